"""The length of generated code is linear in the length of the rules, also for nested rules."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from deros.generators.monitor.c.interface import render_monitor as render_c
from deros.generators.monitor.python.render import render_monitor as render_python
from deros.rules.engine.engine import Engine
from deros.rules.program.ir import Program
from tests.support import timelines
from tests.support.needs import needs

Rule = Callable[[int], str]

HEAD = 'use "robot.system" import Robot\naction stop;\ninput v = topic /speed.data\n'


def nested(pattern: str) -> Rule:
    """Return rules with a pattern nested to a depth."""

    def rule(levels: int) -> str:
        text = "v > 1000"
        for number in range(100, 100 + levels):
            text = pattern.format(number=number, rest=text)
        return text

    return rule


def joined(word: str, pattern: str) -> Rule:
    """Return rules with a number of terms."""
    return lambda terms: f" {word} ".join(pattern.format(i) for i in range(1000, 1000 + terms))


NESTED = {
    "or_not_for": nested("(v > {number} or not ({rest}) for 1 sec)"),
    "or_for": nested("(v > {number} or ({rest}) for 1 sec)"),
    "not_and_not_for": nested("not (v > {number} and not ({rest}) for 1 sec) for 2 sec"),
    "and_not": nested("(v > {number} and not ({rest}))"),
}
WIDE = {
    "and": joined("and", "v != {}"),
    "or": joined("or", "v = {}"),
    "and_of_or": joined("and", "(v != {0} or v > {0})"),
}


def _rule(condition: str) -> Program:
    return timelines.program(f"{HEAD}entity e {{ r: {condition}; }}\nif e.r then {{ stop; }};", "r")


def _behaviour(terms: int) -> Program:
    condition = " or ".join(["e.r", "not e.r"] * (terms // 2))
    rule = "entity e { r: v > 1; }"
    return timelines.program(f"{HEAD}{rule}\nif {condition} then {{ stop; }};", "r")


def _rules(number: int) -> Program:
    rules = " ".join(f"r{i}: v > {i};" for i in range(1000, 1000 + number))
    body = "\n".join(f"if e.r{i} then {{ stop; }};" for i in range(1000, 1000 + number))
    return timelines.program(f"{HEAD}entity e {{ {rules} }}\n{body}", "r")


def _of(rule: Rule) -> Callable[[int], Program]:
    return lambda size: _rule(rule(size))


SHAPES: dict[str, tuple[Callable[[int], Program], int]] = {
    **{name: (_of(rule), 6) for name, rule in NESTED.items()},
    **{name: (_of(rule), 100) for name, rule in WIDE.items()},
    "behaviour": (_behaviour, 100),
    "rules": (_rules, 40),
}
"""Programs of variable size by name, and the smallest size to test."""


@pytest.mark.parametrize("name", SHAPES)
def test_text_grows_linearly_with_the_rules(name: str) -> None:
    """Twice as many terms or levels add twice as much text, except for indentation."""
    make, size = SHAPES[name]
    texts = [{**render_python(p), **render_c(p)} for p in map(make, _sizes(size))]
    for part in texts[0]:
        least, middle, most = (len("".join(text[part].split())) for text in texts)
        assert most - middle <= 2.2 * (middle - least) + 200, part


def _sizes(size: int) -> tuple[int, int, int]:
    return size, 2 * size, 4 * size


LARGE = {
    "600 terms of and": _rule(WIDE["and"](600)),
    "600 terms of or": _rule(WIDE["or"](600)),
    "600 terms in a behaviour": _behaviour(600),
    "30 levels of or not for": _rule(NESTED["or_not_for"](30)),
}


@pytest.mark.parametrize(
    "compiler", [pytest.param(name, marks=needs(name)) for name in ("gcc", "clang")]
)
@pytest.mark.parametrize("name", LARGE)
def test_large_rules_compile(name: str, compiler: str, tmp_path: Path) -> None:
    """Compilers limit nested calls, clang to 256; Python limits nested parentheses to 200."""
    program = LARGE[name]
    Engine(program).message(1, "/speed", {0: 0.5})
    for text in render_python(program).values():
        compile(text, name, "exec")
    for file, text in render_c(program).items():
        (tmp_path / file).write_text(text, encoding="utf-8")
    command = [compiler, "-std=c99", "-Wall", "-Wextra", "-Werror", "-c", "r_monitor.c"]
    subprocess.run(command, cwd=tmp_path, check=True, timeout=60)
