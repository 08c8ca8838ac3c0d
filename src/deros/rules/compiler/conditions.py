"""Conditions of the rules, resolved into those of the monitor: and, or, not, for."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import count

from deros import codes
from deros.models import rules
from deros.rules.compiler.action_states import ActionStates
from deros.rules.compiler.comparisons import Comparisons
from deros.rules.compiler.scope.scope import Scope
from deros.rules.functions.reads import strip_comments
from deros.rules.program import ir, walk

_Leaf = rules.Comparison | rules.Membership | rules.Truth


class Conditions:
    """Builds conditions within a scope. ``None`` means that a fault has been reported."""

    def __init__(
        self,
        scope: Scope,
        comparisons: Comparisons,
        built: Mapping[int, ir.Rule],
        actions: ActionStates,
    ) -> None:
        """Build the operands of logical operators with ``comparisons``.

        Args:
            scope: of the rules.
            comparisons: builds what the operators connect.
            built: the rules built so far, by index.
            actions: resolves the names of actions.
        """
        self._scope = scope
        self._built = built
        self._comparisons = comparisons
        self._actions = actions
        self._memories = count()

    def of_rule(
        self,
        condition: rules.Condition,
        is_rule: Callable[[rules.NamePath], bool],
        verdict: Callable[[rules.NamePath], ir.RuleRef | None],
    ) -> ir.Condition | None:
        """Return the condition of an entity's rule.

        Args:
            condition: as written.
            is_rule: returns whether a name that stands alone is that of a rule.
            verdict: resolves such a name.
        """

        def leaf(each: _Leaf) -> ir.Condition | None:
            match each:
                case rules.Truth(operand=rules.NamePath(path=()) as name) if is_rule(name):
                    return verdict(name)
                case rules.Truth(operand=term) if (asked := self._actions.asked(term)) is not None:
                    return self._actions.condition(asked, term)
                case rules.Truth(operand=rules.NamePath() as name) if is_rule(name):
                    return verdict(name)
            return self._comparisons.build(each)

        return self._build(condition, leaf)

    def of_behaviour(
        self, condition: rules.Condition, verdict: Callable[[rules.NamePath], ir.RuleRef | None]
    ) -> ir.Condition | None:
        """Return the condition of a behaviour; ``verdict`` resolves ``entity.rule``."""

        def leaf(each: _Leaf) -> ir.Condition | None:
            match each:
                case rules.Truth(operand=term) if (asked := self._actions.asked(term)) is not None:
                    return self._actions.condition(asked, term)
                case rules.Truth(operand=rules.NamePath() as name):
                    return verdict(name)
            message = "the condition of a behaviour is made of rules and actions only"
            hint = "make it a rule of an entity, and name it here as 'entity.rule'"
            self._scope.fault(codes.WRONG_OPERAND, message, each.span, hint)
            return None

        return self._build(condition, leaf)

    def _build(
        self,
        condition: rules.Condition,
        leaf: Callable[[_Leaf], ir.Condition | None],
    ) -> ir.Condition | None:
        match condition:
            case rules.Not():
                inner = self._build(condition.operand, leaf)
                return inner and ir.Not(inner)
            case rules.And() | rules.Or():
                built = [self._build(each, leaf) for each in condition.operands]
                operands = tuple(each for each in built if each is not None)
                if len(operands) < len(built):
                    return None
                return ir.And(operands) if isinstance(condition, rules.And) else ir.Or(operands)
            case rules.For():
                inner = self._build(condition.operand, leaf)
                duration_ns = self._scope.duration_ns(condition.duration)
                if inner is None or duration_ns is None:
                    return None
                written = " ".join(condition.duration.span.text.split())
                return ir.For(next(self._memories), inner, duration_ns, condition.span, written)
            case rules.Once():
                inner = self._build(condition.operand, leaf)
                duration_ns = self._scope.duration_ns(condition.duration)
                if inner is None or duration_ns is None:
                    return None
                written = " ".join(condition.duration.span.text.split())
                return ir.Once(next(self._memories), inner, duration_ns, condition.span, written)
            case rules.Times():
                inner = self._build(condition.operand, leaf)
                duration_ns = self._scope.duration_ns(condition.duration)
                times = self._scope.count(condition.count)
                if duration_ns == 0:
                    message = f"nothing turns true {condition.count.span.text} in no time"
                    self._scope.fault(codes.BAD_DURATION, message, condition.duration.span)
                if inner is None or not duration_ns or times is None:
                    return None
                index = next(self._memories)
                return ir.Times(index, inner, times, duration_ns, condition.span)
            case rules.Since():
                inner, cause = (
                    self._build(each, leaf) for each in (condition.operand, condition.cause)
                )
                if inner is None or cause is None:
                    return None
                written = strip_comments(condition.cause.span.text)
                read = self.inputs_of(cause)
                return ir.Since(next(self._memories), inner, cause, read, condition.span, written)
            case rules.Begins():
                inner = self._build(condition.operand, leaf)
                if inner is None:
                    return None
                return ir.Begins(ir.For(next(self._memories), inner, 1, condition.span))
            case _:
                return leaf(condition)

    def inputs_of(self, condition: ir.Condition) -> tuple[int, ...]:
        """Return the inputs that a condition reads, and the rules that it names."""
        return walk.inputs_behind(condition, self._built, self._scope.leaves)
