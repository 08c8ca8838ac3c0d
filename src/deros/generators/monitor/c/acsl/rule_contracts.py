"""The contracts of the functions that evaluate rules and run behaviours.

Each states what it reads, changes and ensures itself. What it does not mention is
seen to be unchanged wherever it is called.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from deros.generators.monitor.c.acsl.changes import (
    ALL,
    DONE,
    INTERVALS_RUN_ON,
    KEPT_BY_JUDGING,
    LATCHED_KEPT,
    VERDICTS_DATED,
    Changes,
)
from deros.generators.monitor.c.acsl.contracts import Contract, all_of, iff
from deros.generators.monitor.c.acsl.predicates import SOUND, Predicates
from deros.generators.monitor.c.code.round_functions import RoundView
from deros.generators.monitor.c.code.view import MessageView, MonitorView
from deros.rules.program import walk
from deros.rules.program.ir import Action, Behaviour, Condition, For, Rule, Trigger


class RuleContracts:
    """Prints the contracts of the functions that process an event."""

    def __init__(self, view: MonitorView, predicates: Predicates, changes: Changes) -> None:
        """Use the names of a layout."""
        self._program = view.program
        self._layout = view.layout
        self._predicates = predicates
        self._changes = changes
        self.emissions = predicates.emissions
        self._behaviours = tuple(walk.behaviours(view.program))
        self._late = view.late_rules
        self._false = predicates.macro("FALSE")

    def judge(self, rule: Rule) -> Contract:
        """Return that a rule's verdict is what the rule means, and whether it has changed."""
        name = self._layout.verdicts[rule.index]
        contract = Contract(["\\valid(m)"])
        contract.requires.append(self._ranges(self._read(rule.condition)))
        changed = [name, self._layout.turned[rule.index], *self._memories([rule.condition])]
        contract.assigns += [f"m->{each}" for each in changed]
        contract.ensures += self._predicates.ranges([name])
        contract.ensures.append(all_of(self._predicates.judged(rule)))
        contract.ensures.append(iff("\\result != 0", f"m->{name} != \\old(m->{name})"))
        contract.ensures.append(self._changes.turned(rule))
        self._with_memories(contract, [rule.condition])
        return contract

    def judge_by(self, message: MessageView) -> Contract:
        """Return that the rules that read a topic are evaluated, and whether a verdict changes."""
        rules = [each for each in self._program.rules if each.index in message.rules]
        contract = self._judge(rules)
        changed = self._changes.changed(self._layout.verdicts[each.index] for each in rules)
        contract.ensures.append(iff("\\result != 0", changed))
        return contract

    def judge_all(self) -> Contract:
        """Return that all rules of the first round are evaluated."""
        late = {each.index for each in self._late}
        return self._judge([each for each in self._program.rules if each.index not in late])

    def judge_round(self, of: RoundView) -> Contract:
        """Return that all rules of a later round are evaluated."""
        return self._judge(of.rules)

    def _judge(self, rules: Sequence[Rule]) -> Contract:
        """Return that some rules are evaluated; all is written out, as for :meth:`act`."""
        names = [self._layout.verdicts[each.index] for each in rules]
        turned = [self._layout.turned[each.index] for each in rules]
        conditions = [each.condition for each in rules]
        contract = Contract(["\\valid(m)"], ["*m"])
        read = [name for rule in rules for name in self._read(rule.condition)]
        contract.requires.append(self._ranges(read))
        changed = [*names, *turned, *self._memories(conditions)]
        contract.ensures.append(self._changes.kept_but(changed))
        contract.ensures.append(all_of(self._predicates.ranges(names)))
        contract.ensures += [all_of(self._predicates.judged(rule)) for rule in rules]
        contract.ensures.append(all_of(map(self._changes.turned, rules)))
        self._with_memories(contract, conditions)
        return contract

    def settle(self, action: Action) -> Contract:
        """Return that an action is reset if a reset is requested and all its causes are over."""
        active = self._layout.active[action.index]
        conditions = [self._layout.conditions[each] for each in action.triggered_by]
        read = [active, *conditions]
        asked = [f"m->{each} == {self._false}" for each in conditions]
        if action.reset_by is not None:
            ran = self._layout.ran[action.reset_by]
            read.append(ran)
            asked.append(f"m->{ran} != 0")
        contract = Contract(["\\valid(m)", all_of(self._predicates.ranges(read))])
        contract.assigns += [f"m->{active}", "emitted"]
        reset = all_of(asked) if asked else "\\true"
        contract.ensures.append(f"m->{active} == ({reset} ? 0 : \\old(m->{active}))")
        now = self.emissions.by_settling(action, "\\old(emitted)", f"\\old(m->{active})")
        contract.ensures.append(f"emitted == {now}")
        return contract

    def behave(self, behaviour: Behaviour) -> Contract:
        """Return the contract of the function that runs a behaviour, and those nested in it."""
        group = self.emissions.closure(behaviour)
        conditions = [each.condition for each in group]
        changed = [self._layout.conditions[each.index] for each in group] + self._touched(group)
        contract = Contract(["\\valid(m)"], [*(f"m->{name}" for name in changed), "emitted"])
        contract.assigns += [f"m->{name}" for name in self._memories(conditions)]
        read = [name for each in group for name in self._read(each.condition)]
        contract.requires.append(self._ranges([*read, *self._guards(group), *changed]))
        contract.ensures += self._predicates.ranges(changed)
        contract.ensures += [all_of(self._predicates.acted(each)) for each in group]
        contract.ensures += self._done(group)
        contract.ensures.append(
            f"emitted == {self.emissions.by_behaviour(behaviour, chr(92) + 'old(emitted)')}"
        )
        self._with_memories(contract, conditions)
        return contract

    def act(self) -> Contract:
        """Return that conditions have their verdicts, and what is run, reset and emitted.

        All is written out: of what it changes field by field, no predicate is seen to hold.
        """
        conditions = [rule.condition for rule in self._late]
        conditions += [each.condition for each in self._behaviours]
        changed = [*self._changes.acted_upon(), *self._memories(conditions)]
        contract = Contract(["\\valid(m)"], list(ALL))
        read = [name for each in conditions for name in self._read(each)]
        read += [*self._guards(self._behaviours), *self._changes.acted_upon()]
        contract.requires.append(self._ranges(read))
        judged = [all_of(self._predicates.judged(rule)) for rule in self._late]
        contract.requires.append(f"changed == 0 ==> {all_of([*judged, *self._acted()])}")
        contract.ensures.append(self._changes.kept_but(changed))
        contract.ensures.append(all_of(self._predicates.ranges(self._changes.acted_upon())))
        contract.ensures += judged
        contract.ensures += [self._changes.turned(rule) for rule in self._late]
        contract.ensures += self._acted()
        contract.ensures += self._changes.latched_kept()
        self._with_memories(contract, conditions)
        contract.cases |= {"change": "changed != 0", "none": "changed == 0"}
        done = [*self._changes.states_done(), *self._changes.emission_done()]
        contract.of_case["change"] = done
        contract.of_case["none"] = self._changes.nothing_done()
        return contract

    def evaluate(self) -> Contract:
        """Return that all rules are evaluated and all behaviours have run."""
        contract = Contract(["\\valid(m)", *SOUND, "m->now <= m->due"], list(ALL))
        contract.ensures += [*SOUND, KEPT_BY_JUDGING, "m->started == 1", "judged(m)", "acted(m)"]
        contract.ensures += [LATCHED_KEPT, VERDICTS_DATED, *DONE, INTERVALS_RUN_ON]
        contract.ensures.append("\\old(m->due) > m->now ==> m->due > m->now")
        return contract

    def _acted(self) -> list[str]:
        """Return the verdict of each behaviour's condition."""
        return [all_of(self._predicates.acted(each)) for each in self._behaviours]

    def kept_called(self, action: Action) -> Iterator[str]:
        """Yield that an action stays active unless what triggers it is known to be false."""
        active = self._layout.active[action.index]
        for index in action.triggered_by:
            over = f"m->{self._layout.conditions[index]} == {self._false}"
            yield f"\\old(m->{active}) != 0 && !({over}) ==> m->{active} != 0"

    def _read(self, condition: Condition) -> list[str]:
        """Return the fields that a condition reads, those of its intervals among them."""
        fields = self._predicates.semantics.fields_of(condition)
        return [*fields, *self._starts(self._predicates.fors(condition))]

    def _ranges(self, names: Iterable[str]) -> str:
        """Return that fields are in range, each once."""
        return all_of(self._predicates.ranges(dict.fromkeys(names)))

    def _with_memories(self, contract: Contract, conditions: Sequence[Condition]) -> None:
        """Add the changes of what conditions remember, and of the next deadline.

        Intervals begin now, continue or are cleared, and stay in range and in time.
        """
        fors = [part for each in conditions for part in self._predicates.fors(each)]
        onces = [part for each in conditions for part in self._predicates.onces(each)]
        counts = [part for each in conditions for part in self._predicates.counts(each)]
        if fors or onces or counts:
            starts = [*self._starts(fors), *(self._layout.until[each.index] for each in onces)]
            starts += self._layout.names_of_turns(counts)
            in_time = self._predicates.ends_in_time("m->due", starts)
            contract.requires += in_time
            contract.ensures += [*self._predicates.ranges(starts), *in_time]
            contract.ensures += self._changes.run_on(fors, onces, counts)
            contract.ensures += EARLIER_DEADLINE
        for each in conditions:
            for part in self._predicates.sinces(each):
                contract.ensures += self._predicates.ranges([self._layout.kept[part.index]])
                contract.ensures += self._changes.kept(part)

    def _guards(self, group: Iterable[Behaviour]) -> Iterator[str]:
        """Yield the fields beside its condition by which a behaviour holds."""
        for each in group:
            if each.parent is not None:
                yield self._layout.conditions[each.parent]
            yield from (self._layout.enabled[index] for index in each.switches)

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
        """Yield that what is run becomes active, and that nothing else changes that."""
        for table in (self._layout.active, self._layout.ran):
            for index, name in table.items():
                rises = [self.emissions.rises(b) for b in self.emissions.callers(index, group)]
                if rises:
                    yield f"m->{name} == ({' || '.join(rises)} ? 1 : \\old(m->{name}))"

    def _memories(self, conditions: Iterable[Condition]) -> list[str]:
        """Return the fields that conditions remember something in, and what they schedule."""
        found: list[str] = []
        for each in conditions:
            fors, onces = self._predicates.fors(each), self._predicates.onces(each)
            found += self._starts(fors)
            found += [self._layout.until[part.index] for part in onces]
            found += [self._layout.kept[part.index] for part in self._predicates.sinces(each)]
            counts = self._predicates.counts(each)
            found += self._layout.names_of_turns(counts)
            found += ["due"] if fors or onces or counts else []
        return list(dict.fromkeys(found))

    def _starts(self, fors: Iterable[For]) -> list[str]:
        return [self._layout.since[each.index] for each in fors]


EARLIER_DEADLINE = ("m->due <= \\old(m->due)", "\\old(m->due) > m->now ==> m->due > m->now")
"""The next deadline comes no later than before, and still lies ahead."""
