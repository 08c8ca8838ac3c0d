"""``deros new rules --from``: what it writes checks clean, and reacts to what it watches."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.importers import first_rules
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import InterfaceType
from deros.metamodels.keywords import keywords
from deros.metamodels.languages import DEROS
from deros.rules.functions.functions import FUNCTIONS
from tests.support.cli import deros
from tests.support.examples import EXAMPLES
from tests.support.real_systems import FOLDER as REAL

BASE = """node base : base
publishes
  topic /odom : nav_msgs.Odometry
  topic /front/scan : sensor_msgs.LaserScan qos deadline 300 ms
  topic /said : std_msgs.String
subscribes topic /cmd_vel : geometry_msgs.Twist stops after 0.5 sec
"""
SYSTEM = """system robot
SAFETY
imports import "base.rnd"
topics
  external topic /odom
  external topic /front/scan
  external topic /said
  external topic /cmd_vel
  external topic /wish : geometry_msgs.Twist
node base : base
  wirings
    connect /odom to /odom
    connect /front/scan to /front/scan
    connect /said to /said
    connect /cmd_vel to /cmd_vel
"""


def robot(folder: Path, safety: str = "") -> Path:
    """Write a robot as an import writes it, and return its system."""
    (folder / "base.rnd").write_text(BASE)
    path = folder / "robot.system"
    path.write_text(SYSTEM.replace("SAFETY", safety))
    return path


def strictly_clean(*paths: Path) -> None:
    """Assert that there is no finding of any kind."""
    outcome = deros("check", "--strict", *paths)
    assert outcome.code == 0, outcome.out + outcome.err


def test_what_moves_or_senses_has_an_input_and_a_timeout(tmp_path: Path) -> None:
    """That of a deadline, where there is one; the others are listed with their types."""
    system = robot(tmp_path)
    outcome = deros("new", "rules", "guard", "--from", system, "-o", tmp_path / "rules")
    assert outcome.code == 0
    rules = tmp_path / "rules/guard.deros"
    text = rules.read_text()
    assert text.startswith('use "../robot.system" import robot\n')
    assert [line for line in text.splitlines() if line.startswith("input")] == [
        "input front_scan = topic /front/scan timeout 300 ms",
        "input odom = topic /odom.twist.twist.linear.x [m/s] timeout 1 sec",
        "input wish = topic /wish.linear.x [m/s] timeout 1 sec",
    ]
    assert outcome.out.splitlines() == [
        f"wrote {rules}",
        f"next: deros check {rules}",
        "no input for these, whose messages are not known to move or sense something:",
        "  /said : std_msgs.String",
    ]
    strictly_clean(rules, system)


@pytest.mark.parametrize(
    ("rate", "timeout"),
    [
        ("10 Hz", "300 ms  // 3 periods at 10 Hz, its rate in the system"),
        ("9.97 Hz", "310 ms  // 3 periods at 9.97 Hz, its rate in the system"),
        ("0.3 Hz", "10 sec  // 3 periods at 0.3 Hz, its rate in the system"),
        ("500 mHz", "6 sec  // 3 periods at 0.5 Hz, its rate in the system"),
        ("1000000 Hz", "3 us  // 3 periods at 1e+06 Hz, its rate in the system"),
        ("1e-300 Hz", "4600000000 sec  // 3 periods at 1e-300 Hz, its rate in the system"),
    ],
)
def test_timeouts_are_from_rates(rate: str, timeout: str, tmp_path: Path) -> None:
    """Three periods, not shorter, in two digits; a deadline counts more, which is a promise."""
    system = robot(tmp_path)
    text = system.read_text()
    for topic in ("/odom", "/front/scan", "/said"):
        text = text.replace(f"external topic {topic}\n", f"external topic {topic} rate {rate}\n")
    system.write_text(text)
    assert deros("new", "rules", "guard", "--from", system, "-o", tmp_path).code == 0
    lines = (tmp_path / "guard.deros").read_text().splitlines()
    assert [line for line in lines if line.startswith("input")] == [
        "input front_scan = topic /front/scan timeout 300 ms",
        f"input odom = topic /odom.twist.twist.linear.x [m/s] timeout {timeout}",
        "input wish = topic /wish.linear.x [m/s] timeout 1 sec",
    ]
    strictly_clean(tmp_path / "guard.deros", system)


def test_gate_stops_what_it_can(tmp_path: Path) -> None:
    """With the line that the output names, rules and system are clean."""
    system = robot(tmp_path)
    words = ["--from", system, "--gate", "/wish", "/cmd_vel", "-o", tmp_path]
    outcome = deros("new", "rules", "guard", *words)
    assert outcome.code == 0, outcome.err
    line = f'the gate becomes a node of {system} with this line in it: safety "guard.deros"'
    assert line in outcome.out
    robot(tmp_path, 'safety "guard.deros"')
    strictly_clean(tmp_path / "guard.deros", system)
    assert "wish" not in tmp_path.joinpath("guard.deros").read_text().partition("gate")[0]


TIMELINE = """# Guard
Rules: [guard.deros](guard.deros)

## A sensor is silent, then the robot is too fast

| time until 4 s          | message         | effect          | command          |
|-------------------------|-----------------|-----------------|------------------|
| every 0.1 s until 4 s   | /odom.twist.twist.linear.x = 0.5 |  |           |
| 4 s                     | odom = 1.5      | stop, log_state | /cmd_vel zero    |
"""


def test_robot_that_is_too_fast_is_stopped(tmp_path: Path) -> None:
    """The rules are played as they are written."""
    (tmp_path / "base.rnd").write_text(BASE.replace("  topic /front/scan", "  // topic /front"))
    system = tmp_path / "robot.system"
    text = SYSTEM.replace("SAFETY", "").replace("  external topic /front/scan\n", "")
    system.write_text(text.replace("    connect /front/scan to /front/scan\n", ""))
    words = ["--from", system, "--gate", "/wish", "/cmd_vel", "-o", tmp_path]
    assert deros("new", "rules", "guard", *words).code == 0
    (tmp_path / "guard.md").write_text(TIMELINE)
    outcome = deros("test", tmp_path / "guard.md")
    assert outcome.code == 0, outcome.out


def _known() -> list[InterfaceType]:
    sensed = [
        InterfaceType(package, "msg", name)
        for package, names in first_rules._SENSED.items()
        for name in names
    ]
    moving = (InterfaceType(p, "msg", n) for p, n in {*first_rules._STOPS, *first_rules._SPEEDS})
    store = InterfaceStore()
    return [each for each in {*sensed, *moving} if store.exists(each)]


def test_every_known_message_gives_clean_rules(tmp_path: Path) -> None:
    """Its fields are there, and their units are right; all but those of Ackermann are embedded."""
    known = sorted(_known(), key=str)
    assert len(known) == 30
    topics = "".join(f"external topic /t{n} : {each.short}\n" for n, each in enumerate(known))
    system = tmp_path / "robot.system"
    system.write_text(f"system robot topics\n{topics}")
    assert deros("new", "rules", "guard", "--from", system, "-o", tmp_path).code == 0
    text = (tmp_path / "guard.deros").read_text()
    assert text.count("\ninput ") == len(known)
    outcome = deros("check", "--strict", tmp_path / "guard.deros")
    assert outcome.code == 0, outcome.out


def test_words_of_the_language_are_no_names(tmp_path: Path) -> None:
    """Topics may be called like them, and like one another but for slashes."""
    words = sorted(keywords(DEROS) | FUNCTIONS.keys())
    names = [*(f"/{each}" for each in words), "/a/b", "/a_b", "/max_speed", "/senses", "/motion"]
    topics = "".join(f'external topic "{name}" : nav_msgs.Odometry\n' for name in names)
    system = tmp_path / "robot.system"
    system.write_text(f"system robot topics\n{topics}")
    assert deros("new", "rules", "guard", "--from", system, "-o", tmp_path).code == 0
    outcome = deros("check", tmp_path / "guard.deros")
    assert outcome.code == 0, outcome.out


@pytest.mark.parametrize("system", sorted(EXAMPLES.rglob("*.system")), ids=lambda each: each.stem)
def test_examples_get_rules_without_errors(system: Path, tmp_path: Path) -> None:
    """Also those that have rules already, and arguments."""
    words = ["--interfaces", REAL / "interfaces"]
    made = deros("new", "rules", "guard", "--from", system, "-o", tmp_path, *words)
    assert made.code == 0, made.err
    assert f"next: deros check {tmp_path / 'guard.deros'} --interfaces {words[1]}\n" in made.out
    outcome = deros("check", "--strict", tmp_path / "guard.deros", *words)
    assert "guard.deros" not in outcome.out, outcome.out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (
            ["rules", "guard", "--from", "robot.system", "--gate", "/x", "/y"],
            "neither '/x' nor",
        ),
        (
            ["rules", "guard", "--from", "robot.system", "--gate", "/said", "/y"],
            "'/said' is a std_msgs.String, of which it is not known what stops the robot",
        ),
        (["rules", "guard", "--from", "robot.system", "--gate", "a b", "/y"], "'a b' is no name"),
        (["rules", "guard", "--gate", "/wish", "/cmd_vel"], "--gate is for rules --from a system"),
        (["node", "guard", "--from", "robot.system"], "--from is for rules"),
        (["rules", "guard", "--from", "base.rnd"], "takes system descriptions"),
    ],
)
def test_mistakes_are_usage_errors(
    words: list[str], said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nothing is written."""
    robot(tmp_path)
    monkeypatch.chdir(tmp_path)
    outcome = deros("new", *words)
    assert outcome.code == 2
    assert said in outcome.err
    assert sorted(each.name for each in tmp_path.iterdir()) == ["base.rnd", "robot.system"]


def test_system_with_errors_gets_no_rules(tmp_path: Path) -> None:
    """The errors are shown."""
    system = robot(tmp_path)
    system.write_text(system.read_text().replace("connect /odom", "connect /odam"))
    outcome = deros("new", "rules", "guard", "--from", system, "-o", tmp_path)
    assert outcome.code == 1
    assert "error[DRS" in outcome.out + outcome.err
    assert not (tmp_path / "guard.deros").exists()
