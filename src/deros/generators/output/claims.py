"""Which target and model made each generated file of a folder, so that none replaces another's.

A file in the output folder, :data:`RECORD`, lists what each run wrote there. Without it, and for
what was written before there was one, packages in Python and in C++ are told apart by their build
files.
"""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from deros import codes
from deros.diagnostics import Diagnostic, SourceFile, Span, report
from deros.generators.api.protocol import File, Files, GenerationError, Owner
from deros.generators.output.banner import with_banner
from deros.interfaces.files import read_regular

RECORD = ".deros-origins.json"
"""The file in the output folder that says what made the others."""

_LARGEST = 16 << 20
_BUILD_FILES = (("setup.py", "a package in Python"), ("CMakeLists.txt", "a package in C++"))


@dataclass(frozen=True, slots=True)
class Origin:
    """What makes files: a target of a language, and a model.

    Attributes:
        model: the model's path relative to the output folder; of a node description its folder, as
            the nodes of a package are made together.
    """

    language: str
    target: str
    model: str

    @classmethod
    def of(cls, language: str, target: str, model: str, directory: Path) -> Origin:
        """Return the origin of files for ``directory``."""
        path = Path(os.path.relpath(os.path.realpath(model), os.path.realpath(directory)))
        return cls(language, target, (path.parent if language == "rosnode" else path).as_posix())

    def is_there(self, directory: Path) -> bool:
        """Tell whether the model can still make its files."""
        return (directory / self.model).exists()

    def __str__(self) -> str:
        """Say what it is."""
        return f"'{self.target}' from '{self.model}'"


def check_claims(files: Files, directory: Path, origin: Origin) -> None:
    """Refuse to replace what another target, or another model that is still there, has made.

    Raises:
        GenerationError: with a ``DRS406`` for each package, or file outside a package, that has
            another origin.
    """
    found = list(_mixed(files, directory))
    places: set[str] = set()
    for path, other in sorted(_recorded(directory).items()):
        file = files.get(path)
        if file is None or other == origin or not (directory / path).exists():
            continue
        is_moved = other.target == origin.target and not other.is_there(directory)
        place = path.partition("/")[0]
        if is_moved or place in places or _is_same(path, file, directory):
            continue
        places.add(place)
        found.append(_claimed(directory / path, f"it was made by {other}, and is not replaced"))
    if found:
        raise GenerationError(found)


def _mixed(files: Files, directory: Path) -> Iterator[Diagnostic]:
    """Find folders with a package of the other build system."""
    for top in dict.fromkeys(path.partition("/")[0] for path in files):
        for (own, _), (other, what) in (_BUILD_FILES, _BUILD_FILES[::-1]):
            place = directory / top / other
            if f"{top}/{own}" in files and f"{top}/{other}" not in files and place.is_file():
                yield _claimed(place, f"the folder has {what} already")


def _claimed(path: Path, why: str) -> Diagnostic:
    source = SourceFile(str(path), "")
    hint = "generate into another folder (-o), or remove what is there"
    return report(codes.OVERWRITES_OTHER, why, Span(source, 0, 0), hint)


def _is_same(path: str, file: File, directory: Path) -> bool:
    if file.owner is Owner.USER:
        return False
    with contextlib.suppress(OSError):
        return read_regular(directory / path, _LARGEST) == with_banner(path, file.text).encode()
    return False


def record_claims(files: Files, directory: Path, origin: Origin) -> None:
    """Add what was written to the record of a folder; a record that is so already stays."""
    recorded = _recorded(directory)
    claims = {path: at for path, at in recorded.items() if (directory / path).exists()}
    claims |= dict.fromkeys(files, origin)
    if claims == recorded:
        return
    by_origin: dict[Origin, list[str]] = {}
    for path in sorted(claims):
        by_origin.setdefault(claims[path], []).append(path)
    entries = [
        {"language": at.language, "target": at.target, "model": at.model, "files": paths}
        for at, paths in sorted(by_origin.items(), key=lambda item: item[1])
    ]
    text = json.dumps({"made by": entries}, indent=1) + "\n"
    # The record helps to find mistakes: that it cannot be written is none.
    with contextlib.suppress(OSError):
        staged = directory / f"{RECORD}.{os.getpid()}"  # several runs may write at the same time
        staged.write_text(text, encoding="utf-8")
        staged.replace(directory / RECORD)


def _recorded(directory: Path) -> dict[str, Origin]:
    """Return the record of a folder; one that cannot be read is empty."""
    try:
        data: Any = json.loads(read_regular(directory / RECORD, _LARGEST))
        return {
            str(path): Origin(str(each["language"]), str(each["target"]), str(each["model"]))
            for each in data["made by"]
            for path in each["files"]
        }
    except (OSError, ValueError, KeyError, TypeError):
        return {}
