"""Safety rules: from conditions, terms and declarations to the syntax tree."""

from __future__ import annotations

from decimal import Decimal

import pytest

from deros import codes
from deros.diagnostics import Code
from deros.interfaces.types import InterfaceType
from deros.metamodels.load import Repository
from deros.models.rules import (
    Action,
    ActionCall,
    And,
    Arithmetic,
    Begins,
    Behaviour,
    Boolean,
    Call,
    Comparison,
    Condition,
    Entries,
    For,
    Membership,
    NamePath,
    Negative,
    Not,
    Number,
    Once,
    Or,
    Rules,
    Since,
    String,
    Term,
    Times,
    TopicPath,
    Truth,
)


def _rules(text: str) -> Rules:
    loaded = Repository().load_text("a.deros", text)
    assert loaded.diagnostics == ()
    assert isinstance(loaded.model, Rules)
    return loaded.model


def _condition(text: str) -> Condition:
    (rule,) = _rules(f"entity e {{ r: {text}; }}").entities[0].rules
    return rule.condition


def _words(found: Condition | Term) -> str:
    """Return a tree with all its parentheses, for comparison."""
    match found:
        case And():
            return f"({' and '.join(map(_words, found.operands))})"
        case Or():
            return f"({' or '.join(map(_words, found.operands))})"
        case Not():
            return f"(not {_words(found.operand)})"
        case For():
            return f"({_words(found.operand)} for {_words(found.duration)})"
        case Once():
            return f"({_words(found.operand)} within {_words(found.duration)})"
        case Times():
            counted = f"{_words(found.count)} times within {_words(found.duration)}"
            return f"({_words(found.operand)} {counted})"
        case Begins():
            return f"({_words(found.operand)} begins)"
        case Since():
            return f"({_words(found.operand)} since {_words(found.cause)})"
        case Truth():
            return _words(found.operand)
        case Entries():
            return f"{found.word}({_words(found.condition)})"
        case Comparison():
            return f"({_words(found.left)} {found.operator} {_words(found.right)})"
        case Membership():
            opening, closing = "(["[found.lower_closed], ")]"[found.upper_closed]
            interval = f"{opening}{_words(found.lower)}, {_words(found.upper)}{closing}"
            return f"({_words(found.operand)} {'not ' * found.negated}in {interval})"
        case Entries():
            return f"{found.word}({_words(found.condition)})"
        case Number():
            return f"{found.value}{f' {found.unit}' if found.unit else ''}"
        case Boolean():
            return str(found.value).lower()
        case String():
            return repr(found.value)
        case Negative():
            return f"-{_words(found.operand)}"
        case Arithmetic():
            return f"({_words(found.left)} {found.operator} {_words(found.right)})"
        case NamePath():
            return ".".join(map(str, (found.name, *found.path)))
        case TopicPath():
            return "topic " + ".".join(map(str, (found.topic, *found.path)))
        case Call():
            receiver = f"{_words(found.receiver)}." if found.receiver else ""
            return f"{receiver}{found.function}({', '.join(map(_words, found.arguments))})"


CONDITIONS = (
    ("a or b and not c", "(a or (b and (not c)))"),
    ("(a or b) and c", "((a or b) and c)"),
    ("not a and b", "((not a) and b)"),
    ("not (a and b)", "(not (a and b))"),
    ("not not a", "(not (not a))"),
    ("not a > 5", "(not (a > 5))"),
    ("a and b or c and d for 2 sec", "(((a and b) or (c and d)) for 2 sec)"),
    ("(a > 5 for 1 sec) and b", "(((a > 5) for 1 sec) and b)"),
    ("a >= 1 since a > 2", "((a >= 1) since (a > 2))"),
    ("a or b since c and d", "((a or b) since (c and d))"),
    ("(not a since b) for 1 sec", "(((not a) since b) for 1 sec)"),
    ("since since since", "(since since since)"),
    ("a > since", "(a > since)"),
    ("a and b within 2 sec", "((a and b) within 2 sec)"),
    ("(a > 3 within 1 sec) since within", "(((a > 3) within 1 sec) since within)"),
    ("a > 3 begins and b", "(((a > 3) begins) and b)"),
    ("begins begins since begins", "((begins begins) since begins)"),
    ("a begins within 1 sec and b", "(((a begins) within 1 sec) and b)"),
    ("a begins 3 times within 1 sec and b", "((a 3 times within 1 sec) and b)"),
    ("a > 3 4 times within 5 m / s", "((a > 3) 4 times within 5 m/s)"),
    ("(a > 3 m 2 times within 1 sec) for 3 s", "(((a > 3 m) 2 times within 1 sec) for 3 s)"),
    ("times > 3 2 times within 1 sec", "((times > 3) 2 times within 1 sec)"),
    ("(not a since b > 2 begins) for 1 sec", "(((not a) since ((b > 2) begins)) for 1 sec)"),
    ("(a or b) begins", "((a or b) begins)"),
    ("not (a begins)", "(not (a begins))"),
    ("a == 5", "(a = 5)"),
    ("a != 5", "(a != 5)"),
    ("a <= 5 and b >= 4", "((a <= 5) and (b >= 4))"),
    ("a<-5", "(a < -5)"),
    ("a in [0, 1]", "(a in [0, 1])"),
    ("a in (0, 1)", "(a in (0, 1))"),
    ("a not in [0, 1)", "(a not in [0, 1))"),
    ("a in (-m, m]", "(a in (-m, m])"),
    ('a = true and b = "x"', "((a = true) and (b = 'x'))"),
    ("status.level = ERROR", "(status.level = ERROR)"),
    ("topic /a/b.c[2].d > 3", "(topic /a/b.c.2.d > 3)"),
    ("/a/b.c > ~/own.x", "(topic /a/b.c > topic ~/own.x)"),
    ("topic relative/name.x", "topic relative/name.x"),
    ("/a.\n  b.\n  c > 3", "(topic /a.b.c > 3)"),
    ("/a . b > 3", "(topic /a.b > 3)"),
    ("q.roll() > 8 deg", "(q.roll() > 8 deg)"),
    ("imu.orientation.roll().abs() > 1", "(imu.orientation.roll().abs() > 1)"),
    (
        "/scan.nearest(-30 deg, 30 deg) < 1.5 m",
        "(topic /scan.nearest(-30 deg, 30 deg) < 1.5 m)",
    ),
    ("v.missing() or v.age() > 100 ms", "(v.missing() or (v.age() > 100 ms))"),
    ("a > toDeg(0.5 rad)", "(a > toDeg(0.5 rad))"),
    ("a > -b.c", "(a > -b.c)"),
    ("any(a.v and not a.f) or b", "(any((a.v and (not a.f))) or b)"),
    ("count ( a > 3 or b ) >= 2 for 1 s", "((count(((a > 3) or b)) >= 2) for 1 s)"),
    ("all(a).unknown() and a.count() > any", "(all(a).unknown() and (a.count() > any))"),
    ("count > all and -count(a) < 2", "((count > all) and (-count(a) < 2))"),
    ("x > 5 m / s ** 2", "(x > 5 m/s**2)"),
    ("x > 5 m/s^2 or y > 3%", "((x > 5 m/s^2) or (y > 3 %))"),
    ("x > 90deg/s for 4sec", "((x > 90 deg/s) for 4 sec)"),
    ("x > 5 min for 2 min", "((x > 5 min) for 2 min)"),
    (
        "topic.abs() > name and name in [action, stop]",
        "((topic.abs() > name) and (name in [action, stop]))",
    ),
    ("topic and not input", "(topic and (not input))"),
    ("topic = 3", "(topic = 3)"),
    ("notable and orderly or informed", "((notable and orderly) or informed)"),
)


def test_conditions_are_parsed_with_their_precedence() -> None:
    """Precedence, ``for``, intervals, terms and units."""
    for text, tree in CONDITIONS:
        assert _words(_condition(text)) == tree, text


def test_numbers_are_exact() -> None:
    """A number keeps every written digit."""
    condition = _condition("a > 0.1000000000000000055511151231257827")
    assert isinstance(condition, Comparison)
    assert isinstance(condition.right, Number)
    assert condition.right.value == Decimal("0.1000000000000000055511151231257827")


def test_semicolons_are_optional() -> None:
    """The label of the next rule, or the keyword of the next statement, is not read as a unit."""
    rules = _rules(
        "const a = 5 const b = 2 m unit pace = 0.5 m/s action stop "
        "input x = topic /x.y timeout 1 sec entity e { r: x > 5 s: x > 6 t: x > b } "
        "if e.r for 5 sec then { stop } if e.s then { stop }"
    )
    assert [rule.name.text for rule in rules.entities[0].rules] == ["r", "s", "t"]
    assert len(rules.behaviours) == 2
    assert isinstance(rules.constants[0].value, Number)
    assert rules.constants[0].value.unit is None


def test_sections_come_in_any_order() -> None:
    """Declarations may precede the names they refer to, and sections may repeat."""
    rules = _rules(
        "if e.r then { stop; }; entity e { r: x; } action stop; input x = topic /x.data;"
    )
    assert len(rules.behaviours) == len(rules.entities) == len(rules.actions) == 1


def test_action_declarations_are_parsed() -> None:
    """Plain actions, arguments, bindings, resets and latches."""
    plain, beep, stop, motor, described = _rules(
        "action plain; action beep(times, pitch); "
        "action stop publishes true on /stop_robot : std_msgs.Bool reset_by ok; "
        "action motor latched publishes -1.5 on ~/motor : std_msgs/msg/Float64 "
        'action described "Says something";'
    ).actions
    assert (plain.parameters, plain.binding, plain.reset_by, plain.latched) == (
        (),
        None,
        None,
        False,
    )
    assert [parameter.text for parameter in beep.parameters] == ["times", "pitch"]
    assert stop.binding is not None
    assert isinstance(stop.binding.value, Boolean)
    assert stop.binding.topic.text == "/stop_robot"
    assert stop.binding.type == InterfaceType("std_msgs", "msg", "Bool")
    assert stop.reset_by is not None
    assert stop.reset_by.text == "ok"
    assert motor.latched
    assert motor.binding is not None
    assert motor.binding.type.name == "Float64"
    assert described.description == "Says something"


def test_input_declarations_are_parsed() -> None:
    """Timeout, description and ``=`` are optional, and the term may be a whole message."""
    field, whole, bare = _rules(
        'input a = topic /odom.twist.twist.linear.x timeout 0.5 sec "Speed" '
        "input b = topic /scan timeout 100ms input c topic /x.data"
    ).inputs
    assert field.timeout is not None
    assert (field.timeout.value, field.timeout.unit) == (Decimal("0.5"), "sec")
    assert field.description == "Speed"
    assert whole.term.path == ()
    assert bare.term.path == ("data",)


def test_behaviours_may_be_nested() -> None:
    """Names, nested behaviours and arguments; the body keeps its order."""
    (outer,) = _rules(
        "behaviour tilt: if e.r or not e.s then "
        '{ stop; if e.t for 1 sec then { beep(3, "x"); }; halt };'
    ).behaviours
    assert outer.name is not None
    assert outer.name.text == "tilt"
    first, nested, last = outer.body
    assert isinstance(first, ActionCall)
    assert isinstance(nested, Behaviour)
    assert isinstance(nested.condition, For)
    assert isinstance(nested.body[0], ActionCall)
    assert [_words(argument) for argument in nested.body[0].arguments] == ["3", "'x'"]
    assert isinstance(last, ActionCall)
    assert last.action.text == "halt"


def test_units_and_constants_may_refer_to_others() -> None:
    """A unit is a multiple of another; a constant is a number, a conversion or another constant."""
    rules = _rules("unit knot = 0.514444 m/s const a = toRad(-8 deg) const b = a const c = -a")
    (knot,) = rules.units
    assert (knot.name.text, str(knot.factor.value), knot.factor.unit) == ("knot", "0.514444", "m/s")
    assert [_words(constant.value) for constant in rules.constants] == ["toRad(-8 deg)", "a", "-a"]


def test_keywords_are_valid_names_where_unambiguous() -> None:
    """Actions, inputs, constants, entities and rules may have names that are keywords."""
    rules = _rules(
        "action stop action action action topic const use = 3 input input = topic /x.y "
        "entity entity { topic: input > use; for: use in [1, 2]; } "
        "if entity.topic and topic.for then { action; topic; use; }"
    )
    assert [action.name.text for action in rules.actions] == ["stop", "action", "topic"]
    assert [rule.name.text for rule in rules.entities[0].rules] == ["topic", "for"]
    (behaviour,) = rules.behaviours
    assert _words(behaviour.condition) == "(entity.topic and topic.for)"


def test_entities_and_rules_may_have_descriptions() -> None:
    """A text after the name describes an entity or a rule."""
    (entity,) = _rules('entity e "The body" { r "It leans": x; }').entities
    assert (entity.description, entity.rules[0].description) == ("The body", "It leans")


def test_spans_cover_exactly_their_words() -> None:
    """The spans of conditions, terms, units and names are exactly their words."""
    condition = _condition("not /a.b.rate() > 5 m/s for 2 sec")
    assert isinstance(condition, For)
    assert condition.span.text == "not /a.b.rate() > 5 m/s for 2 sec"
    negation = condition.operand
    assert isinstance(negation, Not)
    assert negation.span.text == "not /a.b.rate() > 5 m/s"
    comparison = negation.operand
    assert isinstance(comparison, Comparison)
    assert (comparison.left.span.text, comparison.right.span.text) == ("/a.b.rate()", "5 m/s")
    assert isinstance(comparison.left, Call)
    assert comparison.left.receiver is not None
    assert comparison.left.receiver.span.text == "/a.b"
    assert comparison.left.function.span.text == "rate"
    assert isinstance(comparison.right, Number)
    assert comparison.right.unit_span is not None
    assert comparison.right.unit_span.text == "m/s"


@pytest.mark.parametrize(
    ("text", "code", "place"),
    [
        ("action a latched latched;", codes.DUPLICATE_SECTION, "latched"),
        ("action a reset_by b reset_by c;", codes.DUPLICATE_SECTION, "reset_by c"),
        ("input x = topic /a.roll();", codes.SYNTAX_ERROR, ".roll()"),
        ('use "nix.system" import A', codes.UNKNOWN_IMPORT, '"nix.system"'),
        ('use "nix.rnd" import A', codes.UNKNOWN_LANGUAGE, '"nix.rnd"'),
    ],
)
def test_duplicates_and_misplaced_terms_are_findings(text: str, code: Code, place: str) -> None:
    """Duplicates and terms in the wrong place are reported where they are."""
    loaded = Repository().load_text("a.deros", text)
    assert [(finding.code, finding.span.text) for finding in loaded.diagnostics] == [(code, place)]


def test_action_named_twice_is_kept() -> None:
    """The parser does not judge names: both declarations reach the checks."""
    actions = _rules("action a; action a;").actions
    assert [type(action) for action in actions] == [Action, Action]
