"""The generated classes and the user's classes, as they are read in every language."""

from __future__ import annotations

from dataclasses import dataclass

from deros.diagnostics import Span

NODE_HOOKS = ("on_parameters_changed",)
LIFECYCLE_HOOKS = (
    "on_activate",
    "on_cleanup",
    "on_configure",
    "on_deactivate",
    "on_error",
    "on_shutdown",
)
HOOKS = frozenset((*NODE_HOOKS, *LIFECYCLE_HOOKS))
"""Methods of ROS 2 and of the generated classes that every node may override."""


@dataclass(frozen=True, slots=True)
class Name:
    """A name in a file, and its location."""

    text: str
    span: Span


@dataclass(frozen=True, slots=True)
class Base:
    """A generated class: its offers to the user's class, and its requirements.

    Attributes:
        name: of the generated class.
        required: the methods that the user's class has to have.
        offered: everything that it has, those included.
        parameters: the fields of its structure of parameters; ``None`` if it has none.
        fatal: what happens without a required method.
        kind: what it asks for: a method of a class, or a function of a module.
    """

    name: str
    required: tuple[str, ...]
    offered: frozenset[str]
    parameters: frozenset[str] | None
    fatal: str
    kind: str = "method"


@dataclass(frozen=True, slots=True)
class Written:
    """The user's class as it is.

    Attributes:
        name: of the class, where it is declared.
        methods: those that it declares.
        known: all other names that the file itself gives to the class, or mentions as its own.
        used: names that its code asks the base class for.
        parameters: fields that its code reads of the parameters.
        complete: whether all that the class has can be seen; it may inherit from classes of other
            files.
        actions: whether every method is meant to be one that the base class knows.
    """

    name: Name
    methods: tuple[Name, ...]
    known: frozenset[str]
    used: tuple[Name, ...]
    parameters: tuple[Name, ...]
    complete: bool
    actions: bool = False
