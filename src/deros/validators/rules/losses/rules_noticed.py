"""What behaviours notice of values that are lost: by asking for them, or by being failsafe.

A loss is noticed if, wherever the value may decide what a behaviour does, some behaviour is surely
true without it: by Kleene's logic, with the value unknown, ``missing()`` and ``unknown()`` of it
true, what else stands under the same ``and`` as the value (or around its behaviour) true as well,
and all other conditions anything. So ``armed and (near or lost)`` notices the loss, ``armed and
lost`` does where ``near`` stands under ``armed``, and ``lost and other_lost`` does not. A behaviour
that acts needs one that acts: to log a loss does not answer it. What only releases is safe while it
is unknown; there it is enough that the loss is asked for anywhere.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from deros.models import rules
from deros.rules.program import ir, walk
from deros.validators.rules.losses.rules_losses import (
    TRUE,
    Assumed,
    Evaluation,
    Key,
    Loss,
    Verdicts,
    consequences,
    inputs_by_rule,
    inputs_of,
    key_of_input,
    keys_read,
    loss_of,
    negated,
)
from deros.validators.rules.losses.rules_places import Branch, Effect, Place, branches_of, places_of

_SPLITS = 6
"""Conditions that are tried as true and as false, where behaviours only together notice a loss."""

Answer = Literal["none", "conditional", "logged", "noticed"]
"""What answers a loss: nothing, a behaviour on other conditions, the log, or a behaviour."""

_RANKS: tuple[Answer, ...] = ("none", "conditional", "logged", "noticed")


@dataclass(frozen=True, slots=True)
class Used:
    """The rules that behaviours depend on, by themselves or by other rules.

    Attributes:
        rules: of any behaviour.
        exposed: the indices of those that a behaviour can see while they are unknown: not only
            through failsafe rules.
    """

    rules: list[ir.Rule]
    exposed: frozenset[int]


def used_rules(written: rules.Rules, program: ir.Program) -> Used:
    """Return the rules that behaviours depend on."""
    used = {rule for each in walk.behaviours(program) for rule in walk.rules_in(each.condition)}
    exposed = set(used)
    # A behaviour that could not be read may depend on what it mentions.
    lost = {each.index for each in program.rules if written.source.mentions_lost(each.full_name)}
    used |= lost
    for rule in reversed(program.rules):  # a rule comes after those that it names
        named = set(walk.rules_in(rule.condition))
        used |= named if rule.index in used else set()
        is_failsafe = isinstance(rule.condition, ir.Failsafe)
        exposed |= named if rule.index in exposed and not is_failsafe else set()
    rules_used = [program.rules[each] for each in sorted(used)]
    return Used(rules_used, frozenset(exposed))


class Noticed:
    """What behaviours notice.

    Attributes:
        used: the rules that they depend on.
        nan: the inputs that can be NaN.
        places: where values count for behaviours.
    """

    def __init__(self, written: rules.Rules, program: ir.Program) -> None:
        self.used = used_rules(written, program)
        self.nan = frozenset(leaf.input for leaf in program.leaves if leaf.can_be_nan)
        self._program = program
        self._inputs = inputs_by_rule(program)
        self._branches = branches_of(written, program)
        self.places = places_of(program, self._branches)
        self._by_key: dict[Key, list[Place]] = {}
        for place in self.places:
            for key in keys_read(place.leaf, program.leaves):
                self._by_key.setdefault(key, []).append(place)
        self._losses: dict[Key, tuple[Loss, list[Branch]]] = {}
        self._touched: dict[tuple[Assumed, Key], bool] = {}
        self._anyway: dict[tuple[Key, Effect, bool, bool], bool] = {}

    def answer_to(self, key: Key, rule: int | None = None, *, at_once: bool = False) -> Answer:
        """Return what answers a loss wherever a rule reads the value, or any rule: the least.

        Args:
            key: what is lost.
            rule: the index of the rule.
            at_once: whether what asks for the loss must not wait with a ``for``.
        """
        places = [each for each in self._by_key.get(key, ()) if rule is None or each.rule == rule]
        if not places:
            return "noticed" if self._is_asked(loss_of(key, self._program)) else "none"
        found = (self.answer_at(each, key, at_once=at_once) for each in places)
        return min(found, key=_RANKS.index)

    def answer_to_unknown(self, index: int, rule: int, *, at_once: bool = False) -> Answer:
        """Return what answers, wherever a rule reads it, that an input is NaN, or else silent."""
        kind = "input" if index in self.nan else "silence"
        return self.answer_to(key_of_input(kind, index), rule, at_once=at_once)

    def answer_at(self, place: Place, key: Key, *, at_once: bool) -> Answer:
        """Return what answers a loss where the value counts in one place."""
        context = place.context
        loss, asking = self._loss(key)
        if context.effect is Effect.RELEASES:
            return "noticed" if self._is_asked(loss) else "none"
        asking = [each for each in asking if each.firm or not context.firm]
        acting = [each for each in asking if each.effect >= context.effect]
        if not asking:
            return "none"
        given = _Given(loss, self._inputs, frozenset(), frozenset(), at_once)
        alike = (key, context.effect, context.firm, at_once)
        if alike not in self._anyway:
            self._anyway[alike] = given.makes_true(acting, splits=0)
        if self._anyway[alike]:
            return "noticed"
        free = frozenset(each for each in context.assumed if not self._is_touched(each, loss))
        given = replace(given, assumed=free, lasting=context.lasting)
        if given.makes_true(acting):
            return "noticed"
        logging = [each for each in asking if each.effect is Effect.LOGS]
        if logging and given.makes_true([*acting, *logging]):
            return "logged"
        return "conditional" if given.may_make_true(acting) else "none"

    def _loss(self, key: Key) -> tuple[Loss, list[Branch]]:
        """Return what is lost with a key, and the branches that ask for it, or are failsafe."""
        if key not in self._losses:
            loss = loss_of(key, self._program)
            near = (each for each in self._branches if not each.notices.isdisjoint(loss.touched))
            asking = [each for each in near if self._asks(each, loss)]
            self._losses[key] = loss, asking
        return self._losses[key]

    def _asks(self, branch: Branch, loss: Loss) -> bool:
        named = (each for each in branch.named if not self._inputs[each].isdisjoint(loss.touched))
        return _asks(
            [branch.condition, *(self._program.rules[each].condition for each in named)], loss
        )

    def _is_touched(self, assumed: Assumed, loss: Loss) -> bool:
        key = (assumed, loss.key)
        if key not in self._touched:
            self._touched[key] = _is_touched(assumed, loss)
        return self._touched[key]

    def _is_asked(self, loss: Loss) -> bool:
        return _asks([each.condition for each in self.used.rules], loss)


def noticed_of(written: rules.Rules, program: ir.Program) -> Noticed:
    """Return what the behaviours of a program notice."""
    return Noticed(written, program)


@dataclass(frozen=True, slots=True)
class _Given:
    """What is so while a value is lost; see :class:`Evaluation`."""

    loss: Loss
    inputs: Sequence[frozenset[int]]
    assumed: frozenset[Assumed]
    lasting: frozenset[int]
    at_once: bool

    def may_make_true(self, branches: list[Branch]) -> bool:
        """Return whether one of some branches can be true."""
        return any(each.true for each in self._verdicts(branches, self._evaluation()))

    def _evaluation(self) -> Evaluation:
        return Evaluation(self.loss, self.inputs, self.assumed, self.lasting, at_once=self.at_once)

    def _verdicts(self, branches: list[Branch], evaluation: Evaluation) -> list[Verdicts]:
        return [evaluation.of(each.condition, each.named) for each in branches]

    def makes_true(self, branches: list[Branch], splits: int = _SPLITS) -> bool:
        """Return whether one of some branches is surely true, whatever else is."""
        evaluation = self._evaluation()
        verdicts = self._verdicts(branches, evaluation)
        if TRUE in verdicts:
            return True
        open_ = [each for each, found in zip(branches, verdicts, strict=True) if found.true]
        leaf = self._undecided(open_, evaluation) if splits else None
        if leaf is None:
            return False
        rules_ = self.loss.program.rules
        return all(
            replace(self, assumed=self.assumed | consequences(each, rules_)).makes_true(
                open_, splits - 1
            )
            for each in (leaf, negated(leaf))
        )

    def _undecided(self, branches: list[Branch], evaluation: Evaluation) -> ir.Condition | None:
        """Return a condition without operands that stands beside a question for the loss."""
        rules_ = self.loss.program.rules
        seen: set[int] = set()
        open_ = [each.condition for each in reversed(branches)]
        while open_:
            condition = open_.pop()
            if isinstance(condition, ir.RuleRef):
                if condition.rule not in seen:
                    seen.add(condition.rule)
                    open_.append(rules_[condition.rule].condition)
                continue
            found = evaluation.of(condition, ())
            if not (found.true and found.false):
                continue
            operands = walk.operands(condition)
            touched = [each for each in operands if not self._is_free(each)]
            free = [each for each in operands if self._is_free(each)]
            if not operands and self._is_free(condition):
                return condition
            if isinstance(condition, ir.And):
                open_ += [*touched, *reversed(free)]
            else:
                open_ += touched or free
        return None

    def _is_free(self, condition: ir.Condition) -> bool:
        """Return whether a condition has nothing to do with the inputs that are lost."""
        return inputs_of(condition, self.inputs, self.loss.program).isdisjoint(self.loss.touched)


def _is_touched(assumed: Assumed, loss: Loss) -> bool:
    """Return whether a loss may change what is assumed."""
    if isinstance(assumed, tuple):
        kind, condition = assumed
        return kind == "over" and _is_touched(condition, loss)
    wholes = walk.with_named(assumed, loss.program.rules)
    parts = (part for each in wholes for part in walk.parts(each) if not walk.operands(part))
    return any(loss.verdicts(each) is not None for each in parts)


def _asks(wholes: Iterable[ir.Condition], loss: Loss) -> bool:
    """Return whether conditions ask for a loss, or are failsafe and read the value."""
    for whole in wholes:
        leaves = (part for part in walk.parts(whole) if not walk.operands(part))
        if any(loss.verdicts(each) == TRUE for each in leaves):
            return True
        if isinstance(whole, ir.Failsafe) and _is_touched(whole, loss):
            return True
    return False
