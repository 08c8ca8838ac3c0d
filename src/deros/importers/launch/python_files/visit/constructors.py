"""How the objects of launch were made: with which arguments, and where in the launch file.

What launch keeps of them is private and differs between its versions; what they are made with is
its interface.
"""

from __future__ import annotations

import functools
import inspect
import sys
from collections.abc import Callable, Iterator, Mapping
from typing import Any

_GIVEN = "_deros_given"
_LINE = "_deros_line"
_DOES = frozenset({"execute", "visit", "perform", "evaluate"})
"""The methods in which a class says what it does."""


def given(made: Any) -> Mapping[str, Any]:
    """Return the arguments with which an object was made, by name; none of what is not recorded."""
    found: Mapping[str, Any] = vars(made).get(_GIVEN, {})
    return found


def line(made: Any) -> int:
    """Return the line of the launch file that made an object; 0 if it is not known."""
    found: int = getattr(made, "__dict__", {}).get(_LINE, 0)
    return found


def kind(made: Any) -> str:
    """Return the class of launch that an object is of, or that it does the same as.

    Of others it is the name of their own class.
    """
    for each in type(made).__mro__:
        if _is_of_launch(each) and _GIVEN in getattr(made, "__dict__", {}):
            return each.__name__
        if not _DOES.isdisjoint(vars(each)):
            break
    return type(made).__name__


def _is_of_launch(each: type) -> bool:
    return each.__module__.partition(".")[0] in ("launch", "launch_ros")


def record(bases: tuple[type, ...], file: str) -> None:
    """Record how each object is made from now on whose class is one of some, or derived from one.

    Args:
        bases: the classes.
        file: the launch file, as the code in it is told to be of.
    """
    for each in _with_derived(bases):
        constructor = vars(each).get("__init__")
        if inspect.isfunction(constructor):
            setattr(each, "__init__", _recording(constructor, file))  # noqa: B010 - not for mypy


def _with_derived(bases: tuple[type, ...]) -> Iterator[type]:
    waiting, seen = list(bases), set[type]()
    while waiting:
        each = waiting.pop()
        if each not in seen:
            seen.add(each)
            waiting += each.__subclasses__()
            if _is_of_launch(each):
                yield each


def _recording(constructor: Callable[..., None], file: str) -> Callable[..., None]:
    signature = inspect.signature(constructor)

    @functools.wraps(constructor)
    def recorded(self: Any, /, *positional: Any, **named: Any) -> None:
        # An iterator that is looked at here is used up for launch.
        positional = tuple(map(_kept, positional))
        named = {name: _kept(value) for name, value in named.items()}
        if _GIVEN not in vars(self):  # the outermost constructor has what the file says
            try:
                vars(self)[_GIVEN] = _flat(signature, (self, *positional), named)
                vars(self)[_LINE] = _line_in(file)
            except TypeError:
                pass  # the constructor itself says what is wrong
        constructor(self, *positional, **named)

    return recorded


def _kept(value: Any) -> Any:
    return list(value) if isinstance(value, Iterator) else value


def _flat(
    signature: inspect.Signature, positional: tuple[Any, ...], named: Mapping[str, Any]
) -> dict[str, Any]:
    bound = signature.bind(*positional, **named).arguments
    bound.pop(next(iter(signature.parameters)))
    found: dict[str, Any] = {}
    for name, value in bound.items():
        if signature.parameters[name].kind is inspect.Parameter.VAR_KEYWORD:
            found.update(value)
        else:
            found[name] = value
    return found


def _line_in(file: str) -> int:
    """Return the line of a file that is being executed."""
    frame = sys._getframe(1)
    while frame is not None:
        if frame.f_code.co_filename == file:
            return frame.f_lineno
        frame = frame.f_back  # type: ignore[assignment]
    return 0
