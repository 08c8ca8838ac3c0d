"""The views of nodes and processes to start, each with all that it is started with.

Some nodes are in the process of another program, which is given what is for them. A rule of ROS 2
that begins with the name of a node is for it alone. Of several rules that fit, the first one
counts, so those for the names of single nodes stand before those for all of the process.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from deros.generators.system.computed import Setting, Text, Variables, joined, plain_settings
from deros.generators.system.described import XacroView
from deros.generators.system.files import FileView
from deros.generators.system.waiting.wait_view import WaitView
from deros.models.arguments import Condition
from deros.models.common import Value
from deros.models.lifecycle import Autostart
from deros.models.starting import AT_ONCE, Starting
from deros.names.graph_names import resolve_name

Rule = tuple[Text, Text]
"""What stands before ``:=`` of a rule, and what stands behind it."""


@dataclass(frozen=True, slots=True)
class InsideView:
    """A node in the process of another program; the fields are those of a node that is started."""

    name: str
    namespace: Text
    parameters: tuple[tuple[str, Setting], ...]
    remappings: tuple[tuple[Text, Text], ...]
    described: tuple[tuple[str, XacroView], ...] = ()

    @property
    def full_name(self) -> str:
        """The node's name in the ROS graph; not of one whose namespace is computed."""
        assert isinstance(self.namespace, str)
        return resolve_name(self.name, self.namespace)

    @property
    def plain_parameters(self) -> Iterator[tuple[str, Value]]:
        """The parameters of a node for which nothing is computed."""
        return plain_settings(self.parameters)


@dataclass(frozen=True, slots=True)
class NodeView:
    """One node to start.

    Attributes:
        when: the condition of the node in this form; ``None``: it is always started.
        parameters: what the system sets, each value of the type that the node declares.
        files: parameter files, which the node reads before.
        remappings: pairs of a name in the node's code and a graph name, only where they differ;
            the first may start with ``rostopic://`` or ``rosservice://``.
        respawn_delay: seconds until it is started again; ``None``: it is not.
        respawn_max: how often that is done; ``None``: without limit.
        autostart: how it is brought to active when the system is started; ``None``: it is not.
        arguments: of the program, before those of ROS 2.
        environment: variables for the program alone.
        prefix: words before the program, as a shell would take them apart.
        container: the full name of the node that it is loaded into; ``None``: it is a process.
        plugin: the class that is loaded, if it is.
        intra_process: whether it exchanges messages with others in its container by pointers.
        address: of a container, its full name.
        starting: when it is started, and whether its exit stops all.
        described: parameters whose values xacro makes when the system is started.
        own_name: whether the program gives it the name itself, so that it is not renamed.
        inside: other nodes of its process.
        wait: what it waits for in the ROS graph before it is started, if it does.
    """

    name: str
    namespace: Text
    package: str
    executable: str
    lifecycle: bool
    parameters: tuple[tuple[str, Setting], ...]
    remappings: tuple[tuple[Text, Text], ...]
    log_level: str | None
    respawn_delay: float | None
    respawn_max: int | None
    description: str
    when: Condition | None = None
    arguments: tuple[Text, ...] = ()
    environment: Variables = ()
    prefix: Text | None = None
    autostart: Autostart | None = None
    files: tuple[FileView, ...] = ()
    container: Text | None = None
    plugin: str = ""
    intra_process: bool = False
    address: Text | None = None
    starting: Starting = AT_ONCE
    described: tuple[tuple[str, XacroView], ...] = ()
    own_name: bool = False
    inside: tuple[InsideView, ...] = ()
    wait: WaitView | None = None

    @property
    def is_node(self) -> bool:
        """Whether it is a node, and no other process."""
        return True

    @property
    def is_renamed(self) -> bool:
        """Whether the name is for all nodes of the process that do not name themselves."""
        return not self.own_name

    @property
    def full_name(self) -> str:
        """The node's name in the ROS graph; not of one whose namespace is computed."""
        assert isinstance(self.namespace, str)
        return resolve_name(self.name, self.namespace)

    @property
    def plain_parameters(self) -> Iterator[tuple[str, Value]]:
        """The parameters of a node for which nothing is computed."""
        return plain_settings(self.parameters)

    @property
    def logger(self) -> str:
        """The name of the node's own logger, as rcl makes it from the full name."""
        return self.full_name.removeprefix("/").replace("/", ".")


@dataclass(frozen=True, slots=True)
class ProcessView:
    """One process to start that is not a node; the fields are those of :class:`NodeView`.

    Attributes:
        program: a name that is looked up in the ``PATH``, or a path.
        folder: that it runs in; ``None``: that of whoever starts the system.
        inside: the nodes in it.
        files: their parameter files.
    """

    name: str
    program: Text
    arguments: tuple[Text, ...]
    environment: Variables
    prefix: Text | None
    folder: Text | None
    respawn_delay: float | None
    respawn_max: int | None
    description: str
    when: Condition | None = None
    starting: Starting = AT_ONCE
    inside: tuple[InsideView, ...] = ()
    files: tuple[FileView, ...] = ()
    wait: WaitView | None = None

    @property
    def is_node(self) -> bool:
        """Whether it is a node, and no other process."""
        return False

    @property
    def is_renamed(self) -> bool:
        """Whether its nodes are renamed."""
        return False

    @property
    def namespace(self) -> str:
        """The namespace of nodes that do not choose another one."""
        return "/"

    @property
    def remappings(self) -> tuple[tuple[Text, Text], ...]:
        """Those of the nodes in it are theirs."""
        return ()

    @property
    def described(self) -> tuple[tuple[str, XacroView], ...]:
        """Xacro makes no values for nodes in it."""
        return ()


# Nodes in the process of another program ----------------------------------------------------------


def names_inside(program: NodeView | ProcessView) -> Iterator[str]:
    """Yield the names of the nodes of a process that it would rename together with its own."""
    if program.is_renamed:
        yield from (node.name for node in program.inside)


def elsewhere(program: NodeView | ProcessView) -> Sequence[InsideView]:
    """Return the nodes of a process that are not in its namespace."""
    return [node for node in program.inside if node.namespace != program.namespace]


def remappings_of(program: NodeView | ProcessView) -> Iterator[Rule]:
    """Yield the remappings of a process; where it has several nodes, each is for one of them."""
    own = f"{program.name}:" if program.inside else ""
    yield from ((joined(own, name), target) for name, target in program.remappings)
    for node in program.inside:
        yield from ((joined(f"{node.name}:", name), target) for name, target in node.remappings)
