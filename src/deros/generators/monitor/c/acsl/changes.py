r"""Changes of a monitor between two points in time, as predicates in ACSL.

The earlier point is that of the call in a contract (``\old``), and ``Before`` in a predicate.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from deros.generators.monitor.c.acsl.contracts import all_of, any_of, iff
from deros.generators.monitor.c.acsl.predicates import Predicates, predicate
from deros.generators.monitor.c.acsl.terms import constant
from deros.generators.monitor.c.code.view import Forget, MonitorView, Timeout
from deros.rules.program.ir import For, Once, Rule, Since, Times


class Changes:
    """Prints predicates on one monitor as it is and as it was."""

    def __init__(self, view: MonitorView, predicates: Predicates) -> None:
        """Use the names of a layout."""
        self._view = view
        self._layout = view.layout
        self._predicates = predicates
        self._emissions = predicates.emissions
        self._types = {each.name: each.type.strip() for each in view.fields}

    def declarations(self) -> str:
        """Return the predicates."""
        lines = ["/* What has become of a monitor since an earlier moment. */"]
        for name, parts in self._changes():
            texts = [_since(part) for part in parts]
            lines += predicate(self._layout.prefix, name, texts, labels="{Before, Now}")
        return "\n".join([*lines, ""])

    def _changes(self) -> Iterator[tuple[str, list[str]]]:
        """Yield the predicates."""
        rules = self._view.program.rules
        yield "verdicts_dated", [self.turned(rule) for rule in rules]
        fors, onces = self._predicates.all_fors(), self._predicates.all_onces()
        kept = [each for one in self._predicates.all_sinces() for each in self.kept(one)]
        timed = (fors, onces, self._predicates.all_counts())
        yield "intervals_run_on", [*(self.run_on(*timed) if any(timed) else []), *kept]
        yield "states_done", self.states_done()
        yield "emission_done", self.emission_done()
        yield "nothing_done", self.nothing_done()
        yield "nothing_changed", [self.same(self._all_but(["now"])), "emitted == \\old(emitted)"]
        yield "latched_kept", self.latched_kept()
        yield "kept_by_judging", [self.same(self._all_but(self._judged()))]
        yield "kept_by_deadlines", [self.same(self._all_but(self._settled()))]
        yield "kept_by_time", [self.same(self._lasting())]
        yield "caught_up", self._caught_up()
        yield "stepped_back", self._stepped_back()

    def turned(self, rule: Rule) -> str:
        """Return when a rule last became true or ceased to be."""
        verdict, turned = self._layout.verdicts[rule.index], self._layout.turned[rule.index]
        true = self._macro("TRUE")
        turns = (
            f"(m->{verdict} == {true} && \\old(m->{verdict}) != {true}) || "
            f"(m->{verdict} != {true} && \\old(m->{verdict}) == {true})"
        )
        return f"m->{turned} == ({turns} ? m->now : \\old(m->{turned}))"

    def run_on(
        self, fors: Iterable[For], onces: Iterable[Once], counts: Iterable[Times]
    ) -> Iterator[str]:
        """Yield that intervals begin now or continue, and that the next deadline is not later."""
        unset, due = self._macro("UNSET"), "\\old(m->due)"
        kept = []
        for each in fors:
            since = self._layout.since[each.index]
            was = f"\\old(m->{since})"
            start = f"({was} == {unset} ? m->now : {was})"
            kept.append(f"(m->{since} != {unset} ==> m->{since} == {start})")
            end = f"m->now + {each.duration_ns}"
            begins = f"({was} == {unset} && m->{since} != {unset} ? {end} : {self._macro('NEVER')})"
            due = f"\\min({due}, {begins})"
        never = self._macro("NEVER")
        for once in onces:
            until = self._layout.until[once.index]
            was = f"\\old(m->{until})"
            kept.append(f"({self._predicates.semantics.until(once, was)})")
            ceases = f"({was} == {never} && m->{until} != {never} ? m->{until} : {never})"
            due = f"\\min({due}, {ceases})"
        for times in counts:
            turns = self._layout.turns[times.index]
            first = f"m->{turns.ends[-1]}"
            kept += self._predicates.semantics.counts(times, lambda name: f"\\old(m->{name})")
            turned = f"\\old(m->{turns.held}) == 0 && m->{turns.held} != 0 && {first} > m->now"
            due = f"\\min({due}, ({turned} ? {first} : {never}))"
        yield all_of(kept)
        yield f"m->due == {due}"

    def kept(self, condition: Since) -> list[str]:
        """Return that the verdict of a ``since`` follows from its parts and the one before."""
        before = f"\\old(m->{self._layout.kept[condition.index]})"
        return self._predicates.semantics.keeps(condition, before)

    def changed(self, names: Iterable[str]) -> str:
        """Return that one of the named fields is another than before."""
        return any_of(f"m->{name} != \\old(m->{name})" for name in dict.fromkeys(names))

    def same(self, names: Iterable[str]) -> str:
        """Return that the named fields are unchanged."""
        doubles = {name for name, type_ in self._types.items() if type_ == "double"}
        return all_of(
            f"same(m->{each}, \\old(m->{each}))"
            if each in doubles
            else f"m->{each} == \\old(m->{each})"
            for each in names
        )

    def states_done(self) -> list[str]:
        """Return the states of actions after an event of the rules."""
        states = []
        for index, name in self._layout.ran.items():
            rises = [self._emissions.rises(each) for each in self._emissions.callers(index)]
            states.append(
                f"m->{name} == ({' || '.join(rises)} ? 1 : 0)" if rises else f"m->{name} == 0"
            )
        for action in self._view.program.actions:
            if action.index not in self._layout.active:
                continue
            name, active = self._layout.active[action.index], self._emissions.active(action.index)
            if action.reset_by is not None:
                over = [f"m->{self._layout.ran[action.reset_by]} != 0"]
                if action.triggered_by:
                    over.append(self._emissions.over(action))
                active = f"({' && '.join(over)} ? 0 : {active})"
            states.append(f"m->{name} == {active}")
        return states

    def latched_kept(self) -> list[str]:
        """Return that a latched action never clears by itself."""
        latched = [each for each in self._view.program.actions if each.latched]
        names = [f"m->{self._layout.active[each.index]}" for each in latched]
        return [f"(\\old({name}) != 0 ==> {name} != 0)" for name in names]

    def _caught_up(self) -> list[str]:
        """Return the state of inputs, and the emitted events, after all deadlines that were due."""
        expired = [each for one in self._view.timeouts for each in self.expired(one)]
        return [*expired, "follows(\\old(emitted), emitted)"]

    def _stepped_back(self) -> list[str]:
        """Return that all is reset, and one event of the rules has been evaluated."""
        unset, macro = self._macro("UNSET"), self._macro
        sinces = self._layout.since.values()
        new = self._inputs_as_new("m->now")
        new += [f"(m->{since} == {unset} || m->{since} == m->now)" for since in sinces]
        for once in self._predicates.all_onces():
            new.append(f"({self._predicates.semantics.until(once, '0')})")
        for times in self._predicates.all_counts():
            new += self._predicates.semantics.counts(times, lambda _: "0")
        for each in self._predicates.all_sinces():
            new += self._predicates.semantics.keeps(each, macro("FALSE"))
        kind = f"{macro('CLOCK_STEP')}, {macro('SITE_NONE')}"
        step = f"after(\\old(emitted), m->owner, m->now, {kind})"
        emitted = f"emitted == {self._emissions.by_event(step)}"
        return ["m->started == 1", *new, *self.states_done(), emitted]

    def as_new(self, start: str) -> list[str]:
        """Return the state of inputs, times and intervals after a restart."""
        unset = self._macro("UNSET")
        memories = [f"m->{name} == {unset}" for name in self._layout.since.values()]
        memories += [f"m->{name} == 0" for name in self._layout.until.values()]
        memories += [f"m->{name} == 0" for name in self._layout.names_of_turns()]
        memories += [f"m->{name} == {self._macro('FALSE')}" for name in self._layout.kept.values()]
        return [*self._inputs_as_new(start), *memories] or ["\\true"]

    def _inputs_as_new(self, start: str) -> list[str]:
        """Return the state of inputs and times after a restart."""
        layout = self._layout
        found = []
        for fields in layout.inputs.values():
            found += [f"m->{fields.base} == {start}"] if fields.base else []
            found += [f"m->{stamp} == {start}" for stamp in fields.stamps]
            found += [f"m->{name} == 0" for name in (fields.came, fields.missing) if name]
        found += [f"m->{name} == m->now" for name in layout.turned.values()]
        memories = layout.memories.values()
        times = [each.last_t for each in memories if each.last_t and not each.forgotten_t]
        found += [f"m->{name} == m->now" for name in times]
        return found + [each for forget in self._view.forgets for each in self.forgotten(forget)]

    def forgotten(self, forget: Forget) -> list[str]:
        """Return that no value of an input is known or remembered."""
        cleared = [f"m->{name} == 0" for name in (*forget.known, *forget.counts)]
        return [*cleared, *(text for _, text in _forgotten_numbers(forget))]

    def forgets_of(self, function: str) -> list[Forget]:
        """Return what a function forgets; nothing for an empty name."""
        return [each for each in self._view.forgets if each.function == function]

    def expired(self, timeout: Timeout) -> list[str]:
        """Return that an input is missing if its timeout has passed, and its values with it."""
        missing = f"m->{timeout.missing}"
        passed = f"m->{timeout.base} + {timeout.duration_ns} <= m->now"
        found = [iff(f"{missing} != 0", f"(\\old({missing}) != 0 || {passed})")]
        gone = f"(\\old({missing}) == 0 && {passed})"
        for forget in self.forgets_of(timeout.forget):
            cleared = (*forget.known, *forget.counts)
            found += [f"m->{name} == ({gone} ? 0 : \\old(m->{name}))" for name in cleared]
            for name, forgotten in _forgotten_numbers(forget):
                kept = self.same([name])[1:-1]
                found.append(f"({gone} ==> {forgotten}) && (!{gone} ==> {kept})")
        return found

    def emission_done(self) -> list[str]:
        """Return that an event of the rules emits what it must."""
        events = self._emissions.by_event("\\old(emitted)")
        return [f"emitted == {events}"]

    def nothing_done(self) -> list[str]:
        """Return that no behaviour and no reset has done anything."""
        return [self.same(self.acted_upon()), "emitted == \\old(emitted)"]

    def kept_but(self, changed: Iterable[str]) -> str:
        """Return that all fields but some are unchanged."""
        return self.same(self._all_but(changed))

    def kept_over_time_but(self, changed: Iterable[str]) -> str:
        """Return that the fields that do not change with time are unchanged, but for some."""
        gone = set(changed)
        return self.same(name for name in self._lasting() if name not in gone)

    def acted_upon(self) -> list[str]:
        """Return the fields that are changed by behaviours and resets, and by rules after them."""
        layout = self._layout
        late = [each.index for each in self._view.late_rules]
        judged = [table[each] for table in (layout.verdicts, layout.turned) for each in late]
        tables = (layout.conditions, layout.active, layout.ran)
        return [*judged, *(name for table in tables for name in table.values())]

    def _judged(self) -> list[str]:
        """Return the fields that change when all rules are evaluated."""
        layout = self._layout
        tables = (layout.verdicts, layout.turned, layout.since, layout.until, layout.kept)
        names = [each for table in tables for each in table.values()]
        names += self._layout.names_of_turns()
        return ["started", *names, *self.acted_upon(), "due"]

    def _settled(self) -> list[str]:
        """Return the fields that change when deadlines are processed."""
        names = [each.missing for each in self._view.timeouts]
        names += [name for each in self._view.forgets for name in each.changed]
        return ["now", *names, *self._judged()]

    def _lasting(self) -> list[str]:
        """Return the fields that do not change with time."""
        values = [term.name for term in self._layout.terms.values()]
        values += [finding.name for finding in self._layout.findings.values()]
        return list(dict.fromkeys(["owner", *values, *self._layout.enabled.values()]))

    def _all_but(self, names: Iterable[str]) -> list[str]:
        changed = set(names)
        return [each for each in self._predicates.field_names() if each not in changed]

    def _macro(self, name: str) -> str:
        return self._predicates.macro(name)


def _forgotten_numbers(forget: Forget) -> Iterator[tuple[str, str]]:
    """Yield the fields of functions with a step, each with what holds once it is forgotten."""
    for name, value in forget.doubles:
        is_unknown = f"\\is_NaN(m->{name})"
        yield name, is_unknown if math.isnan(value) else f"same(m->{name}, {constant(value)})"
    for name in forget.times:
        yield name, f"m->{name} == -1"


def _since(text: str) -> str:
    """Return a text of a contract as that of a predicate, which names the earlier state."""
    parts = text.split("\\old(")
    for place in range(len(parts) - 1, 0, -1):
        depth, end = 1, 0
        while depth:
            depth += {"(": 1, ")": -1}.get(parts[place][end], 0)
            end += 1
        inner, rest = parts[place][: end - 1], parts[place][end - 1 :]
        parts[place - 1 :] = [f"{parts[place - 1]}\\at({inner}, Before{rest}"]
    return parts[0]


ALL = ("*m", "emitted")
"""Every field, and what is emitted: what of it is kept, a contract says among what it ensures.

A list of fields would be a chain of as many changes, which every look at a field goes through.
"""

VERDICTS_DATED, INTERVALS_RUN_ON, STATES_DONE, EMISSION_DONE = (
    f"{name}{{Old, Here}}(m)"
    for name in ("verdicts_dated", "intervals_run_on", "states_done", "emission_done")
)
KEPT_BY_JUDGING, KEPT_BY_DEADLINES, KEPT_BY_TIME = (
    f"{name}{{Old, Here}}(m)" for name in ("kept_by_judging", "kept_by_deadlines", "kept_by_time")
)
NOTHING_DONE, NOTHING_CHANGED, LATCHED_KEPT, CAUGHT_UP, STEPPED_BACK = (
    f"{name}{{Old, Here}}(m)"
    for name in ("nothing_done", "nothing_changed", "latched_kept", "caught_up", "stepped_back")
)
"""What has become of a monitor since a function was called."""

DONE = (STATES_DONE, EMISSION_DONE)
"""What an event of the rules leaves of actions, and what it emits."""
