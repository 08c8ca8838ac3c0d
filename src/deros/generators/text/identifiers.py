"""Conversion of ROS 2 names to identifiers and file names, and detection of collisions."""

from __future__ import annotations

import builtins
import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import PurePosixPath

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.generators.api.protocol import GenerationError
from deros.names.keywords import PYTHON

_NOT_IN_IDENTIFIERS = re.compile(r"\W+", re.ASCII)
_WORD = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])")
_PLAIN_IN_FILE_NAMES = " _.+-@"
PYTHON_WORDS = PYTHON | {name for name in dir(builtins) if name.islower()}
"""Names that emitted Python must not define: keywords, and builtins that it may call."""


def file_label(path: str) -> str:
    """Return the name of a file, without its folder, escaped for generated text.

    File names may contain everything but ``/`` and NUL, and quotes, line breaks or comment signs
    would become code. Letters, digits, spaces and ``_.+-@`` are kept. Any other character is
    replaced by ``%`` and the hexadecimal number of each byte, as in a URL.
    """
    return "".join(
        character
        if character.isalnum() or character in _PLAIN_IN_FILE_NAMES
        else "".join(f"%{byte:02X}" for byte in character.encode("utf-8", "surrogateescape"))
        for character in PurePosixPath(path).name
    )


def python_identifier(name: str) -> str:
    """Return the Python identifier for a ROS 2 name.

    A leading ``/`` or ``~/`` is removed, and any other run of characters that are not allowed in
    identifiers becomes ``_``: ``/fmInformation/imu`` becomes ``fmInformation_imu``. Keywords get a
    ``_`` at the end, names that start with a digit get one at the front.
    """
    return _legal(_NOT_IN_IDENTIFIERS.sub("_", name.removeprefix("~").removeprefix("/")) or "_")


def camel_case(name: str) -> str:
    """Return the class name for a ROS 2 name, ``VectornavVn100Node`` for ``vectornav_vn100_node``.

    Capitals within a word are kept: ``fmSensors`` becomes ``FmSensors``.
    """
    words = [word for word in python_identifier(name).split("_") if word]
    text = "".join(word[0].upper() + word[1:] for word in words) or "_"
    return _legal(text)


def snake_case(name: str) -> str:
    """Return a name in camel case in lower case: ``JointState`` is ``joint_state``."""
    return _WORD.sub("_", name).lower()


def _legal(text: str) -> str:
    if text[0].isdigit():
        return f"_{text}"
    return f"{text}_" if text in PYTHON else text


@dataclass(frozen=True, slots=True)
class Emitted:
    """An identifier that a target emits.

    Attributes:
        identifier: the identifier.
        origin: the construct of the model that it stands for.
        span: the location of that construct.
    """

    identifier: str
    origin: str
    span: Span


def check_collisions(emitted: Iterable[Emitted], within: str, *, files: bool = False) -> None:
    """Reject a model in which two constructs would get the same name.

    Args:
        emitted: the names, in the order of the model.
        within: the scope in which names must be unique, for the message.
        files: whether the names are file names, which are also compared without case.

    Raises:
        GenerationError: with one ``DRS401`` for each name that is taken already.
    """
    first: dict[str, Emitted] = {}
    diagnostics: list[Diagnostic] = []
    for item in emitted:
        key = item.identifier.casefold() if files else item.identifier
        other = first.setdefault(key, item)
        if other is item:
            continue
        both = f"{item.origin} and {other.origin}"
        message = f"{both} both become {item.identifier!r} in {within}"
        if item.identifier != other.identifier:
            names = f"{item.identifier!r} and {other.identifier!r}"
            message = f"{both} become {names} in {within}, which differ only in case"
        diagnostics.append(
            report(
                codes.NAME_COLLISION,
                message,
                item.span,
                hint="rename one of them",
                related=(Related(other.span, f"{other.origin} is here"),),
            )
        )
    if diagnostics:
        raise GenerationError(diagnostics)
