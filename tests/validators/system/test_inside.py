"""Nodes in the process of another program are checked like any others."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.diagnostics import Diagnostic
from tests.support.checks import checked, checked_rules
from tests.support.cli import deros
from tests.support.work import calls

MANAGER = 'node manager : control executable "manager" parameters name rate : int = 100\n'
WHEELS = """node wheels : controllers lifecycle
parameters name radius : double > 0
subscribes topic ~/cmd_vel : geometry_msgs.Twist
publishes topic ~/odom : nav_msgs.Odometry
"""
PILOT = """node pilot : pilots
subscribes topic odom : nav_msgs.Odometry
publishes topic cmd_vel : geometry_msgs.Twist
"""
BODY = """system Rover imports import "*.rnd"
argument real : bool = true
topics topic /odom topic /cmd_vel
node manager : manager own_name when real
inside manager {
  node wheels : wheels
  parameters param radius = 0.1
  wirings connect ~/cmd_vel to /cmd_vel connect ~/odom to /odom
}
node pilot : pilot
wirings connect odom to /odom connect cmd_vel to /cmd_vel
"""
SOUND = BODY.replace(" when real", "").replace("argument real : bool = true\n", "")
"""The same without the variant that lacks the program."""


def findings(folder: Path, body: str) -> list[Diagnostic]:
    """Return the findings of a system, whose descriptions are sound."""
    for name, text in (("manager", MANAGER), ("wheels", WHEELS), ("pilot", PILOT)):
        (folder / f"{name}.rnd").write_text(text)
    (folder / "robot.system").write_text(body)
    return checked(folder / "robot.system")


def codes_of(found: list[Diagnostic]) -> list[str]:
    """Return the codes of findings."""
    return [each.code.name for each in found]


def test_they_are_there_where_their_program_is(tmp_path: Path) -> None:
    """Without it, nobody publishes what they would."""
    assert findings(tmp_path, SOUND) == []
    found = findings(tmp_path, BODY)
    assert found
    assert all("where real = false" in each.message for each in found)
    assert findings(tmp_path, BODY.replace("pilot : pilot\n", "pilot : pilot when real\n")) == []


@pytest.mark.parametrize(
    ("written", "instead", "code"),
    [
        ("param radius = 0.1", "param radius = -1", "DRS221"),
        ("param radius = 0.1", "param radios = 1", "DRS206"),
        ("parameters param radius = 0.1", "", "DRS227"),
        ("connect ~/odom to /odom", "connect odom to /odom", "DRS204"),
        ("connect ~/odom to /odom", "connect ~/odom to /cmd_vel", "DRS210"),
    ],
)
def test_faults_are_found(tmp_path: Path, written: str, instead: str, code: str) -> None:
    """As of a node that is started."""
    body = SOUND
    assert written in body
    assert code in codes_of(findings(tmp_path, body.replace(written, instead)))


def test_process_exits_before_its_nodes_do_not(tmp_path: Path) -> None:
    """What waits for the exit of a node waits for its program."""
    found = findings(
        tmp_path, BODY.replace(" when real", "") + 'process p : "x" after exit of wheels'
    )
    (each,) = (each for each in found if each.code.name == "DRS284")
    assert "in the process of '/manager'" in each.message


def test_program_brings_its_nodes_to_active(tmp_path: Path) -> None:
    """Or another node, which is one of the system then."""
    body = SOUND
    assert (
        findings(
            tmp_path,
            body.replace("node wheels : wheels", "node wheels : wheels activated by manager"),
        )
        == []
    )
    found = findings(
        tmp_path, body.replace("node wheels : wheels", "node wheels : wheels activated by managr")
    )
    assert codes_of(found) == ["DRS246"]
    # The whole system may be brought up; the program's own nodes are no part of that.
    managed = body.replace("system Rover", "system Rover autostart").replace(
        'import "*', 'import "*'
    )
    assert "DRS270" in codes_of(findings(tmp_path, managed))


def test_rules_read_what_they_publish(tmp_path: Path) -> None:
    """The type of their topics is known, and they feed the input."""
    body = SOUND
    assert findings(tmp_path, body) == []
    rules = """use "robot.system" import Rover;
    input speed = topic /odom.twist.twist.linear.x timeout 0.5 sec
    action stop publishes true on /stop : std_msgs.Bool;
    entity base { fast: speed > 1 m/s or speed.missing(); }
    if base.fast then { stop; };
    """
    found = checked_rules(rules, body, tmp_path)
    assert [each for each in found if each.is_error or "odom" in each.message] == []
    silent = body.replace("connect ~/odom to /odom\n", "").replace(" connect ~/odom to /odom", "")
    assert any("/odom" in each.message for each in checked_rules(rules, silent, tmp_path))


def test_xacro_makes_texts_for_programs_alone(tmp_path: Path) -> None:
    """Whoever starts a system has one command line for a process."""
    (tmp_path / "a.xacro").write_text("<robot/>")
    made = 'parameters param radius = 0.1 param robot_description from xacro "a.xacro"'
    found = findings(tmp_path, SOUND.replace("parameters param radius = 0.1", made))
    assert "DRS274" in codes_of(found)


def test_graph_says_whose_process_it_is(tmp_path: Path) -> None:
    """In each of its forms."""
    assert findings(tmp_path, SOUND) == []
    for form in ("text", "mermaid", "dot"):
        outcome = deros("graph", tmp_path / "robot.system", "--format", form)
        assert outcome.code == 0
        assert "/wheels (inside manager)" in outcome.out
        assert "/pilot (" not in outcome.out.replace("/pilot (odom)", "").replace(
            "/pilot (cmd_vel)", ""
        )


def test_time_is_linear_in_the_nodes_of_a_process(tmp_path: Path) -> None:
    """As it is in those of any system; with conditions, too."""

    def asked(number: int) -> int:
        nodes = "".join(
            f"node w{each} : wheels when real parameters param radius = 1\n"
            for each in range(number)
        )
        head = 'system S imports import "*.rnd" argument real : bool = true node manager : manager '
        return calls(lambda: findings(tmp_path, f"{head} inside manager {{ {nodes} }}"))

    few, many = asked(20), asked(80)
    assert many < 5 * few
