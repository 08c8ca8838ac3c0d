"""``deros``: the command group, exit codes and errors of all commands.

A command's module is imported only when it runs, so that ``deros --help`` answers at once. Exit
codes: 0 clean, 1 findings, 2 usage, unreadable input or a bug of ours, 130 interrupted, 141 the
reader of our output went away.
"""

from __future__ import annotations

import sys
import traceback
from collections.abc import Sequence
from importlib import import_module
from typing import NoReturn

import click

from deros import __version__
from deros.cli.interrupts import INTERRUPTED, interrupts_at_once
from deros.cli.streams import discard_output, is_lost_output, write_readably
from deros.metamodels.languages import listed

BROKEN_PIPE = 141

COMMANDS: dict[str, tuple[str, str]] = {
    "check": ("check:check", "Check models and report every finding."),
    "cmake-dir": (
        "cmake_dir:cmake_dir",
        "Print the folder for CMake's deros_DIR.",
    ),
    "diff": ("diff:diff", "Compare two versions of models by meaning."),
    "draw": ("graphs.draw:draw", "Draw the zones of safety rules to scale."),
    "explain": ("explain:explain", "Explain a finding by its code."),
    "export": ("exchange.export:export", "Write models in formats of other tools."),
    "format": ("editing.format:format_", "Lay out the texts of models in one way."),
    "generate": (
        "generate:generate",
        "Generate code, launch files or parameters.",
    ),
    "graph": ("graph:graph", "Show how the nodes of a system are connected."),
    "import": (
        "exchange.import_:import_",
        "Write models of what runs, or of files of other tools.",
    ),
    "lsp": ("editing.lsp:lsp", "Serve an editor over the Language Server Protocol."),
    "new": ("new:new", "Start a new model that checks clean."),
    "reset": ("reset:reset", "Reset a running safety node or gate."),
    "run": ("run:run", "Start the safety node of rules and its gates at once."),
    "runtime": (
        "runtime:runtime",
        "Write the packages that generated ones may share.",
    ),
    "simulate": ("simulate:simulate", "Run safety rules over a recorded trace."),
    "state": ("state:state", "Show what holds a running robot, and why."),
    "test": ("test:test", "Test safety rules on timelines."),
    "up": ("up:up", "Start every node of a system; stop them all on Ctrl-C."),
    "verify": ("graphs.verify:verify", "Compare what runs with what a system says."),
    "watch": ("watching.command:watch", "Watch running safety nodes and gates."),
}
"""Where each command is, and its line in the overview (so that the overview imports none)."""


class LazyGroup(click.Group):
    """A group that imports a command when it is called for."""

    def list_commands(self, ctx: click.Context) -> list[str]:  # noqa: ARG002 - click's signature
        """Return the names in the order of the overview."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:  # noqa: ARG002
        """Import and return a command, or ``None`` if there is none of that name."""
        if cmd_name not in COMMANDS:
            return None
        module, _, name = COMMANDS[cmd_name][0].partition(":")
        command: click.Command = getattr(import_module(f"deros.cli.commands.{module}"), name)
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find the command, naming the nearest ones when there is none."""
        try:
            return super().resolve_command(ctx, args)
        except click.UsageError as error:
            from deros.validators.findings.hints import did_you_mean

            hint = did_you_mean(args[0], COMMANDS)
            message = f"No such command '{args[0]}'" + (f": {hint}" if hint else ".")
            raise click.UsageError(message, ctx) from error

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:  # noqa: ARG002
        """Write the overview from the table, without importing the commands."""
        with formatter.section("Commands"):
            formatter.write_dl([(name, summary) for name, (_, summary) in COMMANDS.items()])


@click.group(
    cls=LazyGroup,
    context_settings={"help_option_names": ["-h", "--help"]},
    help=f"""Describe, check and generate ROS 2 nodes, systems and safety monitors.

    Models are text: {listed()}.
    """,
)
@click.version_option(__version__, prog_name="deros")
@click.option("--debug", is_flag=True, help="Show a traceback if deros itself fails.")
def deros(debug: bool) -> None:
    """Run the command that the arguments name."""
    del debug  # read from the arguments by main(), which must know it even if parsing them fails


def main(arguments: Sequence[str] | None = None) -> NoReturn:
    """Run ``deros`` and exit; no input ends in a traceback."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    with interrupts_at_once():
        write_readably()
        code = run(given)
        try:
            sys.stdout.flush()
        except BrokenPipeError:
            code = _reader_gone()
        except OSError as error:
            code = _output_lost(error)
    sys.exit(code)


def run(arguments: list[str]) -> int:
    """Run the command that ``arguments`` name and return the exit code."""
    out = sys.stdout
    try:
        result = deros.main(arguments, prog_name="deros", standalone_mode=False)
        return result if isinstance(result, int) else 0
    except click.exceptions.NoArgsIsHelpError as error:
        error.show(sys.stderr)
        return error.exit_code
    except click.ClickException as error:
        error.show(sys.stderr)
        return 2
    except (click.Abort, KeyboardInterrupt):
        sys.stderr.write("\nderos: interrupted\n")
        return INTERRUPTED
    except BrokenPipeError:
        return _reader_gone()
    except OSError as error:
        if is_lost_output(error):
            return _output_lost(error)
        return _bug(error, debug="--debug" in arguments)
    except SystemExit as ended:
        if (
            sys.stdout is not out
        ):  # click turns a closed pipe into an exit, and replaces both streams
            return _reader_gone()
        return ended.code if isinstance(ended.code, int) else int(ended.code is not None)
    except Exception as error:  # the last resort: whatever it is, it is our bug
        return _bug(error, debug="--debug" in arguments)


def _reader_gone() -> int:
    discard_output()
    return BROKEN_PIPE


def _output_lost(error: OSError) -> int:
    discard_output()
    sys.stderr.write(f"deros: cannot write the output: {error.strerror or error}\n")
    return 2


def _bug(error: Exception, *, debug: bool) -> int:
    if debug:
        traceback.print_exc()
    sys.stderr.write(f"deros: this is a bug in deros, not in your models: {_in_words(error)}\n")
    if not debug:
        sys.stderr.write("deros: run 'deros --debug …' to see where, and please report it\n")
    return 2


def _in_words(error: Exception) -> str:
    text = " ".join(str(error).split())
    return f"{type(error).__name__}: {text}" if text else type(error).__name__
