"""What the rules notice of values that are unknown: by asking for them, or by being failsafe."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from deros.metamodels import rules
from deros.monitor import ir, walk
from deros.monitor.functions import FUNCTIONS, Argument

Key = tuple[str, tuple[ir.ValueExpression | int, ...]]
"""What can be unknown by itself: a function, an input that is NaN, or one that is silent."""

Function = ir.Apply | ir.Compute


@dataclass(frozen=True, slots=True)
class Used:
    """The rules that behaviours depend on, by themselves or by other rules.

    Attributes:
        rules: of any behaviour.
        firm: the indices of those of behaviours that cannot be disabled, by themselves or with one
            around them.
        exposed: the indices of those that a behaviour can see while they are unknown: not only
            through failsafe rules.
    """

    rules: list[ir.Rule]
    firm: frozenset[int]
    exposed: frozenset[int]


def used_rules(written: rules.Rules, program: ir.Program) -> Used:
    """Return the rules that behaviours depend on."""
    optional: set[int] = set()
    used: set[int] = set()
    firm: set[int] = set()
    for behaviour in walk.behaviours(program):
        if behaviour.optional or behaviour.parent in optional:
            optional.add(behaviour.index)
        for part in walk.parts(behaviour.condition):
            if isinstance(part, ir.RuleRef):
                used.add(part.rule)
                if behaviour.index not in optional:
                    firm.add(part.rule)
    exposed = set(used)
    # A behaviour that could not be read may depend on what it mentions.
    lost = {each.index for each in program.rules if written.source.mentions_lost(each.full_name)}
    used |= lost
    firm |= lost
    for rule in reversed(program.rules):  # a rule comes after those that it names
        named = {part.rule for part in walk.parts(rule.condition) if isinstance(part, ir.RuleRef)}
        used |= named if rule.index in used else set()
        firm |= named if rule.index in firm else set()
        is_failsafe = isinstance(rule.condition, ir.Failsafe)
        exposed |= named if rule.index in exposed and not is_failsafe else set()
    rules_used = [program.rules[each] for each in sorted(used)]
    return Used(rules_used, frozenset(firm), frozenset(exposed))


@dataclass(frozen=True, slots=True)
class Noticed:
    """What rules that behaviours depend on notice.

    Attributes:
        used: these rules.
        nan: the inputs that can be NaN.
        everywhere: in any of them.
        firmly: in those that cannot be disabled.
    """

    used: Used
    nan: frozenset[int]
    everywhere: frozenset[Key]
    firmly: frozenset[Key]

    def beside(self, rule: int | None) -> frozenset[Key]:
        """Return what is noticed wherever a rule counts; ``None`` stands for a behaviour."""
        return self.firmly if rule is None or rule in self.used.firm else self.everywhere

    def loss_of(self, index: int, rule: int | None) -> bool:
        """Return whether it is noticed, wherever a rule counts, that an input is unknown."""
        return key_of_input("input" if index in self.nan else "silence", index) in self.beside(rule)


def noticed_of(written: rules.Rules, program: ir.Program) -> Noticed:
    """Return what the rules of a program notice."""
    used = used_rules(written, program)
    nan = frozenset(leaf.input for leaf in program.leaves if leaf.can_be_nan)
    everywhere: set[Key] = set()
    firmly: set[Key] = set()
    for rule in used.rules:
        keys = set(_noticed(program, rule.condition))
        everywhere |= keys
        firmly |= keys if rule.index in used.firm else set()
    return Noticed(used, nan, frozenset(everywhere), frozenset(firmly))


def key_of_input(kind: str, index: int) -> Key:
    """Return the key of an input that is NaN (``input``) or silent (``silence``)."""
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
    return name, function.arguments


def _noticed(program: ir.Program, condition: ir.Condition) -> Iterator[Key]:
    """Yield the functions for which a rule detects that they are unknown."""
    silent = (index for part in walk.parts(condition) for index in _asked(part))
    yield from (key_of_input("silence", index) for index in silent)
    asked = [part for part in walk.parts(condition) if isinstance(part, ir.Unknown)]
    yield from (key_of_input("input", each.input) for each in asked)
    for value in walk.values(asked):
        if isinstance(value, ir.Apply):
            yield key_of(value)
    if not isinstance(condition, ir.Failsafe):
        return
    named = walk.named_rules(condition, program.rules)
    wholes = [*(program.rules[index].condition for index in named), condition]
    parts = (part for whole in wholes for part in walk.parts(whole))
    values = walk.values(part for part in parts if not isinstance(part, ir.Unknown))
    for key in dict.fromkeys(key for each in values for key in _keys(each, program.leaves)):
        lost = _Lost(key, program.leaves, {})
        for index, whole in zip(named, wholes, strict=False):
            not_false, not_true = _while_lost(whole, lost)
            lost.verdicts[index] = not_false, not_true and not isinstance(whole, ir.Failsafe)
        if _while_lost(condition, lost)[0]:
            yield key


def _keys(value: ir.ValueExpression, leaves: Sequence[ir.Leaf]) -> Iterator[Key]:
    """Yield what makes a value unknown by itself: a function, and a NaN of an input."""
    if isinstance(value, Function):
        yield key_of(value)
    if isinstance(value, ir.Read):
        yield key_of_input("input", leaves[value.leaf].input)
    elif isinstance(value, ir.Apply):
        yield key_of_input("input", value.input)


@dataclass(frozen=True, slots=True)
class _Lost:
    """A function or an input that is unknown.

    Attributes:
        key: of it.
        leaves: of the program.
        verdicts: by rule, what :func:`_while_lost` returns of it.
    """

    key: Key
    leaves: Sequence[ir.Leaf]
    verdicts: dict[int, tuple[bool, bool]]


def _while_lost(condition: ir.Condition, lost: _Lost) -> tuple[bool, bool]:
    """Return whether a condition is surely not false, and not true, while something is unknown."""
    match condition:
        case ir.Not():
            not_false, not_true = _while_lost(condition.operand, lost)
            return not_true, not_false
        case ir.And() | ir.Or():
            every = [_while_lost(each, lost) for each in condition.operands]
            none_false = [not_false for not_false, _ in every]
            none_true = [not_true for _, not_true in every]
            if isinstance(condition, ir.And):
                return all(none_false), any(none_true)
            return any(none_false), all(none_true)
        case ir.For():
            not_false, not_true = _while_lost(condition.operand, lost)
            return not_false and not_true, not_true  # true for too short a time is false
        case ir.Once():  # it may be true from before
            return _while_lost(condition.operand, lost)[0], False
        case ir.Since():  # it may be false, or true, from before
            return False, False
        case ir.Begins() | ir.Failsafe():
            return _while_lost(condition.operand, lost)
        case ir.RuleRef():
            return lost.verdicts[condition.rule]
        case ir.Unknown():
            return False, False
        case _:
            read = walk.values([condition])
            surely = any(lost.key in _keys(each, lost.leaves) for each in read)
            return surely, surely


def _asked(condition: ir.Condition) -> tuple[int, ...]:
    """Return the inputs that a condition itself, not a part of it, checks for silence."""
    match condition:
        case ir.Missing(input=index) | ir.Unknown(input=index):
            return (index,)
        case ir.Failsafe(inputs=inputs):
            return inputs
        case _:
            return ()
