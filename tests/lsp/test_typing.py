"""Texts as they are while somebody types: whatever is asked of them, there is an answer."""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lsprotocol import types

from deros import codes
from deros.lsp.analysis import Analyses, Analysis
from deros.lsp.answers import ANSWERS
from deros.lsp.completion.complete import complete
from deros.lsp.places import Places, uri_of
from deros.metamodels.languages import language_of
from deros.metamodels.reading import MAX_DEPTH
from deros.metamodels.recovery.slots import Slots

EXAMPLES = sorted(
    str(path)
    for path in Path("examples").rglob("*")
    if language_of(path) is not None and "real" not in path.parts
)
PIECE = 250
"""So many characters are typed in one slow test, which takes less than half a minute."""

SMALL = [path for path in EXAMPLES if "/intelligent_one/" in path]


@dataclass
class Asked:
    """What the answers need of a server: here, only one file is open."""

    places = Places()

    def related(self, analysis: Analysis) -> list[Analysis]:
        """Return the analysis alone."""
        return [analysis]


def ask_everything(analysis: Analysis, offset: int, slots: Slots | None = None) -> None:
    """Ask all that an editor asks, at one place."""
    assert analysis.language is not None
    slots = slots or Slots(analysis.language)
    at = Asked.places.position(analysis.source, offset)
    here = types.TextDocumentIdentifier(uri_of(analysis.file.path))
    whole = types.Range(types.Position(0, 0), at)
    fields = {
        "text_document": here,
        "position": at,
        "range": whole,
        "context": types.CodeActionContext(diagnostics=[]),
    }
    complete(Asked.places, analysis, slots, analysis.source.text, at)
    for method, _, answer in ANSWERS:
        if method == types.TEXT_DOCUMENT_RENAME:
            continue  # refuses by an exception
        answer(Asked(), analysis, _Given(**fields))  # type: ignore[arg-type]


class _Given:
    """The parameters of any request."""

    def __init__(self, **fields: object) -> None:
        self.__dict__.update(fields)


def prefixes(path: str, lengths: range) -> Iterator[str]:
    """Yield the beginnings of a file, as it is typed."""
    text = Path(path).read_text(encoding="utf-8")
    yield from (text[:length] for length in lengths)


def size(path: str) -> int:
    """Return how many characters a file has."""
    return len(Path(path).read_text(encoding="utf-8"))


def type_file(path: str, lengths: range) -> None:
    """Ask everything while a piece of a file is typed."""
    analyses, language = Analyses(), language_of(path)
    assert language is not None
    slots = Slots(language)
    for text in prefixes(path, lengths):
        ask_everything(analyses.of(path, {path: text}), len(text), slots)


@pytest.mark.parametrize("path", SMALL)
def test_a_file_is_typed(path: str) -> None:
    """Each beginning of the text has findings, an outline and all else."""
    type_file(path, range(0, size(path) + 1, 23))


_DEEPEST = {
    ".deros": "input v = topic /x.data\nentity e { a: %s 1 > 0%s; }\n",
    ".system": "system S\nargument a : int\nnode n : x when %s a > 0%s\n",
}


@pytest.mark.parametrize("suffix", _DEEPEST)
def test_the_deepest_text_is_typed(suffix: str, tmp_path: Path) -> None:
    """A text may be nested as deeply as a file may, wherever the cursor is."""
    path = str(tmp_path / f"deep{suffix}")
    depth = MAX_DEPTH - 2
    text = _DEEPEST[suffix] % ("(" * depth, ")" * depth)
    analysis = Analyses().of(path, {path: text})
    assert codes.NESTED_TOO_DEEPLY not in {each.code for each in analysis.findings}
    assert analysis.language is not None
    slots = Slots(analysis.language)
    for offset in (text.rindex("("), text.index(")"), len(text)):
        ask_everything(analysis, offset, slots)


@pytest.mark.slow(seconds=20)
@pytest.mark.parametrize(
    ("path", "start"),
    [(path, start) for path in EXAMPLES for start in range(0, size(path) + 1, PIECE)],
)
def test_a_piece_of_a_file_is_typed(path: str, start: int) -> None:
    """The same after each character of small examples, and every third one of large ones."""
    every = 1 if path in SMALL else 3
    type_file(path, range(start, min(start + PIECE, size(path) + 1), every))


@pytest.mark.parametrize("path", [path for path in SMALL if not path.endswith(".rnd")])
@settings(max_examples=25)
@given(seed=st.integers(0, 2**32))
def test_random_edits_are_survived(path: str, seed: int) -> None:
    """Pieces are cut, doubled and moved, as an editor with a cat on it does."""
    drawn = random.Random(seed)
    text = Path(path).read_text(encoding="utf-8")
    analyses = Analyses()
    for _ in range(3):
        start = drawn.randrange(len(text))
        piece = text[start : start + drawn.randrange(1, 40)]
        text = text.replace(piece, drawn.choice(["", piece * 2, "}", "{", '"', "é🚀", "\n"]), 1)
        to = drawn.randrange(len(text) + 1)
        text = text[:to] + piece + text[to:]
        ask_everything(analyses.of(path, {path: text}), to)


def test_what_was_analysed_is_not_analysed_again() -> None:
    """The same text gives the same analysis; with other text, files that it imports are kept."""
    path = next(each for each in SMALL if each.endswith(".system"))
    text = Path(path).read_text(encoding="utf-8")
    analyses = Analyses()
    first = analyses.of(path, {path: text})
    assert analyses.of(path, {path: text}) is first
    other = analyses.of(path, {path: f"{text}\n// more"})
    imported = {id(each) for each in first.workspace.repository.files if each is not first.file}
    assert imported <= {id(each) for each in other.workspace.repository.files}


def test_a_file_that_changes_on_the_disk_is_read_again(tmp_path: Path) -> None:
    """So it is with files that appear."""
    system = str(tmp_path / "robot.system")
    text = 'system Robot\n\nimports\n  import "arm.rnd"\n\nnodes\n  node arm : Arm\n'
    analyses = Analyses()
    assert "there is no file 'arm.rnd'" in messages(analyses.of(system, {system: text}))
    arm = tmp_path / "arm.rnd"
    arm.write_text("node Arm : arm_pkg\n\npublishes\n  topic /joints : std_msgs.Bool\n")
    assert "there is no file 'arm.rnd'" not in messages(analyses.of(system, {system: text}))
    arm.write_text("node Hand : arm_pkg\n")
    assert any("'Arm'" in each for each in messages(analyses.of(system, {system: text})))


def messages(analysis: Analysis) -> list[str]:
    """Return what the findings say."""
    return [each.message for each in analysis.findings]
