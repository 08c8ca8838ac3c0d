"""The verdict of each rule with its values, and why behaviours hold, for people to read."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from deros.rules.engine.causes import causes_of_behaviour, causes_of_rule, unknown_of_behaviour
from deros.rules.engine.early import early_ones, triggering_resettable
from deros.rules.engine.evaluate import term_value
from deros.rules.engine.state import State
from deros.rules.functions.reads import Term, strip_comments, term_name, terms_of_rules
from deros.rules.program import walk
from deros.rules.program.ir import Program, Rule, Scalar


class RuleState(NamedTuple):
    """A rule at some instant.

    Attributes:
        name: ``entity.rule``.
        line: of the rule, in its file.
        text: of the rule, in one line.
        value: ``None`` when it is not true and something that it reads is unknown.
        since: when it last became true or ceased to be, in nanoseconds; the start, or the last
            backward step of the clock, if it did not since.
        reads: each term that it, or a rule that it names, reads, with its value; ``None`` is
            unknown, an age is in seconds.
        causes: while it is true, the parts of its condition that make it so, with their values.
    """

    name: str
    line: int
    text: str
    value: bool | None
    since: int
    reads: tuple[tuple[str, Scalar | None], ...]
    causes: tuple[str, ...] = ()


class Explanation(NamedTuple):
    """A monitor at some instant.

    Attributes:
        rules: all of them.
        causes: of each behaviour that holds, the rules that make it hold, with their causes; of one
            that is on its way, those that would if no ``for`` had to last, and how long they have
            lasted; of one that can refuse a reset and is unknown, the terms without a value.
    """

    rules: tuple[RuleState, ...]
    causes: Mapping[str, tuple[str, ...]]


def explain(program: Program, running: Program, state: State, t_ns: int) -> Explanation:
    """Return the verdicts and causes as of the last event.

    Args:
        program: the rules as written.
        running: the same with what is early, which ``state`` is of.
        state: of the monitor.
        t_ns: the time.
    """
    rules = tuple(
        _explain_rule(program, rule, read, state, t_ns) for rule, read in terms_of_rules(program)
    )
    everyone = tuple(walk.behaviours(running))
    early = early_ones(running)
    refusing = triggering_resettable(program)
    causes = {}
    for each in walk.behaviours(program):
        asked = each
        if state.holds[each.index] is False:
            asked = everyone[early.get(each.index, each.index)]
        if state.holds[asked.index] is True:
            causes[each.name] = causes_of_behaviour(running, asked, state, t_ns)
        elif state.holds[asked.index] is None and each.index in refusing:
            causes[each.name] = unknown_of_behaviour(running, asked, state, t_ns)
    return Explanation(rules, causes)


def _explain_rule(
    program: Program, rule: Rule, read: Sequence[Term], state: State, t_ns: int
) -> RuleState:
    reads = tuple(
        (term_name(program, each), term_value(program, each, state, t_ns)) for each in read
    )
    value: bool | None = state.verdicts[rule.index] is True
    if not value and any(each is None for _, each in reads):
        value = None
    return RuleState(
        rule.full_name,
        rule.span.line,
        strip_comments(rule.span.text),
        value,
        state.turned_ns[rule.index],
        reads,
        causes_of_rule(program, rule.index, True, state, t_ns) if value else (),
    )
