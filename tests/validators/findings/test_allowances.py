"""Allowance comments in a model: which findings they suppress, and findings about the comments."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from deros import codes
from deros.codes import ALL_CODES
from deros.diagnostics import SourceFile, Span, report
from deros.validators.findings.allowances import read_allowances
from deros.validators.findings.allowed import ProjectAllowance
from tests.support.cli import deros

pytestmark = pytest.mark.usefixtures("own_folder")

MODELS = {
    "units.rnd": (
        "node units : demo\npublishes\n  {before}\n"
        "  topic imu : sensor_msgs.Imu {{ angular_velocity.x [m] }}{same}\n",
        "DRS111",
    ),
    "lone.system": ("system Lone\ntopics\n  {before}\n  topic /odom{same}\n", "DRS212"),
    "rules.deros": (
        "{before}\nconst unused = 1{same}\n",
        "DRS313",
    ),
}


def _codes(*arguments: str) -> list[str]:
    return [d["code"] for d in json.loads(deros("check", "--format", "json", *arguments).out)]


def _write(name: str, before: str = "", same: str = "") -> str:
    text, code = MODELS[name]
    Path(name).write_text(text.format(before=before, same=same))
    return code


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize(
    ("before", "same"),
    [
        ("", "  // deros: allow {code} known"),
        ("", "  /* deros: allow {code} known */"),
        ("// deros: allow {code} known", ""),
        ("//deros:allow {code}: known\n\n// and a remark", ""),
        ("/* deros: allow {code}\n   known for long\n*/", ""),
        ("// deros: allow {code}, DRS211 known", ""),
        ("// deros: allow {slug} known", ""),
        ("// deros: allow no-subscriber, {slug} known", ""),
        ("", "  // deros: allow {slug}: known"),
    ],
)
def test_allowance_comment_suppresses_finding(name: str, before: str, same: str) -> None:
    """A comment on the same line or alone above it suppresses the finding, in each language."""
    code = _write(name)
    assert code in _codes(name)
    slug = ALL_CODES[code].slug
    _write(name, before.format(code=code, slug=slug), same.format(code=code, slug=slug))
    assert code not in _codes(name)


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize(
    "before",
    [
        "// deros: allow {code} known\n  /* another */ // line",
        "/* // deros: allow {code} in a comment that does not begin so */",
        "// see deros: allow {code} known",
    ],
)
def test_allowance_must_begin_the_comment(name: str, before: str) -> None:
    """The words have no effect elsewhere in a comment; comments in between do not matter."""
    code = _write(name, before.format(code="DRS222"))
    assert code in _codes(name)


def test_quoted_text_is_not_an_allowance() -> None:
    """Text inside a string literal of the model does not count as a comment."""
    Path("text.system").write_text(
        'system Text "// deros: allow DRS212"\ntopics\n  topic /a "// deros: allow DRS212 x"\n'
    )
    assert _codes("text.system") == ["DRS212"]


def test_errors_cannot_be_allowed() -> None:
    """The error is still reported, and the allowance is a finding as well."""
    Path("bad.rnd").write_text(
        "node bad : demo\nparameters\n  name a : int = 0.5  // deros: allow DRS103 known\n"
    )
    assert _codes("bad.rnd") == ["DRS103", "DRS021"]
    assert deros("check", "bad.rnd").code == 1


@pytest.mark.parametrize(
    ("written", "hint"),
    [
        ("unused-topik", "did you mean 'unused-topic'"),
        ("no-publisher, unused-topik", "did you mean 'unused-topic'"),
        ("unused_topic", "write 'unused-topic'"),
        ("drs212", "write 'DRS212'"),
    ],
)
def test_mistyped_code_gets_suggestions(written: str, hint: str) -> None:
    """A word similar to a code or slug is reported with that code or slug."""
    _write("lone.system", f"// deros: allow {written} known")
    listed = json.loads(deros("check", "--format", "json", "lone.system").out)
    hints = [each["hint"] for each in listed if each["code"] == "DRS021"]
    assert any(each.startswith(hint) for each in hints), listed


def test_reason_may_begin_with_a_slug() -> None:
    """Without a comma, a slug behind a code belongs to the reason."""
    code = _write("lone.system", "// deros: allow DRS212 unused-import is the reason")
    assert code not in _codes("lone.system")


def test_unneeded_allowance_is_reported_for_named_files_only() -> None:
    """A finding of an imported file may disappear when a larger system imports it."""
    Path("source.rnd").write_text("node source : demo\npublishes\n  topic out : std_msgs.Bool\n")
    Path("sink.rnd").write_text("node sink : demo\nsubscribes\n  topic in : std_msgs.Bool\n")
    Path("part.system").write_text(
        'system Part\nimports import "sink.rnd"\ntopics\n'
        "  topic /x  // deros: allow DRS210 fed by the whole\n"
        "node sink : sink wirings connect in to /x\n"
    )
    Path("whole.system").write_text(
        'system Whole\nimports import "part.system" import "source.rnd"\ntopics topic /x\n'
        "subsystem part : Part\nnode source : source wirings connect out to /x\n"
    )
    assert _codes("part.system") == []
    assert _codes("whole.system") == []
    assert _codes("whole.system", "part.system") == []
    Path("sink.rnd").write_text("node sink : demo\npublishes\n  topic in : std_msgs.Bool\n")
    assert "DRS022" in _codes("part.system")


def test_allowance_is_not_called_unneeded_after_an_error() -> None:
    """Some checks do not run after an error, so their findings may come back."""
    Path("bad.system").write_text(
        'system Bad\nimports import "nowhere.rnd"\ntopics\n'
        "  topic /x  // deros: allow DRS210 fed by hand\nnode a : b wirings connect i to /x\n"
    )
    assert "DRS022" not in _codes("bad.system")


def test_allowed_findings_are_counted_and_shown_on_request() -> None:
    """The summary counts them; ``--show-allowed`` lists finding and reason, in text and JSON."""
    _write("lone.system", same="  // deros: allow DRS212 filled by hand")
    brief = deros("check", "--strict", "lone.system")
    assert (brief.code, brief.out) == (0, "1 file checked, no findings, 1 allowed\n")
    shown = deros("check", "--strict", "--show-allowed", "lone.system")
    assert shown.code == 0
    assert "warning[DRS212 unused-topic]" in shown.out
    assert "    = allowed at lone.system:4:32: filled by hand\n" in shown.out
    listed = json.loads(deros("check", "--show-allowed", "--format", "json", "lone.system").out)
    assert [(each["code"], each["allowed"]) for each in listed] == [("DRS212", "filled by hand")]


def test_sarif_marks_allowed_findings_as_suppressed() -> None:
    """The ``suppressions`` of a result give place and reason (SARIF 2.1.0, 3.27.23 and 3.35)."""
    _write("lone.system", same="  // deros: allow DRS212 filled by hand")
    log = json.loads(deros("check", "--format", "sarif", "lone.system").out)
    (result,) = log["runs"][0]["results"]
    (suppression,) = result["suppressions"]
    assert (suppression["kind"], suppression["justification"]) == ("inSource", "filled by hand")
    assert suppression["location"]["physicalLocation"]["region"]["startLine"] == 4


def test_github_format_omits_allowed_findings() -> None:
    """There is no annotation for an allowed finding."""
    _write("lone.system", same="  // deros: allow DRS212 filled by hand")
    assert deros("check", "--format", "github", "lone.system").out == ""


def test_generate_respects_allowances() -> None:
    """Commands that check before they work do not print allowed findings."""
    for same, shown in (("", True), ("  // deros: allow DRS212 filled by hand", False)):
        _write("lone.system", same=same)
        outcome = deros("generate", "lone.system", "--target", "launch", "-o", "out")
        assert outcome.code == 0
        assert ("DRS212" in outcome.err) is shown


@pytest.mark.parametrize(
    ("pattern", "matches"),
    [("a/*.system", True), ("**", True), ("**/x.system", True), ("a", False), ("*", False)],
)
def test_project_allowance_covers_matching_paths(
    tmp_path: Path, pattern: str, matches: bool
) -> None:
    """Patterns are relative to the project; ``**`` matches any number of folders."""
    source = SourceFile("a/x.system", "topic")
    finding = report(codes.UNUSED_TOPIC, "unused", Span(source, 0, 5))
    span = Span(SourceFile("deros.toml", ""), 0, 0)
    allowance = ProjectAllowance("DRS212", pattern, "known", tmp_path, span)
    assert allowance.covers(finding) is matches


def test_comments_without_allowances_are_skipped() -> None:
    """Only comments addressed to deros are parsed."""
    source = SourceFile("x.rnd", "// a comment\n" * 10)
    assert read_allowances(source) == ([], [])
