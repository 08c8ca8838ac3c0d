"""``deros diff``: what has changed between two versions of models, by meaning."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from deros.cli.findings import show
from deros.cli.interrupts import removed_at_interrupt
from deros.cli.models import named_models
from deros.cli.options import interfaces_option
from deros.cli.streams import say
from deros.interfaces.files import is_folder
from deros.metamodels.languages import language_of
from deros.pipeline.outcome import CLEAN, FINDINGS, exit_code

if TYPE_CHECKING:
    from deros.diagnostics import Diagnostic
    from deros.diff.models import FileChanges, Side
    from deros.pipeline.revisions import Revision

COMPATIBLE = 3


@click.command()
@click.argument("paths", nargs=-1, required=True, metavar="[OLD] NEW", type=click.Path())
@click.option(
    "--since",
    metavar="REV",
    help="Compare with what NEW is in this revision of its git repository, in place of OLD.",
)
@click.option("--breaking", "only_breaking", is_flag=True, help="Show only what breaks somebody.")
@click.option(
    "--exit-code",
    "tells",
    is_flag=True,
    help=f"Exit with {COMPATIBLE} if there are compatible changes only.",
)
@click.option(
    "--format",
    "output_format",
    type=click.Choice(["text", "json"]),
    default="text",
    show_default=True,
    help="Lines to read, or one JSON object.",
)
@interfaces_option
@click.pass_context
def diff(
    ctx: click.Context,
    paths: tuple[str, ...],
    since: str | None,
    only_breaking: bool,
    tells: bool,
    output_format: str,
    interfaces: tuple[Path, ...],
) -> None:
    """Compare two versions of models by meaning: OLD and NEW are two files or two folders.

    The order of parts, comments, layout and the spelling of units are no change. A change that
    breaks users of a node, a topic or a system, or makes rules weaker, is marked. Exits with 1 if
    there is one.
    """
    from deros.report.changes import as_json, as_text
    from deros.systems.arguments.diagrams import TooManyCombinations

    with _old(paths, since) as (old_path, there):
        shown = there.shown if there is not None else str
        compared = _compared(old_path, paths[-1], there, interfaces)
        if isinstance(compared, int):
            ctx.exit(compared)
        try:
            found = list(compared)
        except TooManyCombinations:
            raise click.UsageError(
                "what a system starts depends on its arguments in more ways than can be compared"
            ) from None
        code = _code(found, tells=tells)
        if only_breaking:
            found = [replace(each, changes=each.breaking) for each in found if each.breaking]
        if output_format == "json":
            say(as_json(found, shown))
        else:
            say("\n".join(as_text(found, shown)))
    ctx.exit(code)


@contextlib.contextmanager
def _old(paths: Sequence[str], since: str | None) -> Iterator[tuple[str, Revision | None]]:
    """Provide the path of the old version, and the revision that it is in, if it is in one."""
    from deros.pipeline.revisions import NoRevision, revision

    if since is None:
        if len(paths) != 2:
            raise click.UsageError("it takes OLD and NEW, or --since REV and NEW")
        yield paths[0], None
        return
    if len(paths) != 1:
        raise click.UsageError("with --since it takes one path")
    try:
        opened = revision(since, paths[0])
        with opened as there, removed_at_interrupt(there.folder):
            yield str(there.path), there
    except NoRevision as fault:
        raise click.UsageError(str(fault)) from None


def _compared(
    old: str, new: str, there: Revision | None, interfaces: Sequence[Path]
) -> Iterator[FileChanges] | int:
    """Return the changes; or the exit code, if one of the versions has errors, which are shown."""
    from deros.diff.models import compare_models

    if is_folder(old) != is_folder(new):
        raise click.UsageError("it compares two files or two folders, not a file with a folder")
    if not is_folder(new) and language_of(old) is not language_of(new):
        raise click.UsageError(f"'{old}' and '{new}' are models of two languages")
    sides = []
    findings: list[Diagnostic] = []
    for path, revision in ((old, there), (new, None)):
        models, errors = _side(path, revision, interfaces)
        sides.append(models)
        findings += errors
    if findings:
        show(findings)
        say("deros: nothing is compared: correct the errors first", to=sys.stderr)
        return exit_code(findings)
    return compare_models(*sides)


def _side(
    path: str, revision: Revision | None, interfaces: Sequence[Path]
) -> tuple[list[Side], list[Diagnostic]]:
    """Load the models of one version; return them, and the errors in them."""
    from deros.diff.models import Side
    from deros.pipeline.workspace import load

    names = [each.path for each in named_models([path])]
    workspace = load(names, interfaces)
    errors = [each for each in workspace.check_models().findings if each.is_error]
    sides = []
    for name, loaded in zip(names, workspace.files, strict=True):
        inside = str(Path(name).relative_to(path)) if is_folder(path) else ""
        shown = inside or (name if revision is None else revision.shown(name))
        if loaded.model is not None:
            sides.append(Side(inside, shown, loaded.model))
    if revision is not None and errors:
        # Only what is shown names a file from here on.
        for source in {each.span.source for each in errors}:
            source.path = revision.shown(source.path)
    return sides, errors


def _code(found: Sequence[FileChanges], *, tells: bool) -> int:
    if any(each.breaking for each in found):
        return FINDINGS
    return COMPATIBLE if found and tells else CLEAN
