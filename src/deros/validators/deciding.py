"""What decides conditions: the rules that they name, and what triggers and resets actions."""

from __future__ import annotations

from collections.abc import Container
from typing import Literal

from deros.rules.engine.early import chain_of
from deros.rules.program import ir, walk

Node = tuple[Literal["rule", "action"], int]
"""A rule, or an action whose state is asked for, by its index."""


def nodes_in(condition: ir.Condition) -> list[Node]:
    """Return the rules that a condition itself names, and the actions whose states it asks for."""
    found: list[Node] = []
    for part in walk.parts(condition):
        if isinstance(part, ir.RuleRef):
            found.append(("rule", part.rule))
        elif isinstance(part, ir.Active):
            found.append(("action", part.action))
    return found


class Deciding:
    """What decides the conditions of a program in which nothing depends on itself."""

    def __init__(self, program: ir.Program) -> None:
        """Note the behaviours of a program."""
        self._program = program
        self._behaviours = {each.index: each for each in walk.behaviours(program)}

    def triggers(self, action: int) -> list[ir.Behaviour]:
        """Return the behaviours that run an action."""
        return [self._behaviours[each] for each in self._program.actions[action].triggered_by]

    def resets(self, action: int) -> list[ir.Behaviour]:
        """Return the behaviours that reset an action."""
        reset_by = self._program.actions[action].reset_by
        return self.triggers(reset_by) if reset_by is not None else []

    def around(self, behaviour: ir.Behaviour) -> tuple[ir.Condition, ...]:
        """Return the conditions of the behaviours around one, the outermost first."""
        return tuple(each.condition for each in chain_of(self._behaviours, behaviour.index)[:-1])

    def whole(self, behaviour: ir.Behaviour) -> ir.Condition:
        """Return the condition of a behaviour with those around it."""
        around = self.around(behaviour)
        return ir.And((*around, behaviour.condition)) if around else behaviour.condition

    def behind(self, condition: ir.Condition, known: Container[Node] = ()) -> list[Node]:
        """Return what a condition depends on, directly or not, each after what it depends on.

        What is ``known`` is left out, and so is what only that depends on.
        """
        found: dict[Node, None] = {}
        open_ = nodes_in(condition)
        while open_:
            node = open_[-1]
            if node in known or node in found:
                open_.pop()
                continue
            inner = [each for whole in self.wholes(node) for each in nodes_in(whole)]
            waiting = [each for each in inner if each not in known and each not in found]
            if not waiting:
                found[open_.pop()] = None
            open_ += waiting
        return list(found)

    def wholes(self, node: Node) -> list[ir.Condition]:
        """Return the conditions of a rule, or of what triggers and resets an action."""
        kind, index = node
        if kind == "rule":
            return [self._program.rules[index].condition]
        return [self.whole(each) for each in (*self.triggers(index), *self.resets(index))]
