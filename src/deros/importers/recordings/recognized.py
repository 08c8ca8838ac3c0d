"""Which paths are recordings. It loads no library that reads them."""

from __future__ import annotations

from pathlib import Path

from deros.interfaces.files import entries, is_file, is_folder

METADATA = "metadata.yaml"
SUFFIXES = (".mcap", ".db3")


def is_recording(path: Path) -> bool:
    """Return whether a path is a file of a recording, or a folder with one."""
    if path.suffix in SUFFIXES:
        return True
    return is_folder(path) and (is_file(path / METADATA) or bool(storage_files(path)))


def storage_files(folder: Path) -> list[Path]:
    """Return the files of a folder that hold messages, sorted by name.

    Those that are compressed as a whole are not among them: ``metadata.yaml`` is needed for these.
    """
    files = (folder / each.name for each in entries(folder) if not each.is_folder)
    return [path for path in files if path.suffix in SUFFIXES]
