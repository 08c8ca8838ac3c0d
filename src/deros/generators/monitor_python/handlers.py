"""What a message does to its inputs: one handler per topic."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from deros.generators.monitor_python.conditions import literal, scaled
from deros.generators.monitor_python.layout import Layout, input_of
from deros.generators.monitor_python.logic import Atom, Logic, all_of, lay_out, lay_out_call
from deros.generators.monitor_python.names import Names
from deros.generators.monitor_python.rules import Judge
from deros.generators.monitor_python.source import comment
from deros.interfaces.types import FLOAT_TYPES, INTEGER_RANGES, FieldType
from deros.monitor import walk
from deros.monitor.engine import age_changes
from deros.monitor.functions import FUNCTIONS
from deros.monitor.ir import Age, Apply, Const, Input, Leaf, Program, Read, Scale, ValueExpression


@dataclass(frozen=True, slots=True)
class Parameter:
    """One argument of a handler: a field of the topic's message.

    Attributes:
        name: the parameter's name.
        annotation: its type, as Python writes it.
        path: the field, from the message's root. Where the path has an index that the message's
            array does not have, the caller passes NaN.
        leaves: the leaves of the program that it feeds.
    """

    name: str
    annotation: str
    path: tuple[str | int, ...]
    leaves: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Handler:
    """The method that takes a topic's messages.

    Attributes:
        topic: the topic as the rules name it.
        type: its message type, as ROS 2 writes it.
        method: the method's name; its arguments are the time in ns, then ``parameters``.
        parameters: the fields it takes, in order.
        signature: its first line or lines.
        lines: what it does to the inputs.
        judges: the methods that it calls then, for the rules that depend on the topic.
    """

    topic: str
    type: str
    method: str
    parameters: tuple[Parameter, ...]
    signature: tuple[str, ...]
    lines: tuple[str, ...]
    judges: tuple[str, ...]


def handlers(program: Program, layout: Layout, judges: Sequence[Judge]) -> tuple[Handler, ...]:
    """Return the handlers of a program, in the order of its topics."""
    methods = Names(frozenset())
    return tuple(
        _Writer(program, layout, topic).handler(
            methods.new("on", topic), tuple(each.method for each in judges if topic in each.topics)
        )
        for topic in program.topics
    )


class _Writer:
    """Writes the handler of one topic."""

    def __init__(self, program: Program, layout: Layout, topic: str) -> None:
        self._program = program
        self._layout = layout
        self._topic = topic
        self._inputs = [each for each in program.inputs if each.topic == topic]
        self._names = Names()
        self._parameters = self._name_parameters()

    def handler(self, method: str, judges: tuple[str, ...]) -> Handler:
        lines: list[str] = []
        for each in self._inputs:
            lines += self._input(each)
        parameters = tuple(self._parameters.values())
        signature = ["self", "t: int", *(f"{each.name}: {each.annotation}" for each in parameters)]
        return Handler(
            self._topic,
            str(self._program.topics[self._topic]),
            method,
            parameters,
            tuple(lay_out_call(4, f"def {method}(", signature, ") -> None:")),
            tuple(lines),
            judges,
        )

    def _name_parameters(self) -> dict[tuple[str | int, ...], Parameter]:
        leaves: dict[tuple[str | int, ...], list[Leaf]] = {}
        for each in self._inputs:
            for index in each.leaves:
                leaf = self._program.leaves[index]
                leaves.setdefault(leaf.path, []).append(leaf)
        return {
            path: Parameter(
                self._names.new(*path),
                _annotation(group[0].type),
                path,
                tuple(leaf.index for leaf in group),
            )
            for path, group in leaves.items()
        }

    # One input ----------------------------------------------------------------------------------

    def _input(self, each: Input) -> list[str]:
        tests = [*self._presence(each), *self._guards(each)]
        indent = 12 if tests else 8
        observed = [*self._functions(each, indent), *self._observe(each, indent)]
        if not observed:
            return []
        lines = comment(8, f"Input {each.name}", each.span)
        if not tests:
            return lines + observed
        lines += [*lay_out(8, "if ", all_of(tests), ":"), *observed]
        if each.index in self._layout.forget:
            lines += ["        else:", f"            self._{self._layout.forget[each.index]}()"]
        return lines

    def _presence(self, each: Input) -> list[Logic]:
        """Return the tests for NaN: a sensor's, or the caller's for an element not there."""
        tests: list[Logic] = []
        for index in each.leaves:
            leaf = self._program.leaves[index]
            name = self._parameters[leaf.path].name
            is_float = leaf.type.base in FLOAT_TYPES and leaf.nan_is_unknown
            if leaf.type.is_array and is_float:
                tests.append(Atom(f"not any(map(math.isnan, {name}))"))
            elif not leaf.type.is_array and (is_float or _has_index(leaf)):
                tests.append(Atom(f"{name} == {name}"))
        return tests

    def _guards(self, each: Input) -> list[Logic]:
        tests: dict[Logic, None] = {}
        for function in self._functions_of(each):
            guard = FUNCTIONS[function.function].guard
            if guard is not None:
                arguments = [self._value(function.arguments[n]) for n in guard.arguments]
                tests[Atom(f"{guard.python_call}({', '.join(arguments)})")] = None
        return list(tests)

    def _functions(self, each: Input, indent: int) -> list[str]:
        lines: list[str] = []
        blank = " " * indent
        for function in self._functions_of(each):
            row = FUNCTIONS[function.function]
            slot = self._layout.values[function]
            arguments = [self._value(argument) for argument in function.arguments]
            if function.state is not None:
                last, last_t = self._layout.last[function]
                arguments += [f"self._{last}", f"t - self._{last_t}"]
            if row.python and slot.unknown == "NAN":
                name = self._names.new(slot.name)
                lines += lay_out_call(indent, f"{name} = {row.python_call}(", arguments)
                lines.append(f"{blank}self._{slot.name} = NAN if {name} is None else {name}")
            else:
                lines += lay_out_call(indent, f"self._{slot.name} = {row.python_call}(", arguments)
            if function.state is not None:
                lines += [f"{blank}self._{last} = {arguments[0]}", f"{blank}self._{last_t} = t"]
        return lines

    def _observe(self, each: Input, indent: int) -> list[str]:
        layout, index = self._layout, each.index
        statements = [
            f"self._{slot.name} = {self._parameters[self._program.leaves[value.leaf].path].name}"
            for value, slot in layout.values.items()
            if isinstance(value, Read) and input_of(self._program, value) == index
        ]
        if index in layout.counted:
            statements.append(f"self._{layout.counted[index]} = t")
        soonest = min(self._changes(each), default=None)
        if soonest is not None:
            statements += _call_at(soonest)
        if each.timeout_ns is not None:
            missing = layout.missing[index]
            statements += [
                f"self._{layout.heard[index]} = t",
                f"if self._{layout.silent[index]}:",
                f"    self._{layout.silent[index]} = self._{missing} = False",
                *(f"    {line}" for line in _call_at(each.timeout_ns)),
            ]
        return [f"{' ' * indent}{statement}" for statement in statements]

    def _changes(self, each: Input) -> Iterator[int]:
        """Yield the ages of a message at which a verdict can change without another message."""
        for condition in walk.conditions(self._program):
            if isinstance(condition, Age) and condition.input == each.index:
                yield from (change for change in age_changes(condition) if change > 0)

    def _functions_of(self, each: Input) -> list[Apply]:
        return [
            value
            for value in self._layout.values
            if isinstance(value, Apply) and value.input == each.index
        ]

    def _value(self, value: ValueExpression) -> str:
        """Return the text of a function's argument, from the parameters."""
        match value:
            case Const():
                return literal(value.value)
            case Read():
                return self._parameters[self._program.leaves[value.leaf].path].name
            case Scale():
                return scaled(self._value(value.operand), value)
            case Apply():
                return f"self._{self._layout.values[value].name}"


def _call_at(wait_ns: int) -> list[str]:
    """Return the statements that make the deadline one that is so long after now."""
    return [f"if t + {wait_ns:_} < self._due:", f"    self._due = t + {wait_ns:_}"]


def _has_index(leaf: Leaf) -> bool:
    return any(isinstance(step, int) for step in leaf.path)


def _annotation(type_: FieldType) -> str:
    if type_.base in FLOAT_TYPES:
        scalar = "float"
    elif type_.base in INTEGER_RANGES:
        scalar = "int"
    else:
        scalar = "bool" if type_.base == "bool" else "str"
    return f"Sequence[{scalar}]" if type_.is_array else scalar
