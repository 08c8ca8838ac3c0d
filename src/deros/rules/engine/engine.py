"""The reference engine, which defines the semantics of rules.

It interprets the intermediate form directly and aims to be obviously correct; every generated
monitor must emit the same events at the same nanosecond. In short:

* The monitor is driven by messages and by deadlines. The start is no event.
* An event is: the deadlines of one instant, or one message, or a backward step of the clock. At
  each, all rules are evaluated, then all behaviours, top to bottom; then resets are processed.
  What names an action comes in a later round (:mod:`deros.rules.program.rounds`).
* An action is reset only if every condition that triggers it is known to be false, and not on its
  way (:mod:`deros.rules.engine.early`).
* Deadlines that are due at a call are processed first, in time order, with the old values.
* A call with an earlier time than the one before shows a backward step of the clock.
* To enable or disable an optional behaviour is an event too, after which the inputs are as before.
  So is the reset of a latched action that a condition names.

Source: docs, "What a rule means"; the paper's section 4.4, whose prose (not its printed algorithm)
gives the meaning of ``for``.
"""

from __future__ import annotations

import contextlib
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Literal

from deros.diagnostics import Span
from deros.rules.engine.causes import causes_against_behaviour
from deros.rules.engine.early import early_ones, refusing, with_early
from deros.rules.engine.evaluate import evaluate_condition, evaluate_value, is_nan, remembered
from deros.rules.engine.explain import Explanation, explain
from deros.rules.engine.state import LeafValue, State
from deros.rules.functions.functions import FUNCTIONS
from deros.rules.program import walk
from deros.rules.program.ir import (
    Action,
    Age,
    Apply,
    Behaviour,
    Condition,
    Frequency,
    Input,
    Program,
    Rule,
    Scalar,
    Temporal,
    Trigger,
)
from deros.rules.program.operators import Verdict, conjunction
from deros.rules.program.rounds import rounds, watched_actions

EventKind = Literal["trigger", "reset", "refused", "clock_step"]


@dataclass(frozen=True, slots=True)
class Event:
    """An event: something that a monitor did, or a step of the clock.

    Attributes:
        t_ns: when; of a ``clock_step`` the new time.
        kind: an action ran, became inactive, or stayed active although its reset was asked for.
        action: the action's name; empty for a ``clock_step``.
        behaviour: the name of the behaviour that triggered it; ``None`` for all but triggers.
        arguments: of the action.
        span: the behaviour of a trigger, else the action's declaration.
        holding: the behaviours whose conditions hold, and so refused a reset.
        unknown: the behaviours whose conditions are unknown, and so refused a reset.
        coming: the behaviours whose conditions are on their way, and so refused a reset.
    """

    t_ns: int
    kind: EventKind
    action: str = ""
    behaviour: str | None = None
    arguments: tuple[Scalar, ...] = ()
    span: Span | None = field(default=None, compare=False, repr=False)
    holding: tuple[str, ...] = ()
    unknown: tuple[str, ...] = ()
    coming: tuple[str, ...] = ()


class Engine:
    """Runs one program. Times are nanoseconds of one clock, given with every call.

    Attributes:
        events: all events since the start, in order.
    """

    def __init__(
        self,
        program: Program,
        start_ns: int = 0,
        grace_ns: int = 0,
        latched: Collection[str] = frozenset(),
        constants: Mapping[str, float] | None = None,
    ) -> None:
        """Start at ``start_ns``; nothing has been true yet.

        Args:
            program: what to run.
            start_ns: the time of the start.
            grace_ns: by how much later than the start the timeouts begin to count.
            latched: the names of the latched actions that are active from the start, because they
                were when an earlier run ended. Other names are ignored.
            constants: the values of tunable constants; those not among them have their defaults.

        Raises:
            ValueError: a constant cannot have its value, or is not a tunable one.
        """
        self.events: list[Event] = []
        self._written = program
        self._program = program = with_early(program)
        self._now_ns = start_ns
        conditions = tuple(walk.conditions(program))
        self._temporal = [each for each in conditions if isinstance(each, Temporal)]
        self._ages = [each for each in conditions if isinstance(each, Age)]
        self._frequencies = [each for each in conditions if isinstance(each, Frequency)]
        values = dict.fromkeys(walk.values(conditions))
        self._functions = [each for each in values if isinstance(each, Apply)]
        self._rounds = rounds(program)
        self._watched = watched_actions(program)
        behaviours = tuple(walk.behaviours(program))
        self._state = State(program, start_ns, len(behaviours), grace_ns)
        self._state.constants = constant_values(program, constants or {})
        self._names = [each.name for each in behaviours]
        self._early = early_ones(program)
        self._optional = {each.name: each.index for each in behaviours if each.optional}
        self._ran: set[int] = set()
        for action in program.actions:
            self._state.active[action.index] = action.latched and action.name in latched

    @property
    def next_deadline(self) -> int | None:
        """The earliest instant at which something can happen without a message, if there is one."""
        return min(self._deadlines(), default=None)

    @property
    def waiting(self) -> bool:
        """Whether an input with a timeout waits for its first message and is not missing yet."""
        return any(
            each.timeout_ns is not None and state.awaited
            for each, state in zip(self._program.inputs, self._state.inputs, strict=True)
        )

    def message(self, t_ns: int, topic: str, leaves: Mapping[int, LeafValue]) -> list[Event]:
        """Process a message: the value of every leaf of the topic's inputs. Return the events.

        ``None`` or NaN stands for an array element that the message does not have.

        Raises:
            ValueError: no input of the program is on ``topic``.
        """
        inputs = [each for each in self._program.inputs if each.topic == topic]
        if not inputs:
            raise ValueError(f"no input on topic {topic}")
        before = len(self.events)
        self._catch_up(t_ns)
        for each in inputs:
            self._observe(each, leaves, t_ns)
        self._evaluate()
        return self.events[before:]

    def advance(self, t_ns: int) -> list[Event]:
        """Process all deadlines up to and including ``t_ns``. Return the events."""
        before = len(self.events)
        self._catch_up(t_ns)
        return self.events[before:]

    def reset(self, t_ns: int) -> bool:
        """Reset every latched action that is active, unless a condition refuses it.

        An action is reset if every condition that triggers it is known to be false, as of the last
        event. Before the first event no condition is. If a condition names an action that is reset,
        an event follows.

        Returns:
            Whether no latched action is active any more.
        """
        self._catch_up(t_ns)
        latched = [each.index for each in self._program.actions if each.latched]
        watched = [index for index in latched if index in self._watched]
        before = [self._state.active[index] for index in watched]
        for index in latched:
            self._try_reset(index)
        if before != [self._state.active[index] for index in watched]:
            self._evaluate()
        return not any(self._state.active[index] for index in latched)

    def enable(self, t_ns: int, behaviour: str, enabled: bool) -> list[Event]:
        """Enable or disable an optional behaviour. Return the events.

        While it is disabled its condition counts as false, and its intervals go on. Enabled while
        its condition is true, it acts. There is no event if nothing changes.

        Raises:
            ValueError: there is no optional behaviour of that name.
        """
        if behaviour not in self._optional:
            raise ValueError(f"no optional behaviour {behaviour}")
        before = len(self.events)
        self._catch_up(t_ns)
        index = self._optional[behaviour]
        if self._state.enabled[index] != enabled:
            self._state.enabled[index] = enabled
            self._evaluate()
        return self.events[before:]

    def explain(self) -> Explanation:
        """Return the verdict of each rule as of the last event, and why each behaviour holds."""
        with self._looking():
            return explain(self._written, self._program, self._state, self._now_ns)

    def verdict(self, condition: Condition) -> Verdict:
        """Return what a condition of the program, or a part of one, is as of the last event."""
        with self._looking():
            return evaluate_condition(condition, self._state, self._now_ns)

    @contextlib.contextmanager
    def _looking(self) -> Iterator[None]:
        """Evaluate, and remember nothing of it: before the first event nothing was evaluated."""
        before = dict(self._state.remembered)
        yield
        self._state.remembered = before

    def holds(self, behaviour: Behaviour) -> Verdict:
        """Return whether a behaviour, and all around it, held at the last event."""
        return self._state.holds[behaviour.index]

    def is_enabled(self, behaviour: Behaviour) -> bool:
        """Return whether all optional behaviours around one, and itself, are enabled."""
        return all(self._state.enabled[index] for index in behaviour.switches)

    def is_active(self, action: Action) -> bool:
        """Return whether an action is active."""
        return self._state.active[action.index]

    def against(self, behaviour: Behaviour) -> tuple[str, ...]:
        """Return why a behaviour does not hold as of the last event."""
        with self._looking():
            return causes_against_behaviour(self._written, behaviour, self._state, self._now_ns)

    # Time ---------------------------------------------------------------------------------------

    def _deadlines(self) -> Iterator[int]:
        """Yield every pending time at which a verdict can change by itself."""
        for each, state in zip(self._program.inputs, self._state.inputs, strict=True):
            if each.timeout_ns is not None and not state.missing:
                yield state.base_ns + each.timeout_ns
        ends: list[int] = []
        for condition in self._temporal:
            end = condition.row.deadline(remembered(condition, self._state))
            if end is not None:
                ends.append(end)
        for age in self._ages:
            counted_ns = self._state.inputs[age.input].counted_ns
            if counted_ns is not None:
                ends += [counted_ns + change for change in age_changes(age)]
        for frequency in self._frequencies:
            ends.append(self._state.first_of(frequency) + frequency.elapsed_ns)
        yield from (end for end in ends if end > self._now_ns)

    def _catch_up(self, t_ns: int) -> None:
        if t_ns < self._now_ns:
            self._step_back(t_ns)
        while (due_ns := self.next_deadline) is not None and due_ns <= t_ns:
            self._now_ns = due_ns
            for each, state in zip(self._program.inputs, self._state.inputs, strict=True):
                if each.timeout_ns is not None and state.base_ns + each.timeout_ns <= due_ns:
                    state.missing = True
                    self._make_unknown(each)
            self._evaluate()
        self._now_ns = t_ns

    def _step_back(self, t_ns: int) -> None:
        self._now_ns = t_ns
        self.events.append(Event(t_ns, "clock_step"))
        self._state.forget(t_ns)
        self._evaluate()

    # Messages -----------------------------------------------------------------------------------

    def _observe(self, each: Input, leaves: Mapping[int, LeafValue], t_ns: int) -> None:
        for leaf in each.leaves:
            self._state.values[leaf] = leaves[leaf]
        if not self._counts(each):
            self._make_unknown(each)
            return
        state = self._state.inputs[each.index]
        state.base_ns = state.counted_ns = t_ns
        state.stamps_ns.append(t_ns)
        state.missing, state.known = False, True
        for function in self._functions_of(each):
            if function.state is not None:
                self._follow(function, function.state, t_ns)

    def _counts(self, each: Input) -> bool:
        """Return whether the message just stored counts: no element missing, no NaN, guards met."""
        for index in each.leaves:
            leaf, value = self._program.leaves[index], self._state.values[index]
            if value is None or (leaf.nan_is_unknown and _has_nan(value)):
                return False
        for function in self._functions_of(each):
            guard = FUNCTIONS[function.function].guard
            if guard is not None:
                tested = [
                    evaluate_value(function.arguments[n], self._state) for n in guard.arguments
                ]
                if not guard.evaluate(*tested):
                    return False
        return True

    def _follow(self, function: Apply, number: int, t_ns: int) -> None:
        """Update the memory of a function with the message just stored."""
        if number not in self._state.memories:
            self._state.memories[number] = FUNCTIONS[function.function].new_memory()
        memory = self._state.memories[number]
        memory.follow(t_ns, *(evaluate_value(each, self._state) for each in function.arguments))

    def _make_unknown(self, each: Input) -> None:
        self._state.make_unknown(each.index)
        for function in self._functions_of(each):
            if function.state is not None:
                self._state.memories.pop(function.state, None)

    def _functions_of(self, each: Input) -> Iterator[Apply]:
        return (function for function in self._functions if function.input == each.index)

    # Verdicts and actions -----------------------------------------------------------------------

    def _evaluate(self) -> None:
        """Process one event: all rules, all behaviours, and the requested resets, by rounds."""
        self._ran.clear()
        for each in self._rounds:
            for rule in each.rules:
                self._judge(rule)
            for behaviour in each.behaviours:
                self._behave(behaviour, enclosing=True)
            for action in each.resets:
                if action.reset_by in self._ran:
                    self._try_reset(action.index)

    def _judge(self, rule: Rule) -> None:
        verdict = evaluate_condition(rule.condition, self._state, self._now_ns)
        if (verdict is True) != (self._state.verdicts[rule.index] is True):
            self._state.turned_ns[rule.index] = self._now_ns
        self._state.verdicts[rule.index] = verdict

    def _behave(self, behaviour: Behaviour, enclosing: Verdict) -> None:
        verdict = evaluate_condition(behaviour.condition, self._state, self._now_ns)
        enabled = all(self._state.enabled[index] for index in behaviour.switches)
        holds = conjunction(enclosing, enabled, verdict)
        rises = holds is True and self._state.holds[behaviour.index] is not True
        self._state.holds[behaviour.index] = holds
        for item in behaviour.body:
            if isinstance(item, Behaviour):
                self._behave(item, holds)
            elif rises:
                self._run(item, behaviour)

    def _run(self, trigger: Trigger, behaviour: Behaviour) -> None:
        self._ran.add(trigger.action)
        self._state.active[trigger.action] = True
        name = self._program.actions[trigger.action].name
        self.events.append(
            Event(self._now_ns, "trigger", name, behaviour.name, trigger.arguments, behaviour.span)
        )

    def _try_reset(self, index: int) -> None:
        """Reset an active action if every condition that triggers it is known to be false."""
        action = self._program.actions[index]
        if not self._state.active[index]:
            return
        found = self._refusing(action)
        refused = any(found)
        self._state.active[index] = refused
        kind: EventKind = "refused" if refused else "reset"
        self.events.append(Event(self._now_ns, kind, action.name, None, (), action.span, *found))

    def _refusing(self, action: Action) -> tuple[tuple[str, ...], ...]:
        """Return the behaviours that refuse a reset: those that hold, are unknown, are coming."""
        callers = self._written.actions[action.index].triggered_by
        found = refusing(callers, self._early, self._state.holds)
        return tuple(tuple(self._names[index] for index in each) for each in found)


def constant_values(program: Program, given: Mapping[str, float]) -> list[float]:
    """Return the values of the tunable constants of a program.

    Raises:
        ValueError: a constant cannot have its value, or is not a tunable one.
    """
    names = {each.name for each in program.tunables}
    for name in given:
        if name not in names:
            raise ValueError(f"no tunable constant {name}")
    for each in program.tunables:
        refusal = each.refusal(given.get(each.name, each.default))
        if refusal:
            raise ValueError(f"{each.name}: {refusal}")
    return [float(given.get(each.name, each.default)) for each in program.tunables]


def age_changes(age: Age) -> tuple[int, ...]:
    """Return the ages, in nanoseconds, at which the result of a comparison of an age changes."""
    reached, passed = age.bound_ns, age.bound_ns + 1
    match age.operator:
        case ">=" | "<":
            return (reached,)
        case ">" | "<=":
            return (passed,)
        case _:
            return (reached, passed)


def _has_nan(value: LeafValue) -> bool:
    if isinstance(value, Iterable):
        return any(is_nan(element) for element in value)
    return is_nan(value)
