"""What holds of a monitor, as predicates in ACSL: ranges, deadlines, and what the rules mean."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator

from deros.generators.monitor.c.acsl import quantities, scans, windows
from deros.generators.monitor.c.acsl.contracts import all_of, any_of, iff, wrapped
from deros.generators.monitor.c.acsl.emissions import Emissions
from deros.generators.monitor.c.acsl.semantics import AcslSemantics
from deros.generators.monitor.c.code.view import MonitorView
from deros.generators.text.c import LINE_LENGTH
from deros.generators.text.document import Line, concat, fill, nest, render_lines
from deros.rules.program import walk
from deros.rules.program.ir import Behaviour, Condition, For, Once, Rule, Since, Times


class Predicates:
    """Writes the predicates of one monitor."""

    def __init__(self, view: MonitorView) -> None:
        """Use the names of a layout."""
        self._view = view
        self._layout = view.layout
        self.semantics = AcslSemantics(view.layout)
        self.emissions = Emissions(view)
        self._types = {each.name: each.type.strip() for each in view.fields}

    def field_names(self) -> list[str]:
        """Return the names of all fields; of a rate's samples only how many there are."""
        return [
            f"{each.name}.count" if each.type.strip().endswith("_window") else each.name
            for each in self._view.fields
        ]

    def fors(self, condition: Condition) -> list[For]:
        """Return the intervals of a condition that are remembered."""
        return [
            part
            for part in walk.parts(condition)
            if isinstance(part, For) and part.index in self._layout.since
        ]

    def onces(self, condition: Condition) -> list[Once]:
        """Return the same of a condition's ``within``."""
        return [
            part
            for part in walk.parts(condition)
            if isinstance(part, Once) and part.index in self._layout.until
        ]

    def counts(self, condition: Condition) -> list[Times]:
        """Return the parts of a condition that count turns."""
        return [part for part in walk.parts(condition) if isinstance(part, Times)]

    def sinces(self, condition: Condition) -> list[Since]:
        """Return the parts of a condition whose verdicts are remembered."""
        return [part for part in walk.parts(condition) if isinstance(part, Since)]

    def declarations(self) -> str:
        """Return the predicates that say what the rules mean, and what a sane monitor is.

        What is said of a whole monitor is a predicate, which a proof looks into where it has to: a
        caller mostly hands on what the function that it calls has ensured. Written out in full,
        hundreds of fields would be weighed at each call.
        """
        lines = [
            "/* What the rules mean, and what holds of a monitor between two calls. */",
            *_macro("is_verdict", "v", self._verdicts()),
            f"#define time_of(t) ((t) < 0 ? 0 : (t) > {self.macro('LATEST')}"
            f" ? {self.macro('LATEST')} : (t))",
        ]
        for name, parameters, parts in self._predicates():
            lines += predicate(self._layout.prefix, name, parts, parameters)
        program = self._view.program
        parts = [self.emissions.declarations(), quantities.declarations(program)]
        parts.append(scans.declarations(program))
        parts += filter(None, [windows.declarations(program)])
        return "\n".join([*parts, *lines, ""])

    def _conditions(self) -> list[Condition]:
        """Return the conditions of all rules and behaviours."""
        program = self._view.program
        owners: tuple[Rule | Behaviour, ...] = (*program.rules, *walk.behaviours(program))
        return [each.condition for each in owners]

    def all_fors(self) -> list[For]:
        """Return the intervals of all rules and behaviours that are remembered."""
        return [part for each in self._conditions() for part in self.fors(each)]

    def all_onces(self) -> list[Once]:
        """Return the same of all ``within``."""
        return [part for each in self._conditions() for part in self.onces(each)]

    def all_counts(self) -> list[Times]:
        """Return the same of all parts that count turns."""
        return [part for each in self._conditions() for part in self.counts(each)]

    def all_sinces(self) -> list[Since]:
        """Return the same of their remembered verdicts."""
        return [part for each in self._conditions() for part in self.sinces(each)]

    def end(self, t: str) -> str:
        """Return that an instant is one at which a timeout or an interval ends, or never comes."""
        found = [f"{t} == {self.macro('NEVER')}"]
        found += [
            f"(m->{each.missing} == 0 && {t} == m->{each.base} + {each.duration_ns})"
            for each in self._view.timeouts
        ]
        for end in self._view.ends:
            at_end = f"{t} == m->{end.base} + {end.wait_ns}"
            found.append(f"({end.predicate} && {at_end})" if end.guard else f"({at_end})")
        return any_of(found)

    def _verdicts(self) -> list[str]:
        values = ("FALSE", "UNKNOWN", "TRUE")
        return ["(" + " || ".join(f"(v) == {self.macro(each)}" for each in values) + ")"]

    def _predicates(self) -> Iterator[tuple[str, str, list[str]]]:
        for rule in self._view.program.rules:
            name = self._layout.verdicts[rule.index]
            yield f"judged_{name}", "", self.judged(rule)
        for each in walk.behaviours(self._view.program):
            yield f"acted_{self._layout.behave[each.index]}", "", self.acted(each)
        yield "ranged", "", self.ranges(self._types)
        bases = self._bases()
        yield "timeouts_in_time", ", integer due", self.timeouts_in_time("due", bases)
        yield "ends_in_time", ", integer due", self.ends_in_time("due", bases)
        yield "unexpired", "", self.unexpired(bases)
        yield "is_end", ", integer t", [self.end("t")]
        yield "judged", "", [f"judged_{name}(m)" for name in self._layout.verdicts.values()]
        yield "acted", "", [f"acted_{name}(m)" for name in self._layout.behave.values()]
        unknown = [
            f"m->{name} == {self.macro('UNKNOWN')}" for name in self._layout.conditions.values()
        ]
        yield "unacted", "", unknown
        yield "sane", "", [*SOUND, "m->due > m->now", *EVALUATED]

    def all_in_time(self, due: str) -> list[str]:
        """Return that no deadline lies before ``due``."""
        bases = self._bases()
        return [*self.timeouts_in_time(due, bases), *self.ends_in_time(due, bases)]

    def all_unexpired(self) -> list[str]:
        """Return that no timeout has passed unseen."""
        return self.unexpired(self._bases())

    def _bases(self) -> set[str]:
        bases = {each.base for each in self._view.timeouts}
        return bases | {each.base for each in self._view.ends}

    def macro(self, name: str) -> str:
        """Return the name of one of the monitor's macros."""
        return f"{self._view.macro}_{name}"

    def ranges(self, names: Iterable[str]) -> list[str]:
        """Return what each of the named fields is in."""
        latest, unset = self.macro("LATEST"), self.macro("UNSET")
        sinces = set(self._layout.since.values())
        untils = set(self._layout.until.values())
        untils |= {name for each in self._layout.turns.values() for name in each.ends}
        free = {term.name for term in self._layout.terms.values()} | {"due"}
        free |= set(self._layout.turned.values())
        times = {each.forgotten_t for each in self._layout.memories.values()}
        found = []
        for name in names:
            if name.endswith(".count"):  # of a rate's samples
                found.append(f"m->{name} <= {self.macro('SAMPLES')}")
                continue
            kind = self._types[name]
            if name in sinces:
                found.append(f"(m->{name} == {unset} || 0 <= m->{name} <= m->now)")
            elif name in untils:
                found.append(f"0 <= m->{name}")
            elif kind == "bool":
                found.append(f"(m->{name} == 0 || m->{name} == 1)")
            elif kind.endswith("_verdict"):
                found.append(f"is_verdict(m->{name})")
            elif name in times:
                found.append(f"-1 <= m->{name} <= {latest}")
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
            given = f"{each.predicate} && " if each.guard else ""
            found.append(f"({given}{end} > m->now ==> {due} <= {end})")
        return found

    def unexpired(self, bases: Collection[str]) -> list[str]:
        """Return that no timeout that counts from one of the named fields has passed unseen."""
        return [
            f"(m->{each.missing} == 0 ==> m->{each.base} + {each.duration_ns} > m->now)"
            for each in self._view.timeouts
            if each.base in bases
        ]

    def judged(self, rule: Rule) -> list[str]:
        """Return that a rule's verdict is what it means, and its intervals run if they must."""
        name = self._layout.verdicts[rule.index]
        return [
            *map(self._runs, self.fors(rule.condition)),
            *self._kept(rule.condition),
            iff(f"m->{name} == {self.macro('TRUE')}", self.semantics.true(rule.condition)),
            iff(f"m->{name} == {self.macro('FALSE')}", self.semantics.false(rule.condition)),
        ]

    def _runs(self, condition: For) -> str:
        return iff(self.semantics.runs(condition), self.semantics.true(condition.operand))

    def _kept(self, condition: Condition) -> Iterator[str]:
        """Yield that another event without news would change no ``within`` and no ``since``."""
        never = self.macro("NEVER")
        for once in self.onces(condition):
            until = f"m->{self._layout.until[once.index]}"
            yield iff(f"{until} == {never}", self.semantics.true(once.operand))
        for times in self.counts(condition):
            held = self._layout.turns[times.index].held
            yield iff(f"m->{held} != 0", self.semantics.true(times.operand))
        for each in self.sinces(condition):
            yield from self.semantics.keeps(each, f"m->{self._layout.kept[each.index]}")

    def acted(self, behaviour: Behaviour) -> list[str]:
        """Return what a behaviour's condition is worth, with all that encloses it."""
        true, false = self.macro("TRUE"), self.macro("FALSE")
        holds = [self.semantics.true(behaviour.condition)]
        fails = [self.semantics.false(behaviour.condition)]
        if behaviour.parent is not None:
            outer = f"m->{self._layout.conditions[behaviour.parent]}"
            holds.append(f"{outer} == {true}")
            fails.append(f"{outer} == {false}")
        for index in behaviour.switches:
            enabled = f"m->{self._layout.enabled[index]}"
            holds.append(f"{enabled} != 0")
            fails.append(f"{enabled} == 0")
        condition = f"m->{self._layout.conditions[behaviour.index]}"
        return [
            *map(self._runs, self.fors(behaviour.condition)),
            *self._kept(behaviour.condition),
            iff(f"{condition} == {true}", all_of(holds)),
            iff(f"{condition} == {false}", any_of(fails)),
        ]


def predicate(
    prefix: str, name: str, parts: list[str], parameters: str = "", labels: str = ""
) -> list[str]:
    """Return the lines of a predicate on a monitor; of nothing, it is true."""
    body = " &&\n".join(parts or ["\\true"])
    if labels:
        body = f"\\at({body}, Now)"
    head = f"/*@ predicate {name}{labels}({prefix}_monitor *m{parameters}) ="
    return [head, *(line for each in f"{body}; */".split("\n") for line in wrapped(each, 6))]


def _macro(name: str, parameters: str, parts: list[str]) -> list[str]:
    """Return the lines of a macro that stands for a conjunction."""
    broken = Line(None, before=" \\")
    words = Line(" ", before=" \\")
    texts = [*(f"{part} &&" for part in parts[:-1]), f"{parts[-1]})"]
    lines = [concat(broken, nest("  ", fill(text.split(" "), words))) for text in texts]
    return render_lines(concat(f"#define {name}({parameters}) (", nest(2, *lines)), LINE_LENGTH)


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
