"""Parsing .msg, .srv and .action definitions."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deros.interfaces.definitions import (
    DefinitionError,
    parse_definition,
    parse_field_type,
    without_comment,
)
from deros.interfaces.types import (
    INTEGER_RANGES,
    PRIMITIVES,
    Constant,
    FieldType,
    InterfaceType,
    MessageDefinition,
)

THING = InterfaceType("my_msgs", "msg", "Thing")


def parse_message(text: str) -> MessageDefinition:
    """Parse ``text`` as the message Thing, which must succeed."""
    definition = parse_definition(THING, text)
    assert not isinstance(definition, DefinitionError), definition
    (message,) = definition
    return message


def test_fields_keep_their_order_and_types() -> None:
    """Primitives, messages of this and other packages, arrays and bounds are distinguished."""
    message = parse_message(
        "std_msgs/Header header\n"
        "geometry_msgs/msg/Point[] points\n"
        "Other other\n"
        "float64[9] covariance\n"
        "string<=10[<=3] names\n"
        "wstring text\n"
    )
    assert message.fields == (
        ("header", FieldType(InterfaceType("std_msgs", "msg", "Header"))),
        ("points", FieldType(InterfaceType("geometry_msgs", "msg", "Point"), "unbounded")),
        ("other", FieldType(InterfaceType("my_msgs", "msg", "Other"))),
        ("covariance", FieldType("float64", "fixed", 9)),
        ("names", FieldType("string", "bounded", 3, string_bound=10)),
        ("text", FieldType("wstring")),
    )


def test_constants_have_values_of_their_type() -> None:
    """Numbers, hexadecimal numbers, booleans and strings with and without quotes are read."""
    message = parse_message(
        "byte OK=0\nuint8 MASK = 0xF0  # upper half\nint32 LOW=-5\nbool ON=true\n"
        'float32 HALF=.5\nstring PLAIN=some text \nstring QUOTED="a # b" # c\n'
    )
    assert message.constants == (
        Constant("OK", "byte", 0),
        Constant("MASK", "uint8", 240),
        Constant("LOW", "int32", -5),
        Constant("ON", "bool", True),
        Constant("HALF", "float32", 0.5),
        Constant("PLAIN", "string", "some text"),
        Constant("QUOTED", "string", "a # b"),
    )


def test_defaults_are_separate_from_types() -> None:
    """A default may be a scalar or, for arrays of primitives, a list."""
    message = parse_message(
        "float64 w 1\n"
        "bool[2] flags [true, False]\n"
        'string name "it\'s"\n'
        "string[] words [\"a,b\", 'c']\n"
        "int8[<=3] some []\n"
        'string equal "a=b"\n'
    )
    assert message.defaults == {
        "w": 1.0,
        "flags": (True, False),
        "name": "it's",
        "words": ("a,b", "c"),
        "some": (),
        "equal": "a=b",
    }


def test_layout_and_comments_are_ignored() -> None:
    """Blank lines, comments and tabs do not change a definition."""
    assert parse_message("# head\n\n\tint8\tx\t3 # tail\r\n  \n") == MessageDefinition(
        THING, (("x", FieldType("int8")),), (), {"x": 3}
    )


@pytest.mark.parametrize(
    ("text", "line", "fragment"),
    [
        ("int8 x\nint8 x\n", 2, "declared twice"),
        ("float64<=3 x\n", 1, "not a field type"),
        ("float64[<=] x\n", 1, "not a field type"),
        ("\nint8 3x\n", 2, "not a field name"),
        ("int8\n", 1, "not a field name"),
        ("int8 x 200\n", 1, "not a value of type int8"),
        ("int8[2] x [1]\n", 1, "not a value of type int8[2]"),
        ("int8[2] x 1\n", 1, "not a value of type int8[2]"),
        ("Other x 1\n", 1, "not a value of type my_msgs/msg/Other"),
        ("Other X=1\n", 1, "not a primitive"),
        ("uint8 X=many\n", 1, "not a value of type uint8"),
        ('string s "open\n', 1, "not a value of type string"),
        ("int8 x\n---\nint8 y\n", 1, "2 parts"),
    ],
)
def test_parse_error_has_its_line(text: str, line: int, fragment: str) -> None:
    """An error is a returned value with the line, not an exception."""
    error = parse_definition(THING, text)
    assert isinstance(error, DefinitionError)
    assert error.line == line
    assert fragment in error.message


def test_services_and_actions_have_all_parts() -> None:
    """The parts are named as in rosidl, and present even if they are empty."""
    service = parse_definition(InterfaceType("p_p", "srv", "Go"), "---\nbool success\n")
    action = parse_definition(InterfaceType("p_p", "action", "Go"), "int8 a\n---\n---\nint8 b")
    assert not isinstance(service, DefinitionError)
    assert not isinstance(action, DefinitionError)
    assert [(part.type.name, len(part.fields)) for part in service] == [
        ("Go_Request", 0),
        ("Go_Response", 1),
    ]
    assert [part.type.name for part in action] == ["Go_Goal", "Go_Result", "Go_Feedback"]


field_types = st.builds(
    lambda base, array, size, bound: FieldType(
        base,
        array,
        size if array in ("fixed", "bounded") else None,
        bound if base in ("string", "wstring") else None,
    ),
    st.sampled_from([*sorted(PRIMITIVES), InterfaceType("a_b", "msg", "C")]),
    st.sampled_from([None, "fixed", "bounded", "unbounded"]),
    st.integers(1, 99),
    st.none() | st.integers(1, 99),
)


@given(field_types)
def test_field_type_round_trips_as_text(kind: FieldType) -> None:
    """``parse_field_type`` is the inverse of ``str``."""
    assert parse_field_type(str(kind), "other") == kind


@given(st.sampled_from(sorted(INTEGER_RANGES)), st.integers())
def test_integer_default_must_be_in_range(base: str, value: int) -> None:
    """An integer default that its type cannot represent is an error."""
    definition = parse_definition(THING, f"{base} x {value}")
    least, greatest = INTEGER_RANGES[base]
    assert isinstance(definition, tuple) == (least <= value <= greatest)


@given(st.text(alphabet="ab #\"'=[]<>\\-1,\t", max_size=30))
def test_arbitrary_text_does_not_raise(line: str) -> None:
    """The parser returns a value for any text."""
    assert isinstance(parse_definition(THING, line), (tuple, DefinitionError))
    assert line.startswith(without_comment(line))
