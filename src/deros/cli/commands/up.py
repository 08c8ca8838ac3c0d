"""``deros up``: run a system directly, like the script generated from it."""

from __future__ import annotations

import functools
from pathlib import Path
from typing import TYPE_CHECKING

import click

from deros.cli.findings import show
from deros.cli.options import dry_run_option, interfaces_option, stop_timeout_option
from deros.cli.systems import checked_system
from deros.pipeline.outcome import FINDINGS

if TYPE_CHECKING:
    from collections.abc import Sequence
    from types import SimpleNamespace

    from deros.generators.system.script.standalone.made.files import MadeFiles
    from deros.generators.system.script.standalone.node import Row
    from deros.generators.system.script.standalone.start import Start
    from deros.models.arguments import Lookup


@click.command(
    epilog="Exit codes: 0 if every node ended normally, by itself or on request; 130 if that was a "
    "Ctrl-C; 1 if the model has errors, or a node failed or did not stop on request; 2 if nothing "
    "was started, because an argument is wrong or a program was not found."
)
@click.argument("file", type=click.Path())
@click.argument("arguments", nargs=-1)
@dry_run_option
@click.option(
    "--install",
    "--package-path",
    multiple=True,
    metavar="DIR",
    type=click.Path(exists=True, file_okay=False),
    help="Look for programs in this install space, or folder of Python packages as they were "
    "generated, before those of AMENT_PREFIX_PATH; may be given several times.",
)
@click.option(
    "--only",
    multiple=True,
    metavar="NODE",
    help="Run this node, process or subsystem alone: a name, a full name, or a pattern such as "
    "'/front/*'; may be given several times.",
)
@click.option(
    "--except",
    "excluded",
    multiple=True,
    metavar="NODE",
    help="Leave a node, process or subsystem out.",
)
@click.option("--keep-going", is_flag=True, help="Let the others run on when a node fails.")
@stop_timeout_option
@click.option(
    "--log-dir",
    metavar="DIR",
    type=click.Path(file_okay=False),
    help="Write what each program says into DIR, too: a file for each, and one of all. A full file "
    "of 10 MB begins anew, and five older ones are kept.",
)
@click.option(
    "--table",
    is_flag=True,
    help="Show a table of the programs (process, load, memory, restarts, state) instead of their "
    "output, of which only the last lines are seen.",
)
@click.option(
    "--ssh",
    is_flag=True,
    help="Start the part of each host of the system there, over ssh, and stop them together; with "
    "host:=NAME, the part of that one here.",
)
@click.option(
    "--ssh-command",
    metavar="WORDS",
    help="What to run instead of ssh, as in 'ssh -F robots.conf'.",
)
@click.option(
    "--ssh-timeout",
    metavar="SECONDS",
    help="Time after which a host that is silent counts as lost (default: 10).",
)
@interfaces_option
@click.pass_context
def up(
    ctx: click.Context,
    file: str,
    arguments: tuple[str, ...],
    dry_run: bool,
    install: tuple[str, ...],
    only: tuple[str, ...],
    excluded: tuple[str, ...],
    keep_going: bool,
    stop_timeout: str,
    log_dir: str | None,
    table: bool,
    ssh: bool,
    ssh_command: str | None,
    ssh_timeout: str | None,
    interfaces: tuple[Path, ...],
) -> None:
    """Start every node of the system in FILE; stop them all on Ctrl-C.

    The model is checked first, and nothing is started if an error is found. It then
    runs like the script of 'deros generate --target script', which takes the ARGUMENTS after --.
    Arguments of the system are given as NAME:=VALUE; '-- --help' lists them.
    """
    given = ["--stop-timeout", stop_timeout]
    given += [word for folder in install for word in ("--package-path", folder)]
    given += [word for name in only for word in ("--only", name)]
    given += [word for name in excluded for word in ("--except", name)]
    given += ["--dry-run"] * dry_run + ["--keep-going"] * keep_going + ["--table"] * table
    given += [] if log_dir is None else ["--log-dir", log_dir]
    given += ["--ssh"] * ssh
    given += [] if ssh_command is None else [f"--ssh-command={ssh_command}"]
    given += [] if ssh_timeout is None else [f"--ssh-timeout={ssh_timeout}"]
    run = _run_script if ssh else _run
    ctx.exit(run(ctx, file, interfaces, [*given, *arguments]))


def _run_script(
    ctx: click.Context, file: str, interfaces: tuple[Path, ...], arguments: Sequence[str]
) -> int:
    """Run the script of a system, which goes to all of its hosts as it is."""
    from deros.cli.generated import run_generated_script
    from deros.generators.api.protocol import GenerationError

    system = checked_system(ctx, file, interfaces)
    if not system.hosts:
        raise click.UsageError(
            "--ssh starts a system on its hosts, and this one declares none: write"
            " 'host NAME \"ADDRESS\"' and 'on NAME'"
        )
    try:
        return run_generated_script(system, f"deros up {file}", arguments)
    except GenerationError as error:
        show(error.diagnostics)
        return FINDINGS


def _run(
    ctx: click.Context, file: str, interfaces: tuple[Path, ...], arguments: Sequence[str]
) -> int:
    from deros.generators.api.protocol import GenerationError
    from deros.generators.system.script.generate import declared_to_run, system_to_run, table
    from deros.generators.system.script.standalone.arguments import main_with_arguments
    from deros.generators.system.script.standalone.command import main
    from deros.generators.system.script.standalone.containers.composition import (
        ComposingSupervisor,
    )
    from deros.generators.system.script.standalone.made.files import MadeFiles
    from deros.generators.system.script.standalone.start import Start
    from deros.generators.system.script.standalone.waits.waiting import waiting
    from deros.generators.system.view import system_view
    from deros.systems.arguments.lookups import looked_up
    from deros.systems.running.placement import placed

    program = f"deros up {file}"
    everywhere = checked_system(ctx, file, interfaces)
    system = placed(everywhere)
    made, supervisor = MadeFiles(), waiting(ComposingSupervisor)
    try:
        view = system_view(system, everywhere=everywhere)
        if not system.is_computed:
            rows = table(view, made)
            return main(view.name, rows, arguments, program, "", supervisor, preparation=made)

        values = looked_up(system, functools.partial(_look, Start(file, arguments), made))

        def nodes(given: SimpleNamespace) -> Sequence[Row]:
            there = system_to_run(everywhere, given, values)
            view = system_view(system_to_run(system, given, values), everywhere=there)
            return table(view, made)

        declared = declared_to_run(view, values)
        return main_with_arguments(
            *(view.name, declared, nodes, arguments, program),
            supervisor=supervisor,
            preparation=made,
        )
    except GenerationError as error:
        show(error.diagnostics)
        return FINDINGS


def _look(start: Start, made: MadeFiles, found: Lookup) -> str | bool:
    from deros.systems.arguments.evaluate import AtStart

    if found.made is not None:
        return AtStart(lambda file: made.xacro(file.located, file.given))
    if found.name_from is not None:
        return AtStart(start.share)
    match found.function:
        case "this_dir":
            return found.name
        case "installed":
            return start.installed(found.name)
        case "share":
            return start.share(found.name)
        case _:
            return start.env(found.name, found.default)
