"""The methods that evaluate rules: one for the rules of the same topics."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from deros.generators.monitor.python.conditions import Conditions
from deros.generators.monitor.python.layout import Layout, inputs_of
from deros.generators.text.logic import Atom, all_of, any_of, lay_out
from deros.generators.text.provenance import comment
from deros.generators.text.python import LINE_LENGTH
from deros.rules.program import walk
from deros.rules.program.ir import (
    Age,
    Condition,
    Failsafe,
    For,
    Frequency,
    Missing,
    Once,
    Program,
    Rule,
    RuleRef,
    Since,
    Times,
    Unknown,
)
from deros.rules.program.rounds import rounds


@dataclass(frozen=True, slots=True)
class Judge:
    """A method that evaluates the rules that depend on the same topics.

    Attributes:
        method: its name, without the leading ``_``.
        topics: on which its rules depend.
        lines: of its body.
        round: 0, or the later round of the event in which the behaviours' method calls it.
    """

    method: str
    topics: tuple[str, ...]
    lines: tuple[str, ...]
    round: int = 0

    @property
    def subject(self) -> str:
        """The topics of its rules, in a few words."""
        if self.round:
            return "actions"
        if not self.topics:
            return "constants"
        return self.topics[0] if len(self.topics) == 1 else f"{len(self.topics)} topics together"


def judges(program: Program, layout: Layout) -> tuple[Judge, ...]:
    """Return the methods for all rules: those of fewer topics first, then as written.

    A rule depends on all topics of a rule that it names: it is evaluated in the same method or in
    one of more topics, and either way later. Each later round has one method for its rules.
    """
    first, *later = rounds(program)
    groups: dict[tuple[str, ...], list[Rule]] = {}
    inputs: dict[int, set[int]] = {}
    for rule in program.rules:
        inputs[rule.index] = _inputs(program, rule.condition, inputs)
    for rule in first.rules:
        groups.setdefault(_topics(program, inputs[rule.index]), []).append(rule)
    of_topics = tuple(
        Judge(
            layout.names.new("judge", *_joined(topics)),
            topics,
            tuple(_lines(program, layout, rules)),
        )
        for topics, rules in sorted(groups.items(), key=lambda group: len(group[0]))
    )
    of_actions = tuple(
        Judge(
            layout.names.new("judge", "round", number + 1),
            _topics(program, {index for rule in each.rules for index in inputs[rule.index]}),
            tuple(_lines(program, layout, list(each.rules))),
            number,
        )
        for number, each in enumerate(later, 1)
        if each.rules
    )
    return of_topics + of_actions


def evaluating_lines(
    topic: str, judges: Sequence[Judge], acts: bool, known_at_start: bool
) -> tuple[str, ...]:
    """Return the statements that evaluate the rules of a topic, and run behaviours if any changes.

    Rules of later rounds are evaluated with the behaviours.

    Args:
        topic: that a message has come on.
        judges: those of all topics.
        acts: whether behaviours run though no verdict of a rule has changed.
        known_at_start: whether the first event has to evaluate all.
    """
    methods = [each.method for each in judges if topic in each.topics and not each.round]
    calls = [f"self._{method}(t)" for method in methods]
    first = ["        if not self._started:", "            self._evaluate(t)"]
    if acts:
        first += ["            return"]
        rest = [f"        {each}" for each in (*calls, "self._act(t)")]
    elif calls:
        word = "elif" if known_at_start else "if"
        rest = [f"        {word} {' | '.join(calls)}:", "            self._act(t)"]
        if len(rest[0]) > LINE_LENGTH:
            broken = (f"            | {each}" for each in calls[1:])
            rest[:1] = [f"        {word} (", f"            {calls[0]}", *broken, "        ):"]
    else:
        rest = []
    return (*(first if known_at_start else ()), *rest)


def _joined(topics: tuple[str, ...]) -> list[str]:
    """Return the words of a method's name; with more than three topics it would be too long."""
    return " and ".join(topics).split() if len(topics) <= 3 else ["several"]


def _topics(program: Program, inputs: set[int]) -> tuple[str, ...]:
    found = {program.inputs[index].topic for index in inputs}
    return tuple(topic for topic in program.topics if topic in found)


def _inputs(program: Program, condition: Condition, of_rules: dict[int, set[int]]) -> set[int]:
    """Return the inputs that a condition depends on, those of the rules that it names included."""
    found: set[int] = set()
    for part in walk.parts(condition):
        if isinstance(part, Missing | Unknown | Age | Frequency):
            found.add(part.input)
        elif isinstance(part, RuleRef):
            found |= of_rules[part.rule]
        for value in walk.terminals(part):
            found |= inputs_of(program, value)
    return found


def _lines(program: Program, layout: Layout, rules: list[Rule]) -> list[str]:
    conditions = Conditions(program, layout)
    lines = [f"        {name} = self._{name}" for name in _remembered(layout, rules)]
    lines.append("        changed = False")
    loaded: set[str] = set()
    for rule in rules:
        lines.append("")
        lines += _title(program, rule)
        named = [name for name in _named(layout, rule.condition) if name not in loaded]
        lines += [f"        {name} = self._{name}" for name in named]
        loaded.update(named)
        lines += interval_lines(conditions, layout, rule.condition)
        lines += _verdict(conditions, layout, rule)
    return lines


def _title(program: Program, rule: Rule) -> list[str]:
    if rule.early_of is None:
        return comment(8, f"Rule {rule.full_name}", rule.span)
    written = program.rules[rule.early_of].full_name
    return comment(8, f"Rule {written}, as if no 'for' had to last", rule.span, "")


def _named(layout: Layout, condition: Condition) -> Iterator[str]:
    """Yield the verdicts that a condition asks for; what has them is evaluated before it."""
    yield from dict.fromkeys(layout.verdicts[rule] for rule in walk.rules_in(condition))


def _remembered(layout: Layout, rules: list[Rule]) -> list[str]:
    """Return the names that the rules read, in order, each once."""
    names: dict[str, None] = {}
    for rule in rules:
        for part in walk.parts(rule.condition):
            if isinstance(part, Missing):
                names[layout.missing[part.input]] = None
            elif isinstance(part, Age):
                names[layout.counted[part.input]] = None
            elif isinstance(part, Frequency):
                names[layout.stamps[part.input]] = None
            elif isinstance(part, Unknown):
                names.update(dict.fromkeys(_awaited(layout, part.input)))
                if part.operand is None:
                    names[layout.known[part.input]] = None
            elif isinstance(part, Failsafe):
                for index in part.inputs:
                    names.update(dict.fromkeys(_awaited(layout, index)))
            for value in walk.compared(part):
                names[layout.values[value].name] = None
    return list(names)


def _awaited(layout: Layout, index: int) -> tuple[str, str]:
    """Return the names that tell whether an input is awaited."""
    return layout.silent[index], layout.missing[index]


def interval_lines(conditions: Conditions, layout: Layout, condition: Condition) -> list[str]:
    """Return the statements that update what a condition remembers, inner parts first."""
    lines: list[str] = []
    for part in walk.parts(condition):
        if isinstance(part, Since):
            lines += _kept_lines(conditions, layout, part)
        elif isinstance(part, Once):
            until = layout.untils[part.index]
            lines += [
                f"        {until} = self._{until}",
                *lay_out(8, "if ", conditions.true(part.operand), ":"),
                f"            {until} = self._{until} = NEVER",
                f"        elif {until} is NEVER:",
                f"            {until} = self._{until} = t + {part.duration_ns:_}",
                f"            if {until} < self._due:",
                f"                self._due = {until}",
            ]
        elif isinstance(part, Times):
            turns, held = layout.turns[part.index], layout.held[part.index]
            news = f"(*{turns}[1:], t + {part.duration_ns:_})"
            lines += [
                f"        {turns} = self._{turns}",
                *lay_out(8, "if ", conditions.true(part.operand), ":"),
                f"            if not self._{held}:",
                f"                self._{held} = True",
                f"                {turns} = self._{turns} = {news}",
                f"                if t < {turns}[0] < self._due:",
                f"                    self._due = {turns}[0]",
                "        else:",
                f"            self._{held} = False",
            ]
        elif isinstance(part, For):
            due = layout.dues[part.index]
            lines += [
                f"        {due} = self._{due}",
                *lay_out(8, "if ", conditions.true(part.operand), ":"),
                f"            if {due} is NEVER:",
                f"                {due} = t + {part.duration_ns:_}",
                f"                self._{due} = {due}",
                f"                if {due} < self._due:",
                f"                    self._due = {due}",
                f"        elif {due} is not NEVER:",
                f"            {due} = self._{due} = NEVER",
            ]
            conditions.lasting[part.operand] = due
    return lines


def _kept_lines(conditions: Conditions, layout: Layout, part: Since) -> list[str]:
    """Return the statements that compute what a ``since`` remembers from what it remembered."""
    kept = layout.kept[part.index]
    lasts = all_of((conditions.true(part.operand), Atom(kept)))
    ends = any_of((conditions.false(part.operand), Atom(f"{kept} is False")))
    awaited = (Atom(f"not self._{layout.came[index]}") for index in part.inputs)
    is_none = any_of((conditions.false(part.cause), *awaited))
    return [
        f"        {kept} = self._{kept}",
        *lay_out(8, "if ", any_of((conditions.true(part.cause), lasts)), ":"),
        f"            {kept} = self._{kept} = True",
        *lay_out(8, "elif ", all_of((is_none, ends)), ":"),
        f"            {kept} = self._{kept} = False",
        "        else:",
        f"            {kept} = self._{kept} = None",
    ]


def _verdict(conditions: Conditions, layout: Layout, rule: Rule) -> list[str]:
    """Return the statements that compute a rule's verdict, and record when it changes."""
    held = f"self._{layout.verdicts[rule.index]}"
    since = f"self._{layout.since[rule.index]}" if rule.index in layout.since else ""
    true = conditions.true(rule.condition)
    if rule.index not in layout.three_valued:
        return [
            *lay_out(8, "if ", true, ":"),
            f"            if not {held}:",
            *_turned(16, held, "True", since),
            f"        elif {held}:",
            *_turned(12, held, "False", since),
        ]
    verdict = conditions.itself(rule.condition)
    lines: list[str] = []
    if verdict is None:
        verdict = "verdict"
        lines += [*lay_out(8, "if ", true, ":"), "            verdict = True"]
        if conditions.is_always_known(rule.condition):
            lines += ["        else:", "            verdict = False"]
        else:
            false = conditions.else_false(rule.condition)
            lines += [*lay_out(8, "elif ", false, ":"), "            verdict = False"]
            lines += ["        else:", "            verdict = None"]
    return [
        *lines,
        f"        if {verdict} is not {held}:",
        *(
            [f"            if {verdict} or {held}:", f"                {since} = t"]
            if since
            else []
        ),
        f"            {held} = {verdict}",
        "            changed = True",
    ]


def _turned(indent: int, held: str, verdict: str, since: str) -> list[str]:
    blank = " " * indent
    timed = [f"{blank}{since} = t"] if since else []
    return [f"{blank}{held} = {verdict}", *timed, f"{blank}changed = True"]
