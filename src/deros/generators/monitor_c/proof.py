"""What is to be proved of the emitted functions: their contracts in ACSL.

Between two calls a monitor is *sane*: its numbers are in range, no deadline lies before ``due``, no
timeout has passed unseen, every rule's verdict is what the rule means now (:mod:`.meaning`), and
every behaviour holds if its condition does. Each function is proved by itself, from the contracts
of those that it calls.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from deros.generators.monitor_c.contracts import Contract, all_of, iff
from deros.generators.monitor_c.handlers import Handler
from deros.generators.monitor_c.layout import Term
from deros.generators.monitor_c.meaning import Meaning
from deros.generators.monitor_c.view import MonitorView
from deros.monitor import walk
from deros.monitor.ir import Action, Behaviour, Condition, For, Read, Rule, Trigger


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
    return Proof(writer.declarations(), contracts)


class _Writer:
    """Writes the predicates and contracts of one monitor."""

    def __init__(self, view: MonitorView) -> None:
        self._view = view
        self._program = view.program
        self._layout = view.layout
        self._meaning = Meaning(view.layout)
        self._behaviours = tuple(walk.behaviours(view.program))
        self._types = {each.name: each.type.strip() for each in view.fields}
        self._rule_fors = {each.index: _fors(each.condition, self) for each in self._program.rules}
        self._fors = {each.index: _fors(each.condition, self) for each in self._behaviours}

    def is_timed(self, condition: For) -> bool:
        """Tell whether an interval is remembered."""
        return condition.index in self._layout.since

    # Predicates ---------------------------------------------------------------------------------

    def declarations(self) -> str:
        """Return the predicates that say what the rules mean, and what a sane monitor is."""
        monitor = f"{self._view.prefix}_monitor *m"
        verdicts = " || ".join(f"v == {self._macro(each)}" for each in ("FALSE", "UNKNOWN", "TRUE"))
        lines = ["/* What the rules mean, and what holds of a monitor between two calls. */"]
        lines.append(f"/*@ predicate is_verdict(integer v) = {verdicts};")
        for name, parts in self._predicates():
            lines.append(f"    predicate {name}({monitor}) =")
            lines += [f"      {part}{'' if last else ' &&'}" for part, last in _marked(parts)]
            lines[-1] += ";"
        lines[-1] += " */"
        return "\n".join(lines) + "\n\n"

    def _predicates(self) -> Iterator[tuple[str, list[str]]]:
        for rule in self._program.rules:
            name = self._layout.verdicts[rule.index]
            yield f"true_{name}", [self._meaning.true(rule.condition)]
            yield f"false_{name}", [self._meaning.false(rule.condition)]
        yield "ranged", self._ranges(self._types)
        yield "in_time", [*self._timeouts_in_time(), *self._ends_in_time()] or ["\\true"]
        yield "unexpired", self._unexpired() or ["\\true"]
        yield "judged", [each for rule in self._program.rules for each in self._judged(rule)]
        yield "acted", [each for one in self._behaviours for each in self._acted(one)]
        settled = "(m->started != 0 ==> judged(m) && acted(m))"
        yield "sane", ["ranged(m)", "in_time(m)", "unexpired(m)", "m->due > m->now", settled]

    def _macro(self, name: str) -> str:
        return f"{self._view.macro}_{name}"

    def _ranges(self, names: Iterable[str]) -> list[str]:
        """Return what each of the named fields is in."""
        latest, unset = self._macro("LATEST"), self._macro("UNSET")
        sinces = set(self._layout.since.values())
        turned = set(self._layout.turned.values())
        values = {term.name for term in self._layout.terms.values()}
        found = []
        for name in names:
            kind = self._types[name]
            if name in sinces:
                found.append(f"(m->{name} == {unset} || 0 <= m->{name} <= m->now)")
            elif kind == "bool":
                found.append(f"(m->{name} == 0 || m->{name} == 1)")
            elif kind.endswith("_verdict"):
                found.append(f"is_verdict(m->{name})")
            elif kind == "int64_t" and name not in values and name not in turned and name != "due":
                found.append(f"0 <= m->{name} <= {latest}")
        return found

    def _timeouts_in_time(self) -> list[str]:
        return [
            f"(m->{each.missing} == 0 ==> m->due <= m->{each.base} + {each.duration_ns})"
            for each in self._view.timeouts
        ]

    def _ends_in_time(self) -> list[str]:
        return [f"({pending} ==> m->due <= {end})" for pending, end in self._pending()]

    def _pending(self) -> Iterator[tuple[str, str]]:
        """Yield when an end lies ahead, and the end."""
        for each in self._view.ends:
            end = f"m->{each.base} + {each.wait_ns}"
            condition = each.condition if "!=" in each.condition else f"{each.condition} != 0"
            yield f"{condition} && {end} > m->now", end

    def _for_in_time(self, condition: For) -> str:
        since = self._layout.since[condition.index]
        end = f"m->{since} + {condition.duration_ns}"
        unset = self._macro("UNSET")
        return f"(m->{since} != {unset} && {end} > m->now ==> m->due <= {end})"

    def _unexpired(self) -> list[str]:
        return [
            f"(m->{each.missing} == 0 ==> m->{each.base} + {each.duration_ns} > m->now)"
            for each in self._view.timeouts
        ]

    def _judged(self, rule: Rule) -> list[str]:
        """Return that a rule's verdict is what it means, and its intervals run if they must."""
        name = self._layout.verdicts[rule.index]
        return [
            *(self._runs(each) for each in self._rule_fors[rule.index]),
            iff(f"m->{name} == {self._macro('TRUE')}", f"true_{name}(m)"),
            iff(f"m->{name} == {self._macro('FALSE')}", f"false_{name}(m)"),
        ]

    def _runs(self, condition: For) -> str:
        since = self._layout.since[condition.index]
        operand = self._meaning.true(condition.operand)
        return iff(f"m->{since} != {self._macro('UNSET')}", operand)

    def _acted(self, behaviour: Behaviour) -> list[str]:
        """Return that a behaviour holds if its condition does, within what encloses it."""
        tests = [self._meaning.true(behaviour.condition)]
        if behaviour.parent is not None:
            tests.append(f"m->{self._layout.holds[behaviour.parent]} != 0")
        if behaviour.optional:
            tests.append(f"m->{self._layout.enabled[behaviour.index]} != 0")
        runs = [self._runs(each) for each in self._fors[behaviour.index]]
        return [*runs, iff(f"m->{self._layout.holds[behaviour.index]} != 0", all_of(tests))]

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
        names = ["now", *self._layout.since.values()]
        for fields in self._layout.inputs.values():
            names += [name for name in (fields.base, fields.came, fields.missing) if name]
        contract = Contract(["\\valid_read(m)", *self._ranges(names), "unexpired(m)"])
        contract.ensures.append("\\result > m->now")
        for each in self._view.timeouts:
            end = f"m->{each.base} + {each.duration_ns}"
            contract.ensures.append(f"m->{each.missing} == 0 ==> \\result <= {end}")
        contract.ensures += [f"{p} ==> \\result <= {end}" for p, end in self._pending()]
        return contract

    def _judge(self, rule: Rule) -> Contract:
        name, fors = self._layout.verdicts[rule.index], self._rule_fors[rule.index]
        sinces = [self._layout.since[each.index] for each in fors]
        reads = self._fields_read(rule.condition)
        contract = Contract(["\\valid(m)", *self._ranges(dict.fromkeys(["now", name, *reads]))])
        contract.requires += [self._for_in_time(each) for each in fors]
        contract.assigns += [f"m->{name}", f"m->{self._layout.turned[rule.index]}"]
        contract.ensures += [*self._ranges([name]), *self._judged(rule)]
        contract.ensures.append(iff("\\result != 0", f"m->{name} != \\old(m->{name})"))
        self._with_intervals(contract, fors, sinces)
        return contract

    def _with_intervals(self, contract: Contract, fors: list[For], sinces: list[str]) -> None:
        """Add what becomes of intervals: begun now, kept, or cleared; and in time."""
        if not fors:
            return
        unset = self._macro("UNSET")
        contract.assigns += [*(f"m->{since}" for since in sinces), "m->due"]
        contract.ensures += self._ranges(sinces)
        for each, since in zip(fors, sinces, strict=True):
            running = f"m->{since} != {unset}"
            kept = f"(\\old(m->{since}) == {unset} ? m->now : \\old(m->{since}))"
            contract.ensures.append(f"{running} ==> m->{since} == {kept}")
            contract.ensures.append(self._for_in_time(each))
        contract.ensures.append("m->due <= \\old(m->due)")
        contract.ensures.append("\\old(m->due) > m->now ==> m->due > m->now")

    def _fields_read(self, condition: Condition) -> list[str]:
        """Return the fields that a condition reads, of those whose range matters."""
        text = self._meaning.true(condition) + self._meaning.false(condition)
        names = [name for name in self._types if re.search(rf"m->{name}\b", text)]
        names += [self._layout.since[each.index] for each in _fors(condition, self)]
        return list(dict.fromkeys(names))

    def _settle(self, action: Action) -> Contract:
        active = self._layout.active[action.index]
        holds = [self._layout.holds[each] for each in action.triggered_by]
        contract = Contract(["\\valid(m)", *self._ranges([active, *holds])], [f"m->{active}"])
        called = " || ".join(f"m->{each} != 0" for each in holds) or "\\false"
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
        names: dict[str, None] = {"now": None}
        fors = [each for one in group for each in self._fors[one.index]]
        touched = self._touched(group)
        for each in group:
            names.update(dict.fromkeys(self._fields_read(each.condition)))
            names[self._layout.holds[each.index]] = None
            if each.parent is not None:
                names[self._layout.holds[each.parent]] = None
            if each.optional:
                names[self._layout.enabled[each.index]] = None
        contract.requires += self._ranges([*names, *touched])
        contract.requires += [self._for_in_time(each) for each in fors]
        contract.assigns += [f"m->{self._layout.holds[each.index]}" for each in group]
        contract.assigns += [f"m->{name}" for name in touched]
        held = [self._layout.holds[each.index] for each in group]
        contract.ensures += [*self._ranges(held), *self._ranges(touched)]
        contract.ensures += [part for each in group for part in self._acted(each)]
        contract.ensures += self._done(group)
        self._with_intervals(contract, fors, [self._layout.since[each.index] for each in fors])
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
        rans = list(self._layout.ran.values())
        actives = list(self._layout.active.values())
        contract.requires += self._ranges(actives)
        contract.assigns += [f"m->{name}" for name in (*rans, *actives)]
        contract.ensures += [*self._ranges(rans), *self._ranges(actives)]
        contract.ensures += [*self._kept_latched(), *self._kept_called(), *self._begun()]
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
        fors = [
            each
            for group in (self._rule_fors, self._fors)
            for own in group.values()
            for each in own
        ]
        sinces = [self._layout.since[each.index] for each in fors]
        contract = Contract(["\\valid(m)", "ranged(m)", *map(self._for_in_time, fors)])
        contract.assigns += [
            "m->started",
            *(f"m->{name}" for name in self._layout.verdicts.values()),
            *(f"m->{name}" for name in self._layout.turned.values()),
            *(f"m->{name}" for name in self._layout.holds.values()),
            *(f"m->{name}" for name in self._layout.active.values()),
            *(f"m->{name}" for name in self._layout.ran.values()),
        ]
        contract.ensures += ["ranged(m)", "m->started == 1", "judged(m)", "acted(m)"]
        contract.ensures += self._kept_latched()
        self._with_intervals(contract, fors, sinces)
        if not fors:
            contract.ensures.append("m->due == \\old(m->due)")
        return contract

    def _expire(self) -> Contract:
        contract = Contract(["\\valid(m)", "ranged(m)"])
        known: dict[str, None] = {}
        last: list[str] = []
        for each in self._view.timeouts:
            contract.assigns.append(f"m->{each.missing}")
            passed = f"m->{each.base} + {each.duration_ns} <= m->now"
            was = f"\\old(m->{each.missing}) != 0"
            contract.ensures.append(iff(f"m->{each.missing} != 0", f"({was} || {passed})"))
            for forget in self._view.forgets:
                if forget.function == each.forget:
                    known.update(dict.fromkeys(forget.known))
                    last += forget.last
                    gone = f"(\\old(m->{each.missing}) == 0 && {passed})"
                    contract.ensures += [
                        f"m->{name} == ({gone} ? 0 : \\old(m->{name}))" for name in forget.known
                    ]
        contract.assigns += [f"m->{name}" for name in (*known, *last)]
        contract.ensures += ["ranged(m)", "unexpired(m)"]
        return contract

    def _restart(self) -> Contract:
        known = dict.fromkeys(name for each in self._view.forgets for name in each.known)
        last = [name for each in self._view.forgets for name in each.last]
        contract = Contract(["\\valid(m)", *self._ranges(["now"])])
        contract.requires.append(f"m->now <= from <= {self._macro('LATEST')}")
        names = [each.name for each in self._view.fields if each.restarted]
        contract.assigns += dict.fromkeys(f"m->{n}" for n in (*names, *known, *last, "due"))
        contract.ensures += self._ranges([*names, *known])
        contract.ensures += [f"m->{name} == 0" for name in known]
        contract.ensures += ["in_time(m)", "unexpired(m)", "m->due > m->now"]
        return contract

    def _changing(self) -> list[str]:
        """Return the fields that the passing of time can change."""
        values = {term.name for term in self._layout.terms.values()}
        values |= {finding.name for finding in self._layout.findings.values()}
        fixed = {"owner", *values, *self._layout.enabled.values()}
        return [f"m->{each.name}" for each in self._view.fields if each.name not in fixed]

    def _catch_up(self) -> Contract:
        latest = self._macro("LATEST")
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
        latest = self._macro("LATEST")
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
        fields = [name for each in self._view.timeouts for name in (each.came, each.missing)]
        contract = Contract(["\\valid_read(m)", *self._ranges(fields)])
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
        fields = [self._layout.inputs[index] for index in handler.inputs]
        bases = [name for each in fields for name in (each.base, each.came, each.missing) if name]
        known = list(
            dict.fromkeys(
                term.known for index in handler.inputs for term in self._layout.terms_of(index)
            )
        )
        memories = [
            each for index in handler.inputs for each in self._layout.memories_of(index).values()
        ]
        lasts = [each.last_t for each in memories]
        contract = Contract(["\\valid(m)", *self._ranges(["now", *bases, *known, *lasts])])
        contract.requires += self._arrays(handler)
        contract.requires += self._heard_in_time(handler)
        stored = self._stored(handler)
        contract.assigns += [f"m->{name}" for name in (*bases, *known, *stored, *lasts)]
        contract.assigns += [f"m->{each.last}" for each in memories]
        contract.assigns += ["m->due"] if bases else []
        contract.ensures += self._ranges([*bases, *known, *lasts, *stored])
        contract.ensures += self._heard_in_time(handler)
        contract.checked += self._values_of(handler)
        if bases:
            contract.ensures.append("m->due <= \\old(m->due)")
            contract.ensures.append("\\old(m->due) > m->now ==> m->due > m->now")
        return contract

    def _heard_in_time(self, handler: Handler) -> Iterator[str]:
        bases = {self._layout.inputs[index].base for index in handler.inputs}
        for each in self._view.timeouts:
            if each.base in bases:
                yield f"(m->{each.missing} == 0 ==> m->due <= m->{each.base} + {each.duration_ns})"
                yield f"(m->{each.missing} == 0 ==> m->{each.base} + {each.duration_ns} > m->now)"
        for one in self._view.ends:
            if one.base in bases:
                end = f"m->{one.base} + {one.wait_ns}"
                yield f"({one.condition} != 0 && {end} > m->now ==> m->due <= {end})"

    def _values_of(self, handler: Handler) -> Iterator[str]:
        """Yield how what is stored comes from the message, and what is found from it."""
        for condition, finding in self._layout.findings.items():
            if finding.inputs & set(handler.inputs):
                flags = dict.fromkeys(f"m->{term.known} != 0" for term in finding.terms)
                compares = iff(f"m->{finding.name} != 0", self._meaning.holds(condition))
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


def _fors(condition: Condition, writer: _Writer) -> list[For]:
    return [
        part for part in walk.parts(condition) if isinstance(part, For) and writer.is_timed(part)
    ]


def _triggers(behaviour: Behaviour, action: int) -> bool:
    return any(isinstance(item, Trigger) and item.action == action for item in behaviour.body)


def _marked(parts: list[str]) -> Iterator[tuple[str, bool]]:
    for number, part in enumerate(parts, 1):
        yield part, number == len(parts)
