"""One mistake gives one finding: consequences of a finding are not reported."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from deros import codes
from deros.diagnostics import Diagnostic, Severity
from deros.interfaces.store import InterfaceStore
from tests.support.checks import checked

EXAMPLE = Path(__file__).parents[3] / "examples" / "intelligent_one"
FILES = {path.name: path.read_text(encoding="utf-8") for path in sorted(EXAMPLE.glob("*.*[dsm]"))}
MODELS = {name: text for name, text in FILES.items() if not name.endswith(".md")}
NAMED = ("intelligent_one.system", "intelligent_one.deros")
_TOKEN = re.compile(r'"[^"\n]*"|//[^\n]*|/\*.*?\*/|[\w.]+|[^\s\w]', re.DOTALL)
_EVERY = 17


def _findings(folder: Path, changed: str, text: str) -> list[Diagnostic]:
    named = (folder / name for name in NAMED)
    findings = checked(*named, texts={folder / changed: text}, store=InterfaceStore(()))
    return [each for each in findings if each.severity is not Severity.INFO]


def _with_errors(text: str) -> list[tuple[int, str]]:
    """Return copies of the text with an invalid character before every n-th token."""
    starts = [each.start() for each in _TOKEN.finditer(text) if each[0][:2] not in ("//", "/*")]
    return [(at, f"{text[:at]}? {text[at:]}") for at in starts[::_EVERY]]


@pytest.mark.parametrize("name", MODELS)
def test_syntax_error_anywhere_gives_one_finding(name: str) -> None:
    """A syntax error anywhere in a sound project of seven files gives one finding, at its place."""
    for at, text in _with_errors(MODELS[name]):
        findings = _findings(EXAMPLE, name, text)
        places = [(each.code.name, each.span.file.rsplit("/", 1)[-1]) for each in findings]
        assert places == [("DRS003", name)], (text[max(0, at - 30) : at + 30], findings)


@pytest.mark.parametrize(
    ("name", "old", "new", "code"),
    [
        ("marking_robot.rnd", "nav_msgs.Odometry", "nav_msgs.Odometri", codes.UNKNOWN_TYPE),
        ("marking_robot.rnd", "nav_msgs.Odometry", "nav2_mgs.Odometry", codes.UNKNOWN_PACKAGE),
        ("intelligent_one.system", '"*.rnd"', '"nodes/*.rnd"', codes.UNKNOWN_IMPORT),
        ("intelligent_one.deros", '"intelligent_one.system"', '"inteligent.system"',
         codes.UNKNOWN_IMPORT),
        ("intelligent_one.system", "to /imu", "to /imo", codes.UNKNOWN_TOPIC),
        ("intelligent_one.system", "connect imu", "connect imo", codes.UNKNOWN_PORT),
        ("intelligent_one.system", ": marking_robot", ": marking_robott", codes.UNKNOWN_NODE_TYPE),
    ],
)  # fmt: skip
def test_unknown_name_gives_one_finding(name: str, old: str, new: str, code: object) -> None:
    """A typo in a type, import, topic, port or node type is reported once, at its place."""
    text = MODELS[name]
    assert old in text
    findings = _findings(EXAMPLE, name, text.replace(old, new, 1))
    assert [each.code for each in findings] == [code], findings


def test_gate_declared_twice_gives_one_finding() -> None:
    """Two gates to one topic are not also two nodes of one name that bypass each other."""
    text = MODELS["intelligent_one.deros"]
    twice = f"{text}\n{text[text.index('gate ') :]}"
    findings = _findings(EXAMPLE, "intelligent_one.deros", twice)
    assert [each.code for each in findings] == [codes.DUPLICATE_RULE_NAME], findings


@pytest.mark.parametrize(
    ("topics", "found", "hint"),
    [
        ("topic /t", codes.RULE_TOPIC_NOT_PUBLISHED, "'external topic /t : PACKAGE.TYPE'"),
        ("topic /t : std_msgs.Bool", codes.RULE_TOPIC_NOT_PUBLISHED, "'external topic /t'"),
        ("external topic /t", codes.RULE_TYPE_UNKNOWN, "'topic /t : PACKAGE.TYPE'"),
    ],
)
def test_topic_without_publisher_and_type_gives_one_finding(
    topics: str, found: object, hint: str, tmp_path: Path
) -> None:
    """The missing publisher would have told the type."""
    rules = (
        'use "s.system" import S action stop; input t = topic /t.data timeout 1 sec'
        " entity e { failsafe r: t; } if e.r then { stop; };"
    )
    (tmp_path / "s.system").write_text(f"system S topics {topics}", encoding="utf-8")
    findings = checked(tmp_path / "r.deros", texts={tmp_path / "r.deros": rules})
    assert [(each.code, hint in each.hint) for each in findings] == [(found, True)], findings
