"""Each language prints every step of a gate, or rejects it by name."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, get_args

import pytest
from jinja2.runtime import Macro

from deros import codes
from deros.generators.api.protocol import GenerationError
from deros.generators.gate.cpp import generate as cpp
from deros.generators.gate.cpp import view as cpp_view
from deros.generators.text.identifiers import snake_case
from deros.generators.text.templates import environment
from deros.monitor import gate_program as form
from deros.monitor.ir import Gate, GateLine
from tests.support import gate_cpp, gates

STEPS = {snake_case(step.__name__) for step in get_args(form.Step)}
VARIABLES = {snake_case(variable.__name__) for variable in get_args(form.Variable)}
GATE = Gate(
    0,
    "/wish",
    "/robot/command",
    gates.message_type("geometry_msgs.Twist"),
    10,
    (
        GateLine(0, None, None, (), gates.span(2), True),
        GateLine(None, "input", 5, (), gates.span(3)),
    ),
    gates.span(1),
    resume_on_zero=True,
)

Rendered = Callable[[form.GateProgram], str]


@dataclass(frozen=True)
class Slow:
    """A step, and a condition, without a rule."""


def in_cpp(program: form.GateProgram) -> str:
    """Return the logic of a gate in C++."""
    return cpp.render(
        "logic.cpp", replace(gate_cpp.view_of(program.gate, "robot"), program=program)
    )


both = pytest.mark.parametrize(("language", "render"), [("C++", in_cpp)])


def program() -> form.GateProgram:
    """Return the program of a gate with every reason to block commands."""
    return gates.view_of(GATE).program


@both
def test_step_without_a_rule_is_rejected_by_name(language: str, render: Rendered) -> None:
    """The message names step and language, and points at the gate."""
    assert render(program())
    unknown: Any = Slow()
    extended = replace(program(), settle=(*program().settle, unknown))
    with pytest.raises(GenerationError) as caught:
        render(extended)
    (finding,) = caught.value.diagnostics
    assert finding.message == f"the gate needs Slow, which does not exist in {language}"
    assert finding.code is codes.UNSUPPORTED_BY_TARGET
    assert finding.span == GATE.span


@both
def test_condition_without_a_rule_is_rejected_by_name(language: str, render: Rendered) -> None:
    """It may be anywhere within a step."""
    unknown: Any = Slow()
    zero = form.FindZero(form.AllOf((form.Not(unknown), form.IsWaiting())))
    extended = replace(program(), settle=(zero, *program().settle))
    with pytest.raises(
        GenerationError, match=re.escape(f"Slow, which does not exist in {language}")
    ):
        render(extended)


@pytest.mark.parametrize(
    ("package", "template", "names"),
    [
        ("cpp", "_steps.j2", STEPS),
        ("cpp", "_begin.j2", VARIABLES - {"latches"}),
        ("cpp", "_members.j2", VARIABLES),
    ],
)
def test_every_step_and_variable_has_a_rule(package: str, template: str, names: set[str]) -> None:
    """There are no unused rules either."""
    rules = environment(f"deros.generators.gate.{package}").get_template(template).module
    assert {name for name, rule in vars(rules).items() if isinstance(rule, Macro)} == names


def printers() -> list[cpp_view.Conditions]:
    """Return the printers of all languages for one gate."""
    return [cpp_view.Conditions(gate_cpp.view_of(GATE, "robot"))]


@pytest.mark.parametrize(
    ("condition", "expected"),
    [
        (form.Silent("input", 1500), ["t >= input_ + 1'500"]),
        (form.IsActive(0), ["stop_active_"]),
        (form.IsLost(("input",)), ["is_input_lost"]),
        (form.IsLatched(0), ["stop_latched_"]),
        (form.AnyOf(()), ["false"]),
        (
            form.AllOf((form.IsWaiting(), form.Not(form.IsZero()))),
            ["waits_ && !zero"],
        ),
        (
            form.AllOf((form.IsAnyLatched(), form.AnyOf((form.Applies(0), form.Applies(1))))),
            ["is_latched && (stop || lost_input)"],
        ),
        (
            form.Not(form.AnyOf((form.Applies(0), form.Applies(1)))),
            ["!stop && !lost_input"],
        ),
    ],
)
def test_conditions_are_printed_in_each_language(
    condition: form.Condition, expected: list[str]
) -> None:
    """Operands keep their order, with parentheses where precedence requires them."""
    assert [printer(condition) for printer in printers()] == expected
