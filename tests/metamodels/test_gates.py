"""Gates and optional behaviours: from source text to syntax tree."""

from __future__ import annotations

from decimal import Decimal

import pytest

from deros.diagnostics import Diagnostic
from deros.interfaces.types import InterfaceType
from deros.metamodels.languages import DEROS
from deros.metamodels.load import Repository
from deros.metamodels.parsers import metamodel
from deros.models.rules import (
    ActionCall,
    Gate,
    GateLimit,
    NamePath,
    Negative,
    Number,
    Rules,
)

PRINTED = """gate /cmd_vel_nav -> /cmd_vel : geometry_msgs.Twist rate 20 Hz {
  stop: zero;
  low_speed: limit linear.x to [-0.1, 0.1] m/s, angular.z to [-0.2, 0.2] rad/s;
  lost heartbeat for 0.3 sec: zero;
  lost input for 0.5 sec: zero;
}
"""


def _load(text: str) -> tuple[Rules, tuple[Diagnostic, ...]]:
    loaded = Repository().load_text("a.deros", text)
    assert isinstance(loaded.model, Rules)
    return loaded.model, loaded.diagnostics


def _rules(text: str) -> Rules:
    rules, diagnostics = _load(text)
    assert diagnostics == ()
    return rules


def _gate(text: str) -> Gate:
    (gate,) = _rules(text).gates
    return gate


def _errors(text: str) -> list[tuple[str, str, str]]:
    loaded = Repository().load_text("a.deros", text)
    return [
        (diagnostic.message, diagnostic.span.text, diagnostic.hint)
        for diagnostic in loaded.diagnostics
    ]


def test_documented_gate_is_parsed() -> None:
    """Topics, type, rate and every line of the example in the documentation."""
    gate = _gate(PRINTED)
    assert (gate.sources[0].topic.text, gate.target.text) == ("/cmd_vel_nav", "/cmd_vel")
    assert gate.type == InterfaceType("geometry_msgs", "msg", "Twist")
    assert (gate.rate.value, gate.rate.unit) == (Decimal(20), "Hz")
    assert [
        (line.action and line.action.text, line.lost, line.duration and line.duration.span.text)
        for line in gate.lines
    ] == [
        ("stop", None, None),
        ("low_speed", None, None),
        (None, "heartbeat", "0.3 sec"),
        (None, "input", "0.5 sec"),
    ]
    assert [len(line.limits) for line in gate.lines] == [0, 2, 0, 0]
    first, second = gate.lines[1].limits
    assert (first.path, first.unit, first.lower_closed, first.upper_closed) == (
        ("linear", "x"),
        "m/s",
        True,
        True,
    )
    assert [each.value for each in (first.lower, first.upper) if isinstance(each, Number)] == [
        Decimal("-0.1"),
        Decimal("0.1"),
    ]
    assert (second.path, second.unit) == (("angular", "z"), "rad/s")


def test_documented_gate_is_parsed_by_textx() -> None:
    """The metamodel that textX itself uses accepts it."""
    model = metamodel(DEROS).model_from_str(PRINTED)
    (gate,) = model.statements
    assert [line.action for line in gate.lines] == ["stop", "low_speed", None, None]


@pytest.mark.parametrize(
    "text",
    [
        "gate a->b:geometry_msgs/Twist rate 20Hz{stop:zero low:limit linear.x to[-1,1]m/s"
        " lost heartbeat for 1s:zero lost input for 1 s:zero}",
        "gate\na\n->\nb\n:\ngeometry_msgs . Twist\nrate\n20\nHz\n{\nstop\n:\nzero\n;\n}".replace(
            " . ", "."
        ),
        'gate /a -> /b : geometry_msgs.Twist rate 20 Hz "The drive" { stop : zero } ;',
        "gate ~/a -> ~/b : geometry_msgs.Twist rate 20 Hz // why\n { /* nothing */ stop: zero; }",
    ],
)
def test_gate_layout_is_free(text: str) -> None:
    """Spaces, line breaks and semicolons are optional."""
    gate = _gate(f"const a = 3 {text} const b = 1")
    assert gate.sources[0].topic.text.endswith("a")
    assert gate.target.text.endswith("b")
    assert all(line.action or line.duration for line in gate.lines)


def test_reset_and_resume_clauses() -> None:
    """`until reset` belongs to its line, `resume on zero command` to the gate, wherever it is."""
    for text in (
        "stop: zero until reset; lost input for 1 s: zero; resume on zero command;",
        "resume on zero command stop: zero until reset lost input for 1 s: zero",
        "stop :zero until\nreset\nresume on\nzero command lost input for 1 s : zero",
    ):
        gate = _gate(f"gate a -> b : x.Y rate 1 Hz {{ {text} }}")
        assert [line.until_reset for line in gate.lines] == [True, False]
        assert gate.resume is not None
        assert gate.resume.text.split()[0] == "resume"
    assert _gate(PRINTED).resume is None


def test_gate_may_have_a_description() -> None:
    """A text after the rate describes the gate."""
    assert _gate('gate a -> b : x.Y rate 1 Hz "The drive" { a: zero; }').description == "The drive"


def _limit(text: str) -> GateLimit:
    (line,) = _gate(f"gate a -> b : x.Y rate 1 Hz {{ stop: limit {text}; }}").lines
    (limit,) = line.limits
    return limit


def test_limit_bounds_may_have_names_and_units() -> None:
    """Bounds may be names, have their own units, and be open or closed."""
    limit = _limit("position[2].x to (-low, 3 cm] m")
    assert limit.path == ("position", 2, "x")
    assert (limit.lower_closed, limit.upper_closed) == (False, True)
    assert isinstance(limit.lower, Negative)
    assert isinstance(limit.lower.operand, NamePath)
    assert isinstance(limit.upper, Number)
    assert (limit.upper.unit, limit.unit) == ("cm", "m")


def test_limit_has_exact_spans() -> None:
    """A limit stores the spans of its field, interval and unit."""
    limit = _limit("linear.x to [-1, 1] m/s")
    spans = (limit.span, limit.path_span, limit.interval_span, limit.unit_span)
    assert [span.text for span in spans if span] == [
        "linear.x to [-1, 1] m/s",
        "linear.x",
        "[-1, 1]",
        "m/s",
    ]


def test_gate_keywords_are_valid_names() -> None:
    """Actions, fields, constants and behaviours may have names that are keywords of gates."""
    rules = _rules(
        """action gate; action lost; action zero; action limit; action heartbeat; action optional;
        action input; action rate; action to;
        const lost = 3 const gate = lost const optional = gate const to = 1
        entity gate { lost: optional > 3; zero: gate.rate > 1; }
        behaviour optional: if gate.lost then { optional; gate; lost; zero; };
        optional behaviour gate: if gate.lost then { optional };
        gate gate -> lost : x.Y rate 1 Hz {
          lost: zero; gate: zero heartbeat: zero input: zero optional: limit to to [to, gate]
          zero: limit limit to [0, 1], zero.to to [0, 1]
          lost heartbeat for 1 sec: zero
        }"""
    )
    (gate,) = rules.gates
    assert [line.action.text for line in gate.lines if line.action] == [
        "lost",
        "gate",
        "heartbeat",
        "input",
        "optional",
        "zero",
    ]
    assert [limit.path for line in gate.lines for limit in line.limits] == [
        ("to",),
        ("limit",),
        ("zero", "to"),
    ]
    assert [
        (behaviour.name and behaviour.name.text, behaviour.optional)
        for behaviour in rules.behaviours
    ] == [
        ("optional", False),
        ("gate", True),
    ]


def test_clause_keywords_are_valid_action_names() -> None:
    """`until`, `reset`, `resume` and `command` are keywords only in their places."""
    (gate,) = _rules(
        """gate a -> b : x.Y rate 1 Hz {
          resume: zero until: zero until reset reset: limit x to [0, 1] resume on zero command
          command: limit y to [0, 1] until: zero on: zero
        }"""
    ).gates
    assert [line.action and line.action.text for line in gate.lines] == [
        "resume",
        "until",
        "reset",
        "command",
        "until",
        "on",
    ]
    assert [line.until_reset for line in gate.lines] == [False, True, *[False] * 4]
    assert all(limit.unit is None for line in gate.lines for limit in line.limits)


def test_gate_keywords_after_a_number_are_not_units() -> None:
    """``gate``, ``optional`` and ``lost`` start the next statement."""
    rules = _rules(
        """const a = 3 gate a -> b : x.Y rate 1 Hz { s: limit x to [0, 1] lost input for 1 s: zero }
        const b = 4 optional behaviour c: if e.r then { s; }"""
    )
    values = [constant.value for constant in rules.constants]
    assert [value.unit for value in values if isinstance(value, Number)] == [None, None]
    assert [limit.unit for limit in rules.gates[0].lines[0].limits] == [None]


def test_keyword_makes_a_behaviour_optional() -> None:
    """``optional`` before a named behaviour, nested or not, makes it optional."""
    (outer,) = _rules(
        "optional behaviour a: if e.r then { stop; optional behaviour b: if e.s then { stop; } };"
    ).behaviours
    inner = outer.body[1]
    assert not isinstance(inner, ActionCall)
    assert (outer.optional, inner.optional, inner.name and inner.name.text) == (True, True, "b")


def test_optional_behaviour_needs_a_name() -> None:
    """The name is required to disable it."""
    assert _errors("optional if e.r then { stop; };") == [
        (
            "an optional behaviour needs a name, by which it is switched off",
            "optional",
            "write 'optional behaviour NAME: if …'",
        )
    ]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("gate a -> b { }", "found '{' where ':' is expected"),
        (
            "gate a b : x.Y rate 1 Hz { lost input for 1 sec: zero; }",
            "found 'b' where 'for', 'from', 'over' or '->' is expected",
        ),
        ("gate a -> b : x.Y { }", "found '{' where 'rate' is expected"),
        (
            "gate a -> b : x.Y rate 1 Hz { }",
            "found '}' where something else is expected: 'wait', 'always', 'lost'",
        ),
        ("gate a -> b : x.Y rate 1 Hz { always: zero; }", "found 'zero' where 'limit' is"),
        ("gate a -> b : x.Y rate 1 Hz { wait 1 sec moving: s; }", "found 'moving' where 'before'"),
        ("gate a -> b : x.Y rate 1 Hz { s: zero until; }", "found ';' where 'reset' or ':' is"),
        ("gate a -> b : x.Y rate 1 Hz { resume on zero; }", "found ';' where 'command' is"),
        ("gate a -> b : x.Y rate 1 Hz { resume on zero command; }", "a gate needs a line that"),
        (
            "gate a -> b : x.Y rate 1 Hz { stop: zreo; }",
            "found 'zreo' where something else is expected: 'zero', 'send'",
        ),
        ("gate a -> b : x.Y rate 1 Hz { s: limit x in [0, 1]; }", "found 'in' where"),
        ("gate a for -> b : x.Y rate 1 Hz { s: zero; }", "found '-' where a number is"),
        ("gate a from b -> c : x.Y rate 1 Hz { s: zero; }", "found 'b' where 'zero' is"),
        ("gate a over -> b : x.Y rate 1 Hz { s: zero; }", "found '-' where a topic name is"),
        ("gate a -> b : x.Y rate 1 Hz { lost command for 1 s: zero; }", "found 'command' where"),
    ],
)
def test_gate_syntax_error_names_the_missing_token(text: str, message: str) -> None:
    """The message names the missing token at its place."""
    (error,) = _errors(text)
    assert error[0].startswith(message)
