"""The view of a program that the templates of the C monitor print."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from deros.generators.monitor.c.code.constants import ConstantView, constant_views
from deros.generators.monitor.c.code.handlers import Handler, handlers
from deros.generators.monitor.c.code.layout import Layout, lay_out
from deros.generators.monitor.c.code.literals import integer, literal, number
from deros.generators.monitor.c.code.round_functions import (
    ActionView,
    RoundView,
    actions_of,
    rounds_of,
)
from deros.generators.monitor.c.code.rule_functions import Function, Sites, behave, judge, sites
from deros.generators.monitor.c.code.struct_fields import Field, struct_fields
from deros.generators.monitor.c.code.unsupported import refuse_unsupported
from deros.generators.monitor.c.code.value_types import compared, inputs_of
from deros.generators.text.identifiers import Emitted, check_collisions
from deros.rules.engine.early import with_early
from deros.rules.engine.engine import age_changes
from deros.rules.functions.memories import SAMPLES
from deros.rules.program import walk
from deros.rules.program.ir import (
    Age,
    Behaviour,
    For,
    Frequency,
    Missing,
    Program,
    Rule,
    RuleRef,
    Unknown,
)
from deros.rules.program.rounds import late_rules, rounds


@dataclass(frozen=True, slots=True)
class Timeout:
    """A timeout: its duration, the fields that it concerns, and the function that checks it."""

    input: str
    function: str
    duration_ns: int
    base: str
    came: str
    missing: str
    forget: str


@dataclass(frozen=True, slots=True)
class Forget:
    """The function that makes an input's values unknown.

    Attributes:
        function, input: its name, and that of the input.
        known: the flags that it clears.
        doubles: the numbers that it stores, by the names of their fields.
        times: the times that it stores as -1.
        windows: the samples of which it keeps none.
    """

    function: str
    input: str
    known: tuple[str, ...]
    doubles: tuple[tuple[str, float], ...]
    times: tuple[str, ...]
    windows: tuple[str, ...]

    @property
    def counts(self) -> tuple[str, ...]:
        """The fields that say how many samples there are of a rate."""
        return tuple(f"{name}.count" for name in self.windows)

    @property
    def changed(self) -> tuple[str, ...]:
        """All fields that it sets."""
        return (*self.known, *self.remembered, *self.counts)

    @property
    def remembered(self) -> tuple[str, ...]:
        """The fields of functions with a step."""
        return (*(name for name, _ in self.doubles), *self.times)

    @property
    def stores(self) -> tuple[tuple[str, str], ...]:
        """The same fields, each with what is stored in it."""
        doubles = ((name, number(value)) for name, value in self.doubles)
        return (*doubles, *((name, "-1") for name in self.times))


@dataclass(frozen=True, slots=True)
class End:
    """An instant at which a verdict can change: ``base`` + ``wait_ns``, if there is such a time.

    Attributes:
        guard: the field that tells whether there is; empty if there always is.
        unless: the value that it has if there is none; empty of a boolean.
        base: the field of the time from which it counts.
        wait_ns: how long after that it is.
    """

    guard: str
    unless: str
    base: str
    wait_ns: int

    @property
    def condition(self) -> str:
        """The condition in C that there is such a time."""
        return f"m->{self.guard} != {self.unless}" if self.unless else f"m->{self.guard}"

    @property
    def predicate(self) -> str:
        """The same in ACSL, where a boolean is a number."""
        return f"m->{self.guard} != {self.unless or 0}"


@dataclass(frozen=True, slots=True)
class MessageView:
    """The function that takes a topic's messages, and what it calls after it.

    Attributes:
        rules: the indices of the rules of the first round that a message can change; ``judges``
            their functions.
        judge: the function that evaluates them all; empty if there are none.
        after: the function that does so if a value has changed; empty if no rule reads the topic.
        acts: whether it then runs the behaviours though no verdict of a rule has changed.
    """

    handler: Handler
    rules: tuple[int, ...]
    judges: tuple[str, ...]
    judge: str
    after: str
    acts: bool


@dataclass(frozen=True, slots=True)
class TextTable:
    """A text that rules compare: the positions, from 1, of the constants it is compared with."""

    name: str
    texts: tuple[tuple[str, int], ...]


@dataclass(frozen=True, slots=True)
class ArgumentRows:
    """The table of one call's arguments."""

    name: str
    lines: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class MonitorView:
    """The data of the templates."""

    program: Program
    layout: Layout
    sites: Sites
    fields: tuple[Field, ...]
    texts: tuple[TextTable, ...]
    forgets: tuple[Forget, ...]
    timeouts: tuple[Timeout, ...]
    ends: tuple[End, ...]
    rules: tuple[Function, ...]
    first: tuple[str, ...]
    behaviours: tuple[Function, ...]
    rounds: tuple[RoundView, ...]
    behaviour_names: tuple[tuple[str, str], ...]
    messages: tuple[MessageView, ...]
    actions: tuple[ActionView, ...]
    optional: tuple[tuple[str, str, str], ...]
    constants: tuple[ConstantView, ...]

    @property
    def prefix(self) -> str:
        """The prefix of public names."""
        return self.layout.prefix

    @property
    def macro(self) -> str:
        """The prefix of macros and enumerators."""
        return self.layout.macro

    @property
    def title(self) -> str:
        """The program's name, fit for a comment."""
        return re.sub(r"[^\w .-]", "_", self.program.name)

    @property
    def memory(self) -> int:
        """The greatest size of the struct in bytes, on machines of up to 64 bits."""
        total = sum(field.size for field in self.fields)
        return (total + 7) // 8 * 8

    @property
    def has_instant_timeouts(self) -> bool:
        """Whether an input is missing from the moment on at which its timeout begins."""
        return any(each.duration_ns == 0 for each in self.timeouts)

    @property
    def has_base(self) -> bool:
        """Whether an input counts time from a restart."""
        return any(field.restarted == "from" for field in self.fields)

    @property
    def has_arguments(self) -> bool:
        """Whether an action is called with arguments."""
        return any(site.arguments for site in self.sites.rows)

    @property
    def argument_rows(self) -> Iterator[ArgumentRows]:
        """The tables of the calls' arguments."""
        for index, site in enumerate(self.sites.rows):
            if site.arguments:
                lines = tuple(_argument(self.macro, each) for each in site.arguments)
                yield ArgumentRows(f"arguments_{index}", lines)

    @property
    def site_lines(self) -> Iterator[str]:
        """The rows of the table of sites."""
        for index, site in enumerate(self.sites.rows):
            none = f"{self.macro}_BEHAVIOUR_NONE"
            behaviour = none if site.behaviour is None else self.behaviour_names[site.behaviour][1]
            cells = [self.actions[site.action].enumerator, behaviour, f"{site.line}U"]
            if self.has_arguments:
                rows = f"arguments_{index}" if site.arguments else "NULL"
                cells += [rows, f"{len(site.arguments)}U"]
            yield f"{{{', '.join(cells)}}}"

    def resets_before(self, action: ActionView) -> list[str]:
        """Return the actions that reset those declared before one."""
        return [each.reset_by for each in self.actions[: self.actions.index(action)]]

    @property
    def late_rules(self) -> tuple[Rule, ...]:
        """The rules of all rounds but the first one."""
        return tuple(rule for each in self.rounds[1:] for rule in each.rules)

    @property
    def watched_latched(self) -> tuple[str, ...]:
        """The flags of the latched actions that conditions name, so that a reset is an event."""
        return tuple(each.active for each in self.actions if each.latched and each.watched)

    @property
    def has_latched(self) -> bool:
        """Whether an action is latched."""
        return any(each.latched for each in self.actions)

    @property
    def samples(self) -> int:
        """How many samples a rate over a span of time keeps at most; 0 if there is none."""
        return SAMPLES if any(each.window for each in self.layout.memories.values()) else 0

    @property
    def has_arrays(self) -> bool:
        """Whether a message passes an array."""
        return any(
            parameter.form == "array"
            for message in self.messages
            for parameter in message.handler.parameters
        )


def monitor_view(program: Program) -> MonitorView:
    """Return the view of a program.

    Raises:
        GenerationError: the rules need more than a monitor of fixed size, or C, can do.
    """
    refuse_unsupported(program)
    written = tuple(walk.behaviours(program))
    program = with_early(program)
    layout = lay_out(program)
    places = sites(program)
    rules = tuple(judge(program, layout, rule) for rule in program.rules)
    behaviours = tuple(walk.behaviours(program))
    actions = tuple(actions_of(program, layout, places))
    behaviour_names = tuple((each.name, _enumerator(layout, each.name)) for each in written)
    _check_enumerators(written, program, layout, actions)
    return MonitorView(
        program=program,
        layout=layout,
        sites=places,
        fields=tuple(struct_fields(program, layout)),
        texts=tuple(
            TextTable(t.name, tuple((_c_text(each), len(each.encode())) for each in t.texts))
            for t in layout.terms.values()
            if t.texts
        ),
        forgets=tuple(_forgets(program, layout)),
        timeouts=tuple(_timeouts(program, layout)),
        ends=tuple(ends(program, layout)),
        rules=rules,
        behaviours=tuple(behave(program, layout, each, places) for each in reversed(behaviours)),
        first=tuple(layout.judges[rule.index] for rule in rounds(program)[0].rules),
        rounds=tuple(rounds_of(program, layout, actions)),
        behaviour_names=behaviour_names,
        messages=tuple(_messages(program, layout)),
        actions=actions,
        optional=tuple(
            (each.name, f"{layout.prefix}_enable_{each.name}", layout.enabled[each.index])
            for each in behaviours
            if each.optional
        ),
        constants=constant_views(program),
    )


def _enumerator(layout: Layout, behaviour: str) -> str:
    return f"{layout.macro}_BEHAVIOUR_{behaviour.upper()}"


def _check_enumerators(
    written: Sequence[Behaviour], program: Program, layout: Layout, actions: Sequence[ActionView]
) -> None:
    """Reject names that are one in capitals."""
    callers = {each.index: each.span for each in written}
    spans = [each.span or callers[each.triggered_by[0]] for each in program.actions]
    emitted = [
        Emitted(view.enumerator, f"action {view.name!r}", span)
        for view, span in zip(actions, spans, strict=True)
    ]
    named = [
        Emitted(_enumerator(layout, each.name), f"behaviour {each.name!r}", each.span)
        for each in written
    ]
    none = _enumerator(layout, "none")
    clashes = [each.span for each in named if each.identifier == none]
    emitted += [Emitted(none, "the enumerator of no behaviour", span) for span in clashes[:1]]
    check_collisions([*emitted, *named], "the monitor in C")


def _forgets(program: Program, layout: Layout) -> Iterator[Forget]:
    for index, function in layout.forgets.items():
        terms = [*layout.terms_of(index), *layout.computed_of(index).values()]
        known = dict.fromkeys(term.known for term in terms)
        if layout.inputs[index].known:
            known[layout.inputs[index].known] = None
        memories = layout.memories_of(index).values()
        doubles = tuple(each for memory in memories for each in memory.forgotten.items())
        times = tuple(each.forgotten_t for each in memories if each.forgotten_t)
        windows = tuple(each.window for each in memories if each.window)
        name = program.inputs[index].name
        yield Forget(function, name, tuple(known), doubles, times, windows)


def _timeouts(program: Program, layout: Layout) -> Iterator[Timeout]:
    for index, function in layout.expires.items():
        each, fields = program.inputs[index], layout.inputs[index]
        forget = layout.forgets.get(index, "")
        assert each.timeout_ns is not None
        times = (each.timeout_ns, fields.base, fields.came, fields.missing)
        yield Timeout(each.name, function, *times, forget)


def ends(program: Program, layout: Layout) -> Iterator[End]:
    """Yield the instants, but for timeouts, at which a verdict can change by itself."""
    for condition in walk.conditions(program):
        if isinstance(condition, For) and condition.index in layout.since:
            since = layout.since[condition.index]
            yield End(since, f"{layout.macro}_UNSET", since, condition.duration_ns)
    for name in layout.until.values():
        yield End(name, f"{layout.macro}_NEVER", name, 0)
    for turns in layout.turns.values():
        yield End(turns.ends[-1], "0", turns.ends[-1], 0)
    found: dict[End, None] = {}
    for condition in walk.conditions(program):
        if isinstance(condition, Age):
            fields = layout.inputs[condition.input]
            for change in age_changes(condition):
                if change > 0:  # what is no older than that never was
                    found[End(fields.came, "", fields.base, change)] = None
        elif isinstance(condition, Frequency):
            first = layout.inputs[condition.input].stamps[condition.messages - 1]
            found[End("", "", first, condition.elapsed_ns)] = None
    yield from found


def _messages(program: Program, layout: Layout) -> Iterator[MessageView]:
    inputs = inputs_of_rules(program)
    late = late_rules(program)
    asked = walk.awaited_by_behaviours(program).union(*(inputs[index] for index in late))
    for handler in handlers(program, layout):
        taken = set(handler.inputs)
        reading = [rule.index for rule in program.rules if inputs[rule.index] & taken]
        rules = tuple(index for index in reading if index not in late)
        judges = tuple(layout.judges[index] for index in rules)
        after = handler.observer.replace("observe", "after", 1) if reading else ""
        judge = handler.observer.replace("observe", "judge_by", 1) if judges else ""
        one = judges[0] if len(judges) == 1 else judge
        yield MessageView(handler, rules, judges, one, after, bool(taken & asked))


def inputs_of_rules(program: Program) -> list[set[int]]:
    """Return the inputs that each rule depends on, those of the rules that it names included."""
    inputs: list[set[int]] = []
    for rule in program.rules:
        found: set[int] = set()
        for part in walk.parts(rule.condition):
            if isinstance(part, Missing | Unknown | Age | Frequency):
                found.add(part.input)
            elif isinstance(part, RuleRef):
                found |= inputs[part.rule]
            for value in compared(part):
                found |= inputs_of(program, value)
        inputs.append(found)
    return inputs


def _argument(macro: str, value: bool | int | float | str) -> str:
    truth, whole, real, text = "false", "0", "0.0", "NULL"
    if isinstance(value, bool):
        kind, truth = "TRUTH", literal(value)
    elif isinstance(value, int):
        kind, whole = "INTEGER", integer(value)
    elif isinstance(value, float):
        kind, real = "NUMBER", number(value)
    else:
        kind, text = "TEXT", f'"{_c_text(value)}"'
    return f"{{{macro}_{kind}, {truth}, {whole}, {real}, {text}}}"


def _c_text(text: str) -> str:
    """Return what stands between the quotes: all but plain ASCII as octal escapes of its UTF-8.

    No escape stands before a character that could be taken for its continuation.
    """
    escapes = {ord('"'): '\\"', ord("\\"): "\\\\", ord("?"): "\\?"}
    pieces: list[str] = []
    open_escape = False
    for byte in text.encode():
        octal = not 32 <= byte < 127
        if open_escape and not octal:
            pieces.append('" "')
        pieces.append(f"\\{byte:03o}" if octal else escapes.get(byte, chr(byte)))
        open_escape = octal
    return "".join(pieces)
