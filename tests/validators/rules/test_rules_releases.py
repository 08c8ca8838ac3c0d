"""A reset that a button which is held or stuck gives is remarked on, and it is what it does."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.interfaces.durations import NS_PER_S
from deros.rules.engine.engine import Engine
from tests.support.checks import found_in_rules
from tests.support.rules import program

DECLARED = """
action stop publishes true on /stop : std_msgs.Bool reset_by release;
action release;
input v = topic /speed.data timeout 0.5 sec
input button = topic /flag.data timeout 0.5 sec
"""
RULES = """
  failsafe bad: v > 1;
  lost: button.unknown();
  up: (not button) for 0.1 sec;
"""
BEHAVIOURS = "if e.bad or e.lost then { stop; }; if e.r then { release; };"
RECOMMENDED = "button begins and (up within 1 ms)"
STEP_NS = 20_000_000

STUCK = {
    "from the start": "1" * 200,
    "back after a gap": "1" * 50 + "-" * 60 + "1" * 90,
    "back after a short gap": "1" * 50 + "-" * 30 + "1" * 120,
    "late": "-" * 60 + "1" * 140,
    "held while the danger lasts": "0" * 20 + "1" * 180,
}
LOOSE = "1" * 120 + "0" + "1" * 20 + "00" + "1" * 57
PRESS = "0" * 150 + "1" * 50


def resets(form: str, button: str) -> int:
    """Return how often the stop is reset.

    The danger lasts from 0.2 s to 2 s. A message of the button comes every 20 ms, of the speed
    10 ms later.

    Args:
        form: the condition of the reset.
        button: its states, ``1``, ``0``, or ``-`` for no message.
    """
    engine = Engine(program(f"{DECLARED} entity e {{ {RULES} r: {form}; }} {BEHAVIOURS}"))
    for number, state in enumerate(button, start=1):
        now_ns = number * STEP_NS
        if state != "-":
            engine.message(now_ns, "/flag", {1: state == "1"})
        fast = 0.2 * NS_PER_S <= now_ns < 2 * NS_PER_S
        engine.message(now_ns + STEP_NS // 2, "/speed", {0: 2.0 if fast else 0.0})
    return [each.kind for each in engine.events].count("reset")


FRAME = """
system Robot
topics
  external topic /flag : std_msgs.Bool
  external topic /key : std_msgs.Bool
  external topic /left : std_msgs.Bool
  external topic /right : std_msgs.Bool
  external topic /speed : std_msgs.Float64
  external topic /mode : std_msgs.UInt8
  external topic /joy : sensor_msgs.Joy
  external topic /stop : std_msgs.Bool
  external topic /slow : std_msgs.Bool
  external topic /cmd : geometry_msgs.Twist
  external topic /wish : geometry_msgs.Twist
"""
MORE = """
input key = topic /key.data timeout 0.5 sec
input left = topic /left.data timeout 0.5 sec
input right = topic /right.data timeout 0.5 sec
input mode = topic /mode.data timeout 0.5 sec
input joy = topic /joy timeout 0.5 sec
"""


def messages_of(statements: str, folder: Path) -> list[str]:
    """Return the messages of the remarks."""
    text = f'use "robot.system" import Robot\n{statements}'
    return [each.message for each in found_in_rules("DRS380", text, FRAME, folder)]


def remarked(form: str, folder: Path, more: str = "", behaviours: str = BEHAVIOURS) -> list[str]:
    """Return the messages of the remarks on the condition of a reset."""
    entity = f"entity e {{ {RULES} {more} r: {form}; }}"
    return messages_of(f"{DECLARED}{MORE}{entity} {behaviours}", folder)


# What it does -----------------------------------------------------------------------------------


@pytest.mark.parametrize("button", STUCK.values(), ids=STUCK)
def test_recommended_form_resets_nothing_for_a_stuck_button(button: str) -> None:
    """Only a press that was seen counts, and one that was refused is not repeated."""
    assert resets(RECOMMENDED, button) == 0


def test_recommended_form_resets_nothing_for_a_loose_contact() -> None:
    """The stuck button reads up for two messages; a press within a second would count that."""
    assert resets(RECOMMENDED, LOOSE) == 0
    assert resets("button begins and ((not button) within 1 sec)", LOOSE) == 1


def test_recommended_form_resets_for_a_press() -> None:
    """It is seen up, and then down."""
    assert resets(RECOMMENDED, PRESS) == 1


@pytest.mark.parametrize(
    "form",
    [
        "button",
        "button = true",
        "button and not bad",
        "button begins",
        "button begins and not bad",
        "button for 0.2 sec",
        "button within 0.2 sec",
        "not bad since (button and not bad)",
        "button or (button and bad)",
        "button and ((up within 1 ms) or not bad)",
    ],
)
def test_form_with_the_remark_resets_for_a_stuck_button(form: str, tmp_path: Path) -> None:
    """It does so in one of the traces, at least."""
    (message,) = remarked(form, tmp_path)
    assert message.startswith("'button' held or stuck is enough for 'release', which resets 'stop'")
    assert any(resets(form, each) for each in STUCK.values())


@pytest.mark.parametrize(
    "form",
    [
        RECOMMENDED,
        f"{RECOMMENDED} and not bad",
        f"not bad since ({RECOMMENDED} and not bad)",
        f"({RECOMMENDED}) within 0.5 sec",
        "button and ((not button) within 0.1 sec)",
    ],
)
def test_form_that_asks_for_up_has_none(form: str, tmp_path: Path) -> None:
    """A button that was never up cannot make it true."""
    assert remarked(form, tmp_path) == []
    assert resets(form, STUCK["from the start"]) == 0


# What is a button -------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("form", "more", "names"),
    [
        ("named", "down: button; named: down and not bad;", "'button'"),
        ("not armed", "failsafe armed: not button or bad;", "'button'"),
        ("not bad or (button and left)", "", "'button' and 'left'"),
        ("(button or left) and not bad", "", "'button' and 'left'"),
        ("(left within 1 sec) and (right within 1 sec)", "", "'left' and 'right'"),
        ("left begins within 1 sec and right begins within 1 sec", "", "'left' and 'right'"),
        ("button and mode = 2", "", "'button'"),
        ("button and not left", "", "'button'"),
        ("joy.buttons[7] = 1", "", "'joy.buttons[7]'"),
        ("joy.buttons[7] != 0 and not bad", "", "'joy.buttons[7]'"),
    ],
)
def test_button_is_found(form: str, more: str, names: str, tmp_path: Path) -> None:
    """Through names, in each part of an ``or``, with others, and on a joystick."""
    (message,) = remarked(form, tmp_path, more)
    assert message.startswith(f"{names} held or stuck ")


@pytest.mark.parametrize(
    ("form", "more"),
    [
        ("not bad", ""),
        ("not bad for 2 sec", ""),
        ("v < 0.5", ""),
        ("mode = 2", ""),
        ("not left", ""),
        ("not left and not bad", ""),
        ("button.missing()", ""),
        ("not button.unknown()", ""),
        (f"{RECOMMENDED} and left", ""),
        ("joy.buttons[7] = 1 begins and (idle within 1 ms)", "idle: joy.buttons[7] = 0;"),
        ("joy.axes[1] = 1.0", ""),
    ],
)
def test_what_is_not_a_button_is_not(form: str, more: str, tmp_path: Path) -> None:
    """The action resets itself, a number says so, or a press beside it was seen."""
    assert remarked(form, tmp_path, more) == []


@pytest.mark.parametrize(
    ("stop", "is_state"),
    [
        ("bad or not button", True),
        ("unsafe", True),
        ("bad and not button", True),
        ("bad and button", False),
        ("bad or button.unknown()", False),
        ("armed", False),  # that it stays stopped without the button is what a reset is
    ],
)
def test_signal_that_stops_while_it_is_false_is_a_state(
    stop: str, is_state: bool, tmp_path: Path
) -> None:
    """A key that enables the robot may release it, too."""
    more = """failsafe unsafe: bad or not button;
      free: not bad since (button and not bad); failsafe armed: not free; s: %s;"""
    behaviours = "if e.s then { stop; }; if e.r then { release; };"
    found = remarked("button", tmp_path, more % stop, behaviours)
    assert (found == []) == is_state


# What is a reset --------------------------------------------------------------------------------


def test_condition_of_the_if_around_it_counts(tmp_path: Path) -> None:
    """A press that was seen outside is one; a button there is needed as one inside."""
    for outer, inner, count in ((RECOMMENDED, "left", 0), ("button", "not bad", 1)):
        behaviours = "if e.bad or e.lost then { stop; }; if e.o then { if e.r then { release; }; };"
        found = remarked(inner, tmp_path, f"o: {outer};", behaviours)
        assert len(found) == count


def test_behaviour_that_resets_nothing_has_no_remark(tmp_path: Path) -> None:
    """A button may stop the robot, or make it log."""
    behaviours = 'if e.r or e.lost then { stop; }; if e.up then { log_state("up"); };'
    assert (
        remarked("button", tmp_path, behaviours=f"{behaviours} if e.bad then {{ release; }};") == []
    )


@pytest.mark.parametrize(
    "actions",
    [
        # A permission that ends with the stop, as in the feeding robot.
        """action stop publishes true on /stop : std_msgs.Bool reset_by agreed;
           action agreed publishes true on /slow : std_msgs.Bool reset_by stop;""",
        # A lesser stop that ends with the greater one.
        """action slow publishes true on /slow : std_msgs.Bool reset_by stop;
           action stop publishes true on /stop : std_msgs.Bool latched;""",
        """action slow publishes true on /slow : std_msgs.Bool reset_by stop;
           action stop publishes true on /stop : std_msgs.Bool reset_by agreed;
           action agreed;""",
    ],
)
def test_stop_that_resets_others_is_not_a_permission(actions: str, tmp_path: Path) -> None:
    """A stop button may be a level: that it is held stops all the more."""
    slow = "if e.quick then { slow; };" if "action slow" in actions else ""
    agreed = "if e.calm then { agreed; };" if "action agreed" in actions else ""
    found = messages_of(
        f"""{actions}
        input v = topic /speed.data timeout 0.5 sec
        input button = topic /flag.data timeout 0.5 sec
        entity e {{
          hit: button or button.missing() or v.unknown(); quick: v > 2; calm: v < 0.1 for 1 sec;
        }}
        if e.hit then {{ stop; }}; {slow} {agreed}""",
        tmp_path,
    )
    assert found == []


def test_permission_that_ends_with_the_stop_is_one(tmp_path: Path) -> None:
    """Of two actions that reset each other, the one that no lost sensor triggers permits."""
    found = messages_of(
        """action stop publishes true on /stop : std_msgs.Bool reset_by agreed;
        action agreed publishes true on /slow : std_msgs.Bool reset_by stop;
        input v = topic /speed.data timeout 0.5 sec
        input button = topic /flag.data timeout 0.5 sec
        entity e { bad: v > 1 or v.unknown() or button.missing(); down: button; }
        if e.bad then { stop; }; if e.down then { agreed; };""",
        tmp_path,
    )
    (message,) = found
    assert "is enough for 'agreed', which resets 'stop'" in message
