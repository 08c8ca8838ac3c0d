"""``deros format``: lay out the texts of models in one way."""

from __future__ import annotations

import codecs
import difflib
import os
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

import click

from deros.cli.findings import show
from deros.cli.interrupts import held
from deros.cli.models import named_models
from deros.cli.streams import say
from deros.interfaces.files import real_path
from deros.metamodels.languages import Language, language_of, listed, suffixes
from deros.metamodels.reading import LARGEST_MODEL, Unreadable, decoded, read
from deros.pipeline.outcome import CLEAN, FINDINGS, UNUSABLE

if TYPE_CHECKING:
    from collections.abc import Sequence

    from deros.diagnostics import SourceFile

_STREAM = "-"


@click.command(
    "format",
    help=f"""Lay out the texts of models in one way.

    FILES are {listed()}, and folders, of which all models are formatted; - is standard input, which
    is written to standard output. Only blanks and line breaks change. A file with a syntax error is
    left as it is.
    """,
    epilog="Exit codes: 0 if all could be formatted, or with --check, if all is formatted; 1 with "
    "--check if something is not; 2 if something has a syntax error, or cannot be read or written.",
)
@click.argument("files", nargs=-1, required=True, type=click.Path(allow_dash=True))
@click.option("--check", is_flag=True, help="Write nothing; name the files that would change.")
@click.option("--diff", is_flag=True, help="Write nothing; show what would change.")
@click.option(
    "--stdin-filename",
    metavar="NAME",
    help=f"For -: a name that ends in {', '.join(suffixes())}, which says what language it is.",
)
@click.pass_context
def format_(
    ctx: click.Context,
    files: tuple[str, ...],
    check: bool,
    diff: bool,
    stdin_filename: str | None,
) -> None:
    """Format files, or standard input."""
    if _STREAM in files:
        if len(files) > 1:
            raise click.UsageError("- stands alone: it is standard input")
        names = [_name_of_stream(stdin_filename)]
    else:
        names = [each.path for each in named_models(files)]
    languages = [_language(each) for each in names]
    code = CLEAN
    for name, language in zip(names, languages, strict=True):
        found = _format(name, language, files == (_STREAM,), check, diff)
        code = max(code, found)
    ctx.exit(code)


def _name_of_stream(name: str | None) -> str:
    if name is None:
        raise click.UsageError("- needs --stdin-filename NAME: its ending says what language it is")
    return name


def _language(name: str) -> Language:
    language = language_of(name)
    if language is None:
        endings = ", ".join(suffixes())
        raise click.UsageError(f"'{name}' is not a model: its name ends in none of {endings}")
    return language


def _format(name: str, language: Language, is_stream: bool, check: bool, diff: bool) -> int:
    """Format one file, or say what would change in it; return the exit code for it."""
    from deros.formatting.format import Fault, formatted

    try:
        data = sys.stdin.buffer.read(LARGEST_MODEL + 1) if is_stream else b""
        source = decoded(data, name) if is_stream else read(Path(name), name, streams=False)
    except Unreadable as unreadable:
        show([unreadable.diagnostic])
        return UNUSABLE
    if len(data) > LARGEST_MODEL:
        raise click.ClickException(f"standard input is larger than {LARGEST_MODEL >> 20} MB")
    result = formatted(source.text, language, name)
    if isinstance(result, Fault):
        show(result.diagnostics)
        return UNUSABLE
    if check or diff:
        return _compare(source, result, check, diff)
    if is_stream:
        sys.stdout.flush()
        sys.stdout.buffer.write(result.encode())
    elif result != source.text:
        _replace(name, result)
        say(f"formatted {name}")
    return CLEAN


def _compare(source: SourceFile, result: str, check: bool, diff: bool) -> int:
    """Say what would change; line ends are not shown."""
    if result == source.text:
        return CLEAN
    if diff:
        before, after = source.text.splitlines(), result.splitlines()
        say("\n".join(_diff(before, after, source.path)))
    if check:
        say(f"would format {source.path}", to=sys.stderr)
    return FINDINGS if check else CLEAN


def _diff(before: Sequence[str], after: Sequence[str], name: str) -> list[str]:
    return list(difflib.unified_diff(before, after, name, f"{name} (formatted)", lineterm=""))


def _replace(name: str, text: str) -> None:
    """Write a file that is there as a whole: a link to it stays one, and its mode stays."""
    path = Path(real_path(name))
    try:
        if not os.access(path, os.W_OK):
            raise PermissionError(0, "it is write-protected")
        mark = codecs.BOM_UTF8 if path.read_bytes().startswith(codecs.BOM_UTF8) else b""
        with held(), tempfile.TemporaryDirectory(prefix=".deros-", dir=path.parent) as staging:
            staged = Path(staging) / path.name
            staged.write_bytes(mark + text.encode())
            staged.chmod(path.stat().st_mode & 0o7777)
            staged.replace(path)
    except OSError as error:
        raise click.ClickException(f"cannot write '{name}': {error.strerror or error}") from error
