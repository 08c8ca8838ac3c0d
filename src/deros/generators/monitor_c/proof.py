"""What is to be proved of the emitted functions: their contracts in ACSL.

Between two calls a monitor is *sane*: its numbers are in range, no deadline lies before ``due``, no
timeout has passed unseen, every rule's verdict is what the rule means now (:mod:`.meaning`), and
every behaviour holds if its condition does. Each function is proved by itself, from the contracts
of those that it calls.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from deros.generators.monitor_c.contracts import Contract, all_of, iff
from deros.generators.monitor_c.handlers import Handler
from deros.generators.monitor_c.layout import Term
from deros.generators.monitor_c.predicates import BY_JUDGING, BY_TIME, SOUND, Predicates
from deros.generators.monitor_c.rule_contracts import RuleContracts, with_earlier_deadline
from deros.generators.monitor_c.view import MessageView, MonitorView, Timeout
from deros.monitor import walk
from deros.monitor.ir import Read

_FIELD = re.compile(r"m->(\w+)")


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
        self._rules = RuleContracts(view, self.predicates)
        self._behaviours = tuple(walk.behaviours(view.program))
        self._latched = [each for each in view.program.actions if each.latched]

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
            yield self._layout.judges[rule.index], self._rules.judge(rule)
        for action in self._program.actions:
            if action.index in self._layout.active:
                yield f"settle_{action.name}", self._rules.settle(action)
        for behaviour in self._behaviours:
            yield self._layout.behave[behaviour.index], self._rules.behave(behaviour)
        yield "act", self._rules.act()
        yield "evaluate", self._rules.evaluate()
        for timeout in self._view.timeouts:
            yield timeout.function, self._expire_one(timeout)
        if self._view.timeouts:
            yield "expire", self._expire()
        yield "restart", self._restart()
        yield "catch_up", self._catch_up()
        yield "arrive", self._arrive()
        yield from self._public()

    def _earliest(self) -> Contract:
        fields = [
            each for end in self._view.ends for each in (end.base, *_FIELD.findall(end.condition))
        ]
        fields += [each for t in self._view.timeouts for each in (t.base, t.missing)]
        ranges = self.predicates.ranges(dict.fromkeys(["now", *fields]))
        contract = Contract(["\\valid_read(m)", all_of(ranges), "unexpired(m)"])
        contract.ensures += ["\\result > m->now", "timeouts_in_time(m, \\result)"]
        contract.ensures.append("ends_in_time(m, \\result)")
        return contract

    def _expire_one(self, timeout: Timeout) -> Contract:
        """Return that an input is missing if its timeout has passed, and its values with it."""
        missing = f"m->{timeout.missing}"
        ranges = self.predicates.ranges(["now", timeout.base, timeout.missing])
        contract = Contract(["\\valid(m)", all_of(ranges)], [missing])
        passed = f"m->{timeout.base} + {timeout.duration_ns} <= m->now"
        contract.ensures += self.predicates.ranges([timeout.missing])
        contract.ensures.append(iff(f"{missing} != 0", f"(\\old({missing}) != 0 || {passed})"))
        for forget in self._view.forgets:
            if forget.function == timeout.forget:
                contract.assigns += [f"m->{name}" for name in (*forget.known, *forget.last)]
                gone = f"(\\old({missing}) == 0 && {passed})"
                contract.ensures += [
                    f"m->{name} == ({gone} ? 0 : \\old(m->{name}))" for name in forget.known
                ]
        return contract

    def _expire(self) -> Contract:
        contract = Contract(["\\valid(m)", "ranged(m)"])
        for each in map(self._expire_one, self._view.timeouts):
            contract.assigns += each.assigns
        contract.ensures += ["ranged(m)", "unexpired(m)"]
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

    def _catch_up(self) -> Contract:
        latest = self.predicates.macro("LATEST")
        contract = Contract(["\\valid(m)", "sane(m)", f"0 <= t <= {latest}"], [BY_TIME])
        contract.ensures += ["sane(m)", "m->now == t", *self._rules.kept_latched()]
        return contract

    def loop(self) -> Contract:
        """Return the invariant of the loop over the deadlines that are due."""
        contract = Contract([], [BY_TIME], is_loop=True)
        kept = self._rules.kept_latched("\\at({}, Pre)")
        contract.invariants += ["sane(m)", "m->now <= t", *kept]
        contract.variant = "t - m->now"
        return contract

    def _arrive(self) -> Contract:
        contract = Contract(["\\valid(m)", "sane(m)"], [BY_TIME])
        latest = self.predicates.macro("LATEST")
        now = f"(t < 0 ? 0 : t > {latest} ? {latest} : t)"
        contract.ensures += ["sane(m)", *self._rules.kept_latched(), f"m->now == {now}"]
        contract.cases["back"] = f"{now} < m->now"
        contract.cases["due"] = f"m->now <= {now} && m->due <= {now}"
        contract.cases["idle"] = f"m->now <= {now} < m->due"
        return contract

    # Public functions ---------------------------------------------------------------------------

    def _public(self) -> Iterator[tuple[str, Contract]]:
        prefix = self._view.prefix
        start = Contract(["\\valid(m)"], ["*m"])
        start.ensures += ["sane(m)", *(f"m->{n} == 0" for n in self._layout.active.values())]
        yield f"{prefix}_start", start
        for action in self._latched:
            active = self._layout.active[action.index]
            contract = Contract(["\\valid(m)", "sane(m)"], [f"m->{active}"])
            contract.ensures += ["sane(m)", f"m->{active} == 1"]
            yield f"{prefix}_latch_{action.name}", contract
        advance = Contract(["\\valid(m)", "sane(m)"], [BY_TIME])
        advance.ensures += ["sane(m)", "\\result == m->due", *self._rules.kept_latched()]
        yield f"{prefix}_advance", advance
        yield f"{prefix}_waiting", self._waiting()
        if self._view.has_latched:
            yield f"{prefix}_reset", self._reset()
        for _, function, enabled in self._view.optional:
            contract = Contract(
                ["\\valid(m)", "sane(m)", "(enabled == 0 || enabled == 1)"],
                [BY_TIME, f"m->{enabled}"],
            )
            contract.ensures += ["sane(m)", f"m->{enabled} == enabled", *self._rules.kept_latched()]
            yield function, contract
        for message in self._view.messages:
            if message.handler.observer:
                yield message.handler.observer, self._observe(message.handler)
            if len(message.judges) > 1:
                yield message.judge, self._rules.judge_by(message)
            if message.after:
                yield message.after, self._after(message)
            yield message.handler.function, self._message(message.handler)

    def _waiting(self) -> Contract:
        fields = [each for t in self._view.timeouts for each in (t.came, t.missing)]
        contract = Contract(["\\valid_read(m)", *self.predicates.ranges(fields)])
        waits = " || ".join(
            f"(m->{each.came} == 0 && m->{each.missing} == 0)" for each in self._view.timeouts
        )
        contract.ensures.append(iff("\\result != 0", f"({waits or chr(92) + 'false'})"))
        return contract

    def _reset(self) -> Contract:
        contract = Contract(["\\valid(m)", "sane(m)"], [BY_TIME])
        contract.ensures.append("sane(m)")
        for action in self._latched:
            contract.ensures += self._rules.kept_called(action)
        cleared = [f"m->{self._layout.active[each.index]} == 0" for each in self._latched]
        contract.ensures.append(iff("\\result != 0", all_of(cleared)))
        return contract

    def _after(self, message: MessageView) -> Contract:
        """Return that all is judged anew that a message can have changed."""
        contract = Contract(["\\valid(m)", *SOUND, "m->due > m->now"], [BY_JUDGING])
        names = self._layout.verdicts
        others = [f"judged_{name}(m)" for each, name in names.items() if each not in message.rules]
        touched = [f"judged_{names[each]}(m)" for each in message.rules]
        contract.requires.append(f"m->started != 0 ==> {all_of([*others, 'acted(m)'])}")
        contract.requires.append(f"m->started != 0 && news == 0 ==> {all_of(touched)}")
        contract.ensures += self._settled()
        contract.cases["first"] = "m->started == 0"
        contract.cases["news"] = "m->started != 0 && news != 0"
        contract.cases["none"] = "m->started != 0 && news == 0"
        return contract

    def _message(self, handler: Handler) -> Contract:
        contract = Contract(["\\valid(m)", "sane(m)"], [BY_TIME])
        contract.requires += self._arrays(handler)
        contract.assigns += [f"m->{name}" for name in self._stored(handler)]
        contract.ensures += self._settled()
        return contract

    def _settled(self) -> list[str]:
        """Return that a monitor is sane and has judged, in parts: each is a proof of its own."""
        parts = [*SOUND, "m->due > m->now", "m->started == 1", "judged(m)", "acted(m)"]
        return [*parts, *self._rules.kept_latched()]

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
        changed = [*bases, *flags, *stored]
        changed += [name for each in memories for name in (each.last, each.last_t)]
        own = self.predicates.ranges(["now", *dict.fromkeys(changed)])
        own += self.predicates.timeouts_in_time("m->due", bases)
        own += self.predicates.ends_in_time("m->due", bases)
        own += self.predicates.unexpired(bases)
        contract = Contract(["\\valid(m)", all_of(own), *self._arrays(handler)])
        contract.assigns += [f"m->{name}" for name in changed]
        contract.ensures += [*own, *self._says_nothing_new(handler, [*flags, *stored])]
        contract.checked += self._values_of(handler)
        if bases:
            with_earlier_deadline(contract)
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
