// Runs the program in the integrated terminal.

import * as vscode from "vscode";

import { LANGUAGES, folder, program } from "./program";

/**
 * Runs `deros` with some arguments, after what is being edited has been saved.
 *
 * The process is started as it is, without a shell, so there is nothing to quote: an argument stays
 * one argument whatever is in it. A code lens gives the arguments one by one.
 */
export async function runInTerminal(given: unknown[]): Promise<void> {
  const words = given.flat();
  if (words.length === 0 || !words.every((word) => typeof word === "string")) {
    void vscode.window.showErrorMessage("deros: the command deros.run takes the program's arguments as texts.");
    return;
  }
  if (!(await saved())) {
    return;
  }
  const run = new vscode.Task(
    { type: "process", task: words.join(" ") },
    vscode.TaskScope.Workspace,
    words.join(" "),
    "deros",
    new vscode.ProcessExecution(program(), words, { cwd: folder() }),
    [],
  );
  run.presentationOptions = { reveal: vscode.TaskRevealKind.Always, clear: false, showReuseMessage: false };
  await vscode.tasks.executeTask(run);
}

/** Saves the models that are open; false where one was not saved. */
async function saved(): Promise<boolean> {
  const unsaved = vscode.workspace.textDocuments.filter(
    (each) => each.isDirty && !each.isUntitled && LANGUAGES.includes(each.languageId),
  );
  return (await Promise.all(unsaved.map((each) => each.save()))).every(Boolean);
}
