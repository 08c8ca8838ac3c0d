"""Names of ROS 2 turned into names of a programming language, and the collisions this can cause."""

from __future__ import annotations

import keyword
import re
from collections.abc import Iterable
from dataclasses import dataclass

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.generators.protocol import GenerationError

_NOT_IN_IDENTIFIERS = re.compile(r"\W+", re.ASCII)


def python_identifier(name: str) -> str:
    """Return the Python identifier for a ROS 2 name.

    A leading ``/`` or ``~/`` is dropped, every other run of characters that no identifier may hold
    becomes ``_``: ``/fmInformation/imu`` is ``fmInformation_imu``. Keywords get a ``_`` at the end,
    names that start with a digit one at the front.
    """
    return _legal(_NOT_IN_IDENTIFIERS.sub("_", name.removeprefix("~").removeprefix("/")) or "_")


def camel_case(name: str) -> str:
    """Return the class name for a ROS 2 name: ``vectornav_vn100_node`` is ``VectornavVn100Node``.

    Capitals within a word stay, so ``fmSensors`` is ``FmSensors``.
    """
    words = [word for word in python_identifier(name).split("_") if word]
    text = "".join(word[0].upper() + word[1:] for word in words) or "_"
    return _legal(text)


def _legal(text: str) -> str:
    if text[0].isdigit():
        return f"_{text}"
    return f"{text}_" if keyword.iskeyword(text) else text


@dataclass(frozen=True, slots=True)
class Emitted:
    """One name that a target emits: the identifier, what it stands for in the model, and where."""

    identifier: str
    origin: str
    span: Span


def check_collisions(emitted: Iterable[Emitted], within: str) -> None:
    """Refuse a model of which two things would get one name in ``within``.

    Raises:
        GenerationError: with one ``DRS401`` for each name that is taken already.
    """
    first: dict[str, Emitted] = {}
    found: list[Diagnostic] = []
    for item in emitted:
        other = first.setdefault(item.identifier, item)
        if other is item:
            continue
        found.append(
            report(
                codes.NAME_COLLISION,
                f"{item.origin} and {other.origin} both become {item.identifier!r} in {within}",
                item.span,
                hint="rename one of them",
                related=(Related(other.span, f"{other.origin} is here"),),
            )
        )
    if found:
        raise GenerationError(found)
