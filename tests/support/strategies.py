"""Random programs, rules in text, and traces, for tests that compare what engines do with them.

Times are a few nanoseconds and values come from small pools, so that deadlines, messages and steps
of the clock coincide often, and comparisons meet their bounds.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal

from hypothesis import strategies as st

from deros.diagnostics import SourceFile, Span
from deros.interfaces.fields import FieldPath, Key
from deros.interfaces.types import FieldType, InterfaceType
from deros.rules.engine.state import LeafValue
from deros.rules.functions.function_rows import Result
from deros.rules.functions.functions import FUNCTIONS, WRITTEN, Argument
from deros.rules.program import ir, walk
from deros.rules.program.beams import sector
from deros.rules.program.formulas import (
    Expression,
    Formula,
    Logical,
    Name,
    Negation,
    Number,
    Relation,
    parse,
    renamed,
)
from tests.support.drawn_zones import PLACES, ZONES, inside

_SOURCE = SourceFile("random.deros", "".join(f"line {n};\n" for n in range(1, 100)))

Draw = Callable[[st.SearchStrategy[Any]], Any]


def span(line: int) -> Span:
    """Return the span of a whole line of a source that stands for random rules."""
    start = _SOURCE.text.index(f"line {line};")
    return Span(_SOURCE, start, start + len(f"line {line};"))


# Values -------------------------------------------------------------------------------------------

NUMBERS = (-2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0)
ZEROS = (0.0, -0.0)
"""They are equal, and yet not the same where they are handed on."""
_floats = (*NUMBERS, *NUMBERS, *ZEROS, *ZEROS, -0.0, math.nan, math.inf, -math.inf)
floats = st.sampled_from(_floats) | st.sampled_from(_floats) | st.floats()
unit_floats = st.sampled_from((-1.0, -0.5, -0.0, 0.0, 0.1, 0.5, 1.0, 1.0, math.nan, math.inf))
places = st.sampled_from(PLACES) | st.floats()
# What 32 bits hold, as numbers of a message with 32 bits are.
ranges = st.sampled_from((*NUMBERS, *NUMBERS, math.nan, math.inf, -math.inf)) | st.floats(width=32)
scan_floats = st.sampled_from((-1.0, -0.5, 0.0, 0.125, 0.5, 1.0, 1.0, math.nan, math.inf))
small_ints = st.integers(0, 4)
texts = st.sampled_from(("", "auto", "manual", "it's"))
durations = st.integers(0, 12)
waits = st.sampled_from((0, 0, 1, 1, 2, 3, 4, 5, 7, 10, 25))


@dataclass(frozen=True)
class Kind:
    """A kind of input: where it is, what its leaves are, and what they may hold."""

    topic: str
    type: InterfaceType
    path: FieldPath
    leaves: tuple[tuple[FieldPath, FieldType, st.SearchStrategy[Any]], ...]
    nan_is_unknown: bool = True


_FLOAT = FieldType("float64")
_ANGLES = ("angle_min", "angle_increment", "range_min", "range_max")

KINDS: Mapping[str, Kind] = {
    "number": Kind(
        "/speed",
        InterfaceType("std_msgs", "msg", "Float64"),
        ("data",),
        ((("data",), _FLOAT, floats),),
    ),
    "integer": Kind(
        "/mode",
        InterfaceType("std_msgs", "msg", "UInt8"),
        ("data",),
        ((("data",), FieldType("uint8"), small_ints),),
    ),
    "boolean": Kind(
        "/flag",
        InterfaceType("std_msgs", "msg", "Bool"),
        ("data",),
        ((("data",), FieldType("bool"), st.booleans()),),
    ),
    "text": Kind(
        "/name",
        InterfaceType("std_msgs", "msg", "String"),
        ("data",),
        ((("data",), FieldType("string"), texts),),
    ),
    "quaternion": Kind(
        "/imu",
        InterfaceType("sensor_msgs", "msg", "Imu"),
        ("orientation",),
        tuple((("orientation", axis), _FLOAT, unit_floats) for axis in "xyzw"),
    ),
    "vector": Kind(
        "/imu",
        InterfaceType("sensor_msgs", "msg", "Imu"),
        ("angular_velocity",),
        tuple((("angular_velocity", axis), _FLOAT, floats) for axis in "xyz"),
    ),
    "point": Kind(
        "/odom",
        InterfaceType("nav_msgs", "msg", "Odometry"),
        ("pose", "pose", "position"),
        (
            *((("pose", "pose", "position", axis), _FLOAT, places) for axis in "xy"),
            # Only `missing()` and `unknown()` read it, so a NaN would count for them alone.
            (("pose", "pose", "position", "z"), _FLOAT, st.sampled_from((0.0, 1.0))),
        ),
    ),
    "array": Kind(
        "/joints",
        InterfaceType("sensor_msgs", "msg", "JointState"),
        ("position",),
        (
            (
                ("position",),
                FieldType("float64", "unbounded"),
                st.lists(floats, max_size=3),
            ),
        ),
    ),
    "element": Kind(
        "/joints",
        InterfaceType("sensor_msgs", "msg", "JointState"),
        ("velocity", 2),
        ((("velocity", 2), _FLOAT, st.none() | floats),),
    ),
    "named": Kind(
        "/joints",
        InterfaceType("sensor_msgs", "msg", "JointState"),
        ("effort", Key("name", "elbow")),
        ((("effort", Key("name", "elbow")), _FLOAT, st.none() | floats),),
    ),
    "scan": Kind(
        "/scan",
        InterfaceType("sensor_msgs", "msg", "LaserScan"),
        (),
        (
            (("ranges",), FieldType("float32", "unbounded"), st.lists(ranges, max_size=9)),
            *(((name,), FieldType("float32"), scan_floats) for name in _ANGLES),
        ),
        nan_is_unknown=False,
    ),
}

STAMPED = Kind(
    "/warmth",
    InterfaceType("sensor_msgs", "msg", "Temperature"),
    ("temperature",),
    (
        (("temperature",), _FLOAT, floats),
        (("header", "stamp", "sec"), FieldType("int32"), st.sampled_from((0, 0, 0, 0, 1, -1))),
        (
            ("header", "stamp", "nanosec"),
            FieldType("uint32"),
            st.integers(0, 40) | st.sampled_from((999_999_999, 10**9)),
        ),
        (
            ir.RECEIPT,
            FieldType("int64"),
            st.integers(0, 40) | st.sampled_from((-1, 0, 500_000_000, 10**9 + 7, 2**62, 2**63 - 1)),
        ),
        (ir.PUBLISHER, FieldType("bool"), st.sampled_from((True, True, True, None))),
    ),
)
"""A number with a header, whose stamps go forward and backward, stand still or are missing.

Receipts come before and after them. At times the topic has a second publisher.
"""

long_ints = st.sampled_from((-(2**63), -1, 0, 1, 2**53, 2**53 + 1, 2**53 + 1, 2**63 - 2, 2**63 - 1))
wide_ints = st.sampled_from((0, 1, 2, 2**53 + 1, 2**63, 2**64 - 2, 2**64 - 1))
great_ints = (-(2**63), -1, 0, 1, 2, 2**53, 2**53 + 1, *range(2**63 - 2, 2**63 + 1), 2**64)


def _kind(topic: str, name: str, base: str, size: str, values: st.SearchStrategy[Any]) -> Kind:
    """Return the kind of a message of one field, ``data``; a number is an element of that field."""
    array = size == "unbounded"
    path: FieldPath = ("data", int(size)) if size.isdigit() else ("data",)
    drawn = st.lists(values, max_size=3) if array else values
    type_ = FieldType(base, "unbounded") if array else FieldType(base)
    return Kind(topic, InterfaceType("std_msgs", "msg", name), path, ((path, type_, drawn),))


INTEGER_KINDS: Mapping[str, Kind] = {
    "long": _kind("/long", "Int64", "int64", "", long_ints),
    "wide": _kind("/wide", "UInt64", "uint64", "", wide_ints),
    "ints": _kind("/ints", "Int16MultiArray", "int16", "unbounded", small_ints),
    "longs": _kind("/longs", "Int64MultiArray", "int64", "unbounded", long_ints),
    "wides": _kind("/wides", "UInt64MultiArray", "uint64", "unbounded", wide_ints),
    "second": _kind("/ints", "Int16MultiArray", "int16", "1", st.none() | small_ints),
    "third": _kind("/wides", "UInt64MultiArray", "uint64", "2", st.none() | wide_ints),
}
"""Integers of all widths, in arrays too, and elements that the message's array may not have."""

MORE_KINDS: Mapping[str, Kind] = {
    **INTEGER_KINDS,
    "texts": _kind("/texts", "Strings", "string", "0", st.none() | texts),
    "flags": _kind("/flags", "Flags", "bool", "unbounded", st.booleans()),
    "fields": Kind(
        "/fields",
        InterfaceType("std_msgs", "msg", "Fields"),
        (),
        tuple(
            ((name,), FieldType(base, "unbounded"), st.lists(values, max_size=3))
            for name, base, values in (
                ("valid", "bool", st.booleans()),
                ("clear", "bool", st.booleans()),
                ("heights", "float32", ranges),
            )
        ),
    ),
    "first": _kind("/flags", "Flags", "bool", "0", st.none() | st.booleans()),
    "stamped": STAMPED,
    "floats": _kind("/floats", "Float32MultiArray", "float32", "unbounded", ranges),
}
"""Further kinds, which are not drawn unless they are named."""

ALL_KINDS = {**KINDS, **MORE_KINDS}


def functions_of(*arguments: Argument) -> tuple[str, ...]:
    """Return the functions that rules may apply to something."""
    return tuple(row.name for row in WRITTEN.values() if row.argument in arguments)


# Programs -----------------------------------------------------------------------------------------


@dataclass
class _Drawing:
    """A program being drawn: what has been declared, and the counters that number its parts."""

    draw: Draw
    writable: bool = False
    choice: tuple[str, ...] = tuple(KINDS)
    kinds: list[str] = field(default_factory=list)
    inputs: list[ir.Input] = field(default_factory=list)
    leaves: list[ir.Leaf] = field(default_factory=list)
    memories: int = 0
    states: int = 0
    behaviours: int = 0
    rules: list[ir.Rule] = field(default_factory=list)
    actions: int = 0
    triggered_by: dict[int, list[int]] = field(default_factory=dict)
    free_zeros: dict[int, bool] = field(default_factory=dict)
    watches: bool = False
    rounds: list[int] = field(default_factory=list)
    round: int = 0
    tunables: list[ir.TunableConstant] = field(default_factory=list)

    def input(self) -> None:
        name = self.draw(st.sampled_from(self.choice))
        kind, index = ALL_KINDS[name], len(self.inputs)
        first = len(self.leaves)
        for number, (path, type_, _) in enumerate(kind.leaves):
            nan_is_unknown = kind.nan_is_unknown or number > 0
            self.leaves.append(ir.Leaf(len(self.leaves), index, path, type_, nan_is_unknown))
        self.kinds.append(name)
        self.inputs.append(
            ir.Input(
                index,
                f"input_{index}" if self.writable else self.draw(input_names),
                kind.topic,
                kind.type,
                kind.path,
                tuple(range(first, len(self.leaves))),
                self.draw(st.none() | st.integers(1 if self.writable else 0, 12)),
                span(1 + index),
            )
        )

    # Values ---------------------------------------------------------------------------------------

    def number(self, index: int) -> ir.ValueExpression:
        """Draw a number made of one input, which must have one."""
        reads = [ir.Read(leaf) for leaf in self.inputs[index].leaves]
        match self.kinds[index]:
            case "quaternion":
                value: ir.ValueExpression = self.applied(index, reads, Argument.QUATERNION)
            case "vector":
                value = self.applied(index, reads, Argument.VECTOR)
            case "array" | "floats" | "ints" | "longs" | "wides" if self.draw(st.integers(0, 2)):
                value = self.applied(index, reads, Argument.NUMBERS, Argument.ARRAY)
            case "array" | "floats" | "ints" | "longs" | "wides" | "fields":
                value = self.matches(index, reads)
            case "scan":
                value = self.applied(index, reads, Argument.SCAN)
            case "stamped" if self.draw(st.booleans()):
                _, sec, nanosec, receipt, _ = reads
                value = ir.Apply("latency", (receipt, sec, nanosec), index)
            case "flags" if self.draw(st.booleans()):
                value = self.matches(index, reads)
            case "flags":
                value = self.applied(index, reads, Argument.ARRAY)
            case _:
                value = reads[0]
        for _ in range(self.draw(st.sampled_from((0, 0, 0, 1, 2)))):
            value = self.wrapped(value, index)
        return value

    def applied(self, index: int, reads: list[ir.Read], *arguments: Argument) -> ir.Apply:
        """Draw a function of a part of a message, and its parameters."""
        name = self.draw(st.sampled_from(functions_of(*arguments)))
        named = {self.leaves[read.leaf].path[-1]: read for read in reads}
        wanted = FUNCTIONS[name].leaves
        read = [named[leaf] for leaf in wanted] if all(wanted) else reads
        constants = list(self.parameters(name))
        zone = None
        if FUNCTIONS[name].of_zone:
            zone = self.draw(st.sampled_from(ZONES))
            constants += map(ir.Const, sector(zone.shape))
        if FUNCTIONS[name].argument is Argument.SCAN:
            if index not in self.free_zeros:
                self.free_zeros[index] = self.draw(st.booleans())
            constants.append(ir.Const(self.free_zeros[index]))
        return ir.Apply(name, (*read, *constants), index, zone=zone)

    def matches(self, index: int, reads: list[ir.Read]) -> ir.Apply:
        """Draw how many entries of the arrays of an input satisfy a condition."""
        named = {f"leaf{each.leaf}": each for each in reads}
        flags = {name: self.leaves[each.leaf].type.base == "bool" for name, each in named.items()}
        entry = Formula((), self.entry(self.draw(st.integers(0, 2)), flags))
        read = tuple(each for name, each in named.items() if name in entry.names)
        counted = ir.Apply("matches", read, index, wording=f"condition {index}")
        names = zip((f"leaf{each.leaf}" for each in read), counted.names, strict=True)
        return replace(counted, entry=renamed(entry, dict(names)).result)

    def entry(self, depth: int, flags: Mapping[str, bool]) -> Expression:
        """Draw a condition on the entries with some names; which of them are flags is given."""
        if depth and self.draw(st.booleans()):
            word: Literal["and", "or"] = self.draw(st.sampled_from(("and", "or")))
            return Logical(word, tuple(self.entry(depth - 1, flags) for _ in range(2)))
        name = self.draw(st.sampled_from(tuple(flags)))
        part: Expression = Name(name)
        if not flags[name]:
            numbers = [other for other, is_flag in flags.items() if not is_flag]
            bounds = [Number(each) for each in NUMBERS] + [Name(each) for each in numbers]
            operator = self.draw(st.sampled_from(("<", "<=", ">", ">=", "==", "!=")))
            part = Relation(operator, part, self.draw(st.sampled_from(bounds)))
        return Negation(part) if self.draw(st.booleans()) else part

    def parameters(self, name: str) -> tuple[ir.Const, ...]:
        """Draw the constants in the parentheses of a function."""
        units = [unit for _, unit in FUNCTIONS[name].parameters]
        drawn = (unit_bearing if unit == "rad" else st.sampled_from(NUMBERS) for unit in units)
        return tuple(ir.Const(float(self.draw(each))) for each in drawn)

    def wrapped(self, value: ir.ValueExpression, index: int) -> ir.ValueExpression:
        choices = (*functions_of(Argument.NUMBER), "over")
        choices = choices if self.writable else (*choices, "scale")
        if self.kinds[index] == "stamped":  # whose stamps only a rate over a span of time reads
            choices = (*choices, *["over"] * 3)
        choice = self.draw(st.sampled_from(choices))
        if self.writable:  # what the text of a rate stands for, which has stamps if there are any
            bare = self.kinds[index] in ("number", "integer")
            choice = "rate" if choice == "over" and not bare else choice
            jumps = isinstance(value, ir.Apply) and value.function in ("roll", "yaw")
            if choice in ("rate", "over") and jumps:
                turn = ir.Const(6.283185307179586)
                value = self.remembering("unwrapped", (value, turn), index)
        elif self.draw(st.integers(0, 3)) == 0:
            turn = ir.Const(self.draw(st.sampled_from((2.0, 6.283185307179586, 360.0))))
            value = self.remembering("unwrapped", (value, turn), index)
        match choice:
            case "over":
                leaves = self.inputs[index].leaves
                header = leaves[1:3] if self.kinds[index] == "stamped" else ()
                span_ns = ir.Const(self.draw(st.sampled_from((1, 2, 3, 7, 8, 9, 20))))
                arguments = (value, span_ns, *map(ir.Read, header))
                return self.remembering("rate_over", arguments, index)
            case "scale":
                offset = self.draw(st.sampled_from((0.0, 1.0, -0.5)))
                return ir.Scale(value, self.draw(st.sampled_from((2.0, -1.0, 0.1))), offset)
            case name if FUNCTIONS[name].is_stateful:
                return self.remembering(name, (value, *self.parameters(name)), index)
            case name:
                return ir.Apply(name, (value, *self.parameters(name)), index)

    def remembering(
        self, function: str, arguments: tuple[ir.ValueExpression, ...], index: int
    ) -> ir.Apply:
        self.states += 1
        return ir.Apply(function, arguments, index, self.states - 1)

    def operand(self, index: int) -> ir.Read | ir.Apply:
        """Draw a number of one input in its own unit."""
        value = self.number(index)
        while isinstance(value, ir.Scale):
            value = value.operand
        assert isinstance(value, ir.Read | ir.Apply)
        return value

    def arithmetic(self) -> ir.Compute:
        """Draw arithmetic on numbers of any inputs; its wording is that of rules."""
        operands: dict[ir.Read | ir.Apply | ir.Tuned, str] = {}
        numeric = self.numeric()
        for index in (*numeric[:2], self.draw(st.sampled_from(numeric))):
            operands.setdefault(self.operand(index), f"x{len(operands) + 1}")
        if not self.writable and self.draw(st.integers(0, 3)) == 3:
            operands.setdefault(self.tuned().as_written, f"x{len(operands) + 1}")
        formula, written = self.part(self.draw(st.integers(1, 3)), list(operands.values()))
        for name in operands.values():  # as a product, which has a unit whatever the units are
            is_used = re.search(rf"\b{name}\b", formula) is not None
            if not is_used and (name == "x1" or self.draw(st.booleans())):
                formula, written = f"({name} * {formula})", f"({name} * {written})"
        used = [each for each, name in operands.items() if re.search(rf"\b{name}\b", formula)]
        new = {operands[each]: f"x{number}" for number, each in enumerate(used, 1)}
        formula, written = (
            re.sub(r"\bx\d\b", lambda name: new[name[0]], each) for each in (formula, written)
        )
        return ir.Compute(parse(formula), tuple(used), f"({written})")

    def part(self, depth: int, names: list[str]) -> tuple[str, str]:
        """Draw a part of a formula, and how rules write it."""
        if depth == 0:
            text = self.draw(st.sampled_from((*names, *names, *map(repr, NUMBERS))))
            return text, text
        (a, left), (c, factor) = (self.part(depth - 1, names) for _ in range(2))
        b, right = c, factor
        if self.writable:  # with units: of what is read, products and quotients always fit
            b = right = repr(self.draw(st.sampled_from(NUMBERS)))
            c = factor = self.draw(st.sampled_from(names))
        match self.draw(st.integers(0, 9)):
            case 8:
                return self.beside_product((a, left), (c, factor))
            case 9:
                return self.of_several((a, left))
        functions = () if self.writable else ("sqrt", "sin", "cos", "tan")
        choices = [
            (f"({a} + {b})", f"({left} + {right})"),
            (f"({a} - {b})", f"({left} - {right})"),
            (f"({a} * {c})", f"({left} * {factor})"),
            *[(f"({a} / {c})", f"({left} / {factor})")] * 3,  # the divisor is to be zero at times
            (f"-({a})", f"(-({left}))"),
            (f"sqrt({a} * {a})", f"sqrt({left} * {left})"),
            (f"({a} if {a} > 0.0 else 0.0 - {a})", f"abs({left})"),
            (f"least({a}, {b})", f"min({left}, {right})"),
            (f"greatest({a}, {b})", f"max({left}, {right})"),
            (f"sqrt({a} * {a} + {b} * {b})", f"hypot({left}, {right})"),
            (f"atan2({a}, {b})", f"atan2({left}, {right})"),
            *((f"{name}({a})", f"{name}({left})") for name in functions),
        ]
        return choices[self.draw(st.integers(0, len(choices) - 1))]

    def beside_product(self, term: tuple[str, str], factor: tuple[str, str]) -> tuple[str, str]:
        """Draw a plain number beside a product or quotient, whose unit may be of several."""
        (a, left), (c, right) = term, factor
        number, sign = self.draw(st.sampled_from(NUMBERS)), self.draw(st.sampled_from("+-"))
        match self.draw(st.integers(0, 3)):
            case 0:
                return f"({a} * {c} {sign} {number})", f"({left} * {right} {sign} {number})"
            case 1:
                return f"({number} {sign} {a} / {c})", f"({number} {sign} {left} / {right})"
            case 2:
                return f"({c} * 2.0 {sign} {number})", f"({right} * 2 s {sign} {number})"
        written = f"({right} * 500 ms / 4 ms {sign} {number})"
        return f"({c} * 500.0 / 4.0 {sign} {number})", written

    def of_several(self, term: tuple[str, str]) -> tuple[str, str]:
        """Draw the least or greatest of three or four, constants among them, or these alone."""
        a, left = term
        name = self.draw(st.sampled_from(("min", "max")))
        chosen = {"min": "least", "max": "greatest"}[name]
        x, y, z = (repr(self.draw(st.sampled_from(NUMBERS))) for _ in range(3))
        match self.draw(st.integers(0, 2)):
            case 0:
                found = f"{chosen}({chosen}({a}, {x}), {a} + {y})"
                return found, f"{name}({left}, {x}, {left} + {y})"
            case 1:
                found = f"{chosen}({chosen}({chosen}({x}, {a} - {y}), {a}), {z})"
                return found, f"{name}({x}, {left} - {y}, {left}, {z})"
        return f"({a} + {chosen}({chosen}({x}, {y}), {z}))", f"({left} + {name}({x}, {y}, {z}))"

    def numeric(self) -> list[int]:
        none = ("boolean", "text", "texts", "first", "point")
        return [n for n, kind in enumerate(self.kinds) if kind not in none]

    def bound(self) -> ir.ValueExpression:
        """Draw what a number is compared with."""
        inputs = self.numeric()
        choice = self.draw(st.integers(0, 11)) if inputs and not self.writable else 9
        if choice == 0:
            return self.arithmetic()
        if choice == 1:
            return self.number(self.draw(st.sampled_from(inputs)))
        if choice == 10:
            return self.tuned()
        if choice == 11:
            formula, written = self.part(1, ["x1"])
            if "x1" not in formula:
                formula, written = f"(x1 * {formula})", f"(x1 * {written})"
            if not re.search("/|sqrt", formula):  # or it could have no value, which is an error
                return ir.Compute(parse(formula), (self.tuned().as_written,), f"({written})")
        return ir.Const(self.draw(st.sampled_from((*NUMBERS, -0.0, 1, 2))))

    def tuned(self) -> ir.Tuned:
        """Draw a value of a tunable constant, and declare that constant."""
        index = self.draw(st.integers(0, min(len(self.tunables), 2)))
        if index == len(self.tunables):
            least, default, greatest = sorted(self.draw(st.sampled_from(NUMBERS)) for _ in "123")
            name = f"limit_{index}"
            constant = ir.TunableConstant(
                name, float(default), float(least), float(greatest), "", span(57)
            )
            self.tunables.append(constant)
        factor = self.draw(st.sampled_from((1.0, 1.0, 2.0, 0.1)))
        offset = self.draw(st.sampled_from((0.0, 0.0, 1.0, -0.5)))
        return ir.Tuned(index, self.draw(st.booleans()), factor, offset, self.draw(st.booleans()))

    # Conditions -----------------------------------------------------------------------------------

    def condition(self, depth: int, atom: Callable[[], ir.Condition]) -> ir.Condition:
        """Draw a condition; before each of its parts there may be a ``not``."""
        condition = self.bare(depth, atom)
        return ir.Not(condition) if self.draw(st.integers(0, 7)) == 7 else condition

    def bare(self, depth: int, atom: Callable[[], ir.Condition]) -> ir.Condition:
        choices = ("atom", "atom", "not", "and", "or", "for", "since", "within", "times", "begins")
        choice = "atom" if depth == 0 else self.draw(st.sampled_from(choices))
        if choice == "atom":
            return atom()
        if choice == "not":
            return ir.Not(self.condition(depth - 1, atom))
        if choice == "for":
            operand = self.condition(depth - 1, atom)
            self.memories += 1
            return ir.For(self.memories - 1, operand, self.draw(durations), span(50))
        if choice == "begins":
            operand = self.condition(depth - 1, atom)
            self.memories += 1
            return ir.Begins(ir.For(self.memories - 1, operand, 1, span(53)))
        if choice == "within":
            operand = self.condition(depth - 1, atom)
            self.memories += 1
            return ir.Once(self.memories - 1, operand, self.draw(durations), span(52))
        if choice == "times":
            operand = self.condition(depth - 1, atom)
            self.memories += 1
            count, duration = self.draw(st.integers(2, 3)), self.draw(st.integers(1, 30))
            return ir.Times(self.memories - 1, operand, count, duration, span(54))
        if choice == "since":
            operand, cause = self.condition(depth - 1, atom), self.condition(depth - 1, atom)
            self.memories += 1
            return ir.Since(self.memories - 1, operand, cause, self.inputs_of(cause), span(51))
        size = self.draw(st.integers(2, 3))
        operands = tuple(self.condition(depth - 1, atom) for _ in range(size))
        return ir.And(operands) if choice == "and" else ir.Or(operands)

    def atom(self) -> ir.Condition:
        """Draw a condition on an input."""
        index = self.draw(st.integers(0, len(self.inputs) - 1))
        choice = self.draw(st.integers(0, 14))
        if choice in (0, 12) and self.inputs[index].timeout_ns is not None:
            return ir.Missing(index)
        if choice in (10, 11) and self.inputs[index].timeout_ns is not None:
            return self.unknown(index)
        if choice in (1, 13) and self.inputs[index].timeout_ns is not None:
            operator = self.draw(orders if self.writable else operators)
            return ir.Age(index, operator, self.draw(st.integers(-1 + self.writable, 10)))
        if choice == 14:
            messages, elapsed_ns = self.draw(st.integers(1, 4)), self.draw(st.integers(1, 30))
            return ir.Frequency(index, messages, elapsed_ns)
        if choice == 2:
            return ir.Truth(ir.Const(self.draw(st.booleans())))
        read = ir.Read(self.inputs[index].leaves[0])
        match self.kinds[index]:
            case "boolean":
                return self.boolean(index, read)
            case "first":
                return self.boolean(index, read)
            case "point":
                zone, point = self.draw(st.sampled_from(ZONES)), self.inputs[index]
                x, y, _ = map(ir.Read, point.leaves)
                return inside(zone, x, y, f"{point.name}.inside({zone.name})")
            case kind if kind in INTEGER_KINDS:
                return self.integer(index)
            case "text" if self.draw(st.booleans()):
                return self.like(index, "text")
            case "text" | "texts":
                operator = self.draw(st.sampled_from(("=", "!=")))
                return ir.Compare(read, operator, ir.Const(self.draw(texts)))
        if choice < 6:
            computes = self.draw(st.integers(0, 2)) == 0
            left, right = self.arithmetic() if computes else self.number(index), self.bound()
            sides = (right, left) if choice == 3 else (left, right)
            return ir.Compare(sides[0], self.draw(operators), sides[1])
        lower, upper = self.bound(), self.bound()
        if self.writable:
            lower = ir.Const(self.draw(st.sampled_from(NUMBERS[:4])))
            upper = ir.Const(self.draw(st.sampled_from(NUMBERS[4:])))
        return self.within(self.number(index), lower, upper)

    def within(
        self, value: ir.ValueExpression, lower: ir.ValueExpression, upper: ir.ValueExpression
    ) -> ir.Within:
        """Draw an interval between two ends; one of constants is not empty: that is an error."""
        closed = self.draw(st.tuples(st.booleans(), st.booleans()))
        if isinstance(lower, ir.Const) and isinstance(upper, ir.Const):
            lower, upper = sorted((lower, upper), key=lambda end: end.value)
            closed = (True, True) if lower == upper else closed
        return ir.Within(value, lower, upper, *closed)

    def unknown(self, index: int) -> ir.Condition:
        """Draw the question whether an input, or a function of it, is unknown."""
        value = self.number(index) if index in self.numeric() else None
        asked = isinstance(value, ir.Apply) and self.draw(st.integers(0, 3))
        return ir.Unknown(index, value if asked else None)  # type: ignore[arg-type]

    def integer(self, index: int) -> ir.Condition:
        """Draw a condition on an integer as it is built: constants stand on the right.

        They are integers, or doubles if what is computed of the integer is no integer. Another
        value that it is compared with may be of any type.
        """
        value = self.number(index)
        if self.kinds[index] in ("long", "wide", "third") and self.draw(st.integers(0, 3)) == 0:
            value = ir.Read(self.inputs[index].leaves[0])
            value = self.remembering("previous", (value,), index)
        bound: st.SearchStrategy[int | float] = st.sampled_from(great_ints)
        if not _is_integer(value):
            bound = bound.map(float)
        choice = self.draw(st.integers(0, 3))
        if choice == 0:
            other = self.number(self.draw(st.sampled_from(self.numeric())))
            return ir.Compare(value, self.draw(operators), other)
        if choice == 1:
            lower, upper = (ir.Const(self.draw(bound)) for _ in range(2))
            return self.within(value, lower, upper)
        return ir.Compare(value, self.draw(operators), ir.Const(self.draw(bound)))

    def boolean(self, index: int, read: ir.Read) -> ir.Condition:
        choices: tuple[ir.Condition, ...] = (
            ir.Truth(read),
            ir.Compare(read, "=", ir.Const(False)),
            ir.Compare(read, "!=", ir.Const(False)),
            ir.Compare(ir.Const(True), "=", read),
            self.like(index, self.kinds[index]),
        )
        return choices[self.draw(st.integers(0, len(choices) - 1))]

    def like(self, index: int, kind: str) -> ir.Condition:
        """Draw the comparison of an input with another of its kind, or with itself."""
        others = [n for n, each in enumerate(self.kinds) if each == kind]
        other = self.inputs[self.draw(st.sampled_from(others))]
        left, right = ir.Read(self.inputs[index].leaves[0]), ir.Read(other.leaves[0])
        return ir.Compare(left, self.draw(st.sampled_from(("=", "!="))), right)

    # Rules, behaviours, actions -------------------------------------------------------------------

    def rule(self) -> ir.Rule:
        index = len(self.rules)
        condition = self.condition(self.draw(st.integers(0, 3)), self.atom_or_rule)
        inputs = self.inputs_of(condition)
        timed = all(self.inputs[each].timeout_ns is not None for each in inputs)
        if inputs and timed and self.draw(st.booleans()):
            condition = ir.Failsafe(condition, inputs)
        rule = ir.Rule(index, "entity", f"rule_{index}", condition, span(10 + index))
        self.rules.append(rule)
        parts = list(walk.parts(condition))
        rounds = [self.rounds[each.rule] for each in parts if isinstance(each, ir.RuleRef)]
        rounds += [each.action + 1 for each in parts if isinstance(each, ir.Active)]
        self.rounds.append(max(rounds, default=0))
        return rule

    def inputs_of(self, condition: ir.Condition) -> tuple[int, ...]:
        """Return the inputs that a condition reads, and the rules that it names."""
        return walk.inputs_behind(condition, self.rules, self.leaves)

    def atom_or_rule(self) -> ir.Condition:
        """Draw a condition on an input, an earlier rule, or an action."""
        if self.watches and self.draw(st.integers(0, 3)) == 0:
            return ir.Active(self.draw(st.integers(0, max(self.actions - 2, 0))), span(55))
        if self.rules and self.draw(st.integers(0, 3)) == 0:
            return ir.RuleRef(self.draw(st.integers(0, len(self.rules) - 1)))
        return self.atom()

    def reference(self) -> ir.Condition:
        """Draw a condition on a rule or an action of an earlier round.

        An action is triggered in the round of its number at the latest, and named in later ones.
        """
        named = [index for index, place in enumerate(self.rounds) if place <= self.round]
        if self.round and (not named or self.draw(st.integers(0, 2)) == 0):
            return ir.Active(self.draw(st.integers(0, self.round - 1)), span(56))
        return ir.RuleRef(self.draw(st.sampled_from(named)))

    def behaviour(self, depth: int, parent: int | None) -> ir.Behaviour:
        index = self.behaviours
        self.behaviours += 1
        if self.watches and parent is None:
            first = min(self.rounds)
            self.round = self.draw(st.integers(min(first, self.actions - 1), self.actions - 1))
        condition = self.condition(self.draw(st.integers(0, 2)), self.reference)
        body: list[ir.Trigger | ir.Behaviour] = []
        for _ in range(self.draw(st.integers(1, 3))):
            if depth and self.draw(st.integers(0, 2)) == 0:
                body.append(self.behaviour(depth - 1, index))
            else:
                action = self.draw(st.integers(self.round, self.actions - 1))
                self.triggered_by.setdefault(action, []).append(index)
                # Every trigger has a line of its own, so that the events name each of them.
                line = 60 + sum(map(len, self.triggered_by.values())) % 39
                arguments = () if self.writable else self.draw(argument_lists)
                body.append(ir.Trigger(action, arguments, span(line)))
        name = f"behaviour_{index + 1}"
        optional = not self.writable and self.draw(st.integers(0, 2)) == 0
        return ir.Behaviour(index, name, condition, tuple(body), parent, span(20 + index), optional)

    def action(self, index: int) -> ir.Action:
        reset = self.draw(st.sampled_from(("never", "latched", "by")))
        last = index if self.watches else self.actions - 1
        reset_by = self.draw(st.integers(0, last)) if reset == "by" else None
        triggered_by = tuple(dict.fromkeys(self.triggered_by.get(index, ())))
        return ir.Action(
            index, f"action_{index}", (), None, reset_by, reset == "latched", triggered_by, span(9)
        )


input_names = st.sampled_from(("speed", "in", "t", "x_2", "/odom.twist"))
orders = st.sampled_from(("<", "<=", ">", ">="))
operators = st.sampled_from(("=", "!=", "<", "<=", ">", ">="))
argument_lists = st.sampled_from(((), (1, 2.5), ("too 'fast\"",), (True,)))
unit_bearing = st.sampled_from((-1.0, -0.5, 0.0, 0.5, 1.0))


@st.composite
def programs(
    draw: Draw, writable: bool = False, kinds: tuple[str, ...] = tuple(KINDS)
) -> ir.Program:
    """Draw a program: up to four inputs, five rules, nested behaviours, actions with resets.

    A ``writable`` one is one that a text in DeRoS can mean (:mod:`tests.support.rules_text`). The
    inputs are of the given ``kinds``.
    """
    drawing = _Drawing(draw, writable, kinds)
    for _ in range(draw(st.integers(1, 4))):
        drawing.input()
    drawing.actions = draw(st.integers(1, 3))
    drawing.watches = drawing.actions > 1 and draw(st.integers(0, 2)) == 0
    rules = tuple(drawing.rule() for _ in range(draw(st.integers(1, 5))))
    behaviours = tuple(drawing.behaviour(2, None) for _ in range(draw(st.integers(1, 4))))
    actions = tuple(drawing.action(index) for index in range(drawing.actions))
    program = ir.Program(
        "random",
        tuple(drawing.leaves),
        tuple(drawing.inputs),
        rules,
        behaviours,
        actions,
        tunables=tuple(drawing.tunables),
    )
    return _as_built(program) if writable else program


def _as_built(program: ir.Program) -> ir.Program:
    """Return a program as the compiler builds it of its text.

    It has no unread fields of whole messages and no timeouts of unused inputs, and a NaN in an
    array that is only counted is ignored, unless it is asked whether the input is missing. All
    three change what happens.
    """
    conditions = tuple(walk.conditions(program))
    values = walk.values(conditions)
    read = {program.leaves[value.leaf].input for value in values if isinstance(value, ir.Read)}
    asked = ir.Missing | ir.Unknown | ir.Age | ir.Frequency
    used = read | {each.input for each in conditions if isinstance(each, asked)}
    inputs = []
    for each in program.inputs:
        taken = each.leaves if each.index in read or each.path else ()
        timeout_ns = each.timeout_ns if each.index in used else None
        inputs.append(replace(each, leaves=taken, timeout_ns=timeout_ns))
    arrays = [
        (term.leaf, FUNCTIONS[value.function].nan_is_unknown)
        for value in walk.values(conditions)
        if isinstance(value, ir.Apply)
        for term in value.arguments
        if isinstance(term, ir.Read) and program.leaves[term.leaf].type.is_array
    ]
    matters = {leaf for leaf, nan_is_unknown in arrays if nan_is_unknown}
    for condition in conditions:
        match condition:
            case (
                ir.Missing(input=index)
                | ir.Age(input=index)
                | ir.Frequency(input=index)
                | ir.Unknown(index, operand=None)
            ):
                matters.update(program.inputs[index].leaves if program.inputs[index].path else ())
    counted = {leaf for leaf, _ in arrays} - matters
    leaves = tuple(
        replace(leaf, nan_is_unknown=leaf.nan_is_unknown and leaf.index not in counted)
        for leaf in program.leaves
    )
    return replace(program, inputs=tuple(inputs), leaves=leaves)


# Traces -------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Step:
    """One call of a monitor, ``wait_ns`` after the one before (before it, if negative).

    A message has a topic and leaves; what is enabled, or disabled, is a behaviour.
    """

    call: Literal["message", "advance", "reset", "enable"]
    wait_ns: int
    topic: str = ""
    leaves: Mapping[int, LeafValue] = field(default_factory=dict)
    behaviour: str = ""
    enabled: bool = True


@dataclass(frozen=True)
class Start:
    """How a monitor starts: the timeouts' grace, and the actions that are active already.

    Tunable constants that are not among the ``constants`` have their defaults.
    """

    grace_ns: int
    latched: frozenset[str]
    constants: tuple[tuple[str, float], ...] = ()


@st.composite
def starts(draw: Draw, program: ir.Program) -> Start:
    """Draw how a program's monitor starts, some of its actions named that are not latched."""
    grace_ns = draw(st.sampled_from((0, 0, 1, 5, 20)))
    names = [each.name for each in program.actions]
    latched = draw(st.frozensets(st.sampled_from(names)))
    chosen = [
        (each.name, draw(st.sampled_from((each.lower, each.default, each.upper))))
        for each in program.tunables
        if draw(st.booleans())
    ]
    return Start(grace_ns, latched, tuple(chosen))


@st.composite
def traces(draw: Draw, program: ir.Program) -> list[Step]:
    """Draw what drives a program's monitor: messages mostly, timers that may be late or absent.

    At times one of the topics never comes, or each comes once before anything else.
    """
    optional = [each.name for each in walk.behaviours(program) if each.optional]
    calls = ["message"] * 5 + ["advance", "reset", *(["enable"] if optional else [])]
    topics = draw(st.permutations(tuple(program.topics)))
    if len(topics) > 1 and draw(st.integers(0, 4)) == 4:  # one of them never comes
        topics = topics[:-1]
    steps: list[Step] = []
    if draw(st.integers(0, 4)) == 4:  # each comes once, in any order
        each_once = ((topic, draw(waits)) for topic in topics)
        steps += [
            Step("message", w, name, draw(leaf_values(program, name))) for name, w in each_once
        ]
    for _ in range(draw(st.integers(4, 30))):
        call = draw(st.sampled_from(calls))
        backward = draw(st.integers(0, 19)) == 0
        wait_ns = -draw(st.integers(1, 15)) if backward else draw(waits)
        if call == "enable":
            name, enabled = draw(st.sampled_from(optional)), draw(st.booleans())
            steps.append(Step(call, wait_ns, behaviour=name, enabled=enabled))
            continue
        if call != "message":
            steps.append(Step(call, wait_ns))
            continue
        if draw(st.integers(0, 3)) == 0:  # repeat a message, as sensors of slow things do
            sent = [each for each in steps if each.call == "message"]
            if sent:
                again = draw(st.sampled_from((*sent, *sent[-1:] * 3)))
                values = draw(st.sampled_from((_same, _almost_same)))
                leaves = {index: values(each) for index, each in again.leaves.items()}
                steps.append(replace(again, wait_ns=wait_ns, leaves=leaves))
                continue
        topic = draw(st.sampled_from(topics))
        steps.append(Step("message", wait_ns, topic, draw(leaf_values(program, topic))))
    return steps


def _is_integer(value: ir.ValueExpression) -> bool:
    """Return whether what is drawn of an integer field is an integer itself."""
    if not isinstance(value, ir.Apply):
        return isinstance(value, ir.Read)
    result = FUNCTIONS[value.function].result
    return result is Result.INTEGER or (
        result is Result.ELEMENT and _is_integer(value.arguments[0])
    )


def _same(value: LeafValue) -> LeafValue:
    return value


def _almost_same(value: LeafValue) -> LeafValue:
    """Return a value that is another one, and yet equal as a double, where there is one."""
    match value:
        case float() if value == 0.0:
            return -value
        case int() if abs(value) >= 2**53:
            return value ^ 1
        case list():
            return [each for each in map(_almost_same, value) if isinstance(each, float | int)]
    return value


@st.composite
def leaf_values(draw: Draw, program: ir.Program, topic: str) -> dict[int, LeafValue]:
    """Draw one message: equal fields have equal values, whichever input reads them."""
    message: dict[FieldPath, LeafValue] = {}
    values: dict[int, LeafValue] = {}
    for leaf in program.leaves:
        if program.inputs[leaf.input].topic == topic:
            if leaf.path not in message:
                message[leaf.path] = draw(_values(leaf))
            values[leaf.index] = message[leaf.path]
    return values


def _values(leaf: ir.Leaf) -> st.SearchStrategy[Any]:
    for kind in ALL_KINDS.values():
        for path, type_, values in kind.leaves:
            if (path, type_) == (leaf.path, leaf.type):
                return values
    raise AssertionError(f"no values for {leaf.path}")
