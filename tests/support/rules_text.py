"""Programs written as DeRoS texts, to hold loading and building to what they mean."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from decimal import ROUND_CEILING, Context

from deros.interfaces.fields import FieldPath, format_steps
from deros.interfaces.rep103 import unit_of
from deros.rules.functions.functions import FUNCTIONS, Argument
from deros.rules.program import formulas, ir, walk
from tests.support.drawn_zones import zone_text
from tests.support.rules import embedded_store
from tests.support.strategies import KINDS

NODE_TEXT = "node robot : robot\npublishes\n" + "".join(
    f"  topic {topic} : {short}\n"
    for topic, short in {kind.topic: kind.type.short for kind in KINDS.values()}.items()
)
"""A node that publishes every topic of the random programs."""

_ROUND_UP = Context(prec=25, rounding=ROUND_CEILING)
"""Rounds a frequency so little upwards that it is reached at no earlier nanosecond."""

_TOPICS = list(dict.fromkeys(kind.topic for kind in KINDS.values()))
SYSTEM_TEXT = (
    'system Robot\nimports\n  import "robot.rnd"\ntopics\n'
    + "".join(f"  topic {topic}\n" for topic in _TOPICS)
    + "subsystem Base {\n  node robot : robot\n  wirings\n"
    + "".join(f"    connect {topic} to {topic}\n" for topic in _TOPICS)
    + "}\n"
)
"""The system of that node."""


def rules_text(program: ir.Program) -> str:
    """Return the text of a program that is ``writable``; every operand stands in parentheses."""
    writer = _Writer(program)
    lines = ['use "robot.system" import Robot']
    lines += [writer.action(each) for each in program.actions]
    lines += [writer.input(each) for each in program.inputs]
    held = (
        each.zone
        for each in walk.values(walk.conditions(program))
        if isinstance(each, ir.Apply | ir.Compute)
    )
    zones = dict.fromkeys(each for each in held if each is not None)
    lines += [zone_text(each) for each in zones]
    lines.append("entity entity {")
    lines += [f"  {writer.rule(each)};" for each in program.rules]
    lines.append("}")
    lines += [writer.behaviour(each) for each in program.behaviours]
    return "\n".join(lines) + "\n"


class _Writer:
    def __init__(self, program: ir.Program) -> None:
        self._program = program

    def action(self, action: ir.Action) -> str:
        binding = f"publishes true on /{action.name} : std_msgs.Bool"
        reset = " latched" if action.latched else ""
        if action.reset_by is not None:
            reset = f" reset_by {self._program.actions[action.reset_by].name}"
        return f"action {action.name} {binding}{reset};"

    def input(self, each: ir.Input) -> str:
        timeout = "" if each.timeout_ns is None else f" timeout {each.timeout_ns} ns"
        unit = " [dimensionless]" if self._lacks_unit(each) else ""
        free = " no_return 0" if self._has_free_zeros(each) else ""
        return f"input {each.name} = topic {each.topic}{_path(each.path)}{unit}{free}{timeout}"

    def _has_free_zeros(self, each: ir.Input) -> bool:
        """Return whether 0 means that nothing is there, as functions of a scan are told last."""
        return any(
            isinstance(value, ir.Apply)
            and value.input == each.index
            and FUNCTIONS[value.function].argument is Argument.SCAN
            and value.arguments[-1] == ir.Const(True)
            for value in walk.values(walk.conditions(self._program))
        )

    def _lacks_unit(self, each: ir.Input) -> bool:
        """Return whether an input is a field, or an array, of numbers whose unit nothing tells."""
        numbers = (
            leaf.path == each.path and leaf.type.element.is_number
            for leaf in self._program.leaves
            if leaf.input == each.index
        )
        return any(numbers) and unit_of(embedded_store(), each.type, each.path) is None

    def rule(self, rule: ir.Rule) -> str:
        failsafe = "failsafe " if isinstance(rule.condition, ir.Failsafe) else ""
        return f"{failsafe}{rule.name}: {self.condition(rule.condition)}"

    def behaviour(self, behaviour: ir.Behaviour) -> str:
        body = [
            self.behaviour(item)
            if isinstance(item, ir.Behaviour)
            else f"{self._program.actions[item.action].name};"
            for item in behaviour.body
        ]
        head = f"behaviour {behaviour.name}: if {self.condition(behaviour.condition)} then"
        return "\n".join([f"{head} {{", *body, "};"])

    def condition(self, condition: ir.Condition) -> str:
        match condition:
            case ir.Truth():
                return self.value(condition.operand)
            case ir.Compare(left=ir.Compute(zone=ir.Zone()) as inside):
                return inside.wording
            case ir.Compare():
                left, right = self.value(condition.left), self.value(condition.right)
                return f"{left} {condition.operator} {right}"
            case ir.Within():
                bounds = f"{self.value(condition.lower)}, {self.value(condition.upper)}"
                opening = "[" if condition.lower_closed else "("
                closing = "]" if condition.upper_closed else ")"
                return f"{self.value(condition.operand)} in {opening}{bounds}{closing}"
            case ir.Missing():
                return f"{self._program.inputs[condition.input].name}.missing()"
            case ir.Unknown():
                asked = self._program.inputs[condition.input].name
                if condition.operand is not None:
                    asked = self.value(condition.operand)
                return f"{asked}.unknown()"
            case ir.Failsafe():
                return self.condition(condition.operand)
            case ir.Age():
                name = self._program.inputs[condition.input].name
                return f"{name}.age() {condition.operator} {condition.bound_ns} ns"
            case ir.Frequency():
                name = self._program.inputs[condition.input].name
                hertz = _ROUND_UP.divide(condition.messages * 10**9, condition.elapsed_ns)
                return f"{name}.frequency({condition.messages}) <= {hertz:f} Hz"
            case ir.Not():
                return f"not ({self.condition(condition.operand)})"
            case ir.And():
                return " and ".join(f"({self.condition(each)})" for each in condition.operands)
            case ir.Or():
                return " or ".join(f"({self.condition(each)})" for each in condition.operands)
            case ir.For():
                return f"({self.condition(condition.operand)}) for {condition.duration_ns} ns"
            case ir.Once():
                return f"({self.condition(condition.operand)}) within {condition.duration_ns} ns"
            case ir.Times():
                counted = f"{condition.count} times within {condition.duration_ns} ns"
                return f"({self.condition(condition.operand)}) {counted}"
            case ir.Begins():
                return f"(({self.condition(condition.operand.operand)}) begins)"
            case ir.Since():
                operand, cause = self.condition(condition.operand), self.condition(condition.cause)
                return f"(({operand}) since ({cause}))"
            case ir.RuleRef():
                return self._program.rules[condition.rule].full_name
            case ir.Active():
                return f"{self._program.actions[condition.action].name}.active"

    def value(self, value: ir.ValueExpression) -> str:
        match value:
            case ir.Const():
                return json.dumps(value.value)
            case ir.Read():
                return self._program.inputs[self._program.leaves[value.leaf].input].name
            case ir.Apply(function="unwrapped"):  # what a rate of an angle is taken of
                return self.value(value.arguments[0])
            case ir.Apply(function="rate_over"):
                span = value.arguments[1]
                assert isinstance(span, ir.Const)
                return f"{self.value(value.arguments[0])}.rate({span.value} ns)"
            case ir.Apply(entry=entry) if entry is not None:
                names = dict(zip(value.names, map(self.value, value.arguments), strict=True))
                return f"count({_entry(entry, names)})"
            case ir.Apply():
                row = FUNCTIONS[value.function]
                subject = self._program.inputs[value.input].name
                if row.argument is Argument.NUMBER:
                    subject = self.value(value.arguments[0])
                if value.zone is not None:
                    return f"{subject}.{value.function}({value.zone.name})"
                constants = [each for each in value.arguments if isinstance(each, ir.Const)]
                constants = constants[: len(row.parameters)]
                units = [unit if unit != "1" else "" for _, unit in row.parameters]
                pairs = zip(constants, units, strict=True)
                arguments = ", ".join(f"{each.value} {unit}".strip() for each, unit in pairs)
                return f"{subject}.{value.function}({arguments})"
            case ir.Compute():
                operands = dict(zip(value.names, map(self.value, value.operands), strict=True))
                return re.sub(r"\bx\d+\b", lambda name: operands[name[0]], value.wording)
            case ir.Scale() | ir.Tuned():
                raise ValueError("it has no text of its own")


def _entry(condition: formulas.Expression, names: Mapping[str, str]) -> str:
    match condition:
        case formulas.Name():
            return names[condition.name]
        case formulas.Number():
            return str(condition.value)
        case formulas.Relation():
            left, right = (_entry(each, names) for each in (condition.left, condition.right))
            return f"{left} {condition.operator} {right}"
        case formulas.Negation():
            return f"not ({_entry(condition.operand, names)})"
        case formulas.Logical():
            texts = (f"({_entry(each, names)})" for each in condition.operands)
            return f" {condition.operator} ".join(texts)
    raise ValueError(f"{condition} is not a condition on entries")


def _path(path: FieldPath) -> str:
    return format_steps(path)
