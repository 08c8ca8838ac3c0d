"""Files of other tools: what they become, and faults to put into them."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Callable, Collection, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from hypothesis import strategies as st

from deros.diagnostics import Diagnostic
from deros.generators.output.writer import write
from deros.importers.kept.files import renewed
from deros.importers.kinds import KINDS, kinds_of
from deros.importers.readers import Request, UnreadableError
from deros.metamodels.load import Repository
from deros.models.node import NodeType
from tests.support.checks import checked
from tests.support.rules import embedded_store


class Become(NamedTuple):
    """What files became.

    Attributes:
        paths: of the models, the one to check first at the start.
        missing: the lines that say what is in none of them, without the folder of the files.
        findings: of checking the first one.
    """

    paths: tuple[Path, ...]
    missing: tuple[str, ...]
    findings: list[Diagnostic]

    @property
    def node(self) -> NodeType:
        """The node of the first model."""
        model = Repository().load(self.paths[0]).model
        assert isinstance(model, NodeType)
        return model


def become(*files: Path, word: str | None = None, name: str | None = None) -> Become:
    """Import files of one kind into a folder beside them, and check the first model.

    Args:
        files: what to import.
        word: their kind; ``None`` if it shows.
        name: of the system.
    """
    kind = next((each for each in KINDS if each.word == word), None) or next(kinds_of(files))
    assert kind is not None, files
    output = files[0].parent / "models"
    store = embedded_store()
    imported = kind.read(Request(files, name, output, store.exists, store))
    write(renewed(imported.files, output).files, output)
    paths = tuple(output / path for path in imported.files)
    prefix = f"{files[0].parent}/"
    missing = tuple(each.replace(prefix, "") for each in imported.missing)
    return Become(paths, missing, checked(paths[0]) if paths else [])


def survived(
    data: bytes,
    name: str,
    word: str | None = None,
    beside: Mapping[str, str] | None = None,
    allowed: Collection[str] = (),
) -> bool:
    """Return whether a file became models; they have to check clean, and an error to name it.

    Args:
        data: what is in the file.
        name: of the file.
        word: its kind; ``None`` if it shows.
        beside: the texts of files that are imported with it, by name.
        allowed: codes of findings that the contents of a file may deserve.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / name
        path.write_bytes(data)
        list(kinds_of([path]))
        others = [Path(folder) / each for each in beside or ()]
        for other, text in zip(others, (beside or {}).values(), strict=True):
            other.write_text(text, encoding="utf-8")
        try:
            made = become(path, *others, word=word)
        except UnreadableError as error:
            if str(path) not in str(error):
                raise
            return False
        assert [each for each in made.findings if each.code.name not in allowed] == []
        return True


ODD = (
    "",
    "~",
    "yes",
    "-1",
    "1e400",
    "9" * 400,
    "-9223372036854775809",
    ".nan",
    "-.inf",
    "''",
    '"\\u0007\\u2028"',
    "[]",
    "[[1], {a: b}]",
    "{}",
    "{type: int}",
    "*nowhere",
    "&a [*a]",
    "!!python/name:os.system",
    "2020-01-01",
    "node",
    "a b",
    "::",
    "->",
    "<x>",
    "ä",
    "x" * 300,
)
"""Values that stand where nobody expects them."""

_VALUE = re.compile(r"(?<=[:\-\[,] )[^\s\[\]{},][^\n,\]}]*|(?<=: )\[[^\n]*")


def damaged(text: str) -> st.SearchStrategy[bytes]:
    """Return the text with one to four faults: cut, lines swapped or moved, values that are odd."""
    fault = st.sampled_from([_cut, _swapped, _indented, _odd, _odd, _odd, _repeated, _bytes])
    drawn = st.tuples(fault, st.integers(0, 10**6), st.integers(0, 10**6))
    return st.lists(drawn, min_size=1, max_size=4).map(lambda faults: _with(text, faults))


_Fault = Callable[[bytes, int, int], bytes]


def _with(text: str, faults: Sequence[tuple[_Fault, int, int]]) -> bytes:
    data = text.encode()
    for fault, first, second in faults:
        data = fault(data, first, second)
    return data


def _cut(data: bytes, first: int, second: int) -> bytes:
    start = first % (len(data) + 1)
    return data[:start] + data[start + second % 40 :]


def _lines(data: bytes) -> list[bytes]:
    return data.split(b"\n")


def _swapped(data: bytes, first: int, second: int) -> bytes:
    lines = _lines(data)
    one, other = first % len(lines), second % len(lines)
    lines[one], lines[other] = lines[other], lines[one]
    return b"\n".join(lines)


def _indented(data: bytes, first: int, second: int) -> bytes:
    lines = _lines(data)
    at = first % len(lines)
    lines[at] = b" " * (second % 8) + lines[at].lstrip()
    return b"\n".join(lines)


def _repeated(data: bytes, first: int, second: int) -> bytes:
    lines = _lines(data)
    start = first % len(lines)
    chunk = lines[start : start + 1 + second % 4]
    return b"\n".join([*lines[:start], *chunk, *lines[start:]])


def _odd(data: bytes, first: int, second: int) -> bytes:
    text = data.decode(errors="replace")
    places = list(_VALUE.finditer(text))
    if not places:
        return data
    place = places[first % len(places)]
    return (text[: place.start()] + ODD[second % len(ODD)] + text[place.end() :]).encode()


def _bytes(data: bytes, first: int, second: int) -> bytes:
    start = first % (len(data) + 1)
    return data[:start] + bytes([second % 256]) + data[start:]
