"""What conditions can be while a value is lost: Kleene's logic on sets of verdicts."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from deros.rules.engine.evaluate import COMPARE
from deros.rules.functions.functions import FUNCTIONS, Argument
from deros.rules.program import ir, walk

Key = tuple[str, tuple[ir.ValueExpression | int, ...]]
"""What can be unknown by itself: a function, or an input (see :func:`key_of_input`)."""

Function = ir.Apply | ir.Compute
Assumed = ir.Condition | tuple[str, ir.Condition]
"""What is so: a condition, or of a ``since`` ``("before", cause)``, that it has been true since its
cause was, or ``("over", operand)``, that it is not true any more."""


class Verdicts(NamedTuple):
    """The verdicts that a condition can have."""

    true: bool
    false: bool
    unknown: bool

    @property
    def opposite(self) -> Verdicts:
        """Those of its negation."""
        return Verdicts(self.false, self.true, self.unknown)


TRUE = Verdicts(true=True, false=False, unknown=False)
FALSE = Verdicts(true=False, false=True, unknown=False)
UNKNOWN = Verdicts(true=False, false=False, unknown=True)
ANY = Verdicts(true=True, false=True, unknown=True)


# Keys -------------------------------------------------------------------------------------------


def key_of_input(kind: str, index: int) -> Key:
    """Return the key of an input.

    Args:
        kind: ``silence`` of its topic, ``nan`` from now on, or ``input`` where it is NaN now and
            then, so that it never goes missing.
        index: of the input.
    """
    return kind, (index,)


def header_of(function: ir.Apply) -> tuple[ir.ValueExpression, ...]:
    """Return the header fields that a rate over a span reads; none for other functions."""
    return function.arguments[2:] if FUNCTIONS[function.function].over_span else ()


def key_of(function: Function) -> Key:
    """Return a key that is equal for functions that are unknown for the same messages."""
    if isinstance(function, ir.Compute):
        return "arithmetic", (function,)
    if header_of(function):
        return "stamps", header_of(function)
    argument = FUNCTIONS[function.function].argument
    name = function.function
    if argument in (Argument.QUATERNION, Argument.NUMBERS):
        name = argument.value
    elif argument is Argument.ENTRIES and len(function.arguments) == 1:
        name = Argument.NUMBERS.value  # unknown as these are, for an empty array
    return name, function.arguments


# What is lost -----------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Loss:
    """A function that is unknown, or an input that is silent or NaN.

    Attributes:
        key: of it.
        program: the rules.
        inputs: those that are unknown themselves; none for a function.
        touched: the inputs that it has to do with.
        missing: those of which ``missing()`` is surely true.
    """

    key: Key
    program: ir.Program
    touched: frozenset[int]
    inputs: frozenset[int] = frozenset()
    missing: frozenset[int] = frozenset()

    def verdicts(self, leaf: ir.Condition) -> Verdicts | None:
        """Return what a condition without operands can be; ``None`` if the loss has no part in it.

        The age of a silent input passes every bound, but not before its first message.
        """
        match leaf:
            case ir.Missing(input=index):
                return TRUE if index in self.missing else None
            case ir.Unknown(input=index):
                silent = self.key[0] == "silence"
                asked = index in (self.missing if silent else self.inputs)
                return TRUE if asked or self.key in _function_keys([leaf]) else None
            case ir.Frequency(input=index):  # with no more messages that count, it falls
                return TRUE if index in self.missing else None
            case ir.Age(input=index):
                return ANY if index in self.inputs and self.key[0] == "silence" else None
            case _:
                return UNKNOWN if self._is_read(leaf) else None

    def _is_read(self, leaf: ir.Condition) -> bool:
        read = walk.inputs_read(leaf, self.program.leaves)
        return not read.isdisjoint(self.inputs) or self.key in _function_keys([leaf])


def loss_of(key: Key, program: ir.Program) -> Loss:
    """Return what is lost with a key: with an input that is silent, others of its topic.

    They are those that are missing as early.
    """
    kind, parts = key
    if kind not in ("silence", "nan", "input"):
        return Loss(key, program, frozenset(_inputs_of(parts, program)))
    assert isinstance(parts[0], int)
    lost = program.inputs[parts[0]]
    if kind != "silence":
        itself = frozenset({lost.index})
        return Loss(key, program, itself, itself, itself if kind == "nan" else frozenset())
    silent = {each.index: each.timeout_ns for each in program.inputs if each.topic == lost.topic}
    latest = lost.timeout_ns or 0
    early = {
        index for index, timeout in silent.items() if timeout is not None and timeout <= latest
    }
    unknown = frozenset(early | {lost.index})
    return Loss(key, program, unknown, unknown, frozenset(early))


def _inputs_of(values: Iterable[ir.ValueExpression | int], program: ir.Program) -> Iterator[int]:
    for value in values:
        for term in walk.terms(value) if not isinstance(value, int) else ():
            if isinstance(term, ir.Read):
                yield program.leaves[term.leaf].input
            elif isinstance(term, ir.Apply):
                yield term.input


def keys_read(leaf: ir.Condition, leaves: Sequence[ir.Leaf]) -> Iterator[Key]:
    """Yield, each once, the keys of what makes a condition without operands unknown.

    Silence makes an age unknown only before the first message, and a NaN does not.
    """
    if isinstance(leaf, ir.Missing | ir.Unknown | ir.Frequency):
        return
    kinds = ("silence",) if isinstance(leaf, ir.Age) else ("silence", "nan", "input")
    for index in sorted(walk.inputs_read(leaf, leaves)):
        yield from (key_of_input(kind, index) for kind in kinds)
    yield from dict.fromkeys(_function_keys([leaf]))


def inputs_of(
    condition: ir.Condition, named: Sequence[frozenset[int]], program: ir.Program
) -> frozenset[int]:
    """Return the inputs that a condition reads or asks for, given those of the rules it names."""
    found = walk.inputs_read(condition, program.leaves)
    for part in walk.parts(condition):
        if isinstance(part, ir.Missing | ir.Unknown | ir.Frequency):
            found.add(part.input)
        elif isinstance(part, ir.RuleRef):
            found |= named[part.rule]
    return frozenset(found)


def inputs_by_rule(program: ir.Program) -> list[frozenset[int]]:
    """Return what the rules read or ask for, by themselves or by the rules that they name."""
    found: list[frozenset[int]] = []
    for rule in program.rules:  # a rule comes after those that it names
        found.append(inputs_of(rule.condition, found, program))
    return found


def _function_keys(conditions: Iterable[ir.Condition]) -> Iterator[Key]:
    values = walk.values(conditions)
    return (key_of(each) for each in values if isinstance(each, Function))


# What follows -----------------------------------------------------------------------------------


def negated(condition: ir.Condition) -> ir.Condition:
    """Return the negation, without two ``not`` in a row."""
    return condition.operand if isinstance(condition, ir.Not) else ir.Not(condition)


def consequences(condition: ir.Condition, rules: Sequence[ir.Rule]) -> frozenset[Assumed]:
    """Return what is true wherever a condition is, itself included."""
    found: set[Assumed] = set()
    open_ = [condition]
    while open_:
        each = open_.pop()
        if each in found:
            continue
        found.add(each)
        match each:
            case ir.And(operands=operands):
                open_ += operands
            case ir.For(operand=operand):
                open_.append(operand)
            case ir.Begins(operand=lasts):
                open_.append(lasts.operand)
            case ir.RuleRef(rule=rule) if not isinstance(rules[rule].condition, ir.Failsafe):
                open_.append(rules[rule].condition)
            case ir.Not(operand=ir.Or(operands=operands)):
                open_ += map(negated, operands)
            case ir.Not(operand=ir.Once(operand=operand) | ir.Failsafe(operand=operand)):
                open_.append(negated(operand))
            case ir.Not(operand=ir.Since(cause=cause)):
                open_.append(negated(cause))
            case ir.Not(operand=ir.RuleRef(rule=rule)):
                open_.append(negated(rules[rule].condition))
            case _:
                pass
    return frozenset(found)


@dataclass(frozen=True, slots=True)
class Evaluation:
    """What conditions can be while something is lost.

    Attributes:
        loss: what is lost.
        inputs: what each rule reads; see :func:`inputs_by_rule`.
        assumed: what is true meanwhile; see :func:`consequences`.
        lasting: the ``for``, by index, that run while the value is read.
        at_once: whether the loss is new: a ``for`` on what it makes true is not true yet, unless
            it is among those that run and are not started over, and a ``within`` may still be true.
            Else it lasts.
        rules: what the rules can be that are named, but for those that can be anything.
        decided: the inputs that are lost, or of which something is assumed.
    """

    loss: Loss
    inputs: Sequence[frozenset[int]]
    assumed: frozenset[Assumed] = frozenset()
    lasting: Container[int] = ()
    at_once: bool = False
    rules: dict[int, Verdicts] = field(default_factory=dict)
    decided: set[int] = field(init=False)

    def __post_init__(self) -> None:
        """Find the inputs on which a rule must depend to be other than anything."""
        program = self.loss.program
        decided = set(self.loss.touched)
        for each in self.assumed:
            condition = each[1] if isinstance(each, tuple) else each
            decided |= inputs_of(condition, self.inputs, program)
        object.__setattr__(self, "decided", decided)

    def of(self, condition: ir.Condition, named: Sequence[int]) -> Verdicts:
        """Return the verdicts that are possible, given the rules that a condition names."""
        for index in named:
            if index not in self.rules and not self.decided.isdisjoint(self.inputs[index]):
                self.rules[index] = self._of(self.loss.program.rules[index].condition)
        return self._of(condition)

    def _of(self, condition: ir.Condition) -> Verdicts:
        if self.assumed:
            if condition in self.assumed:
                return TRUE
            if negated(condition) in self.assumed:
                return FALSE
        match condition:
            case ir.Not():
                return self._of(condition.operand).opposite
            case ir.And():
                return _all([self._of(each) for each in condition.operands])
            case ir.Or():
                return _any([self._of(each) for each in condition.operands])
            case ir.For():  # true for too short a time is false
                inner = self._of(condition.operand)
                lasts = not self.at_once or condition.index in self.lasting
                return inner if inner == TRUE and lasts else _or(inner, false=inner.true)
            case ir.Once():  # true from before, until that is over
                inner = self._of(condition.operand)
                return _or(inner, true=self.at_once)
            case ir.Times():  # what stays as it is turns no more
                inner = self._of(condition.operand)
                return Verdicts(self.at_once, inner.true or inner.false, inner.unknown)
            case ir.Since(operand=operand, cause=cause):
                before = TRUE if ("before", cause) in self.assumed else ANY
                lasts_on = _all([self._of(operand), before])
                if ("over", operand) in self.assumed:
                    lasts_on = FALSE
                return _any([self._of(cause), lasts_on])
            case ir.Begins():  # true, where it begins; then false
                return self._of(condition.operand.operand)
            case ir.Failsafe():
                inner = self._of(condition.operand)
                return Verdicts(inner.true or inner.unknown, inner.false, unknown=False)
            case ir.RuleRef():
                return self.rules.get(condition.rule, ANY)
            case _:
                return self.loss.verdicts(condition) or self._free(condition)

    def _free(self, leaf: ir.Condition) -> Verdicts:
        """Return what a condition can be, given what is assumed of the same value."""
        if isinstance(leaf, ir.Missing | ir.Unknown | ir.Frequency):
            return Verdicts(true=True, false=True, unknown=False)
        if isinstance(leaf, ir.Compare):
            opposite = ir.Compare(leaf.left, ir.OPPOSITE[leaf.operator], leaf.right)
            facts = [fact for each in self.assumed if (fact := _fact(each)) is not None]
            if any(_implies(fact, leaf) for fact in facts):
                return TRUE
            if any(_implies(fact, opposite) for fact in facts):
                return FALSE
        return ANY


def _all(every: list[Verdicts]) -> Verdicts:
    return Verdicts(
        true=all(each.true for each in every),
        false=any(each.false for each in every),
        unknown=all(each.true or each.unknown for each in every)
        and any(each.unknown for each in every),
    )


def _any(every: list[Verdicts]) -> Verdicts:
    return _all([each.opposite for each in every]).opposite


def _or(verdicts: Verdicts, *, true: bool = False, false: bool = False) -> Verdicts:
    return Verdicts(verdicts.true or true, verdicts.false or false, verdicts.unknown)


def _fact(assumed: Assumed) -> ir.Compare | None:
    """Return what is assumed as a comparison of a known value."""
    match assumed:
        case ir.Compare():
            return assumed
        case ir.Not(operand=ir.Compare(left=left, operator=operator, right=right)):
            return ir.Compare(left, ir.OPPOSITE[operator], right)
        case _:
            return None


def _implies(fact: ir.Compare, other: ir.Compare) -> bool:
    """Return whether one comparison with a number holds wherever another one does."""
    if fact.left != other.left:
        return False
    if not isinstance(fact.right, ir.Const) or not isinstance(other.right, ir.Const):
        return fact.right == other.right and fact.operator == other.operator
    bound, wanted = fact.right.value, other.right.value
    if fact.operator == "=":
        return bool(COMPARE[other.operator](bound, wanted))
    if fact.operator == other.operator == "!=":
        return bound == wanted
    upwards = fact.operator in (">", ">=")
    same_way = (">", ">=") if upwards else ("<", "<=")
    if fact.operator == "!=" or other.operator not in ("!=", *same_way):
        return False
    if bound == wanted:
        return fact.operator in (">", "<") or other.operator in (">=", "<=")
    return bool(COMPARE[">" if upwards else "<"](bound, wanted))
