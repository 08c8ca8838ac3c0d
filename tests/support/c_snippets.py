"""Snippets of generated C, one for each construct, short enough to review.

Each is of the smallest rules that use the construct, and shows what these add to the snippets
before it. Whether together they show all that a monitor may have, ``c_shapes`` tells.
"""

from __future__ import annotations

import difflib
import functools
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from deros.generators.monitor.c.interface import render_monitor
from tests.support.c_everything import built


@dataclass(frozen=True)
class Snippet:
    """What is shown of the monitor of some rules, beside what has a name of its own.

    Attributes:
        rules: the rules.
        shown: names of functions, types and tables whose text differs from that shown before.
    """

    rules: str
    shown: tuple[str, ...]


STOP = "if e.r then { stop; };"
SPEED = "input v = topic /odom.twist.twist.linear.x"
SMALLEST = "smallest"
SMALLEST_RULES = f"action stop; input v = topic /flag.data entity e {{ r: v; }} {STOP}"


def _rule(source: str, condition: str, shown: str = "", said: str = "") -> Snippet:
    """Return the snippet of one rule about one input."""
    rules = f"action stop; input v = topic {source} entity e {{ {said}r: {condition}; }} {STOP}"
    return Snippet(rules, tuple(shown.split()))


def _acts(rest: str, shown: str) -> Snippet:
    """Return the snippet of what follows from two rules."""
    return Snippet(f"{SPEED} entity e {{ r: v > 1; s: v > 2; }} {rest}", tuple(shown.split()))


X = "/odom.twist.twist.linear.x"
SNIPPETS = {
    "comparison": _rule(X, "v > 1.5", "small_monitor judge_e_r observe_v"),
    "connectives": _rule(X, "v in [-1, 1) and not v = 0 or v != 2", "judge_e_r observe_v"),
    "timeout": _rule(
        f"{X} timeout 0.5 sec",
        "v > 1 or v.missing() or v.age() > 0.2 sec",
        "small_monitor judge_e_r observe_v earliest restart reach_deadline small_waiting",
    ),
    "unknown": _rule(f"{X} timeout 0.5 sec", "v.unknown()", "judge_e_r observe_v"),
    "failsafe": _rule(f"{X} timeout 0.5 sec", "v > 1", "judge_e_r", said="failsafe "),
    "duration": _rule(X, "v > 1.5 for 2 sec", "small_monitor judge_e_r earliest restart"),
    "within": _rule(X, "v > 1.5 within 2 sec", "small_monitor judge_e_r earliest restart"),
    "since": _rule(X, "v > 1.5 since v < 0", "small_monitor judge_e_r restart"),
    "begins": _rule(X, "v > 1.5 begins", "begun judge_e_r"),
    "named_rule": Snippet(
        f"action stop; {SPEED} entity e {{ q: v > 1; r: v < 2 and not q for 1 sec; }} {STOP}",
        ("judge_e_r", "after_v"),
    ),
    "two_inputs": Snippet(
        "action stop; input v = topic /odom.twist.twist.linear.x timeout 1 sec "
        f"input w = topic /odom.twist.twist.linear.y entity e {{ r: v > w; }} {STOP}",
        ("judge_e_r", "observe_odom", "restart"),
    ),
    "integer": _rule("/mode.data", "v in [-3, 5)", "judge_e_r observe_v"),
    "magnitude": _rule("/mode.data", "v.abs() > 2", "observe_v"),
    "itself": _rule("/ticks.data", "v = v", "judge_e_r"),
    "unsigned": _rule("/beats.data", "v > 5", "small_monitor judge_e_r observe_v"),
    "text": _rule(
        "/state.data", 'v = "säge" or v != "\\"??/"', "small_monitor judge_e_r observe_v"
    ),
    "element": _rule("/diagnostics.status[1].level", "v > 1", "observe_v"),
    "angle": _rule(
        "/imu.orientation",
        "v.roll() in [0, 1] or v.pitch() > 1 or v.yaw() > 1 or v.tilt() > 1",
        "observe_v",
    ),
    "vector": _rule("/imu.angular_velocity", "v.norm() > 1", "observe_v"),
    "scan": _rule("/scan", "v.nearest(-30 deg, 30 deg) < 0.4", "observe_v"),
    "numbers": _rule("/joints.position", "v.max() > 1 or v.min() < 1", "observe_v"),
    "few_numbers": _rule(
        "/battery.cell_voltage", "v.min() < 3", "are_numbers_float32 least_float32"
    ),
    "integers": _rule(
        "/levels.data",
        "v.max() > 1 or v.min() < 1 or v.count() = 0",
        "least_int16 greatest_int16 observe_v",
    ),
    "unsigned_integers": _rule("/counters.data", "v.max() > 1", "greatest_uint64 observe_v"),
    "count": _rule("/joints.name", "v.count() != 6", "observe_v"),
    "rate": _rule(X, "v.rate() > 2 or v.abs() > 2", "forget_v restart observe_v"),
    "previous": _rule(X, "v.previous() > 2", "observe_v"),
    "rate_over": _rule(X, "v.rate(1 sec) > 2", "small_monitor forget_v observe_v"),
    "turning": _rule("/imu.orientation", "v.yaw().rate() > 2", "small_monitor clear observe_v"),
    "arithmetic": _rule(
        "/battery.percentage",
        "hypot(v, sqrt(2 * abs(v))) in (0.5, 2) and sin(v) / v < min(max(v, 0.5), 2) - v",
        "least greatest compute_1 compute_2 compute_3 observe_v",
    ),
    "arithmetic_of_integers": _rule(
        "/mode.data", "abs(v - 1) > v / 2", "compute_1 compute_2 observe_v"
    ),
    "behaviour": _acts(
        "action stop; action beep(times, text, loud, pitch, slow); behaviour near: "
        'if e.r then { stop; if e.s then { beep(-3, "a", true, 0.5, false); }; stop; };',
        "small_site small_sites behave_near",
    ),
    "latched_action": _acts(
        "action stop latched; if e.r then { stop; }; if e.s then { stop; };", "behave_behaviour_1"
    ),
    "reset_by": _acts(
        "action stop reset_by ok; action ok; if e.r then { stop; }; if e.s then { ok; };",
        "small_monitor settle_stop behave_behaviour_2 act clear",
    ),
    "optional_behaviour": _acts(
        "action stop; optional behaviour near: if e.r then { stop; };",
        "small_monitor clear behave_near",
    ),
    "lasting_behaviour": _acts(
        "action stop; if e.r for 1 sec then { stop; }; "
        "if e.r since e.s then { stop; }; if (not e.r) within 1 sec then { stop; };",
        "behave_behaviour_1 behave_behaviour_2 behave_behaviour_3 after_v",
    ),
}
"""Constructs by name."""

KINDS = (
    (
        r"(judge_by|judge|behave|settle|forget|which|expire|observe|after|take|compute|arguments"
        r"|small_on|small_latch|small_enable)_(?!all\b)\w+",
        r"\1",
    ),
    (r"(least|greatest|are_numbers)_\w+", r"\1"),
)
"""Names that come from rules in part, and that part left out."""


@functools.cache
def texts(rules: str) -> Mapping[str, str]:
    """Return the header and the source of the monitor of some rules, by the end of their names."""
    made = render_monitor(built(f'use "robot.system" import Robot\n{rules}', "small"))
    return {end: made[f"small_monitor.{end}"] for end in ("h", "c")}


def shown() -> dict[str, dict[str, str]]:
    """Return what each snippet is to show: blocks of the source or the header, by their names.

    The smallest monitor is shown whole. A snippet shows what it lists, and the first block of a
    kind wherever that appears.

    Raises:
        AssertionError: something to be shown is not there.
    """
    made = {SMALLEST: _blocks(SMALLEST_RULES)}
    kinds = {kind_of(each) for each in made[SMALLEST]}
    for name, each in SNIPPETS.items():
        blocks = _blocks(each.rules)
        assert set(each.shown) <= set(blocks), sorted(blocks)
        made[name] = {
            key: block
            for key, block in blocks.items()
            if key in each.shown or kind_of(key) not in kinds
        }
        kinds |= {kind_of(key) for key in made[name]}
    return made


def snippets() -> dict[str, str]:
    """Return the text of each snippet, by its name.

    Of two blocks of a kind, the second one has the number of lines in place of those that both
    have. So a change of what they share is read once.
    """
    before: dict[str, dict[str, list[str]]] = {}
    made: dict[str, str] = {}
    for name, blocks in shown().items():
        parts = []
        for key, block in blocks.items():
            alike = before.setdefault(kind_of(key), {})
            parts.append(_shortened(_bare(block), alike) if alike else block)
            alike.setdefault(name, _bare(block))
        if name in SNIPPETS:
            made[name] = "\n\n".join([f"/* {SNIPPETS[name].rules} */", *parts]) + "\n"
    return made


def _shortened(lines: list[str], before: Mapping[str, list[str]]) -> str:
    """Return a block with the number of lines in place of those that another one has as well.

    Args:
        lines: of the block.
        before: the blocks of its kind, by the snippets that show them.
    """
    matchers = {name: difflib.SequenceMatcher(None, other, lines) for name, other in before.items()}
    name = max(matchers, key=lambda each: matchers[each].ratio())
    body = lines.index("{") + 1 if "{" in lines and lines[0] != "typedef struct" else 0
    text = lines[:body]
    for what, _, _, start, end in matchers[name].get_opcodes():
        start, end = max(start, body), min(end, len(lines) - 1)
        is_long = what == "equal" and end - start > 1
        text += [f"  /* {end - start} lines of {name} */"] if is_long else lines[start:end]
    return "\n".join([*text, lines[-1]])


def _bare(block: str) -> list[str]:
    """Return the lines of a block without what they quote of the rules."""
    return re.sub(r"^ */\*[^@].*?\*/\n", "", block, flags=re.DOTALL | re.MULTILINE).splitlines()


def kind_of(name: str) -> str:
    """Return the name of a function, type or table without what comes from the rules."""
    for pattern, form in KINDS:
        name = re.sub(pattern, form, name)
    return name


_NAMED = re.compile(
    r"^(?:\} (\w+);$|#define (\w+) |(?:static )?const \w+ (\w+)\[|\w[^;{(]*?(\w+)\()",
    re.MULTILINE,
)


def _blocks(rules: str) -> dict[str, str]:
    """Return the named blocks of the header and the source of the monitor of some rules."""
    return {name: block for text in texts(rules).values() for name, block in named(text) if name}


def named(text: str) -> Iterator[tuple[str, str]]:
    """Yield what is between empty lines, with the name that it declares or defines, if any."""
    for block in map(str.strip, text.split("\n\n")):
        match = _NAMED.search(block)
        name = next(filter(None, match.groups())) if match else ""
        yield (f"{name};" if match and match[4] and block.endswith(";") else name), block
