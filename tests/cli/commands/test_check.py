"""``deros check``: files checked together, order of findings, and exit codes."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.support.cli import deros

GOOD = "node good : demo\npublishes\n  topic odom : nav_msgs.Odometry\n"
BAD = "node bad : demo\nparameters\n  name rate : int = 0.5\n  name rate : int = 1\n"
LONELY = """\
system Lonely
topics
  topic /odom
"""


@pytest.fixture(autouse=True)
def _in_own_directory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name, text in (("good.rnd", GOOD), ("bad.rnd", BAD), ("lonely.system", LONELY)):
        (tmp_path / name).write_text(text)


def test_clean_models_exit_with_0() -> None:
    """The summary counts the files."""
    outcome = deros("check", "good.rnd")
    assert (outcome.code, outcome.out) == (0, "1 file checked, no findings\n")


def test_errors_exit_with_1_and_are_all_reported() -> None:
    """All findings of a run are sorted by file name and line."""
    outcome = deros("check", "good.rnd", "lonely.system", "bad.rnd")
    assert outcome.code == 1
    places = [line.split(": ")[0] for line in outcome.out.splitlines() if line[0] not in " 0123"]
    assert places == ["bad.rnd:3:21", "bad.rnd:4:8", "lonely.system:3:9"]
    assert outcome.out.endswith("\n2 errors and 1 warning in 3 files\n")


def test_warnings_fail_only_with_strict() -> None:
    """A warning is always reported; with ``--strict`` it fails the run."""
    assert deros("check", "lonely.system").code == 0
    strict = deros("check", "--strict", "lonely.system")
    assert strict.code == 1
    assert "warning[DRS212 unused-topic]" in strict.out


def test_notes_never_fail() -> None:
    """Notes do not fail a run, even with ``--strict``."""
    Path("old.rnd").write_text('node old : demo\nparameters\n  name topic_id : string = "x"\n')
    Path("remark.system").write_text(
        'system Remark\nimports import "old.rnd"\ntopics topic /x\n'
        "node old : old wirings connect topic_id to /x\n"
    )
    outcome = deros("check", "--strict", "remark.system")
    assert "info[DRS217 untyped-wiring]" in outcome.out
    assert outcome.code == 0


@pytest.mark.parametrize("name", ["nowhere.rnd", "model.txt", "latin.rnd", "folder.rnd"])
def test_unreadable_input_exits_with_2(name: str) -> None:
    """Missing files, unknown suffixes, binary files and directories give one finding each."""
    Path("model.txt").write_text(GOOD)
    Path("latin.rnd").write_bytes(b"node caf\xe9 : demo")
    Path("folder.rnd").mkdir()
    outcome = deros("check", "--format", "json", name)
    assert outcome.code == 2
    assert [d["file"] for d in json.loads(outcome.out)] == [name]


def test_other_files_are_checked_despite_an_unreadable_one() -> None:
    """One unreadable file does not hide findings of the others."""
    outcome = deros("check", "nowhere.rnd", "bad.rnd")
    assert outcome.code == 2
    assert "bad.rnd:3:21: error[DRS103 wrong-default]" in outcome.out


def test_file_given_twice_is_checked_once() -> None:
    """A repeated file, or one both given and imported, gives each finding once."""
    Path("uses.system").write_text('system Uses\nimports import "bad.rnd"\nnode bad : bad\n')
    outcome = deros("check", "bad.rnd", "./bad.rnd", "uses.system")
    assert outcome.out.count("DRS103") == 1


def test_interfaces_come_from_given_folders() -> None:
    """A custom message type is known if its folder is given."""
    Path("own.rnd").write_text("node own : demo\npublishes\n  topic state : own_msgs.State\n")
    (Path("ws") / "own_msgs" / "msg").mkdir(parents=True)
    (Path("ws") / "own_msgs" / "msg" / "State.msg").write_text("float64 charge\n")
    assert "DRS101" in deros("check", "own.rnd").out
    assert deros("check", "--interfaces", "ws", "own.rnd").code == 0


def test_missing_interface_folder_is_a_usage_error() -> None:
    """The exit code is 2."""
    assert deros("check", "--interfaces", "nowhere", "good.rnd").code == 2


COUNTED = """\
use "counted.system" import Counted
action stop publishes true on /stop : std_msgs.Bool latched;
input ticks = topic /ticks.data timeout 1 sec
entity e { moved: ticks.rate() > 5; lost: ticks.missing(); }
if e.moved or e.lost then { stop; };
"""
TICKS = """\
system Counted
topics
  external topic /ticks : std_msgs.Int64
  external topic /stop : std_msgs.Bool
"""


WATCHING = """\
use "counted.system" import Counted
action stop publishes true on /stop : std_msgs.Bool latched;
input ticks = topic /ticks.data timeout 1 sec
input stopped = topic stop.data
entity e { moved: ticks != 0 and stopped for 1 sec; lost: ticks.missing(); }
if e.moved or e.lost then { stop; };
"""


@pytest.mark.parametrize("target", ["", " target cpp"])
def test_action_whose_topic_is_watched_is_found(target: str) -> None:
    """No target publishes and watches a topic in one node; the hint names the condition."""
    Path("counted.system").write_text(f'{TICKS}safety "counted.deros"{target}\n')
    Path("counted.deros").write_text(WATCHING)
    outcome = deros("check", "--format", "json", "counted.system")
    (found,) = (each for each in json.loads(outcome.out) if each["code"] == "DRS402")
    assert "'stop.active'" in found["hint"]
    assert outcome.code == 1


@pytest.mark.parametrize(
    ("statement", "project", "refused"),
    [
        ('safety "counted.deros"\n', "", False),
        ('safety "counted.deros" target cpp\n', "", True),
        ('subsystem Arm { safety "counted.deros" target cpp }\n', "", True),
        ("", '[targets]\nderos = ["c"]\n', True),
        ("", '[targets]\nderos = ["python"]\n', False),
    ],
)
def test_what_a_named_target_cannot_express_is_found(
    statement: str, project: str, refused: bool
) -> None:
    """It is found where the system or the project names the target, before generating."""
    Path("counted.system").write_text(TICKS + statement)
    Path("counted.deros").write_text(COUNTED)
    Path("deros.toml").write_text(project)
    for named in ("counted.system", "counted.deros"):
        outcome = deros("check", named)
        expected = refused and (bool(project) == (named == "counted.deros"))
        assert ("DRS402" in outcome.out) == expected, outcome.out
        assert outcome.code == int(expected), outcome.out
