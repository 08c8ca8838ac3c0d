"""The events that the rules emit, in order, in ACSL.

No list is needed. ``emitted`` is one value for all events so far, and ``after`` returns
that of one event more, whatever function it is: values that are equal for every such function
stand for the same events in the same order.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from deros.generators.monitor.c.acsl.contracts import wrapped
from deros.generators.monitor.c.code.view import MonitorView
from deros.rules.program import walk
from deros.rules.program.ir import Action, Behaviour, Trigger
from deros.rules.program.rounds import rounds

_EVENTS = """\
/* All events so far, as one value. after() gives that of one event more, and may be any function;
 * follows() is any relation that holds of a value and the same once an event of the rules has
 * added what it emits.
 */
/*@ ghost extern int emitted; */
/*@ axiomatic Events {
      logic integer after(integer events, void *owner, integer t, integer kind, integer site);
      predicate follows(integer earlier, integer later);
      axiom none: \\forall integer a; follows(a, a);
      axiom both: \\forall integer a, b, c; follows(a, b) && follows(b, c) ==> follows(a, c);
    } */
"""


class Emissions:
    """Prints the events that functions emit as terms: those after a call, from those before it."""

    def __init__(self, view: MonitorView) -> None:
        """Use the names of a layout."""
        self._layout = view.layout
        self._program = view.program
        self._sites = view.sites
        self._behaviours = tuple(walk.behaviours(view.program))

    def declarations(self) -> str:
        """Return the logic functions for the emissions of behaviours, resets and events."""
        prefix = self._layout.prefix
        emit = [
            "/*@ assigns emitted;",
            "    ensures emitted == after(\\old(emitted), owner, t, kind, site); */",
            f"extern void {prefix}_emit(",
            f"  void *owner, int64_t t, {prefix}_kind kind, uint32_t site);",
        ]
        lines = [_EVENTS.rstrip("\n"), *emit]
        for behaviour in reversed(self._behaviours):
            lines += self._define(self._name(behaviour), self._of(behaviour), self._body(behaviour))
        for action in self._program.actions:
            if action.latched or action.reset_by is not None:
                lines += self._define(
                    f"emitted_by_settle_{action.name}", self._read(action), self._settling(action)
                )
        names = [each for one in self._behaviours for each in self._seen(one)]
        names += [name for action in self._resettable() for name in self._reset(action)]
        names = list(dict.fromkeys(names))
        lines += self._define("emitted_by_event", names, self._event())
        bound = "".join(f", {name}" for name in names)
        lines += wrapped(
            f"/*@ axiomatic Following {{ axiom event: \\forall integer events, void *owner, "
            f"integer now{bound.replace(', ', ', integer ')}; "
            f"follows(events, emitted_by_event(events, owner, now{bound})); }} */"
        )
        return "\n".join([*lines, ""])

    # Terms on a monitor -------------------------------------------------------------------------

    def by_behaviour(self, behaviour: Behaviour, before: str) -> str:
        """Return all events after a behaviour, and those nested in it, have run."""
        arguments = [each for one in self.closure(behaviour) for each in self._edges(one)]
        return self._call(self._name(behaviour), before, arguments)

    def by_settling(self, action: Action, before: str, active: str) -> str:
        """Return all events after a possible reset; ``active`` is the action's state before."""
        rest = self._read(action)[1:]
        arguments = [active, *(f"m->{each}" for each in rest)]
        return self._call(f"emitted_by_settle_{action.name}", before, arguments)

    def by_event(self, before: str) -> str:
        """Return all events after every behaviour has run and every requested reset is done."""
        arguments = [each for one in self._behaviours for each in self._edges(one)]
        for action in self._resettable():
            active, ran = self._reset(action)
            arguments += [f"\\old(m->{active[4:]})", f"m->{ran}"]
        return self._call("emitted_by_event", before, list(dict.fromkeys(arguments)))

    def rises(self, behaviour: Behaviour, was: str = "\\old(m->{})", now: str = "m->{}") -> str:
        """Return that a behaviour's condition turns true."""
        name = self._layout.conditions[behaviour.index]
        true = f"{self._layout.macro}_TRUE"
        return f"({now.format(name)} == {true} && {was.format(name)} != {true})"

    def closure(self, behaviour: Behaviour) -> list[Behaviour]:
        """Return a behaviour and those nested in it."""
        found = [behaviour]
        for item in behaviour.body:
            if isinstance(item, Behaviour):
                found += self.closure(item)
        return found

    def callers(self, action: int, group: Sequence[Behaviour] | None = None) -> list[Behaviour]:
        """Return the behaviours that run an action themselves."""
        return [
            each
            for each in (self._behaviours if group is None else group)
            if any(isinstance(item, Trigger) and item.action == action for item in each.body)
        ]

    # Definitions --------------------------------------------------------------------------------

    def _define(self, name: str, parameters: Sequence[str], body: str) -> list[str]:
        declared = "".join(f", integer {each}" for each in parameters)
        head = f"/*@ logic integer {name}(integer events, void *owner, integer now{declared}) ="
        return [*wrapped(head), *wrapped(f"{body}; */", 6)]

    def _body(self, behaviour: Behaviour) -> str:
        """Return what a behaviour's body emits, from top to bottom."""
        text, lets, triggers = "events", "", []
        rises = self.rises(behaviour, "was_{}", "{}")
        for place, item in [*enumerate(behaviour.body), (len(behaviour.body), None)]:
            if isinstance(item, Trigger):
                triggers.append(self._sites.calls[behaviour.index, place])
                continue
            if triggers:
                if text != "events":
                    name = f"events_{place}"
                    lets, text = f"{lets}\\let {name} = {text}; ", name
                text = f"({rises} ? {self._chain(text, triggers)} : {text})"
                triggers = []
            if isinstance(item, Behaviour):
                text = f"{self._name(item)}({', '.join([text, 'owner', 'now', *self._of(item)])})"
        return lets + text

    def _chain(self, before: str, sites: Sequence[int]) -> str:
        for site in sites:
            before = f"after({before}, owner, now, {self._layout.macro}_TRIGGER, {site})"
        return before

    def _settling(self, action: Action) -> str:
        active = self._read(action)[0]
        asked = [f"{active} != 0"]
        if action.reset_by is not None:
            asked.append(f"{self._layout.ran[action.reset_by]} != 0")
        site, macro = self._sites.declarations[action.index], self._layout.macro
        over = self.over(action, "{}")
        kind = f"{macro}_RESET" if not over else f"({over} ? {macro}_RESET : {macro}_REFUSED)"
        return f"({' && '.join(asked)} ? after(events, owner, now, {kind}, {site}) : events)"

    def over(self, action: Action, name: str = "m->{}") -> str:
        """Return that every condition that triggers an action is known to be false."""
        false = f"{self._layout.macro}_FALSE"
        names = [self._layout.conditions[each] for each in action.triggered_by]
        return " && ".join(f"{name.format(each)} == {false}" for each in names)

    def _event(self) -> str:
        text = "events"
        for each in rounds(self._program):
            for behaviour in each.behaviours:
                parts = [text, "owner", "now", *self._of(behaviour)]
                text = f"{self._name(behaviour)}({', '.join(parts)})"
            for action in each.resets:
                rest = self._read(action)[1:]
                parts = [text, "owner", "now", self.active(action.index, "was_{}", "{}"), *rest]
                text = f"emitted_by_settle_{action.name}({', '.join(parts)})"
        return text

    def active(self, action: int, was: str = "\\old(m->{})", now: str = "m->{}") -> str:
        """Return whether an action is active after all behaviours have run."""
        before = was.format(self._layout.active[action])
        rises = [self.rises(each, was, now) for each in self.callers(action)]
        return f"({' || '.join(rises)} ? 1 : {before})" if rises else before

    # Names --------------------------------------------------------------------------------------

    def _name(self, behaviour: Behaviour) -> str:
        return f"emitted_by_{self._layout.behave[behaviour.index]}"

    def _seen(self, behaviour: Behaviour) -> list[str]:
        name = self._layout.conditions[behaviour.index]
        return [f"was_{name}", name]

    def _of(self, behaviour: Behaviour) -> list[str]:
        return [each for one in self.closure(behaviour) for each in self._seen(one)]

    def _edges(self, behaviour: Behaviour) -> list[str]:
        name = self._layout.conditions[behaviour.index]
        return [f"\\old(m->{name})", f"m->{name}"]

    def _resettable(self) -> Iterator[Action]:
        for action in self._program.actions:
            if action.reset_by is not None:
                yield action

    def _reset(self, action: Action) -> list[str]:
        assert action.reset_by is not None
        return [f"was_{self._layout.active[action.index]}", self._layout.ran[action.reset_by]]

    def _read(self, action: Action) -> list[str]:
        names = [self._layout.active[action.index]]
        if action.reset_by is not None:
            names.append(self._layout.ran[action.reset_by])
        return [*names, *(self._layout.conditions[each] for each in action.triggered_by)]

    def _call(self, name: str, before: str, arguments: Sequence[str]) -> str:
        return f"{name}({', '.join([before, 'm->owner', 'm->now', *arguments])})"
