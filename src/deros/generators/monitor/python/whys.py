"""The view of what the explanation of a program prints: its methods, and what they need.

They return why a rule is true, or false, and why a behaviour holds or is unknown.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TypeVar

from deros.generators.monitor.python.conditions import Conditions
from deros.generators.monitor.python.layout import Layout
from deros.generators.monitor.python.names import title
from deros.generators.monitor.python.rule_state import rule_state_lines, value_text
from deros.generators.text.logic import Atom, Logic, lay_out, text
from deros.generators.text.python import lay_out_call, names_in, tuple_entries
from deros.rules.engine.cause_plans import (
    AllOf,
    AnyOf,
    During,
    NoValue,
    OrUnknown,
    Plan,
    Reading,
    Say,
    SayRule,
    plan_of_behaviour,
    plan_of_rule,
    plan_of_unknown,
    since_text,
    telling_unknown,
)
from deros.rules.engine.cause_texts import Beams, Lasting, Piece, beams_of
from deros.rules.engine.early import early_ones
from deros.rules.functions.reads import Term, term_name
from deros.rules.program import walk
from deros.rules.program.ir import Once, Program, Since

_PLACE = "\0"  # stands for a value while a text is quoted

Key = TypeVar("Key")


@dataclass(frozen=True, slots=True)
class Why:
    """A generated method that returns the causes of a rule or a behaviour.

    Attributes:
        method: its name, without the leading ``_``.
        subject: the rule or behaviour whose causes it returns.
        lines: of its body.
    """

    method: str
    subject: str
    lines: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Told:
    """A behaviour's attribute, and the methods that return its causes.

    ``holds`` is that while it is true; ``unknown``, of those that can refuse a reset, while it is
    unknown.
    """

    attribute: str
    holds: str
    unknown: str


@dataclass(frozen=True, slots=True)
class ExplanationView:
    """The data of the template of the explanation.

    Attributes:
        name: of the program, as the first line of the module has room for it.
        names: what is used of the monitor, of the standard library, and of the template's own.
        explained: the lines of the rule states that ``explain()`` returns.
        whys: the methods that return why rules are true or false, and why behaviours hold.
        told: of each behaviour its name, and by its attribute the methods that return its causes;
            then the same of its early one, if there is one.
    """

    name: str
    names: frozenset[str]
    explained: tuple[str, ...]
    whys: tuple[Why, ...]
    told: tuple[tuple[str, Told, Told | None], ...]


def explanation_view(program: Program, running: Program, layout: Layout) -> ExplanationView:
    """Return the view of a program that is laid out."""
    early = early_ones(running)
    methods = tuple(whys(running, layout))
    explained = tuple(rule_state_lines(program, layout))
    told = tuple(
        (
            each.name,
            _told(layout, each.index),
            _told(layout, early[each.index]) if each.index in early else None,
        )
        for each in walk.behaviours(program)
    )
    bodies = (line for each in methods for line in ("def why(self):", *each.lines))
    lines = ("(", *explained, ")", *bodies)
    return ExplanationView(title(program.name), names_in(lines), explained, methods, told)


def _told(layout: Layout, behaviour: int) -> Told:
    unknown = layout.why_unknown.get(behaviour, "")
    return Told(layout.holds[behaviour], layout.why_holds[behaviour], unknown)


def whys(program: Program, layout: Layout) -> Iterator[Why]:
    """Yield the methods of all rules, then of all behaviours."""
    emitter = _Emitter(program, layout)
    for rule in program.rules:
        for methods, holds in ((layout.why, True), (layout.why_not, False)):
            if rule.index in methods:
                lines = emitter.body(plan_of_rule(program, rule.index, holds))
                subject = f"{rule.full_name} is {str(holds).lower()}"
                yield Why(methods[rule.index], subject, tuple(lines))
    for behaviour in walk.behaviours(program):
        lines = emitter.body(plan_of_behaviour(program, behaviour))
        yield Why(layout.why_holds[behaviour.index], f"{behaviour.name} holds", tuple(lines))
    for behaviour in telling_unknown(program):
        lines = emitter.unknown_body(plan_of_unknown(program, behaviour))
        subject = f"{behaviour.name} is unknown"
        yield Why(layout.why_unknown[behaviour.index], subject, tuple(lines))


class _Emitter:
    """Emits plans. Conditions read the attributes themselves, as causes are seldom requested."""

    def __init__(self, program: Program, layout: Layout) -> None:
        self._program = program
        self._layout = layout
        self._own = replace(
            layout,
            values={
                value: replace(slot, name=f"self._{slot.name}")
                for value, slot in layout.values.items()
            },
            silent=_of_self(layout.silent),
            missing=_of_self(layout.missing),
            known=_of_self(layout.known),
            counted=_of_self(layout.counted),
            stamps=_of_self(layout.stamps),
            dues=_of_self(layout.dues),
            untils=_of_self(layout.untils),
            turns=_of_self(layout.turns),
            kept=_of_self(layout.kept),
            verdicts=_of_self(layout.verdicts),
        )
        self._conditions = Conditions(program, self._own, "self._now")
        self._parts = 0  # local variables of a method

    def body(self, plan: Plan) -> list[str]:
        """Return the statements that collect the causes of a condition that is known to hold."""
        self._parts = 0
        if not _has_tests(plan):
            causes = map(self._cause, _sayings(plan))
            return lay_out_call(8, "return (", tuple_entries(causes))
        lines = ["        found = []", *self._block(8, plan, known=True)]
        return [*lines, "        return tuple(found)"]

    def unknown_body(self, plan: NoValue) -> list[str]:
        """Return the statements that return what is unknown."""
        calls = [
            [f"({', '.join(self._reading(each))})" for each in readings] for readings in plan.tiers
        ]
        lines: list[str] = []
        for number, readings in enumerate(calls):
            lines += [*(["        if not found:"] if number else [])]
            lines += lay_out_call(12 if number else 8, "found = without_value(", readings)
        otherwise = f"({plan.otherwise!r},)"
        return [*lines, f"        return {f'found or {otherwise}' if lines else otherwise}"]

    def _reading(self, each: Reading) -> tuple[str, str, str]:
        """Return the verdict of the rule that reads a term, the term's name, and its value."""
        verdict = "None" if each.rule is None else f"self._{self._layout.verdicts[each.rule]}"
        term = each.term
        value = "None" if term is None else value_text(self._program, term, self._layout)
        beams = beams_of(term) if term is not None else ()
        return verdict, self._pieces((each.name, *beams)), value

    # Statements, which append to what was found ---------------------------------------------------

    def _block(self, indent: int, plan: Plan, known: bool) -> list[str]:
        """Return the statements of a plan; ``known``: the condition is known to hold."""
        match plan:
            case Say() | SayRule() if known:
                return lay_out_call(indent, "found.append(", [self._cause(plan)])
            case Say() | SayRule() | During() if not known:
                return [
                    *lay_out(indent, "if ", self._test(plan), ":"),
                    *self._block(indent + 4, plan, True),
                ]
            case During():
                return self._block(indent, plan.part, plan.is_sure)
            case AllOf() if not known:
                lines: list[str] = []
                parts = [self._expression(indent, each, False, lines) for each in plan.parts]
                return [*lines, *lay_out_call(indent, "found += all_of(", parts)]
            case AllOf() | AnyOf():
                sure = isinstance(plan, AllOf)
                return [line for each in plan.parts for line in self._block(indent, each, sure)]
            case OrUnknown():
                return [
                    *self._block(indent, plan.part, False),
                    f"{' ' * indent}if not found:",
                    *lay_out_call(indent + 4, "found.append(", [self._unknown(plan)]),
                ]
        raise AssertionError("every plan is one of these")

    # Expressions, of which there is none where one part has none ----------------------------------

    def _expression(self, indent: int, plan: Plan, known: bool, before: list[str]) -> str:
        """Return the expression of a plan; of what it consists of is added to the lines before."""
        match plan:
            case Say() | SayRule():
                test = "True" if known else text(self._test(plan))
                return f"given({test}, {self._cause(plan)})"
            case During():
                if known:
                    return self._expression(indent, plan.part, plan.is_sure, before)
                test = text(self._test(plan))
                if plan.is_sure and isinstance(plan.part, Say | SayRule):
                    return f"given({test}, {self._cause(plan.part)})"
                part = self._expression(indent, plan.part, plan.is_sure, before)
                return f"given({test}, *{part})"
            case AllOf() | AnyOf():
                sure = known and isinstance(plan, AllOf)
                head = "all_of" if isinstance(plan, AllOf) else "any_of"
                parts = [self._expression(indent, each, sure, before) for each in plan.parts]
                self._parts += 1
                name = f"part_{self._parts}"
                before += lay_out_call(indent, f"{name} = {head}(", parts)
                return name
            case OrUnknown():
                raise AssertionError("failsafe is a whole rule, and no part of one")

    def _test(self, plan: Say | SayRule | During) -> Logic:
        match plan:
            case Say():
                asked = self._conditions.true if plan.holds else self._conditions.false
                return asked(plan.condition)
            case SayRule():
                verdict = f"self._{self._layout.verdicts[plan.rule]}"
                return Atom(verdict if plan.holds else f"{verdict} is False")
            case During(interval=Since() | Once() as interval):
                asked = self._conditions.true if plan.reached else self._conditions.false
                return asked(interval)
            case During():
                due = self._own.dues[plan.interval.index]
                reached, waits = f"self._now >= {due}", f"self._now < {due} < NEVER"
                return Atom(reached if plan.reached else waits)

    def _cause(self, part: Say | SayRule) -> str:
        if isinstance(part, SayRule):
            method = (self._layout.why if part.holds else self._layout.why_not)[part.rule]
            return f"because({self._pieces(part.head)}, self._{method}())"
        return self._pieces(part.pieces)

    def _pieces(self, pieces: tuple[Piece, ...]) -> str:
        values = [self._shown(each) for each in pieces if not isinstance(each, str)]
        texts = [each if isinstance(each, str) else _PLACE for each in pieces]
        return _text(texts, values)

    def _shown(self, piece: Term | Lasting | Beams) -> str:
        if isinstance(piece, Beams):
            return f"beams_text(self._{self._layout.values[piece.share].name})"
        return f"shown({self._value(piece)})"

    def _value(self, piece: Term | Lasting) -> str:
        if not isinstance(piece, Lasting):
            return value_text(self._program, piece, self._layout)
        due = self._own.dues[piece.interval.index]
        if piece.remains:
            return f"({due} - self._now) / 1e9"
        return f"(self._now - {due} + {piece.interval.duration_ns:_}) / 1e9"

    def _unknown(self, plan: OrUnknown) -> str:
        reads = list(map(self._read, plan.terms))
        if plan.results:
            reads.append(f"results=({', '.join(map(self._read, plan.results))},)")
        return f"unknown_of({', '.join(reads)})"

    def _read(self, each: Term | Since) -> str:
        """Return the name and the value of a term, or of the verdict that a ``since`` remembers."""
        if isinstance(each, Since):
            return f"({since_text(each)!r}, {self._own.kept[each.index]})"
        name = self._pieces((term_name(self._program, each), *beams_of(each)))
        return f"({name}, {value_text(self._program, each, self._layout)})"


def _has_tests(plan: Plan, known: bool = True) -> bool:
    """Return whether a plan asks for anything; ``known``: its condition is known to hold."""
    match plan:
        case Say() | SayRule():
            return not known
        case AllOf():
            return any(_has_tests(each, known) for each in plan.parts)
        case AnyOf():
            return any(_has_tests(each, False) for each in plan.parts)
        case During():
            return not known or _has_tests(plan.part, plan.is_sure)
        case OrUnknown():
            return _has_tests(plan.part, False)


def _sayings(plan: Plan) -> Iterator[Say | SayRule]:
    """Yield the causes of a plan without alternatives."""
    match plan:
        case Say() | SayRule():
            yield plan
        case AllOf() | AnyOf():
            for each in plan.parts:
                yield from _sayings(each)
        case During() | OrUnknown():
            yield from _sayings(plan.part)


def _of_self(names: dict[Key, str]) -> dict[Key, str]:
    return {key: f"self._{name}" for key, name in names.items()}


def _text(pieces: list[str], values: list[str]) -> str:
    """Return a string literal, with a value in each place."""
    if not values:
        return repr("".join(pieces))
    quoted = repr("".join(each.replace("{", "{{").replace("}", "}}") for each in pieces))
    first, *rest = quoted.split(repr(_PLACE)[1:-1])
    return f"f{first}" + "".join(f"{{{v}}}{t}" for v, t in zip(values, rest, strict=True))
