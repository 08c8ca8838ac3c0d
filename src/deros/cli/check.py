"""``deros check``: run every check on the named files and report all findings together."""

from __future__ import annotations

import contextlib
import gc
from pathlib import Path
from typing import TYPE_CHECKING

import click

from deros.cli.options import exit_code, interfaces_option

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from deros.diagnostics import Diagnostic

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
@interfaces_option
@click.pass_context
def check(
    ctx: click.Context,
    files: tuple[str, ...],
    strict: bool,
    output_format: str,
    interfaces: tuple[Path, ...],
) -> None:
    """Check models and report every finding.

    FILES are node descriptions (*.rnd), system descriptions (*.system) and safety rules
    (*.deros). What they import is checked with them. Exits with 0 if nothing was found, 1 if
    something was (warnings count under --strict), 2 if a file cannot be read.
    """
    with without_collector():
        findings, count = find(files, interfaces)
    report(findings, count, output_format)
    ctx.exit(exit_code(findings, strict=strict))


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


def find(files: Sequence[str], interfaces: Sequence[Path]) -> tuple[list[Diagnostic], int]:
    """Return the findings of the files and their imports, and how many files that were."""
    from deros.interfaces.store import InterfaceStore
    from deros.metamodels.load import Repository
    from deros.validators.check import check as check_loaded

    repository = Repository()
    named = [repository.load(path) for path in files]
    findings = check_loaded(named, repository, InterfaceStore(interfaces))
    return findings, len(repository.files)


def report(findings: Sequence[Diagnostic], files: int, output_format: str) -> None:
    """Write the findings to standard output; text closes with a count."""
    from deros.cli import formats, render

    if output_format == "json":
        click.echo(formats.render_json(findings), nl=False)
    elif output_format == "sarif":
        click.echo(formats.render_sarif(findings), nl=False)
    elif output_format == "github":
        click.echo(formats.render_github(findings), nl=False)
    else:
        render.print_text(findings)
        click.echo(render.summary(findings, files))
