"""How commands write files: all or none, and faults of files are errors that name them."""

from __future__ import annotations

import contextlib
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import click

from deros.cli.interrupts import held
from deros.cli.streams import say

if TYPE_CHECKING:
    from deros.generators.api.protocol import File
    from deros.generators.output.writer import WriteReport


@contextlib.contextmanager
def file_errors() -> Iterator[None]:
    """End the command with a message where a file cannot be read or written, or not safely.

    A signal that ends the program waits until all is written.

    Raises:
        click.ClickException: the message names the file.
    """
    from deros.generators.output.writer import WriteError

    try:
        with held():
            yield
    except OSError as error:
        raise click.ClickException(f"cannot read {error.filename}: {error.strerror}") from error
    except WriteError as error:
        raise click.ClickException(str(error)) from error


def write_files(files: Mapping[str, File], output: Path) -> WriteReport:
    """Write files into a folder, and say which of them have changed.

    Args:
        files: by their paths in the folder.
        output: the folder, which is made if it is not there.

    Raises:
        click.ClickException: nothing is written.
    """
    from deros.generators.output.writer import Outcome, write

    with file_errors():
        report = write(files, output)
    for path in report.of(Outcome.WRITTEN):
        say(f"wrote {output / path}")
    return report


def say_next(model: Path, interfaces: Iterable[Path]) -> None:
    """Say how to check what has been written, with the folders of definitions that it needs."""
    options = "".join(f" --interfaces {folder}" for folder in dict.fromkeys(interfaces))
    say(f"next: deros check {model}{options}")
