"""Findings: the failures of mutants, distinguished by where they occurred."""

from __future__ import annotations

import json
import re
import traceback
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from tools.fuzzing.mutants import KINDS, Mutant
from tools.fuzzing.projects import ROOT

_CARD = "mutant.json"
_VARYING = re.compile(r"'[^']*'|\"[^\"]*\"|\d+(?:\.\d+)?")


@dataclass(frozen=True)
class Finding:
    """One thing that went wrong.

    Attributes:
        signature: equal for mutants that fail in the same way at the same place.
        text: the traceback, or what was measured.
        number: of the mutant.
        mutant: complete, with its trace or message; ``None`` if its process died.
    """

    signature: str
    text: str
    number: int
    mutant: Mutant | None = field(repr=False, default=None)

    @property
    def file_name(self) -> str:
        """A name for a folder."""
        return re.sub(r"[^\w.]+", "_", self.signature)[:80].strip("_")


def signature(error: BaseException) -> str:
    """Return the kind of an exception, and the place in deros where it comes from."""
    frames = traceback.extract_tb(error.__traceback__)
    ours = [each for each in frames if "/deros/" in each.filename] or frames
    where = f"{_short(ours[-1].filename)}:{ours[-1].name}" if ours else "nowhere"
    what = _VARYING.sub("…", str(error))[:80]
    named = type(error).__name__
    if named == "Wrong":
        return f"{named} {what}"
    return f"{named} in {where}"


def _short(path: str) -> str:
    parts = Path(path).parts
    return "/".join(parts[parts.index("deros") + 1 :]) if "deros" in parts else parts[-1]


def keep(folder: Path, mutant: Mutant) -> None:
    """Write a mutant to a folder, to be replayed from there."""
    for path, content in mutant.files.items():
        target = folder / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(content)
    card = {"kind": mutant.kind, "entry": mutant.entry}
    (folder / _CARD).write_text(json.dumps(card) + "\n", encoding="utf-8")


def kept(folder: Path) -> Mutant:
    """Read a mutant from the folder that :func:`keep` wrote."""
    card: Mapping[str, str] = json.loads((folder / _CARD).read_text(encoding="utf-8"))
    files = {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path.name != _CARD
    }
    kind = next(each for each in KINDS if each == card["kind"])
    return Mutant(kind, f"kept_{folder.name}", files, card["entry"])


CORPUS = ROOT / "tests" / "data" / "fuzzing"
"""Mutants that once failed, each in a folder, replayed by the tests and mutated further."""
