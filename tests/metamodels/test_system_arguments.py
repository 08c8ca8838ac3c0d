"""Arguments of systems, expressions and conditions: what their text is converted to."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros import codes
from deros.metamodels.load import Repository
from deros.models.arguments import (
    Argument,
    Calculation,
    Chosen,
    Compared,
    Condition,
    Expression,
    Holds,
    Interpolation,
    Joined,
    Literally,
    Lookup,
    Not,
    OneOf,
    Opposite,
)
from deros.models.common import Interval
from deros.models.node import ParameterType
from deros.models.system import NodeInstance, ParameterSetting, Subsystem, System

NODE = "node camera : cameras publishes topic /image : sensor_msgs.Image\n"


def _system(folder: Path, body: str) -> System:
    (folder / "camera.rnd").write_text(NODE, encoding="utf-8")
    text = f'system S imports import "camera.rnd" {body}'
    loaded = Repository().load_text(folder / "s.system", text)
    assert loaded.diagnostics == ()
    assert isinstance(loaded.model, System)
    return loaded.model


def _setting(folder: Path, text: str) -> ParameterSetting:
    (node,) = _system(folder, f"node n : camera parameters param x = {text}").members
    assert isinstance(node, NodeInstance)
    return node.parameters[0]


def _expression(folder: Path, text: str) -> Expression:
    found = _setting(folder, text).value_from
    assert found is not None
    assert not isinstance(found, tuple)
    return found


def _condition(folder: Path, text: str) -> Condition:
    (node,) = _system(folder, f"node n : camera when {text}").members
    assert isinstance(node, NodeInstance)
    assert node.when is not None
    return node.when


def _shown(found: Expression | Condition) -> str:
    """Return an expression or a condition with all its parentheses."""
    match found:
        case Literally(value):
            return repr(value)
        case Lookup(function, name, default):
            return f"{function}({name}, {default})"
        case Argument(name):
            return name
        case Opposite(operand):
            return f"(-{_shown(operand)})"
        case Calculation(word, left, right) | Compared(word, left, right):
            return f"({_shown(left)} {word} {_shown(right)})"
        case Chosen(condition, chosen, otherwise):
            parts = map(_shown, (condition, chosen, otherwise))
            return "(if {} then {} else {})".format(*parts)
        case Holds(operand):
            return f"{_shown(operand)}?"
        case OneOf(operand, choices):
            return f"({_shown(operand)} in {[each.value for each in choices]})"
        case Not(operand):
            return f"(not {_shown(operand)})"
        case Joined(word, operands):
            return f"({f' {word} '.join(map(_shown, operands))})"
        case Interpolation(pieces):
            return "".join(
                each if isinstance(each, str) else f"<{_shown(each)}>" for each in pieces
            )


def test_argument_is_declared_as_a_parameter_is(tmp_path: Path) -> None:
    """It has a type, a default or none, bounds, a unit and a description."""
    speed, mode, needed = _system(
        tmp_path,
        'argument speed : double = 1 in [0, 2] [m/s] "Of the base" '
        'argument mode : string = "auto" one_of ["auto", "off"] argument needed : int',
    ).arguments
    assert (speed.name, speed.type, speed.default) == ("speed", ParameterType.DOUBLE, 1.0)
    assert isinstance(speed.default, float)
    assert (speed.interval, speed.unit) == (Interval(0.0, 2.0), "m/s")
    assert speed.description == "Of the base"
    assert mode.choices == ("auto", "off")
    assert (needed.type, needed.default) == (ParameterType.INTEGER, None)


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("$a", "a"),
        ("$a + 2 * $b", "(a + (2 * b))"),
        ("if c then $a else 2", "(if c? then a else 2)"),
        ("if not c and a > 1 then $a else 2", "(if ((not c?) and (a > 1)) then a else 2)"),
        ("2 * (if c then $a else 2) + 1", "((2 * (if c? then a else 2)) + 1)"),
        (
            "if c then 1 else if d then 2 else 3 + $a",
            "(if c? then 1 else (if d? then 2 else (3 + a)))",
        ),
        ("$a - 1 - $b", "((a - 1) - b)"),
        ("$a / 2 / $b", "((a / 2) / b)"),
        ("($a - 1) * -$b", "((a - 1) * (-b))"),
        ("-($a + 1)", "(-(a + 1))"),
        ("3 - 1", "(3 - 1)"),
        ("3 -1", "(3 - 1)"),
        ("3-$a", "(3 - a)"),
        ("2.5e1 * $a", "(25.0 * a)"),
        ("$a // nothing but a comment\n", "a"),
        ("$a /* 2 */ * 3", "(a * 3)"),
    ],
)
def test_precedence_of_calculations(tmp_path: Path, text: str, shown: str) -> None:
    """``* /`` come before ``+ -``; equals go from left to right, and a comment divides nothing."""
    assert _shown(_expression(tmp_path, text)) == shown


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("slam", "slam?"),
        ("$slam", "slam?"),
        ("not slam and a = 3 or b", "(((not slam?) and (a = 3)) or b?)"),
        ("a or b and not (c or d)", "(a? or (b? and (not (c? or d?))))"),
        ("not not a", "(not (not a?))"),
        ("a and b and c", "(a? and b? and c?)"),
        ("0.5 <= $speed", "(0.5 <= speed)"),
        ("mode != other", "(mode != other)"),
        ('mode in ["auto", "off"]', "(mode in ['auto', 'off'])"),
        ("n in [1, 2.5] and true", "((n in [1, 2.5]) and True?)"),
        ("x > -3", "(x > -3)"),
    ],
)
def test_precedence_of_conditions(tmp_path: Path, text: str, shown: str) -> None:
    """``not`` comes before ``and``, that before ``or``; an argument needs no ``$``."""
    assert _shown(_condition(tmp_path, text)) == shown


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ('"${robot}_base"', "<robot>_base"),
        ('"/${a}/${b}"', "/<a>/<b>"),
        ('"$${a} ${b}"', "${a} <b>"),
        (r'"say \"${a}\" \\ "', 'say "<a>" \\ '),
    ],
)
def test_text_with_arguments(tmp_path: Path, text: str, shown: str) -> None:
    """``${name}`` is a value, ``$${`` stands for ``${``, and escapes are those of any text."""
    found = _pieces(_expression(tmp_path, text))
    pieces = (each if isinstance(each, str) else f"<{_shown(each)}>" for each in found)
    assert "".join(pieces) == shown


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ('"$a"', "$a"),
        ('"$${a}"', "${a}"),
        ('"costs 3$"', "costs 3$"),
        ("-3", -3),
        ("[1, 2]", (1, 2)),
    ],
)
def test_plain_values_are_not_computed(tmp_path: Path, text: str, value: object) -> None:
    """What no argument is in keeps its value, and the system is not computed."""
    system = _system(tmp_path, f"node n : camera parameters param x = {text}")
    (node,) = system.members
    assert isinstance(node, NodeInstance)
    assert (node.parameters[0].value, node.parameters[0].value_from) == (value, None)
    assert not system.is_computed


def test_list_may_have_arguments_and_texts_with_arguments(tmp_path: Path) -> None:
    """Each element is a value, an argument, or a text with arguments in it."""
    found = _setting(tmp_path, '[1, $a, "${b}_x"]').value_from
    assert isinstance(found, tuple)
    assert [type(each) for each in found] == [Literally, Argument, Interpolation]


def test_spans_cover_exactly_their_words(tmp_path: Path) -> None:
    """Findings point at the part that they are about."""
    text = '"/${robot}/x"'
    (use,) = (each for each in _pieces(_expression(tmp_path, text)) if not isinstance(each, str))
    assert use.span.text == "${robot}"
    calculation = _expression(tmp_path, "($a + 1) * -$b  when c")
    assert isinstance(calculation, Calculation)
    assert calculation.left.span.text == "$a + 1"
    assert calculation.right.span.text == "-$b"
    setting = _setting(tmp_path, "$a * 2 when c = 3 // no more")
    assert setting.value_span.text == "$a * 2"
    assert setting.when is not None
    assert setting.when.span.text == "c = 3"
    condition = _condition(tmp_path, "a and not b = 2")
    assert isinstance(condition, Joined)
    assert [each.span.text for each in condition.operands] == ["a", "not b = 2"]


def _pieces(found: Expression) -> tuple[str | Expression, ...]:
    assert isinstance(found, Interpolation)
    return found.pieces


def test_names_may_be_computed_wherever_a_part_has_one(tmp_path: Path) -> None:
    """Topic, namespace and target of a connection; the text stays as written beside it."""
    system = _system(
        tmp_path,
        'topics topic "/${r}/x" subsystem s namespace $r { node n : camera namespace "${r}_n" '
        'wirings connect image to "/${r}/x" when r != "q" }',
    )
    (topic,), (part,) = system.topics, system.members
    assert topic.name == "/${r}/x"
    assert topic.name_from is not None
    assert _shown(topic.name_from) == "/<r>/x"
    assert isinstance(part, Subsystem)
    assert isinstance(part.namespace_from, Argument)
    (node,) = part.members
    assert isinstance(node, NodeInstance)
    assert isinstance(node.namespace_from, Interpolation)
    (wiring,) = node.wirings
    assert isinstance(wiring.target_from, Interpolation)
    assert isinstance(wiring.when, Compared)
    assert system.is_computed


def test_quoted_name_without_arguments_is_a_plain_one(tmp_path: Path) -> None:
    """Quotes alone compute nothing."""
    (topic,) = _system(tmp_path, 'topics topic "/x"').topics
    assert (topic.name, topic.name_from) == ("/x", None)


def test_using_a_system_that_is_computed_is_computing(tmp_path: Path) -> None:
    """A system around one with conditions varies with it, though it says nothing of that itself."""
    (tmp_path / "arm.system").write_text(
        'system Arm imports import "camera.rnd" argument a : bool = true node n : camera when a'
    )
    (tmp_path / "plain.system").write_text("system Plain")
    assert _system(tmp_path, 'import "arm.system" subsystem s : Arm').is_computed
    assert not _system(tmp_path, 'import "plain.system" subsystem s : Plain').is_computed
    (part,) = _system(tmp_path, 'import "arm.system" subsystem s : Arm(a = false)').members
    assert isinstance(part, Subsystem)
    ((name, value),) = ((each.name.text, each.value) for each in part.passed)
    assert (name, _shown(value)) == ("a", "False")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("parameters param a = «$»", "directly behind '$'"),
        ("parameters param a = 3 +«»", "the file ends where a value"),
        ("parameters param a = «b»", "strings are written in quotes"),
        ("parameters param a = ($a«»", "')' is expected"),
        ("parameters param a = [$a «+» 1]", "',' or ']' is expected"),
        ('parameters param a = "«${x»"', "not the value of an argument"),
        ('parameters param a = "«${}»"', "not the value of an argument"),
        ('parameters param a = "«${a-b}»"', "'$${' stands for '${' itself"),
        ("when«»", "'not', a value, an argument or '(' is expected"),
        ("when a and«»", "'not', a value, an argument or '(' is expected"),
        ("when a =«»", "a value or an argument is expected"),
        ("when a in «b»", "'[' is expected"),
        ("wirings connect a to «${x}/b»", "write '\"${x}/b\"'"),
        ("wirings connect a to «/c/$x»", "write '\"/c/${x}\"'"),
        ("wirings connect a to «$x/c»", "write '\"${x}/c\"'"),
        ('wirings connect a to «"»${x}/b', "not closed"),
    ],
)
def test_faults_say_what_is_expected(tmp_path: Path, text: str, words: str) -> None:
    """There is one finding, at the fault, in words."""
    (tmp_path / "camera.rnd").write_text(NODE, encoding="utf-8")
    marked = f'system S imports import "camera.rnd" node n : camera {text}'
    start, end = marked.index("«"), marked.index("»") - 1
    plain = marked.replace("«", "").replace("»", "")
    (finding,) = Repository().load_text(tmp_path / "s.system", plain).diagnostics
    assert words in f"{finding.message} | {finding.hint}"
    assert finding.code is codes.SYNTAX_ERROR
    assert (finding.span.start, finding.span.end) == (start, end)


def test_what_is_looked_up_stands_alone_and_in_texts(tmp_path: Path) -> None:
    """In a text nothing needs quotes; whitespace counts for nothing."""
    shown = {
        'env("HOME")': "env(HOME, None)",
        'env("HOME", "/root")': "env(HOME, /root)",
        'share("camera")': "share(camera, None)",
        "this_dir": f"this_dir({tmp_path}, None)",
    }
    for text, expected in shown.items():
        assert _shown(_expression(tmp_path, text)) == expected
    found = _expression(tmp_path, '"${share(camera)}/${env(MODEL, small one)}${this_dir}$${x}"')
    assert isinstance(found, Interpolation)
    looked_up = [_shown(each) for each in found.pieces if not isinstance(each, str)]
    assert looked_up == [
        "share(camera, None)",
        "env(MODEL, small one)",
        f"this_dir({tmp_path}, None)",
    ]
    assert "".join(each for each in found.pieces if isinstance(each, str)) == "/${x}"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('parameters param a = «share("x y")»', "'x y' is not the name of a package"),
        ('parameters param a = «share("camera", "b")»', "has no default"),
        ('parameters param a = «env("a b")»', "'a b' is not the name of a variable"),
        ('parameters param a = «this_dir("a")»', "takes no name"),
        ('parameters param a = "«${env()}»"', "'' is not the name of a variable"),
        ('parameters param a = "«${home()}»"', "not the value of an argument"),
    ],
)
def test_faults_of_lookups(tmp_path: Path, text: str, words: str) -> None:
    """There is one finding, at the fault."""
    test_faults_say_what_is_expected(tmp_path, text, words)


def test_elements_of_lists_and_words_may_have_conditions(tmp_path: Path) -> None:
    """The place of a condition is that of its element; without any, there are none."""
    text = 'node n : camera arguments ["-x", "-y" when loud] parameters param x = [1, $n when a]'
    (node,) = _system(tmp_path, f"argument loud : bool = false {text}").members
    assert isinstance(node, NodeInstance)
    (first, second) = node.arguments
    assert first.when is None
    assert isinstance(second.when, Holds)
    (setting,) = node.parameters
    assert [each is None for each in setting.element_conditions] == [True, False]
    assert setting.switches == setting.element_conditions[1:]
    assert [type(each) for each in setting.computed] == [Literally, Argument]
    assert _setting(tmp_path, "[1, 2]").element_conditions == ()
