"""Parameter files of a system: the statements that name them, and what stands in one.

``parameters from "nav2.yaml"`` of a node, a subsystem or a system is a :class:`ParameterFile`. A
file that has been read is a :class:`Document`, whose positions lead into the YAML. How several of
them become the parameters of one node is :mod:`deros.systems.parameters.overrides`.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Literal

from deros.diagnostics import SourceFile, Span
from deros.models.arguments import Condition, Expression, LaunchArgument
from deros.names.names import check_namespace

if TYPE_CHECKING:
    from deros.models.common import Value

_IN_PACKAGE = re.compile(r"share:(?P<package>[^/]*)/(?P<path>.*)", re.DOTALL)


MARK = "ros__parameters"
"""The key above the parameters of a node."""


@dataclass(frozen=True, slots=True)
class Fault:
    """Why a file cannot be used, and where; ``hint`` is what to do."""

    message: str
    span: Span
    hint: str = ""


@dataclass(frozen=True, slots=True)
class Unmovable(Fault):
    """A key that ROS 2 would refuse below a namespace."""


@dataclass(frozen=True, slots=True)
class FileValue:
    """One value of a section.

    Attributes:
        name: the full name of the parameter, ``gains.p``.
        value: as ROS 2 reads it; ``None``: it has none, which ends the node that reads it.
        name_span: of the last part of its name.
        value_span: of its value.
    """

    name: str
    value: Value | None
    name_span: Span
    value_span: Span


@dataclass(frozen=True, slots=True)
class Section:
    """The parameters under one key.

    Attributes:
        key: the nodes that it is for, as ROS 2 composes it: ``/**``, ``/front/lidar``, ``lidar``.
        spans: of each place where the file has the key.
        values: in the order in which ROS 2 applies them.
    """

    key: str
    spans: tuple[Span, ...]
    values: tuple[FileValue, ...]


EventKind = Literal["scalar", "list", "end of list", "mapping", "end of mapping"]


@dataclass(frozen=True, slots=True)
class Event:
    """One step of a YAML parser.

    Attributes:
        kind: what begins or ends.
        span: where.
        text: of a scalar.
        is_text: whether a scalar is a text, whatever it looks like: by quotes or by its tag.
        is_quoted: whether a scalar stands in quotes.
        is_in_braces: whether it stands inside of ``[]`` or ``{}``.
    """

    kind: EventKind
    span: Span
    text: str = ""
    is_text: bool = False
    is_quoted: bool = False
    is_in_braces: bool = False


@dataclass(frozen=True, slots=True)
class Substituted:
    """What stands for ``$(…)`` in a parameter file.

    Attributes:
        values: of ``$(var NAME)``, by name.
        used: the names that are in the file.
        faults: what cannot be substituted.
        looks_up: whether something is looked up where the system is started.
    """

    values: tuple[tuple[str, str], ...]
    used: frozenset[str]
    faults: tuple[Fault, ...]
    looks_up: bool


@dataclass(frozen=True, slots=True, eq=False)
class Document:
    """A parameter file that ROS 2 reads.

    Attributes:
        source: the file.
        path: its absolute path, without symbolic links: files are the same one if this is.
        events: the steps in which it is read.
        sections: what it says by itself.
        keys: that its text has been put under, in ``events`` and ``sections``.
        substituted: what has been put into it, if anything could be.
    """

    source: SourceFile
    path: str
    events: tuple[Event, ...]
    sections: tuple[Section, ...]
    keys: tuple[str, ...] = ()
    substituted: Substituted | None = None

    @property
    def contents(self) -> tuple[object, ...]:
        """By which two are known to say the same: the path, and what is made of the text."""
        made = self.substituted
        return self.path, self.keys, None if made is None else made.values


@dataclass(frozen=True, slots=True)
class NotInstalled:
    """The package of a ``share:`` file is not known here."""

    package: str


@dataclass(frozen=True, slots=True)
class Missing:
    """There is no such file, or it cannot be read: ``reason``."""

    path: str
    reason: str


def in_package(path: str) -> tuple[str, str] | None:
    """Return package and path in its share folder, if a path names a file of a package."""
    found = _IN_PACKAGE.fullmatch(path)
    return (found["package"], found["path"]) if found is not None else None


LoadedFile = Document | Fault | Missing | NotInstalled
"""What has become of a parameter file; a ``Fault`` lies in the file itself."""

Load = Callable[["ParameterFile"], LoadedFile]
"""Reads the file that a statement names; the same file only once."""


@dataclass(frozen=True, slots=True)
class Below:
    """``below NAMESPACE``: where the keys of a parameter file are moved to.

    Attributes:
        namespace: from the root, with or without its leading ``/``; nothing is moved below ``""``.
        is_assumed: it is computed from what is only known at the start.
    """

    namespace: str
    span: Span = field(compare=False, repr=False)
    namespace_from: Expression | None = None
    is_assumed: bool = False

    @property
    def fault(self) -> str | None:
        """Why no key can stand below it, after "it"; ``None`` where some can."""
        return check_namespace(self.namespace) if self.namespace else None


@dataclass(frozen=True, slots=True)
class Plain:
    """``plain as PARAMETER``: a file that holds parameters, and no names of nodes.

    Attributes:
        parameter: that all of them are below, with a dot between; ``""``: they have their names.
    """

    parameter: str
    span: Span = field(compare=False, repr=False)

    @property
    def keys(self) -> tuple[str, ...]:
        """The keys that its text is put under, to become a file for all who read it."""
        return ("/**", MARK, *filter(None, self.parameter.split(".")))


@dataclass(frozen=True, slots=True)
class ParameterFile:
    """``parameters from PATH below NAMESPACE``, or ``plain``.

    Attributes:
        path: relative to the file of the system that writes it, absolute, or
            ``share:PACKAGE/PATH`` for a file of an installed package.
        loader: reads it.
        is_assumed: the path is computed from what is only known at the start.
        below: where its keys are moved to, if they are.
        plain: it has no names of nodes.
        given: the values for ``$(var NAME)`` in it; ``None``: nothing is substituted.
        is_bare: it is read for its text alone.
    """

    path: str
    span: Span = field(compare=False, repr=False)
    path_span: Span = field(compare=False, repr=False)
    loader: Load = field(compare=False, repr=False)
    path_from: Expression | None = None
    when: Condition | None = None
    is_assumed: bool = False
    below: Below | None = None
    plain: Plain | None = None
    given: tuple[LaunchArgument, ...] | None = None
    is_bare: bool = False

    @property
    def keys(self) -> tuple[str, ...]:
        """The keys that its text is put under."""
        if self.plain is not None:
            return self.plain.keys
        namespace = "" if self.below is None else self.below.namespace
        return (namespace,) if namespace else ()

    @property
    def in_package(self) -> tuple[str, str] | None:
        """The package and the path in its share folder, if it is a file of a package."""
        return in_package(self.path)

    @property
    def folder(self) -> str:
        """The folder that a relative path starts from."""
        return os.path.dirname(self.span.source.path)  # noqa: PTH120 - stays as the user named it

    @property
    def placed(self) -> tuple[Expression, ...]:
        """What its path, and the namespace of its keys, are computed from."""
        below = None if self.below is None else self.below.namespace_from
        return tuple(each for each in (self.path_from, below) if each is not None)

    @property
    def computed(self) -> tuple[Expression, ...]:
        """What all of it is computed from."""
        given = (each.value_from for each in self.given or ())
        return (*self.placed, *(each for each in given if each is not None))

    def used_at(self, path: str) -> frozenset[str]:
        """Return the names for which the file at ``path`` takes a value, if it can be read."""
        given = tuple(replace(each, value="", value_from=None) for each in self.given or ())
        found = self.loader(replace(self, path=path, path_from=None, below=None, given=given))
        made = found.substituted if isinstance(found, Document) else None
        return frozenset() if made is None else made.used

    def load(self) -> LoadedFile | None:
        """Return the file, with its values, and its keys where they are moved to.

        ``None`` where one of these is only known at the start, or is not what it has to be.
        """
        if self.below is not None and (self.below.is_assumed or self.below.fault):
            return None
        is_assumed = self.is_assumed or any(each.is_assumed for each in self.given or ())
        return None if is_assumed else self.loader(self)

    @property
    def is_known(self) -> bool:
        """Whether what it says is the same wherever the system is started."""
        found = self.load()
        if not isinstance(found, Document):
            return False
        return found.substituted is None or not found.substituted.looks_up

    def original(self) -> LoadedFile | None:
        """Return the file as it is, without what it says; ``None`` where its path is not known."""
        return None if self.is_assumed else self.loader(replace(self, is_bare=True))


@dataclass(frozen=True, slots=True)
class Origin:
    """Where a parameter of a node comes from, if it is not set in the system itself.

    Attributes:
        file: the statement that names the file.
        key: of the section.
    """

    file: ParameterFile
    key: str

    @property
    def is_for_several(self) -> bool:
        """Whether the key may be for several nodes."""
        return "*" in self.key
