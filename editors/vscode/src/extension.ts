// The client of `deros lsp`: it starts the server, and runs the commands that the server offers.

import * as vscode from "vscode";

import { Connection } from "./connection";
import { runInTerminal } from "./terminal";

/** Commands by name. `deros.run` is what the server's code lenses call. */
const RESTART = "deros.restart";
const RUN = "deros.run";

let connection: Connection | undefined;

/** Called by VS Code when the first model is opened. */
export async function activate(context: vscode.ExtensionContext): Promise<void> {
  const current = new Connection();
  connection = current;
  context.subscriptions.push(
    vscode.commands.registerCommand(RESTART, () => current.restart()),
    vscode.commands.registerCommand(RUN, (...given: unknown[]) => runInTerminal(given)),
    vscode.workspace.onDidChangeConfiguration((change) => {
      if (change.affectsConfiguration("deros.path") || change.affectsConfiguration("deros.interfaces")) {
        return current.restart();
      }
    }),
    vscode.workspace.onDidGrantWorkspaceTrust(() => current.restart()),
  );
  await current.restart();
}

/** Called by VS Code when it ends, or the extension is turned off. */
export async function deactivate(): Promise<void> {
  await connection?.stop();
}
