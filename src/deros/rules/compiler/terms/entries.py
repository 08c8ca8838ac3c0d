"""Resolves ``any()``, ``all()`` and ``count()`` of the entries of arrays.

The condition inside is built as any other one, while the name of an array stands for an entry of
it, and is then turned into a formula of the entries at one index.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from fractions import Fraction

from deros import codes
from deros.diagnostics import Related, Span
from deros.interfaces.fields import FieldPath, ResolvedField
from deros.interfaces.types import FieldType
from deros.models import rules
from deros.rules.compiler.scope.resolved import (
    AppliedFunction,
    DeclaredInput,
    EntriesHold,
    Value,
    family,
)
from deros.rules.compiler.scope.scope import Scope
from deros.rules.compiler.terms.term_names import shortened
from deros.rules.functions.reads import strip_comments
from deros.rules.program import formulas, ir, walk
from deros.rules.program.bounds import type_bounds

Build = Callable[[rules.Comparison | rules.Membership | rules.Truth], ir.Condition | None]

_EXACT = 2**53
"""Below this, a double holds every integer, so that rounding changes no comparison."""


@dataclass(slots=True)
class Array:
    """An array in the condition: its input, its reading, its type and where it is first named."""

    input: DeclaredInput
    read: ir.Read
    type: FieldType
    span: Span


@dataclass(slots=True)
class Inside:
    """What is read in the condition of one ``any()``, ``all()`` or ``count()``, by leaf.

    Attributes:
        word: the word in question.
        arrays: those that are named, in order.
    """

    word: str
    arrays: dict[int, Array] = field(default_factory=dict)


class Entries:
    """Resolves conditions on entries within a scope. ``None``: a fault has been reported."""

    def __init__(self, scope: Scope) -> None:
        """Resolve within a scope."""
        self._scope = scope
        self._inside: Inside | None = None
        self.build: Build = lambda _: None
        """Builds the comparisons; given by what resolves them."""

    @property
    def is_open(self) -> bool:
        """Whether the condition of one is being resolved, so that arrays stand for entries."""
        return self._inside is not None

    def resolve(self, term: rules.Entries) -> tuple[Value | EntriesHold, AppliedFunction] | None:
        """Return how many entries satisfy a condition, or whether one does or all do."""
        self._inside = inside = Inside(term.word)
        try:
            entry = self._entry(term.condition)
        finally:
            self._inside = None
        if entry is None or not self._fit(inside, term):
            return None
        written = strip_comments(term.condition.span.text)
        if term.word == "all":
            entry, written = _negated(entry), _not(term.condition, written)
        arrays = [each for _, each in sorted(inside.arrays.items())]
        names = {f"leaf {each.read.leaf}": f"x{n}" for n, each in enumerate(arrays, 1)}
        formula = formulas.renamed(formulas.Formula((), entry), names)
        owner = arrays[0].input
        reads = tuple(each.read for each in arrays)
        index = self._scope.use(owner)
        counted = ir.Apply("matches", reads, index, entry=formula.result, wording=written)
        of_any_length = [each.type for each in arrays if each.type.array != "fixed"]
        applied = AppliedFunction(counted, (*of_any_length, arrays[0].type)[0], term.span)
        found: Value | EntriesHold
        if term.word == "count":
            found = self._counted(counted, owner, arrays)
        else:
            operator: ir.Operator = ">=" if term.word == "any" else "<"
            shown = ir.Wording(operator, "", ("1",))
            condition = ir.Compare(counted, operator, ir.Const(1), shown)
            found = EntriesHold(owner, condition, counted)
        return found, applied

    def _counted(self, counted: ir.Apply, owner: DeclaredInput, arrays: list[Array]) -> Value:
        sizes = [each.type.size for each in arrays if each.type.size is not None]
        bounds = Fraction(0), Fraction(min(sizes)) if sizes else math.inf
        plain = self._scope.units.parse("1")
        return Value(counted, FieldType("uint64"), plain, owner, bounds)

    def entry(
        self, owner: DeclaredInput, path: FieldPath, found: ResolvedField, span: Span
    ) -> Value | None:
        """Return an entry of the array at a path, in a condition on entries."""
        assert self._inside is not None
        kind = found.type
        word = self._inside.word
        if not kind.is_array:
            self.refuse(f"'{span.text}' is {shortened(kind)}, not an array", span)
            return None
        if not (kind.element.is_number or kind.base == "bool"):
            message = f"'{word}()' needs flags or numbers, '{span.text}' is {shortened(kind)}"
            self._fault(message, span)
            return None
        read = self._scope.read(owner, path, kind)
        self._inside.arrays.setdefault(read.leaf, Array(owner, read, kind, span))
        units = self._scope.field_units
        unit = units.unit_of(owner.topic, owner.type, path)
        return Value(
            read,
            kind.element,
            unit,
            owner,
            units.share_bounds(owner.topic, owner.type, path) or type_bounds(kind.element),
            found.parent,
            undeclared=((owner.topic, path),) if unit is None else (),
        )

    def _fault(self, message: str, span: Span, hint: str = "") -> None:
        self._scope.fault(codes.WRONG_FUNCTION_ARGUMENT, message, span, hint)

    # The arrays ---------------------------------------------------------------------------------

    def _fit(self, inside: Inside, term: rules.Entries) -> bool:
        """Return whether there are arrays, of one message; else report it."""
        if not inside.arrays:
            message = f"'{term.word}()' names no array"
            self._fault(message, term.span, f"write '{term.word}(INPUT)' with an array of flags")
            return False
        first, *others = inside.arrays.values()
        for other in others:
            if other.input is not first.input:
                related = (Related(first.span, f"'{first.span.text}' is of another input"),)
                message = f"'{term.word}()' takes arrays of one message, so of one input"
                hint = "declare the whole message as one input, and name both as its fields"
                code = codes.WRONG_FUNCTION_ARGUMENT
                self._scope.fault(code, message, other.span, hint, related)
                return False
            sizes = {each.type.size for each in (first, other) if each.type.array == "fixed"}
            if len(sizes) > 1:
                message = (
                    f"'{first.span.text}' has {first.type.size} entries,"
                    f" '{other.span.text}' has {other.type.size}"
                )
                self._fault(message, other.span, "the entries at the same index are compared")
                return False
        return True

    # The condition ------------------------------------------------------------------------------

    def _entry(self, condition: rules.Condition) -> formulas.Expression | None:
        """Return a condition on entries as one of formulas, its names being those of leaves."""
        match condition:
            case rules.Not():
                inner = self._entry(condition.operand)
                return inner and _negated(inner)
            case rules.And() | rules.Or():
                parts = [self._entry(each) for each in condition.operands]
                operands = tuple(each for each in parts if each is not None)
                if len(operands) < len(parts):
                    return None
                is_and = isinstance(condition, rules.And)
                return formulas.Logical("and" if is_and else "or", operands)
            case rules.Comparison() | rules.Membership() | rules.Truth():
                built = self.build(condition)
                return None if built is None else self._formula(built, condition.span)
        self._beside(condition.span)
        return None

    def _formula(self, condition: ir.Condition, span: Span) -> formulas.Expression | None:
        match condition:
            case ir.Not():
                inner = self._formula(condition.operand, span)
                return inner and _negated(inner)
            case ir.Truth(operand=ir.Read() as read):
                return _name(read)
            case ir.Compare(left=ir.Read() as left, operator=operator, right=right) if (
                self._is_flag(left)
            ):
                return _of_flags(_name(left), operator, right)
            case ir.Compare() if self._is_exact(condition):
                return _relation(condition.left, condition.operator, condition.right)
            case ir.Within(operand=operand, lower=lower, upper=upper) if self._is_exact(condition):
                above: ir.Operator = ">=" if condition.lower_closed else ">"
                below: ir.Operator = "<=" if condition.upper_closed else "<"
                ends = (_relation(operand, above, lower), _relation(operand, below, upper))
                return formulas.Logical("and", ends)
            case ir.Compare() | ir.Within() if all(map(_is_entry, _sides(condition))):
                message = f"'{span.text}' compares 64-bit integers that a double does not hold"
                self._fault(message, span, "compare them with constants below 2^53")
                return None
        self._beside(span)
        return None

    def _is_flag(self, read: ir.Read) -> bool:
        return family(self._scope.leaves[read.leaf].type.element) == "boolean"

    def _is_exact(self, condition: ir.Compare | ir.Within) -> bool:
        """Return whether entries rounded to doubles compare as they are."""
        sides = _sides(condition)
        if not all(map(_is_entry, sides)):
            return False
        leaves = [leaf for each in sides for leaf in walk.leaves(each)]
        if all(self._scope.leaves[leaf].type.base not in ("int64", "uint64") for leaf in leaves):
            return True
        constants = [each.value for each in sides[1:] if isinstance(each, ir.Const)]
        small = all(isinstance(each, float | int) and abs(each) < _EXACT for each in constants)
        return small and len(constants) == len(sides) - 1

    def _beside(self, span: Span) -> None:
        """Report what is not a comparison of entries."""
        message = f"'{span.text}' is not about the entries of arrays"
        self.refuse(message, span)

    def refuse(self, message: str, span: Span) -> None:
        """Report what cannot stand in a condition on entries."""
        assert self._inside is not None
        word = self._inside.word
        hint = f"'{word}()' compares entries as they are, with constants and with one another"
        self._fault(message, span, hint)


def _sides(condition: ir.Compare | ir.Within) -> tuple[ir.ValueExpression, ...]:
    if isinstance(condition, ir.Compare):
        return condition.left, condition.right
    return condition.operand, condition.lower, condition.upper


def _is_entry(value: ir.ValueExpression) -> bool:
    """Return whether a value is an entry, in whatever unit, or a constant."""
    while isinstance(value, ir.Scale):
        value = value.operand
    return isinstance(value, ir.Read | ir.Const)


def _not(condition: rules.Condition, written: str) -> str:
    """Return the opposite of a condition, as rules write it."""
    match condition:
        case rules.Not(operand=rules.Truth(operand=term)):
            return strip_comments(term.span.text)
        case rules.Truth():
            return f"not {written}"
    return f"not ({written})"


def _negated(condition: formulas.Expression) -> formulas.Expression:
    if isinstance(condition, formulas.Negation):
        return condition.operand
    return formulas.Negation(condition)


def _name(read: ir.Read) -> formulas.Name:
    return formulas.Name(f"leaf {read.leaf}")


def _of_flags(
    left: formulas.Name, operator: ir.Operator, right: ir.ValueExpression
) -> formulas.Expression:
    if isinstance(right, ir.Const):
        return left if bool(right.value) is (operator == "=") else formulas.Negation(left)
    assert isinstance(right, ir.Read)
    other: formulas.Expression = _name(right)
    same, opposite = other, formulas.Negation(other)
    if operator != "=":
        same, opposite = opposite, same
    both = formulas.Logical("and", (left, same))
    neither = formulas.Logical("and", (formulas.Negation(left), opposite))
    return formulas.Logical("or", (both, neither))


def _relation(
    left: ir.ValueExpression, operator: ir.Operator, right: ir.ValueExpression
) -> formulas.Expression:
    sign: formulas.Comparison = "==" if operator == "=" else operator
    return formulas.Relation(sign, _number(left), _number(right))


def _number(value: ir.ValueExpression) -> formulas.Expression:
    match value:
        case ir.Const(value=int() | float() as number):
            return formulas.Number(float(number))
        case ir.Read():
            return _name(value)
        case ir.Scale():
            factor, offset = formulas.Number(value.factor), formulas.Number(value.offset)
            scaled = formulas.Binary("*", _number(value.operand), factor)
            return formulas.Binary("+", scaled, offset) if value.offset else scaled
    raise AssertionError(f"{value} is not a number of an entry")
