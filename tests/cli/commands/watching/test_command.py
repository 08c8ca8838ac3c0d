"""``deros watch`` at a running robot: in a terminal, in a pipe, once, and its layout."""

from __future__ import annotations

import json
import re
import signal
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from deros.live.watched import CONDITIONS
from tests.faults.conftest import robot, software
from tests.support.cli import Outcome
from tests.support.faults import GATE, NODE, Robot
from tests.support.played import load, scan
from tests.support.ros import read_line, running, stop
from tests.support.shell import DEROS, deros_at, deros_until
from tests.support.terminal import FIRST_SCREEN, SECOND_SCREEN, Terminal

__all__ = ["robot", "software"]

BLOCKED = 0.1
"""A distance ahead, in m, at which the robot may not drive."""

TIMEOUT_S = 0.5
"""The timeout of the speed."""

LIGHT, WORN, WORN_S = 10.0, 45.0, 20.0
"""Loads that the arm bears, and does not bear for so many seconds; they have no timeout."""

SMALL, LARGE = (80, 24), (132, 50)


def row_of(picture: list[str], name: str) -> str:
    """Return the rest of the row of a node, rule or action; empty if there is none."""
    found = [line.strip() for line in picture if line.strip().startswith(name)]
    return found[0].removeprefix(name).strip() if found else ""


@pytest.mark.ros
def test_terminal_shows_a_violation_silence_and_the_way_back(robot: Robot) -> None:
    """Verdict, action and event appear; a killed node is silent until it runs again."""
    command = [DEROS, "watch", "--timeout", "30"]
    with (
        robot.safety_node() as node,
        robot.gate(),
        robot.sensors() as sensors,
        Terminal(command, {**robot.env, "TERM": "xterm"}, LARGE) as terminal,
    ):
        sensors.drive()
        terminal.until(lambda picture: row_of(picture, "space.blocked").startswith("false"))
        terminal.until(lambda picture: row_of(picture, f"/{GATE}").startswith("ok"))
        sensors.play("/scan", scan(BLOCKED))
        shown = terminal.until(
            lambda picture: (
                row_of(picture, "action stop").startswith("active")
                and row_of(picture, "space.blocked").startswith("true")
                and any("  trigger" in line for line in picture)
            )
        )
        assert "space.blocked" in row_of(shown, "action stop")
        terminal.until(lambda picture: row_of(picture, f"/{GATE}").startswith("warning"))

        node.kill()
        silent = terminal.until(lambda picture: row_of(picture, f"/{NODE}").startswith("silent"))
        assert "no report for" in row_of(silent, f"/{NODE}")
        assert row_of(silent, "action stop").startswith("was active")
        assert row_of(silent, "space.blocked").startswith("was true")
        terminal.until(lambda picture: row_of(picture, f"/{GATE}").startswith("error"))
        robot.restart()
        back = terminal.until(lambda picture: row_of(picture, "action stop").startswith("active"))
        assert not row_of(back, f"/{NODE}").startswith("silent")

        terminal.resize(SMALL)
        small = terminal.until(lambda picture: len(picture) == SMALL[1])
        assert {len(line) for line in small} == {SMALL[0]}
        assert terminal.end(signal.SIGINT) == 0
        assert terminal.output.index(SECOND_SCREEN) < terminal.output.index(FIRST_SCREEN)
        last = terminal.output.rpartition(FIRST_SCREEN)[2]
        assert f"/{NODE}" in last
        assert "Traceback" not in terminal.output


@pytest.mark.ros
def test_pipe_gets_a_line_for_each_change(robot: Robot) -> None:
    """The first lines are what is; then come changes and events, and Ctrl-C ends with 0."""
    command = [DEROS, "watch", NODE, "--timeout", "30", "--events", "0"]
    with robot.safety_node(), robot.sensors() as sensors:
        sensors.drive()
        robot.until_free()
        with running(command, robot.env) as watch:

            def until(wanted: str) -> str:
                while wanted not in (line := read_line(watch)):
                    assert line, f"no line with '{wanted}'"
                return line

            until("rule space.blocked  false")
            sensors.play("/scan", scan(BLOCKED))
            seen = {"rule space.blocked  true", "action stop  active", "event trigger"}
            while seen:
                line = read_line(watch)
                assert line
                assert f"  /{NODE}  " in line
                seen = {each for each in seen if each not in line}
            code, rest = stop(watch, signal.SIGINT)
            assert code == 0
            assert "Traceback" not in rest


@pytest.mark.ros
def test_pipe_with_json_reports_silence_of_a_hung_node(robot: Robot) -> None:
    """One object a line; a hung node is silent, and reports again when it goes on."""
    command = [DEROS, "watch", "--timeout", "30", "--format", "json", "--silence", "2"]
    with robot.safety_node() as node, running(command, robot.env) as watch:

        def until(accepted: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
            while True:
                change: dict[str, Any] = json.loads(read_line(watch))
                assert change["node"] == f"/{NODE}"
                if accepted(change):
                    return change

        until(lambda change: change["what"] == "node" and change["silent_s"] is None)
        node.freeze()
        hung = until(lambda change: change["what"] == "node")
        node.thaw()
        assert hung["silent_s"] >= 2
        until(lambda change: change["what"] == "node" and change["silent_s"] is None)
        assert stop(watch, signal.SIGTERM)[0] == 128 + signal.SIGTERM


@pytest.mark.ros
def test_once_shows_all_and_the_layout_names_it(robot: Robot, tmp_path: Path) -> None:
    """Each rule and action, the events in order; the layout has their names and topics."""
    with robot.safety_node(), robot.gate(), robot.sensors() as sensors:
        sensors.drive()
        robot.until_free()
        sensors.play("/scan", scan(BLOCKED))
        robot.until_stopped()
        outcome = deros_at(robot.env, "watch", "--once", "--format", "json", "--events", "1000")
        assert outcome.code == 0, outcome
        shown = json.loads(outcome.out)
        assert shown["silent"] == []
        gate, guard = shown["nodes"]
        assert (gate["node"], guard["node"]) == (f"/{GATE}", f"/{NODE}")
        verdicts = {rule["name"]: rule["verdict"] for rule in guard["rules"]}
        assert verdicts["space.blocked"] == "true"
        assert {"stop", "halt"} <= {action["name"] for action in guard["actions"]}
        times = [event["ros_time_ns"] for event in shown["events"]]
        assert times == sorted(times)
        assert "trigger" in {event["kind"] for event in shown["events"]}

        file = tmp_path / "robot.json"
        outcome = deros_at(robot.env, "watch", "--foxglove", str(file))
        assert (outcome.code, outcome.out, outcome.err) == (0, f"wrote {file}\n", "")
        panels = json.loads(file.read_text(encoding="utf-8"))["configById"]
        paths = {path["value"] for path in panels["StateTransitions!deros"]["paths"]}
        rule = f'/diagnostics.status[:]{{name=="/{NODE}: space.blocked"}}.level'
        assert {"/stop.data", rule} <= paths
        assert panels["DiagnosticStatusPanel!deros"]["selectedName"] == f"/{NODE}"


@pytest.mark.ros
def test_once_shows_what_comes_next_and_how_old_inputs_are(robot: Robot) -> None:
    """An interval that runs, a sensor that may fall silent; inputs heard, once heard, and never."""
    with robot.safety_node("diagnostics_freq:=20.0"), robot.sensors() as sensors:
        sensors.drive()
        robot.until_free()

        inputs, rules = guard_once(robot, lambda _, rules: rules["drive.blind"]["next"])
        assert [*inputs] == ["speed", "orientation", "scan", "load", "button"]
        assert inputs["load"] == {"name": "load", "is_received": False, "age_s": None}
        assert inputs["speed"]["age_s"] < 2 * TIMEOUT_S
        assert rules["arm.worn"]["next"] == []
        (silence,) = rules["drive.blind"]["next"]
        assert (silence["condition"], silence["verdict"]) == ("no message comes", "true")
        assert 0 <= silence["in_s"] <= TIMEOUT_S

        picture = once(robot, lambda outcome: "(true in 0." in outcome.out).splitlines()
        assert re.search(r"  \(true in 0\.[0-5] s\)$", row_of(picture, "drive.blind"))
        assert re.fullmatch(r"received  +0\.\d s", row_of(picture, "input speed"))

        def is_wearing(_: Parts, rules: Parts) -> bool:
            """Return whether the interval is seen to run; else begin it anew."""
            if not rules["arm.worn"]["next"]:
                sensors.send("/load", load(LIGHT), load(WORN))
                return False
            return True

        sensors.match("/load")
        inputs, rules = guard_once(robot, is_wearing)
        for then, condition in zip(rules["arm.worn"]["next"], CONDITIONS, strict=True):
            assert (then["condition"], then["verdict"]) == (condition, "true")
            assert then["in_s"] + inputs["load"]["age_s"] == pytest.approx(WORN_S, abs=0.5)


Parts = dict[str, dict[str, Any]]


def once(robot: Robot, accepted: Callable[[Outcome], object], *options: str) -> str:
    """Return what ``deros watch --once`` prints of the safety node, as soon as it is accepted."""
    return deros_until(
        robot.env,
        lambda outcome: outcome.code == 0 and bool(accepted(outcome)),
        *("watch", NODE, "--once", *options),
    ).out


def guard_once(robot: Robot, accepted: Callable[[Parts, Parts], object]) -> tuple[Parts, Parts]:
    """Return inputs and rules of the safety node by their names, as soon as they are accepted."""

    def parts(text: str) -> tuple[Parts, Parts]:
        (guard,) = json.loads(text)["nodes"]
        inputs, rules = ({each["name"]: each for each in guard[n]} for n in ("inputs", "rules"))
        return inputs, rules

    shown = once(robot, lambda outcome: accepted(*parts(outcome.out)), "--format", "json")
    return parts(shown)


@pytest.mark.ros
def test_domain_without_nodes(ros_env: dict[str, str], tmp_path: Path) -> None:
    """Watching nothing is no success; a layout is then for the name that was given."""
    for arguments in (["watch"], ["watch", "guard"], ["watch", "--once"]):
        outcome = deros_at(ros_env, *arguments, "--timeout", "1")
        assert (outcome.code, outcome.out) == (2, "")
        assert "reported within 1 s" in outcome.err
    file = tmp_path / "robot.json"
    arguments = ["watch", "guard", "--foxglove", str(file), "--timeout", "1"]
    outcome = deros_at(ros_env, *arguments)
    assert outcome.code == 0
    assert "the layout is for /guard" in outcome.err
    assert "/guard/events" in file.read_text(encoding="utf-8")
    file.write_text("mine", encoding="utf-8")
    outcome = deros_at(ros_env, *arguments)
    assert outcome.code == 2
    assert f"{file} cannot be written: it exists" in outcome.err
    assert file.read_text(encoding="utf-8") == "mine"
