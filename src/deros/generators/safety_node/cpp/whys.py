"""C++ functions that return why a rule is true or false, a behaviour holds or is unknown."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from deros.generators.monitor.c.interface import (
    SYMBOLS,
    Conditions,
    Layout,
    compared,
    integer,
    known_of,
)
from deros.generators.safety_node.cpp.rule_state import (
    beams_texts,
    reading,
    reading_of_sector,
    shown_text,
)
from deros.generators.text import logic
from deros.generators.text.c import flat, lay_out_if
from deros.generators.text.cpp import Call, Chain, Expression, cpp_string, expression_lines
from deros.generators.text.logic import Atom, Logic, NoneOf, all_of, any_of
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
    told_rules,
)
from deros.rules.engine.cause_texts import Beams, Lasting, Piece
from deros.rules.functions.reads import Term
from deros.rules.program import walk
from deros.rules.program.ir import (
    OPPOSITE,
    Active,
    Age,
    And,
    Begins,
    Compare,
    Compute,
    Condition,
    Const,
    For,
    Frequency,
    Missing,
    Not,
    Once,
    Or,
    Program,
    RuleRef,
    Since,
    Times,
    Truth,
    Unknown,
    Within,
)


@dataclass(frozen=True, slots=True)
class CauseFunction:
    """A function that returns the causes of a verdict.

    Attributes:
        function: its name.
        subject: the verdict, as a clause.
        lines: the lines of its body.
    """

    function: str
    subject: str
    lines: tuple[str, ...]

    @property
    def reads(self) -> bool:
        """Whether it looks at the monitor at all."""
        return any(_MONITOR.search(_TEXT.sub("", line)) for line in self.lines)


@dataclass(frozen=True, slots=True)
class Told:
    """The field of a behaviour's condition, and the functions that return its causes.

    ``holds`` is that while it is true; ``unknown`` that while it is unknown, or ``nullptr`` of one
    that never refuses a reset.
    """

    field: str
    holds: str
    unknown: str


_TEXT = re.compile(r'"(?:[^"\\]|\\.)*"')
_MONITOR = re.compile(r"\bm\b")


def why_rule(layout: Layout, rule: int, holds: bool = True) -> str:
    """Return the name of the function that returns why a rule is true or false."""
    return f"why_{str(holds).lower()}_{layout.verdicts[rule]}"


def told(program: Program, layout: Layout, behaviour: int) -> Told:
    """Return the field of a behaviour's condition with its cause functions."""
    name = layout.conditions[behaviour]
    can_refuse = any(each.index == behaviour for each in telling_unknown(program))
    return Told(name, f"why_holds_{name}", f"why_unknown_{name}" if can_refuse else "nullptr")


def cause_functions(program: Program, layout: Layout) -> Iterator[CauseFunction]:
    """Yield the functions of rules, then of all behaviours; the monitor's struct is ``m``."""
    emitter = _Emitter(program, layout)
    asked = told_rules(program)
    for rule in program.rules:
        for holds in (each for each in (True, False) if (rule.index, each) in asked):
            plan = plan_of_rule(program, rule.index, holds)
            subject = f"{rule.full_name} is {str(holds).lower()}"
            yield CauseFunction(why_rule(layout, rule.index, holds), subject, emitter.body(plan))
    for behaviour in walk.behaviours(program):
        plan = plan_of_behaviour(program, behaviour)
        name = told(program, layout, behaviour.index).holds
        yield CauseFunction(name, f"{behaviour.name} holds", emitter.body(plan))
    for behaviour in telling_unknown(program):
        lines = emitter.unknown_body(plan_of_unknown(program, behaviour))
        name = told(program, layout, behaviour.index).unknown
        yield CauseFunction(name, f"{behaviour.name} is unknown", lines)


class _Emitter:
    def __init__(self, program: Program, layout: Layout) -> None:
        self._program = program
        self._layout = layout
        self._conditions = Conditions(program, layout)

    def body(self, plan: Plan) -> tuple[str, ...]:
        """Return the statements that return the causes of a plan that is known to hold."""
        lines = self._block(2, plan, known=True)
        return ("  runtime::Causes causes;", *lines, "  return causes;")

    def unknown_body(self, plan: NoValue) -> tuple[str, ...]:
        """Return the statements that return what is unknown."""
        lines = ["  runtime::Causes causes;"]
        for number, readings in enumerate(plan.tiers):
            lines += ["  if (causes.empty()) {"] if number else []
            for each in readings:
                arguments = ("causes", self._is_open(each), self._reading(each))
                indent = 4 if number else 2
                lines += _called("runtime::append_unknown", arguments, indent)
            lines += ["  }"] if number else []
        lines += ["  if (causes.empty()) {"]
        lines += _called("causes.push_back", (cpp_string(plan.otherwise),), 4)
        return (*lines, "  }", "  return causes;")

    def _is_open(self, each: Reading) -> str:
        if each.rule is None:
            return "true"
        return f"m.{self._layout.verdicts[each.rule]} == {self._layout.macro}_UNKNOWN"

    def _reading(self, each: Reading) -> Expression:
        if each.term is None:
            return Call("runtime::Reading", (cpp_string(each.name), "std::nullopt"))
        return self._read(each.term)

    # Statements, which append to the causes ---------------------------------------------------

    def _block(self, indent: int, plan: Plan, known: bool) -> Iterator[str]:
        """Yield the statements of a plan; ``known``: the plan is known to hold."""
        blank = " " * indent
        match plan:
            case Say() | SayRule() if known:
                yield from _called("causes.push_back", (self._cause(plan),), indent)
            case Say() | SayRule() | During() if not known:
                yield from _if(self._test(plan), indent)
                yield from self._block(indent + 2, plan, True)
                yield f"{blank}}}"
            case During():
                yield from self._block(indent, plan.part, plan.is_sure)
            case AllOf() if not known:
                yield from _called(
                    "runtime::append", ("causes", self._expression(plan, False)), indent
                )
            case AllOf() | AnyOf():
                for each in plan.parts:
                    yield from self._block(indent, each, isinstance(plan, AllOf))
            case OrUnknown():
                yield from self._block(indent, plan.part, False)
                yield f"{blank}if (causes.empty()) {{"
                unknown = Call("runtime::unknown_terms", tuple(map(self._read, plan.terms)))
                if plan.results:
                    results = Call("runtime::readings", tuple(map(self._result, plan.results)))
                    terms = Call("runtime::readings", unknown.arguments)
                    unknown = Call("runtime::unknown_terms_or", (terms, results))
                yield from _called("causes.push_back", (unknown,), indent + 2)
                yield f"{blank}}}"

    def _read(self, term: Term) -> Expression:
        return reading_of_sector(self._program, self._layout, term)

    def _result(self, each: Compute | Since) -> Expression:
        """Return what is computed with its value, or a ``since`` with the verdict it remembers."""
        if isinstance(each, Compute):
            return reading(self._program, self._layout, each)
        known = f"m.{self._layout.kept[each.index]} != {self._layout.macro}_UNKNOWN"
        value = f"runtime::value_of({known}, true)"
        return Call("runtime::Reading", (cpp_string(since_text(each)), value))

    # Expressions ----------------------------------

    def _expression(self, plan: Plan, known: bool) -> Expression:
        match plan:
            case Say() | SayRule():
                test = "true" if known else _text(self._test(plan))
                return Call("runtime::cause_if", (test, self._cause(plan)))
            case During():
                part = self._expression(plan.part, plan.is_sure)
                test = _text(self._test(plan))
                return part if known else Call("runtime::causes_if", (test, part))
            case AllOf() | AnyOf():
                sure = known and isinstance(plan, AllOf)
                head = "runtime::all_causes" if isinstance(plan, AllOf) else "runtime::any_causes"
                return Call(head, tuple(self._expression(each, sure) for each in plan.parts))
            case OrUnknown():
                raise AssertionError("failsafe is a whole rule, and no part of one")

    def _test(self, plan: Say | SayRule | During) -> Logic:
        macro = self._layout.macro
        match plan:
            case Say():
                return self._is(plan.condition, plan.holds)
            case SayRule():
                verdict = f"m.{self._layout.verdicts[plan.rule]}"
                return Atom(f"{verdict} == {macro}_{str(plan.holds).upper()}")
            case During(interval=For() as interval):
                return self._lasts(interval, plan.reached)
            case During():
                return self._is(plan.interval, plan.reached)

    def _cause(self, part: Say | SayRule) -> Expression:
        if isinstance(part, SayRule):
            why = why_rule(self._layout, part.rule, part.holds)
            return Call("runtime::rule_cause", (self._text(part.head), f"{why}(m)"))
        return self._text(part.pieces)

    def _text(self, pieces: tuple[Piece, ...]) -> Expression:
        return Chain("", tuple(map(self._piece, pieces)), " + ")

    def _piece(self, piece: Piece) -> str:
        if isinstance(piece, str):
            return cpp_string(piece)
        if isinstance(piece, Beams):
            return next(beams_texts(self._layout, [piece]))
        if not isinstance(piece, Lasting):
            return shown_text(self._program, self._layout, piece)
        time = f"m.now - m.{self._layout.since[piece.interval.index]}"
        if piece.remains:
            time = f"{integer(piece.interval.duration_ns)} - ({time})"
        return f"runtime::to_text(runtime::seconds({time}))"

    # Conditions, as tests whether they are true or false -------------------------------------

    def _lasts(self, interval: For, reached: bool) -> Logic:
        """Return whether an interval has begun, and has lasted long enough or has not."""
        since = f"m.{self._layout.since[interval.index]}"
        relation = ">=" if reached else "<"
        lasted = f"m.now - {since} {relation} {integer(interval.duration_ns)}"
        return all_of((Atom(f"{since} != {self._layout.macro}_UNSET"), Atom(lasted)))

    def _is(self, condition: Condition, holds: bool) -> Logic:
        match condition:
            case Not():
                return self._is(condition.operand, not holds)
            case And() | Or():
                join = all_of if isinstance(condition, And) is holds else any_of
                return join([self._is(each, holds) for each in condition.operands])
            case For() if not condition.duration_ns:
                return self._is(condition.operand, holds)
            case For():
                lasts = self._lasts(condition, holds)
                return lasts if holds else any_of((lasts, self._is(condition.operand, False)))
            case Begins(operand=interval):
                lasts = self._lasts(interval, not holds)
                return lasts if holds else any_of((lasts, self._is(interval.operand, False)))
            case Since():
                verdict = f"{self._layout.macro}_{str(holds).upper()}"
                kept = Atom(f"m.{self._layout.kept[condition.index]} == {verdict}")
                return kept if holds else all_of((kept, self._is(condition.cause, False)))
            case Once() if not condition.duration_ns:
                return self._is(condition.operand, holds)
            case Truth(operand=Const() as fixed):
                return Atom(str(bool(fixed.value) is holds).lower())
            case Truth() | Compare() | Within():
                return self._compares(condition, holds)
            case Missing():
                missing = Atom(f"m.{self._layout.inputs[condition.input].missing}")
                return missing if holds else NoneOf(missing)
            case Unknown():
                fields, known = (
                    self._layout.inputs[condition.input],
                    known_of(self._layout, condition),
                )
                come = any_of((Atom(f"m.{fields.came}"), Atom(f"m.{fields.missing}")))
                unknown = all_of((come, NoneOf(Atom(f"m.{known}"))))
                return unknown if holds else NoneOf(unknown)
            case Age():
                fields = self._layout.inputs[condition.input]
                operator = condition.operator if holds else OPPOSITE[condition.operator]
                bound = f"{SYMBOLS[operator]} {integer(condition.bound_ns)}"
                return all_of((Atom(f"m.{fields.came}"), Atom(f"m.now - m.{fields.base} {bound}")))
            case Frequency():
                first = self._layout.inputs[condition.input].stamps[condition.messages - 1]
                operator = ">=" if holds else "<"
                bound = f"{operator} {integer(condition.elapsed_ns)}"
                return Atom(f"m.now - m.{first} {bound}")
            case Once():
                recent = Atom(f"m.now < m.{self._layout.until[condition.index]}")
                over = NoneOf(recent)
                return recent if holds else all_of((over, self._is(condition.operand, False)))
            case Times():
                turns = self._layout.turns[condition.index]
                counted = Atom(f"m.now < m.{turns.ends[-1]}")
                is_known = any_of((Atom(f"m.{turns.held}"), self._is(condition.operand, False)))
                return counted if holds else all_of((NoneOf(counted), is_known))
            case Active():
                active = Atom(f"m.{self._layout.active[condition.action]}")
                return active if holds else NoneOf(active)
            case RuleRef():
                verdict = f"m.{self._layout.verdicts[condition.rule]}"
                return Atom(f"{verdict} == {self._layout.macro}_{str(holds).upper()}")
            case _:
                raise AssertionError("no condition of a single cause")

    def _compares(self, condition: Truth | Compare | Within, holds: bool) -> Logic:
        terms = [self._layout.terms[value] for value in compared(condition)]
        finding = self._layout.findings.get(condition)
        held = f"m->{finding.name}" if finding else flat(self._conditions.holds(condition))
        result = Atom(held.replace("m->", "m."))
        known = [Atom(f"m.{each.known}") for each in terms if each.known]
        return all_of((*known, result if holds else NoneOf(result)))


def _called(function: str, arguments: tuple[Expression, ...], indent: int) -> Iterator[str]:
    yield from expression_lines(Call(function, arguments), indent, ";")


def _if(asked: Logic, indent: int) -> list[str]:
    """Return the lines that open a block with a condition."""
    if isinstance(asked, logic.AllOf | logic.AnyOf):
        return lay_out_if(_joint(asked), [_inner(each) for each in asked.operands], indent)
    return lay_out_if("", [_text(asked)], indent)


def _joint(asked: logic.AllOf | logic.AnyOf) -> str:
    return " && " if isinstance(asked, logic.AllOf) else " || "


def _text(asked: Logic) -> str:
    match asked:
        case Atom():
            return asked.text
        case NoneOf():
            simple = isinstance(asked.operand, Atom) and " " not in asked.operand.text
            inner = _text(asked.operand)
            return f"!{inner}" if simple else f"!({inner})"
        case logic.AllOf() | logic.AnyOf():
            return _joint(asked).join(map(_inner, asked.operands))


def _inner(asked: Logic) -> str:
    """Return an operand, in parentheses if it has operators of its own."""
    text = _text(asked)
    plain = isinstance(asked, NoneOf) or (isinstance(asked, Atom) and " " not in asked.text)
    return text if plain else f"({text})"
