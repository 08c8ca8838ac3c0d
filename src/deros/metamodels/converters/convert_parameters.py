"""Declarations of parameters, in node descriptions and as arguments of systems."""

from __future__ import annotations

import math
from typing import Any

from deros import codes
from deros.diagnostics import Fix, Span, report
from deros.metamodels.converters.convert import Converter, Sections
from deros.models.common import Interval, Name, Scalar
from deros.models.node import Parameter, ParameterType, as_double
from deros.names.names import did_you_mean, near

_PARAMETER_TYPES = {each.value: each for each in ParameterType} | {
    "int": ParameterType.INTEGER,
    "int[]": ParameterType.INTEGER_ARRAY,
    "float": ParameterType.DOUBLE,
    "float[]": ParameterType.DOUBLE_ARRAY,
}
_FOREIGN_TYPES = {
    **dict.fromkeys(("float32", "float64", "real", "number", "decimal"), "double"),
    **dict.fromkeys(("int8", "int16", "int32", "int64", "long", "uint", "unsigned"), "integer"),
    **dict.fromkeys(("uint8", "uint16", "uint32", "uint64", "int_", "integers"), "integer"),
    **dict.fromkeys(("str", "text", "char", "std::string"), "string"),
    **dict.fromkeys(("boolean", "flag"), "bool"),
}
"""The ROS 2 names of parameter types of other languages."""

_WORDS = {
    "ParameterUnit": "unit",
    "Within": "in",
    "OneOf": "one_of",
    "Size": "size",
    "MinSize": "min_size",
    "MaxSize": "max_size",
    "NotEmpty": "not_empty",
    "Unique": "unique",
    "ReadOnly": "read_only",
    "Description": "description",
}

_UNBOUNDED = Interval(-math.inf, math.inf)


class ParameterConverter(Converter):
    """Converts declarations of parameters."""

    def parameter(self, found: Any) -> Parameter | None:
        """Return a declared parameter; ``None`` where its type is unknown, which is reported."""
        kind = self._parameter_type(found)
        if kind is None:
            return None
        settings: dict[str, Any] = {}
        if found.default is not None:
            settings["default_span"] = self.value_span(found.default)
        attributes = Sections(self)
        for attribute in found.attributes:
            what = type(attribute).__name__
            if what in ("Within", "Bound"):
                self._bounds(attribute, attributes, settings)
            elif what == "Custom":
                function = Name(self.text(attribute.function), self.token_span(attribute.function))
                settings["custom"] = (*settings.get("custom", ()), function)
            elif attributes.once(_WORDS[what], self.span(attribute)):
                settings |= self._attribute(attribute, kind)
        default = None if found.default is None else as_double(self.value(found.default), kind)
        return Parameter(
            self.written(found.name),
            kind,
            default,
            self.span(found),
            self.token_span(found.name),
            **settings,
        )

    def _attribute(self, attribute: Any, kind: ParameterType) -> dict[str, Any]:
        what = type(attribute).__name__
        if what == "ParameterUnit":
            return {
                "unit": self.unit(attribute.unit),
                "unit_span": self.token_span(attribute.unit),
            }
        if what == "OneOf":
            return {"choices": self._choices(attribute.values, kind)}
        if what in ("Size", "MinSize", "MaxSize"):
            return {_WORDS[what]: self.integer(attribute.size)}
        if what in ("NotEmpty", "Unique", "ReadOnly"):
            return {_WORDS[what]: True}
        return {"description": self.text(attribute.text)}

    def _bounds(self, attribute: Any, given: Sections, settings: dict[str, Any]) -> None:
        """Combine a range or a one-sided bound with another bound."""
        known: Interval = settings.get("interval", _UNBOUNDED)
        span = self.span(attribute)
        if type(attribute).__name__ == "Within":
            span = self.span(attribute.interval)
            if not given.once("lower bound", span) or not given.once("upper bound", span):
                return
            bounds = self.interval(attribute.interval)
        else:
            operator, value = str(attribute.operator), float(self.decimal(attribute.value))
            closed = operator.endswith("=")
            if operator[0] == ">":
                if not given.once("lower bound", span):
                    return
                bounds = Interval(value, known.upper, closed, known.upper_closed)
            else:
                if not given.once("upper bound", span):
                    return
                bounds = Interval(known.lower, value, known.lower_closed, closed)
        first: Span = settings.get("interval_span", span)
        settings["interval"] = bounds
        settings["interval_span"] = Span(self.source, first.start, span.end)

    def _parameter_type(self, found: Any) -> ParameterType | None:
        text = "".join(found.type.split())
        kind = _PARAMETER_TYPES.get(text)
        if kind is None:
            self._unknown_parameter_type(text, self.token_span(found.type))
            self.lose(self.span(found))
        return kind

    def _unknown_parameter_type(self, text: str, span: Span) -> None:
        element, is_array = text.removesuffix("[]").lower(), text.endswith("[]")
        meant = _FOREIGN_TYPES.get(element)
        fix = None
        if meant is not None:
            hint = f"write '{meant}{'[]' * is_array}'"
            fix = Fix(span, f"{meant}{'[]' * is_array}")
        else:
            hint = did_you_mean(near(text, _PARAMETER_TYPES))
            hint = hint or f"the types are {', '.join(_PARAMETER_TYPES)}"
        message = f"unknown parameter type '{text}'"
        self.diagnostics.append(report(codes.SYNTAX_ERROR, message, span, hint, fix=fix))

    def _choices(self, array: Any, kind: ParameterType) -> tuple[Scalar, ...]:
        values = tuple(self.scalar(item) for item in array.items)
        if kind in (ParameterType.DOUBLE, ParameterType.DOUBLE_ARRAY):
            return tuple(float(value) if type(value) is int else value for value in values)
        return values
