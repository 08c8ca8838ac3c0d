"""Expressions, conditions and arguments of systems, from their text."""

from __future__ import annotations

from deros.metamodels.load import Repository
from deros.models.arguments import Condition, Expression, Literally
from deros.models.common import Scalar
from deros.models.node import Parameter
from deros.models.system import NodeInstance, System


def system_of(text: str) -> System:
    """Return a system from its text, whatever its imports define."""
    model = Repository().load_text("s.system", text).model
    assert isinstance(model, System)
    return model


def expression(text: str) -> Expression:
    """Return an expression as the value of a parameter."""
    (node,) = system_of(f"system S node n : p parameters param x = {text}").members
    assert isinstance(node, NodeInstance)
    setting = node.parameters[0]
    if setting.value_from is None:
        assert not isinstance(setting.value, tuple)
        return Literally(setting.value, setting.value_span)
    assert not isinstance(setting.value_from, tuple)
    return setting.value_from


def condition(text: str) -> Condition:
    """Return the condition of a topic."""
    (topic,) = system_of(f"system S topics topic /x when {text}").topics
    assert topic.when is not None
    return topic.when


def arguments(text: str) -> tuple[Parameter, ...]:
    """Return the arguments that a system declares."""
    return system_of(f"system S {text}").arguments


def text_of(value: Scalar) -> str:
    """Return a value as it is given on a command line."""
    return str(value).lower() if isinstance(value, bool) else str(value)
