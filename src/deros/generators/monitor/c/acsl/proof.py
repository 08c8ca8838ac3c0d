"""What is to be proved of the emitted functions: their contracts in ACSL.

Between two calls a monitor is *sane*: its numbers are in range, no deadline lies before ``due``, no
timeout has passed unseen, every rule's verdict is what the rule means now
(:mod:`.acsl_semantics`), and every behaviour holds if its condition does. Each function is proved
by itself, from the contracts of those that it calls.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from deros.generators.monitor.c.acsl.changes import (
    ALL,
    CAUGHT_UP,
    KEPT_BY_DEADLINES,
    KEPT_BY_TIME,
    LATCHED_KEPT,
    NOTHING_CHANGED,
    STEPPED_BACK,
    Changes,
)
from deros.generators.monitor.c.acsl.contracts import Contract, all_of, any_of, iff
from deros.generators.monitor.c.acsl.message_contracts import MessageContracts
from deros.generators.monitor.c.acsl.predicates import IDLE, IDLE_BEFORE, Predicates
from deros.generators.monitor.c.acsl.rule_contracts import RuleContracts
from deros.generators.monitor.c.code.constants import started_predicates
from deros.generators.monitor.c.code.view import MonitorView, Timeout
from deros.rules.program import walk
from deros.rules.program.rounds import watched_actions


@dataclass(frozen=True, slots=True)
class Proof:
    """The contracts of the functions, and the predicates that they use.

    Attributes:
        declarations: the predicates.
        contracts: by function; that of its loop by its name and ``loop``.
    """

    declarations: str = ""
    contracts: dict[str, str] = field(default_factory=dict)

    def contract(self, function: str) -> str:
        """Return the contract of a function."""
        return self.contracts.get(function, NO_CONTRACT)


NO_CONTRACT = "/* no contract */"
"""Marks the line of a function without contract, which is taken out."""


def proof_of(view: MonitorView) -> Proof:
    """Return what is to be proved of a monitor."""
    writer = _Writer(view)
    contracts = {name: contract.text(0) for name, contract in writer.contracts()}
    contracts["catch_up loop"] = writer.loop().text(2)
    declarations = writer.predicates.declarations() + writer.changes.declarations()
    return Proof(declarations, contracts)


class _Writer:
    """Writes the contracts of one monitor."""

    def __init__(self, view: MonitorView) -> None:
        self._view = view
        self._program = view.program
        self._layout = view.layout
        self.predicates = Predicates(view)
        self.changes = Changes(view, self.predicates)
        self._rules = RuleContracts(view, self.predicates, self.changes)
        self._behaviours = tuple(walk.behaviours(view.program))
        self._latched = [each for each in view.program.actions if each.latched]
        self._watched = watched_actions(view.program)

    # Contracts ----------------------------------------------------------------------------------

    def contracts(self) -> Iterator[tuple[str, Contract]]:
        """Yield the contract of every function."""
        for text in self._view.texts:
            contract = Contract(["\\valid_read(text + (0 .. length - 1))"])
            contract.ensures.append(f"\\result <= {len(text.texts)}")
            yield f"which_{text.name}", contract
        for forget in self._view.forgets:
            cleared = [f"m->{name}" for name in forget.known]
            contract = Contract(["\\valid(m)"], [f"m->{name}" for name in forget.changed])
            contract.ensures.append(all_of(self.changes.forgotten(forget)))
            known = any_of(f"\\old({each}) != 0" for each in cleared)
            contract.ensures.append(iff("\\result != 0", known))
            contract.requires.append(all_of(self.predicates.ranges(forget.known)))
            yield forget.function, contract
        yield "earliest", self._earliest()
        for rule in self._program.rules:
            yield self._layout.judges[rule.index], self._rules.judge(rule)
        for action in self._program.actions:
            if action.latched or action.reset_by is not None:
                yield f"settle_{action.name}", self._rules.settle(action)
        for behaviour in self._behaviours:
            yield self._layout.behave[behaviour.index], self._rules.behave(behaviour)
        for each in self._view.rounds:
            if len(each.rules) > 1:
                yield each.judge, self._rules.judge_round(each)
        yield "act", self._rules.act()
        yield "judge_all", self._rules.judge_all()
        yield "evaluate", self._rules.evaluate()
        for timeout in self._view.timeouts:
            yield timeout.function, self._expire_one(timeout)
        if self._view.timeouts:
            yield "expire", self._expire()
        yield "restart", self._restart()
        yield "reach_deadline", self._reach_deadline()
        yield "catch_up", self._catch_up()
        yield "step_back", self._step_back()
        yield "pass", self._pass()
        yield "arrive", self._arrive()
        yield from self._public()

    def _earliest(self) -> Contract:
        fields = [each for end in self._view.ends for each in (end.base, end.guard) if each]
        fields += [each for t in self._view.timeouts for each in (t.base, t.missing)]
        ranges = self.predicates.ranges(dict.fromkeys(["now", *fields]))
        unexpired = all_of(self.predicates.all_unexpired())
        contract = Contract(["\\valid_read(m)", all_of(ranges), unexpired])
        contract.ensures.append("\\result > m->now")
        contract.ensures.append(all_of(self.predicates.all_in_time("\\result")))
        contract.ensures.append(self.predicates.end("\\result"))
        return contract

    def _expire_one(self, timeout: Timeout) -> Contract:
        missing = f"m->{timeout.missing}"
        known = [name for each in self.changes.forgets_of(timeout.forget) for name in each.known]
        names = ["now", timeout.base, timeout.missing, *known]
        contract = Contract(["\\valid(m)", all_of(self.predicates.ranges(names))], [missing])
        for forget in self.changes.forgets_of(timeout.forget):
            contract.assigns += [f"m->{name}" for name in forget.changed]
        contract.ensures += self.predicates.ranges([timeout.missing])
        contract.ensures.append(all_of(self.changes.expired(timeout)))
        return contract

    def _expire(self) -> Contract:
        """Return the same of all inputs; called at an instant that is due, and at no later one."""
        names = ["now"]
        changed: list[str] = []
        for each in self._view.timeouts:
            known = [name for f in self.changes.forgets_of(each.forget) for name in f.known]
            last = [
                name
                for f in self.changes.forgets_of(each.forget)
                for name in (*f.remembered, *f.counts)
            ]
            names += [each.base, each.missing, *known]
            changed += [each.missing, *known, *last]
        ranges = self.predicates.ranges(names)
        contract = Contract(["\\valid(m)", all_of(ranges), "is_end(m, m->now)"], ["*m"])
        contract.ensures.append(self.changes.kept_but(changed))
        for each in self._view.timeouts:
            contract.ensures.append(all_of(self.changes.expired(each)))
        contract.ensures += [all_of(ranges), all_of(self.predicates.all_unexpired())]
        return contract

    def _restart(self) -> Contract:
        latest = self.predicates.macro("LATEST")
        contract = Contract(["\\valid(m)"], ["*m"])
        contract.requires.append(f"0 <= m->now <= from <= {latest}")
        names = [each.name for each in self._view.fields if each.restarted]
        names += [name for each in self._view.forgets for name in each.changed]
        contract.ensures.append(self.changes.kept_but([*names, "due"]))
        contract.ensures.append(all_of(self.changes.as_new("from")))
        contract.ensures.append(all_of(self.predicates.all_in_time("m->due")))
        contract.ensures += ["m->due > m->now", self.predicates.end("m->due")]
        return contract

    def _step_back(self) -> Contract:
        """Return that all is as new at an earlier time, and one event of the rules is settled."""
        contract = Contract(["\\valid(m)", "sane(m)", "0 <= t < m->now"], list(ALL))
        contract.ensures += ["sane(m)", LATCHED_KEPT, "m->now == t", STEPPED_BACK, KEPT_BY_TIME]
        return contract

    def _reach_deadline(self) -> Contract:
        """Return that what is due is settled at its own instant.

        A function of its own, so that the loop which calls it is proved from these few words.
        """
        due = ["is_end(m, m->due)", f"m->due <= {self.predicates.macro('LATEST')}"]
        contract = Contract(["\\valid(m)", "sane(m)", *due], list(ALL))
        contract.ensures += ["sane(m)", "is_end(m, m->due)", "m->now == \\old(m->due)"]
        contract.ensures += [LATCHED_KEPT, CAUGHT_UP, KEPT_BY_DEADLINES]
        return contract

    def _catch_up(self) -> Contract:
        latest = self.predicates.macro("LATEST")
        contract = Contract(["\\valid(m)", "sane(m)", f"m->now <= t <= {latest}"], list(ALL))
        contract.ensures += ["sane(m)", "m->now == t", LATCHED_KEPT, CAUGHT_UP, KEPT_BY_DEADLINES]
        return contract

    def loop(self) -> Contract:
        """Return the invariant of the loop over the deadlines that are due."""
        contract = Contract([], list(ALL), is_loop=True)
        since_call = [
            each.replace("Old", "Pre") for each in (LATCHED_KEPT, CAUGHT_UP, KEPT_BY_DEADLINES)
        ]
        contract.invariants += ["sane(m)", "is_end(m, m->due)", "m->now <= t", *since_call]
        contract.variant = "t - m->now"
        return contract

    def _pass(self) -> Contract:
        """Return that while nothing is due time alone passes, and all stays as it is."""
        latest = self.predicates.macro("LATEST")
        within = ["m->now <= t < m->due", f"t <= {latest}"]
        contract = Contract(["\\valid(m)", "sane(m)", *within], ["m->now"])
        contract.ensures += ["sane(m)", "m->now == t", LATCHED_KEPT, NOTHING_CHANGED]
        return contract

    def _arrive(self) -> Contract:
        contract = Contract(["\\valid(m)", "sane(m)"], list(ALL))
        contract.at_once += ["sane(m)", LATCHED_KEPT, "m->now == time_of(t)", KEPT_BY_TIME]
        contract.cases["back"] = "time_of(t) < m->now"
        contract.cases["due"] = "m->now <= time_of(t) && m->due <= time_of(t)"
        contract.cases["idle"] = IDLE
        contract.of_case["back"] = [STEPPED_BACK]
        contract.of_case["due"] = [CAUGHT_UP, KEPT_BY_DEADLINES]
        contract.of_case["idle"] = [NOTHING_CHANGED]
        return contract

    # Public functions ---------------------------------------------------------------------------

    def _public(self) -> Iterator[tuple[str, Contract]]:
        prefix = self._view.prefix
        clear = Contract(["\\valid(m)"], ["*m"])
        clear.ensures.append(all_of(self._started()))
        start = Contract(["\\valid(m)"], ["*m"])
        start.ensures += ["sane(m)", all_of(self._started()), "is_end(m, m->due)"]
        start.ensures.append(all_of(self.changes.as_new("time_of(m->now + time_of(grace))")))
        if self._view.constants:
            yield "are_valid", self._of_constants(clear, start)
        yield "clear", clear
        yield f"{prefix}_start", start
        for action in self._latched:
            active = self._layout.active[action.index]
            contract = Contract(["\\valid(m)", "sane(m)"], [f"m->{active}"])
            if action.index in self._watched:  # no rule has seen that it was not active
                contract.requires.append("m->started == 0")
            contract.ensures += ["sane(m)", f"m->{active} == 1"]
            yield f"{prefix}_latch_{action.name}", contract
        advance = Contract(["\\valid(m)", "sane(m)"], list(ALL))
        advance.ensures += ["sane(m)", "\\result == m->due", LATCHED_KEPT]
        advance.ensures += [
            "m->now == time_of(t)",
            KEPT_BY_TIME,
            f"{IDLE_BEFORE} ==> {NOTHING_CHANGED}",
        ]
        yield f"{prefix}_advance", advance
        yield f"{prefix}_waiting", self._waiting()
        if self._view.has_latched:
            yield f"{prefix}_reset", self._reset()
        for _, function, enabled in self._view.optional:
            contract = Contract(
                ["\\valid(m)", "sane(m)", "(enabled == 0 || enabled == 1)"],
                list(ALL),
            )
            contract.ensures += ["sane(m)", f"m->{enabled} == enabled", LATCHED_KEPT]
            contract.ensures.append("m->now == time_of(t)")
            contract.ensures.append(self.changes.kept_over_time_but([enabled]))
            yield function, contract
        messages = MessageContracts(self._view, self.predicates, self.changes, self._rules)
        for message in self._view.messages:
            yield from messages.contracts(message)

    def _of_constants(self, clear: Contract, start: Contract) -> Contract:
        """Add what the constants have to do with a start; return what their check ensures."""
        known = all_of(started_predicates(self._program, self._layout))
        given, default = "\\valid_read(constants)", f"&{self._view.prefix}_default_constants"
        clear.requires += [given, "\\separated(m, constants)"]
        clear.ensures.append(known)
        are_valid = iff("\\result != 0", all_of(each.predicate for each in self._view.constants))
        start.requires += [given, f"\\separated(m, constants, {default})"]
        start.ensures += [are_valid, f"\\result != 0 ==> {known}"]
        return Contract([given], ensures=[are_valid])

    def _waiting(self) -> Contract:
        fields = [each for t in self._view.timeouts for each in (t.came, t.missing)]
        contract = Contract(["\\valid_read(m)", *self.predicates.ranges(fields)])
        waits = " || ".join(
            f"(m->{each.came} == 0 && m->{each.missing} == 0)" for each in self._view.timeouts
        )
        contract.ensures.append(iff("\\result != 0", f"({waits or chr(92) + 'false'})"))
        return contract

    def _started(self) -> list[str]:
        """Return what all that a restart leaves alone is at the start."""
        layout, macro = self._layout, self.predicates.macro
        terms = [each for each in layout.terms.values() if each.known]
        zero = [each.known for each in terms]
        zero += [each.name for each in layout.findings.values()]
        zero += [each.known for each in layout.inputs.values() if each.known]
        zero += [*layout.active.values(), *layout.ran.values(), "started"]
        verdicts = [*layout.verdicts.values(), *layout.conditions.values()]
        found = ["m->owner == owner", "m->now == time_of(t)"]
        found += [f"m->{each} == {macro('UNKNOWN')}" for each in verdicts]
        found += [f"m->{each} == 0" for each in dict.fromkeys(zero)]
        found += [f"m->{each} == 1" for each in layout.enabled.values()]
        for term in terms:
            double = term.type == "double"
            found.append(f"same(m->{term.name}, (double)0.0)" if double else f"m->{term.name} == 0")
        return found

    def _reset(self) -> Contract:
        """Return what is reset; where it is an event of its own, whether anything is active."""
        contract = Contract(["\\valid(m)", "sane(m)"], list(ALL))
        contract.ensures += ["sane(m)", "m->now == time_of(t)", KEPT_BY_TIME]
        cleared = [f"m->{self._layout.active[each.index]} == 0" for each in self._latched]
        if self._view.watched_latched:
            contract.ensures.append(iff("\\result != 0", all_of(cleared)))
            return contract
        emitted = "\\old(emitted)"
        emissions = self.predicates.emissions
        states = []
        for action in self._latched:
            contract.ensures += self._rules.kept_called(action)
            active = f"m->{self._layout.active[action.index]}"
            emitted = emissions.by_settling(action, emitted, f"\\old({active})")
            over = emissions.over(action) or "\\true"
            contract.ensures.append(f"{over} ==> {active} == 0")
            states.append(f"({over} || {active} == \\old({active}))")
        contract.ensures.append(f"{IDLE_BEFORE} ==> {all_of([*states, f'emitted == {emitted}'])}")
        contract.ensures.append(iff("\\result != 0", all_of(cleared)))
        return contract
