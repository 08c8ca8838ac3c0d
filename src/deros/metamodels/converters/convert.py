"""The base class of the converters from textX objects to typed models."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from decimal import Decimal
from typing import TYPE_CHECKING, Any

from deros import codes
from deros.diagnostics import Code, Diagnostic, Related, SourceFile, Span, report
from deros.interfaces.durations import NS_PER_S, with_unit_of_time
from deros.interfaces.types import MOST_DIGITS, InterfaceKind, InterfaceType
from deros.interfaces.units import UnitRegistry
from deros.metamodels.imported_part import imported_from
from deros.metamodels.reading import forbidden_character
from deros.models.common import Interval, Name, QosProfile, Scalar, Value
from deros.models.node import FieldUnit
from deros.names.names import did_you_mean, near, not_text

if TYPE_CHECKING:
    from collections.abc import Iterable

    from deros.metamodels.matching import Token

_ESCAPE = re.compile(r"\\(u[0-9a-fA-F]{4}|.)", re.DOTALL)
_PAIR = re.compile("[\ud800-\udbff][\udc00-\udfff]")
_ESCAPES = {'"': '"', "\\": "\\", "/": "/", "n": "\n", "t": "\t", "r": "\r"}
_INTEGER = re.compile(r"[+-]?\d+\Z")
_EXPONENT = re.compile(r"[eE]([+-]?\d+)\Z")
_GREATEST_COUNT = 2**31 - 1
_LONGEST_S = 2**31 - 1  # the limit of DDS; rmw would shorten longer times
_UNITS = UnitRegistry()
_WRAPPING = "wrapping"
"""The word after the unit of an angle that wraps around after a full turn."""

_KINDS: dict[str, InterfaceKind] = {"msg": "msg", "srv": "srv", "action": "action"}


class Converter:
    """Turns the textX objects of one file into frozen models and collects the diagnostics."""

    def __init__(self, source: SourceFile) -> None:
        self.source = source
        self.imported_from = imported_from(source.text)
        self.diagnostics: list[Diagnostic] = []

    def report(
        self, code: Code, message: str, span: Span, hint: str = "", *related: Related
    ) -> None:
        """Collect a diagnostic."""
        self.diagnostics.append(report(code, message, span, hint, related))

    def lose(self, span: Span) -> None:
        """Discard a meaningless statement; names that it mentions are not reported missing."""
        self.source.lost |= frozenset(re.findall(r"\w+", span.text))

    def span(self, found: Any) -> Span:
        """Return the span of a textX object."""
        return Span(self.source, found._tx_position, found._tx_position_end)

    def token_span(self, token: Token) -> Span:
        """Return the span of a token."""
        return Span(self.source, token.start, token.start + len(token))

    def name(self, token: Token) -> Name:
        """Return a token as a name with its span."""
        return Name(str(token), self.token_span(token))

    def written(self, token: Token) -> str:
        """Return a name that may be quoted."""
        return self.text(token) if token[0] == '"' else str(token)

    # Texts, numbers, values ------------------------------------------------------------------

    def text(self, token: Token | None) -> str:
        """Return the content of a quoted string, or an empty one when there is none."""
        if token is None:
            return ""
        inner = token[1:-1]
        if "\\" not in inner:
            return inner
        said = _ESCAPE.sub(lambda found: self._escape(found, token), inner)
        said = _PAIR.sub(_character, said)
        if wrong := not_text(said):
            self.diagnostics.append(forbidden_character(wrong[0], self.token_span(token)))
            return ""
        return said

    def _escape(self, found: re.Match[str], token: Token) -> str:
        what = found.group(1)
        if len(what) == 5:
            return chr(int(what[1:], 16))
        if what not in _ESCAPES:
            start = token.start + 1 + found.start()
            span = Span(self.source, start, start + len(found.group()))
            hint = r"a backslash itself is written '\\'"
            self.report(codes.SYNTAX_ERROR, f"unknown escape '{found.group()}'", span, hint)
        return _ESCAPES.get(what, what)

    def decimal(self, token: Token) -> Decimal:
        """Return a number exactly; one beyond any physical quantity is reported and reads as 0."""
        exponent = _EXPONENT.search(token)
        if len(token) > MOST_DIGITS or (exponent and len(exponent[1].lstrip("+-0")) > 3):
            return self._out_of_range(token)
        value = Decimal(token)
        return value if math.isfinite(float(value)) else self._out_of_range(token)

    def _out_of_range(self, token: Token) -> Decimal:
        self.report(codes.SYNTAX_ERROR, "number out of range", self.token_span(token))
        return Decimal(0)

    def integer(self, token: Token) -> int:
        """Return a count; one that is too large for a machine is reported and reads as 0."""
        value = int(self.decimal(token))
        return value if value <= _GREATEST_COUNT else int(self._out_of_range(token))

    def scalar(self, token: Token) -> Scalar:
        """Return a value by the form of its text: bool, int, float or str."""
        if token[0] == '"':
            return self.text(token)
        if token == "true" or token == "false":
            return token == "true"
        if token[-1].isalpha():
            return float(token)  # nan, inf, -inf
        value = self.decimal(token)
        return int(value) if _INTEGER.match(token) else float(value)

    def value(self, found: Any) -> Value:
        """Return a scalar, or a tuple of them for an array."""
        if isinstance(found, str):
            return self.scalar(found)  # type: ignore[arg-type]
        return tuple(self.scalar(item) for item in found.items)

    def value_span(self, found: Any) -> Span:
        """Return the span of a scalar or an array."""
        return self.token_span(found) if isinstance(found, str) else self.span(found)  # type: ignore[arg-type]

    def interval(self, found: Any) -> Interval:
        """Return a range of numbers."""
        return Interval(
            float(self.decimal(found.lower)),
            float(self.decimal(found.upper)),
            found.opening == "[",
            found.closing == "]",
        )

    # Types, units, durations, QoS -------------------------------------------------------------

    def interface(self, token: Token, kind: InterfaceKind) -> InterfaceType:
        """Return the type that a text such as ``std_msgs.Bool`` names."""
        package, *middle, name = token.replace("/", ".").split(".")
        return InterfaceType(package, _KINDS[middle[0]] if middle else kind, name)

    def unit(self, token: Token | None) -> str | None:
        """Return a unit as written, without spaces."""
        return "".join(token.split()) if token is not None else None

    def field_unit(self, found: Any) -> FieldUnit:
        """Return the unit of a field of a topic, and whether the field wraps around."""
        *unit, last = str(found.unit).split()
        wrapping = last == _WRAPPING and bool(unit)
        return FieldUnit(
            "".join(found.path.split()),
            "".join(unit if wrapping else [*unit, last]),
            self.token_span(found.path),
            self.token_span(found.unit),
            wrapping,
        )

    def duration_ns(self, found: Any) -> int:
        """Return a duration in nanoseconds, or 0 after reporting why it is invalid."""
        if found.unit is None:
            hint = with_unit_of_time(str(found.value))
            self.report(codes.UNKNOWN_UNIT, "a duration needs a unit", self.span(found), hint)
            return 0
        text = self.unit(found.unit) or ""
        unit = _UNITS.parse(text)
        second = _UNITS.parse("sec")
        if unit is None or second is None or not _UNITS.compatible(unit, second):
            message = f"'{text}' is not a unit of time"
            hint = "units of time are ns, us, ms, sec, min and h"
            if text == "Hz" and (rate := self.decimal(found.value)) > 0:
                hint = f"write the period: '{1000 / rate:g} ms'"
            self.report(codes.UNKNOWN_UNIT, message, self.token_span(found.unit), hint)
            return 0
        duration = _UNITS.duration_ns(self.decimal(found.value), unit)
        if duration is None:
            message = "a duration is a whole number of nanoseconds, and not negative"
            self.report(codes.BAD_DURATION, message, self.span(found))
            return 0
        return duration

    def positive_ns(self, found: Any, what: str) -> int:
        """Return a duration in nanoseconds, and report one that is not positive."""
        before = len(self.diagnostics)
        duration = self.duration_ns(found)
        if duration == 0 and len(self.diagnostics) == before:
            self.report(codes.BAD_DURATION, f"{what} must be positive", self.span(found))
        return duration

    def rate_hz(self, found: Any) -> float | None:
        """Return a rate in Hz, or ``None`` after reporting why it is none."""
        text = self.unit(found.unit) or ""
        unit, hertz = _UNITS.parse(text), _UNITS.parse("Hz")
        if unit is None or hertz is None or not _UNITS.compatible(unit, hertz):
            message = f"'{text}' is not a unit of rates" if text else "a rate needs a unit"
            hint = f"write how many messages come in a second, as in '{found.value} Hz'"
            self.report(codes.UNKNOWN_UNIT, message, self.span(found), hint)
            return None
        rate = _UNITS.convert(self.decimal(found.value), unit, hertz)
        if rate > 0:
            return rate
        message = "a rate must be positive"
        self.report(codes.IMPOSSIBLE_NUMBER, message, self.span(found), "leave it out for none")
        return None

    def effective_ns(self, found: Any, what: str, zero: str) -> int | None:
        """Return a duration for ROS 2, or ``None`` after reporting why ROS 2 cannot apply it.

        Args:
            found: the duration.
            what: the name of the duration, for the message.
            zero: how ROS 2 treats a duration of 0, for the message.
        """
        before = len(self.diagnostics)
        duration = self.duration_ns(found)
        if len(self.diagnostics) > before:
            return None
        if duration == 0:
            message = f"{what} of 0 has no effect: {zero}"
            hint = "give a longer time, or leave it out"
            self.report(codes.IMPOSSIBLE_NUMBER, message, self.span(found), hint)
        self.check_longest(duration, what, found)
        return duration if len(self.diagnostics) == before else None

    def check_longest(self, duration_ns: int, what: str, found: Any) -> None:
        """Report a duration that is longer than ROS 2 supports."""
        if duration_ns > _LONGEST_S * NS_PER_S:
            message = f"{what} is longer than the {_LONGEST_S} seconds that the middleware supports"
            self.report(codes.IMPOSSIBLE_NUMBER, message, self.span(found))

    def qos(self, found: Any) -> QosProfile:
        """Return a QoS profile; a policy given twice is reported, the first one counts."""
        before = len(self.diagnostics)
        settings: dict[str, Any] = {}
        for policy in found.policies:
            for field, value in self._policy(policy):
                if field in settings:
                    message = f"the QoS policy '{field.removesuffix('_ns')}' is given twice"
                    self.report(codes.DUPLICATE_SECTION, message, self.span(policy))
                settings.setdefault(field, value)
        empty = settings.get("depth") == 0 and "keep_all" not in settings
        if empty and len(self.diagnostics) == before:
            message = "a depth of 0 keeps no message: ROS 2 treats it as the middleware's default"
            hint = "the minimum is 'depth 1'; 'keep_all' keeps as many as memory allows"
            self.report(codes.IMPOSSIBLE_NUMBER, message, self.span(found), hint)
            settings["depth"] = None
        return QosProfile(**settings, span=self.span(found))

    def _policy(self, policy: Any) -> list[tuple[str, Any]]:
        kind = type(policy).__name__
        if kind == "QosDepth":
            return [("depth", self.integer(policy.depth))]
        if kind == "QosTime":
            what, zero = f"a {policy.policy}", f"ROS 2 treats it as no {policy.policy}"
            return [(f"{policy.policy}_ns", self.effective_ns(policy.time, what, zero))]
        if kind == "QosLiveliness":
            settings: list[tuple[str, Any]] = [("liveliness", str(policy.kind))]
            if policy.lease is not None:
                what, zero = "a lease", "ROS 2 treats it as an infinite lease"
                settings.append(("lease_ns", self.effective_ns(policy.lease, what, zero)))
            return settings
        word = str(policy.word)
        if word == "keep_all":
            return [("keep_all", True)]
        return [(_QOS_FIELDS.get(word, "preset"), word)]


def _character(pair: re.Match[str]) -> str:
    """Return the character of two surrogate escapes, as in JSON."""
    return pair[0].encode("utf-16", "surrogatepass").decode("utf-16")


_QOS_FIELDS = {
    "reliable": "reliability",
    "best_effort": "reliability",
    "volatile": "durability",
    "transient_local": "durability",
}


class Sections:
    """Reports sections and attributes that are given twice.

    The part of a file that people write and the imported one may have a section each: the line
    between them shows that there are two.
    """

    def __init__(self, converter: Converter) -> None:
        self._converter = converter
        self._first: dict[tuple[str, bool], Span] = {}

    def once(self, what: str, span: Span) -> bool:
        """Return whether ``what`` is given for the first time; report it otherwise."""
        is_imported = span.start >= self._converter.imported_from
        first = self._first.setdefault((what, is_imported), span)
        if first is span:
            return True
        self._converter.report(
            codes.DUPLICATE_SECTION,
            f"'{what}' is given twice",
            span,
            "put both into one",
            Related(first, "first given here"),
        )
        return False


def unknown(name: str, what: str, known: Iterable[str], span: Span) -> tuple[str, Span, str]:
    """Return message, span and hint of the finding that no import defines ``name``."""
    names = list(known)
    hint = did_you_mean(near(name, names), name)
    if not hint:
        hint = (
            f"the imports define {', '.join(names)}" if names else "import the file that defines it"
        )
    return f"no import defines the {what} '{name}'", span, hint
