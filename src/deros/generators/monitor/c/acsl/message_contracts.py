"""What is to be proved of the functions that take messages: what each does to every field."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from deros.generators.monitor.c.acsl.changes import (
    ALL,
    DONE,
    INTERVALS_RUN_ON,
    KEPT_BY_JUDGING,
    LATCHED_KEPT,
    NOTHING_DONE,
    VERDICTS_DATED,
    Changes,
)
from deros.generators.monitor.c.acsl.contracts import Contract, all_of, iff
from deros.generators.monitor.c.acsl.predicates import SOUND, Predicates
from deros.generators.monitor.c.acsl.quantities import array_predicate, is_value
from deros.generators.monitor.c.acsl.rule_contracts import EARLIER_DEADLINE, RuleContracts
from deros.generators.monitor.c.code.computed import computed_functions
from deros.generators.monitor.c.code.handlers import Handler, Parameter
from deros.generators.monitor.c.code.layout import Finding, Term
from deros.generators.monitor.c.code.stamps import frequencies_of
from deros.generators.monitor.c.code.view import Forget, MessageView, MonitorView
from deros.interfaces.types import FLOAT_TYPES
from deros.rules.engine.engine import age_changes
from deros.rules.functions.functions import FUNCTIONS, Argument, Guard
from deros.rules.program import walk
from deros.rules.program.ir import Age, Apply, Condition, Input, Read, ValueExpression


class MessageContracts:
    """Writes the contracts of what a message of one topic runs."""

    def __init__(
        self,
        view: MonitorView,
        predicates: Predicates,
        changes: Changes,
        rules: RuleContracts,
    ) -> None:
        """Use the names of a layout."""
        self._view = view
        self._program = view.program
        self._layout = view.layout
        self._predicates = predicates
        self._rules = rules
        self._changes = changes

    def contracts(self, message: MessageView) -> Iterator[tuple[str, Contract]]:
        """Yield the contract of each function that takes a topic's messages."""
        if message.handler.observer:
            yield message.handler.observer, self._observe(message.handler)
        if len(message.judges) > 1:
            yield message.judge, self._rules.judge_by(message)
        if message.after:
            yield message.after, self._after(message)
        if message.handler.taker:
            yield message.handler.taker, self._take(message)
        yield message.handler.function, self._message(message)

    def _after(self, message: MessageView) -> Contract:
        """Return that all is judged anew that a message can have changed."""
        contract = Contract(["\\valid(m)", *SOUND, "m->due > m->now"], list(ALL))
        names = self._layout.verdicts
        late = [each.index for each in self._view.late_rules]
        apart = {*message.rules, *late}
        others = [f"judged_{name}(m)" for each, name in names.items() if each not in apart]
        touched = [f"judged_{names[each]}(m)" for each in message.rules]
        with_act = touched if message.acts else others
        with_act += [*(f"judged_{names[each]}(m)" for each in late), "acted(m)"]
        contract.requires += [f"m->started != 0 ==> {all_of(others)}"] if others else []
        contract.requires.append(f"m->started != 0 && news == 0 ==> {all_of(touched)}")
        contract.requires.append("(m->started == 0 ==> unacted(m))")
        contract.ensures += [*self._settled(), KEPT_BY_JUDGING, VERDICTS_DATED, INTERVALS_RUN_ON]
        changed = self._changes.changed(names[each] for each in message.rules)
        contract.cases["first"] = "m->started == 0"
        contract.of_case["first"] = list(DONE)
        contract.cases["news"] = "m->started != 0 && news != 0"
        contract.of_case["news"] = list(DONE)
        if not message.acts:
            contract.of_case["news"] = [
                *(f"{changed} ==> {each}" for each in DONE),
                f"!{changed} ==> {NOTHING_DONE}",
            ]
        contract.cases["none"] = "m->started != 0 && news == 0"
        contract.of_case["none"] = [NOTHING_DONE]
        return contract

    def _take(self, message: MessageView) -> Contract:
        """Return what a message changes that comes now.

        A function of its own, so that no proof has to look through a message and the time before.
        """
        return self._taken(message.handler, "\\old(m->now)")

    def _message(self, message: MessageView) -> Contract:
        """Return what a message changes, and the time before it."""
        return self._taken(message.handler, "time_of(t)")

    def _taken(self, handler: Handler, now: str) -> Contract:
        """Return that a message that comes at some time is settled."""
        contract = Contract(["\\valid(m)", "sane(m)"], list(ALL))
        contract.requires += self._arrays(handler)
        contract.ensures += [*self._settled(), f"m->now == {now}"]
        contract.ensures.append(self._changes.kept_over_time_but(self._stored(handler)))
        for each in map(self._program.inputs.__getitem__, handler.inputs):
            contract.ensures += self._either(each, handler, self._says(each, handler), [])
        return contract

    def _settled(self) -> list[str]:
        """Return that a monitor is sane and has judged, in parts: each is a proof of its own."""
        parts = [*SOUND, "m->due > m->now", "m->started == 1", "judged(m)", "acted(m)"]
        return [*parts, LATCHED_KEPT]

    def _stored(self, handler: Handler) -> list[str]:
        """Return the fields that hold what a message says."""
        terms = [term for index in handler.inputs for term in self._layout.terms_of(index)]
        found = [each.name for _, each in self._findings(handler.inputs)]
        return [*(term.name for term in terms), *self._computed(handler), *found]

    def _computed(self, handler: Handler) -> dict[str, Term]:
        """Return the arithmetic that reads what a message says, by the names of the fields."""
        terms = [
            term for index in handler.inputs for term in self._layout.computed_of(index).values()
        ]
        return {term.name: term for term in terms}

    def _findings(self, inputs: tuple[int, ...]) -> list[tuple[Condition, Finding]]:
        return [
            (condition, each)
            for condition, each in self._layout.findings.items()
            if each.inputs & set(inputs)
        ]

    # What a message says ------------------------------------------------------------------------

    def _observe(self, handler: Handler) -> Contract:
        """Return what a message's values become: known, compared, and heard in time."""
        terms = [term for index in handler.inputs for term in self._layout.terms_of(index)]
        memories = [
            each for index in handler.inputs for each in self._layout.memories_of(index).values()
        ]
        fields = [self._layout.inputs[index] for index in handler.inputs]
        bases = [n for each in fields for n in (each.base, each.came, *each.stamps) if n]
        flags = [each.missing for each in fields if each.missing]
        flags += [each.known for each in fields if each.known]
        flags += [term.known for term in (*terms, *self._computed(handler).values())]
        stored = self._stored(handler)
        changed = [*bases, *dict.fromkeys(flags), *stored]
        changed += [name for each in memories for name in each.numbers]
        windows = [each.window for each in memories if each.window]
        counts = [f"{each}.count" for each in windows]
        own = self._predicates.ranges(["now", *dict.fromkeys(changed), *counts])
        own += self._predicates.timeouts_in_time("m->due", bases)
        own += self._predicates.ends_in_time("m->due", bases)
        own += self._predicates.unexpired(bases)
        contract = Contract(["\\valid(m)", all_of(own), *self._arrays(handler)])
        contract.assigns += [f"m->{name}" for name in (*changed, *windows)]
        contract.ensures.append(all_of(own))
        awaited = [each.came for each in fields if each.awaits]
        contract.ensures += self._news(handler, [*flags, *awaited, *stored])
        for each in map(self._program.inputs.__getitem__, handler.inputs):
            contract.ensures += self._effect(each, handler)
        if bases:
            contract.assigns.append("m->due")
            contract.ensures += EARLIER_DEADLINE
        return contract

    def _news(self, handler: Handler, names: list[str]) -> Iterator[str]:
        """Yield whether a message brings news: what rules read is another, or a message's age.

        Each direction is a goal of its own: of both together, no prover makes short work.
        """
        doubles = {t.name for t in self._layout.terms.values() if t.type == "double"}
        read = [name for name in names if name not in doubles]
        fields = [self._layout.inputs[index] for index in handler.inputs]
        is_told = any(self._ages(self._program.inputs[index]) for index in handler.inputs)
        is_told |= any(each.stamps for each in fields)
        if is_told:  # of an age, or a frequency, there is news without a change, too
            read += [n for each in fields for n in (each.base, each.came, *each.stamps) if n]
        if not read:
            yield "\\result == 0"
            return
        yield f"\\result == 0 ==> {self._changes.same(read)}"
        if not is_told:
            yield f"{self._changes.same(read)} ==> \\result == 0"

    def _effect(self, each: Input, handler: Handler) -> Iterator[str]:
        """Yield what becomes of an input's fields if a message counts, and if it does not."""
        heard = [*self._heard(each, handler), *self._says(each, handler)]
        yield from self._either(each, handler, heard, self._unheard(each, handler))

    def _either(
        self, each: Input, handler: Handler, heard: list[str], unheard: list[str]
    ) -> Iterator[str]:
        """Yield what holds if a message counts, and if it does not: then nothing is known, too."""
        if not heard:
            return
        counts, is_all = self._counts(each, handler)
        rest = [*self._unknown(each), *unheard]
        if counts == "\\true" and is_all:  # every message does
            yield all_of(heard)
        elif is_all:
            yield f"{counts} ==> {all_of(heard)}"
            yield f"!{counts} ==> {all_of(rest)}"
        else:
            yield f"({all_of([counts, *heard])} || {all_of(rest)})"

    def _heard(self, each: Input, handler: Handler) -> Iterator[str]:
        """Yield that a message counts from now."""
        fields = self._layout.inputs[each.index]
        if fields.base:
            yield f"m->{fields.base} == m->now"
        if fields.stamps:
            before = ("m->now", *(f"\\old(m->{name})" for name in fields.stamps))
            pairs = zip(fields.stamps, before, strict=False)
            yield from (f"m->{name} == {value}" for name, value in pairs)
        if fields.came:
            yield f"m->{fields.came} == 1"
        if fields.missing:
            yield f"m->{fields.missing} == 0"
        for memory in self._layout.memories_of(each.index).values():
            if memory.last_t:
                yield f"m->{memory.last_t} == m->now"
        for value, term in self._layout.computed_of(each.index).items():
            operands = [self._layout.terms[operand] for operand in value.operands]
            name = computed_functions(self._program)[value].name
            texts = (
                f"{'' if each.type == 'double' else '(double)'}m->{each.name}" for each in operands
            )
            yield f"is_{name}({', '.join([f'm->{term.name}', *texts])})"
            flags = dict.fromkeys(each.known for each in operands if each.known)
            known = [f"m->{flag} != 0" for flag in flags]
            yield iff(f"m->{term.known} != 0", all_of([*known, f"!\\is_NaN(m->{term.name})"]))
        for condition, finding in self._findings((each.index,)):
            yield iff(f"m->{finding.name} != 0", self._predicates.semantics.holds(condition))
        if len(handler.inputs) == 1:
            waits = [each.timeout_ns] if each.timeout_ns is not None and fields.base else []
            waits += [wait for age in self._ages(each) for wait in age_changes(age) if wait > 0]
            due = "\\old(m->due)"
            due = f"\\min({due}, m->now + {min(waits)})" if waits else due
            for frequency in frequencies_of(self._program, each.index):
                end = f"m->{fields.stamps[frequency.messages - 1]} + {frequency.elapsed_ns}"
                ahead = f"({end} > m->now ? {end} : {self._predicates.macro('NEVER')})"
                due = f"\\min({due}, {ahead})"
            yield f"m->due == {due}"

    def _says(self, each: Input, handler: Handler) -> list[str]:
        """Return what is known of a message that counts, and what it is."""
        leaves = self._leaves(handler)
        doubles = {
            leaf: name
            for leaf, name in leaves.items()
            if self._program.leaves[leaf].type.base in FLOAT_TYPES
        }
        known = self._layout.inputs[each.index].known
        found = [f"m->{known} == 1"] if known else []
        lengths: dict[object, str] = {}
        numbers = []
        for term in self._layout.terms_of(each.index):
            if isinstance(term.value, Apply):
                quaternion = FUNCTIONS[term.value.function].argument is Argument.QUATERNION
                if quaternion and term.value.arguments not in lengths:
                    lengths[term.value.arguments] = f"length_{len(lengths) + 1}"
            if term.type == "double":
                if not isinstance(term.value, Read):
                    found.append(iff(f"m->{term.known} != 0", f"!\\is_NaN(m->{term.name})"))
                read = leaves if _is_of_stamps(term.value) else doubles
                numbers.append(is_value(f"m->{term.name}", term.value, read, lengths))
            elif isinstance(term.value, Read) and not term.texts:
                found.append(f"m->{term.name} == {leaves[term.value.leaf]}")
        numbers = [text for text in numbers if text]
        if lengths:
            of = [
                f"is_length_of({name}, {', '.join(_parts(arguments, doubles))})"
                for arguments, name in lengths.items()
            ]
            names = ", ".join(lengths.values())
            return [*found, f"(\\exists double {names}; {' && '.join([*of, *numbers])})"]
        return [*found, *numbers]

    def _forgets(self, each: Input) -> list[Forget]:
        """Return what is forgotten when a message of an input does not count."""
        return self._changes.forgets_of(self._layout.forgets.get(each.index, ""))

    def _unknown(self, each: Input) -> list[str]:
        """Return that no value of an input is known."""
        return [text for forget in self._forgets(each) for text in self._changes.forgotten(forget)]

    def _unheard(self, each: Input, handler: Handler) -> list[str]:
        """Return that of a message that does not count all else is as it was."""
        fields = self._layout.inputs[each.index]
        forgotten = [name for forget in self._forgets(each) for name in forget.changed]
        names = [fields.base, fields.came, fields.missing, *fields.stamps]
        names += [term.name for term in self._layout.terms_of(each.index)]
        # What another input of the message has a part in, too, is another if that one counts.
        others = set(handler.inputs) - {each.index}
        parts: list[Term | Finding] = [*self._layout.computed_of(each.index).values()]
        parts += [finding for _, finding in self._findings((each.index,))]
        names += [part.name for part in parts if others.isdisjoint(part.inputs)]
        for memory in self._layout.memories_of(each.index).values():
            names += memory.numbers
        kept = [name for name in names if name and name not in forgotten]
        due = ["due"] if len(handler.inputs) == 1 else []
        return [self._changes.same([*kept, *due])]

    def _counts(self, each: Input, handler: Handler) -> tuple[str, bool]:
        """Return what must hold for a message to count, and whether that is all of it."""
        tests: list[str] = []
        is_all = True
        for index in each.leaves:
            leaf, parameter = self._program.leaves[index], self._parameter(index, handler)
            if parameter is None:
                continue
            if parameter.given:
                tests.append(f"{parameter.name}_given != 0")
            if parameter.form == "array":
                tests.append(f"{parameter.name}_count <= {self._predicates.macro('MOST_ELEMENTS')}")
            if leaf.can_be_nan:
                is_all &= not leaf.type.is_array
                tests += [] if leaf.type.is_array else [f"!\\is_NaN({parameter.name})"]
        for value in self._functions_of(each):
            guard = FUNCTIONS[value.function].guard
            if guard is not None:
                tests.append(self._is_met(guard, value, handler))
        return all_of(dict.fromkeys(tests)) if tests else "\\true", is_all

    def _is_met(self, guard: Guard, value: Apply, handler: Handler) -> str:
        """Return that a function takes its arguments: that of scans asks whether one is usable."""
        tested = replace(value, arguments=tuple(value.arguments[n] for n in guard.arguments))
        return array_predicate(guard.c_call, tested, self._leaves(handler))

    def _functions_of(self, each: Input) -> list[Apply]:
        return [
            value
            for value in walk.values(walk.conditions(self._program))
            if isinstance(value, Apply) and value.input == each.index
        ]

    def _ages(self, each: Input) -> list[Age]:
        return [
            condition
            for condition in walk.conditions(self._program)
            if isinstance(condition, Age) and condition.input == each.index
        ]

    def _leaves(self, handler: Handler) -> dict[int, str]:
        return {leaf: each.name for each in handler.parameters for leaf in each.leaves}

    def _parameter(self, leaf: int, handler: Handler) -> Parameter | None:
        return next((each for each in handler.parameters if leaf in each.leaves), None)

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


def _is_of_stamps(value: ValueExpression) -> bool:
    return isinstance(value, Apply) and FUNCTIONS[value.function].argument is Argument.STAMPED


def _parts(arguments: object, leaves: dict[int, str]) -> list[str]:
    assert isinstance(arguments, tuple)
    return [leaves[each.leaf] for each in arguments if isinstance(each, Read)]
