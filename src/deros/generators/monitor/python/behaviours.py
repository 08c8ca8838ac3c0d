"""The method that runs all behaviours from top to bottom, then the resets they request.

So it does round by round, with the rules of each round but the first one before its behaviours.

A behaviour is True or False; one on whose falsehood a reset depends is None while it is unknown.
"""

from __future__ import annotations

from collections.abc import Sequence

from deros.generators.monitor.python.conditions import Conditions
from deros.generators.monitor.python.layout import Layout
from deros.generators.monitor.python.rules import Judge, interval_lines
from deros.generators.text.logic import Atom, Logic, all_of, any_of, lay_out
from deros.generators.text.provenance import comment, header
from deros.generators.text.python import lay_out_call, tuple_entries
from deros.rules.engine.early import early_ones
from deros.rules.program import walk
from deros.rules.program.ir import Action, Behaviour, Program, RuleRef, Trigger
from deros.rules.program.rounds import Round, rounds, watched_actions


def act_lines(program: Program, layout: Layout, judges: Sequence[Judge]) -> list[str]:
    """Return the body of the method that runs behaviours."""
    return _Writer(program, layout).act(judges)


def latched_lines(program: Program, layout: Layout) -> list[str]:
    """Return the lines of ``reset()`` for the latched actions."""
    return _Writer(program, layout).latched()


class _Writer:
    def __init__(self, program: Program, layout: Layout) -> None:
        self._program = program
        self._layout = layout
        self._conditions = Conditions(program, layout)
        self._rounds = rounds(program)
        self._early = early_ones(program)
        self._names = [each.name for each in walk.behaviours(program)]

    def act(self, judges: Sequence[Judge]) -> list[str]:
        lines: list[str] = []
        loaded: set[str] = set()
        for number, each in enumerate(self._rounds):
            calls = [
                f"        self._{judge.method}(t)" for judge in judges if judge.round == number
            ]
            lines += ["", *calls] if number and calls else []
            names = [name for name in self._verdicts(each) if name not in loaded]
            lines += [f"        {name} = self._{name}" for name in names]
            loaded.update(names)
            if not number:
                lines += [f"        {name} = False" for name in self._layout.ran.values()]
            for behaviour in each.behaviours:
                lines += self._behaviour(behaviour, None)
            for action in each.resets:
                if action.reset_by is not None:
                    lines += self._reset(action, action.reset_by)
        return lines[1:] if lines and not lines[0] else lines

    def latched(self) -> list[str]:
        lines: list[str] = []
        latched = [action for action in self._program.actions if action.latched]
        states = [f"self._{self._layout.active[action.index]}" for action in latched]
        watched = [f"self._{self._layout.active[n]}" for n in self._watched_latched()]
        if watched:
            lines += lay_out_call(8, "before = (", tuple_entries(watched))
        for action, active in zip(latched, states, strict=True):
            lines += ["", *self._title(action, "is latched"), f"        if {active}:"]
            lines += self._settle(action)
            lines += [] if watched else [f"            done = done and not {active}"]
        if watched:
            after = Atom(f"before != ({', '.join(tuple_entries(watched))})")
            lines += ["", *lay_out(8, "if ", after, ":"), "            self._evaluate(t)"]
            lines += [*lay_out(8, "done = ", all_of(Atom(f"not {each}") for each in states))]
        return lines

    def _watched_latched(self) -> list[int]:
        """Return the latched actions that conditions name: their reset is an event."""
        watched = watched_actions(self._program)
        return [
            each.index for each in self._program.actions if each.latched and each.index in watched
        ]

    def _verdicts(self, of: Round) -> list[str]:
        names: dict[str, None] = {}
        for outer in of.behaviours:
            for behaviour in walk.nested(outer):
                for part in walk.parts(behaviour.condition):
                    if isinstance(part, RuleRef):
                        names[self._layout.verdicts[part.rule]] = None
        return list(names)

    # Behaviours ---------------------------------------------------------------------------------

    def _behaviour(self, behaviour: Behaviour, outer: str | None) -> list[str]:
        if behaviour.early_of is not None:
            return self._early_behaviour(behaviour, behaviour.early_of)
        nested = [n for n, item in enumerate(behaviour.body) if isinstance(item, Behaviour)]
        first = nested[0] if nested else len(behaviour.body)
        late = any(isinstance(item, Trigger) for item in behaviour.body[first:])
        holds = f"self._{self._layout.holds[behaviour.index]}"
        itself = None if outer else self._itself(behaviour)
        if not nested and itself is not None:
            return [
                "",
                *comment(8, f"Behaviour {behaviour.name}", behaviour.span),
                f"        if {itself} and not {holds}:",
                *self._triggers(12, behaviour.body, behaviour),
                f"        {holds} = {itself}",
            ]
        rises = self._layout.names.new(behaviour.name, "rises") if late else ""
        text = header(behaviour.span.text) if nested else behaviour.span.text
        lines = [
            "",
            *comment(8, f"Behaviour {behaviour.name}", behaviour.span, text),
            *interval_lines(self._conditions, self._layout, behaviour.condition),
            *([f"        {rises} = False"] if late else []),
            *lay_out(8, "if ", self._true(behaviour, outer), ":"),
            f"            if not {holds}:",
            f"                {f'{rises} = ' if late else ''}{holds} = True",
        ]
        lines += self._triggers(16, behaviour.body[:first], behaviour)
        lines += self._otherwise(behaviour, outer)
        for item in behaviour.body[first:]:
            if isinstance(item, Behaviour):
                lines += self._behaviour(item, holds)
            else:
                lines += [f"        if {rises}:", *self._trigger(12, item, behaviour)]
        return lines

    def _early_behaviour(self, behaviour: Behaviour, written: int) -> list[str]:
        title = f"Behaviour {self._names[written]}, as if no 'for' had to last"
        holds = f"self._{self._layout.holds[behaviour.index]}"
        itself = self._itself(behaviour)
        if itself is not None:
            return ["", *comment(8, title, behaviour.span, ""), f"        {holds} = {itself}"]
        return [
            "",
            *comment(8, title, behaviour.span, ""),
            *interval_lines(self._conditions, self._layout, behaviour.condition),
            *lay_out(8, "if ", self._true(behaviour, None), ":"),
            f"            {holds} = True",
            *self._otherwise(behaviour, None),
        ]

    def _itself(self, behaviour: Behaviour) -> str | None:
        """Return the name of what is True, False or None as a behaviour on its own has to be."""
        if behaviour.switches or behaviour.index not in self._layout.refusing:
            return None
        return self._conditions.itself(behaviour.condition)

    def _otherwise(self, behaviour: Behaviour, outer: str | None) -> list[str]:
        """Return the statements for a condition that is not true."""
        holds = f"self._{self._layout.holds[behaviour.index]}"
        if behaviour.index not in self._layout.refusing:
            return ["        else:", f"            {holds} = False"]
        return [
            *lay_out(8, "elif ", self._false(behaviour, outer), ":"),
            f"            {holds} = False",
            "        else:",
            f"            {holds} = None",
        ]

    def _true(self, behaviour: Behaviour, outer: str | None) -> Logic:
        parts = [Atom(outer)] if outer else []
        names = (self._names[index] for index in behaviour.switches)
        parts += [Atom(f"{name!r} not in self._disabled") for name in names]
        return all_of([*parts, self._conditions.true(behaviour.condition)])

    def _false(self, behaviour: Behaviour, outer: str | None) -> Logic:
        parts = [Atom(f"{outer} is False")] if outer else []
        names = (self._names[index] for index in behaviour.switches)
        parts += [Atom(f"{name!r} in self._disabled") for name in names]
        return any_of([*parts, self._conditions.false(behaviour.condition)])

    def _triggers(
        self, indent: int, items: Sequence[Trigger | Behaviour], behaviour: Behaviour
    ) -> list[str]:
        lines: list[str] = []
        for trigger in items:
            assert isinstance(trigger, Trigger)
            lines += self._trigger(indent, trigger, behaviour)
        return lines

    def _trigger(self, indent: int, trigger: Trigger, behaviour: Behaviour) -> list[str]:
        blank = " " * indent
        lines: list[str] = []
        if trigger.action in self._layout.active:
            lines.append(f"{blank}self._{self._layout.active[trigger.action]} = True")
        if trigger.action in self._layout.ran:
            lines.append(f"{blank}{self._layout.ran[trigger.action]} = True")
        names = self._program.actions[trigger.action].name, behaviour.name
        arguments = [*map(repr, names), str(behaviour.span.line), *map(repr, trigger.arguments)]
        return lines + lay_out_call(indent, "self._trigger(", ["t", *arguments])

    # Resets -------------------------------------------------------------------------------------

    def _reset(self, action: Action, reset_by: int) -> list[str]:
        active, ran = self._layout.active[action.index], self._layout.ran[reset_by]
        return [
            "",
            *self._title(action, f"is reset by {self._program.actions[reset_by].name}"),
            f"        if {ran} and self._{active}:",
            *self._settle(action),
        ]

    def _title(self, action: Action, what: str) -> list[str]:
        assert action.span is not None
        return comment(8, f"Action {action.name} {what}", action.span, "")

    def _settle(self, action: Action) -> list[str]:
        """Return the statements that reset an action, unless a condition refuses it."""
        assert action.span is not None
        active = f"self._{self._layout.active[action.index]}"
        behaviours = [
            f"({self._names[index]!r}, {self._holds(index)}, {self._holds(self._early.get(index))})"
            for index in action.triggered_by
            if index not in self._early.values()
        ]
        arguments = ["t", repr(action.name), str(action.span.line), *behaviours]
        return lay_out_call(12, f"{active} = not self._is_reset(", arguments)

    def _holds(self, behaviour: int | None) -> str:
        return "False" if behaviour is None else f"self._{self._layout.holds[behaviour]}"
