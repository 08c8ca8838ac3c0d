"""Services that bound actions call: their types, and the values of the requests."""

from __future__ import annotations

from deros import codes
from deros.diagnostics import Related
from deros.interfaces.types import FieldType, MessageDefinition
from deros.models.bindings import ServiceCall
from deros.models.node import PortKind
from deros.models.rules import Term
from deros.rules.compiler.held_values import held_value
from deros.rules.compiler.scope.resolved import MessageConstant, Plain, Quantity
from deros.rules.compiler.scope.scope import Scope
from deros.rules.compiler.terms.terms import Terms
from deros.rules.program import ir

SUCCESS = "success"
"""The boolean field of a response that says whether the service has done what it was called for."""


class ServiceCalls:
    """Resolves the services of actions; faults are reported to the scope."""

    def __init__(self, scope: Scope, terms: Terms) -> None:
        """Take over where names and terms are resolved."""
        self._scope = scope
        self._terms = terms
        self._calls: dict[str, ServiceCall] = {}

    def resolve(self, call: ServiceCall) -> ir.ServiceCall | None:
        """Return a call with its names resolved; report what cannot be called."""
        service = self._scope.topic_name(call.service, "service")
        definitions = self._scope.service_type(call.type, call.type_span)
        if service is None or definitions is None:
            return None
        request, response = definitions
        self._check_type(call, service)
        if response.field(SUCCESS) != FieldType("bool"):
            self._scope.fault(
                codes.NOT_CALLABLE,
                f"{call.type.short} does not answer whether it succeeded: its response has no"
                f" 'bool {SUCCESS}'",
                call.type_span,
                "call a service such as std_srvs.SetBool or std_srvs.Trigger",
            )
            return None
        if not request.fields:
            return self._empty(call, service)
        return self._filled(call, service, request)

    def _check_type(self, call: ServiceCall, service: str) -> None:
        """Report a service that has another type in the systems, or where it is called first."""
        first = self._calls.setdefault(service, call)
        known = [
            (port.port.type, port.port.type_span)
            for system in self._scope.topics.systems
            for node in system.nodes
            for port in node.ports
            if port.port.kind is PortKind.SERVICE and port.topic == service
        ]
        for kind, place in [*known, (first.type, first.span)]:
            if kind != call.type:
                self._scope.fault(
                    codes.ACTION_TYPE_MISMATCH,
                    f"the action calls {call.type.short}, '{service}' is of type {kind.short}",
                    call.type_span,
                    related=(Related(place, "the service"),),
                )
                return

    def _empty(self, call: ServiceCall, service: str) -> ir.ServiceCall | None:
        if call.value is None:
            return ir.ServiceCall(service, call.type)
        self._scope.fault(
            codes.NOT_CALLABLE,
            f"the request of {call.type.short} is empty: it takes no value",
            call.value.span,
            f"write 'calls {call.service} : {call.type.short}'",
        )
        return None

    def _filled(
        self, call: ServiceCall, service: str, request: MessageDefinition
    ) -> ir.ServiceCall | None:
        """Return the call of a service with a value in the one field of its request."""
        fields = ", ".join(f"{name} ({kind})" for name, kind in request.fields)
        (name, kind), *others = request.fields
        if others or not isinstance(kind.base, str) or kind.is_array:
            self._scope.fault(
                codes.NOT_CALLABLE,
                f"an action sets one number, text or boolean, the request of {call.type.short}"
                f" consists of {fields}",
                call.type_span,
                "offer a service with one such field in its request, or none, and call that",
            )
            return None
        if call.value is None:
            self._scope.fault(
                codes.NOT_CALLABLE,
                f"the request of {call.type.short} needs a value, of {fields}",
                call.service.span,
                f"write 'calls VALUE on {call.service} : {call.type.short}'",
            )
            return None
        value = self._value(call.value, request, kind)
        return None if value is None else ir.ServiceCall(service, call.type, name, value)

    def _value(self, term: Term, request: MessageDefinition, kind: FieldType) -> ir.Scalar | None:
        value = self._terms.resolve(term, request)
        if value is None:
            return None
        if not isinstance(value, (Quantity, Plain, MessageConstant)):
            message = "an action calls a service with a constant"
            self._scope.fault(codes.ACTION_VALUE, message, term.span)
            return None
        held = held_value(self._scope.units, kind, None, value)
        if held is None:
            ((name, _),) = request.fields
            message = f"the request cannot hold '{term.span.text}'"
            hint = f"its field: {name} ({kind})"
            self._scope.fault(codes.ACTION_VALUE, message, term.span, hint)
        return held
