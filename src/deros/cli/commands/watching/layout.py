"""Writes the Foxglove layout of ``deros watch``."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from deros.cli.streams import say

if TYPE_CHECKING:
    from deros.live.watcher import Watcher

PLACEHOLDER = "/robot_safety_node"
"""The safety node of the layout where none runs, and none is named."""


def write_layout(watcher: Watcher, node: str | None, file: str) -> None:
    """Write the layout for the nodes that report, or for a placeholder.

    Args:
        watcher: that has listened already.
        node: the full name that the user gave.
        file: to write, which may not exist yet; ``-`` is standard output.

    Raises:
        click.ClickException: if the file exists or cannot be written.
    """
    from deros.live.foxglove import Subject, layout

    subjects = watcher.subjects()
    if not subjects:
        subjects = (Subject(node or PLACEHOLDER),)
        say(
            f"deros: no safety node reported in time: the layout is for {subjects[0].node}, "
            "without its actions and rules; write it anew while the node runs",
            to=sys.stderr,
        )
    text = json.dumps(layout(subjects), indent=2, ensure_ascii=False)
    if file == "-":
        say(text)
    else:
        _write_new(Path(file), f"{text}\n")


def _write_new(path: Path, text: str) -> None:
    """Write a file that does not exist yet: a layout may have been changed by hand."""
    try:
        with path.open("x", encoding="utf-8") as stream:
            stream.write(text)
    except FileExistsError as error:
        raise _unwritable(path, "it exists; remove it, or give another name") from error
    except OSError as error:
        raise _unwritable(path, error.strerror or str(error)) from error
    say(f"wrote {path}")


def _unwritable(path: Path, why: str) -> click.ClickException:
    return click.ClickException(f"{path} cannot be written: {why}")
