"""Actions of the rules: declarations, the messages of bound actions, and calls."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction

from deros import codes
from deros.diagnostics import Related
from deros.interfaces.types import FieldType, MessageDefinition
from deros.models import rules
from deros.models.bindings import Binding
from deros.models.common import Name
from deros.names.keywords import CPP_20, PYTHON, C
from deros.names.names import did_you_mean, near
from deros.rules.compiler.held_values import held_value
from deros.rules.compiler.scope.resolved import (
    Fixed,
    MessageConstant,
    Plain,
    Quantity,
    family,
)
from deros.rules.compiler.scope.scope import Scope
from deros.rules.compiler.scope.tuned import refuse_tuned
from deros.rules.compiler.service_calls import ServiceCalls
from deros.rules.compiler.terms.term_names import counted
from deros.rules.compiler.terms.terms import Terms
from deros.rules.program import ir
from deros.rules.program.bounds import rounded

LOG_STATE = "log_state"
"""The action that is built in: it writes a text to the log."""


_WORDS = C | CPP_20 | PYTHON  # rules are to generate for every target


class Actions:
    """The declared actions of one program, by name; faults are reported to the scope."""

    def __init__(self, scope: Scope, terms: Terms, declared: tuple[rules.Action, ...]) -> None:
        """Check the declarations."""
        self._scope = scope
        self._terms = terms
        self._declared: dict[str, rules.Action] = {}
        self._bindings: dict[str, ir.Binding | None] = {}
        self._services: dict[str, ir.ServiceCall | None] = {}
        services = ServiceCalls(scope, terms)
        self._triggered_by: dict[str, list[int]] = {}
        scope.check_duplicates((each.name for each in declared), "action '{}'")
        for each in declared:
            self._check(each)
            if self._declared.setdefault(each.name.text, each) is not each:
                continue
            if each.binding:
                self._bindings[each.name.text] = self._bind(each.binding)
            if each.service:
                self._services[each.name.text] = services.resolve(each.service)
        for each in declared:
            self._check_reset(each)
        self.indices = {name: index for index, name in enumerate(self._declared)}
        """The place of each declared action, by name."""

    def _check(self, action: rules.Action) -> None:
        if action.name.text == LOG_STATE:
            message = f"'{LOG_STATE}' is built in and cannot be declared"
            self._scope.fault(codes.DUPLICATE_RULE_NAME, message, action.name.span)
        for name in (action.name, *action.parameters):
            if name.text in _WORDS:
                message = f"'{name}' is a word of the languages that code is generated in"
                hint = f"call it '{name}_' or the like"
                self._scope.fault(codes.INVALID_RULES_NAME, message, name.span, hint)
        self._scope.check_duplicates(action.parameters, f"parameter '{{}}' of '{action.name}'")

    def _check_reset(self, action: rules.Action) -> None:
        reset = action.reset_by
        if reset is None:
            return
        if action.latched:
            message = f"'{action.name}' is latched: nothing but '~/reset' resets it"
            hint = "keep either 'latched' or 'reset_by'"
            self._scope.fault(codes.LATCHED_AND_RESET_BY, message, reset.span, hint)
        if reset.text not in self._declared:
            hint = did_you_mean(near(reset.text, self._declared))
            message = f"no action '{reset}' is declared"
            self._scope.fault(codes.UNKNOWN_RESET, message, reset.span, hint)

    # Bindings -----------------------------------------------------------------------------------

    def _bind(self, binding: Binding) -> ir.Binding | None:
        topic = self._scope.topic_name(binding.topic)
        definition = self._scope.message_type(binding.type, binding.type_span)
        if definition is None or topic is None:
            return None
        known = self._scope.topics.get(topic)
        if known is not None and known.type is not None and known.type != binding.type:
            self._scope.fault(
                codes.ACTION_TYPE_MISMATCH,
                f"the action publishes {binding.type.short}, '{topic}' is of type"
                f" {known.type.short}",
                binding.type_span,
                related=(Related(known.place, "the topic"),),
            )
        value = self._terms.resolve(binding.value, definition)
        what = "what an action publishes"
        if value is None or refuse_tuned(self._scope, value, binding.value.span, what):
            return None
        if not isinstance(value, (Quantity, Plain, MessageConstant)):
            message = "an action publishes a constant"
            self._scope.fault(codes.ACTION_VALUE, message, binding.value.span)
            return None
        return self._carried(binding, topic, definition, value)

    def _carried(
        self,
        binding: Binding,
        topic: str,
        definition: MessageDefinition,
        value: Fixed,
    ) -> ir.Binding | None:
        """Assign the value to the first field of the message that can hold it."""
        candidates = [
            (name, kind, self._scope.field_units.unit_of(topic, binding.type, (name,)))
            for name, kind in definition.fields
            if isinstance(kind.base, str) and not kind.is_array
        ]
        if isinstance(value, Quantity) and value.unit is not None:
            # A field whose unit is known to fit goes before one that happens to have none.
            candidates.sort(key=lambda candidate: candidate[2] is None)
        for name, kind, unit in candidates:
            scalar = held_value(self._scope.units, kind, unit, value)
            if scalar is not None:
                carried = ir.Binding(topic, binding.type, (name,), scalar)
                self._check_distinct(binding, definition, kind, carried)
                return carried
        fields = ", ".join(f"{name} ({kind})" for name, kind in definition.fields)
        self._scope.fault(
            codes.ACTION_VALUE,
            f"no field of {binding.type.short} can hold '{binding.value.span.text}'",
            binding.value.span,
            f"its fields: {fields}" if fields else "it has no fields",
        )
        return None

    def _check_distinct(
        self,
        binding: Binding,
        definition: MessageDefinition,
        kind: FieldType,
        carried: ir.Binding,
    ) -> None:
        """Warn of an active message that equals the inactive one."""
        related: tuple[Related, ...] = ()
        if family(kind) == "boolean":
            first = self._first(carried)
            if first is None or self._bindings[first] == carried:
                return
            hint = f"'{first}' publishes the opposite: give this action a topic of its own"
            related = (Related(self._declared[first].span, "declared first"),)
        else:
            default = definition.defaults.get(carried.path[0], "" if family(kind) == "text" else 0)
            if carried.value != default:
                return
            hint = "publish a value other than the default of the field"
        message = (
            f"'{binding.value.span.text}' is also what the topic carries while the action is not"
            " active"
        )
        span = binding.value.span
        self._scope.fault(codes.ACTIVE_EQUALS_INACTIVE, message, span, hint, related)

    def _first(self, carried: ir.Binding) -> str | None:
        """Return the first action whose state is in the same field of the same topic."""
        field = (carried.topic, carried.type, carried.path)
        for name, binding in self._bindings.items():
            if binding and (binding.topic, binding.type, binding.path) == field:
                return name
        return None

    # Calls --------------------------------------------------------------------------------------

    def trigger(self, call: rules.ActionCall, behaviour: int) -> ir.Trigger | None:
        """Return the call of an action in the body of the behaviour with this index."""
        name = call.action.text
        arguments = tuple(self._argument(each) for each in call.arguments)
        self._triggered_by.setdefault(name, []).append(behaviour)
        if name == LOG_STATE:
            if len(arguments) != 1 or not isinstance(arguments[0], (str, type(None))):
                message = f"'{LOG_STATE}' takes one text"
                hint = f"write '{LOG_STATE}(\"what happened\");'"
                self._scope.fault(codes.WRONG_ACTION_ARGUMENTS, message, call.span, hint)
                return None
        elif name not in self._declared:
            self._unknown(call.action)
            return None
        else:
            wanted = self._declared[name].parameters
            if len(wanted) != len(arguments):
                shown = f"{name}({', '.join(map(str, wanted))})" if wanted else name
                message = f"'{shown}' takes {counted(len(wanted))}, {len(arguments)} given"
                place = (Related(self._declared[name].span, "declared here"),)
                self._scope.fault(codes.WRONG_ACTION_ARGUMENTS, message, call.span, related=place)
                return None
        known = tuple(each for each in arguments if each is not None)
        if len(known) < len(arguments):
            return None
        index = self.indices.get(name, len(self._declared))
        return ir.Trigger(index, known, call.span)

    def _unknown(self, name: Name) -> None:
        hint = did_you_mean(near(name.text, [*self._declared, LOG_STATE]))
        hint = hint or f"declare it: 'action {name};'"
        message = f"no action '{name}' is declared"
        self._scope.fault(codes.UNKNOWN_NAME, message, name.span, hint)

    def state_topics(self, names: Iterable[str]) -> frozenset[str]:
        """Return the topics of the states of those named actions that are bound."""
        bindings = (self._bindings.get(name) for name in names)
        return frozenset(each.topic for each in bindings if each is not None)

    def bound(self, name: Name) -> int | None:
        """Return the index of a bound action that a gate reacts to; report any other."""
        declared = self._declared.get(name.text)
        if declared is None:
            self._unknown(name)
            return None
        if declared.binding is None:
            message = f"'{name}' publishes no state, so no gate can know whether it is active"
            bind = f"publishes true on /{name} : std_msgs.Bool"
            hint = f"bind it: 'action {name} {bind} …'"
            if declared.service is not None:
                hint = f"let it publish its state too: write '{bind}' before 'calls …'"
            place = (Related(declared.span, "declared here"),)
            self._scope.fault(codes.GATE_ACTION, message, name.span, hint, place)
            return None
        return self.indices[name.text]

    def _argument(self, term: rules.Term) -> ir.Scalar | None:
        found = self._terms.resolve(term)
        match found:
            case None:
                return None
            case Plain(value=value):
                return value
            case Quantity():
                return _as_written(found)
        if refuse_tuned(self._scope, found, term.span, "an argument of an action"):
            return None
        message = f"an argument is a constant, '{term.span.text}' is read from a topic"
        self._scope.fault(codes.WRONG_ACTION_ARGUMENTS, message, term.span)
        return None

    def program_actions(self) -> tuple[ir.Action, ...]:
        """Return the actions of the program: those declared, and ``log_state`` if it is used."""
        actions = [
            ir.Action(
                index,
                name,
                tuple(each.text for each in declared.parameters),
                self._bindings.get(name),
                self.indices.get(declared.reset_by.text) if declared.reset_by else None,
                declared.latched,
                self._triggers(name),
                declared.span,
                self._services.get(name),
            )
            for index, (name, declared) in enumerate(self._declared.items())
        ]
        if LOG_STATE in self._triggered_by:
            index, by = len(actions), self._triggers(LOG_STATE)
            actions.append(ir.Action(index, LOG_STATE, ("text",), None, None, False, by))
        return tuple(actions)

    def _triggers(self, name: str) -> tuple[int, ...]:
        return tuple(dict.fromkeys(self._triggered_by.get(name, ())))


def _as_written(quantity: Quantity) -> int | float:
    number: Fraction = quantity.in_unit(None)
    if quantity.whole and number.denominator == 1:
        return int(number)
    return rounded(number)
