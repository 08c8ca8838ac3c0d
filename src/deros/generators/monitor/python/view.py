"""The view of a program that the template of the Python monitor prints."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from deros.generators.monitor.functions import refuse_unknown
from deros.generators.monitor.python.behaviours import act_lines, latched_lines
from deros.generators.monitor.python.constants import (
    ConstantView,
    constant_lines,
    constant_slots,
    constant_views,
)
from deros.generators.monitor.python.formulas import (
    class_name,
    needed_texts,
    printed,
    printed_computed,
    printed_entries,
    printed_points,
)
from deros.generators.monitor.python.handlers import Handler, handlers
from deros.generators.monitor.python.layout import (
    Layout,
    inputs_of,
    knows,
    lay_out_memory,
    slots_of,
)
from deros.generators.monitor.python.names import title
from deros.generators.monitor.python.rule_state import rules_of, verdict_lines, waiting_lines
from deros.generators.monitor.python.rules import Judge, judges
from deros.generators.monitor.python.slots import CELL, lay_out_cells
from deros.generators.text.python import lay_out_call
from deros.rules.engine.early import early_ones, with_early
from deros.rules.engine.engine import age_changes
from deros.rules.engine.evaluate import evaluate_condition, remembered
from deros.rules.engine.state import State
from deros.rules.functions.function_texts import PYTHON
from deros.rules.functions.functions import FUNCTIONS
from deros.rules.program import walk
from deros.rules.program.ir import Age, Apply, Frequency, Program, Temporal, Times, Trigger
from deros.rules.program.rounds import watched_actions


@dataclass(frozen=True, slots=True)
class Forget:
    """The method that makes an input's values unknown: pairs of an attribute and its value."""

    method: str
    input: str
    unknown: tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class Timeout:
    """An input's timeout: its attributes, and the method that is called when it expires."""

    duration_ns: int
    heard: str
    silent: str
    missing: str
    forget: str | None

    @property
    def end(self) -> str:
        """The time at which it expires."""
        return f"self._{self.heard} + {self.duration_ns:_}"


@dataclass(frozen=True, slots=True)
class MonitorView:
    """The data of the template.

    Attributes:
        name: of the program, as the first line of the module has room for it.
        functions: definitions of the functions that the rules use.
        imported: the names of ``collections.abc`` that it needs.
        uses_numpy: whether its numbers are read.
        uses_cache: whether a result that depends on it is cached.
        constants: the tunable ones, and the statements that store them; ``rounds_constants``:
            whether one of them is rounded to a float32.
        slots: the lines that declare the attributes.
        initial: pairs of attribute and value at the start, for those that a clock step keeps.
        restarted: the same for those that it resets.
        forgets, timeouts: of the inputs.
        handlers: one per topic.
        judges: the methods that evaluate rules, and by topic which of them a message calls.
        behaviours: the name of each, the flag that its condition holds, and that of the early one,
            if it has one.
        triggers: whether a behaviour runs an action.
        resets: whether an action can be reset.
        rules_of: the name of each, and the rules that its condition names.
        optional: the names of those that can be disabled.
        verdicts: the lines of the verdicts that ``verdicts()`` returns.
        waiting: the lines of what ``waiting`` returns.
        held: from when the timeouts count that a copy can hold still.
        act: the lines of all behaviours and resets.
        earliest: the lines that return the earliest deadline.
        known_at_start: whether a verdict can be known before any message, so that the first event,
            whichever it is, must evaluate all rules.
        latched: the lines of ``reset()``.
    """

    name: str
    functions: tuple[str, ...]
    imported: tuple[str, ...]
    uses_numpy: bool
    uses_cache: bool
    constants: tuple[ConstantView, ...]
    constant_lines: tuple[str, ...]
    rounds_constants: bool
    slots: tuple[str, ...]
    initial: tuple[tuple[str, str], ...]
    restarted: tuple[tuple[str, str], ...]
    forgets: tuple[Forget, ...]
    timeouts: tuple[Timeout, ...]
    handlers: tuple[Handler, ...]
    judges: tuple[Judge, ...]
    behaviours: tuple[tuple[str, str, str], ...]
    triggers: bool
    resets: bool
    rules_of: tuple[tuple[str, tuple[str, ...]], ...]
    optional: tuple[str, ...]
    verdicts: tuple[str, ...]
    waiting: tuple[str, ...]
    held: tuple[str, ...]
    act: tuple[str, ...]
    earliest: tuple[str, ...]
    known_at_start: bool
    latched: tuple[str, ...]


def monitor_view(program: Program) -> MonitorView:
    """Return the view of a program; safety nodes read the handlers' signatures from it.

    Raises:
        GenerationError: if a rule calls a function that does not exist in Python.
    """
    return view_of(program, *laid_out(program))


def laid_out(program: Program) -> tuple[Program, Layout]:
    """Return the program that runs, which has the early behaviours, too, and its memory.

    Raises:
        GenerationError: if a rule calls a function that does not exist in Python.
    """
    refuse_unknown(program, knows, "Python")
    running = with_early(program)
    layout = lay_out_memory(running)
    layout.cells.update(lay_out_cells(running, layout))
    return running, layout


def view_of(program: Program, running: Program, layout: Layout) -> MonitorView:
    """Return the view of a program that is laid out."""
    functions = _function_texts(layout)
    methods = judges(running, layout)
    known_at_start = _known_at_start(running, layout)
    made = handlers(running, layout, methods, known_at_start)
    annotations = [each.annotation for handler in made for each in handler.parameters]
    arrays = [*functions, *(line for handler in made for line in handler.lines)]
    early = early_ones(running)
    initial = _initial(running, layout, known_at_start)
    restarted = _restarted(running, layout)
    forgets = _forgets(program, layout)
    timeouts = _timeouts(program, layout)
    stored = tuple(constant_lines(running, layout))
    attributes = [
        *("emit", "now", "due"),
        *constant_slots(layout),
        *(name for name, _ in initial),
        *(name for forget in forgets for name, _ in forget.unknown),
        *_times(layout),
        *(
            name
            for timeout in timeouts
            for name in (timeout.heard, timeout.silent, timeout.missing)
        ),
        *(name for name, _ in restarted),
    ]
    return MonitorView(
        name=title(program.name),
        functions=functions,
        imported=tuple(_imported(program, [*functions, *annotations])),
        uses_numpy=any("np." in each for each in arrays),
        uses_cache=any("functools." in each for each in functions),
        constants=constant_views(program),
        constant_lines=stored,
        rounds_constants=any("ctypes." in line for line in stored),
        slots=tuple(_slot_lines(attributes)),
        initial=initial,
        restarted=restarted,
        forgets=forgets,
        timeouts=timeouts,
        handlers=made,
        judges=methods,
        behaviours=tuple(
            (each.name, layout.holds[each.index], layout.holds.get(early.get(each.index, -1), ""))
            for each in walk.behaviours(program)
        ),
        triggers=any(
            isinstance(item, Trigger) for each in walk.behaviours(program) for item in each.body
        ),
        resets=any(each.latched or each.reset_by is not None for each in program.actions),
        act=tuple(act_lines(running, layout, methods)),
        earliest=tuple(_earliest_lines(timeouts, _ends(running, layout))),
        known_at_start=known_at_start,
        latched=tuple(latched_lines(running, layout)),
        rules_of=tuple(rules_of(program)),
        optional=tuple(each.name for each in walk.behaviours(program) if each.optional),
        verdicts=tuple(verdict_lines(program, layout)),
        waiting=tuple(waiting_lines(layout)),
        held=tuple(layout.heard[each.index] for each in walk.holdable_inputs(program)),
    )


def _slot_lines(attributes: Sequence[str]) -> list[str]:
    names = [repr(f"_{name}") for name in dict.fromkeys(attributes)]
    return lay_out_call(4, "__slots__ = (", names)


def _earliest_lines(timeouts: Sequence[Timeout], ends: Sequence[str]) -> list[str]:
    """Return the lines that return the earliest deadline; what is missing has none."""
    if not timeouts and not ends:
        return ["        return NEVER"]
    deadlines = ["NEVER", *(each.end for each in timeouts)]
    if not ends:
        return lay_out_call(8, "return min(", deadlines)
    later = "*(end for end in ends if end > self._now)"
    return [
        *lay_out_call(8, "ends = [", ends, "]"),
        *lay_out_call(8, "return min([", [*deadlines, later], "])"),
    ]


def _imported(program: Program, texts: Sequence[str]) -> Iterator[str]:
    yield from ("Callable", "Collection")
    if program.tunables:
        yield "Mapping"
    if any("Sequence" in each for each in texts):  # an array comes into a handler or a function
        yield "Sequence"


def _function_texts(layout: Layout) -> tuple[str, ...]:
    texts: dict[str, None] = {}
    for value in layout.values:
        if isinstance(value, Apply):
            row = FUNCTIONS[value.function]
            if row.guard is not None:
                texts[row.guard.python] = None
            for name in needed_texts(value):
                texts[PYTHON[name]] = None
            texts.update(dict.fromkeys(printed(row)))
    for function in layout.computed.values():
        texts.update(dict.fromkeys(printed_computed(function)))
    for each in layout.entries.values():
        texts[printed_entries(each)] = None
    for points in layout.points.values():
        texts[printed_points(points)] = None
    if layout.cells:
        texts[CELL] = None
    return tuple(text for text in texts if text)


def _times(layout: Layout) -> list[str]:
    """Return the attributes that hold when a function's last message came."""
    return [names["last_t"] for names in layout.remembered.values() if "last_t" in names]


def _initial(program: Program, layout: Layout, known_at_start: bool) -> tuple[tuple[str, str], ...]:
    pairs = [
        (name, "None" if rule in layout.three_valued else "False")
        for rule, name in layout.verdicts.items()
    ]
    pairs += [
        (name, "None" if index in layout.refusing else "False")
        for index, name in layout.holds.items()
    ]
    for index, name in layout.active.items():
        action = program.actions[index]
        pairs.append((name, f"{action.name!r} in latched" if action.latched else "False"))
    if any(each.optional for each in walk.behaviours(program)):
        pairs.append(("disabled", "set()"))
    pairs += [(name, "start") for name in _times(layout)]
    if known_at_start:
        pairs.append(("started", "False"))
    return tuple(pairs)


def _restarted(program: Program, layout: Layout) -> tuple[tuple[str, str], ...]:
    pairs = [(name, "NAN") for name in layout.counted.values()]
    most = walk.most_messages(walk.conditions(program))
    pairs += [(name, f"(t + grace,) * {most[index]}") for index, name in layout.stamps.items()]
    pairs += [(name, "NEVER") for name in layout.dues.values()]
    pairs += [(name, "0") for name in layout.untils.values()]
    counts = {
        each.index: each.count for each in walk.conditions(program) if isinstance(each, Times)
    }
    pairs += [(name, f"(0,) * {counts[index]}") for index, name in layout.turns.items()]
    booleans = (layout.held, layout.kept, layout.came)
    pairs += [(name, "False") for table in booleans for name in table.values()]
    pairs += [(name, "t") for name in layout.since.values()]
    return tuple(pairs)


def _forgets(program: Program, layout: Layout) -> tuple[Forget, ...]:
    found: list[Forget] = []
    for index, method in layout.forget.items():
        unknown = [(slot.name, slot.unknown) for slot in slots_of(layout, program, index)]
        for value, cell in layout.cells.items():
            if index in inputs_of(program, value):
                unknown += [(cell.low, "NAN"), (cell.high, "NAN")]
        if index in layout.known:
            unknown.append((layout.known[index], "False"))
        for value, names in layout.remembered.items():
            if value.input == index:
                unknown += [(name, "NAN") for key, name in names.items() if key != "last_t"]
        for value, memory in layout.memories.items():
            if value.input == index:
                row = FUNCTIONS[value.function]
                unknown.append((memory, f"{class_name(row)}()"))
        found.append(Forget(method, program.inputs[index].name, tuple(unknown)))
    return tuple(found)


def _timeouts(program: Program, layout: Layout) -> tuple[Timeout, ...]:
    return tuple(
        Timeout(
            each.timeout_ns,
            layout.heard[each.index],
            layout.silent[each.index],
            layout.missing[each.index],
            layout.forget.get(each.index),
        )
        for each in program.inputs
        if each.timeout_ns is not None
    )


def _ends(program: Program, layout: Layout) -> tuple[str, ...]:
    """Return the instants, as attributes or sums, that are deadlines while they lie ahead."""
    ends = [f"self._{name}" for name in (*layout.dues.values(), *layout.untils.values())]
    ends += [f"self._{name}[0]" for name in layout.turns.values()]
    for condition in walk.conditions(program):
        if isinstance(condition, Age):
            counted = layout.counted[condition.input]
            ends += [f"self._{counted} + {change:_}" for change in age_changes(condition)]
        elif isinstance(condition, Frequency):
            first = f"self._{layout.stamps[condition.input]}[-{condition.messages}]"
            ends.append(f"{first} + {condition.elapsed_ns:_}")
    return tuple(dict.fromkeys(ends))


def _known_at_start(program: Program, layout: Layout) -> bool:
    if watched_actions(program):
        return True
    state = State(program, 0, len(layout.holds))
    for rule in program.rules:
        verdict = evaluate_condition(rule.condition, state, 0)
        state.verdicts[rule.index] = verdict
        if verdict or (verdict is False and rule.index in layout.three_valued):
            return True
    for behaviour in walk.behaviours(program):
        evaluate_condition(behaviour.condition, state, 0)
    return any(
        remembered(condition, state) != condition.row.memory.initial
        for condition in walk.conditions(program)
        if isinstance(condition, Temporal)
    )
