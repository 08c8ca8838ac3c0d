"""The effect of messages on their inputs: one function per topic."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from deros.generators.monitor.c.code.computed import computed_functions
from deros.generators.monitor.c.code.expressions import (
    Arguments,
    Conditions,
    as_double,
    expression,
    present,
)
from deros.generators.monitor.c.code.layout import InputFields, Layout, Term
from deros.generators.monitor.c.code.names import new_names
from deros.generators.monitor.c.code.stamps import deadline_lines, shift_lines
from deros.generators.monitor.c.code.value_types import ELEMENTS, c_type
from deros.generators.monitor.c.helpers import helper_names
from deros.generators.text.c import (
    Call,
    Expression,
    Infix,
    comment,
    lay_out,
    lay_out_if,
    lay_out_list,
)
from deros.generators.text.unique_names import UniqueNames
from deros.interfaces.fields import FieldPath
from deros.interfaces.types import FLOAT_TYPES, STRING_TYPES
from deros.rules.engine.engine import age_changes
from deros.rules.functions.functions import FUNCTIONS, Argument
from deros.rules.program import walk
from deros.rules.program.ir import (
    Age,
    Apply,
    Compute,
    Input,
    Leaf,
    Program,
    Read,
    Scale,
    ValueExpression,
)
from deros.rules.program.values import place_among_arguments


@dataclass(frozen=True, slots=True)
class Parameter:
    """One field of the topic's message, as one to three parameters of C.

    Attributes:
        name: of the first; that of an array's or a text's length ends in ``_count`` or ``_length``,
            that of a flag that the element is there in ``_given``.
        declarations: of all, as C writes them.
        path: the field, from the message's root.
        leaves: the leaves of the program that it feeds.
        form: what is passed: the ``value``; an ``array``'s elements and count; its ``count`` alone;
            a ``text``'s characters and length; only the flag ``given``.
        element: the C type of an array's elements; empty for others.
        given: whether a flag follows that the message's array has the element; for
            floating-point numbers a NaN says it instead.
    """

    name: str
    declarations: tuple[str, ...]
    path: FieldPath
    leaves: tuple[int, ...]
    form: str
    element: str
    given: bool


@dataclass(frozen=True, slots=True)
class Handler:
    """The function that takes a topic's messages.

    Attributes:
        topic: the topic as the rules name it; ``type`` its message type, as ROS 2 writes it.
        function: the function's name; it takes the monitor, the time, then ``parameters``.
        signature: its first line or lines, without what follows them.
        observer: the name of the function that stores the inputs' values; empty if none are read.
        observing: the first line or lines of that; ``observe`` what is in it.
        taker: the name of the function that processes a message at its time; empty likewise.
        taking: the first line or lines of that.
        values: the names of all parameters.
        inputs: what it changes.
    """

    topic: str
    type: str
    function: str
    parameters: tuple[Parameter, ...]
    signature: tuple[str, ...]
    observer: str
    observing: tuple[str, ...]
    observe: tuple[str, ...]
    taker: str
    taking: tuple[str, ...]
    values: tuple[str, ...]
    inputs: tuple[int, ...]

    @property
    def call(self) -> list[str]:
        """The line or lines that call the observer."""
        arguments = ["m", *self.values]
        return lay_out_list(2, f"const bool news = {self.observer}(", arguments, ");")

    @property
    def call_in_vain(self) -> list[str]:
        """The same, where no rule asks what it brings."""
        return lay_out_list(2, f"(void){self.observer}(", ["m", *self.values], ");")

    @property
    def take(self) -> list[str]:
        """The line or lines that call the taker."""
        return lay_out_list(2, f"{self.taker}(", ["m", *self.values], ");")


def handlers(program: Program, layout: Layout) -> tuple[Handler, ...]:
    """Return the handlers of a program, in the order of its topics."""
    names = new_names(each.removeprefix("judge_by_") for each in layout.judges.values())
    return tuple(_Writer(program, layout, topic, names).handler() for topic in program.topics)


_OF_MESSAGES = ("observe", "take", "after", "judge_by")
"""What the functions of one topic begin with; the first two have its parameters."""
_ENDINGS = ("_count", "_length", "_given")
"""What else is passed of a value: its elements' or bytes' number, and whether there is one."""


class _Writer:
    """Writes the handler of one topic."""

    def __init__(self, program: Program, layout: Layout, topic: str, names: UniqueNames) -> None:
        self._program = program
        self._layout = layout
        self._topic = topic
        self._inputs = [each for each in program.inputs if each.topic == topic]
        name = names.new(self._inputs[0].name if len(self._inputs) == 1 else topic)
        self._functions = (f"{layout.prefix}_on_{name}", *(f"{e}_{name}" for e in _OF_MESSAGES))
        self._names = self._known_names()
        self._parameters = self._name_parameters()
        self._arguments = Arguments(self._leaf_names(), self._count_names())

    def handler(self) -> Handler:
        """Return the handler."""
        function, observer, taker, *_ = self._functions
        monitor = f"{self._layout.prefix}_monitor *m"
        declared = [text for each in self._parameters for text in each.declarations]
        lines = [line for each in self._inputs for line in self._observe(each)]
        return Handler(
            self._topic,
            str(self._program.topics[self._topic]),
            function,
            self._parameters,
            tuple(lay_out_list(0, f"void {function}(", [monitor, "int64_t t", *declared], ")")),
            observer if lines else "",
            tuple(lay_out_list(0, f"static bool {observer}(", [monitor, *declared], ")")),
            ("  bool news = false;", *lines, "  return news;"),
            taker if lines else "",
            tuple(lay_out_list(0, f"static void {taker}(", [monitor, *declared], ")")),
            tuple(text.rsplit(" ", 1)[-1].lstrip("*") for text in declared),
            tuple(each.index for each in self._inputs),
        )

    # Parameters ---------------------------------------------------------------------------------

    def _known_names(self) -> UniqueNames:
        """Return the source of names for parameters and constants, without called functions."""
        called = (*self._functions, *self._layout.judges.values())
        return new_names({*helper_names(self._program), *called, "news"})

    def _name_parameters(self) -> tuple[Parameter, ...]:
        groups: dict[FieldPath, list[Leaf]] = {}
        for each in self._inputs:
            for index in each.leaves if self._is_observed(each) else ():
                leaf = self._program.leaves[index]
                if self._is_needed(leaf):
                    groups.setdefault(leaf.path, []).append(leaf)
        return tuple(
            self._parameter(self._names.new(*path, endings=_ENDINGS), path, group)
            for path, group in sorted(
                groups.items(), key=lambda each: place_among_arguments(each[0])
            )
        )

    def _parameter(self, name: str, path: FieldPath, group: list[Leaf]) -> Parameter:
        leaf = group[0]
        element, base = "", leaf.type.base
        counted = not any(self._reads_elements(each) for each in group)
        given = leaf.can_be_absent and (leaf.type.is_array or base not in FLOAT_TYPES)
        if given and not any(self._is_read(each) for each in group):
            form, declarations = "given", []
        elif leaf.type.is_array and counted:
            form, declarations = "count", [f"size_t {name}_count"]
        elif leaf.type.is_array:
            assert isinstance(base, str)
            element = ELEMENTS[base]
            form = "array"
            declarations = [f"const {element} *{name}", f"size_t {name}_count"]
        elif base in STRING_TYPES:
            form, declarations = "text", [f"const char *{name}", f"size_t {name}_length"]
        else:
            form, declarations = "value", [f"{c_type(leaf.type)} {name}"]
        if given:
            declarations.append(f"bool {name}_given")
        leaves = tuple(each.index for each in group)
        return Parameter(name, tuple(declarations), path, leaves, form, element, given)

    def _is_observed(self, each: Input) -> bool:
        """Return whether any condition reads an input; of others only arrivals are recorded."""
        layout, index = self._layout, each.index
        remembered = layout.terms_of(index) or layout.memories_of(index)
        return bool(remembered or layout.inputs[index].base or layout.inputs[index].stamps)

    def _is_needed(self, leaf: Leaf) -> bool:
        """Return whether a leaf is used, or a message does not count without it."""
        return leaf.can_be_absent or self._is_read(leaf)

    def _is_read(self, leaf: Leaf) -> bool:
        """Return whether the value of a leaf is used, or must not be NaN."""
        if leaf.can_be_nan:
            return True
        return Read(leaf.index) in walk.values(walk.conditions(self._program))

    def _reads_elements(self, leaf: Leaf) -> bool:
        """Return whether more than the length of an array is read."""
        if leaf.can_be_nan:
            return True
        return any(
            isinstance(value, Apply)
            and not FUNCTIONS[value.function].reads_length
            and Read(leaf.index) in value.arguments
            for value in walk.values(walk.conditions(self._program))
        )

    def _parameter_of(self, leaf: int) -> Parameter | None:
        return next((each for each in self._parameters if leaf in each.leaves), None)

    def _leaf_names(self) -> dict[int, str]:
        names: dict[int, str] = {}
        for each in self._parameters:
            text = f"{each.name}, {each.name}_count" if each.form == "array" else each.name
            names.update(dict.fromkeys(each.leaves, text))
        return names

    def _count_names(self) -> dict[int, str]:
        return {
            leaf: f"{each.name}_count"
            for each in self._parameters
            if each.form in ("array", "count")
            for leaf in each.leaves
        }

    # One input ----------------------------------------------------------------------------------

    def _observe(self, each: Input) -> list[str]:
        fields = self._layout.inputs[each.index]
        terms = self._layout.terms_of(each.index)
        if not self._is_observed(each):
            return []
        stores = [f"  {line}" for line in [*self._values(each, terms), *self._heard(each, fields)]]
        lines = comment(2, f"Input {each.name}", each.span)
        tests = self._tests(each)
        if not tests:
            return [*lines, *(line[2:] for line in stores)]
        lines += [*lay_out_if(" && ", tests), *stores]
        if each.index in self._layout.forgets:
            forget = self._layout.forgets[each.index]
            lines += ["  } else {", f"    news = {forget}(m) || news;"]
        return [*lines, "  }"]

    def _tests(self, each: Input) -> list[str]:
        """Return the conditions for a message to count: no NaN, no element missing, guards met."""
        tests: dict[str, None] = {}
        for index in each.leaves:
            leaf = self._program.leaves[index]
            parameter = self._parameter_of(index)
            if parameter is None:
                continue
            if parameter.given:
                tests[f"{parameter.name}_given"] = None
            if parameter.form == "array":
                tests[f"({parameter.name}_count <= {self._layout.macro}_MOST_ELEMENTS)"] = None
            if leaf.can_be_nan:
                array = f"are_numbers_{leaf.type.base}({self._arguments.leaves[index]})"
                single = f"is_number({parameter.name})"
                tests[array if leaf.type.is_array else single] = None
        for value in self._functions_of(each):
            guard = FUNCTIONS[value.function].guard
            if guard is not None:
                arguments = [
                    expression(value.arguments[n], self._program, self._arguments)
                    for n in guard.arguments
                ]
                tests[f"{guard.c_call}({', '.join(arguments)})"] = None
        return list(tests)

    def _values(self, each: Input, terms: Sequence[Term]) -> Iterator[str]:
        """Yield the statements that store values, and set ``news`` if one has changed."""
        yield from self._lengths(each)
        for value, memory in self._layout.memories_of(each.index).items():
            yield from self._angle(value.arguments[0])
            arguments = [as_double(value.arguments[0], self._program, self._arguments)]
            if memory.row.over_span:
                span = expression(value.arguments[1], self._program, self._arguments)
                arguments += [self._stamp(value), span]
            else:
                constants = value.arguments[1:]
                arguments += [expression(c, self._program, self._arguments) for c in constants]
                arguments += ["m->now"] if memory.last_t else []
            arguments += [f"&m->{name}" for name in memory.names]
            name = self._names.new(memory.names[0], memory.row.name)
            yield f"  const double {name} = {memory.row.c_name}({', '.join(arguments)});"
            self._arguments.computed[value] = name
        known = self._layout.inputs[each.index].known
        if known:
            yield from _news(known, "true")
        for term in terms:
            yield from self._value(term)
        for arithmetic, term in self._layout.computed_of(each.index).items():
            yield from self._computed(arithmetic, term)
        conditions = Conditions(self._program, self._layout)
        for condition, finding in self._layout.findings.items():
            if each.index in finding.inputs:
                yield from _news(finding.name, conditions.holds(condition))

    def _stamp(self, value: Apply) -> str:
        """Return the stamp of a message, or its time of arrival if it has no header."""
        header = [expression(each, self._program, self._arguments) for each in value.arguments[2:]]
        return f"stamp_of({', '.join(header)})" if header else "m->now"

    def _lengths(self, each: Input) -> Iterator[str]:
        """Yield the statements that compute the length of each quaternion, once."""
        lengths = self._arguments.lengths
        for value in self._functions_of(each):
            quaternion = FUNCTIONS[value.function].argument is Argument.QUATERNION
            if quaternion and value.arguments not in lengths:
                texts = [
                    expression(part, self._program, self._arguments) for part in value.arguments
                ]
                name = self._names.new("length", str(len(lengths) + 1))
                lengths[value.arguments] = name
                yield from lay_out(2, f"const double {name} = ", Call("length_of", tuple(texts)))

    def _angle(self, operand: ValueExpression) -> Iterator[str]:
        """Yield the statement that computes the angle that a memory reads, once."""
        while isinstance(operand, Scale):
            operand = operand.operand
        computed, lengths = self._arguments.computed, self._arguments.lengths
        if isinstance(operand, Apply) and operand.arguments in lengths and operand not in computed:
            text = expression(operand, self._program, self._arguments)
            name = self._names.new("new", operand.function)
            yield f"  const double {name} = {text};"
            computed[operand] = name

    def _value(self, term: Term) -> Iterator[str]:
        if term.texts:
            name = self._arguments.leaves[_leaf_of(term.value)]
            yield from _news(term.name, f"which_{term.name}({name}, {name}_length)", "text")
            return
        text = expression(term.value, self._program, self._arguments)
        if term.type == "double":
            yield f"  m->{term.name} = {text};"
        else:
            yield from _news(term.name, text, _PUT[term.type])
        if not isinstance(term.value, Read):
            yield from _news(term.known, self._is_known(term))

    def _computed(self, value: Compute, term: Term) -> Iterator[str]:
        """Yield the statements that compute arithmetic with the operands that are stored."""
        operands = [self._layout.terms[each] for each in value.operands]
        texts = tuple(f"{_cast(each)}m->{each.name}" for each in operands)
        call = Call(computed_functions(self._program)[value].name, texts)
        yield from lay_out(2, f"m->{term.name} = ", call)
        flags = dict.fromkeys(f"m->{each.known}" for each in operands if each.known)
        known = Infix("&&", (*flags, f"is_number(m->{term.name})"))
        yield from _news(term.known, known)

    def _is_known(self, term: Term) -> str:
        if term.type == "double":
            return f"is_number(m->{term.name})"
        return present(term.value, self._program, self._arguments) or "true"

    def _heard(self, each: Input, fields: InputFields) -> Iterator[str]:
        if fields.base:
            yield f"  m->{fields.base} = m->now;"
        yield from shift_lines(fields.stamps)
        if fields.awaits:
            yield from _news(fields.came, "true")
        elif fields.came:
            yield f"  m->{fields.came} = true;"
        if fields.missing:
            yield from _news(fields.missing, "false")
        waits = [each.timeout_ns] if each.timeout_ns is not None else []
        ages = self._ages(each)
        if ages:
            yield "  news = true;  /* its age is another */"
        elif fields.stamps:
            yield "  news = true;  /* its frequency is another */"
        for condition in ages:
            waits += [change for change in age_changes(condition) if change > 0]
        if waits:
            soonest = f"m->now + INT64_C({min(waits)})"
            yield f"  m->due = earlier(m->due, {soonest});"
        yield from deadline_lines(self._program, each.index, fields.stamps)

    def _ages(self, each: Input) -> list[Age]:
        return [
            condition
            for condition in walk.conditions(self._program)
            if isinstance(condition, Age) and condition.input == each.index
        ]

    def _functions_of(self, each: Input) -> list[Apply]:
        return [
            value
            for value in walk.values(walk.conditions(self._program))
            if isinstance(value, Apply) and value.input == each.index
        ]


def _cast(term: Term) -> str:
    return "" if term.type == "double" else "(double)"


_PUT = {"bool": "truth", "int64_t": "integer", "uint64_t": "unsigned", "uint32_t": "text"}
"""By the type of a field, what the function is called that stores a value in it."""


def _news(field: str, value: Expression, kind: str = "truth") -> list[str]:
    """Return the statement that stores a value and compares it with the one before."""
    call = Call(f"store_{kind}", (f"&m->{field}", value, "news"))
    # It stands in a block in the end, two columns further.
    return [line[2:] for line in lay_out(4, "news = ", call)]


def _leaf_of(value: ValueExpression) -> int:
    assert isinstance(value, Read)
    return value.leaf
