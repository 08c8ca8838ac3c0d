"""The symbol table of the emitted monitor: its attributes and their names."""

from __future__ import annotations

from dataclasses import dataclass, field

from deros.generators.monitor.computed import (
    ComputedFunction,
    EntriesFunction,
    PointsFunction,
    computed_functions,
    entries_functions,
    points_functions,
)
from deros.generators.monitor.python.formulas import printed
from deros.generators.monitor.python.names import RESERVED
from deros.generators.monitor.tuned import tuned_values, tuned_words
from deros.generators.text.unique_names import UniqueNames
from deros.interfaces.types import FLOAT_TYPES, INTEGER_RANGES
from deros.rules.engine.cause_plans import telling_unknown, told_rules
from deros.rules.functions.functions import FUNCTIONS, Function, Result
from deros.rules.functions.reads import all_told
from deros.rules.program import walk
from deros.rules.program.ir import (
    Age,
    Apply,
    Begins,
    Compute,
    Condition,
    Failsafe,
    For,
    Not,
    Once,
    Program,
    Read,
    RuleRef,
    Since,
    Times,
    Tuned,
    Unknown,
    ValueExpression,
)
from deros.rules.program.rounds import watched_actions


@dataclass(frozen=True, slots=True)
class Slot:
    """One stored value: the attribute is ``_name``, a local copy of it ``name``.

    ``unknown`` is how *unknown* is written: ``NAN`` for numbers, with which every comparison is
    false, and ``None`` for all else.
    """

    name: str
    unknown: str


@dataclass(frozen=True, slots=True)
class Cell:
    """The numbers that compare with all bounds in the rules as a value does.

    Attributes:
        low: the attribute with the least of them.
        high: that with the greatest.
        bounds: what the rules compare the value with, ascending.
    """

    low: str
    high: str
    bounds: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Layout:
    """The names of all attributes of a program's monitor.

    Attributes:
        names: of them all, and of the methods.
        values: what the conditions read of the inputs' messages, and every function of them; and
            the tunable constants, as written and as they are compared.
        cells: of those values of which most messages say nothing new (:mod:`.slots`).
        computed: of arithmetic, which is among the values, the function that computes it.
        entries: of a count of entries, the function that counts them.
        points: of a count of points in a zone, the function that tells which are inside.
        remembered: of a function with a step, what it remembers beside its result, by the name in
            the step, and under ``last_t`` the time of the last message if the step asks for it.
        memories: of a function whose memory is an object, that object.
        heard: of an input with a timeout, from when it counts: the last counted message, or the
            start; never while the input is missing.
        silent: of such an input, whether it waits for its first message, or for the first after its
            timeout.
        missing: of such an input, whether its timeout has passed.
        known: of an input whose unknown() is asked for, whether it has a value.
        counted: of an input that an ``age()`` asks for, when its last counted message came.
        stamps: of an input that a ``frequency()`` asks for, when its last counted messages came.
        dues: of each ``For``, when it becomes true.
        untils: of each ``Once``, until when it is true.
        turns: of each ``Times``, until when each of the last turns counts.
        held: of each ``Times``, whether its operand was true.
        kept: of each ``Since``, its verdict as the next event remembers it.
        came: of an input that the cause of a ``since`` reads, whether it has come since the start
            or the last step of the clock.
        verdicts: of each rule.
        since: of each rule that is written, when it last became true or ceased to be.
        three_valued: the rules whose falsehood matters, not only their truth.
        refusing: the behaviours whose falsehood matters, because a reset depends on it.
        holds: of each behaviour.
        active: of each action that can be reset, or that a condition names.
        ran: of each action that resets another, whether it ran in the present event.
        forget: of each input with values, the method that makes them unknown.
        why: of each rule, the method that returns why it is true.
        why_not: of each rule that a behaviour negates, the method that returns why it is false.
        why_holds: of each behaviour, the method that returns why it holds.
        why_unknown: of each behaviour that can refuse a reset, that which returns what is unknown.
    """

    names: UniqueNames
    values: dict[ValueExpression, Slot] = field(default_factory=dict)
    cells: dict[ValueExpression, Cell] = field(default_factory=dict)
    computed: dict[Compute, ComputedFunction] = field(default_factory=dict)
    entries: dict[Apply, EntriesFunction] = field(default_factory=dict)
    points: dict[Apply, PointsFunction] = field(default_factory=dict)
    remembered: dict[Apply, dict[str, str]] = field(default_factory=dict)
    memories: dict[Apply, str] = field(default_factory=dict)
    heard: dict[int, str] = field(default_factory=dict)
    silent: dict[int, str] = field(default_factory=dict)
    missing: dict[int, str] = field(default_factory=dict)
    known: dict[int, str] = field(default_factory=dict)
    counted: dict[int, str] = field(default_factory=dict)
    stamps: dict[int, str] = field(default_factory=dict)
    dues: dict[int, str] = field(default_factory=dict)
    untils: dict[int, str] = field(default_factory=dict)
    turns: dict[int, str] = field(default_factory=dict)
    held: dict[int, str] = field(default_factory=dict)
    kept: dict[int, str] = field(default_factory=dict)
    came: dict[int, str] = field(default_factory=dict)
    verdicts: dict[int, str] = field(default_factory=dict)
    since: dict[int, str] = field(default_factory=dict)
    three_valued: frozenset[int] = frozenset()
    refusing: frozenset[int] = frozenset()
    holds: dict[int, str] = field(default_factory=dict)
    active: dict[int, str] = field(default_factory=dict)
    ran: dict[int, str] = field(default_factory=dict)
    forget: dict[int, str] = field(default_factory=dict)
    why: dict[int, str] = field(default_factory=dict)
    why_not: dict[int, str] = field(default_factory=dict)
    why_holds: dict[int, str] = field(default_factory=dict)
    why_unknown: dict[int, str] = field(default_factory=dict)


def lay_out_memory(program: Program) -> Layout:
    """Name the attributes of a program's monitor, in the program's order."""
    layout = Layout(
        UniqueNames(RESERVED),
        three_valued=frozenset(_three_valued(program)),
        refusing=walk.refusing(program),
    )
    conditions = tuple(walk.conditions(program))
    for each in walk.values(conditions):
        if isinstance(each, Apply):
            _name_value(program, each, layout)
    for each in tuned_values(program):
        layout.values[each] = Slot(layout.names.new(*tuned_words(program, each)), "NAN")
    for each in all_told(program):
        _name_value(program, each, layout)
    for condition in conditions:
        for terminal in walk.terminals(condition):
            _name_value(program, terminal, layout)
    layout.computed.update(computed_functions(program, "_compute", RESERVED))
    layout.entries.update(entries_functions(program, "_matches", RESERVED))
    layout.points.update(points_functions(program))
    for number, value in enumerate(layout.computed, 1):
        layout.values[value] = Slot(layout.names.new("computed", number), "NAN")
    _name_inputs(program, layout)
    _name_verdicts(program, layout)
    _name_actions(program, layout)
    _name_causes(program, layout)
    return layout


def slots_of(layout: Layout, program: Program, index: int) -> list[Slot]:
    """Return the slots that hold values of one input."""
    return [slot for value, slot in layout.values.items() if index in inputs_of(program, value)]


def inputs_of(program: Program, value: ValueExpression) -> set[int]:
    """Return the inputs that a leaf, a function, arithmetic or a tunable constant reads."""
    if isinstance(value, Apply):
        return {value.input}
    if isinstance(value, Compute):
        return {index for each in value.operands for index in inputs_of(program, each)}
    if isinstance(value, Tuned):
        return set()
    assert isinstance(value, Read)
    return {program.leaves[value.leaf].input}


def _name_inputs(program: Program, layout: Layout) -> None:
    asked = {
        each.input
        for each in walk.conditions(program)
        if isinstance(each, Unknown) and each.operand is None
    }
    for each in program.inputs:
        if each.timeout_ns is not None:
            layout.heard[each.index] = layout.names.new(each.name, "heard")
            layout.silent[each.index] = layout.names.new(each.name, "silent")
            layout.missing[each.index] = layout.names.new(each.name, "missing")
        if each.index in asked:
            layout.known[each.index] = layout.names.new(each.name, "known")
        if each.index in asked or slots_of(layout, program, each.index):
            layout.forget[each.index] = layout.names.new("forget", each.name)
    for condition in walk.conditions(program):
        if isinstance(condition, Age) and condition.input not in layout.counted:
            name = program.inputs[condition.input].name
            layout.counted[condition.input] = layout.names.new(name, "counted")
    for index in walk.most_messages(walk.conditions(program)):
        layout.stamps[index] = layout.names.new(program.inputs[index].name, "stamps")
    for index in sorted(walk.inputs_of_causes(walk.conditions(program))):
        layout.came[index] = layout.names.new(program.inputs[index].name, "came")


def _name_verdicts(program: Program, layout: Layout) -> None:
    for rule in program.rules:
        layout.verdicts[rule.index] = layout.names.new(rule.entity, rule.name)
        if rule.early_of is None:
            layout.since[rule.index] = layout.names.new(rule.entity, rule.name, "since")
        _name_memories(rule.condition, layout, rule.entity, rule.name)
    for behaviour in walk.behaviours(program):
        layout.holds[behaviour.index] = layout.names.new(behaviour.name)
        _name_memories(behaviour.condition, layout, behaviour.name)


def _name_memories(condition: Condition, layout: Layout, *words: str) -> None:
    for part in walk.parts(condition):
        if isinstance(part, For):
            layout.dues[part.index] = layout.names.new(*words, "due")
        elif isinstance(part, Once):
            layout.untils[part.index] = layout.names.new(*words, "until")
        elif isinstance(part, Times):
            layout.turns[part.index] = layout.names.new(*words, "turns")
            layout.held[part.index] = layout.names.new(*words, "held")
        elif isinstance(part, Since):
            layout.kept[part.index] = layout.names.new(*words, "kept")


def _name_actions(program: Program, layout: Layout) -> None:
    watched = watched_actions(program)
    for action in program.actions:
        if action.latched or action.reset_by is not None or action.index in watched:
            layout.active[action.index] = layout.names.new(action.name, "active")
    for action in program.actions:
        if action.reset_by is not None and action.reset_by not in layout.ran:
            reset_by = program.actions[action.reset_by]
            layout.ran[reset_by.index] = layout.names.new(reset_by.name, "ran")


def _name_causes(program: Program, layout: Layout) -> None:
    asked = told_rules(program)
    for rule in program.rules:
        if (rule.index, True) in asked:
            layout.why[rule.index] = layout.names.new("why", rule.entity, rule.name)
        if (rule.index, False) in asked:
            layout.why_not[rule.index] = layout.names.new("why_not", rule.entity, rule.name)
    for behaviour in walk.behaviours(program):
        layout.why_holds[behaviour.index] = layout.names.new("why", behaviour.name)
    for behaviour in telling_unknown(program):
        layout.why_unknown[behaviour.index] = layout.names.new("why_unknown", behaviour.name)


def knows(row: Function) -> bool:
    """Return whether the function of a row can be emitted as Python."""
    if row.memory is not None and not row.over_span:
        return False
    return bool(row.python_call or row.python_of_unit or printed(row))


def _name_value(program: Program, value: ValueExpression, layout: Layout) -> None:
    if value in layout.values:
        return
    slot = layout.values[value] = _slot(program, value, layout.names)
    if isinstance(value, Apply) and value.state is not None:
        row = FUNCTIONS[value.function]
        if row.step is None or not row.python:
            word = "window" if row.over_span else "memory"
            layout.memories[value] = layout.names.new(slot.name, word)
            return
        names = [each.name for each in row.step.memory if each.name != row.step.result_field]
        names += ["last_t"] if row.step.is_timed else []
        layout.remembered[value] = {name: layout.names.new(slot.name, name) for name in names}


def _slot(program: Program, value: ValueExpression, names: UniqueNames) -> Slot:
    if isinstance(value, Apply):
        unknown = "None" if FUNCTIONS[value.function].result is Result.BOOLEAN else "NAN"
        return Slot(names.new(program.inputs[value.input].name, value.function), unknown)
    assert isinstance(value, Read)
    leaf = program.leaves[value.leaf]
    each = program.inputs[leaf.input]
    rest = leaf.path[len(each.path) :] if leaf.path[: len(each.path)] == each.path else leaf.path
    number = leaf.type.base in INTEGER_RANGES or leaf.type.base in FLOAT_TYPES
    return Slot(names.new(each.name, *rest), "NAN" if number else "None")


def _three_valued(program: Program) -> set[int]:
    """Return the rules whose falsehood a behaviour, a reset or another rule depends on."""
    found: set[int] = set()
    refusing = walk.refusing(program)

    def ask(condition: Condition, for_truth: bool, for_falsehood: bool) -> None:
        match condition:
            case RuleRef(rule=rule) if for_falsehood:
                found.add(rule)
            case Not(operand=operand):
                ask(operand, for_falsehood, for_truth)
            case For() | Once() | Times() | Begins():
                ask(condition.operand, True, for_falsehood)
            case Failsafe(operand=operand):
                ask(operand, True, True)
            case Since(operand=operand, cause=cause):
                ask(operand, True, True)
                ask(cause, True, True)
            case _:
                for operand in getattr(condition, "operands", ()):
                    ask(operand, for_truth, for_falsehood)

    for behaviour in walk.behaviours(program):
        ask(behaviour.condition, True, behaviour.index in refusing)
    for rule in reversed(program.rules):  # a rule comes after those that it names
        ask(rule.condition, True, rule.index in found)
    return found
