"""What is on its way: the conditions that refuse a reset, with each ``for`` as over at once.

A reset is refused by a condition that triggers the action, and already when it is on its way: when
it would be true if no ``for`` that stands for it (under an even number of ``not``) had to last. So
each such condition has an *early* one, a behaviour without a body, and each rule in it that it
takes part of an early rule. They are evaluated as all others are, with memories of their own.

Source: docs, "What a rule means", on resets.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import count

from deros.rules.program import walk
from deros.rules.program.ir import (
    And,
    Begins,
    Behaviour,
    Condition,
    Failsafe,
    For,
    Not,
    Once,
    Or,
    Program,
    RuleRef,
    Since,
    Temporal,
    Times,
)


def with_early(program: Program) -> Program:
    """Return a program that has the early rules and behaviours too, after all that are written.

    Rules and behaviours as written keep their numbers. Without a ``for`` that counts, the program
    is returned as it is.
    """
    return _Early(program).program()


def early_ones(program: Program) -> dict[int, int]:
    """Return the early behaviour of each one that has one, by index."""
    everyone = walk.behaviours(program)
    return {each.early_of: each.index for each in everyone if each.early_of is not None}


def refusing(
    behaviours: Iterable[int], early: Mapping[int, int], holds: Sequence[bool | None]
) -> tuple[tuple[int, ...], tuple[int, ...], tuple[int, ...]]:
    """Return which behaviours refuse a reset: they hold, are unknown, or are on their way.

    Args:
        behaviours: those that trigger the action, by index.
        early: the early behaviour of each one that has one.
        holds: what the condition of each is worth, those of the early ones among them.
    """
    found: dict[str, list[int]] = {"holding": [], "unknown": [], "coming": []}
    for index in behaviours:
        verdicts = (holds[index], holds[early.get(index, index)])
        if verdicts[0] is True:
            found["holding"].append(index)
        elif None in verdicts:
            found["unknown"].append(index)
        elif verdicts[1] is True:
            found["coming"].append(index)
    return tuple(found["holding"]), tuple(found["unknown"]), tuple(found["coming"])


def triggering_resettable(program: Program) -> list[int]:
    """Return the behaviours, by index, that trigger an action that can be reset."""
    found = (
        index
        for action in program.actions
        if action.latched or action.reset_by is not None
        for index in action.triggered_by
    )
    return sorted(set(found))


class _Early:
    """Adds what is early to one program."""

    def __init__(self, written: Program) -> None:
        self._written = written
        self._waits: dict[tuple[int, bool], bool] = {}
        for rule in written.rules:  # a rule comes after those that it names
            for stands in (True, False):
                self._waits[rule.index, stands] = self._has_wait(rule.condition, stands)
        parts = list(walk.conditions(written))
        self._memories = _after(each.index for each in parts if isinstance(each, Temporal))
        self._numbers: dict[tuple[int, bool], int] = {}

    def program(self) -> Program:
        """Return the program with what is early."""
        written = self._written
        everyone = {each.index: each for each in walk.behaviours(written)}
        every = {index: chain_of(everyone, index) for index in triggering_resettable(written)}
        chains = {
            index: chain
            for index, chain in every.items()
            if any(self._has_wait(each.condition, True) for each in chain)
        }
        if not chains:
            return written
        needed = self._needed(each.condition for chain in chains.values() for each in chain)
        self._numbers = {key: number for number, key in enumerate(needed, len(written.rules))}
        rules = tuple(
            replace(
                written.rules[index],
                index=number,
                name=f"{written.rules[index].name}_early",
                condition=self._early(written.rules[index].condition, stands),
                early_of=index,
            )
            for (index, stands), number in self._numbers.items()
        )
        behaviours = tuple(
            self._behaviour(len(everyone) + place, everyone[index], chain)
            for place, (index, chain) in enumerate(chains.items())
        )
        early_of = {each.early_of: each.index for each in behaviours}
        actions = tuple(
            replace(each, triggered_by=(*each.triggered_by, *refusing))
            if each.latched or each.reset_by is not None
            else each
            for each in written.actions
            for refusing in [[early_of[n] for n in each.triggered_by if n in early_of]]
        )
        return replace(
            written,
            rules=(*written.rules, *rules),
            behaviours=(*written.behaviours, *behaviours),
            actions=actions,
        )

    def _behaviour(self, index: int, of: Behaviour, chain: Sequence[Behaviour]) -> Behaviour:
        """Return the early behaviour of one that is written, with all around it in a condition."""
        conditions = tuple(self._early(each.condition, True) for each in chain)
        return Behaviour(
            index,
            f"{of.name}_early",
            conditions[0] if len(conditions) == 1 else And(conditions),
            (),
            None,
            of.span,
            switched_by=tuple(each.index for each in chain if each.optional),
            early_of=of.index,
        )

    # Which rules are needed ---------------------------------------------------------------------

    def _has_wait(self, condition: Condition, stands: bool) -> bool:
        """Return whether a ``for`` stands for a condition, or for its opposite."""
        match condition:
            case For(operand=operand, duration_ns=duration_ns):
                return (stands and duration_ns > 0) or self._has_wait(operand, stands)
            case Begins():
                return self._has_wait(condition.operand.operand, stands)
            case Not():
                return self._has_wait(condition.operand, not stands)
            case Once() | Times() | Failsafe():
                return self._has_wait(condition.operand, stands)
            case And(operands=operands) | Or(operands=operands):
                return any(self._has_wait(each, stands) for each in operands)
            case Since(operand=operand, cause=cause):
                return self._has_wait(operand, stands) or self._has_wait(cause, stands)
            case RuleRef():
                return self._waits[condition.rule, stands]
            case _:
                return False

    def _needed(self, conditions: Iterator[Condition]) -> list[tuple[int, bool]]:
        """Return the rules that early conditions name, and whether each stands for it, in order."""
        found: set[tuple[int, bool]] = set()
        open_ = [key for each in conditions for key in _references(each, True)]
        while open_:
            key = index, stands = open_.pop()
            if self._waits[key] and key not in found:
                found.add(key)
                open_ += _references(self._written.rules[index].condition, stands)
        return sorted(found)

    # Early conditions ---------------------------------------------------------------------------

    def _early(self, condition: Condition, stands: bool) -> Condition:
        """Return a condition without the ``for`` that stand for it, with memories of its own."""
        match condition:
            case For() if stands:
                return self._early(condition.operand, stands)
            case For():
                operand = self._early(condition.operand, stands)
                return replace(condition, index=next(self._memories), operand=operand)
            case Begins(operand=lasting):
                operand = self._early(lasting.operand, stands)
                return Begins(replace(lasting, index=next(self._memories), operand=operand))
            case Once() | Times():
                operand = self._early(condition.operand, stands)
                return replace(condition, index=next(self._memories), operand=operand)
            case Since():
                operand = self._early(condition.operand, stands)
                cause = self._early(condition.cause, stands)
                return replace(condition, index=next(self._memories), operand=operand, cause=cause)
            case Not():
                return Not(self._early(condition.operand, not stands))
            case Failsafe():
                return replace(condition, operand=self._early(condition.operand, stands))
            case And(operands=operands) | Or(operands=operands):
                return replace(condition, operands=tuple(self._early(o, stands) for o in operands))
            case RuleRef():
                return RuleRef(self._numbers.get((condition.rule, stands), condition.rule))
            case _:
                return condition


def _after(numbers: Iterable[int]) -> Iterator[int]:
    """Return the numbers that are free after all that are taken."""
    return count(max(numbers, default=-1) + 1)


def chain_of(everyone: dict[int, Behaviour], index: int) -> tuple[Behaviour, ...]:
    """Return a behaviour after all that enclose it, the outermost first."""
    chain = [everyone[index]]
    while (parent := chain[0].parent) is not None:
        chain.insert(0, everyone[parent])
    return tuple(chain)


def _references(condition: Condition, stands: bool) -> Iterator[tuple[int, bool]]:
    """Yield the rules that a condition names, and whether each stands for it or its opposite."""
    match condition:
        case RuleRef():
            yield condition.rule, stands
        case Not():
            yield from _references(condition.operand, not stands)
        case For() | Once() | Times() | Begins() | Failsafe():
            yield from _references(condition.operand, stands)
        case And(operands=operands) | Or(operands=operands):
            for each in operands:
                yield from _references(each, stands)
        case Since(operand=operand, cause=cause):
            yield from _references(operand, stands)
            yield from _references(cause, stands)
        case _:
            pass
