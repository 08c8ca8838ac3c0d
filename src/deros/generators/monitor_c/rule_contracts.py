"""What is to be proved of the functions that judge rules and run behaviours.

Each says what it reads, changes and ensures by itself, and no more: what it does not mention is
seen to be as it was wherever it is called.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from deros.generators.monitor_c.contracts import Contract, all_of, iff
from deros.generators.monitor_c.predicates import BY_JUDGING, Predicates
from deros.generators.monitor_c.view import MessageView, MonitorView
from deros.monitor import walk
from deros.monitor.ir import Action, Behaviour, Condition, For, Rule, Trigger

_FIELD = re.compile(r"m->(\w+)")


class RuleContracts:
    """Writes the contracts of what settles an event."""

    def __init__(self, view: MonitorView, predicates: Predicates) -> None:
        """Remember what is named how."""
        self._program = view.program
        self._layout = view.layout
        self._predicates = predicates
        self._behaviours = tuple(walk.behaviours(view.program))
        self._latched = [each for each in view.program.actions if each.latched]
        self._true, self._false = predicates.macro("TRUE"), predicates.macro("FALSE")

    def judge(self, rule: Rule) -> Contract:
        """Return that a rule's verdict is what it means, and whether it has changed."""
        name = self._layout.verdicts[rule.index]
        fors = self._predicates.fors(rule.condition)
        contract = Contract(["\\valid(m)"])
        contract.requires.append(self._ranges_read(rule.condition, fors))
        contract.assigns += [f"m->{name}", f"m->{self._layout.turned[rule.index]}"]
        contract.ensures += self._predicates.ranges([name])
        contract.ensures.append(f"judged_{name}(m)")
        contract.ensures.append(iff("\\result != 0", f"m->{name} != \\old(m->{name})"))
        self._with_own_intervals(contract, fors)
        return contract

    def judge_by(self, message: MessageView) -> Contract:
        """Return that the rules that read a topic are judged, and whether a verdict changes."""
        rules = [each for each in self._program.rules if each.index in message.rules]
        names = [self._layout.verdicts[each.index] for each in rules]
        turned = [self._layout.turned[each.index] for each in rules]
        contract = Contract(["\\valid(m)", "ranged(m)"])
        contract.assigns += [f"m->{name}" for name in (*names, *turned)]
        contract.ensures += self._predicates.ranges(names)
        contract.ensures += [f"judged_{name}(m)" for name in names]
        contract.ensures += [f"\\result == 0 ==> m->{n} == \\old(m->{n})" for n in names]
        fors = [each for rule in rules for each in self._predicates.fors(rule.condition)]
        self._with_own_intervals(contract, fors)
        return contract

    def settle(self, action: Action) -> Contract:
        """Return that an action is reset if that is asked for and all its causes are over."""
        active = self._layout.active[action.index]
        conditions = [self._layout.conditions[each] for each in action.triggered_by]
        read = [active, *conditions]
        asked = [f"m->{each} == {self._false}" for each in conditions]
        if action.reset_by is not None:
            ran = self._layout.ran[action.reset_by]
            read.append(ran)
            asked.append(f"m->{ran} != 0")
        contract = Contract(["\\valid(m)", all_of(self._predicates.ranges(read))], [f"m->{active}"])
        reset = all_of(asked) if asked else "\\true"
        contract.ensures.append(f"m->{active} == ({reset} ? 0 : \\old(m->{active}))")
        return contract

    def behave(self, behaviour: Behaviour) -> Contract:
        """Return the contract of the function that runs a behaviour, and those within it."""
        group = self._closure(behaviour)
        fors = [each for one in group for each in self._predicates.fors(one.condition)]
        changed = [self._layout.conditions[each.index] for each in group] + self._touched(group)
        contract = Contract(["\\valid(m)"], [f"m->{name}" for name in changed])
        for each in group:
            own = self._predicates.fors(each.condition)
            contract.requires.append(self._ranges_read(each.condition, own))
        contract.requires.append(all_of(self._predicates.ranges([*self._guards(group), *changed])))
        contract.ensures += self._predicates.ranges(changed)
        contract.ensures += [f"acted_{self._layout.behave[each.index]}(m)" for each in group]
        contract.ensures += self._done(group)
        self._with_own_intervals(contract, fors)
        return contract

    def act(self) -> Contract:
        """Return that every behaviour holds if its condition does, and what becomes of actions."""
        tables = (self._layout.conditions, self._layout.ran, self._layout.active)
        contract = self._run([each for table in tables for each in table.values()])
        contract.ensures += ["acted(m)", *self.kept_latched()]
        for action in self._program.actions:
            if action.reset_by is not None:
                contract.ensures += self.kept_called(action)
        contract.ensures += self._begun()
        fors = [part for each in self._behaviours for part in self._predicates.fors(each.condition)]
        self._with_intervals(contract, self._sinces(fors))
        contract.requires.append("changed == 0 ==> acted(m)")
        contract.cases |= {"change": "changed != 0", "none": "changed == 0"}
        return contract

    def evaluate(self) -> Contract:
        """Return that all is judged, and acted upon."""
        contract = self._run([])
        contract.ensures += ["m->started == 1", "judged(m)", "acted(m)", *self.kept_latched()]
        self._with_intervals(contract, self._layout.since.values())
        contract.assigns = [BY_JUDGING]
        return contract

    def kept_latched(self, before: str = "\\old({})") -> list[str]:
        """Return that a latched action never clears by itself."""
        names = [f"m->{self._layout.active[each.index]}" for each in self._latched]
        return [f"{before.format(name)} != 0 ==> {name} != 0" for name in names]

    def kept_called(self, action: Action) -> Iterator[str]:
        """Yield that an action stays active unless what triggers it is known to be false."""
        active = self._layout.active[action.index]
        for index in action.triggered_by:
            over = f"m->{self._layout.conditions[index]} == {self._false}"
            yield f"\\old(m->{active}) != 0 && !({over}) ==> m->{active} != 0"

    def _ranges_read(self, condition: Condition, fors: Iterable[For]) -> str:
        """Return that all that a condition reads, and its intervals, are in range."""
        meaning = self._predicates.meaning
        text = f"m->now {meaning.true(condition)} {meaning.false(condition)}"
        sinces = self._sinces(fors)
        names = dict.fromkeys([*_FIELD.findall(text), *sinces])
        return all_of(self._predicates.ranges(names))

    def _with_own_intervals(self, contract: Contract, fors: Iterable[For]) -> None:
        """Add what becomes of the intervals of a condition; they stay in range and in time."""
        sinces = self._sinces(fors)
        if sinces:
            in_time = self._predicates.ends_in_time("m->due", sinces)
            contract.requires += in_time
            contract.ensures += [*self._predicates.ranges(sinces), *in_time]
            self._with_intervals(contract, sinces)

    def _with_intervals(self, contract: Contract, sinces: Iterable[str]) -> None:
        """Add what becomes of intervals: begun now, kept, or cleared."""
        unset = self._predicates.macro("UNSET")
        for since in sinces:
            contract.assigns.append(f"m->{since}")
            kept = f"(\\old(m->{since}) == {unset} ? m->now : \\old(m->{since}))"
            contract.ensures.append(f"m->{since} != {unset} ==> m->{since} == {kept}")
            with_earlier_deadline(contract)

    def _closure(self, behaviour: Behaviour) -> list[Behaviour]:
        found = [behaviour]
        for item in behaviour.body:
            if isinstance(item, Behaviour):
                found += self._closure(item)
        return found

    def _guards(self, group: list[Behaviour]) -> Iterator[str]:
        """Yield the fields beside its condition by which a behaviour holds."""
        for each in group:
            if each.parent is not None:
                yield self._layout.conditions[each.parent]
            if each.optional:
                yield self._layout.enabled[each.index]

    def _touched(self, group: list[Behaviour]) -> list[str]:
        names: dict[str, None] = {}
        for each in group:
            for item in each.body:
                if isinstance(item, Trigger):
                    for table in (self._layout.active, self._layout.ran):
                        if item.action in table:
                            names[table[item.action]] = None
        return list(names)

    def _done(self, group: list[Behaviour]) -> Iterator[str]:
        """Yield that what is triggered becomes active, and that nothing else changes that."""
        for index, active in self._layout.active.items():
            callers = [each for each in group if _triggers(each, index)]
            if not callers:
                continue
            rises = " || ".join(self._rises(each) for each in callers)
            yield iff(f"m->{active} != 0", f"(\\old(m->{active}) != 0 || {rises})")

    def _rises(self, behaviour: Behaviour) -> str:
        condition, true = f"m->{self._layout.conditions[behaviour.index]}", self._true
        return f"({condition} == {true} && \\old({condition}) != {true})"

    def _run(self, changed: Iterable[str]) -> Contract:
        """Return what is common to what runs rules or behaviours: all stays in range and time."""
        contract = Contract(["\\valid(m)", "ranged(m)", "ends_in_time(m, m->due)"])
        contract.assigns += [f"m->{name}" for name in changed]
        contract.ensures += ["ranged(m)", "ends_in_time(m, m->due)"]
        return contract

    def _sinces(self, fors: Iterable[For]) -> list[str]:
        return [self._layout.since[each.index] for each in fors]

    def _begun(self) -> Iterator[str]:
        """Yield that what a behaviour calls for becomes active when its condition turns true."""
        for behaviour in self._behaviours:
            for index, active in self._layout.active.items():
                if _triggers(behaviour, index):
                    yield f"{self._rises(behaviour)} ==> m->{active} != 0"


def with_earlier_deadline(contract: Contract) -> None:
    """Add that the next deadline comes no later than before, and still lies ahead."""
    contract.assigns.append("m->due")
    contract.ensures.append("m->due <= \\old(m->due)")
    contract.ensures.append("\\old(m->due) > m->now ==> m->due > m->now")


def _triggers(behaviour: Behaviour, action: int) -> bool:
    return any(isinstance(item, Trigger) and item.action == action for item in behaviour.body)
