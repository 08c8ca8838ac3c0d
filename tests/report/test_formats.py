"""The same findings as text, JSON, SARIF and GitHub annotations."""

from __future__ import annotations

import io
import json
from dataclasses import replace

import pytest

from deros import codes
from deros.diagnostics import Diagnostic, Fix, Related, SourceFile, Span, report
from deros.report import formats
from deros.report import text as render

SOURCE = SourceFile("models/a b.system", "system Demo\n\tnode café : bäse, 100%\n")


def _span(word: str) -> Span:
    start = SOURCE.text.index(word)
    return Span(SOURCE, start, start + len(word))


FINDING = report(
    codes.UNKNOWN_NODE_TYPE,
    "no import defines 'bäse'",
    _span("bäse"),
    hint="did you mean 'base'?",
    related=(Related(_span("Demo"), "in this system"),),
)
WARNING = replace(
    report(codes.UNUSED_TOPIC, "", _span("café")), message="100% unused,\nreally: yes"
)


def test_text_shows_line_caret_hint_and_related_places() -> None:
    """The caret is under the word, after a tab as in the line itself."""
    assert render.render_text([FINDING]) == (
        "models/a b.system:2:14: error[DRS203 unknown-node-type]: no import defines 'bäse'\n"
        "    2 | \tnode café : bäse, 100%\n"
        "      | \t            ^^^^\n"
        "    = hint: did you mean 'base'?\n"
        "    = models/a b.system:1:8: in this system\n"
    )


def test_control_characters_are_replaced() -> None:
    """Control characters of a model do not reach the terminal."""
    source = SourceFile("x\x1b.rnd", "node \x1b[31m\x07 : x\n")
    text = render.render_text([report(codes.SYNTAX_ERROR, "found '\x1b'", Span(source, 5, 6))])
    assert "\x1b" not in text
    assert "\x07" not in text


def test_long_lines_are_cut_around_the_span() -> None:
    """Of a line of a megabyte, the relevant 160 characters are shown, with a matching caret."""
    source = SourceFile("x.rnd", "a" * 500_000 + "B" + "c" * 500_000)
    lines = render.render_text(
        [report(codes.SYNTAX_ERROR, "here", Span(source, 500_000, 500_001))]
    ).splitlines()
    assert max(map(len, lines)) < 200
    assert lines[1][lines[2].index("^")] == "B"


def test_wide_characters_move_the_caret() -> None:
    """A character that is two columns wide moves the caret by two."""
    source = SourceFile("x.rnd", "名前 x")
    line, caret = render.render_text(
        [report(codes.SYNTAX_ERROR, "here", Span(source, 3, 4))]
    ).splitlines()[1:3]
    assert line.index("x") + 2 == caret.index("^")


class _Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_colours_are_used_only_on_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pipes and terminals with NO_COLOR get plain text."""
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("TERM", "xterm-256color")
    plain, terminal, asked = io.StringIO(), _Terminal(), _Terminal()
    render.print_text([FINDING], plain)
    render.print_text([FINDING], terminal)
    monkeypatch.setenv("NO_COLOR", "1")
    render.print_text([FINDING], asked)
    assert plain.getvalue() == asked.getvalue() == render.render_text([FINDING])
    assert "\x1b[1;31merror[DRS203 unknown-node-type]" in terminal.getvalue()


def test_json_objects_have_exactly_the_documented_keys() -> None:
    """The output is an array of flat objects; a missing hint is an empty string."""
    first, second = json.loads(formats.render_json([FINDING, WARNING]))
    assert first == {
        "file": "models/a b.system",
        "line": 2,
        "column": 14,
        "end_line": 2,
        "end_column": 18,
        "severity": "error",
        "code": "DRS203",
        "slug": "unknown-node-type",
        "message": "no import defines 'bäse'",
        "hint": "did you mean 'base'?",
        "fix": None,
    }
    assert (second["severity"], second["hint"]) == ("warning", "")
    assert json.loads(formats.render_json([])) == []


def test_sarif_refers_to_rules_by_index() -> None:
    """Each result has its rule, level and place; paths are URIs; related places are kept."""
    log = json.loads(formats.render_sarif([FINDING, WARNING, FINDING]))
    assert log["version"] == "2.1.0"
    (run,) = log["runs"]
    rules = run["tool"]["driver"]["rules"]
    assert [(rule["id"], rule["name"]) for rule in rules] == [
        ("DRS203", "unknown-node-type"),
        ("DRS212", "unused-topic"),
    ]
    for result in run["results"]:
        assert rules[result["ruleIndex"]]["id"] == result["ruleId"]
    first, second, _ = run["results"]
    assert (first["level"], second["level"]) == ("error", "warning")
    place = first["locations"][0]["physicalLocation"]
    assert place["artifactLocation"]["uri"] == "models/a%20b.system"
    assert place["region"] == {"startLine": 2, "startColumn": 14, "endLine": 2, "endColumn": 18}
    assert first["relatedLocations"][0]["message"]["text"] == "in this system"
    assert "relatedLocations" not in second


def test_github_annotations_are_escaped() -> None:
    """Each finding is one command on one line, whatever the message contains."""
    error, warning = formats.render_github([FINDING, WARNING]).splitlines()
    assert error.startswith("::error file=models/a b.system,line=2,col=14,endLine=2,endColumn=18,")
    assert error.endswith("::no import defines 'bäse'%0Adid you mean 'base'?")
    assert "title=DRS203 unknown-node-type::" in error
    assert warning.startswith("::warning ")
    assert warning.endswith("::100%25 unused, really: yes")


@pytest.mark.parametrize(
    ("findings", "expected"),
    [
        ([], "3 files checked, no findings"),
        ([FINDING], "1 error in 3 files"),
        ([WARNING, FINDING, WARNING], "1 error and 2 warnings in 3 files"),
    ],
)
def test_summary_counts_findings(findings: list[Diagnostic], expected: str) -> None:
    """The last line counts findings by severity, highest first."""
    assert render.summary(findings, 3) == expected


def test_fix_is_a_machine_readable_edit() -> None:
    """JSON and SARIF contain place and new text of a fix; text shows only the hint."""
    fix = Fix(_span("bäse"), "base")
    hint = "did you mean 'base'?"
    finding = report(codes.UNKNOWN_NODE_TYPE, "unknown", _span("bäse"), hint, fix=fix)
    (found,) = json.loads(formats.render_json([finding]))
    assert found["fix"] == {
        "line": 2,
        "column": 14,
        "end_line": 2,
        "end_column": 18,
        "text": "base",
    }
    (result,) = json.loads(formats.render_sarif([finding]))["runs"][0]["results"]
    (edit,) = result["fixes"]
    assert edit["description"] == {"text": hint}
    (change,) = edit["artifactChanges"]
    assert change["artifactLocation"] == {"uri": "models/a%20b.system"}
    (replacement,) = change["replacements"]
    assert replacement["insertedContent"] == {"text": "base"}
    assert replacement["deletedRegion"] == {
        "startLine": 2,
        "startColumn": 14,
        "endLine": 2,
        "endColumn": 18,
    }
