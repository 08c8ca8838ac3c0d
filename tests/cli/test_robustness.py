"""Robustness: any input gives findings and an exit code, never a traceback."""

from __future__ import annotations

import json
import os
import random
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.cli import Outcome, deros
from tests.support.profiles import scaled

MODELS = {
    "robot.rnd": """\
node robot : demo "A robot" executable "run"
parameters
  name speed : double = 0.5 [m/s] in (0, 2.0] "How fast" read_only
  name modes : string[] = ["a", "b"] size 2
publishes
  topic odom : nav_msgs.Odometry { twist.twist.linear.x [m/s] } qos reliable deadline 1 sec
subscribes
  topic /stop : std_msgs.Bool qos best_effort
timers
  timer tick every 20 ms
""",
    "robot.system": """\
system Robot
imports import "robot.rnd"
topics
  topic /odom : nav_msgs.Odometry /* pinned */
  external topic /stop
subsystem Base namespace /base {
  node robot : robot respawn delay 1 sec max 3 log_level debug
  parameters param speed = 1.0
  wirings connect odom to /odom connect stop to /stop
}
""",
    "robot.deros": """\
use "robot.system" import Robot
action stop publishes true on /stop : std_msgs.Bool reset_by go;
action go;
const limit = 0.5 m/s
input speed = topic /odom.twist.twist.linear.x timeout 0.5 sec
entity drive {
  fast: (speed.abs() > limit for 2 sec) or not speed in [-limit, limit);
  blind: speed.unknown();
}
behaviour halt: if drive.fast or drive.blind for 100 ms then {
  stop; if drive.blind then { log_state("blind"); };
};
if not drive.fast and not drive.blind then { go; };
""",
}


@pytest.fixture
def models(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Create and enter a folder with one clean model of each language."""
    for name, text in MODELS.items():
        (tmp_path / name).write_text(text)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def _findings(*arguments: object) -> tuple[Outcome, list[dict[str, object]]]:
    outcome = deros("check", "--format", "json", *arguments)
    assert "bug in deros" not in outcome.err, outcome.err
    assert outcome.code in (0, 1, 2)
    return outcome, json.loads(outcome.out)


@pytest.mark.usefixtures("models")
def test_undamaged_models_are_clean() -> None:
    """The models that the other tests damage are sound."""
    assert _findings(*MODELS)[1] == []


@pytest.mark.parametrize("name", MODELS)
def test_truncated_models_give_findings(models: Path, name: str) -> None:
    """A model cut off anywhere gives findings with valid places."""
    text = MODELS[name]
    for length in range(0, len(text), 7):
        (models / name).write_text(text[:length])
        for finding in _findings(name)[1]:
            assert isinstance(finding["line"], int)
            assert 1 <= finding["line"] <= text.count("\n") + 1


@pytest.mark.parametrize("name", MODELS)
def test_damaged_bytes_give_findings(models: Path, name: str) -> None:
    """Random changes of bytes give findings, or another valid model."""
    chance = random.Random(name)
    for _ in range(60):
        damaged = bytearray(MODELS[name].encode())
        for _ in range(chance.randint(1, 6)):
            damaged[chance.randrange(len(damaged))] = chance.randrange(256)
        (models / name).write_bytes(damaged)
        _findings(name)


@settings(max_examples=scaled(80))
@given(content=st.binary(max_size=300), suffix=st.sampled_from([".rnd", ".system", ".deros"]))
def test_random_bytes_give_findings(
    tmp_path_factory: pytest.TempPathFactory, content: bytes, suffix: str
) -> None:
    """Random bytes are not a model, and do not crash."""
    path = tmp_path_factory.mktemp("random") / f"model{suffix}"
    path.write_bytes(content)
    _findings(path)


@pytest.mark.parametrize("suffix", ["rnd", "system", "deros"])
@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"\n\n",
        b"\xef\xbb\xbf",
        b"\x00" * 64,
        b"\x7fELF\x02\x01\x01" + bytes(range(256)),
        b"\xff\xfe" + "node a : b".encode("utf-16-le"),
        b"(" * 100_000,
        b"not " * 20_000,
        b"subsystem a {" * 20_000,
        b"/*" * 50_000,
        b'"' + b"a" * 200_000,
        "node \u202e : \U0001f916".encode(),
        b"node a : b\r\nparameters\r\n\tname p : int = 1.5\r\n",
    ],
    ids=lambda content: repr(content[:12]),
)
def test_unusual_files_give_findings(tmp_path: Path, suffix: str, content: bytes) -> None:
    """Empty, binary, unfinished, deeply nested and exotic files give findings."""
    path = tmp_path / f"odd.{suffix}"
    path.write_bytes(content)
    outcome, findings = _findings(path)
    assert findings or outcome.code == 0


@pytest.mark.parametrize("depth", [50, 5000])
def test_nesting_of_conditions_is_limited(models: Path, depth: int) -> None:
    """Realistic nesting is accepted, extreme nesting is rejected."""
    condition = "(" * depth + "speed > limit" + ")" * depth
    text = MODELS["robot.deros"].replace("speed.abs() > limit for", f"{condition} for")
    (models / "robot.deros").write_text(text)
    codes = {finding["code"] for finding in _findings("robot.deros")[1]}
    assert codes == (set() if depth == 50 else {"DRS004"})


@pytest.mark.parametrize("depth", [90, 5000])
@pytest.mark.parametrize(
    ("head", "again", "tail"),
    [
        ("speed = ", "-", "$p"),
        ("speed = 0.1", " * $p", ""),
        ("speed = ", "if $p = 1.0 then $p else ", "$p"),
        ("speed = ", "if $p = 1.0 then ", "$p"),
        ("speed = $p when ", "not ", "$p = 1"),
    ],
)
def test_nesting_without_brackets_is_limited(
    models: Path, head: str, again: str, tail: str, depth: int
) -> None:
    """Signs, ``not``, ``if`` and calculations nest as far as a person follows, and no further."""
    value = head + again * depth + tail + " else $p" * (depth if again.endswith("then ") else 0)
    text = MODELS["robot.system"].replace(
        "topics", "argument p : double = 1.0 in (0, 2.0]\ntopics", 1
    )
    (models / "robot.system").write_text(text.replace("speed = 1.0", value))
    found = {finding["code"] for finding in _findings("robot.system")[1]}
    assert found - {"DRS211"} == (set() if depth == 90 else {"DRS004"})


def test_long_condition_is_accepted(models: Path) -> None:
    """A condition of thousands of terms is long, not deeply nested."""
    condition = " or ".join(["speed > limit"] * 3000)
    text = MODELS["robot.deros"].replace("speed.abs() > limit for", f"({condition}) for")
    (models / "robot.deros").write_text(text)
    assert {finding["code"] for finding in _findings("robot.deros")[1]} <= {"DRS004"}


def test_import_cycle_is_one_finding(models: Path) -> None:
    """A system that imports itself, directly or indirectly, is one finding."""
    (models / "robot.system").write_text('system Robot\nimports import "robot.system"\n')
    assert "DRS202" in {finding["code"] for finding in _findings("robot.system")[1]}
    for here, there in (("a", "b"), ("b", "c"), ("c", "a")):
        text = f'system {here.upper()}\nimports import "{there}.system"\n'
        text += f"subsystem x : {there.upper()}\n"
        (models / f"{here}.system").write_text(text)
    assert "DRS202" in {finding["code"] for finding in _findings("a.system")[1]}


def test_imports_that_are_not_files(models: Path) -> None:
    """Directories, dangling links and globs without matches are unknown imports."""
    (models / "folder.rnd").mkdir()
    (models / "dangling.rnd").symlink_to("nowhere.rnd")
    for path in ("folder.rnd", "dangling.rnd", "no*.rnd", "/", "..", ""):
        (models / "x.system").write_text(f'system X\nimports import "{path}"\n')
        assert _findings("x.system")[0].code in (1, 2)


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_file_without_read_permission(models: Path) -> None:
    """It is reported as unreadable."""
    (models / "robot.rnd").chmod(0)
    assert _findings("robot.rnd")[0].code == 2


@pytest.mark.parametrize("name", MODELS)
def test_device_or_pipe_is_rejected(models: Path, name: str) -> None:
    """A path that is neither file nor directory is rejected without blocking."""
    (models / name).unlink()
    os.mkfifo(models / name)
    assert _findings(name)[0].code == 2


def test_generate_writes_nothing_from_models_with_errors(models: Path) -> None:
    """The output directory stays as it was, or is not created."""
    (models / "robot.rnd").write_text(MODELS["robot.rnd"].replace("0.5 [m/s]", '"x" [m/s]'))
    for name, target in (
        ("robot.rnd", "python"),
        ("robot.system", "script"),
        ("robot.deros", "python"),
    ):
        outcome = deros("generate", name, "--target", target, "-o", "out")
        assert outcome.code == 1
        assert "DRS103" in outcome.err
        assert not (models / "out").exists()
