"""``deros verify``: what is refused before a graph is read, and the report of an empty one."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.support.cli import deros
from tests.support.shell import deros_at

NODE = "node talker : demo\nparameters\n  name rate : double = 1.0\n"
SYSTEM = """\
system Demo
argument robot : string = "front" one_of ["front", "rear"]
argument second : bool = false
argument maps : string = env("DEROS_TEST_MAPS", "none")
imports import "talker.rnd"
node talker : talker namespace $robot env MAPS = $maps
node other : talker when second
"""


@pytest.fixture
def model(tmp_path: Path) -> Path:
    """Return a system with arguments."""
    (tmp_path / "talker.rnd").write_text(NODE, encoding="utf-8")
    path = tmp_path / "demo.system"
    path.write_text(SYSTEM, encoding="utf-8")
    return path


def test_it_says_what_it_compares_with(model: Path) -> None:
    """A recording, or something else, may come later."""
    outcome = deros("verify", model)
    assert outcome.code == 2
    assert "--live" in outcome.err


@pytest.mark.parametrize(
    ("argument", "why"),
    [
        ("robot:=left", "'robot': left is not one of front, rear"),
        ("second:=2", "'second': '2' is not true or false"),
        ("third:=1", "the system has no argument 'third'; its arguments: robot, second, maps"),
    ],
)
def test_wrong_argument_is_refused(model: Path, argument: str, why: str) -> None:
    """As 'deros up' refuses it."""
    outcome = deros("verify", "--live", model, argument)
    assert outcome.code == 2
    assert why in outcome.err


def test_model_with_errors_is_not_compared(model: Path) -> None:
    """They are shown."""
    model.write_text(SYSTEM.replace(": talker when", ": walker when"), encoding="utf-8")
    outcome = deros("verify", "--live", model)
    assert (outcome.code, outcome.out) == (1, "")
    assert "walker" in outcome.err


def test_model_of_another_language_is_refused(model: Path) -> None:
    """A node description says nothing of a graph."""
    outcome = deros("verify", "--live", model.with_name("talker.rnd"))
    assert outcome.code == 2
    assert "*.system" in outcome.err


@pytest.mark.ros
def test_arguments_choose_what_has_to_run(ros_env: dict[str, str], model: Path) -> None:
    """In an empty domain all of it is missing."""
    arguments = ("verify", "--timeout", "1", "--live", str(model), "robot:=rear", "second:=true")
    outcome = deros_at(ros_env, *arguments)
    assert (outcome.code, outcome.err) == (1, "")
    assert outcome.out.splitlines() == [
        f"missing-node /other  ({model}:7)",
        f"missing-node /rear/talker  ({model}:6)",
        "not compared:",
        "  no node was found within 1 s (see ROS_DOMAIN_ID)",
        f"{model}: 2 nodes, 2 differences",
    ]
    outcome = deros_at(ros_env, "verify", "--timeout", "1", "--format", "json", *arguments[3:5])
    (only,) = json.loads(outcome.out)
    assert only == {
        "kind": "missing-node",
        "severity": "error",
        "node": "/front/talker",
        "subject": "",
        "expected": "",
        "seen": "",
        "note": "",
        "file": str(model),
        "line": 6,
        "column": 6,
    }
    assert "no node was found within 1 s" in outcome.err


@pytest.mark.parametrize(
    ("option", "why"),
    [
        (["--grace", "missing-node=2"], "--grace is for --watch"),
        (["--diagnostics"], "--diagnostics is for --watch"),
        (["--watch", "--grace", "mising-node=2"], "did you mean 'missing-node'"),
        (["--watch", "--grace", "missing-node"], "is not a time in seconds"),
        (["--watch", "--grace", "missing-node=-1"], "is not a time in seconds"),
    ],
)
def test_wrong_option_is_refused(model: Path, option: list[str], why: str) -> None:
    """Before the model is read."""
    outcome = deros("verify", "--live", *option, model)
    assert outcome.code == 2
    assert why in " ".join(outcome.err.split())
