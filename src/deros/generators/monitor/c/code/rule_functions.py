"""The functions that evaluate rules and run behaviours."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from deros.generators.monitor.c.code.expressions import Conditions
from deros.generators.monitor.c.code.layout import Layout
from deros.generators.monitor.c.code.literals import integer
from deros.generators.text.c import Call, comment, lay_out, lay_out_if
from deros.generators.text.provenance import header
from deros.rules.program import walk
from deros.rules.program.ir import (
    Action,
    Behaviour,
    Condition,
    For,
    Once,
    Program,
    Rule,
    Since,
    Times,
    Trigger,
)


@dataclass(frozen=True, slots=True)
class Site:
    """A place in the rules that emits an event: a call in a behaviour, or an action's declaration.

    ``line`` is that of the behaviour, or of the declaration.
    """

    action: int
    behaviour: int | None
    line: int
    arguments: tuple[bool | int | float | str, ...] = ()


@dataclass(frozen=True, slots=True)
class Sites:
    """All places that emit events, numbered; ``calls`` by behaviour and place in its body."""

    rows: tuple[Site, ...]
    calls: dict[tuple[int, int], int]
    declarations: dict[int, int]


def sites(program: Program) -> Sites:
    """Return the places that emit events: the calls from top to bottom, then the declarations."""
    rows: list[Site] = []
    calls: dict[tuple[int, int], int] = {}
    for behaviour in walk.behaviours(program):
        for place, item in enumerate(behaviour.body):
            if isinstance(item, Trigger):
                calls[behaviour.index, place] = len(rows)
                line = behaviour.span.line
                rows.append(Site(item.action, behaviour.index, line, item.arguments))
    declarations: dict[int, int] = {}
    for action in program.actions:
        if action.latched or action.reset_by is not None:
            declarations[action.index] = len(rows)
            rows.append(Site(action.index, None, action.span.line if action.span else 0))
    return Sites(tuple(rows), calls, declarations)


@dataclass(frozen=True, slots=True)
class Function:
    """A function of the emitted text: its comment, and the lines of its body."""

    name: str
    comment: tuple[str, ...]
    body: tuple[str, ...]


def judge(program: Program, layout: Layout, rule: Rule) -> Function:
    """Return the function that evaluates a rule and returns whether its verdict has changed."""
    conditions = Conditions(program, layout)
    verdict = layout.verdicts[rule.index]
    arguments = (f"&m->{verdict}", f"&m->{layout.turned[rule.index]}", "m->now")
    found = conditions.verdict(rule.condition)
    body = [
        *_intervals(conditions, layout, rule.condition),
        *lay_out(2, f"const {layout.prefix}_verdict verdict = ", found),
        *lay_out(2, "return ", Call("turned", ("verdict", *arguments))),
    ]
    title = comment(0, f"Rule {rule.full_name}", rule.span)
    return Function(layout.judges[rule.index], tuple(title), tuple(body))


def _intervals(conditions: Conditions, layout: Layout, condition: Condition) -> Iterator[str]:
    for part in walk.parts(condition):
        if isinstance(part, For) and part.index in layout.since:
            since = layout.since[part.index]
            operand = conditions.verdict(part.operand)
            duration = integer(part.duration_ns)
            call = Call("lasting", (operand, duration, "m->now", f"&m->{since}", "&m->due"))
            name = conditions.interval(part)
            yield from lay_out(2, f"const {layout.prefix}_verdict {name} = ", call)
        elif isinstance(part, Once) and part.index in layout.until:
            place = f"&m->{layout.until[part.index]}"
            duration = integer(part.duration_ns)
            operand = conditions.verdict(part.operand)
            call = Call("recent", (operand, duration, "m->now", place, "&m->due"))
            name = conditions.interval(part)
            yield from lay_out(2, f"const {layout.prefix}_verdict {name} = ", call)
        elif isinstance(part, Times):
            yield from _counting(conditions, layout, part)
        elif isinstance(part, Since):
            kept = f"m->{layout.kept[part.index]}"
            lasts = Call("both", (conditions.verdict(part.operand), kept))
            result = Call("either", (conditions.cause(part), lasts))
            yield from lay_out(2, f"{kept} = ", result)


def _counting(conditions: Conditions, layout: Layout, part: Times) -> Iterator[str]:
    """Yield the statements that note a turn, dropping the first one, and count those that count."""
    turns, name = layout.turns[part.index], conditions.interval(part)
    true, first = f"{layout.macro}_TRUE", turns.ends[-1]
    operand, kind = f"{name}_operand", f"const {layout.prefix}_verdict "
    yield from lay_out(2, f"{kind}{operand} = ", conditions.verdict(part.operand))
    yield from lay_out_if(" && ", [f"({operand} == {true})", f"(!m->{turns.held})"])
    for later, earlier in zip(turns.ends[-2::-1], turns.ends[:0:-1], strict=True):
        yield f"    m->{earlier} = m->{later};"
    yield f"    m->{turns.ends[0]} = m->now + {integer(part.duration_ns)};"
    yield from lay_out(4, "m->due = ", Call("ahead", ("m->now", "m->due", f"m->{first}")))
    yield "  }"
    yield f"  m->{turns.held} = ({operand} == {true});"
    counted = Call("counted", (operand, f"m->now < m->{first}"))
    yield from lay_out(2, f"{kind}{name} = ", counted)


def behave(program: Program, layout: Layout, behaviour: Behaviour, places: Sites) -> Function:
    """Return the function that runs a behaviour's body when its condition turns true."""
    conditions = Conditions(program, layout)
    field = f"m->{layout.conditions[behaviour.index]}"
    verdict = conditions.verdict(behaviour.condition)
    for index in behaviour.switches:
        enabled = Call("truth_of", ("true", f"m->{layout.enabled[index]}"))
        verdict = Call("both", (enabled, verdict))
    if behaviour.parent is not None:
        verdict = Call("both", (f"m->{layout.conditions[behaviour.parent]}", verdict))
    acts = any(isinstance(item, Trigger) for item in behaviour.body)
    true = f"{layout.macro}_TRUE"
    edge = [
        f"  const bool held = ({field} == {true});",
        f"  const bool rises = (condition == {true}) && (!held);",
    ]
    body = [
        *_intervals(conditions, layout, behaviour.condition),
        *lay_out(2, f"const {layout.prefix}_verdict condition = ", verdict),
        *(edge if acts else []),
        f"  {field} = condition;",
        *_body(layout, behaviour, places, program),
    ]
    nested = any(isinstance(item, Behaviour) for item in behaviour.body)
    text = header(behaviour.span.text) if nested else behaviour.span.text
    title = comment(0, f"Behaviour {behaviour.name}", behaviour.span, text)
    return Function(layout.behave[behaviour.index], tuple(title), tuple(body))


def _body(layout: Layout, behaviour: Behaviour, places: Sites, program: Program) -> Iterator[str]:
    opened = False
    for place, item in enumerate(behaviour.body):
        if isinstance(item, Behaviour):
            if opened:
                yield "  }"
            opened = False
            yield f"  {layout.behave[item.index]}(m);"
            continue
        if not opened:
            yield "  if (rises) {"
            opened = True
        yield from _trigger(layout, item, places.calls[behaviour.index, place], program)
    if opened:
        yield "  }"


def _trigger(layout: Layout, item: Trigger, site: int, program: Program) -> Iterator[str]:
    if item.action in layout.active:
        yield f"    m->{layout.active[item.action]} = true;"
    if item.action in layout.ran:
        yield f"    m->{layout.ran[item.action]} = true;"
    name = program.actions[item.action].name
    yield f"    {_emit(layout, 'TRIGGER', site)}  /* {name} */"


def settle(layout: Layout, action: Action, places: Sites) -> list[str]:
    """Return the lines that reset an action if it is active and its reset ran, if it needs one.

    The reset is refused unless each condition that triggers it is known to be false.
    """
    site, active = places.declarations[action.index], layout.active[action.index]
    asked = [f"m->{active}"]
    if action.reset_by is not None:
        asked.insert(0, f"m->{layout.ran[action.reset_by]}")
    lines = [f"    m->{active} = false;", f"    {_emit(layout, 'RESET', site)}"]
    conditions = [f"m->{layout.conditions[each]}" for each in action.triggered_by]
    if conditions:
        over = [f"{each} == {layout.macro}_FALSE" for each in conditions]
        lines = [
            *lay_out_if(" && ", over if len(over) == 1 else [f"({each})" for each in over], 4),
            *(f"  {line}" for line in lines),
            "    } else {",
            f"      {_emit(layout, 'REFUSED', site)}",
            "    }",
        ]
    return [*lay_out_if(" && ", asked), *lines, "  }"]


def _emit(layout: Layout, kind: str, site: int) -> str:
    return f"{layout.prefix}_emit(m->owner, m->now, {layout.macro}_{kind}, {site}U);"
