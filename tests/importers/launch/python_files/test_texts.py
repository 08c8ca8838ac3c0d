"""Texts that the process writes are read as what they were made of."""

from __future__ import annotations

import shlex
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deros.importers.launch.python_files.visit import texts
from deros.importers.launch.python_files.visit.texts import Call, Pieces, text, words
from deros.importers.launch.values.substitutions import Substitution, pieces_of

CHARACTERS = st.text(st.sampled_from("ab \t\n'\"\\$()/:{}[]\u00e9") | st.characters(codec="utf-8"))
NAMES = st.sampled_from(["var", "find-pkg-share", "if", "ReplaceString"])
CALLS = st.recursive(
    NAMES.map(Call),
    lambda inner: st.builds(
        Call, NAMES, st.lists(st.lists(CHARACTERS | inner, max_size=3).map(tuple)).map(tuple)
    ),
    max_leaves=6,
)


def read(found: Pieces) -> tuple[object, ...]:
    """Return what pieces are read as, in which no two texts are neighbours."""
    merged: list[object] = []
    for each in found:
        if isinstance(each, Call):
            merged.append(Substitution(each.name, tuple(map(read, each.operands))))  # type: ignore[arg-type]
        elif each and merged and isinstance(merged[-1], str):
            merged[-1] += each
        elif each:
            merged.append(each)
    return tuple(merged)


@given(found=st.lists(CHARACTERS | CALLS, max_size=4))
def test_texts_and_substitutions_are_read_as_they_are(found: list[str | Call]) -> None:
    """Whatever characters are in them, at any depth."""
    assert pieces_of(text(found)) == read(tuple(found))


@given(found=st.lists(CHARACTERS, min_size=1, max_size=4))
def test_words_of_a_command_line_stay_as_they_are(found: list[str]) -> None:
    """A word is one word, though there are blanks and quotes in it."""
    read_again = pieces_of(words(found))
    assert all(isinstance(each, str) for each in read_again)
    assert shlex.split("".join(map(str, read_again))) == found


def test_folders_of_packages_are_not_those_of_this_machine(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A path in one becomes the call that finds it anywhere; a path that begins alike does not."""
    share, own = tmp_path / "share" / "maps", tmp_path / "launch"
    own.mkdir()
    (own / "a.yaml").touch()
    places = {str(share): Call("find-pkg-share", (("maps",),)), str(own): Call("dirname")}
    monkeypatch.setattr(texts, "PLACES", places)
    assert text(share / "world.yaml") == "$(find-pkg-share maps)/world.yaml"
    assert text(f"file://{share}") == "file://$(find-pkg-share maps)"
    assert text(f"{share}2/world.yaml") == f"{share}2/world.yaml"
    assert text(own / "a.yaml") == "$(dirname)/a.yaml"
    assert text(own / "not_there.yaml") == f"{own}/not_there.yaml"
