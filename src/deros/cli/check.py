"""``deros check``: run every check on the named files and report all findings together."""

from __future__ import annotations

import contextlib
import gc
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import click

from deros.cli.options import exit_code, interfaces_option

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from deros.diagnostics import Diagnostic
    from deros.validators.allowances import Allowed

FORMATS = ("text", "json", "sarif", "github")


@click.command()
@click.argument("files", nargs=-1, required=True, type=click.Path())
@click.option("--strict", is_flag=True, help="Let warnings fail the run, too.")
@click.option(
    "--format",
    "output_format",
    type=click.Choice(FORMATS),
    default="text",
    show_default=True,
    help="How to report findings.",
)
@click.option("--show-allowed", is_flag=True, help="Report what the models allow, too.")
@interfaces_option
@click.pass_context
def check(
    ctx: click.Context,
    files: tuple[str, ...],
    strict: bool,
    output_format: str,
    show_allowed: bool,
    interfaces: tuple[Path, ...],
) -> None:
    """Check models and report every finding.

    FILES are node descriptions (*.rnd), system descriptions (*.system) and safety rules
    (*.deros). What they import is checked with them. Exits with 0 if nothing was found, 1 if
    something was (warnings count under --strict), 2 if a file cannot be read.
    """
    with without_collector():
        found = find(files, interfaces)
    report(found, output_format, show_allowed=show_allowed)
    ctx.exit(exit_code(found.findings, strict=strict))


@contextlib.contextmanager
def without_collector() -> Iterator[None]:
    """Keep Python's cycle collector away while models are loaded and checked.

    They live until the end of the run: looking for garbage among them finds none, and takes a third
    of the time on a large system.
    """
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()


@dataclass(frozen=True, slots=True)
class Found:
    """What a run of the checks found, in how many files."""

    findings: Sequence[Diagnostic]
    allowed: Sequence[Allowed]
    files: int


def find(files: Sequence[str], interfaces: Sequence[Path]) -> Found:
    """Check the files and their imports."""
    from deros.interfaces.store import InterfaceStore
    from deros.metamodels.load import Repository
    from deros.validators.check import check_all

    repository = Repository()
    named = [repository.load(path) for path in files]
    checked = check_all(named, repository, InterfaceStore(interfaces))
    return Found(checked.findings, checked.allowed, len(repository.files))


def report(found: Found, output_format: str, *, show_allowed: bool = False) -> None:
    """Write the findings to standard output; text closes with a count."""
    from deros.cli import formats, render

    shown = found.allowed if show_allowed else ()
    if output_format == "json":
        click.echo(formats.render_json(found.findings, shown), nl=False)
    elif output_format == "sarif":
        click.echo(formats.render_sarif(found.findings, found.allowed), nl=False)
    elif output_format == "github":
        click.echo(formats.render_github(found.findings), nl=False)
    else:
        render.print_text(found.findings, allowed=shown)
        click.echo(render.summary(found.findings, found.files, len(found.allowed)))
