"""Small pieces of C++ source text: names, literals, calls, comments; within ament's line length."""

from __future__ import annotations

import math
import re
import textwrap
from collections.abc import Iterable
from dataclasses import dataclass

from deros.generators.text.prose import printable_line, sentence
from deros.interfaces.keywords import CPP_20
from deros.interfaces.types import InterfaceType

LINE_LENGTH = 100
"""Longest line that ament's uncrustify and cpplint settings allow."""

# What common headers define as macros: nothing may be called so.
_MACROS_TEXT = (
    "EOF HUGE_VAL INFINITY NAN NULL assert errno linux major minor stderr stdin stdout unix"
)
_MACROS = frozenset(_MACROS_TEXT.split())
_NOT_IN_IDENTIFIERS = re.compile(r"[^A-Za-z0-9]+")


# Names --------------------------------------------------------------------------------------------


def cpp_identifier(name: str) -> str:
    """Return the C++ identifier for a ROS 2 name: ``/fmInformation/imu`` is ``fmInformation_imu``.

    Every run of characters that are neither letter nor digit becomes one ``_``, and is dropped at
    either end, since C++ reserves many names with underscores. Keywords and macros get a ``_`` at
    the end; what starts with a digit gets an ``x`` in front.
    """
    text = _NOT_IN_IDENTIFIERS.sub("_", name).strip("_") or "x"
    if is_reserved(text):
        return f"{text}_"
    return f"x{text}" if text[0].isdigit() else text


def is_reserved(name: str) -> bool:
    """Tell whether C++ keeps a word for itself."""
    return name in CPP_20 or name in _MACROS


def cpp_type(interface: InterfaceType) -> str:
    """Return the C++ type of an interface: ``std_msgs::msg::Bool``."""
    return f"{interface.package}::{interface.kind}::{interface.name}"


def cpp_header(interface: InterfaceType) -> str:
    """Return the header that defines an interface's C++ type: ``sensor_msgs/msg/laser_scan.hpp``.

    Source: rosidl_pycommon, ``convert_camel_case_to_lower_case_underscore``.
    """
    name = re.sub(r"(.)([A-Z][a-z]+)", r"\1_\2", interface.name)
    name = re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", name).lower()
    return f"{interface.package}/{interface.kind}/{name}.hpp"


# Literals -----------------------------------------------------------------------------------------


def cpp_string(text: str) -> str:
    """Return the literal of a text, as UTF-8; ``std::string`` in full where it holds a NUL."""
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
        return "std::numeric_limits<int64_t>::min()"  # there is no literal below zero
    return f"INT64_C({value})" if abs(value) >= 2**31 else str(value)


# Layout -------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Text:
    """A text as a literal, broken into several where it is too long for a line."""

    text: str


@dataclass(frozen=True, slots=True)
class Call:
    """A call; where too long, its arguments stand on lines of their own.

    ``tail`` follows the closing parenthesis.
    """

    head: str
    arguments: tuple[Expression, ...]
    tail: str = ""


@dataclass(frozen=True, slots=True)
class Chain:
    """Parts that follow one another; where too long, each stands on a line of its own.

    ``joint`` stands between two parts, on one line as it is and at a line's end without its blank.
    """

    head: str
    parts: tuple[str, ...]
    joint: str = ""


@dataclass(frozen=True, slots=True)
class Items:
    """A list in braces; where too long, each item stands on a line of its own."""

    items: tuple[str, ...]


Expression = str | Text | Call | Chain | Items


def layout(expression: Expression, indent: int, trailer: str = "") -> list[str]:
    """Return the lines of an expression that starts in column ``indent``; the first has no blanks.

    ``trailer`` is what follows the expression on its last line.
    """
    line = _on_one_line(expression) + trailer
    if isinstance(expression, str) or indent + len(line) <= LINE_LENGTH:
        return [line]
    if isinstance(expression, Text):
        return _broken(expression.text, indent, trailer)
    if isinstance(expression, Chain):
        return _links(expression, indent, trailer)
    if isinstance(expression, Items):
        margin = " " * (indent + 2)
        items = [f"{margin}{item}," for item in expression.items]
        return ["{", *items[:-1], items[-1].removesuffix(",") + "}" + trailer]
    before, head = _cut(expression.head, indent)
    margin = " " * (indent + 2)
    trailer = ")" + expression.tail + trailer
    together = ", ".join(map(_on_one_line, expression.arguments)) + trailer
    if indent + 2 + len(together) <= LINE_LENGTH:
        return [*before, f"{head}(", margin + together]
    lines = [*before, f"{head}("]
    ends = _ends(len(expression.arguments), trailer)
    for argument, end in zip(expression.arguments, ends, strict=True):
        inner = layout(argument, indent + 2, end)
        lines += [margin + inner[0], *inner[1:]]
    return lines


def _ends(count: int, last: str) -> list[str]:
    """Return what follows each of some arguments."""
    return [*[","] * (count - 1), last]


def _cut(head: str, indent: int) -> tuple[list[str], str]:
    """Take the type in front of a declared name to a line of its own, where both do not fit."""
    type_, blank, name = head.rpartition(" ")
    if indent + len(head) < LINE_LENGTH or not blank:
        return [], head
    return [type_], " " * indent + name


def _broken(text: str, indent: int, trailer: str) -> list[str]:
    """Return a long text as literals one below the other, which the compiler joins."""
    pieces = textwrap.wrap(
        _escaped(text),  # no escape has a blank, so none is broken
        LINE_LENGTH - indent - 8,
        break_long_words=False,
        break_on_hyphens=False,
        drop_whitespace=False,
        expand_tabs=False,
        replace_whitespace=False,
    )
    margin = " " * indent
    lines = [f'{margin}"{piece}"' for piece in pieces]
    lines[0] = lines[0].removeprefix(margin)
    lines[-1] += trailer
    return lines


def _links(chain: Chain, indent: int, trailer: str) -> list[str]:
    margin = " " * indent
    parts = [*([chain.head] if chain.head else []), *chain.parts]
    joint = chain.joint.rstrip()
    lines = [f"{part}{joint}" for part in parts[:-1]] + [f"{parts[-1]}{trailer}"]
    return [lines[0], *(margin + line for line in lines[1:])]


def _on_one_line(expression: Expression) -> str:
    if isinstance(expression, str):
        return expression
    if isinstance(expression, Text):
        return cpp_string(expression.text)
    if isinstance(expression, Chain):
        return expression.head + expression.joint.join(expression.parts)
    if isinstance(expression, Items):
        return f"{{{', '.join(expression.items)}}}"
    arguments = ", ".join(map(_on_one_line, expression.arguments))
    return f"{expression.head}({arguments}){expression.tail}"


def call(head: str, arguments: Iterable[Expression | None], indent: int, end: str = ";") -> str:
    """Return a call as text for a template that has written ``indent`` blanks already.

    Arguments that are ``None`` are left out.
    """
    given = tuple(argument for argument in arguments if argument is not None)
    return "\n".join(layout(Call(head, given), indent, end))


def arguments(given: Iterable[Expression | None], indent: int, end: str) -> str:
    """Return arguments as text for a template that has written ``indent`` blanks already.

    Those that are ``None`` are left out; ``end`` follows the last.
    """
    listed = [argument for argument in given if argument is not None]
    line = ", ".join(map(_on_one_line, listed)) + end
    if indent + len(line) <= LINE_LENGTH:
        return line
    lines = []
    for argument, trailer in zip(listed, _ends(len(listed), end), strict=True):
        lines += layout(argument, indent, trailer)
    return ("\n" + " " * indent).join(line.strip() for line in lines)


def statement(head: str, value: Expression, indent: int) -> str:
    """Return ``head value;`` for a template that has written ``indent`` blanks already.

    A value that does not fit behind its head stands below.
    """
    line = f"{head} {_on_one_line(value)};".lstrip()
    if indent + len(line) <= LINE_LENGTH or isinstance(value, str):
        return line
    if isinstance(value, Items):
        return f"{head} " + "\n".join(layout(value, indent, ";"))
    margin = " " * (indent + 2)
    first, *others = layout(value, indent + 2, ";")
    return "\n".join([head, margin + first, *others])


def expression(value: Expression, indent: int, end: str = "") -> str:
    """Return any expression as text for a template that has written ``indent`` blanks already."""
    return "\n".join(layout(value, indent, end))


# Comments -----------------------------------------------------------------------------------------


def comment(text: str, indent: int, notes: Iterable[str] = (), mark: str = "///") -> str:
    """Return a comment as text for a template that has written ``indent`` blanks already.

    Text and notes are broken where they are too long; an empty line stands between two. What a
    compiler or linter would take for its own business (a backslash at a line's end, a trigraph, a
    to-do) is rewritten.
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
    return textwrap.wrap(
        plain, LINE_LENGTH - indent, break_long_words=False, break_on_hyphens=False
    )


def summary(text: str, otherwise: str) -> str:
    """Return a description as a sentence, or another one where there is none."""
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
    "string": r"std::(string|to_string)\b",
    "type_traits": r"std::is_same\b",
    "utility": r"std::(exchange|move|pair|swap)\b",
    "vector": r"std::vector\b",
}


def standard_headers(text: str) -> list[str]:
    """Return the headers of the standard library that a text needs, by the names it uses."""
    return [header for header, names in _HEADERS.items() if re.search(names, text)]


def include_lines(headers: Iterable[str]) -> list[str]:
    """Return ``#include`` lines of quoted headers, in order, each once."""
    return [f'#include "{header}"' for header in sorted(set(headers))]


def tidied(text: str) -> str:
    """Return ``text`` without needless empty lines and without empty sections of classes."""
    text = re.sub(r"\n{3,}", "\n\n", text)
    text = re.sub(r"(?:\n\w+:\n+)+(?=(?:private|protected):|\};)", "\n", text)
    return re.sub(r"\n+(\n(?: +\}|\};))", r"\1", text)


def mark_long_lines(text: str) -> str:
    """Have the linters pass over lines that no wrapping could keep to the line length.

    ROS 2 names may be 255 characters long, and a name cannot be broken: cpplint is told of each
    such line, and uncrustify, which would break it all the same, to leave the whole file alone.
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
