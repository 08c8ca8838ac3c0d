"""The rounds of an event, and the actions that settle in them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from deros.generators.monitor.c.code.layout import Layout
from deros.generators.monitor.c.code.rule_functions import Sites, settle
from deros.generators.text.c import comment
from deros.rules.program.ir import Program, Rule
from deros.rules.program.rounds import rounds, watched_actions


@dataclass(frozen=True, slots=True)
class ActionView:
    """An action: its name, and the flag that it is active, if it can be reset.

    It is ``watched`` if a condition names it.
    """

    name: str
    enumerator: str
    active: str
    latched: bool
    settle: str
    reset_by: str
    lines: tuple[str, ...]
    comment: tuple[str, ...]
    watched: bool


@dataclass(frozen=True, slots=True)
class RoundView:
    """A round of an event, the first of which begins where its rules have been evaluated.

    Attributes:
        rules: those that the round itself evaluates; ``judges`` their functions.
        judge: the function that evaluates them all; empty if there are none.
        outer: the functions of its outermost behaviours.
        resets: the functions of its resets.
    """

    rules: tuple[Rule, ...]
    judges: tuple[str, ...]
    judge: str
    outer: tuple[str, ...]
    resets: tuple[str, ...]


def actions_of(program: Program, layout: Layout, places: Sites) -> Iterator[ActionView]:
    """Yield the actions of a program."""
    watched = watched_actions(program)
    for action in program.actions:
        enumerator = f"{layout.macro}_ACTION_{action.name.upper()}"
        active = layout.active[action.index] if action.index in places.declarations else ""
        lines = settle(layout, action, places) if active else []
        reset_by = layout.ran[action.reset_by] if action.reset_by is not None else ""
        how = "is latched"
        if action.reset_by is not None:
            how = f"is reset by {program.actions[action.reset_by].name}"
        title = comment(0, f"Action {action.name} {how}", action.span, "") if action.span else []
        yield ActionView(
            action.name,
            enumerator,
            active,
            action.latched,
            f"settle_{action.name}",
            reset_by,
            tuple(lines),
            tuple(title),
            action.index in watched,
        )


def rounds_of(
    program: Program, layout: Layout, actions: Sequence[ActionView]
) -> Iterator[RoundView]:
    """Yield the rounds of a program."""
    for number, each in enumerate(rounds(program), 1):
        rules = each.rules if number > 1 else ()
        judges = tuple(layout.judges[rule.index] for rule in rules)
        all_of_them = layout.names.new("judge", "round", number) if len(judges) > 1 else ""
        yield RoundView(
            rules,
            judges,
            all_of_them or "".join(judges),
            tuple(layout.behave[behaviour.index] for behaviour in each.behaviours),
            tuple(actions[action.index].settle for action in each.resets),
        )
