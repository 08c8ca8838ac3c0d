"""The functions that tell why a rule is true, or false, and why a behaviour holds, in C++."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from deros.generators.cpp_source import Call, Chain, Expression, cpp_string, layout
from deros.generators.monitor_c.expressions import SYMBOLS, Conditions, integer, known_of
from deros.generators.monitor_c.layout import Layout, compared
from deros.generators.monitor_c.source import flat, lay_out_if
from deros.generators.monitor_python.logic import (
    AllOf,
    AnyOf,
    Atom,
    Logic,
    NoneOf,
    all_of,
    any_of,
)
from deros.generators.safety_cpp.explained import reading, shown_text
from deros.monitor import walk
from deros.monitor.causes import (
    OPPOSITE,
    Plan,
    Say,
    SayRule,
    SayUnknown,
    When,
    negated_rules,
    plan_of,
    plan_of_behaviour,
)
from deros.monitor.ir import (
    Age,
    And,
    Compare,
    Condition,
    Const,
    Failsafe,
    For,
    Missing,
    Not,
    Or,
    Program,
    RuleRef,
    Truth,
    Unknown,
    Within,
)


@dataclass(frozen=True, slots=True)
class Why:
    """A function that tells why something is as it is.

    Attributes:
        function: its name.
        subject: what it tells the causes of.
        lines: of its body.
    """

    function: str
    subject: str
    lines: tuple[str, ...]

    @property
    def reads(self) -> bool:
        """Whether it looks at the monitor at all."""
        return any("m." in line or "(m)" in line for line in self.lines)


def why_rule(layout: Layout, rule: int, holds: bool = True) -> str:
    """Return the function that tells why a rule is true, or false."""
    return f"why_{str(holds).lower()}_{layout.verdicts[rule]}"


def why_behaviour(layout: Layout, behaviour: int) -> str:
    """Return the function that tells why a behaviour holds."""
    return f"why_holds_{layout.conditions[behaviour]}"


def whys(program: Program, layout: Layout) -> Iterator[Why]:
    """Yield the functions of all rules, then of all behaviours; the monitor's struct is ``m``."""
    emitter = _Emitter(program, layout)
    negated = negated_rules(program)
    for rule in program.rules:
        for holds in (True, False) if rule.index in negated else (True,):
            plan = plan_of(program, rule.condition, holds)
            subject = f"{rule.full_name} is {str(holds).lower()}"
            yield Why(why_rule(layout, rule.index, holds), subject, emitter.body(plan))
    for behaviour in walk.behaviours(program):
        plan = plan_of_behaviour(program, behaviour)
        name = why_behaviour(layout, behaviour.index)
        yield Why(name, f"{behaviour.name} holds", emitter.body(plan))


class _Emitter:
    def __init__(self, program: Program, layout: Layout) -> None:
        self._program = program
        self._layout = layout
        self._conditions = Conditions(program, layout)

    def body(self, plan: Plan) -> tuple[str, ...]:
        return ("  runtime::Causes found;", *self._block(2, plan), "  return found;")

    def _block(self, indent: int, plan: Plan) -> Iterator[str]:
        blank = " " * indent
        for part in plan:
            if not isinstance(part, When):
                first, *rest = layout(Call("found.push_back", (self._cause(part),)), indent, ";")
                yield from (blank + first, *rest)
                continue
            yield from _if(self._is(part.condition, part.holds), indent)
            yield from self._block(indent + 2, part.then)
            if part.otherwise:
                yield f"{blank}}} else {{"
                yield from self._block(indent + 2, part.otherwise)
            yield f"{blank}}}"

    def _cause(self, part: Say | SayUnknown | SayRule | When) -> Expression:
        match part:
            case Say():
                pieces = (
                    cpp_string(each) if isinstance(each, str) else shown_text(self._layout, each)
                    for each in part.pieces
                )
                return Chain("", tuple(pieces), " + ")
            case SayUnknown():
                reads = (reading(self._program, self._layout, each) for each in part.terms)
                return Call("runtime::unknown_of", (cpp_string(part.suffix), *reads))
            case SayRule():
                why = why_rule(self._layout, part.rule, part.holds)
                return Call("runtime::because", (cpp_string(part.head), f"{why}(m)"))
            case When():
                raise AssertionError("a condition is no cause")

    # Conditions, as questions whether they are true, or false -------------------------------------

    def _is(self, condition: Condition, holds: bool) -> Logic:
        match condition:
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
            case Not():
                return self._is(condition.operand, not holds)
            case And() | Or():
                join = all_of if isinstance(condition, And) is holds else any_of
                return join(self._is(each, holds) for each in condition.operands)
            case For():
                return self._lasts(condition, holds)
            case RuleRef():
                verdict = f"m.{self._layout.verdicts[condition.rule]}"
                return Atom(f"{verdict} == {self._layout.macro}_{str(holds).upper()}")
            case Failsafe():
                raise AssertionError("failsafe is a whole rule, and no part of one")

    def _compares(self, condition: Truth | Compare | Within, holds: bool) -> Logic:
        terms = [self._layout.terms[value] for value in compared(condition)]
        finding = self._layout.findings.get(condition)
        held = f"m->{finding.name}" if finding else flat(self._conditions.holds(condition))
        result = Atom(held.replace("m->", "m."))
        known = [Atom(f"m.{each.known}") for each in terms]
        return all_of((*known, result if holds else NoneOf(result)))

    def _lasts(self, condition: For, holds: bool) -> Logic:
        since = self._layout.since.get(condition.index)
        if since is None:
            return self._is(condition.operand, holds)
        # While its operand is true, an interval has begun.
        lasted = f"m.now - m.{since} {'>=' if holds else '<'} {integer(condition.duration_ns)}"
        whole = all_of((self._is(condition.operand, True), Atom(lasted)))
        return whole if holds else any_of((self._is(condition.operand, False), whole))


def _if(logic: Logic, indent: int) -> list[str]:
    """Return the line or lines that open a block where something holds."""
    if isinstance(logic, AllOf | AnyOf):
        joint = " && " if isinstance(logic, AllOf) else " || "
        return lay_out_if(joint, [_inner(each) for each in logic.operands], indent)
    return lay_out_if("", [_text(logic)], indent)


def _text(logic: Logic) -> str:
    match logic:
        case Atom():
            return logic.text
        case NoneOf():
            simple = isinstance(logic.operand, Atom) and " " not in logic.operand.text
            inner = _text(logic.operand)
            return f"!{inner}" if simple else f"!({inner})"
        case AllOf() | AnyOf():
            joint = " && " if isinstance(logic, AllOf) else " || "
            return joint.join(map(_inner, logic.operands))


def _inner(logic: Logic) -> str:
    """Return an operand, in parentheses if it has operators of its own."""
    text = _text(logic)
    plain = isinstance(logic, NoneOf) or (isinstance(logic, Atom) and " " not in logic.text)
    return text if plain else f"({text})"
