// The language server: started, started again, and what is said where it cannot be.

import { spawn, type ChildProcess } from "node:child_process";
import { once } from "node:events";
import * as vscode from "vscode";
import { CloseAction, ErrorAction, LanguageClient, State } from "vscode-languageclient/node";

import { LANGUAGES, folder, interfaces, program } from "./program";

const INSTALL = "pip install 'deros[lsp]'";
const WATCHED = "**/{*.rnd,*.system,*.deros,*.msg,*.srv,*.action,*.yaml,*.yml,deros.toml}";
const KEPT = 2000; // characters of what a server wrote, for the message about its end
const SETTINGS = "Open settings";
const AGAIN = "Try again";

/** Why a server did not start, in words for the user. */
class Failure extends Error {}

/** A client that only writes down what fails: a {@link Connection} tells it, and tells it once. */
class Client extends LanguageClient {
  override error(message: string, data?: unknown): void {
    super.error(message, data, false);
  }
}

/** At most one server at a time. What is asked meanwhile waits for its turn. */
export class Connection {
  private readonly output = vscode.window.createOutputChannel("deros", { log: true });
  private readonly files = vscode.workspace.createFileSystemWatcher(WATCHED);
  private client: LanguageClient | undefined;
  private turn: Promise<void> = Promise.resolve();

  /** Starts the server, or ends the one that there is and starts another. */
  restart(): Promise<void> {
    return this.next(async () => {
      await this.end();
      await this.start();
    });
  }

  /** Ends the server. */
  stop(): Promise<void> {
    return this.next(() => this.end());
  }

  private next(step: () => Promise<void>): Promise<void> {
    this.turn = this.turn.then(step, step);
    return this.turn;
  }

  private async end(): Promise<void> {
    const client = this.client;
    this.client = undefined;
    if (client?.state === State.Running) {
      await client.dispose();
    }
  }

  private async start(): Promise<void> {
    try {
      const server = await launched();
      const client = this.clientOf(server);
      this.client = client;
      await client.start().catch((error: unknown) => {
        throw new Failure(server.said.trim() || `The language server does not answer: ${error}`);
      });
    } catch (error) {
      this.client = undefined;
      void this.tell(error instanceof Failure ? error.message : String(error));
    }
  }

  private clientOf(server: Server): LanguageClient {
    const client = new Client("deros", "deros", () => Promise.resolve(server.process), {
      documentSelector: LANGUAGES.map((language) => ({ scheme: "file", language })),
      outputChannel: this.output,
      synchronize: { fileEvents: this.files },
      initializationFailedHandler: () => false,
      errorHandler: {
        error: () => ({ action: ErrorAction.Continue, handled: true }),
        closed: () => {
          if (this.client === client && client.state === State.Running) {
            this.client = undefined;
            void this.tell(`The language server has ended. ${server.said.trim()}`);
          }
          return { action: CloseAction.DoNotRestart, handled: true };
        },
      },
    });
    return client;
  }

  private async tell(message: string): Promise<void> {
    this.output.error(message);
    const chosen = await vscode.window.showErrorMessage(message, AGAIN, SETTINGS);
    if (chosen === AGAIN) {
      await this.restart();
    } else if (chosen === SETTINGS) {
      await vscode.commands.executeCommand("workbench.action.openSettings", "deros.");
    }
  }
}

/** A running server, and the end of what it wrote beside the protocol. */
interface Server {
  readonly process: ChildProcess;
  said: string;
}

/** Starts the server's process. */
async function launched(): Promise<Server> {
  const name = program();
  const options = interfaces().flatMap((each) => ["--interfaces", each]);
  const child = spawn(name, ["lsp", ...options], { cwd: folder(), stdio: "pipe" });
  const server: Server = { process: child, said: "" };
  child.stderr.on("data", (text) => {
    server.said = (server.said + String(text)).slice(-KEPT);
  });
  try {
    await once(child, "spawn");
  } catch (error) {
    throw new Failure(
      `The program ${name} cannot be started (${(error as NodeJS.ErrnoException).code}). ` +
        `Install it with: ${INSTALL}. Or name it in the setting deros.path.`,
    );
  }
  return server;
}
