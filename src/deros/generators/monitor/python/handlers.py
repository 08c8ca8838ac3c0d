"""The effect of messages on their inputs: one handler per topic."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from deros.generators.monitor.python.conditions import literal, scaled
from deros.generators.monitor.python.formulas import (
    function_name,
    is_printed,
    length_of_quaternion,
    stamp_of_message,
)
from deros.generators.monitor.python.layout import Layout, inputs_of
from deros.generators.monitor.python.names import RESERVED
from deros.generators.monitor.python.rules import Judge, evaluating_lines
from deros.generators.monitor.python.slots import (
    Slot,
    may_be_wide,
    signed_values,
    stamp_lines,
    stores,
    stores_of_news,
    timed_topics,
)
from deros.generators.text.logic import Atom, Logic, all_of, lay_out
from deros.generators.text.provenance import comment
from deros.generators.text.python import lay_out_call
from deros.generators.text.unique_names import UniqueNames
from deros.interfaces.fields import FieldPath
from deros.interfaces.types import FLOAT_TYPES, INTEGER_RANGES, FieldType
from deros.rules.engine.engine import age_changes
from deros.rules.functions.functions import FUNCTIONS, UNIT_PARTS, Argument, Function, Result
from deros.rules.functions.reads import is_whole
from deros.rules.program import walk
from deros.rules.program.ir import (
    Age,
    Apply,
    Compute,
    Const,
    Input,
    Leaf,
    Program,
    Read,
    Scale,
    Tuned,
    ValueExpression,
)
from deros.rules.program.values import place_among_arguments


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
    path: FieldPath
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
        rest: how it then evaluates the rules that depend on the topic, and runs the behaviours.
    """

    topic: str
    type: str
    method: str
    parameters: tuple[Parameter, ...]
    signature: tuple[str, ...]
    lines: tuple[str, ...]
    rest: tuple[str, ...]


_FRESH = "fresh = True"


def handlers(
    program: Program, layout: Layout, judges: Sequence[Judge], known_at_start: bool
) -> tuple[Handler, ...]:
    """Return the handlers of a program, in the order of its topics.

    They evaluate nothing if a message changes no value. If a verdict is ``known_at_start``, the
    first message, whatever its values, is the first event.
    """
    methods = UniqueNames(frozenset())
    signed = signed_values(program, layout)
    acting = {program.inputs[index].topic for index in walk.awaited_by_behaviours(program)}
    acting |= {topic for each in judges if each.round for topic in each.topics}
    return tuple(
        _Writer(program, layout, topic, known_at_start, signed).handler(
            methods.new("on", topic),
            evaluating_lines(topic, judges, topic in acting, known_at_start),
        )
        for topic in program.topics
    )


class _Writer:
    """Writes the handler of one topic."""

    def __init__(
        self,
        program: Program,
        layout: Layout,
        topic: str,
        at_first: bool,
        signed: frozenset[ValueExpression],
    ) -> None:
        self._program = program
        self._layout = layout
        self._topic = topic
        self._inputs = [each for each in program.inputs if each.topic == topic]
        self._names = UniqueNames(RESERVED)
        self._parameters = self._name_parameters()
        self._locals: dict[ValueExpression, str] = {}
        self._signed = signed
        self._tells_news = topic not in timed_topics(program, layout)
        """Whether a message that says nothing new can be told."""
        self._running = [Atom("self._started")] if at_first else []
        read = [each for each in self._inputs if self._is_observed(each)]
        self._counts_news = self._tells_news and len(read) > 1

    def handler(self, method: str, rest: tuple[str, ...]) -> Handler:
        lines: list[str] = []
        for each in self._inputs:
            lines += self._input(each)
        if self._counts_news:
            test = all_of((Atom("not fresh"), *self._running))
            lines = ["        fresh = False", *lines]
            lines += [*lay_out(8, "if ", test, ":"), "            return"]
        parameters = tuple(self._parameters.values())
        signature = ["self", "t: int", *(f"{each.name}: {each.annotation}" for each in parameters)]
        return Handler(
            self._topic,
            str(self._program.topics[self._topic]),
            method,
            parameters,
            tuple(lay_out_call(4, f"def {method}(", signature, ") -> None:")),
            tuple(lines),
            rest,
        )

    def _name_parameters(self) -> dict[FieldPath, Parameter]:
        leaves: dict[FieldPath, list[Leaf]] = {}
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
            for path, group in sorted(
                leaves.items(), key=lambda each: place_among_arguments(each[0])
            )
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
            lines += [f"            {_FRESH}"] if self._counts_news else []
        return lines

    def _presence(self, each: Input) -> list[Logic]:
        """Return the tests for NaN: from the sensor, or from the caller for a missing element."""
        tests: list[Logic] = []
        for index in each.leaves:
            leaf = self._program.leaves[index]
            name = self._parameters[leaf.path].name
            if leaf.type.is_array and leaf.can_be_nan:
                tests.append(Atom(f"not np.isnan({name}).any()"))
            elif leaf.type.is_array and leaf.can_be_absent:
                tests.append(Atom(f"not isinstance({name}, float)"))
            elif not leaf.type.is_array and (leaf.can_be_nan or leaf.can_be_absent):
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
        """Return the statements that compute the functions of an input, into local names."""
        lines: list[str] = []
        blank = " " * indent
        units: set[tuple[ValueExpression, ...]] = set()
        for function in self._functions_of(each):
            row = FUNCTIONS[function.function]
            if row.argument is Argument.QUATERNION:
                if function.arguments not in units:
                    units.add(function.arguments)
                    lines += self._of_quaternion(each, function.arguments, indent)
                continue
            slot = self._layout.values[function].name
            name = self._locals[function] = self._names.new(slot)
            call, arguments, after = self._call(function, row)
            lines += lay_out_call(indent, f"{name} = {call}(", arguments)
            lines += [f"{blank}{statement}" for statement in after]
            if row.may_be_none:
                lines += [f"{blank}if {name} is None:", f"{blank}    {name} = NAN"]
        return lines

    def _call(self, function: Apply, row: Function) -> tuple[str, list[str], list[str]]:
        """Return what is called for a function, its arguments, and the statements after the call.

        A function whose memory is an object keeps it up to date. Of others the memory is handed in,
        and stored afterwards: each number is the result or a copy of an argument.
        """
        memory = self._layout.memories.get(function)
        arguments = [self._argument(row, value, self._value(value)) for value in function.arguments]
        if memory is not None and row.over_span:
            value, span, *header = arguments
            return f"self._{memory}.rate", [value, stamp_of_message(header), span], []
        if memory is not None and row.step is not None:
            timed = ["t"] if row.step.is_timed else []
            return f"self._{memory}.follow", [*arguments, *timed], []
        if function in self._layout.entries:
            return self._layout.entries[function].name, arguments, []
        if function in self._layout.points:
            points = self._layout.points[function]
            return function_name(row), [*arguments, literal(points.reach), f"_{points.test}"], []
        if row.step is None:
            return function_name(row), arguments, []
        names = self._layout.remembered[function]
        slot = self._layout.values[function].name
        before = [f"self._{names.get(each.name, slot)}" for each in row.step.memory]
        given = dict(zip(row.variables, arguments, strict=True))
        copied = row.step.copied
        after = [f"self._{names[name]} = {given[copied[name]]}" for name in names if name in copied]
        if row.step.is_timed:
            before.append(f"t - self._{names['last_t']}")
            after.append(f"self._{names['last_t']} = t")
        return row.python_call, [*arguments, *before], after

    def _argument(self, row: Function, value: ValueExpression, text: str) -> str:
        """Return the text of an argument: a double, where the function computes with doubles."""
        if not is_printed(row):
            return text
        keeps = row.step is not None and row.step.keeps_integers
        if keeps and may_be_wide(self._program, value):
            return f"float({text}) if {text} == float({text}) else {text}"
        return self._as_float(value, text)

    def _as_float(self, value: ValueExpression, text: str) -> str:
        """Return the text of an argument of a printed function, which computes with doubles."""
        if isinstance(value, Read):
            leaf = self._program.leaves[value.leaf]
            if leaf.type.base in INTEGER_RANGES and not leaf.type.is_array:
                return f"float({text})"
        is_float = not isinstance(value, Apply) or FUNCTIONS[value.function].result is Result.FLOAT
        return text if is_float and not is_whole(value) else f"float({text})"

    def _of_quaternion(
        self, each: Input, parts: tuple[ValueExpression, ...], indent: int
    ) -> list[str]:
        """Return the statements for all functions of one quaternion, normalised once."""
        blank = " " * indent
        texts = [self._value(part) for part in parts]
        results: list[str] = []
        names: list[str] = []
        for function in self._functions_of(each):
            row = FUNCTIONS[function.function]
            if row.argument is Argument.QUATERNION and function.arguments == parts:
                name = self._locals[function] = self._names.new(self._layout.values[function].name)
                *before, result = row.python_of_unit or (_call_of_unit(row),)
                results += [f"{blank}    {line}" for line in before]
                results.append(f"{blank}    {name} = {result}")
                names.append(name)
        return [
            *length_of_quaternion(indent, texts),
            f"{blank}if 0.0 < length < math.inf:",
            *(
                f"{blank}    {unit} = {part} / length"
                for unit, part in zip(UNIT_PARTS, texts, strict=True)
            ),
            *results,
            f"{blank}else:",
            f"{blank}    {' = '.join(names)} = NAN",
        ]

    def _observe(self, each: Input, indent: int) -> list[str]:
        """Return the statements that store a message, and detect whether it changes a value."""
        layout, index = self._layout, each.index
        statements: list[str] = []
        if index in layout.counted:
            statements.append(f"self._{layout.counted[index]} = t")
            soonest = min(self._changes(each), default=None)
            statements += _call_at(soonest) if soonest is not None else []
        if index in layout.stamps:
            local = self._names.new("stamps")
            statements += stamp_lines(self._program, index, layout.stamps[index], local)
        slots = [
            self._slot(value, slot.name)
            for value, slot in layout.values.items()
            if not isinstance(value, Compute) and index in inputs_of(self._program, value)
        ]
        slots += [
            Slot(f"self._{flags[index]}", "True")
            for flags in (layout.known, layout.came)
            if index in flags
        ]
        if each.timeout_ns is not None:
            statements += self._heard(each, each.timeout_ns, bool(slots))
        lines = [f"{' ' * indent}{statement}" for statement in statements]
        return lines + self._news(slots, self._computed(index, indent), indent)

    def _computed(self, index: int, indent: int) -> list[str]:
        """Return the statements that compute arithmetic anew that reads an input."""
        lines: list[str] = []
        for value, function in self._layout.computed.items():
            if index in inputs_of(self._program, value):
                operands = [
                    self._as_float(each, f"self._{self._layout.values[each].name}")
                    for each in value.operands
                ]
                name = self._layout.values[value].name
                lines += lay_out_call(indent, f"self._{name} = {function.name}(", operands)
        return lines

    def _heard(self, each: Input, timeout_ns: int, has_values: bool) -> list[str]:
        """Return the statements that restart the timeout."""
        silent, missing = self._layout.silent[each.index], self._layout.missing[each.index]
        lines = [
            f"self._{self._layout.heard[each.index]} = t",
            f"if self._{silent}:",
            f"    self._{silent} = self._{missing} = False",
            *(f"    {line}" for line in _call_at(timeout_ns)),
        ]
        if has_values:
            return lines  # unknown values tell that it was silent
        if self._counts_news:
            return [*lines, f"    {_FRESH}"]
        if not self._tells_news:
            return lines
        return [*lines, "elif self._started:" if self._running else "else:", "    return"]

    def _slot(self, value: ValueExpression, name: str) -> Slot:
        cell = self._layout.cells.get(value)
        return Slot(f"self._{name}", self._local(value), value in self._signed, cell)

    def _news(self, slots: Sequence[Slot], computed: Sequence[str], indent: int) -> list[str]:
        """Return the statements that store the values, and compute with them if they are news."""
        if not slots or not self._tells_news:
            return [*stores(slots, indent), *computed]
        fresh = _FRESH if self._counts_news else ""
        return stores_of_news(slots, computed, self._running, fresh, indent)

    def _local(self, value: ValueExpression) -> str:
        if value in self._locals:
            return self._locals[value]
        assert isinstance(value, Read)
        return self._parameters[self._program.leaves[value.leaf].path].name

    def _changes(self, each: Input) -> Iterator[int]:
        """Yield the ages of a message at which a verdict can change without another message."""
        for condition in walk.conditions(self._program):
            if isinstance(condition, Age) and condition.input == each.index:
                yield from (change for change in age_changes(condition) if change > 0)

    def _is_observed(self, each: Input) -> bool:
        layout, index = self._layout, each.index
        tables = (layout.forget, layout.came, layout.counted, layout.stamps)
        has_values = any(index in names for names in tables)
        return has_values or each.timeout_ns is not None

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
                return self._locals[value]
            case Compute() | Tuned():
                raise AssertionError("arithmetic and constants are no arguments of a function")


def _call_of_unit(row: Function) -> str:
    return f"{function_name(row)}({', '.join(row.variables)})"


def _call_at(wait_ns: int) -> list[str]:
    """Return the statements that schedule the deadline at a time after now."""
    return [f"if t + {wait_ns:_} < self._due:", f"    self._due = t + {wait_ns:_}"]


def _annotation(type_: FieldType) -> str:
    if type_.base in FLOAT_TYPES:
        scalar = "float"
    elif type_.base in INTEGER_RANGES:
        scalar = "int"
    else:
        scalar = "bool" if type_.base == "bool" else "str"
    return f"Sequence[{scalar}]" if type_.is_array else scalar
