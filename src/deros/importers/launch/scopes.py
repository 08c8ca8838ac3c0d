"""What holds where an action of a launch file stands, and what the whole file makes known."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

from deros.importers.launch.blocks import Group, Line, Part
from deros.importers.launch.described import Types, argument_name
from deros.importers.launch.entities import Entity
from deros.importers.launch.values.argument_types import Declared
from deros.importers.launch.values.conditions import NOWHERE, all_of, negated
from deros.importers.launch.values.expressions import Expressions
from deros.importers.launch.values.substitutions import InexpressibleError
from deros.importers.results import Missing
from deros.models.arguments import Argument, Condition, Expression
from deros.models.node import PortKind

_NAME = re.compile(r"[A-Za-z_]\w*", re.ASCII)
_HIDDEN = frozenset({"ros_namespace", "global_params", "ros_remaps"})
"""Configurations in which launch_ros keeps what holds for a group."""


class NotSetError(InexpressibleError):
    """A configuration has a value that a model cannot say."""

    def __init__(self, name: str, why: str, line: int) -> None:
        super().__init__(f"needs $(var {name}), which {why}")
        self.name, self.why, self.line = name, why, line


@dataclass(slots=True)
class Scope:
    """What holds where an action stands.

    Attributes:
        values: of launch configurations.
        environment: variables that were set before.
        when: what holds for all that follows, beside the conditions of groups.
        delay_ns: how long after the start.
        remapped: names that are already remapped: what comes first counts.
        sees_outside: whether configurations of those who include the file are there, too.
        is_sure: whether it is there in any case.
    """

    group: Group
    values: dict[str, Expression | InexpressibleError] = field(default_factory=dict)
    environment: dict[str, Expression | InexpressibleError] = field(default_factory=dict)
    when: Condition | None = None
    delay_ns: int = 0
    remapped: set[str] = field(default_factory=set)
    sees_outside: bool = True
    is_sure: bool = True

    def inside(self, group: Group, condition: Condition | None) -> Scope:
        """Return the scope of a group, whose settings end with it."""
        return Scope(
            group,
            dict(self.values),
            dict(self.environment),
            condition,
            self.delay_ns,
            set(self.remapped),
            self.sees_outside,
            self.is_sure and condition is None,
        )

    def opened(self, key: tuple[str, str] | None = None) -> Group:
        """Return a group in which a setting counts for what follows, and for nothing before."""
        if self.group.members or (key is not None and key in self.group.set):
            self.open_group("group", None)
        if key is not None:
            self.group.set.add(key)
        return self.group

    def open_group(self, name: str, head: Line | None, *spaces: Expression) -> Group:
        """Go on in a group within the one so far, and return it."""
        inner = Group(self.group.unused(name), head, (*self.group.namespaces, *spaces))
        self.group.members.append(inner)
        self.group = inner
        return inner


class File:
    """A launch file on its way into a model."""

    def __init__(self, name: str, shown: str, folder: str, output: Path, types: Types) -> None:
        """Begin with a file.

        Args:
            name: of the file, without its folder.
            shown: its path as the user named it.
            folder: of the file, from that of the models.
            output: the folder of the models.
            types: of the nodes.
        """
        self.output = output
        self.name = name
        self.shown = shown
        self.folder = folder
        self.types = types
        self.root = Group("", None, ())
        self.declared: dict[str, Declared] = {}
        self.names: dict[str, str] = {}
        """What arguments are called in the model, by what they are called in the file."""
        self.missing: list[Missing] = []
        self.unsaid: list[NotSetError] = []
        self.topics: dict[str, list[tuple[PortKind, bool]]] = {}
        """The ends of each topic, and whether each is there in any case."""
        self.open_topics: dict[int, set[str]] = {}

    def refuse(self, what: str, why: str, line: int) -> None:
        """Note what the model does not say."""
        self.missing.append(Missing(what, why, self.shown, line))

    def argument_name(self, said: str, line: int) -> str:
        """Return what an argument is called in the model; no other one has that name."""
        if said not in self.names:
            found = argument_name(said)
            while found in self.names.values():
                found += "_"
            self.names[said] = found
            if found != said:
                self.refuse(f"the name of argument '{said}'", f"is '{found}' in the model", line)
        return self.names[said]

    def expressions(self, scope: Scope) -> Expressions:
        """Return what reads texts in a scope."""

        def unknown(name: str, default: Expression | None) -> Expression:
            is_name = _NAME.fullmatch(name) is not None
            if name in _HIDDEN or not scope.sees_outside or not (is_name or default is None):
                if default is not None:
                    return default
                raise InexpressibleError(f"needs $(var {name}), which nothing in the file sets")
            return self.argument(Declared(self.argument_name(name, 0), default))

        return Expressions(scope.values, scope.environment, self.folder, self.name, unknown)

    def argument(self, found: Declared) -> Argument:
        """Return an argument; what was declared first counts."""
        self.declared.setdefault(found.name, found)
        return Argument(found.name, NOWHERE)

    def condition(self, entity: Entity, scope: Scope) -> Condition | bool:
        """Return when an action is executed; what that is cannot be said, it is in any case."""
        said, unless = entity.get("if"), entity.get("unless")
        try:
            if said is not None and unless is not None:
                raise InexpressibleError("has both 'if' and 'unless', which launch refuses")
            if said is not None:
                return self.expressions(scope).condition(said)
            if unless is not None:
                return negated(self.expressions(scope).condition(unless))
        except InexpressibleError as error:
            what = f"the condition of '{entity.tag}'"
            self.refuse(what, f"is left out, so that it always holds: it {error}", entity.line)
        return True

    def left(self, entity: Entity) -> None:
        """Note what has not been asked for."""
        for what, line in entity.left():
            self.refuse(what, "is left out: a system cannot say it", line)


def both(scope: Scope, found: Condition | bool) -> Condition | None:
    """Return the condition of an action that may be executed, with that of its scope."""
    joined = all_of([True if scope.when is None else scope.when, found])
    assert joined is not False
    return None if joined is True else joined


def line_of(entity: Entity, *parts: Part, depth: int = 0, what: str = "") -> Line:
    """Return a line that an element becomes."""
    return Line(parts, what or f"'{entity.tag}'", entity.line, depth)
