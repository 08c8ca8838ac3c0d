"""Existing launch files that a system starts as they are, and files that xacro makes texts of.

A ``launch`` statement is a :class:`~deros.models.system.Subsystem` with a :class:`LaunchFile`. One
that has been read is a :class:`LaunchDocument`: what can be known of it without running it. The
text that xacro makes is the value of a parameter: :class:`XacroFile`. See
:mod:`deros.models.system` for ``…_from``.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from deros.diagnostics import SourceFile, Span
from deros.models.arguments import Condition, Expression, LaunchArgument
from deros.models.parameter_files import Fault, Missing, NotInstalled, in_package


@dataclass(frozen=True, slots=True)
class DeclaredArgument:
    """An argument that a launch file declares.

    Attributes:
        span: of the declaration.
        choices: the texts that it may be; without any, it may be each.
        is_required: whether it has to be given.
    """

    span: Span
    choices: tuple[str, ...]
    is_required: bool


@dataclass(frozen=True, slots=True, eq=False)
class LaunchDocument:
    """A launch file, and what is known of it.

    Attributes:
        source: the file.
        path: its absolute path, without symbolic links.
        arguments: that it declares, by name.
        used: names of arguments that it uses, declared or not.
        nodes: the names of nodes that it starts.
        is_complete: whether that is all: nothing in it is computed, or in another file.
    """

    source: SourceFile
    path: str
    arguments: Mapping[str, DeclaredArgument] = field(default_factory=dict)
    used: frozenset[str] = frozenset()
    nodes: frozenset[str] = frozenset()
    is_complete: bool = False


LoadedLaunchFile = LaunchDocument | Fault | Missing | NotInstalled
"""What has become of a launch file; a ``Fault`` lies in the file itself."""

LoadLaunchFile = Callable[["LaunchFile"], LoadedLaunchFile]
"""Reads the file that a statement names; the same file only once."""


@dataclass(frozen=True, slots=True)
class LaunchFile:
    """``launch PATH (NAME = VALUE, …)``.

    Attributes:
        path: as that of a :class:`~deros.models.parameter_files.ParameterFile`.
        is_described: whether the statement says which nodes the file starts.
        is_assumed: the path is computed from what is only known at the start.
    """

    path: str
    span: Span = field(compare=False, repr=False)
    path_span: Span = field(compare=False, repr=False)
    loader: LoadLaunchFile = field(compare=False, repr=False)
    arguments: tuple[LaunchArgument, ...] = ()
    is_described: bool = False
    path_from: Expression | None = None
    is_assumed: bool = False

    @property
    def in_package(self) -> tuple[str, str] | None:
        """The package and the path in its share folder, if it is a file of a package."""
        return in_package(self.path)

    @property
    def folder(self) -> str:
        """The folder that a relative path starts from."""
        return os.path.dirname(self.span.source.path)  # noqa: PTH120 - stays as the user named it

    @property
    def computed(self) -> tuple[Expression, ...]:
        """What its path and the values of its arguments are computed from."""
        found = (self.path_from, *(each.value_from for each in self.arguments))
        return tuple(each for each in found if each is not None)

    def load(self) -> LoadedLaunchFile | None:
        """Return the file; ``None`` where its path is only known at the start."""
        return None if self.is_assumed else self.loader(self)


@dataclass(frozen=True, slots=True, eq=False)
class XacroDocument:
    """A file for xacro, and what is known of it and of the files that it includes.

    Attributes:
        source: the file.
        path: its absolute path, without symbolic links.
        arguments: that ``xacro:arg`` declares, by name, each with its place.
        used: names of arguments that it uses, declared or not.
        needed: of these, those that are looked at whenever the file is read, with their places.
        included: the files that it includes, as far as their names are known.
        is_complete: whether that is all: nothing else is included.
    """

    source: SourceFile
    path: str
    arguments: Mapping[str, Span] = field(default_factory=dict)
    used: frozenset[str] = frozenset()
    needed: Mapping[str, Span] = field(default_factory=dict)
    included: tuple[XacroDocument, ...] = ()
    is_complete: bool = False

    @property
    def whole(self) -> tuple[XacroDocument, ...]:
        """The file and all that it includes, each once."""
        found = {self.path: self}
        for each in self.included:
            found |= {inner.path: inner for inner in each.whole if inner.path not in found}
        return tuple(found.values())


LoadedXacroFile = XacroDocument | Fault | Missing | NotInstalled
"""What has become of a file for xacro; a ``Fault`` lies in the file itself."""

LoadXacroFile = Callable[["XacroFile"], LoadedXacroFile]
"""Reads the file that a parameter names; the same file only once."""


@dataclass(frozen=True, slots=True)
class XacroFile:
    """``from xacro PATH (NAME = VALUE, …)``: a text that xacro makes when the system is started.

    It is the value of a parameter, or a file.

    Attributes:
        path: as that of a :class:`~deros.models.parameter_files.ParameterFile`.
        is_assumed: the path is computed from what is only known at the start.
    """

    path: str
    path_span: Span = field(compare=False, repr=False)
    loader: LoadXacroFile = field(compare=False, repr=False)
    arguments: tuple[LaunchArgument, ...] = ()
    path_from: Expression | None = None
    is_assumed: bool = False

    @property
    def in_package(self) -> tuple[str, str] | None:
        """The package and the path in its share folder, if it is a file of a package."""
        return in_package(self.path)

    @property
    def folder(self) -> str:
        """The folder that a relative path starts from."""
        return os.path.dirname(self.path_span.source.path)  # noqa: PTH120 - as the user named it

    @property
    def computed(self) -> tuple[Expression, ...]:
        """What its path and the values of its arguments are computed from."""
        found = (self.path_from, *(each.value_from for each in self.arguments))
        return tuple(each for each in found if each is not None)

    @property
    def located(self) -> str:
        """Where it is: an absolute path, or ``share:PACKAGE/PATH``."""
        if self.in_package is not None:
            return self.path
        return os.path.abspath(os.path.join(self.folder, self.path))  # noqa: PTH100, PTH118

    @property
    def given(self) -> dict[str, str]:
        """The values of its arguments."""
        return {each.name: each.value for each in self.arguments}

    def load(self) -> LoadedXacroFile | None:
        """Return the file; ``None`` where its path is only known at the start."""
        return None if self.is_assumed else self.loader(self)


@dataclass(frozen=True, slots=True)
class MadeFile:
    """``file NAME from xacro PATH (NAME = VALUE, …)``.

    Attributes:
        name: by which its path is used, ``$NAME``, wherever in the system.
        xacro: of which file it is made, and with which arguments.
        when: where it is made; elsewhere, its path is the empty text.
    """

    name: str
    xacro: XacroFile
    span: Span = field(compare=False, repr=False)
    name_span: Span = field(compare=False, repr=False)
    when: Condition | None = None
