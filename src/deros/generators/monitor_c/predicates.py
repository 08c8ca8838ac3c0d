"""What holds of a monitor, as predicates in ACSL: ranges, deadlines, and what the rules mean."""

from __future__ import annotations

import textwrap
from collections.abc import Collection, Iterable, Iterator

from deros.generators.monitor_c import quantities
from deros.generators.monitor_c.contracts import all_of, any_of, iff
from deros.generators.monitor_c.emissions import Emissions
from deros.generators.monitor_c.meaning import Meaning
from deros.generators.monitor_c.source import MAX_LINE
from deros.generators.monitor_c.view import MonitorView
from deros.monitor import walk
from deros.monitor.ir import Behaviour, Condition, For, Rule


class Predicates:
    """Writes the predicates of one monitor."""

    def __init__(self, view: MonitorView) -> None:
        """Remember what is named how."""
        self._view = view
        self._layout = view.layout
        self.meaning = Meaning(view.layout)
        self.emissions = Emissions(view)
        self._types = {each.name: each.type.strip() for each in view.fields}

    def fors(self, condition: Condition) -> list[For]:
        """Return the intervals of a condition that are remembered."""
        return [
            part
            for part in walk.parts(condition)
            if isinstance(part, For) and part.index in self._layout.since
        ]

    def declarations(self) -> str:
        """Return the predicates that say what the rules mean, and what a sane monitor is.

        They are macros, which Frama-C replaces by what they stand for: most of it is as it was
        before a statement, and is seen to be so only where nothing hides it.
        """
        lines = [
            "/* What the rules mean, and what holds of a monitor between two calls. */",
            *_macro("is_verdict", "v", self._verdicts()),
            f"#define time_of(t) ((t) < 0 ? 0 : (t) > {self.macro('LATEST')}"
            f" ? {self.macro('LATEST')} : (t))",
        ]
        for name, parameters, parts in self._predicates():
            lines += _macro(name, f"m{parameters}", parts)
        turned = [self.turned(rule) for rule in self._view.program.rules]
        lines += _macro("verdicts_dated", "m", turned or ["\\true"])
        for name, parts in self._outcome("\\old(emitted)"):
            lines += _macro(name, "m", parts)
        fors = self.all_fors()
        lines += _macro("intervals_run_on", "m", list(self.run_on(fors)) if fors else ["\\true"])
        lines += _macro("is_end", "m, t", [self.is_end()])
        lines += _macro("nothing_done", "m", [self.same(self._changed_by_acting())])
        idle = [name for name in self.changed_by_time() if name != "m->now"]
        lines += _macro("nothing_changed", "m", [self.same(idle)])
        lines += _set("changed_by_judging", self._changed_by_judging())
        lines += _set("changed_by_deadlines", self.changed_by_deadlines())
        lines += _set("changed_by_time", self.changed_by_time())
        parts = [self.emissions.declarations(), quantities.declarations(self._view.program)]
        return "\n".join([*parts, *lines, ""])

    def all_fors(self) -> list[For]:
        """Return the intervals of all rules and behaviours that are remembered."""
        program = self._view.program
        conditions = [each.condition for each in program.rules]
        conditions += [each.condition for each in walk.behaviours(program)]
        return [part for each in conditions for part in self.fors(each)]

    def turned(self, rule: Rule) -> str:
        """Return since when a rule is true, or is not."""
        verdict, turned = self._layout.verdicts[rule.index], self._layout.turned[rule.index]
        true = self.macro("TRUE")
        turns = (
            f"(m->{verdict} == {true} && \\old(m->{verdict}) != {true}) || "
            f"(m->{verdict} != {true} && \\old(m->{verdict}) == {true})"
        )
        return f"m->{turned} == ({turns} ? m->now : \\old(m->{turned}))"

    def run_on(self, fors: Iterable[For]) -> Iterator[str]:
        """Yield that intervals begin now or run on, and that the next deadline is no later."""
        unset, due = self.macro("UNSET"), "\\old(m->due)"
        kept = []
        for each in fors:
            since = self._layout.since[each.index]
            was = f"\\old(m->{since})"
            start = f"({was} == {unset} ? m->now : {was})"
            kept.append(f"(m->{since} != {unset} ==> m->{since} == {start})")
            end = f"m->now + {each.duration_ns}"
            begins = f"({was} == {unset} && m->{since} != {unset} ? {end} : {self.macro('NEVER')})"
            due = f"\\min({due}, {begins})"
        yield all_of(kept)
        yield f"m->due == {due}"

    def changed(self, names: Iterable[str]) -> str:
        """Return that one of the named fields is another than before."""
        return any_of(f"m->{name} != \\old(m->{name})" for name in dict.fromkeys(names))

    def same(self, names: Iterable[str]) -> str:
        """Return that each of the named fields is as it was."""
        doubles = {f"m->{name}" for name, type_ in self._types.items() if type_ == "double"}
        return all_of(
            f"same({each}, \\old({each}))" if each in doubles else f"{each} == \\old({each})"
            for each in names
        )

    def is_end(self) -> str:
        """Return that an instant is one at which a timeout or an interval ends, or never comes."""
        found = [f"t == {self.macro('NEVER')}"]
        found += [
            f"(m->{each.missing} == 0 && t == m->{each.base} + {each.duration_ns})"
            for each in self._view.timeouts
        ]
        for end in self._view.ends:
            condition = end.condition if "!=" in end.condition else f"{end.condition} != 0"
            found.append(f"({condition} && t == m->{end.base} + {end.wait_ns})")
        return any_of(found)

    def _outcome(self, before: str) -> Iterator[tuple[str, list[str]]]:
        """Yield what an event of the rules leaves of actions, and what is emitted."""
        states = []
        for index, name in self._layout.ran.items():
            rises = [self.emissions.rises(each) for each in self.emissions.callers(index)]
            states.append(
                f"m->{name} == ({' || '.join(rises)} ? 1 : 0)" if rises else f"m->{name} == 0"
            )
        for action in self._view.program.actions:
            if action.index not in self._layout.active:
                continue
            name, active = self._layout.active[action.index], self.emissions.active(action.index)
            if action.reset_by is not None:
                over = [f"m->{self._layout.ran[action.reset_by]} != 0"]
                if action.triggered_by:
                    over.append(self.emissions.over(action))
                active = f"({' && '.join(over)} ? 0 : {active})"
            states.append(f"m->{name} == {active}")
        yield "states_done", states or ["\\true"]
        yield "emission_done", [f"emitted == {self.emissions.by_event(before)}"]

    def _verdicts(self) -> list[str]:
        values = ("FALSE", "UNKNOWN", "TRUE")
        return ["(" + " || ".join(f"(v) == {self.macro(each)}" for each in values) + ")"]

    def _predicates(self) -> Iterator[tuple[str, str, list[str]]]:
        for rule in self._view.program.rules:
            name = self._layout.verdicts[rule.index]
            yield f"true_{name}", "", [self.meaning.true(rule.condition)]
            yield f"false_{name}", "", [self.meaning.false(rule.condition)]
            yield f"judged_{name}", "", self._judged(rule)
        for each in walk.behaviours(self._view.program):
            yield f"acted_{self._layout.behave[each.index]}", "", self._acted(each)
        yield "ranged", "", self.ranges(self._types)
        restarted = {each.name for each in self._view.fields if each.restarted}
        restarted |= {name for each in self._view.forgets for name in each.known}
        kept = [name for name in self._types if name not in restarted]
        yield "ranged_but_for_restart", "", self.ranges(kept)
        bases = {each.base for each in self._view.timeouts}
        bases |= {each.base for each in self._view.ends}
        yield "timeouts_in_time", ", due", self.timeouts_in_time("due", bases)
        yield "ends_in_time", ", due", self.ends_in_time("due", bases)
        yield "unexpired", "", self.unexpired(bases)
        yield "judged", "", [f"judged_{name}(m)" for name in self._layout.verdicts.values()]
        yield "acted", "", [f"acted_{name}(m)" for name in self._layout.behave.values()]
        unknown = [
            f"m->{name} == {self.macro('UNKNOWN')}" for name in self._layout.conditions.values()
        ]
        yield "unacted", "", unknown
        yield "sane", "", [*SOUND, "m->due > m->now", *EVALUATED]

    def _changed_by_judging(self) -> list[str]:
        """Return the fields that are changed where all is judged."""
        layout = self._layout
        tables = (layout.verdicts, layout.turned, layout.conditions, layout.active, layout.ran)
        names = [each for table in (*tables, layout.since) for each in table.values()]
        return [*(f"m->{name}" for name in ("started", *names, "due")), "emitted"]

    def _changed_by_acting(self) -> list[str]:
        """Return the fields that are changed by behaviours and resets."""
        layout = self._layout
        tables = (layout.conditions, layout.active, layout.ran)
        return [*(f"m->{name}" for table in tables for name in table.values()), "emitted"]

    def changed_by_deadlines(self) -> list[str]:
        """Return the fields that are changed where deadlines are settled."""
        names = [each.missing for each in self._view.timeouts]
        names += [name for each in self._view.forgets for name in (*each.known, *each.last)]
        changed = [f"m->{name}" for name in ("now", *names)]
        return list(dict.fromkeys([*changed, *self._changed_by_judging()]))

    def changed_by_time(self) -> list[str]:
        """Return the fields that the passing of time can change."""
        values = {term.name for term in self._layout.terms.values()}
        values |= {finding.name for finding in self._layout.findings.values()}
        fixed = {"owner", *values, *self._layout.enabled.values()}
        names = [f"m->{each.name}" for each in self._view.fields if each.name not in fixed]
        return [*names, "emitted"]

    def macro(self, name: str) -> str:
        """Return the name of one of the monitor's macros."""
        return f"{self._view.macro}_{name}"

    def ranges(self, names: Iterable[str]) -> list[str]:
        """Return what each of the named fields is in."""
        latest, unset = self.macro("LATEST"), self.macro("UNSET")
        sinces = set(self._layout.since.values())
        free = {term.name for term in self._layout.terms.values()} | {"due"}
        free |= set(self._layout.turned.values())
        found = []
        for name in names:
            kind = self._types[name]
            if name in sinces:
                found.append(f"(m->{name} == {unset} || 0 <= m->{name} <= m->now)")
            elif kind == "bool":
                found.append(f"(m->{name} == 0 || m->{name} == 1)")
            elif kind.endswith("_verdict"):
                found.append(f"is_verdict(m->{name})")
            elif kind == "int64_t" and name not in free:
                found.append(f"0 <= m->{name} <= {latest}")
        return found

    def timeouts_in_time(self, due: str, bases: Collection[str]) -> list[str]:
        """Return that no timeout that counts from one of the named fields lies before ``due``."""
        return [
            f"(m->{each.missing} == 0 ==> {due} <= m->{each.base} + {each.duration_ns})"
            for each in self._view.timeouts
            if each.base in bases
        ]

    def ends_in_time(self, due: str, bases: Collection[str]) -> list[str]:
        """Return that no end of an interval from one of the named fields lies before ``due``."""
        found = []
        for each in self._view.ends:
            if each.base not in bases:
                continue
            end = f"m->{each.base} + {each.wait_ns}"
            condition = each.condition if "!=" in each.condition else f"{each.condition} != 0"
            found.append(f"({condition} && {end} > m->now ==> {due} <= {end})")
        return found

    def unexpired(self, bases: Collection[str]) -> list[str]:
        """Return that no timeout that counts from one of the named fields has passed unseen."""
        return [
            f"(m->{each.missing} == 0 ==> m->{each.base} + {each.duration_ns} > m->now)"
            for each in self._view.timeouts
            if each.base in bases
        ]

    def _judged(self, rule: Rule) -> list[str]:
        """Return that a rule's verdict is what it means, and its intervals run if they must."""
        name = self._layout.verdicts[rule.index]
        return [
            *map(self._runs, self.fors(rule.condition)),
            iff(f"m->{name} == {self.macro('TRUE')}", f"true_{name}(m)"),
            iff(f"m->{name} == {self.macro('FALSE')}", f"false_{name}(m)"),
        ]

    def _runs(self, condition: For) -> str:
        return iff(self.meaning.runs(condition), self.meaning.true(condition.operand))

    def _acted(self, behaviour: Behaviour) -> list[str]:
        """Return what a behaviour's condition is worth, with all that encloses it."""
        true, false = self.macro("TRUE"), self.macro("FALSE")
        holds = [self.meaning.true(behaviour.condition)]
        fails = [self.meaning.false(behaviour.condition)]
        if behaviour.parent is not None:
            outer = f"m->{self._layout.conditions[behaviour.parent]}"
            holds.append(f"{outer} == {true}")
            fails.append(f"{outer} == {false}")
        if behaviour.optional:
            enabled = f"m->{self._layout.enabled[behaviour.index]}"
            holds.append(f"{enabled} != 0")
            fails.append(f"{enabled} == 0")
        condition = f"m->{self._layout.conditions[behaviour.index]}"
        return [
            *map(self._runs, self.fors(behaviour.condition)),
            iff(f"{condition} == {true}", all_of(holds)),
            iff(f"{condition} == {false}", any_of(fails)),
        ]


def _macro(name: str, parameters: str, parts: list[str]) -> list[str]:
    """Return the lines of a macro that stands for a conjunction; of nothing, that is true."""
    parts = parts or ["\\true"]
    joined = [f"{part} &&" for part in parts[:-1]]
    return _lines(f"{name}({parameters}) (", [*joined, f"{parts[-1]})"])


def _set(name: str, fields: list[str]) -> list[str]:
    """Return the lines of a macro that stands for fields of a monitor."""
    return _lines(f"{name}(m)", [", ".join(fields)])


def _lines(head: str, parts: list[str]) -> list[str]:
    lines = [f"#define {head}"]
    for text in parts:
        lines += textwrap.wrap(
            text,
            MAX_LINE - len(" \\"),
            initial_indent="  ",
            subsequent_indent="    ",
            break_long_words=False,
            break_on_hyphens=False,
        )
    return [f"{line} \\" for line in lines[:-1]] + lines[-1:]


BY_JUDGING, BY_TIME = "changed_by_judging(m)", "changed_by_time(m)"
"""The fields that change where all is judged, and those that change as time passes."""

DONE = ("states_done(m)", "emission_done(m)")
"""What an event of the rules leaves of actions, and what it emits."""

IDLE = "m->now <= time_of(t) < m->due"
IDLE_BEFORE = "\\old(m->now) <= time_of(t) < \\old(m->due)"
"""Nothing is due at the time of a call, and the clock has not stepped back; as seen before it."""

IN_TIME = ("timeouts_in_time(m, m->due)", "ends_in_time(m, m->due)")
"""No deadline lies before the one that the owner was told."""

EVALUATED = (
    "(m->started != 0 ==> judged(m) && acted(m))",
    "(m->started == 0 ==> unacted(m))",
)
"""All is judged since the first event; before it, no condition of a behaviour is known."""

SOUND = ("ranged(m)", *IN_TIME, "unexpired(m)")
"""What holds of a monitor at all times, but for the verdicts."""
