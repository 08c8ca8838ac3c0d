"""Arguments, variables, prefixes and processes are the same in every way of starting a system."""

from __future__ import annotations

import random
import shlex
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest

from deros.generators.builtin import rossystem_launch, rossystem_script
from deros.generators.output.writer import write
from deros.generators.system.script.generate import table
from deros.generators.system.script.standalone.command_line import command_line
from deros.generators.system.script.standalone.node import Program, Row
from deros.generators.system.view import system_view
from deros.models.common import Scalar
from deros.systems.arguments.resolve import resolve
from tests.generators.system.test_arguments import launch_file, script_of
from tests.support import launch
from tests.support.arguments import text_of
from tests.support.lint import assert_lint_clean
from tests.support.systems import CONTEXT, load_text

WHOLE = """system Whole "All that programs are started with"
argument robot : string = "r2"
argument level : int = 3 in [1, 9]
argument tool : string = "nice -n 5"
argument bag : bool = true
imports import "eye.rnd" import "arm.system"
env ROS_DOMAIN_ID = $level
env KIND = "outer" when bag
env KIND = "other" when not bag
parameters param rate = $level when bag
remappings
  remap /tf to tf
  remap library to "/${robot}/library" when level > 5
process recorder : "record"
  arguments ["all", "-o", "/tmp/${robot} $${x}", $level, "", "it's \\"so\\""]
  env KIND = $robot cwd "/tmp/${robot}" prefix "nice" respawn if level > 5 delay 2 sec max 3
    when bag "Records"
process viewer : $robot
subsystem front namespace front {
  env KIND = "inner" when level < 3
  node eye : eye arguments ["-v", $robot, "${level}-${robot}", $level, 5] env LEVEL = $level
    prefix $tool
  process eye_log : "tail" arguments ["-f", "${robot}.log"] when not bag
}
subsystem arm : Arm(level = $level + 1, name = "${robot}_arm") { env SIDE = $robot }
node last : eye prefix ""
"""
EYE = """node eye : eyes
  executable "watch"
parameters name rate : double = 1.0
publishes topic tf : tf2_msgs.TFMessage
"""
ARM = """system Arm
argument level : int
argument name : string
imports import "eye.rnd"
node hand : eye arguments ["--level", $level, $name] env NAME = "${name}_${level}"
process gripper : "grip" arguments [$level]
"""
CHOICES: Mapping[str, tuple[Scalar, ...]] = {
    "robot": ("r2", "it", "a/b"),
    "level": (3, 1, 9),
    "tool": ("nice -n 5", "", "gdb -ex 'break main' --args"),
    "bag": (True, False),
}

_Command = tuple[str, list[str], dict[str, str], str | None]


def rows_as_commands(rows: Sequence[Row]) -> list[_Command]:
    """Return what rows start: name, words without those of ROS 2, variables, and folder."""
    found: list[_Command] = []
    for row in rows:
        start = row.program if isinstance(row, Program) else row.executable
        words = command_line(row, [start])
        if "--ros-args" in words:
            words = words[: words.index("--ros-args")]
        folder = row.folder or None if isinstance(row, Program) else None
        found.append((row.name, words, dict(row.environment), folder))
    return found


def test_all_ways_start_programs_alike(tmp_path: Path) -> None:
    """Table, script and launch file have the same words and variables, whatever the arguments."""
    (tmp_path / "arm.system").write_text(ARM)
    system = load_text(tmp_path, WHOLE, eye=EYE)
    script, text = script_of(system), launch_file(system)
    chosen = random.Random(3)
    seen: list[Any] = []
    restarted: set[str] = set()
    for _ in range(60):
        values = {name: chosen.choice(found) for name, found in CHOICES.items()}
        expected = rows_as_commands(table(system_view(resolve(system, values))))
        given = {name: text_of(value) for name, value in values.items()}
        words = [f"{name}:={value}" for name, value in given.items()]
        rows = script.nodes(script.given(script.ARGUMENTS, words))
        alike = [
            (row.name, [*shlex.split(row.prefix), *_own_words(row)], dict(row.environment))
            for row in rows
        ]
        assert alike == [each[:3] for each in expected], values
        assert [getattr(row, "folder", "") or None for row in rows] == [e[3] for e in expected]
        assert launch.commands(text, given) == expected, values
        restarts = [(row.name, row.respawn_delay, row.respawn_max) for row in rows]
        assert launch.restarts(text, given) == restarts, values
        restarted |= {name for name, delay, _ in restarts if delay is not None}
        seen += expected
    assert restarted == {"recorder"}
    assert {name for name, *_ in seen} == {
        *("recorder", "viewer", "eye", "eye_log", "hand", "gripper", "last"),
    }


def _own_words(row: Any) -> list[str]:
    start = row.program if hasattr(row, "program") else row.executable
    assert all(isinstance(each, str) for each in (*row.arguments, *row.environment.values()))
    return [start, *row.arguments]


def test_words_are_those_of_the_model(tmp_path: Path) -> None:
    """Of one assignment, written out by hand."""
    (tmp_path / "arm.system").write_text(ARM)
    system = load_text(tmp_path, WHOLE, eye=EYE)
    found = rows_as_commands(table(system_view(resolve(system, {"level": 9}))))
    everywhere = {"ROS_DOMAIN_ID": "9", "KIND": "outer"}
    assert found == [
        (
            "recorder",
            ["nice", "record", "all", "-o", "/tmp/r2 ${x}", "9", "", 'it\'s "so"'],
            {"ROS_DOMAIN_ID": "9", "KIND": "r2"},
            "/tmp/r2",
        ),
        ("viewer", ["r2"], everywhere, None),
        (
            "eye",
            ["nice", "-n", "5", "watch", "-v", "r2", "9-r2", "9", "5"],
            {**everywhere, "LEVEL": "9"},
            None,
        ),
        (
            "hand",
            ["watch", "--level", "10", "r2_arm"],
            {**everywhere, "SIDE": "r2", "NAME": "r2_arm_10"},
            None,
        ),
        ("gripper", ["grip", "10"], {**everywhere, "SIDE": "r2"}, None),
        ("last", ["watch"], everywhere, None),
    ]


def test_output_is_lint_clean(tmp_path: Path) -> None:
    """The linters of ament find nothing in either file."""
    (tmp_path / "arm.system").write_text(ARM)
    system = load_text(tmp_path, WHOLE, eye=EYE)
    files = {**rossystem_launch(system, CONTEXT), **rossystem_script(system, CONTEXT)}
    write(files, tmp_path / "o")
    assert_lint_clean(tmp_path / "o")


@pytest.mark.parametrize("part", ['env A = "1"', 'process p : "x"'])
def test_system_without_nodes_of_its_own_is_started(tmp_path: Path, part: str) -> None:
    """Processes alone are a system, too; settings alone start nothing."""
    system = load_text(tmp_path, f"system S {part}")
    script = script_of(system)
    assert [row.name for row in script.NODES] == (["p"] if "process" in part else [])
    names = [name for name, *_ in launch.commands(launch_file(system), {})]
    assert names == [row.name for row in script.NODES]
