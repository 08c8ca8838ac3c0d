"""From the textX objects of terms to those of :mod:`deros.models.rules`."""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator
from functools import cached_property, partial
from typing import Any, NamedTuple, cast

from deros.diagnostics import SourceFile, Span
from deros.interfaces.fields import STEP, FieldPath, PathStep, step_of
from deros.interfaces.units import UnitRegistry
from deros.metamodels.converters.convert import Converter
from deros.metamodels.matching import Token
from deros.metamodels.reading import MAX_DEPTH, too_deep
from deros.models.common import Name
from deros.models.rules import (
    Arithmetic,
    ArithmeticOperator,
    Boolean,
    Call,
    Condition,
    Entries,
    EntriesWord,
    NamePath,
    Negative,
    Number,
    String,
    Term,
    TopicPath,
)

_UNIT_OPERATOR = re.compile(r"\s*(?P<operator>[*/])\s*(?P<name>[^\W\d]\w*)")


class _Operand(NamedTuple):
    """An operand with the operator before it, if there is one, and its place with parentheses."""

    operator: Token | None
    term: Term
    span: Span


class TermConverter(Converter, ABC):
    """Converts terms; a multiple of a unit may stand before an input or a constant."""

    def __init__(self, source: SourceFile) -> None:
        """Convert the terms of one file, before :meth:`declare` as if nothing were declared."""
        super().__init__(source)
        self._declared: frozenset[str] = frozenset()
        self._definitions: tuple[Any, ...] = ()
        self._operations = 0

    def declare(self, statements: Iterable[Any]) -> None:
        """Take the names of inputs, constants and units from the statements of the file."""
        of_kind: dict[str, list[Any]] = {}
        for each in statements:
            of_kind.setdefault(type(each).__name__, []).append(each)
        named = (*of_kind.get("Input", ()), *of_kind.get("Constant", ()))
        self._declared = frozenset(str(each.name) for each in named)
        self._definitions = tuple(of_kind.get("UnitDefinition", ()))

    @cached_property
    def _units(self) -> UnitRegistry:
        known = len(self.diagnostics)
        numbers = [(str(each.name), self._number(each.factor)) for each in self._definitions]
        del self.diagnostics[known:]  # they are reported where the unit is defined
        return UnitRegistry({name: (number.value, number.unit or "1") for name, number in numbers})

    def _is_unit(self, text: str) -> bool:
        return self._units.parse(text) is not None

    def _terms(self, found: Any) -> tuple[Term, ...]:
        return tuple(map(self._term, found))

    def _term(self, found: Any) -> Term:
        """Return a term that is not part of another."""
        self._operations = 0
        return self._nested(found)

    def _nested(self, found: Any) -> Term:
        """Return a term: products and quotients come before sums, all from left to right."""
        self._operations += len(found.rest)
        if self._operations > MAX_DEPTH:
            if self._operations - len(found.rest) <= MAX_DEPTH:
                self.diagnostics.append(too_deep(self.span(found)))
            return self._factor(found.first)
        operands = [_Operand(None, self._factor(found.first), self.span(found.first))]
        self._split_unit(operands)
        for each in found.rest:
            operands.append(
                _Operand(each.operator, self._factor(each.operand), self.span(each.operand))
            )
            self._split_unit(operands)
        for operators in (("*", "/"), ("+", "-")):
            applied = operands[:1]
            for each in operands[1:]:
                if each.operator in operators:
                    applied[-1] = self._applied(applied[-1], each)
                else:
                    applied.append(each)
            operands = applied
        return operands[0].term

    def _applied(self, left: _Operand, right: _Operand) -> _Operand:
        assert right.operator is not None
        operator = cast(ArithmeticOperator, str(right.operator))
        span = Span(self.source, left.span.start, right.span.end)
        place = self.token_span(right.operator)
        return _Operand(
            left.operator, Arithmetic(operator, left.term, right.term, span, place), span
        )

    def _split_unit(self, operands: list[_Operand]) -> None:
        """Separate what multiplies a number from its unit: in ``0.5 s * v`` the input ``v``.

        A text that is a unit as a whole stays one.
        """
        number = operands[-1].term
        if not isinstance(number, Number) or number.unit_span is None:
            return
        text = number.unit_span.text
        places = [each for each in _UNIT_OPERATOR.finditer(text) if each["name"] in self._declared]
        if not places or self._is_unit(text):
            return
        units = [each for each in places if self._is_unit(text[: each.start()])]
        first = units[-1] if units else places[0]
        start, length = number.unit_span.start, first.start()
        span = Span(self.source, number.span.start, start + length)
        unit_span = Span(self.source, start, start + length)
        shorter = Number(number.value, span, text[:length], unit_span)
        operands[-1] = _Operand(operands[-1].operator, shorter, span)
        for each in _UNIT_OPERATOR.finditer(text, length):
            operator, name = (
                _token(each[group], start + each.start(group)) for group in ("operator", "name")
            )
            path = NamePath(self.name(name), (), self.token_span(name))
            operands.append(_Operand(operator, path, path.span))

    def _factor(self, found: Any) -> Term:
        kind = type(found).__name__
        if kind == "Group":
            return self._nested(found.term)
        if kind in ("Quantity", "UnsignedQuantity"):
            return self._number(found)
        if kind == "Literal":
            text: Token = found.text
            if text[0] == '"':
                return String(self.text(text), self.token_span(text))
            return Boolean(text == "true", self.token_span(text))
        if kind == "Negative":
            return Negative(self._factor(found.operand), self.span(found))
        if kind == "TopicTerm":
            return self._calls(self._topic_path(found), found)
        if kind == "EntriesTerm":
            return self._calls(self._entries(found.entries), found)
        return self._calls(self._named(found), found)

    def _number(self, found: Any) -> Number:
        return Number(
            self.decimal(found.value),
            self.span(found),
            self.unit(found.unit),
            None if found.unit is None else self.token_span(found.unit),
        )

    def _named(self, found: Any) -> Term:
        name = self.name(found.name)
        if found.arguments is not None:
            arguments = tuple(map(self._nested, found.arguments.arguments))
            end: int = found.arguments._tx_position_end
            return Call(name, None, arguments, Span(self.source, name.span.start, end))
        return NamePath(name, *self._path(name, found))

    def _entries(self, found: Any) -> Entries:
        word = cast(EntriesWord, str(found.word))
        operations = self._operations  # the terms inside count for themselves
        condition = self._disjunction(found.condition)
        self._operations = operations
        return Entries(word, condition, self.span(found))

    @abstractmethod
    def _disjunction(self, found: Any) -> Condition:
        """Return a condition inside a term."""

    def _topic_path(self, found: Any) -> TopicPath:
        name = self.name(found.topic)
        path, span = self._path(name, found)
        return TopicPath(name, path, Span(self.source, found._tx_position, span.end))

    def _path(self, name: Name, found: Any) -> tuple[FieldPath, Span]:
        """Return the steps after a name, and the span of the whole path."""
        if found.path is None:
            return (), name.span
        span = Span(self.source, name.span.start, found.path.end)
        return tuple(self._steps(found.path)), span

    def _steps(self, path: Token) -> Iterator[PathStep]:
        for found in STEP.finditer(path):
            yield step_of(found, partial(self._text_at, path.start + found.start("value")))

    def _text_at(self, start: int, text: str) -> str:
        return self.text(_token(text, start))

    def _calls(self, term: Term, found: Any) -> Term:
        if len(found.calls) > MAX_DEPTH:
            self.diagnostics.append(too_deep(self.span(found)))
            return term
        for call in found.calls:
            span = Span(self.source, term.span.start, call._tx_position_end)
            arguments = tuple(map(self._nested, call.arguments.arguments))
            term = Call(self.name(call.function), term, arguments, span)
        return term


def _token(text: str, start: int) -> Token:
    token = Token(text)
    token.start = start
    return token
