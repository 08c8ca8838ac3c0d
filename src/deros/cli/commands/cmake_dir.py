"""``deros cmake-dir``: where CMake finds deros, if it does not find it by itself."""

from __future__ import annotations

from pathlib import Path

import click

from deros.cli.streams import say


@click.command("cmake-dir")
def cmake_dir() -> None:
    """Print the folder for CMake's deros_DIR.

    It is needed only where find_package(deros) does not find deros by itself:

      cmake -B build -Dderos_DIR=$(deros cmake-dir)
    """
    say(str(Path(__file__).resolve().parents[2] / "cmake"))
