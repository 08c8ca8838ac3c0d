"""Resolves the functions of the table, where the rules apply them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from fractions import Fraction

from deros import codes
from deros.diagnostics import Span
from deros.interfaces.durations import with_unit_of_time
from deros.interfaces.fields import format_path, leaves
from deros.interfaces.types import FieldType, InterfaceType
from deros.interfaces.units import Unit
from deros.models import rules
from deros.names.names import did_you_mean, near
from deros.rules.compiler.scope import shapes
from deros.rules.compiler.scope.resolved import (
    AgeOf,
    AppliedFunction,
    DeclaredInput,
    EntriesHold,
    FrequencyOf,
    InsideOf,
    MissingOf,
    Part,
    Quantity,
    Resolved,
    UnknownOf,
    Value,
    family,
)
from deros.rules.compiler.scope.scope import Scope
from deros.rules.compiler.scope.tuned import refuse_tuned
from deros.rules.compiler.terms.bearings import check_sector
from deros.rules.compiler.terms.conversions import compatible
from deros.rules.compiler.terms.operations import CALLS
from deros.rules.compiler.terms.term_names import counted, describe
from deros.rules.compiler.terms.zone_terms import ZoneTerms
from deros.rules.functions.functions import (
    FUNCTIONS,
    WRITTEN,
    Argument,
    Function,
    Result,
    UnitRule,
    result_bounds,
)
from deros.rules.program import ir
from deros.rules.program.beams import sector
from deros.rules.program.bounds import Ends, bounds_of_change, type_bounds

_POINT_CLOUD = InterfaceType("sensor_msgs", "msg", "PointCloud2")

MOST_MESSAGES = 100
"""The most messages that a frequency looks at; a monitor of fixed size keeps a time for each."""

_RESULT_TYPES = {Result.FLOAT: FieldType("float64"), Result.INTEGER: FieldType("uint64")}


class FunctionTerms:
    """Resolves functions within a scope. ``None`` means that a fault has been reported."""

    def __init__(
        self, scope: Scope, resolve: Callable[[rules.Term], Resolved | None], zones: ZoneTerms
    ) -> None:
        """Resolve what functions are applied to with ``resolve``, and zones with ``zones``."""
        self._zones = zones
        self._scope = scope
        self._resolve = resolve
        self._states = 0
        self.found: list[AppliedFunction] = []
        """The functions of messages and arrays, as they were met."""

    def call(self, call: rules.Call) -> Resolved | None:
        """Return what a function of the table gives, applied to what stands before it."""
        name = call.function.text
        row = WRITTEN.get(name)
        if row is not None and row.over and call.arguments:
            row = FUNCTIONS[row.over]
        if row is None:
            hint = did_you_mean(near(name, WRITTEN)) or f"there are {', '.join(WRITTEN)}"
            if name in (*CALLS, "any", "all") and call.receiver is not None:
                hint = f"write '{name}({call.receiver.span.text})'"
            message = f"there is no function '{name}()'"
            self._scope.fault(codes.UNKNOWN_FUNCTION, message, call.function.span, hint)
            return None
        if row.argument is Argument.CONSTANT:
            return self._conversion(call, row)
        if call.receiver is None:
            wanted = call.arguments[0].span.text if call.arguments else "INPUT"
            message = f"'{name}()' is written behind what it is applied to"
            hint = f"write '{wanted}.{name}()'"
            self._scope.fault(codes.WRONG_FUNCTION_ARGUMENT, message, call.span, hint)
            return None
        operand = self._resolve(call.receiver)
        if row.of_zone:
            return self._of_zone(call, row, operand)
        parameters = self._parameters(call, row)
        if operand is None or parameters is None:
            return None
        if isinstance(operand, Value) and operand.is_tuned:
            message = f"'{name}()' is applied to what a message says, not to a tunable constant"
            self._scope.fault(codes.BAD_TUNABLE, message, call.receiver.span)
            return None
        if isinstance(operand, Value) and isinstance(operand.expression, ir.Compute):
            message = (
                f"'{name}()' is applied to what a message says; '{call.receiver.span.text}' is"
                " arithmetic"
            )
            hint = f"apply '{name}()' to its operands"
            self._scope.fault(codes.WRONG_FUNCTION_ARGUMENT, message, call.span, hint)
            return None
        if row.argument is Argument.INPUT:
            return self._of_input(call, row, operand, parameters)
        if row.argument is Argument.ANY:
            return self._of_any(call, row, operand)
        if row.argument is Argument.STAMPED:
            return self._of_stamped(call, row, operand)
        if row.argument is Argument.NUMBER:
            if isinstance(operand, Value) and family(operand.type) == "number":
                return self._of_number(call, row, operand, parameters)
        elif isinstance(operand, Part) and shapes.fits(self._scope.store, row, operand.type):
            if row.bearings:
                check_sector(self._scope, call.arguments, parameters)
            constants = self._scope.constants_of(row.parameters, parameters)
            return self._applied_to_part(call, row, operand, constants)
        self._misapplied(call, row, operand)
        return None

    def _misapplied(self, call: rules.Call, row: Function, operand: Resolved) -> None:
        receiver = call.receiver.span.text if call.receiver else ""
        name = call.function.text
        message = f"'{name}()' needs {row.argument.value}, '{receiver}' is {describe(operand)}"
        hint = ""
        if row.of_zone and isinstance(operand, Part) and operand.type.base == _POINT_CLOUD:
            hint = "point clouds are not supported yet, laser scans are"
        elif isinstance(operand, Part) and not operand.type.is_array:
            inner = shapes.fitting_fields(self._scope.store, row, operand.type)
            hint = did_you_mean((f"{receiver}.{format_path(path)}" for path in inner[:3]), receiver)
        elif isinstance(operand, Part) and operand.type.base == "bool":
            hint = f"of flags there are 'any({receiver})', 'all({receiver})', 'count({receiver})'"
        self._scope.fault(codes.WRONG_FUNCTION_ARGUMENT, message, call.span, hint)

    def _conversion(self, call: rules.Call, row: Function) -> Quantity | None:
        if call.receiver is not None or len(call.arguments) != 1:
            message = f"'{row.name}' converts one constant"
            hint = f"write '{row.name}(10 deg)'" if row.unit == "rad" else "write 'toDeg(0.2 rad)'"
            self._scope.fault(codes.WRONG_FUNCTION_ARGUMENT, message, call.span, hint)
            return None
        argument = call.arguments[0]
        operand = self._resolve(argument)
        what = f"the argument of '{row.name}()'"
        if operand is None or refuse_tuned(self._scope, operand, argument.span, what):
            return None
        if not isinstance(operand, Quantity):
            message = (
                f"'{row.name}' converts constants, '{argument.span.text}' is {describe(operand)}"
            )
            hint = "the units of fields are converted where they are compared"
            self._scope.fault(
                codes.WRONG_FUNCTION_ARGUMENT,
                message,
                argument.span,
                hint if isinstance(operand, Value) else "",
            )
            return None
        target = self._scope.units.parse(row.unit)
        # A plain number is in the unit that the function converts from (paper, section 4.3).
        source = operand.unit or self._scope.units.parse("deg" if row.unit == "rad" else "rad")
        if (
            source is None
            or target is None
            or not compatible(self._scope, source, target, argument)
        ):
            return None
        return Quantity(operand.value, source, target, whole=False)

    def _parameters(self, call: rules.Call, row: Function) -> tuple[Quantity, ...] | None:
        if len(call.arguments) != len(row.parameters):
            names = ", ".join(name for name, _ in row.parameters)
            given = f"{len(call.arguments)} given"
            name = call.function.text
            message = f"'{name}({names})' takes {counted(len(row.parameters))}, {given}"
            self._scope.fault(codes.WRONG_FUNCTION_ARGUMENT, message, call.span)
            return None
        found: list[Quantity] = []
        for argument, (name, unit) in zip(call.arguments, row.parameters, strict=True):
            value = self._resolve(argument)
            wanted = self._scope.units.parse(unit)
            if isinstance(value, Quantity) and wanted is not None:
                if value.unit is None or compatible(self._scope, value.unit, wanted, argument):
                    found.append(value)
            elif value is not None and not refuse_tuned(
                self._scope, value, argument.span, f"'{name}' of '{call.function.text}()'"
            ):
                message = f"'{name}' of '{call.function.text}()' must be a constant number"
                self._scope.fault(codes.WRONG_FUNCTION_ARGUMENT, message, argument.span)
        return tuple(found) if len(found) == len(row.parameters) else None

    def _owner(self, call: rules.Call, row: Function, operand: Resolved) -> DeclaredInput | None:
        """Return the input that an operand is read from; report another operand."""
        is_read = isinstance(operand, Value) and isinstance(operand.expression, ir.Read)
        if is_read or isinstance(operand, Part):
            assert isinstance(operand, (Value, Part))
            return operand.input
        self._misapplied(call, row, operand)
        return None

    def _of_input(
        self, call: rules.Call, row: Function, operand: Resolved, parameters: tuple[Quantity, ...]
    ) -> AgeOf | FrequencyOf | MissingOf | None:
        owner = self._owner(call, row, operand)
        if owner is None:
            return None
        if isinstance(operand, Part):
            self._watch(operand)
        if row.result is Result.FREQUENCY:  # it is known from the start on, without a timeout
            messages = self._messages(call.arguments[0].span, parameters[0])
            return None if messages is None else FrequencyOf(owner, messages)
        is_age = row.result is Result.DURATION
        without = (
            "so nothing notices a sensor that never sends: it has no age"
            if is_age
            else "so it is never missing"
        )
        if not self.has_timeout(owner, f"'{owner.name}' has no timeout, {without}", call.span):
            return None
        return AgeOf(owner) if is_age else MissingOf(owner)

    def _messages(self, span: Span, number: Quantity) -> int | None:
        """Return of how many messages a frequency is; report a number that is not in range."""
        if 1 <= number.value <= MOST_MESSAGES and number.value.denominator == 1:
            return int(number.value)
        message = f"'{span.text}' is not a whole number of messages, from 1 to {MOST_MESSAGES}"
        hint = "'frequency(10)' is that of the last ten messages"
        self._scope.fault(codes.BAD_FREQUENCY, message, span, hint)
        return None

    def _of_any(self, call: rules.Call, row: Function, operand: Resolved) -> UnknownOf | None:
        if not isinstance(operand, (Value, Part, EntriesHold, InsideOf)):
            self._misapplied(call, row, operand)
            return None
        function = None
        if isinstance(operand, Part):
            self._watch(operand)
        elif isinstance(operand, EntriesHold):
            function = operand.function
        elif isinstance(operand, Value) and isinstance(operand.expression, ir.Apply):
            function = operand.expression
        owner = operand.input
        assert owner is not None
        never = f"'{owner.name}' has no timeout, so its silence does not make it unknown"
        if not self.has_timeout(owner, never, call.span):
            return None
        return UnknownOf(owner, function)

    def _of_zone(
        self, call: rules.Call, row: Function, operand: Resolved | None
    ) -> InsideOf | Value | None:
        """Return whether a point is in a zone, or how many of a scan are.

        A point is unknown with a NaN in it, like any part.
        """
        if operand is None:
            return None
        if not (isinstance(operand, Part) and shapes.fits(self._scope.store, row, operand.type)):
            self._misapplied(call, row, operand)
            return None
        if row.argument is Argument.POINT:
            return self._zones.inside(call, operand, row.leaves)
        zone = self._zones.seen(call, operand.input)
        if zone is None:
            return None
        bearings = map(ir.Const, sector(zone.shape))
        return self._applied_to_part(call, row, operand, bearings, zone)

    def _of_stamped(self, call: rules.Call, row: Function, operand: Resolved) -> Value | None:
        """Return a function of the receipt and the header's stamp of an input's messages."""
        owner = self._owner(call, row, operand)
        if owner is None:
            return None
        stamp = self._scope.stamp(owner)
        if not stamp:
            message = (
                f"'{call.function.text}()' needs an input whose messages have a header,"
                f" {owner.type.short} has none"
            )
            hint = f"'{owner.name}.age()' is the time since the last message"
            self._scope.fault(codes.WRONG_FUNCTION_ARGUMENT, message, call.span, hint)
            return None
        if isinstance(operand, Part):
            self._watch(operand)
        receipt = self._scope.read(owner, ir.RECEIPT, FieldType("int64"))
        applied = ir.Apply(row.name, (receipt, *stamp), self._scope.use(owner))
        kind = _RESULT_TYPES[row.result]
        self.found.append(AppliedFunction(applied, kind, call.span))
        return Value(applied, kind, self._unit(row, None), owner, result_bounds(row, kind))

    def has_timeout(self, owner: DeclaredInput, without: str, span: Span) -> bool:
        """Return whether an input has a timeout; report ``without`` if it has none."""
        if owner.timeout_ns is not None:
            return True
        hint = "declare it with one: 'input NAME = topic ... timeout 0.5 sec'"
        self._scope.fault(codes.MISSING_NEEDS_TIMEOUT, without, span, hint)
        return False

    def _watch(self, part: Part) -> None:
        """Read every floating-point number of a part: a NaN means that the sensor has no value.

        A whole message is left alone, because in many a one NaN means that a field is not in use.
        """
        if not part.path:
            return
        kind = part.type
        read: Iterable[tuple[tuple[str, ...], FieldType]]
        if kind.is_array or isinstance(kind.base, str):
            read = [((), kind)] if kind.element.is_float else []
        else:
            every = leaves(self._scope.store, kind.base)
            read = [(path, leaf) for path, leaf in every if leaf.is_float]
        for path, leaf in read:
            self._scope.read(part.input, (*part.path, *path), leaf)

    def _of_number(
        self, call: rules.Call, row: Function, operand: Value, parameters: tuple[Quantity, ...]
    ) -> Value | None:
        assert operand.input is not None
        kind = _RESULT_TYPES.get(row.result, operand.type)
        unit = self._unit(row, operand.unit)
        arguments: list[ir.ValueExpression] = [operand.expression]
        bounds = result_bounds(row, kind, operand.bounds)
        if row.is_stateful and operand.turn is not None:
            turn = (operand.expression, ir.Const(operand.turn))
            arguments = [self._applied("unwrapped", turn, operand)]
        if row.over_span:
            span_ns = self._span_ns(call.arguments[0], parameters[0])
            if span_ns is None:
                return None
            arguments += [ir.Const(span_ns), *self._scope.stamp(operand.input)]
            if operand.turn is None:
                bounds = bounds_of_change(operand.bounds, Fraction(span_ns, 10**9))
        else:
            arguments += self._scope.constants_of(row.parameters, parameters)
        if row.over:
            self._scope.fault(
                codes.RATE_OF_ARRIVALS,
                f"'{call.span.text}' divides by the time between two arrivals, which may be next to"
                " nothing: messages often come in bursts",
                call.span,
                f"write '{call.function.text}(0.1 sec)', the change over that span",
            )
        applied = self._applied(row.name, arguments, operand)
        self.found.append(AppliedFunction(applied, operand.type, call.span))
        fields = operand.undeclared if unit is None else ()
        return Value(applied, kind, unit, operand.input, bounds, undeclared=fields)

    def _applied(
        self, function: str, arguments: Iterable[ir.ValueExpression], operand: Value
    ) -> ir.Apply:
        assert operand.input is not None
        state = None
        if FUNCTIONS[function].is_stateful:
            state = self._states
            self._states += 1
        return ir.Apply(function, tuple(arguments), self._scope.use(operand.input), state)

    def _span_ns(self, term: rules.Term, span: Quantity) -> int | None:
        """Return the span of time of a rate; report a term that is not a duration."""
        if span.unit is None:
            message = f"the duration '{term.span.text}' has no unit"
            hint = with_unit_of_time(term.span.text)
            self._scope.fault(codes.BAD_DURATION, message, term.span, hint)
            return None
        span_ns = self._scope.nanoseconds(span.in_unit(self._scope.units.parse("s")), term.span)
        if span_ns == 0:
            message = "a rate over no time has no value"
            self._scope.fault(codes.BAD_DURATION, message, term.span, "write 'rate(0.1 sec)'")
            return None
        return span_ns

    def _applied_to_part(
        self,
        call: rules.Call,
        row: Function,
        part: Part,
        constants: Iterable[ir.Const],
        zone: ir.Zone | None = None,
    ) -> Value:
        """Return a function of a part of a message, and of constants."""
        arguments: list[ir.ValueExpression] = []
        leaf_bounds: list[Ends] = []
        for name in row.leaves:
            path = (*part.path, name) if name else part.path
            kind = shapes.leaf_type(self._scope.store, part.type, name)
            if kind is None:  # a plane vector has no z
                arguments.append(ir.Const(0.0))
                continue
            leaf_bounds.append(type_bounds(kind))
            # Only the beams of a scan may be NaN; its angles and limits may not.
            nan_is_unknown = row.nan_is_unknown or not kind.is_array
            arguments.append(self._scope.read(part.input, path, kind, nan_is_unknown))
        owner = self._scope.use(part.input)
        arguments += constants
        if row.argument is Argument.SCAN:
            arguments.append(ir.Const(part.input.zero_is_free))
        applied = ir.Apply(row.name, tuple(arguments), owner, zone=zone)
        self.found.append(AppliedFunction(applied, part.type, call.span))
        first = (*part.path, row.leaves[0]) if row.leaves[0] else part.path
        unit = self._unit(
            row, self._scope.field_units.unit_of(part.input.topic, part.input.type, first)
        )
        kind = _RESULT_TYPES.get(row.result, part.type.element)
        if row.is_single:
            kind = FieldType("float32")
        bounds = result_bounds(row, kind, *leaf_bounds)
        if row.argument is Argument.ARRAY and part.type.size is not None:
            least = part.type.size if part.type.array == "fixed" else 0
            bounds = Fraction(least), Fraction(part.type.size)
        turn = self._scope.field_units.full_turn(unit) if row.turns else None
        fields = ((part.input.topic, first),) if unit is None else ()
        return Value(applied, kind, unit, part.input, bounds, turn=turn, undeclared=fields)

    def _unit(self, row: Function, operand: Unit | None) -> Unit | None:
        match row.unit_rule:
            case UnitRule.FIXED:
                return self._scope.units.parse(row.unit)
            case UnitRule.SAME:
                return operand
            case UnitRule.PER_SECOND:
                return operand and self._scope.units.parse(f"{operand.text}/s")
            case UnitRule.NONE:
                return self._scope.units.parse("1")
