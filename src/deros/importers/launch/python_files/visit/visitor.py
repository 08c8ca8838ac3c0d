"""A visit to the actions of a launch file, which runs the functions that make some of them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from contextlib import suppress
from functools import partial
from typing import Any

from deros.importers.launch.python_files.visit.actions import Site, conditions, made
from deros.importers.launch.python_files.visit.computed import (
    is_computed_file,
    maker_of,
    parameters_in,
)
from deros.importers.launch.python_files.visit.constructors import given, kind, line
from deros.importers.launch.python_files.visit.elements import Made, element
from deros.importers.launch.python_files.visit.texts import text

_SETS = frozenset(
    {
        *("AppendEnvironmentVariable", "DeclareLaunchArgument", "PopEnvironment"),
        *("PopLaunchConfigurations", "PushEnvironment", "PushLaunchConfigurations"),
        *("PushROSNamespace", "PushRosNamespace", "ResetEnvironment"),
        *("ResetLaunchConfigurations", "SetEnvironmentVariable", "SetLaunchConfiguration"),
        *("UnsetEnvironmentVariable", "UnsetLaunchConfiguration"),
    }
)
"""Actions that change values, which functions of the launch file may ask for."""

_MOST_LEVELS = 80


class Visitor:
    """Makes elements of actions.

    Attributes:
        unsaid: what no element says: what it is, why, and its line.
    """

    def __init__(self, context: Any, values: Mapping[str, str]) -> None:
        """Begin a visit.

        Args:
            context: of launch, which knows the values of configurations where the visit is.
            values: of arguments, as they are given to launch.
        """
        self.unsaid: list[tuple[str, str, int]] = []
        self._context = context
        self._values = values
        self._declared: set[str] = set()
        self._is_dead = False
        self._depth = 0

    def elements(self, actions: Iterable[Any]) -> list[Made]:
        """Return what some actions are."""
        self._depth += 1
        if self._depth > _MOST_LEVELS:
            raise RecursionError(f"actions are nested more than {_MOST_LEVELS} levels deep")
        found: list[Made] = []
        for action in actions:
            found += self._elements(action)
        self._depth -= 1
        return found

    def close(self) -> None:
        """Note the values that no argument takes."""
        for name in self._values.keys() - self._declared:
            self.refuse(f"the value of '{name}'", "is of no use: no argument has that name", 0)

    def refuse(self, what: str, why: str, place: int) -> None:
        """Note what no element says."""
        self.unsaid.append((what, why, place))

    def _elements(self, action: Any) -> list[Made]:
        what = kind(action)
        if what == "OpaqueFunction":
            return self._computed(action)
        if hasattr(action, "entities"):  # a launch description
            return self.elements(action.entities)
        happens = self._happens(action)
        was_dead, self._is_dead = self._is_dead, self._is_dead or happens is False
        found = made(action, Site(partial(self._inner, action), self._parameters))
        if what in _SETS and not self._is_dead:
            self._execute(action)
        self._is_dead = was_dead
        if found is None:
            self.refuse(f"'{what}'", "is left out: a system cannot say it", line(action))
            return []
        if what == "DeclareLaunchArgument":
            self._declare(action.name, found)
        return [found]

    def _inner(self, group: Any, actions: Iterable[Any]) -> list[Made]:
        """Return what is in a group, with the values that it has in it."""
        own = list(actions)
        if kind(group) != "GroupAction" or self._is_dead:
            return self.elements(own)
        found: list[Made] = []
        known = set(map(id, own))
        for each in group.execute(self._context):
            if id(each) in known:
                found += self.elements([each])
            else:  # how launch itself begins and ends a group
                self._execute(each)
        return found

    def _declare(self, name: str, found: Made) -> None:
        self._declared.add(name)
        if name in self._values:
            found["attributes"]["default"] = text(self._values[name])

    # What Python computes -------------------------------------------------------------------------

    def _computed(self, action: Any) -> list[Made]:
        """Return what a function of the launch file makes, which is run for that."""
        what, place = "'OpaqueFunction'", line(action)
        if self._is_dead or self._happens(action) is False:
            why = "is left out: it is run for certain values alone, and not for those there are"
            self.refuse(what, why, place)
            return []
        try:
            actions = action.execute(self._context)
        except (Exception, SystemExit) as error:
            why = f"is left out: it fails with the values there are, {failure(error)}"
            self.refuse(what, why, place)
            return []
        children = self.elements(actions or [])
        if not children:
            self.refuse(what, "makes no action with the values that it was run with", place)
            return []
        why = "is what it makes with the values that it was run with; see NAME:=VALUE"
        self.refuse(what, why, place)
        return [element("group", place, {"scoped": False, **conditions(action)}, children)]

    def _parameters(self, node: Any, file: Any) -> Mapping[str, Any] | None:
        """Return the parameters of a node that are in a file which is made on the way."""
        if self._is_dead or not is_computed_file(file):
            return None
        what, place = f"the file of '{maker_of(file)}'", line(node)
        try:
            found = parameters_in(file, node, self._context)
        except (Exception, SystemExit) as error:
            why = f"cannot be made with the values there are, {failure(error)}"
            self.refuse(what, why, place)
            return None
        why = "has the parameters that it was made with; see NAME:=VALUE"
        self.refuse(what, why, place)
        return found

    def _happens(self, action: Any) -> bool | None:
        """Return whether an action is executed; ``None`` if that cannot be computed."""
        condition = given(action).get("condition")
        if condition is None:
            return True
        try:
            return bool(condition.evaluate(self._context))
        except Exception:
            return None

    def _execute(self, action: Any) -> None:
        """Have an action change the values; what needs one that is not given says so itself."""
        with suppress(Exception):
            action.execute(self._context)


def failure(error: BaseException) -> str:
    """Return what has failed, in one line."""
    said = " ".join(str(error).split())
    return f"{type(error).__name__}: {said}" if said else type(error).__name__
