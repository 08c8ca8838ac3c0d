"""The symbol table of the emitted monitor: the fields of its struct, and their meaning."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from deros import codes
from deros.diagnostics import Span, report
from deros.generators.api.protocol import GenerationError
from deros.generators.monitor.c.code.computed import computed_functions
from deros.generators.monitor.c.code.names import new_names, prefix_of
from deros.generators.monitor.c.code.value_types import compared, inputs_of, type_of
from deros.generators.monitor.tuned import tuned_values, tuned_words
from deros.generators.text.unique_names import UniqueNames
from deros.interfaces.fields import PathStep
from deros.rules.functions.function_forms import Remembered
from deros.rules.functions.functions import FUNCTIONS, Function
from deros.rules.functions.reads import all_told
from deros.rules.program import walk
from deros.rules.program.ir import (
    Age,
    Apply,
    Compare,
    Compute,
    Condition,
    Const,
    Failsafe,
    For,
    Once,
    Operator,
    Program,
    Read,
    Scale,
    Since,
    Times,
    Truth,
    Tuned,
    Unknown,
    ValueExpression,
    Within,
)
from deros.rules.program.rounds import watched_actions


@dataclass(frozen=True, slots=True)
class Term:
    """A value that conditions read, as the struct keeps it: ``name``, and whether it is ``known``.

    ``inputs`` are those that it is read from: one, or those of the operands of arithmetic. Of a
    value of tunable constants alone there are none, and ``known`` is empty: it never changes.
    ``type`` is ``double``, ``int64_t``, ``uint64_t``, ``bool``, or ``uint32_t`` for a text, which
    is kept as its place (from 1) among the ``texts`` that the rules compare it with, else 0.
    """

    value: ValueExpression
    inputs: frozenset[int]
    name: str
    known: str
    type: str
    texts: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Finding:
    """What is found of floating-point values when a message brings one: how they compare.

    Rules are then judged without another look at the numbers. ``name`` is its field, ``terms`` are
    what it compares, ``inputs`` those whose messages settle it anew.
    """

    name: str
    terms: tuple[Term, ...]
    inputs: frozenset[int]


@dataclass(frozen=True, slots=True)
class InputFields:
    """What is remembered of an input; the names are empty where nothing asks for it.

    Attributes:
        known: whether it has a value, if conditions read it without a function or ask whether
            it is unknown.
        base: from when its timeout counts, and its age if it ``came``.
        came: whether a message has counted since the start or the last step of the clock.
        missing: whether its timeout has passed.
        stamps: when its last messages came that counted, the last one first; as many as its
            frequencies look at.
        awaits: whether verdicts depend on its having come or gone missing.
    """

    known: str
    base: str
    came: str
    missing: str
    awaits: bool = False
    stamps: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Memory:
    """The fields that a function remembers something in.

    Attributes:
        row: of the function.
        doubles: what its step remembers, each with the name of the field.
        last_t: the time of the last message; empty if the step does not ask for it.
        window: the samples in a span of time; empty if the function does not keep any.
    """

    row: Function
    doubles: tuple[tuple[Remembered, str], ...] = ()
    last_t: str = ""
    window: str = ""

    @property
    def names(self) -> tuple[str, ...]:
        """The names of all fields, in the order in which the function takes pointers to them."""
        doubles = (name for _, name in self.doubles)
        return tuple(name for name in (*doubles, self.last_t, self.window) if name)

    @property
    def numbers(self) -> tuple[str, ...]:
        """The names of the fields that are numbers."""
        return tuple(name for name in self.names if name != self.window)

    @property
    def forgotten(self) -> dict[str, float]:
        """The fields that are set to a number when the input becomes unknown."""
        return {name: each.initial for each, name in self.doubles if each.initial is not None}

    @property
    def forgotten_t(self) -> str:
        """The field of a time that is forgotten with the input, if it has one."""
        step = self.row.step
        return self.last_t if step is not None and step.forgets_time else ""


@dataclass(frozen=True, slots=True)
class Turns:
    """What is remembered where turns are counted.

    Attributes:
        ends: until when each of the last turns counts, the last one first.
        held: whether what is counted is true.
    """

    ends: tuple[str, ...]
    held: str


@dataclass(frozen=True, slots=True)
class Layout:
    """The names of all that a program's monitor remembers, and of its functions.

    Attributes:
        prefix: what public names begin with; ``macro`` the same in capitals.
        terms: by value; a leaf, a function, or either in another unit.
        memories: of each function that remembers something.
        findings: of each comparison of floating-point values.
        inputs: of each input, by index.
        forgets: of each input with values, the function that makes them unknown.
        expires: of each input with a timeout, the function that looks whether it has passed.
        since: of each ``For`` with a duration, since when its operand has been true.
        turns: of each ``Times``.
        verdicts, turned: of each rule, what it is worth, and when it last became true or ceased to.
        judges: of each rule, the function that judges it; ``behave`` the same of each behaviour.
        conditions: of each behaviour, what its condition and all around it are worth together;
            ``enabled`` of each optional one.
        active: of each action that can be reset, or that a condition names; ``ran`` of each that
            resets another.
    """

    prefix: str
    names: UniqueNames
    terms: dict[ValueExpression, Term] = field(default_factory=dict)
    memories: dict[Apply, Memory] = field(default_factory=dict)
    findings: dict[Condition, Finding] = field(default_factory=dict)
    inputs: dict[int, InputFields] = field(default_factory=dict)
    forgets: dict[int, str] = field(default_factory=dict)
    expires: dict[int, str] = field(default_factory=dict)
    since: dict[int, str] = field(default_factory=dict)
    until: dict[int, str] = field(default_factory=dict)
    turns: dict[int, Turns] = field(default_factory=dict)
    kept: dict[int, str] = field(default_factory=dict)
    verdicts: dict[int, str] = field(default_factory=dict)
    turned: dict[int, str] = field(default_factory=dict)
    judges: dict[int, str] = field(default_factory=dict)
    behave: dict[int, str] = field(default_factory=dict)
    conditions: dict[int, str] = field(default_factory=dict)
    enabled: dict[int, str] = field(default_factory=dict)
    active: dict[int, str] = field(default_factory=dict)
    ran: dict[int, str] = field(default_factory=dict)

    def names_of_turns(self, counts: Iterable[Times] | None = None) -> list[str]:
        """Return the names of all that remembers turns, or of those of some conditions."""
        indices = self.turns if counts is None else [each.index for each in counts]
        found = (self.turns[each] for each in indices)
        return [name for each in found for name in (*each.ends, each.held)]

    @property
    def fixed(self) -> list[Term]:
        """The values of tunable constants alone, which are set at the start."""
        return [term for term in self.terms.values() if not term.known]

    @property
    def macro(self) -> str:
        """The prefix of macros and enumerators."""
        return self.prefix.upper()

    def terms_of(self, index: int) -> list[Term]:
        """Return the terms that belong to one input; arithmetic belongs to none."""
        return [
            term
            for value, term in self.terms.items()
            if index in term.inputs and not isinstance(value, Compute)
        ]

    def computed_of(self, index: int) -> dict[Compute, Term]:
        """Return the arithmetic that has operands of an input."""
        return {
            value: term
            for value, term in self.terms.items()
            if index in term.inputs and isinstance(value, Compute)
        }

    def memories_of(self, index: int) -> dict[Apply, Memory]:
        """Return what the functions of one input remember."""
        return {value: each for value, each in self.memories.items() if value.input == index}


def lay_out(program: Program) -> Layout:
    """Name the attributes of a program's monitor, in the program's order.

    Raises:
        GenerationError: what a rule compares has no place in a monitor of fixed size.
    """
    layout = Layout(prefix_of(program.name), new_names())
    _name_inputs(program, layout)
    for tuned in tuned_values(program):
        _name_term(program, tuned, layout, program.tunables[tuned.constant].span)
    for condition, span in rule_parts(program):
        for value in compared(condition):
            for operand in value.operands if isinstance(value, Compute) else ():
                _name_term(program, operand, layout, span)
            _name_term(program, value, layout, span)
    for told in all_told(program):
        _name_term(program, told, layout, program.inputs[told.input].span)
    for value in walk.values(walk.conditions(program)):
        if isinstance(value, Apply) and value.state is not None and value not in layout.memories:
            name = program.inputs[value.input].name
            layout.memories[value] = _memory(FUNCTIONS[value.function], name, layout.names)
    for condition in walk.conditions(program):
        _name_finding(condition, layout)
    for each in program.inputs:
        terms = layout.terms_of(each.index) or layout.memories_of(each.index)
        if terms or layout.inputs[each.index].known:
            layout.forgets[each.index] = layout.names.new("forget", each.name)
        if each.timeout_ns is not None:
            layout.expires[each.index] = layout.names.new("expire", each.name)
    _name_verdicts(program, layout)
    _name_actions(program, layout)
    return layout


def _memory(row: Function, name: str, names: UniqueNames) -> Memory:
    if row.step is None:
        return Memory(row, window=names.new(name, "window"))
    doubles = tuple((each, names.new(name, each.name)) for each in row.step.memory)
    return Memory(row, doubles, names.new(name, "last_t") if row.step.is_timed else "")


def rule_parts(program: Program) -> Iterator[tuple[Condition, Span]]:
    """Yield every condition of the rules, operands before the whole, with the span of its rule."""
    for rule in program.rules:
        for part in walk.parts(rule.condition):
            yield part, rule.span


def _name_inputs(program: Program, layout: Layout) -> None:
    asked = {each.input for each in walk.conditions(program) if isinstance(each, Age)}
    sides = [value for each in walk.conditions(program) for value in compared(each)]
    sides += [each for value in sides if isinstance(value, Compute) for each in value.operands]
    read = {program.leaves[value.leaf].input for value in sides if isinstance(value, Read)}
    read |= {
        each.input
        for each in walk.conditions(program)
        if isinstance(each, Unknown) and each.operand is None
    }
    most = walk.most_messages(walk.conditions(program))
    awaited, causes = _awaited(program), walk.inputs_of_causes(walk.conditions(program))
    for each in program.inputs:
        timed = each.timeout_ns is not None
        new = layout.names.new
        layout.inputs[each.index] = InputFields(
            known=new(each.name, "known") if each.index in read else "",
            base=new(each.name, "base") if timed or each.index in asked else "",
            came=new(each.name, "came") if timed or each.index in asked | causes else "",
            missing=new(each.name, "missing") if timed else "",
            awaits=each.index in awaited | causes,
            stamps=tuple(new(each.name, "stamp", n + 1) for n in range(most.get(each.index, 0))),
        )


def _awaited(program: Program) -> set[int]:
    """Return the inputs of which a condition asks whether they are awaited."""
    found: set[int] = set()
    for condition in walk.conditions(program):
        if isinstance(condition, Unknown):
            found.add(condition.input)
        elif isinstance(condition, Failsafe):
            found.update(condition.inputs)
    return found


def _name_term(program: Program, value: ValueExpression, layout: Layout, span: Span) -> None:
    if value in layout.terms:
        return
    inputs = inputs_of(program, value)
    kind = type_of(program, value)
    name = layout.names.new(*_words(program, value))
    if isinstance(value, Read):
        known = layout.inputs[program.leaves[value.leaf].input].known
    elif walk.is_fixed(value):
        known = ""
    else:
        known = layout.names.new(name, "known")
    texts = _texts(program, value, span) if kind == "text" else ()
    kind = "uint32_t" if kind == "text" else kind
    layout.terms[value] = Term(value, inputs, name, known, kind, texts)


_WORDS: dict[Operator, str] = {
    "=": "is",
    "!=": "is_not",
    "<": "below",
    "<=": "at_most",
    ">": "above",
    ">=": "at_least",
}


def _name_finding(condition: Condition, layout: Layout) -> None:
    """Name what is found by a comparison, if it is one of floating-point values."""
    values = compared(condition)
    terms = tuple(dict.fromkeys(layout.terms[value] for value in values))
    floats = any(term.type == "double" for term in terms)
    if condition in layout.findings or isinstance(condition, Truth | Unknown) or not floats:
        return
    match condition:
        case Within(operand=operand):
            words = [*_side(operand, layout), "within"]
        case Compare(left=left, operator=operator, right=right):
            words = [*_side(left, layout), _WORDS[operator], *_side(right, layout)]
        case _:
            return
    inputs: frozenset[int] = frozenset().union(*(term.inputs for term in terms))
    layout.findings[condition] = Finding(layout.names.new(*words), terms, inputs)


def _side(value: ValueExpression, layout: Layout) -> list[str]:
    """Return how a value stands in the name of a finding."""
    if not isinstance(value, Const):
        return [layout.terms[value].name]
    assert not isinstance(value.value, str)
    text = f"{float(value.value):.6g}".replace("+", "")
    return [text.replace("-", "minus_", 1) if text.startswith("-") else text]


def _words(program: Program, value: ValueExpression) -> list[PathStep]:
    match value:
        case Scale():
            return [*_words(program, value.operand), "scaled"]
        case Compute():
            return [computed_functions(program)[value].name.replace("compute", "computed")]
        case Apply():
            return [program.inputs[value.input].name, value.function]
        case Read():
            leaf = program.leaves[value.leaf]
            each = program.inputs[leaf.input]
            within = leaf.path[: len(each.path)] == each.path
            return [each.name, *(leaf.path[len(each.path) :] if within else leaf.path)]
        case Tuned():
            return list(tuned_words(program, value))
        case Const():
            raise AssertionError("a constant is no term")


def _texts(program: Program, value: ValueExpression, span: Span) -> tuple[str, ...]:
    """Return the constants that a text is compared with."""
    found: dict[str, None] = {}
    for part in walk.conditions(program):
        if isinstance(part, Compare) and value in (part.left, part.right):
            other = part.right if part.left == value else part.left
            if not isinstance(other, Const):
                message = "two texts that are read from topics are compared"
                hint = "a monitor of fixed size cannot keep them: compare each with constants"
                raise GenerationError([report(codes.UNSUPPORTED_BY_TARGET, message, span, hint)])
            found[str(other.value)] = None
    return tuple(found)


def _name_verdicts(program: Program, layout: Layout) -> None:
    new = layout.names.new
    for rule in program.rules:
        layout.verdicts[rule.index] = new(rule.entity, rule.name)
        layout.turned[rule.index] = new(rule.entity, rule.name, "turned")
        layout.judges[rule.index] = new("judge", rule.entity, rule.name)
        _name_intervals(rule.condition, layout, rule.entity, rule.name)
    for behaviour in walk.behaviours(program):
        layout.conditions[behaviour.index] = new(behaviour.name, "condition")
        layout.behave[behaviour.index] = new("behave", behaviour.name)
        if behaviour.optional:
            layout.enabled[behaviour.index] = new(behaviour.name, "enabled")
        _name_intervals(behaviour.condition, layout, behaviour.name)


def _name_intervals(condition: Condition, layout: Layout, *words: str) -> None:
    for part in walk.parts(condition):
        if isinstance(part, For) and part.duration_ns > 0:
            layout.since[part.index] = layout.names.new(*words, "since")
        elif isinstance(part, Once) and part.duration_ns > 0:
            layout.until[part.index] = layout.names.new(*words, "until")
        elif isinstance(part, Times):
            ends = (layout.names.new(*words, "end", n) for n in range(1, part.count + 1))
            layout.turns[part.index] = Turns(tuple(ends), layout.names.new(*words, "held"))
        elif isinstance(part, Since):
            layout.kept[part.index] = layout.names.new(*words, "kept")


def _name_actions(program: Program, layout: Layout) -> None:
    watched = watched_actions(program)
    for action in program.actions:
        if action.latched or action.reset_by is not None or action.index in watched:
            layout.active[action.index] = layout.names.new(action.name, "active")
    for action in program.actions:
        if action.reset_by is not None and action.reset_by not in layout.ran:
            name = program.actions[action.reset_by].name
            layout.ran[action.reset_by] = layout.names.new(name, "ran")
