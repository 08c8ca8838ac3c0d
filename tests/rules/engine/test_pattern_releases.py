"""The patterns that release the robot do so at a press that was seen, whatever buttons do."""

from __future__ import annotations

import random
from collections.abc import Iterator
from pathlib import Path

import pytest

from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.rules.compiler.build import build
from deros.rules.engine.engine import Engine
from deros.rules.program.ir import Program
from tests.support import timelines
from tests.support.rules import embedded_store

PAGE = Path(__file__).parents[3] / "docs/patterns.md"
RULES = {each.name.split(",")[0]: each.rules for each in timelines.read(PAGE)}
MS = 10**6
TRACES = 200
LENGTH = 60

Message = tuple[int, str, bool]
"""When, in ms, on which topic, which value."""


def _armed(history: list[Message]) -> bool:
    """Return whether the last message is a press after 0.1 s of up, with the door closed."""
    now, topic, pressed = history[-1]
    doors = [(t, is_open) for t, name, is_open in history if name == "/door_open"]
    is_closed = bool(doors) and not doors[-1][1] and now - doors[-1][0] <= 500
    if topic != "/button" or not pressed or not is_closed:
        return False
    after = up = now
    for t, name, value in reversed(history[:-1]):
        if name != "/button":
            continue
        if value or after - t > 500:
            break
        after = up = t
    return now - up >= 100


def _two_hands(history: list[Message]) -> bool:
    """Return whether both were seen up, and then pressed for the first time within 0.5 s."""
    now = history[-1][0]
    state: dict[str, tuple[int, bool]] = {}
    first_press: int | None = None  # since both were seen up
    is_ready = False
    for t, name, value in history:
        if any(t - at > 300 for at, _ in state.values()):
            is_ready = False
        was_held = len(state) == 2 and all(pressed for _, pressed in state.values())
        if was_held and t < now:
            is_ready = False
        state[name] = (t, value)
        pressed_ones = [pressed for _, pressed in state.values()]
        if len(state) == 2 and not any(pressed_ones):
            is_ready, first_press = True, None
        elif first_press is None:
            first_press = t
    is_held = len(state) == 2 and all(pressed for _, pressed in state.values())
    return is_held and is_ready and first_press is not None and now - first_press <= 500


PATTERNS = {
    "Armed until reset": (("/button", "/door_open"), _armed),
    "Two-hand control": (("/left", "/right"), _two_hands),
}

WEAKER = (
    ("Armed until reset", " and (up within 1 ms)", ""),
    ("Armed until reset", " for 0.1 sec", ""),
    ("Two-hand control", " and (up within 0.5 sec)", ""),
    ("Two-hand control", " and not let_go", ""),
    ("Two-hand control", " and not gap", ""),
    ("Two-hand control", "held begins", "held"),
)
"""Parts of a pattern, and what stands in their place in a weaker one."""


@pytest.mark.parametrize("name", PATTERNS)
def test_nothing_but_a_press_releases(name: str, tmp_path: Path) -> None:
    """At each release the history has what the pattern asks for; and there are releases."""
    rules = program(RULES[name], tmp_path)
    checked = [is_right for seed in range(TRACES) for is_right in _releases(name, rules, seed)]
    assert len(checked) > TRACES / 10
    assert all(checked)


@pytest.mark.parametrize(("name", "part", "instead"), WEAKER)
def test_weaker_rule_releases_without_a_press(
    name: str, part: str, instead: str, tmp_path: Path
) -> None:
    """Each part of the two patterns is needed."""
    assert RULES[name].count(part) == 1
    rules = program(RULES[name].replace(part, instead), tmp_path)
    assert not all(is_right for seed in range(TRACES) for is_right in _releases(name, rules, seed))


def program(text: str, folder: Path) -> Program:
    """Build rules on the system of the page."""
    (folder / "robot.system").write_text(timelines.system(PAGE), encoding="utf-8")
    model = Repository().load_text(folder / "rules.deros", text).model
    assert isinstance(model, Rules)
    result = build(model, embedded_store())
    assert result.program is not None, result.diagnostics
    return result.program


def _releases(name: str, rules: Program, seed: int) -> Iterator[bool]:
    """Yield of each release in a random trace whether it is right."""
    topics, is_right = PATTERNS[name]
    leaves = {rules.inputs[leaf.input].topic: leaf.index for leaf in rules.leaves}
    engine = Engine(rules, 0)
    history: list[Message] = []
    for message in _trace(topics, random.Random(seed)):
        t, topic, value = message
        done = len(engine.events)
        engine.advance(t * MS)
        # Between messages nothing may release: time alone is nobody's press.
        yield from (False for each in engine.events[done:] if each.kind == "reset")
        done = len(engine.events)
        engine.message(t * MS, topic, {leaves[topic]: value})
        history.append(message)
        if any(each.kind == "reset" for each in engine.events[done:]):
            yield is_right(history)


def _trace(topics: tuple[str, str], random_: random.Random) -> Iterator[Message]:
    """Yield messages of two switches that are pressed, held, silent and bounce at random."""
    t = 0
    values = dict.fromkeys(topics, False)
    for topic in topics:
        values[topic] = random_.random() < 0.5
    for _ in range(LENGTH):
        t += random_.choice((1, 10, 50, 100, 100, 200, 350, 600))
        for topic in random_.sample(topics, random_.choice((1, 2))):
            if random_.random() < 0.3:
                values[topic] = not values[topic]
            yield t, topic, values[topic]
            t += random_.choice((1, 1, 20))
