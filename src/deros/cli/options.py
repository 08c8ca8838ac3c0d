"""Options that several commands share."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import click

Command = TypeVar("Command", bound=Callable[..., Any])


def interfaces_option(command: Command) -> Command:
    """Add ``--interfaces PATH``, which may be given several times."""
    option = click.option(
        "--interfaces",
        "interfaces",
        multiple=True,
        metavar="PATH",
        type=click.Path(exists=True, file_okay=False, path_type=Path),
        help="Folder with .msg, .srv and .action files of packages; may be given several times.",
    )
    return option(command)
