"""The order within an event: rounds of rules, behaviours, and the resets that these request.

A condition sees an action as it is after everything that triggers or resets it at the same event
has run. So a rule or behaviour that names an action, by itself or by the rules that it names,
belongs to a later round than all of that. Without such names there is one round.
"""

from __future__ import annotations

from dataclasses import dataclass

from deros.rules.program import walk
from deros.rules.program.ir import Action, Active, Behaviour, Condition, Program, Rule, RuleRef


@dataclass(frozen=True, slots=True)
class Round:
    """A part of an event: its rules, then its behaviours, then its resets, each as numbered.

    Attributes:
        rules: a rule stands in the round of those that it names, or in a later one.
        behaviours: the outermost ones, with those nested in them.
        resets: the actions that others reset, of which nothing in a later round triggers or resets
            any at the same event.
    """

    rules: tuple[Rule, ...]
    behaviours: tuple[Behaviour, ...]
    resets: tuple[Action, ...]


def watched_actions(program: Program) -> frozenset[int]:
    """Return the actions that conditions name."""
    conditions = walk.conditions(program)
    return frozenset(each.action for each in conditions if isinstance(each, Active))


def rounds(program: Program) -> tuple[Round, ...]:
    """Return the rounds of a program in which nothing depends on itself."""
    places = _places(program)
    return tuple(
        Round(
            tuple(rule for rule in program.rules if places.rules[rule.index] == number),
            tuple(each for each in program.behaviours if places.behaviours[each.index] == number),
            tuple(
                each
                for each in program.actions
                if each.reset_by is not None and places.actions[each.index] == number
            ),
        )
        for number in range(places.count)
    )


def late_rules(program: Program) -> frozenset[int]:
    """Return the rules of all rounds but the first one."""
    return frozenset(rule.index for each in rounds(program)[1:] for rule in each.rules)


@dataclass(frozen=True, slots=True)
class _Places:
    """The number of the round of each rule, of each behaviour, and of each action."""

    rules: list[int]
    behaviours: dict[int, int]
    actions: list[int]

    @property
    def count(self) -> int:
        return max((0, *self.rules, *self.behaviours.values(), *self.actions)) + 1


def _places(program: Program) -> _Places:
    """Return the earliest rounds that are late enough: they are put off until nothing changes."""
    actions = [0] * len(program.actions)
    while True:
        rules: list[int] = []
        for rule in program.rules:  # after those that it names
            rules.append(_after(rule.condition, rules, actions))
        behaviours: dict[int, int] = {}
        for outer in program.behaviours:
            tree = list(walk.nested(outer))
            place = max(_after(each.condition, rules, actions) for each in tree)
            behaviours.update((each.index, place) for each in tree)
        triggered = [
            max((behaviours[index] for index in action.triggered_by), default=0)
            for action in program.actions
        ]
        later = [
            max(place, triggered[action.reset_by] if action.reset_by is not None else 0)
            for place, action in zip(triggered, program.actions, strict=True)
        ]
        if later == actions:
            return _Places(rules, behaviours, actions)
        actions = later


def _after(condition: Condition, rules: list[int], actions: list[int]) -> int:
    """Return the first round in which everything that a condition names is settled."""
    place = 0
    for part in walk.parts(condition):
        if isinstance(part, RuleRef):
            place = max(place, rules[part.rule])
        elif isinstance(part, Active):
            place = max(place, actions[part.action] + 1)
    return place
