"""Nearly empty programs: the output of every target compiles and runs."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from deros.generators.monitor.c.interface import render_monitor
from deros.generators.monitor.python.run import GeneratedMonitor
from deros.rules.engine.engine import Engine
from tests.support import timelines
from tests.support.needs import needs

SYSTEM = 'use "robot.system" import Robot\n'
SPEED = "input v = topic /speed.data\n"
LATCHED = "action stop publishes true on /stop : std_msgs.Bool latched;\n"
STRICT = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror"]

PROGRAMS = {
    "a_system": SYSTEM,
    "an_action": "action stop;",
    "a_bound_action": SYSTEM + "action stop publishes true on /stop : std_msgs.Bool;",
    "a_latched_action": SYSTEM + LATCHED,
    "an_action_and_its_reset": SYSTEM
    + "action stop publishes true on /stop : std_msgs.Bool reset_by ok; action ok;",
    "a_constant": "const x = 1",
    "an_empty_entity": "entity e { }",
    "an_input": SYSTEM + "input v = topic /speed.data timeout 1 sec",
    "a_rule": SYSTEM + SPEED + "entity e { r: v > 0.5; }",
    "a_rule_and_an_action": SYSTEM + LATCHED + SPEED + "entity e { r: v > 0.5; }",
    "a_rule_that_reads_nothing": "action stop; entity e { r: true; } if e.r then { stop; };",
    "a_behaviour_that_does_nothing": SYSTEM
    + SPEED
    + "entity e { r: v > 0.5; } if e.r then { if e.r then { }; };",
    "a_behaviour_that_only_logs": SYSTEM
    + SPEED
    + 'entity e { r: v > 0.5; } if e.r then { log_state("fast"); };',
}
"""Rules by the only construct that they contain."""


@needs("gcc")
def test_nearly_empty_programs_compile_in_c(tmp_path: Path) -> None:
    """No enumeration or table is empty, and no parameter is unused."""
    for name, rules in PROGRAMS.items():
        for file, text in render_monitor(timelines.program(rules, name)).items():
            (tmp_path / file).write_text(text, encoding="utf-8")
    sources = [f"{name}_monitor.c" for name in PROGRAMS]
    subprocess.run(["gcc", *STRICT, "-c", *sources], cwd=tmp_path, check=True, timeout=60)


@pytest.mark.parametrize("name", PROGRAMS)
def test_nearly_empty_program_runs_in_python(name: str) -> None:
    """It behaves like the reference as time passes and at a reset."""
    program = timelines.program(PROGRAMS[name], name)
    engine, generated = Engine(program), GeneratedMonitor(program)
    for monitor in (engine, generated):
        monitor.advance(2 * 10**9)
        monitor.reset(3 * 10**9)
        monitor.advance(10**9)
    assert generated.events == engine.events
