"""Hints that ask which name was meant carry an edit for each, and it mends what they are about.

Every finding of the cases whose hint asks is tried: each of its edits goes into the text of the
file, and the case is checked again with that text in place of the one on the disk.
"""

from __future__ import annotations

from collections import Counter

import pytest

from deros.diagnostics import Diagnostic, Fix, NearMiss, SourceFile, Span
from deros.interfaces.files import unsaved
from deros.names.names import did_you_mean
from tests.support import cases

ASKS = "did you mean"
WITHOUT_EDIT = {"DRS260": "the key of a parameter file is a name together with keys around it"}
ALL_CASES = [*cases.all_cases(), *cases.robots()]


def _asks(finding: Diagnostic) -> bool:
    return ASKS in finding.hint


def _has_no_edit(finding: Diagnostic) -> bool:
    """Return whether what is written is not the name: it has arguments in it, or keys around it."""
    return finding.code.name in WITHOUT_EDIT or "${" in finding.span.text


def _kind(finding: Diagnostic) -> tuple[str, str, str]:
    return finding.span.file, finding.code.name, finding.message


def _counted(findings: list[Diagnostic]) -> Counter[tuple[str, str, str]]:
    return Counter(map(_kind, findings))


def _mended(fix: Fix) -> str:
    text = fix.span.source.text
    return f"{text[: fix.span.start]}{fix.text}{text[fix.span.end :]}"


def _found_after(name: str, fix: Fix) -> list[Diagnostic]:
    path = (cases.DIRECTORY / fix.span.file).resolve()
    with unsaved({str(path): _mended(fix).encode()}):
        return cases.run(name)[0]


@pytest.mark.parametrize("name", ALL_CASES)
def test_each_edit_removes_its_finding(name: str) -> None:
    """An edit at a wrong place, or without the words around the name, would leave the finding.

    None is certain, as tools apply ``fix`` unasked; but the parser tries keywords.
    """
    found, _ = cases.run(name)
    before = _counted(found)
    for each in filter(_asks, found):
        assert each.fix is None or each.code.name == "DRS003", _kind(each)
        assert bool(each.choices) != _has_no_edit(each), (_kind(each), each.hint, each.span.text)
        for fix in each.choices:
            after = _counted(_found_after(name, fix))
            assert after[_kind(each)] < before[_kind(each)], (_kind(each), fix)


def test_many_cases_ask() -> None:
    """The test above is about something."""
    models = (each for each in cases.DIRECTORY.glob("*.*") if each.is_file())
    asking = [each for each in models if ASKS in each.read_text("utf-8", "replace")]
    assert len(asking) > 50


def _edits(hint: str, place: str) -> list[str]:
    """Return the texts that come of the edits of a hint, at a place inside a longer text."""
    assert isinstance(hint, NearMiss)
    source = SourceFile("robot.system", f"<{place}>")
    return [_mended(fix) for fix in hint.edits(Span(source, 1, 1 + len(place)))]


@pytest.mark.parametrize(
    ("hint", "place", "mended"),
    [
        (did_you_mean(["left"]), "lfet", ["<left>"]),
        (did_you_mean(["left", "lift"]), "lfet", ["<left>", "<lift>"]),
        (did_you_mean(["a/b.rnd"]), '"a/c.rnd"', ['<"a/b.rnd">']),
        (did_you_mean(["b.rnd"], "c.rnd"), '"a/c.rnd"', ['<"a/b.rnd">']),
        (did_you_mean(["Bool"], "Bol"), "std_msgs.Bol", ["<std_msgs.Bool>"]),
        (did_you_mean(["/scan"], "sacn", "/sacn"), "sacn", ["<scan>"]),
        (did_you_mean(["/scan"], "/sacn", "/sacn"), "/sacn", ["</scan>"]),
        (did_you_mean(["/a/scan", "/scan"], "sacn", "/a/sacn"), "sacn", ["<scan>", "</scan>"]),
        (did_you_mean(["/n/scan"], "~/sacn", "/n/sacn"), "~/sacn", ["</n/scan>"]),
        # What is no plain place of the name, or is it twice, is left to people.
        (did_you_mean(["left"]), "connect lfet", []),
        (did_you_mean(["left"]), "", []),
        (did_you_mean(["b"], "a"), "a.a", []),
        (did_you_mean(["b"], "a"), "ab", []),
        (did_you_mean(["husky.yaml"], "of_husky.yaml"), '"of_${robot}.yaml"', []),
        (did_you_mean(["left"]), "left", []),
    ],
)
def test_edits_are_at_the_name(hint: str, place: str, mended: list[str]) -> None:
    """Only the name changes; full names stay relative where they have been written so."""
    assert _edits(hint, place) == mended


def test_what_is_said_besides_makes_a_plain_hint() -> None:
    """A hint that says more than the question may ask for something else."""
    assert not isinstance(f"{did_you_mean(['left'])} Or declare it.", NearMiss)
    assert did_you_mean([]) == ""
