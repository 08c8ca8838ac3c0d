"""What a launch file in XML or YAML consists of, whichever of the two it is written in."""

from __future__ import annotations

from dataclasses import dataclass

from deros.models.common import Scalar


@dataclass(frozen=True, slots=True)
class ReadAsYaml:
    """A text with substitutions that launch_xml reads as YAML, as it does for a ``bool``."""

    text: str


Value = Scalar | tuple[Scalar, ...] | ReadAsYaml


@dataclass(frozen=True, slots=True)
class Comment:
    """A comment between actions."""

    text: str


@dataclass(frozen=True, slots=True)
class Element:
    """An action, or a detail of one.

    Attributes:
        tag: of the element in XML, and the key in YAML.
        attributes: in the order to write; a number where launch_yaml accepts no text.
        details: elements that say more about this one, such as ``param``.
        children: actions in it; ``None``: it cannot have any.
    """

    tag: str
    attributes: tuple[tuple[str, Value], ...] = ()
    details: tuple[Element, ...] = ()
    children: tuple[Element | Comment, ...] | None = None


def element(tag: str, /, *details: Element, **attributes: Value | None) -> Element:
    """Return an element; attributes without a value are left out, and ``__`` in a name is ``-``.

    A ``_`` at the end of a name only tells it from a keyword.
    """
    named = (
        (name.removesuffix("_").replace("__", "-"), value)
        for name, value in attributes.items()
        if value is not None
    )
    return Element(tag, tuple(named), details)


def group(*children: Element | Comment, condition: tuple[tuple[str, Value], ...] = ()) -> Element:
    """Return a group of actions, whose settings count in it alone."""
    return Element("group", condition, children=children)
