"""Names of inputs, constants and entities that are words of the language."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from deros.diagnostics import Diagnostic, Severity
from deros.metamodels import grammar
from tests.support.checks import checked_rules

HEAD = 'use "robot.system" import Robot\naction stop;\n'
SYSTEM = "system Robot topics external topic /t : std_msgs.Float64 { data [m] }"
GRAMMAR = Path(grammar.__file__).with_name("deros.tx").read_text(encoding="utf-8")
KEYWORDS = re.search(r"TermName: /\(\?!\(\?:([a-z|]+)\)", GRAMMAR)


def found(text: str, folder: Path) -> list[Diagnostic]:
    """Return the findings of a program."""
    return checked_rules(HEAD + text, SYSTEM, folder)


@pytest.mark.parametrize("word", KEYWORDS[1].split("|") if KEYWORDS is not None else [])
@pytest.mark.parametrize(
    "declared",
    [
        "input {} = topic /t.data timeout 1 sec",
        "const {} = 1 m",
        "entity {} {{ r: topic /t.data > 1; }}",
    ],
)
def test_keyword_is_refused_where_it_is_declared(word: str, declared: str, tmp_path: Path) -> None:
    """No condition can read what is called so; a use of it would be a riddle."""
    findings = found(declared.format(word), tmp_path)
    refused = [each for each in findings if each.severity is Severity.ERROR]
    assert [(each.code.name, each.span.text) for each in refused] == [("DRS332", word)]
    assert refused[0].hint == f"call it '{word}_' or the like"


@pytest.mark.parametrize("word", ["h", "s", "min", "input", "timeout", "since", "within", "topic"])
def test_other_words_are_names(word: str, tmp_path: Path) -> None:
    """A unit or a word of the language is a name where nothing else can be meant."""
    text = (
        f"input {word} = topic /t.data timeout 1 sec entity e {{ r: {word} > 2; s: 2 < {word};"
        f" lost: {word}.unknown(); }} if e.r or e.s or e.lost then {{ stop; }};"
    )
    assert found(text, tmp_path) == []


def test_unit_after_a_number_is_a_unit(tmp_path: Path) -> None:
    """Beside an input ``h``, ``2 h`` is two hours: of a distance that is an error, and says so."""
    text = (
        "input h = topic /t.data timeout 1 sec entity e { failsafe r: h > 2 h; }"
        " if e.r then { stop; };"
    )
    (finding,) = found(text, tmp_path)
    assert finding.message == "'2 h' is in h (time), m (length) is needed"
