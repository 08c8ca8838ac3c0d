"""Small pieces of C++ source text: names, literals, calls, comments; within ament's line length."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass

from deros.generators.text.document import (
    HARDLINE,
    LINE,
    SOFTLINE,
    Document,
    Line,
    align,
    breakable,
    comma_separated,
    concat,
    group,
    if_broken,
    join,
    nest,
    render,
    render_lines,
)
from deros.generators.text.prose import pieces, printable_line, sentence, wrap
from deros.interfaces.types import InterfaceType
from deros.names.keywords import CPP_20

LINE_LENGTH = 100
"""The longest line that ament's settings of uncrustify and cpplint allow."""

# Macros of common headers, which must not be used as names.
_MACROS_TEXT = (
    "EOF HUGE_VAL INFINITY NAN NULL assert errno linux major minor stderr stdin stdout unix"
)
_MACROS = frozenset(_MACROS_TEXT.split())
_NOT_IN_IDENTIFIERS = re.compile(r"[^A-Za-z0-9]+")


# Names --------------------------------------------------------------------------------------------


def cpp_identifier(name: str) -> str:
    """Return the C++ identifier for a ROS 2 name, ``fmInformation_imu`` for ``/fmInformation/imu``.

    Each run of characters other than letters and digits becomes one ``_``. It is removed at both
    ends, since C++ reserves many names with underscores. Keywords and macros get a ``_`` at the
    end, names that start with a digit get an ``x`` in front.
    """
    text = _NOT_IN_IDENTIFIERS.sub("_", name).strip("_") or "x"
    if is_reserved(text):
        return f"{text}_"
    return f"x{text}" if text[0].isdigit() else text


def is_reserved(name: str) -> bool:
    """Return whether a word is a keyword or a macro."""
    return name in CPP_20 or name in _MACROS


def cpp_type(interface: InterfaceType) -> str:
    """Return the C++ type of an interface, ``std_msgs::msg::Bool`` for example."""
    return f"{interface.package}::{interface.kind}::{interface.name}"


def cpp_header(interface: InterfaceType) -> str:
    """Return the header of the C++ type of an interface: ``sensor_msgs/msg/laser_scan.hpp``.

    Source: rosidl_pycommon, ``convert_camel_case_to_lower_case_underscore``.
    """
    name = re.sub(r"(.)([A-Z][a-z]+)", r"\1_\2", interface.name)
    name = re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", name).lower()
    return f"{interface.package}/{interface.kind}/{name}.hpp"


# Literals -----------------------------------------------------------------------------------------


def cpp_string(text: str) -> str:
    """Return the literal of a text in UTF-8, as a ``std::string`` if it contains a NUL."""
    literal = f'"{_escaped(text)}"'
    return f"std::string({literal}, {len(text.encode())})" if "\0" in text else literal


def _escaped(text: str) -> str:
    return "".join(map(_character, text)).replace("??", "?\\?")


def _character(character: str) -> str:
    if character in '"\\':
        return f"\\{character}"
    if character.isprintable():
        return character
    return "".join(f"\\{byte:03o}" for byte in character.encode())


def cpp_double(value: float) -> str:
    """Return the literal of a double, exact to the bit."""
    if math.isnan(value):
        return "std::numeric_limits<double>::quiet_NaN()"
    if math.isinf(value):
        sign = "-" if value < 0 else ""
        return f"{sign}std::numeric_limits<double>::infinity()"
    return repr(float(value))


def cpp_int64(value: int) -> str:
    """Return the literal of a 64-bit integer."""
    if value == -(2**63):
        return "std::numeric_limits<int64_t>::min()"  # a literal cannot be negative
    return f"INT64_C({value})" if abs(value) >= 2**31 else str(value)


# Expressions --------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Text:
    """A text as a literal, broken into several where it is too long for a line."""

    text: str


@dataclass(frozen=True, slots=True)
class Call:
    """A call; where it is too long, its arguments are on lines of their own.

    Attributes:
        head: the text in front of the opening bracket; of a declaration type and name.
        arguments: the arguments.
        tail: the text behind the closing bracket.
    """

    head: str
    arguments: tuple[Expression, ...]
    tail: str = ""


@dataclass(frozen=True, slots=True)
class Chain:
    """Parts that follow each other; where they are too long, each is on a line of its own.

    Attributes:
        head: the text in front of the parts, without a joint behind it.
        parts: the parts.
        joint: the text between two parts; at the end of a line, its last blank is dropped.
    """

    head: str
    parts: tuple[str, ...]
    joint: str = ""


@dataclass(frozen=True, slots=True)
class Items:
    """A list in braces; where it is too long, each item is on a line of its own."""

    items: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Table:
    """An initializer in braces; where it is too long, each row is on a line with a comma."""

    rows: tuple[Expression, ...]


Expression = str | Text | Call | Chain | Items | Table


def expression(value: Expression, indent: int, end: str = "") -> str:
    """Return an expression, for a template that has written ``indent`` blanks already.

    Args:
        value: the expression.
        indent: the column in which it starts, and to which further lines are indented.
        end: the text behind it.
    """
    return render(concat(_document(value), end), LINE_LENGTH, indent)


def expression_lines(value: Expression, indent: int, end: str = "") -> list[str]:
    """Return the lines of an expression with the text behind it, behind ``indent`` blanks."""
    return render_lines(concat(_document(value), end), LINE_LENGTH, indent)


def call(head: str, arguments: Iterable[Expression | None], indent: int, end: str = ";") -> str:
    """Return a call, for a template that has written ``indent`` blanks already.

    Arguments that are ``None`` are left out.
    """
    return expression(Call(head, _given(arguments)), indent, end)


def arguments(given: Iterable[Expression | None], indent: int, end: str) -> str:
    """Return arguments, for a template that has written ``indent`` blanks already.

    Those that are ``None`` are left out; ``end`` follows the last.
    """
    listed = comma_separated(map(_document, _given(given)))
    return render(group(listed, end), LINE_LENGTH, indent)


def statement(head: str, value: Expression, indent: int) -> str:
    """Return ``head value;``, for a template that has written ``indent`` blanks already.

    A value that does not fit behind its head is below it.
    """
    inner = _document(value)
    if not head:
        document = concat(inner, ";")
    elif isinstance(value, str | Items):
        document = concat(head, " ", inner, ";")
    else:
        document = group(head, nest(2, LINE, inner), ";")
    return render(document, LINE_LENGTH, indent)


def _given(listed: Iterable[Expression | None]) -> tuple[Expression, ...]:
    return tuple(argument for argument in listed if argument is not None)


def _document(value: Expression) -> Document:
    if isinstance(value, str):
        return value
    if isinstance(value, Text):
        text = value.text
        return align(breakable(cpp_string(text), lambda indent: _literals(text, indent)))
    if isinstance(value, Chain):
        joint = value.joint.rstrip()
        line = Line(value.joint.removeprefix(joint))
        return group(
            align(
                value.head, SOFTLINE if value.head else "", join(concat(joint, line), value.parts)
            )
        )
    if isinstance(value, Items):
        return group("{", nest(2, SOFTLINE, comma_separated(value.items)), "}")
    if isinstance(value, Table):
        rows = comma_separated(map(_document, value.rows))
        return (
            group("{", nest(2, SOFTLINE, rows, if_broken(",")), SOFTLINE, "}")
            if value.rows
            else "{}"
        )
    arguments = group(comma_separated(map(_document, value.arguments)))
    return group(_head(value.head), "(", nest(2, SOFTLINE, arguments), ")", value.tail)


def _head(head: str) -> Document:
    """Return the head of a call; where it is too long, its type is on a line of its own."""
    type_, blank, name = head.rpartition(" ")
    return group(type_, LINE, name) if blank else head


def _literals(text: str, indent: int) -> Document:
    """Return a long text as literals one below the other, which the compiler joins."""
    escaped = _escaped(text)  # no escape has a blank, so none is broken
    return join(HARDLINE, (f'"{piece}"' for piece in pieces(escaped, LINE_LENGTH - indent - 8)))


# Comments -----------------------------------------------------------------------------------------


def comment(text: str, indent: int, notes: Iterable[str] = (), mark: str = "///") -> str:
    """Return a comment, for a template that has written ``indent`` blanks already.

    The text and each note are paragraphs with an empty line between them. Character sequences that
    compilers or linters interpret in comments (a backslash at the end of a line, a trigraph, a
    to-do) are replaced.
    """
    lines: list[str] = []
    for paragraph in filter(None, (text, *notes)):
        if lines:
            lines.append(mark)
        lines += [f"{mark} {line}" for line in wrapped(paragraph, indent + len(mark) + 1)]
    return ("\n" + " " * indent).join(lines)


def wrapped(text: str, indent: int) -> list[str]:
    """Return ``text`` as lines of a comment that fit behind ``indent`` columns."""
    plain = printable_line(text).replace("\\", "/").replace("??", "?").replace("TODO", "To do")
    return wrap(plain, LINE_LENGTH - indent)


def summary(text: str, otherwise: str) -> str:
    """Return a description as a sentence, or ``otherwise`` if it is empty."""
    return sentence(text) or otherwise


_HEADERS = {
    "algorithm": r"std::(all_of|count_if|find|find_if|max|min|sort)\b",
    "array": r"std::array\b",
    "atomic": r"std::atomic",
    "chrono": r"std::chrono",
    "cstddef": r"\bsize_t\b",
    "cstdint": r"\bu?int\d+_t\b|\bINT64_C\b",
    "exception": r"std::exception(_ptr)?\b",
    "functional": r"std::(function|hash|less)\b",
    "future": r"std::(shared_)?future\b",
    "iterator": r"std::next\b",
    "limits": r"std::numeric_limits",
    "list": r"std::list\b",
    "map": r"std::map\b",
    "memory": r"std::(make_shared|make_unique|shared_ptr|unique_ptr|weak_ptr)\b",
    "mutex": r"std::(lock_guard|mutex|unique_lock)\b",
    "optional": r"std::(nullopt|optional)\b",
    "set": r"std::set\b",
    "stdexcept": r"std::invalid_argument\b",
    "string": r"std::(string|to_string)\b",
    "type_traits": r"std::is_same\b",
    "utility": r"std::(exchange|move|pair|swap)\b",
    "vector": r"std::vector\b",
}


def standard_headers(text: str) -> list[str]:
    """Return the headers of the standard library for the names that a text uses."""
    return [header for header, names in _HEADERS.items() if re.search(names, text)]


def include_lines(headers: Iterable[str]) -> list[str]:
    """Return the ``#include`` lines of quoted headers, sorted and without repeats."""
    return [f'#include "{header}"' for header in sorted(set(headers))]


def tidied(text: str) -> str:
    """Return ``text`` without superfluous empty lines and empty sections of classes."""
    text = re.sub(r"\n{3,}", "\n\n", text)
    text = re.sub(r"(?:\n\w+:\n+)+(?=(?:private|protected):|\};)", "\n", text)
    return re.sub(r"\n+(\n(?: +\}|\};))", r"\1", text)


def mark_long_lines(text: str) -> str:
    """Exempt lines that are too long from the linters.

    They cannot be broken: a name in ROS 2 may have 255 characters. For cpplint each such line is
    marked. For uncrustify, which would break it anyway, the whole file is.
    """
    lines = text.splitlines()
    if all(len(line) <= LINE_LENGTH for line in lines):
        return text
    code = next((i for i, line in enumerate(lines) if line.startswith("#")), 0)
    marked = [
        f"{line}  // NOLINT(whitespace/line_length)" if len(line) > LINE_LENGTH else line
        for line in lines
    ]
    return "\n".join([*marked[:code], "// *INDENT-OFF*", *marked[code:]]) + "\n"
