"""The causes of a condition that is true or false: its decisive parts, each with its values.

So are those of one that is on its way, and of one that is unknown. What they are is planned without
any values (:mod:`deros.rules.engine.cause_plans`); here the plans are carried out.
"""

from __future__ import annotations

from deros.interfaces.durations import NS_PER_S
from deros.rules.compiler.wordings import constant
from deros.rules.engine.cause_plans import (
    AllOf,
    AnyOf,
    During,
    OrUnknown,
    Plan,
    Reading,
    Say,
    SayRule,
    plan_of_behaviour,
    plan_of_rule,
    plan_of_unknown,
    since_text,
)
from deros.rules.engine.cause_texts import Beams, Lasting, Piece, beams_of, beams_text
from deros.rules.engine.evaluate import evaluate_condition, evaluate_value, remembered, term_value
from deros.rules.engine.state import State
from deros.rules.functions.reads import Term, term_name
from deros.rules.program.ir import Behaviour, For, Program, Since
from deros.rules.program.operators import NEVER


def causes_of_rule(
    program: Program, index: int, holds: bool, state: State, t_ns: int
) -> tuple[str, ...]:
    """Return why a rule is true, or false, as of its last evaluation."""
    return tuple(_tell(program, plan_of_rule(program, index, holds), state, t_ns))


def causes_of_behaviour(
    program: Program, behaviour: Behaviour, state: State, t_ns: int
) -> tuple[str, ...]:
    """Return why the conditions of a behaviour and of all around it are true."""
    return tuple(_tell(program, plan_of_behaviour(program, behaviour), state, t_ns))


def causes_against_behaviour(
    program: Program, behaviour: Behaviour, state: State, t_ns: int
) -> tuple[str, ...]:
    """Return why a behaviour does not hold: what is false, or else what is unknown."""
    found = _tell(program, plan_of_behaviour(program, behaviour, holds=False), state, t_ns)
    return tuple(found) or unknown_of_behaviour(program, behaviour, state, t_ns)


def unknown_of_behaviour(
    program: Program, behaviour: Behaviour, state: State, t_ns: int
) -> tuple[str, ...]:
    """Return what is unknown, while the condition of a behaviour, or of one around it, is."""

    def is_open(each: Reading) -> bool:
        if each.rule is not None and state.verdicts[each.rule] is not None:
            return False
        return each.term is None or term_value(program, each.term, state, t_ns) is None

    plan = plan_of_unknown(program, behaviour)
    for tier in plan.tiers:
        names = dict.fromkeys(
            each.name + _beams(program, each.term, state) for each in tier if is_open(each)
        )
        if names:
            return tuple(f"{name} is unknown" for name in names)
    return (plan.otherwise,)


def _tell(program: Program, plan: Plan, state: State, t_ns: int) -> list[str]:
    # To evaluate once more what this event has evaluated changes no interval.
    match plan:
        case Say():
            if evaluate_condition(plan.condition, state, t_ns) is not plan.holds:
                return []
            return ["".join(_shown(program, each, state, t_ns) for each in plan.pieces)]
        case SayRule():
            if state.verdicts[plan.rule] is not plan.holds:
                return []
            head = "".join(_shown(program, each, state, t_ns) for each in plan.head)
            causes = causes_of_rule(program, plan.rule, plan.holds, state, t_ns)
            return [head + "; ".join(causes)]
        case AllOf() | AnyOf():
            told = [_tell(program, each, state, t_ns) for each in plan.parts]
            is_so = all(told) or isinstance(plan, AnyOf)
            return [cause for each in told for cause in each] if is_so else []
        case During():
            verdict = evaluate_condition(plan.interval, state, t_ns)
            if not isinstance(plan.interval, For):
                return _tell(program, plan.part, state, t_ns) if verdict is plan.reached else []
            has_lasted = verdict is True
            is_short = not has_lasted and remembered(plan.interval, state) != NEVER
            is_so = has_lasted if plan.reached else is_short
            return _tell(program, plan.part, state, t_ns) if is_so else []
        case OrUnknown():
            found = _tell(program, plan.part, state, t_ns)
            return found or [f"unknown: {', '.join(_unknown(program, plan, state))}"]


def _unknown(program: Program, plan: OrUnknown, state: State) -> list[str]:
    terms = (each for each in plan.terms if term_value(program, each, state, 0) is None)
    names = [term_name(program, each) + _beams(program, each, state) for each in terms]
    if names:
        return names
    for each in plan.results:
        if isinstance(each, Since):
            names += [since_text(each)] if remembered(each, state) is None else []
        elif term_value(program, each, state, 0) is None:
            names.append(term_name(program, each))
    return names


def _beams(program: Program, term: Term | None, state: State) -> str:
    """Return how many beams are blind of the sector that a term looks into, if it does."""
    found = beams_of(term) if term is not None else ()
    return "".join(_shown(program, each, state, 0) for each in found)


def _shown(program: Program, piece: Piece, state: State, t_ns: int) -> str:
    if isinstance(piece, str):
        return piece
    if isinstance(piece, Lasting):
        due = state.remembered[piece.interval.index]
        assert isinstance(due, int)
        remaining = due - t_ns
        lasted = piece.interval.duration_ns - remaining
        return str((remaining if piece.remains else lasted) / NS_PER_S)
    if isinstance(piece, Beams):
        return beams_text(evaluate_value(piece.share, state))
    value = term_value(program, piece, state, t_ns)
    assert value is not None, "what makes a condition true or false has a value"
    return constant(value)
