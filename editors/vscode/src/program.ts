// Which program is run, as the settings say.

import { homedir } from "node:os";
import { isAbsolute, resolve } from "node:path";
import * as vscode from "vscode";

/** The ids of the three languages, as package.json declares them. */
export const LANGUAGES = ["rosnode", "rossystem", "deros"];

/** The folder that relative paths of the settings begin at. */
export function folder(): string | undefined {
  return vscode.workspace.workspaceFolders?.find((each) => each.uri.scheme === "file")?.uri.fsPath;
}

/** The program `deros`: a name for the PATH, or an absolute path. */
export function program(): string {
  const given = setting<string>("path")?.trim() || "deros";
  return /^[^/\\$~]+$/.test(given) ? given : expanded(given);
}

/** The folders with definitions of messages, as absolute paths. */
export function interfaces(): string[] {
  return (setting<string[]>("interfaces") ?? []).map(expanded);
}

function setting<T>(name: string): T | undefined {
  return vscode.workspace.getConfiguration("deros").get<T>(name);
}

function expanded(path: string): string {
  const base = folder();
  const full = path
    .replace(/^~(?=[/\\]|$)/, () => homedir())
    .replaceAll("${workspaceFolder}", () => base ?? "${workspaceFolder}");
  return isAbsolute(full) || base === undefined ? full : resolve(base, full);
}
