"""Substitutions as the texts that they are in XML: ``$(var robot)``."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from deros.importers.launch.python_files.visit.constructors import given, kind


class Call(NamedTuple):
    """``$(name operand …)``."""

    name: str
    operands: tuple[Pieces, ...] = ()


Pieces = tuple["str | Call", ...]

PLACES: dict[str, Call] = {}
"""Folders that the launch file has asked for or is in, and what to write for them."""

_WRITTEN: Mapping[str, tuple[str, tuple[str, ...]]] = {
    "AllSubstitution": ("all", ("*",)),
    "AndSubstitution": ("and", ("left", "right")),
    "AnonName": ("anon", ("name",)),
    "AnySubstitution": ("any", ("*",)),
    "Command": ("command", ("command",)),
    "EnvironmentVariable": ("env", ("name", "default_value")),
    "EqualsSubstitution": ("equals", ("left", "right")),
    "ExecutableInPackage": ("exec-in-pkg", ("executable", "package")),
    "FileContent": ("file-content", ("path",)),
    "FindExecutable": ("find-exec", ("name",)),
    "FindPackage": ("find-pkg-prefix", ("package",)),
    "FindPackagePrefix": ("find-pkg-prefix", ("package",)),
    "FindPackageShare": ("find-pkg-share", ("package",)),
    "IfElseSubstitution": ("if", ("condition", "if_value", "else_value")),
    "LaunchConfiguration": ("var", ("variable_name", "default")),
    "NotEqualsSubstitution": ("not-equals", ("left", "right")),
    "NotSubstitution": ("not", ("value",)),
    "OrSubstitution": ("or", ("left", "right")),
    "PythonExpression": ("eval", ("expression",)),
    "ThisLaunchFile": ("filename", ()),
    "ThisLaunchFileDir": ("dirname", ()),
}
"""How substitutions are written, and the arguments of their classes that become operands."""

_PLAIN = frozenset("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-")


def text(value: Any) -> str:
    """Return a value as a text with substitutions in it."""
    return _rendered(pieces(value), _in_text)


def words(values: Iterable[Any]) -> str:
    """Return a command line, whose words are values."""
    return " ".join(_rendered(pieces(each), _in_word) or "''" for each in values)


def pieces(value: Any) -> Pieces:
    """Return the texts and substitutions that a value is put together from."""
    if isinstance(value, bool):
        return ("true" if value else "false",)
    if isinstance(value, (str, Path)):
        return _with_places(str(value))
    if value is None or isinstance(value, (int, float)):
        return ("" if value is None else str(value),)
    if isinstance(value, Call):
        return (value,)
    if isinstance(value, Iterable):
        return tuple(piece for each in value for piece in pieces(each))
    return _substitution(value)


def _substitution(value: Any) -> Pieces:
    what, said = kind(value), given(value)
    if what == "TextSubstitution":
        return pieces(said["text"])
    if what == "PathJoinSubstitution":
        return _joined(said["substitutions"])
    name, operands = _WRITTEN.get(what, (plain_name(what), ()))
    if operands == ("*",):
        return (Call(name, tuple(map(pieces, said.get("args", ())))),)
    if what == "IfElseSubstitution":
        said = {"if_value": "", "else_value": "", **said}
    found = [pieces(said[each]) for each in operands if said.get(each) is not None]
    return (Call(name, tuple(found)),)


def is_text(value: Any) -> bool:
    """Return whether a value may be a text, or is put together from some."""
    if isinstance(value, (list, tuple)):
        return all(map(is_text, value))
    return isinstance(value, (str, Path, bool, int, float)) or hasattr(value, "perform")


def is_known(value: Any) -> bool:
    """Return whether a value has no substitutions but those of launch."""
    if value is None or isinstance(value, (str, Path, bool, int, float)):
        return True
    if isinstance(value, Iterable):
        return all(map(is_known, value))
    what, said = kind(value), given(value)
    if what not in {*_WRITTEN, "TextSubstitution", "PathJoinSubstitution"}:
        return False
    return all(is_known(each) for each in said.values() if not callable(each))


def plain_name(what: str) -> str:
    """Return a name that no substitution of launch has."""
    return "".join(each if each.isalnum() else "-" for each in what).strip("-") or "substitution"


def _joined(parts: Iterable[Any]) -> Pieces:
    """Return the parts of a path with ``/`` between them; an absolute one begins anew."""
    found: list[str | Call] = []
    for each in map(pieces, parts):
        first, last = each[:1], found[-1:]
        if first and isinstance(first[0], str) and first[0].startswith("/"):
            found.clear()
        elif found and not (isinstance(last[0], str) and last[0].endswith("/")):
            found.append("/")
        found += each
    return tuple(found)


# Places -----------------------------------------------------------------------------------------


def _with_places(said: str) -> Pieces:
    """Return a text in which the paths of known folders are what leads to them anywhere."""
    for folder in sorted(PLACES, key=len, reverse=True):
        before, mark, after = said.partition(folder)
        if mark and (not after or after.startswith("/")):
            place = PLACES[folder]
            # That a text begins like the launch file's own folder may be chance.
            if place.name == "dirname" and not (not before and Path(said).exists()):
                continue
            return (*_with_places(before), place, *_with_places(after))
    return (said,) if said else ()


# Escapes ----------------------------------------------------------------------------------------


def _rendered(found: Pieces, escape: Callable[[str], str]) -> str:
    return "".join(escape(each) if isinstance(each, str) else _called(each) for each in found)


def _called(found: Call) -> str:
    operands = (_rendered(each, _in_operand) or "''" for each in found.operands)
    return f"$({' '.join((found.name, *operands))})"


def _in_text(said: str) -> str:
    return said.replace("\\", "\\\\").replace("$", "\\$")


def _in_operand(said: str) -> str:
    return "".join(each if each in _PLAIN else f"\\{each}" for each in said)


def _in_word(said: str) -> str:
    """Return a part of one word of a command line, in which a shell's rules hold as well."""
    return _in_text(_in_operand(said))
