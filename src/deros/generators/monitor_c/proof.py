"""What is to be proved of the emitted functions: their contracts in ACSL.

Between two calls a monitor is *sane*: its numbers are in range, no deadline lies before ``due``, no
timeout has passed unseen, every rule's verdict is what the rule means now (:mod:`.meaning`), and
every behaviour holds if its condition does. Each function is proved by itself, from the contracts
of those that it calls.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from deros.generators.monitor_c.contracts import Contract, all_of, iff
from deros.generators.monitor_c.handlers import Handler
from deros.generators.monitor_c.layout import Term
from deros.generators.monitor_c.predicates import SOUND, Predicates
from deros.generators.monitor_c.view import MonitorView
from deros.monitor import walk
from deros.monitor.ir import Action, Behaviour, For, Read, Rule, Trigger


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
    return Proof(writer.predicates.declarations(), contracts)


class _Writer:
    """Writes the contracts of one monitor."""

    def __init__(self, view: MonitorView) -> None:
        self._view = view
        self._program = view.program
        self._layout = view.layout
        self.predicates = Predicates(view)
        self._behaviours = tuple(walk.behaviours(view.program))

    # Contracts ----------------------------------------------------------------------------------

    def contracts(self) -> Iterator[tuple[str, Contract]]:
        """Yield the contract of every function."""
        for text in self._view.texts:
            contract = Contract(["\\valid_read(text + (0 .. length - 1))"])
            contract.ensures.append(f"\\result <= {len(text.texts)}")
            yield f"which_{text.name}", contract
        for forget in self._view.forgets:
            cleared = [f"m->{name}" for name in forget.known]
            contract = Contract(["\\valid(m)"], [*cleared, *(f"m->{n}" for n in forget.last)])
            contract.ensures += [f"{each} == 0" for each in cleared]
            contract.ensures += [f"\\result == 0 ==> {each} == \\old({each})" for each in cleared]
            yield forget.function, contract
        yield "earliest", self._earliest()
        for rule in self._program.rules:
            yield self._layout.judges[rule.index], self._judge(rule)
        for action in self._program.actions:
            if action.index in self._layout.active:
                yield f"settle_{action.name}", self._settle(action)
        for behaviour in self._behaviours:
            yield self._layout.behave[behaviour.index], self._behave(behaviour)
        yield "act", self._act()
        yield "evaluate", self._evaluate()
        if self._view.timeouts:
            yield "expire", self._expire()
        yield "restart", self._restart()
        yield "catch_up", self._catch_up()
        yield "arrive", self._arrive()
        yield from self._public()

    def _earliest(self) -> Contract:
        contract = Contract(["\\valid_read(m)", "ranged(m)", "unexpired(m)"])
        contract.ensures += ["\\result > m->now", "timeouts_in_time(m, \\result)"]
        contract.ensures.append("ends_in_time(m, \\result)")
        return contract

    def _judge(self, rule: Rule) -> Contract:
        name = self._layout.verdicts[rule.index]
        contract = Contract(["\\valid(m)"])
        contract.assigns += [f"m->{name}", f"m->{self._layout.turned[rule.index]}"]
        contract.ensures += ["ranged(m)", f"judged_{name}(m)"]
        contract.ensures.append(iff("\\result != 0", f"m->{name} != \\old(m->{name})"))
        self._with_intervals(contract, self.predicates.fors(rule.condition))
        return contract

    def _with_intervals(self, contract: Contract, fors: Iterable[For]) -> None:
        """Add what becomes of intervals: begun now, kept, or cleared; and in time."""
        contract.requires += ["ranged(m)", "ends_in_time(m, m->due)"]
        contract.ensures.append("ends_in_time(m, m->due)")
        unset = self.predicates.macro("UNSET")
        sinces = [self._layout.since[each.index] for each in fors]
        for since in sinces:
            contract.assigns.append(f"m->{since}")
            kept = f"(\\old(m->{since}) == {unset} ? m->now : \\old(m->{since}))"
            contract.ensures.append(f"m->{since} != {unset} ==> m->{since} == {kept}")
        if sinces:
            contract.assigns.append("m->due")
            contract.ensures.append("m->due <= \\old(m->due)")
            contract.ensures.append("\\old(m->due) > m->now ==> m->due > m->now")

    def _settle(self, action: Action) -> Contract:
        active = self._layout.active[action.index]
        holds = [self._layout.holds[each] for each in action.triggered_by]
        contract = Contract(["\\valid(m)", "ranged(m)"], [f"m->{active}"])
        called = " || ".join(f"m->{each} != 0" for each in holds) or "\\false"
        contract.ensures.append("ranged(m)")
        contract.ensures.append(f"({called}) ==> m->{active} == \\old(m->{active})")
        contract.ensures.append(f"!({called}) ==> m->{active} == 0")
        return contract

    def _closure(self, behaviour: Behaviour) -> list[Behaviour]:
        found = [behaviour]
        for item in behaviour.body:
            if isinstance(item, Behaviour):
                found += self._closure(item)
        return found

    def _behave(self, behaviour: Behaviour) -> Contract:
        return self._of_behaviours(self._closure(behaviour))

    def _of_behaviours(self, group: list[Behaviour]) -> Contract:
        """Return the contract of a function that runs some behaviours."""
        contract = Contract(["\\valid(m)"])
        contract.assigns += [f"m->{self._layout.holds[each.index]}" for each in group]
        contract.assigns += [f"m->{name}" for name in self._touched(group)]
        contract.ensures.append("ranged(m)")
        contract.ensures += [f"acted_{self._layout.behave[each.index]}(m)" for each in group]
        contract.ensures += self._done(group)
        fors = [each for one in group for each in self.predicates.fors(one.condition)]
        self._with_intervals(contract, fors)
        return contract

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
        holds = self._layout.holds[behaviour.index]
        return f"(m->{holds} != 0 && \\old(m->{holds}) == 0)"

    def _act(self) -> Contract:
        contract = self._of_behaviours(list(self._behaviours))
        done = set(self._done(list(self._behaviours)))
        contract.ensures[:] = [each for each in contract.ensures if each not in done]
        changed = (*self._layout.ran.values(), *self._layout.active.values())
        contract.assigns += [f"m->{name}" for name in changed]
        contract.ensures += ["acted(m)", *self._kept_latched(), *self._kept_called()]
        contract.ensures += self._begun()
        return contract

    def _kept_latched(self) -> list[str]:
        """Return that a latched action never clears by itself."""
        return [
            f"\\old(m->{self._layout.active[each.index]}) != 0"
            f" ==> m->{self._layout.active[each.index]} != 0"
            for each in self._program.actions
            if each.latched
        ]

    def _kept_called(self) -> Iterator[str]:
        """Yield that no action clears while a behaviour calls for it."""
        for each in self._program.actions:
            if each.reset_by is not None:
                active = self._layout.active[each.index]
                for index in each.triggered_by:
                    holds = self._layout.holds[index]
                    yield (f"\\old(m->{active}) != 0 && m->{holds} != 0 ==> m->{active} != 0")

    def _begun(self) -> Iterator[str]:
        """Yield that what a behaviour calls for becomes active when its condition turns true."""
        for behaviour in self._behaviours:
            for index, active in self._layout.active.items():
                if _triggers(behaviour, index):
                    yield f"{self._rises(behaviour)} ==> m->{active} != 0"

    def _evaluate(self) -> Contract:
        conditions = [each.condition for each in self._program.rules]
        conditions += [each.condition for each in self._behaviours]
        fors = [each for condition in conditions for each in self.predicates.fors(condition)]
        contract = Contract(["\\valid(m)"], ["m->started"])
        tables = (self._layout.verdicts, self._layout.turned, self._layout.holds)
        for table in (*tables, self._layout.active, self._layout.ran):
            contract.assigns += [f"m->{name}" for name in table.values()]
        contract.ensures += ["ranged(m)", "m->started == 1", "judged(m)", "acted(m)"]
        contract.ensures += self._kept_latched()
        self._with_intervals(contract, fors)
        return contract

    def _expire(self) -> Contract:
        contract = Contract(["\\valid(m)", "ranged(m)", "ends_in_time(m, m->due)"])
        forgets = {each.function: each for each in self._view.forgets}
        for each in self._view.timeouts:
            contract.assigns.append(f"m->{each.missing}")
            passed = f"m->{each.base} + {each.duration_ns} <= m->now"
            was = f"\\old(m->{each.missing}) != 0"
            contract.ensures.append(iff(f"m->{each.missing} != 0", f"({was} || {passed})"))
            if each.forget:
                forget = forgets[each.forget]
                contract.assigns += [f"m->{name}" for name in (*forget.known, *forget.last)]
                gone = f"(\\old(m->{each.missing}) == 0 && {passed})"
                contract.ensures += [
                    f"m->{name} == ({gone} ? 0 : \\old(m->{name}))" for name in forget.known
                ]
        contract.ensures += ["ranged(m)", "unexpired(m)", "ends_in_time(m, m->due)"]
        return contract

    def _restart(self) -> Contract:
        known = dict.fromkeys(name for each in self._view.forgets for name in each.known)
        last = [name for each in self._view.forgets for name in each.last]
        latest = self.predicates.macro("LATEST")
        contract = Contract(["\\valid(m)", "ranged_but_for_restart(m)"])
        contract.requires.append(f"m->now <= from <= {latest}")
        names = [each.name for each in self._view.fields if each.restarted]
        contract.assigns += [f"m->{name}" for name in (*names, *known, *last, "due")]
        contract.ensures += [*SOUND, "m->due > m->now"]
        contract.ensures += [f"m->{name} == 0" for name in known]
        return contract

    def _changing(self) -> list[str]:
        """Return the fields that the passing of time can change."""
        values = {term.name for term in self._layout.terms.values()}
        values |= {finding.name for finding in self._layout.findings.values()}
        fixed = {"owner", *values, *self._layout.enabled.values()}
        return [f"m->{each.name}" for each in self._view.fields if each.name not in fixed]

    def _catch_up(self) -> Contract:
        latest = self.predicates.macro("LATEST")
        contract = Contract(["\\valid(m)", "sane(m)", f"0 <= t <= {latest}"], self._changing())
        contract.ensures += ["sane(m)", "m->now == t", *self._kept_latched()]
        return contract

    def loop(self) -> Contract:
        """Return the invariant of the loop over the deadlines that are due."""
        contract = Contract([], self._changing(), is_loop=True)
        contract.invariants += ["sane(m)", "m->now <= t"]
        contract.invariants += [
            each.replace("\\old(", "\\at(").replace(") != 0 ==>", ", Pre) != 0 ==>", 1)
            for each in self._kept_latched()
        ]
        contract.variant = "t - m->now"
        return contract

    def _arrive(self) -> Contract:
        contract = Contract(["\\valid(m)", "sane(m)"], self._changing())
        latest = self.predicates.macro("LATEST")
        contract.ensures += ["sane(m)", *self._kept_latched()]
        contract.ensures.append(f"m->now == (t < 0 ? 0 : t > {latest} ? {latest} : t)")
        return contract

    # Public functions ---------------------------------------------------------------------------

    def _public(self) -> Iterator[tuple[str, Contract]]:
        prefix = self._view.prefix
        start = Contract(["\\valid(m)"], ["*m"])
        start.ensures += ["sane(m)", *(f"m->{n} == 0" for n in self._layout.active.values())]
        yield f"{prefix}_start", start
        for action in self._program.actions:
            if action.latched:
                active = self._layout.active[action.index]
                contract = Contract(["\\valid(m)", "sane(m)"], [f"m->{active}"])
                contract.ensures += ["sane(m)", f"m->{active} == 1"]
                yield f"{prefix}_latch_{action.name}", contract
        advance = Contract(["\\valid(m)", "sane(m)"], self._changing())
        advance.ensures += ["sane(m)", "\\result == m->due", *self._kept_latched()]
        yield f"{prefix}_advance", advance
        yield f"{prefix}_waiting", self._waiting()
        if self._view.has_latched:
            yield f"{prefix}_reset", self._reset()
        for _, function, enabled in self._view.optional:
            contract = Contract(
                ["\\valid(m)", "sane(m)", "(enabled == 0 || enabled == 1)"],
                [*self._changing(), f"m->{enabled}"],
            )
            contract.ensures += ["sane(m)", f"m->{enabled} == enabled", *self._kept_latched()]
            yield function, contract
        for message in self._view.messages:
            if message.handler.observer:
                yield message.handler.observer, self._observe(message.handler)
            yield message.handler.function, self._message(message.handler.function)

    def _waiting(self) -> Contract:
        contract = Contract(["\\valid_read(m)", "ranged(m)"])
        waits = " || ".join(
            f"(m->{each.came} == 0 && m->{each.missing} == 0)" for each in self._view.timeouts
        )
        contract.ensures.append(iff("\\result != 0", f"({waits or chr(92) + 'false'})"))
        return contract

    def _reset(self) -> Contract:
        contract = Contract(["\\valid(m)", "sane(m)"], self._changing())
        contract.ensures.append("sane(m)")
        actives = []
        for each in self._program.actions:
            if each.latched:
                active = self._layout.active[each.index]
                actives.append(f"m->{active} == 0")
                for index in each.triggered_by:
                    holds = self._layout.holds[index]
                    contract.ensures.append(
                        f"\\old(m->{active}) != 0 && m->{holds} != 0 ==> m->{active} != 0"
                    )
        contract.ensures.append(iff("\\result != 0", all_of(actives)))
        return contract

    def _message(self, function: str) -> Contract:
        handler = next(m.handler for m in self._view.messages if m.handler.function == function)
        contract = Contract(["\\valid(m)", "sane(m)"], self._changing())
        contract.requires += self._arrays(handler)
        contract.assigns += [f"m->{name}" for name in self._stored(handler)]
        contract.ensures += ["sane(m)", "m->started == 1", *self._kept_latched()]
        return contract

    def _stored(self, handler: Handler) -> list[str]:
        """Return the fields that hold what a message says."""
        terms = [term for index in handler.inputs for term in self._layout.terms_of(index)]
        findings = self._layout.findings.values()
        found = [each.name for each in findings if each.inputs & set(handler.inputs)]
        return [*(term.name for term in terms), *found]

    def _observe(self, handler: Handler) -> Contract:
        """Return what a message's values become: known, compared, and heard in time."""
        terms = [term for index in handler.inputs for term in self._layout.terms_of(index)]
        memories = [
            each for index in handler.inputs for each in self._layout.memories_of(index).values()
        ]
        fields = [self._layout.inputs[index] for index in handler.inputs]
        bases = [name for each in fields for name in (each.base, each.came) if name]
        flags = [each.missing for each in fields if each.missing]
        flags += [term.known for term in terms]
        stored = self._stored(handler)
        contract = Contract(["\\valid(m)", *SOUND, *self._arrays(handler)])
        contract.assigns += [f"m->{name}" for name in (*bases, *flags, *stored)]
        contract.assigns += [f"m->{name}" for each in memories for name in (each.last, each.last_t)]
        contract.ensures += [*SOUND, *self._says_nothing_new(handler, [*flags, *stored])]
        contract.checked += self._values_of(handler)
        if bases:
            contract.assigns.append("m->due")
            contract.ensures.append("m->due <= \\old(m->due)")
            contract.ensures.append("\\old(m->due) > m->now ==> m->due > m->now")
        return contract

    def _says_nothing_new(self, handler: Handler, names: list[str]) -> Iterator[str]:
        """Yield that all that rules read is as it was, if a message is said to bring no news."""
        floats = {t.name for t in self._layout.terms.values() if t.type == "double"}
        aged = {end.base for end in self._view.ends}
        for index in handler.inputs:
            fields = self._layout.inputs[index]
            if fields.base in aged:
                names = [*names, fields.base, fields.came]
        for name in dict.fromkeys(names):
            if name not in floats:
                yield f"\\result == 0 ==> m->{name} == \\old(m->{name})"

    def _values_of(self, handler: Handler) -> Iterator[str]:
        """Yield how what is stored comes from the message, and what is found from it."""
        for condition, finding in self._layout.findings.items():
            if finding.inputs & set(handler.inputs):
                flags = dict.fromkeys(f"m->{term.known} != 0" for term in finding.terms)
                compares = iff(f"m->{finding.name} != 0", self.predicates.meaning.holds(condition))
                yield f"({' && '.join(flags)} ==> {compares})"
        names = {leaf: each.name for each in handler.parameters for leaf in each.leaves}
        for index in handler.inputs:
            for term in self._layout.terms_of(index):
                if isinstance(term.value, Read) and not term.texts:
                    yield from self._value_of(term, names[term.value.leaf])

    def _value_of(self, term: Term, name: str) -> Iterator[str]:
        if term.type == "double":
            yield f"(\\is_NaN({name}) ==> m->{term.known} == 0)"
            yield f"(m->{term.known} != 0 ==> \\eq_double(m->{term.name}, {name}))"
        else:
            yield f"(m->{term.known} != 0 ==> m->{term.name} == {name})"

    def _arrays(self, handler: Handler) -> Iterator[str]:
        for parameter in handler.parameters:
            name = parameter.name
            extent = {
                "array": f"{name} + (0 .. {name}_count - 1)",
                "text": f"{name} + (0 .. {name}_length - 1)",
            }.get(parameter.form)
            if extent:
                yield f"\\valid_read({extent})"
                yield f"\\separated(m, {extent})"


def _triggers(behaviour: Behaviour, action: int) -> bool:
    return any(isinstance(item, Trigger) and item.action == action for item in behaviour.body)
