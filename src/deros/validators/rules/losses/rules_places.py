"""Where behaviours read values, and under which other conditions."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from enum import IntEnum

from deros.models import rules
from deros.rules.program import ir, walk
from deros.validators.deciding import Deciding
from deros.validators.rules.losses.rules_losses import Assumed, consequences, negated

_MOST = 16
"""Contexts of one rule that are told apart; more are only made by nesting names many times."""

_MOST_BESIDE = 100
"""Operands that are judged beside one another. Of more, each is judged as if it stood alone: a loss
counts as noticed less often, and the work stays linear."""


class Effect(IntEnum):
    """What a behaviour does, from what concerns safety least."""

    RELEASES = 0
    LOGS = 1
    ACTS = 2


@dataclass(frozen=True, slots=True)
class Branch:
    """A behaviour with those around it: what all of them ask, and what it does.

    Attributes:
        condition: theirs together.
        named: the rules that it names, directly or not, in the order of evaluation.
        effect: of the actions in its own body.
        firm: whether it cannot be disabled.
        notices: the inputs whose loss may make it true by itself.
    """

    condition: ir.Condition
    named: tuple[int, ...]
    effect: Effect
    firm: bool
    notices: frozenset[int]


@dataclass(frozen=True, slots=True)
class Context:
    """Under what a condition counts for a branch.

    Attributes:
        effect: of the branch.
        firm: whether the branch cannot be disabled.
        assumed: what else is true where the condition decides.
        lasting: the ``for`` around it that it keeps running, by index.
        negated: whether it stands under an odd number of ``not``.
    """

    effect: Effect
    firm: bool
    assumed: frozenset[Assumed] = frozenset()
    lasting: frozenset[int] = frozenset()
    negated: bool = False


@dataclass(frozen=True, slots=True)
class Place:
    """A condition without operands that counts for a behaviour; ``rule`` is ``None`` in its own."""

    leaf: ir.Condition
    rule: int | None
    context: Context


def branches_of(written: rules.Rules, program: ir.Program) -> list[Branch]:
    """Return the behaviours that run anything, and rules that behaviours mention that are lost."""
    by_state = acted_on(program)
    optional: set[int] = set()
    around: dict[int, tuple[ir.Condition, ...]] = {}
    found: list[tuple[ir.Condition, Effect, bool]] = []
    for each in walk.behaviours(program):
        outer = () if each.parent is None else around[each.parent]
        around[each.index] = (*outer, each.condition)
        if each.optional or each.parent in optional:
            optional.add(each.index)
        effect = _effect(each, program, by_state)
        if effect is not None:
            chain = around[each.index]
            whole = chain[0] if len(chain) == 1 else ir.And(chain)
            found.append((whole, effect, each.index not in optional))
    lost = (rule for rule in program.rules if written.source.mentions_lost(rule.full_name))
    found += ((ir.RuleRef(rule.index), Effect.ACTS, True) for rule in lost)
    notices = _noticing(program)
    return [
        Branch(
            condition,
            tuple(walk.named_rules(condition, program.rules)),
            effect,
            firm,
            frozenset().union(
                *(notices[each.rule] for each in _refs(condition)), _asked(condition)
            ),
        )
        for condition, effect, firm in found
    ]


def places_of(program: ir.Program, branches: Iterable[Branch]) -> list[Place]:
    """Return where conditions without operands count for behaviours, each once per context."""
    contexts: dict[int, list[Context]] = {}
    found: dict[Place, None] = {}

    def add(condition: ir.Condition, rule: int | None, context: Context) -> None:
        for leaf, inner in _spread(condition, context, program.rules):
            if isinstance(leaf, ir.RuleRef):
                _add(contexts.setdefault(leaf.rule, []), inner)
            else:
                found[Place(leaf, rule, inner)] = None

    for branch in branches:
        add(branch.condition, None, Context(branch.effect, branch.firm))
    for each in reversed(program.rules):  # a rule comes after those that it names
        for context in contexts.get(each.index, ()):
            add(each.condition, each.index, context)
    return list(found)


def _effect(
    behaviour: ir.Behaviour, program: ir.Program, acted_on: Container[int]
) -> Effect | None:
    """Return what the actions in a behaviour's own body do; ``None`` if there are none.

    An action without a binding that resets another one releases; what a bound one does is more, and
    so is what is ``acted_on``.
    """
    run = [program.actions[each.action] for each in behaviour.body if isinstance(each, ir.Trigger)]
    resets = {each.reset_by for each in program.actions if each.reset_by != each.index}
    effects = [
        Effect.LOGS
        if each.name == "log_state"
        else Effect.RELEASES
        if each.index in resets and not each.is_bound and each.index not in acted_on
        else Effect.ACTS
        for each in run
    ]
    if Effect.ACTS not in effects and Effect.RELEASES in effects:
        return Effect.RELEASES
    return max(effects, default=None)


def acted_on(program: ir.Program) -> frozenset[int]:
    """Return the actions that make a behaviour act: one that is active, or that ends another."""
    rules_: list[frozenset[tuple[int, bool]]] = []
    for rule in program.rules:  # a rule comes after those that it names
        rules_.append(_states(rule.condition, rules_))
    deciding = Deciding(program)
    found: set[int] = set()
    open_ = [e for e in walk.behaviours(program) if _effect(e, program, found) is Effect.ACTS]
    while open_:
        for action, is_negated in _states(deciding.whole(open_.pop()), rules_):
            cause = program.actions[action].reset_by if is_negated else action
            if cause is not None and cause not in found:
                found.add(cause)
                open_ += deciding.triggers(cause)
    return frozenset(found)


def _states(
    condition: ir.Condition, rules_: Sequence[frozenset[tuple[int, bool]]]
) -> frozenset[tuple[int, bool]]:
    """Return the actions that a condition names, each with whether under an odd number of ``not``.

    What the ``rules_`` name is among them.
    """
    found: set[tuple[int, bool]] = set()
    open_ = [(condition, False)]
    while open_:
        part, is_negated = open_.pop()
        match part:
            case ir.Active(action=action):
                found.add((action, is_negated))
            case ir.RuleRef(rule=rule):
                found |= {(action, its != is_negated) for action, its in rules_[rule]}
            case ir.Not(operand=operand):
                open_.append((operand, not is_negated))
            case _:
                open_ += [(each, is_negated) for each in walk.operands(part)]
    return frozenset(found)


def _noticing(program: ir.Program) -> list[frozenset[int]]:
    """Return, by rule, the inputs whose loss may make it true: asked for, or behind failsafe."""
    found: list[frozenset[int]] = []
    read: list[frozenset[int]] = []
    for rule in program.rules:
        named = [each.rule for each in _refs(rule.condition)]
        own = walk.inputs_read(rule.condition, program.leaves)
        read.append(frozenset(own).union(*(read[each] for each in named)))
        asked = frozenset(_asked(rule.condition)).union(*(found[each] for each in named))
        found.append(asked | read[-1] if isinstance(rule.condition, ir.Failsafe) else asked)
    return found


def _refs(condition: ir.Condition) -> list[ir.RuleRef]:
    return [each for each in walk.parts(condition) if isinstance(each, ir.RuleRef)]


def _asked(condition: ir.Condition) -> set[int]:
    asking = ir.Missing | ir.Unknown | ir.Frequency
    asked = (each for each in walk.parts(condition) if isinstance(each, asking))
    return {each.input for each in asked}


def _spread(
    condition: ir.Condition, context: Context, all_rules: Sequence[ir.Rule]
) -> Iterator[tuple[ir.Condition, Context]]:
    """Yield the parts without operands, each with its own context."""
    match condition:
        case ir.Not(operand=operand):
            inner = replace(context, negated=not context.negated)
            yield from _spread(operand, inner, all_rules)
        case ir.And(operands=operands) | ir.Or(operands=operands):
            together = isinstance(condition, ir.And) != context.negated
            together = together and len(operands) <= _MOST_BESIDE
            for each in operands:
                others = [other for other in operands if other is not each] if together else []
                yield from _spread(each, _beside(context, others, all_rules), all_rules)
        case ir.For(operand=operand):
            inner = replace(context, lasting=context.lasting | {condition.index})
            yield from _spread(operand, inner, all_rules)
        case ir.Once(operand=operand) | ir.Times(operand=operand):  # they start no 'for' over
            yield from _spread(operand, replace(context, lasting=frozenset()), all_rules)
        case ir.Begins(operand=lasts):
            yield from _spread(lasts.operand, context, all_rules)
        case ir.Failsafe(operand=operand):
            yield from _spread(operand, context, all_rules)
        case ir.Since(operand=operand, cause=cause):
            over = context
            if context.negated:  # where it is still true, the cause does not matter
                over = replace(context, assumed=context.assumed | {("over", operand)})
            yield from _spread(cause, over, all_rules)
            inner = _beside(context, [cause] if context.negated else [], all_rules)
            inner = replace(inner, assumed=inner.assumed | {("before", cause)})
            yield from _spread(operand, inner, all_rules)
        case _:
            yield condition, context


def _beside(
    context: Context, others: Sequence[ir.Condition], all_rules: Sequence[ir.Rule]
) -> Context:
    """Return the context of a condition that decides only where others do not."""
    if not others:
        return context
    true = [negated(each) if context.negated else each for each in others]
    more = (consequences(each, all_rules) for each in true)
    return replace(context, assumed=context.assumed.union(*more))


def _add(contexts: list[Context], new: Context) -> None:
    """Add a context, unless one that assumes no more is there."""

    def covers(one: Context, other: Context) -> bool:
        return one.assumed <= other.assumed and replace(one, assumed=other.assumed) == other

    if any(covers(each, new) for each in contexts):
        return
    contexts[:] = [each for each in contexts if not covers(new, each)]
    contexts.append(new)
    alike = [each for each in contexts[:-1] if each.negated == new.negated]
    if len(contexts) > _MOST and alike:
        contexts[:] = [each for each in contexts if each is not new and each is not alike[-1]]
        contexts.append(_merged(alike[-1], new))


def _merged(one: Context, other: Context) -> Context:
    """Return a context that asks for as much as either."""
    return Context(
        max(one.effect, other.effect),
        one.firm or other.firm,
        one.assumed & other.assumed,
        one.lasting | other.lasting,
        one.negated,
    )
