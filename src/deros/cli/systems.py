"""Systems that commands work on once their models are clean, for values of their arguments."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from deros.cli.findings import show, wrong_language
from deros.pipeline.outcome import FINDINGS, exit_code

if TYPE_CHECKING:
    from deros.generators.system.script.standalone.start import Start
    from deros.models.arguments import Lookup
    from deros.models.system import System


def checked_system(ctx: click.Context, file: str, interfaces: tuple[Path, ...]) -> System:
    """Return the system of a file without errors; show the findings, and exit if it has some."""
    from deros.metamodels.languages import ROSSYSTEM
    from deros.models.system import System as SystemModel
    from deros.pipeline.workspace import check_one

    loaded, findings = check_one(file, interfaces)
    show(findings)
    code = exit_code(findings)
    if code:
        ctx.exit(code)
    if not isinstance(loaded.model, SystemModel):
        raise wrong_language(file, ROSSYSTEM)
    return loaded.model


def system_as_started(
    ctx: click.Context, system: System, start: Start, arguments: Sequence[str]
) -> tuple[System, System]:
    """Return a system for arguments as ``deros up`` takes them, on all of its hosts together.

    Args:
        ctx: of the command, which exits where the system cannot be started.
        system: without errors.
        start: where it is looked up what the system looks up.
        arguments: each ``NAME:=VALUE``.

    Returns:
        The system, with :data:`~deros.systems.arguments.lookups.AT_START` for what is not known
        here, such as a folder of a package that is not installed, and again with that for all paths
        that it looks up.

    Raises:
        click.UsageError: if an argument is wrong or missing, or something has no value for it.
    """
    from deros.generators.api.protocol import GenerationError
    from deros.generators.system.script.generate import declared_to_run, system_to_run
    from deros.generators.system.script.standalone.arguments import given
    from deros.generators.system.view import system_view
    from deros.systems.arguments.lookups import looked_up

    here = looked_up(system, functools.partial(_here, start))
    elsewhere = looked_up(system, functools.partial(_elsewhere, start))
    try:
        declared = declared_to_run(system_view(system), here)
        values = given(declared, arguments)
        return system_to_run(system, values, here), system_to_run(system, values, elsewhere)
    except GenerationError as error:
        show(error.diagnostics)
        ctx.exit(FINDINGS)
    except (ValueError, ArithmeticError) as fault:
        raise click.UsageError(str(fault)) from None


def _here(start: Start, found: Lookup) -> str | bool:
    from deros.systems.arguments.lookups import AT_START

    try:
        if found.function == "share" and found.name_from is None:
            return start.share(found.name)
    except ValueError:
        return AT_START
    return found.name if found.function == "this_dir" else _elsewhere(start, found)


def _elsewhere(start: Start, found: Lookup) -> str | bool:
    """Return what a system looks up without what depends on the folders of a computer."""
    from deros.systems.arguments.evaluate import AtStart
    from deros.systems.arguments.lookups import AT_START

    if found.made is not None or found.name_from is not None:
        return AtStart(lambda _: AT_START)
    match found.function:
        case "installed":
            return start.installed(found.name)
        case "env":
            return start.env(found.name, found.default)
        case _:
            return AT_START
