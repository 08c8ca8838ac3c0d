"""``deros check``: run every check on the named files and report all findings together."""

from __future__ import annotations

import contextlib
import gc
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from deros.cli.interrupts import held
from deros.cli.options import interfaces_option
from deros.cli.streams import say
from deros.interfaces.files import recorded
from deros.metamodels.languages import listed
from deros.pipeline.outcome import exit_code
from deros.pipeline.remembered import Found, Memory

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from deros.report.baseline import Compared

FORMATS = ("text", "json", "sarif", "github")


@click.command(
    help=f"""Check models and report every finding.

    FILES are {listed()}, and folders, of which all models are checked. What they import is checked
    with them. Exits with 0 if nothing was found, 1 if something was (warnings count under
    --strict), 2 if a file cannot be read.
    """
)
@click.argument("files", nargs=-1, required=True, type=click.Path())
@click.option("--strict", is_flag=True, help="Fail the run on warnings, too.")
@click.option(
    "--format",
    "output_format",
    type=click.Choice(FORMATS),
    default="text",
    show_default=True,
    help="How to report findings.",
)
@click.option("--show-allowed", is_flag=True, help="Report allowed findings, too.")
@click.option(
    "--baseline",
    metavar="FILE",
    type=click.Path(dir_okay=False, path_type=Path),
    help="Report only findings that are not in this file, and entries of it that no longer occur.",
)
@click.option("--write-baseline", is_flag=True, help="Write the findings to --baseline FILE.")
@click.option(
    "--no-cache",
    is_flag=True,
    help="Check again what has not changed since the last check, and do not keep the findings.",
)
@interfaces_option
@click.pass_context
def check(
    ctx: click.Context,
    files: tuple[str, ...],
    strict: bool,
    output_format: str,
    show_allowed: bool,
    baseline: Path | None,
    write_baseline: bool,
    no_cache: bool,
    interfaces: tuple[Path, ...],
) -> None:
    """Check models and report every finding."""
    if write_baseline and baseline is None:
        raise click.UsageError("--write-baseline needs --baseline FILE")
    with collector_suspended():
        found = find(files, interfaces, anew=no_cache)
    compared = None
    if baseline is not None:
        found, compared = _compared(found, baseline, write=write_baseline)
    report(found, output_format, compared, show_allowed=show_allowed)
    ctx.exit(exit_code(found.findings, strict=strict))


@contextlib.contextmanager
def collector_suspended() -> Iterator[None]:
    """Suspend Python's cyclic garbage collector while models are loaded and checked.

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


def _compared(found: Found, path: Path, *, write: bool) -> tuple[Found, Compared | None]:
    """Leave out the findings in the baseline ``path``, which is written first with ``write``."""
    from deros.report import baseline

    try:
        if write:
            with held():
                count = baseline.write(path, found.findings, found.named)
            say(f"wrote {count} {'finding' if count == 1 else 'findings'} to {path}", to=sys.stderr)
        listed = baseline.read(path)
    except baseline.Unusable as unusable:
        return replace(found, findings=(*found.findings, unusable.diagnostic)), None
    compared = baseline.compare(found.findings, listed, found.named)
    gone = tuple(baseline.absent(each, listed) for each in compared.absent)
    return replace(found, findings=(*compared.new, *gone)), compared


def find(files: Sequence[str], interfaces: Sequence[Path], *, anew: bool = False) -> Found:
    """Check the files, all models below folders, and what they import, as their projects say.

    What an earlier check of them found is returned where nothing has changed that it rests on,
    unless they are to be checked ``anew``.
    """
    if anew:
        return _checked(files, interfaces)
    memory = Memory(files, interfaces)
    found = memory.recall()
    if found is None:
        with recorded() as answers:
            found = _checked(files, interfaces)
        memory.remember(answers, found)
    return found


def _checked(files: Sequence[str], interfaces: Sequence[Path]) -> Found:
    from deros.cli.models import named_models, to_be_checked
    from deros.pipeline.workspace import load

    models = named_models(files)
    names = [each.path for each in models]
    workspace = load(names, interfaces)
    repository = workspace.repository
    named = to_be_checked(models, workspace.files, repository)
    checked = workspace.check(named, files)
    return Found(checked.findings, checked.allowed, len(repository.files), names)


def report(
    found: Found,
    output_format: str,
    compared: Compared | None = None,
    *,
    show_allowed: bool = False,
) -> None:
    """Write the findings to standard output; text closes with a count."""
    from deros.report import formats
    from deros.report import text as render

    shown = found.allowed if show_allowed else ()
    if output_format == "json":
        say(formats.render_json(found.findings, shown), end="")
    elif output_format == "sarif":
        say(formats.render_sarif(found.findings, found.allowed, compared), end="")
    elif output_format == "github":
        say(formats.render_github(found.findings), end="")
    else:
        render.print_text(found.findings, allowed=shown)
        known = len(compared.known) if compared else 0
        say(render.summary(found.findings, found.files, len(found.allowed), known))
