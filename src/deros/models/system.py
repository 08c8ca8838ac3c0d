"""The typed model of a system description (``*.system``), as written.

For the system at run time (full names, connections) see :mod:`deros.systems.flatten`.

What is computed from arguments stands in ``…_from``; the field itself then holds the text as
written, until :mod:`deros.systems.arguments.resolve` has put the value in its place. A part with
``when`` is there where that condition holds.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

from deros.diagnostics import SourceFile, Span
from deros.interfaces.types import InterfaceType
from deros.models.arguments import Condition, Expression, Passed
from deros.models.common import Name, QosProfile, Value
from deros.models.composition import Inside, Into, IntraProcess, OtherType
from deros.models.launch_files import LaunchFile, MadeFile, XacroFile
from deros.models.lifecycle import Autostart
from deros.models.node import FieldUnit, NodeType, Parameter, PortKind
from deros.models.parameter_files import Origin, ParameterFile
from deros.models.programs import ProcessInstance, Remapping, Respawn, Variable, Word
from deros.models.starting import AT_ONCE, Host, Starting

if TYPE_CHECKING:
    from deros.models.rules import Rules


@dataclass(frozen=True, slots=True)
class Import:
    """An ``import`` line: a path or a glob, and the files that it found, in sorted order."""

    path: str
    files: tuple[str, ...]
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Topic:
    """A declared topic; ``type`` is there only when the declaration pins it.

    ``any_publishers``: several nodes are meant to publish it. ``rate_hz``: how many messages come
    in a second on average, where that is known; nothing follows from it while the system runs.
    """

    name: str  # as written
    span: Span = field(compare=False, repr=False)
    name_span: Span = field(compare=False, repr=False)
    type: InterfaceType | None = None
    type_span: Span | None = field(default=None, compare=False, repr=False)
    qos: QosProfile | None = None
    external: bool = False
    description: str = ""
    units: tuple[FieldUnit, ...] = ()
    any_publishers: bool = False
    rate_hz: float | None = None
    name_from: Expression | None = None
    when: Condition | None = None


@dataclass(frozen=True, slots=True)
class ParameterSetting:
    """``param NAME = VALUE [UNIT]`` of a node instance, or a value in a parameter file.

    Where ``xacro`` makes the value, it is known only when the system is started: ``value`` is then
    what is written for it. Of a list some of whose elements have conditions, ``value_from`` and
    ``element_conditions`` have all elements.
    """

    name: str
    value: Value
    span: Span = field(compare=False, repr=False)
    name_span: Span = field(compare=False, repr=False)
    value_span: Span = field(compare=False, repr=False)
    unit: str | None = None
    unit_span: Span | None = field(default=None, compare=False, repr=False)
    value_from: Expression | tuple[Expression, ...] | None = None
    when: Condition | None = None
    origin: Origin | None = None  # of a value in a parameter file
    xacro: XacroFile | None = None
    element_conditions: tuple[Condition | None, ...] = ()

    @property
    def switches(self) -> tuple[Condition, ...]:
        """What decides which elements of a list are there."""
        return tuple(each for each in self.element_conditions if each is not None)

    @property
    def computed(self) -> tuple[Expression, ...]:
        """What the value is computed from."""
        if self.xacro is not None:
            return self.xacro.computed
        if self.value_from is None:
            return ()
        return self.value_from if isinstance(self.value_from, tuple) else (self.value_from,)


@dataclass(frozen=True, slots=True)
class Wiring:
    """``connect PORT to TOPIC``: the port, or string parameter, and the graph name, as written.

    ``kind`` says which of the ports of that name is meant; without it, all are.
    """

    port: str
    target: str
    span: Span = field(compare=False, repr=False)
    port_span: Span = field(compare=False, repr=False)
    target_span: Span = field(compare=False, repr=False)
    kind: PortKind | None = None
    target_from: Expression | None = None
    when: Condition | None = None


@dataclass(frozen=True, slots=True)
class GroupSettings:
    """The settings at the head of a system or a subsystem, for all that is below."""

    environment: tuple[Variable, ...] = ()
    parameters: tuple[ParameterSetting, ...] = ()
    remappings: tuple[Remapping, ...] = ()


@dataclass(frozen=True, slots=True)
class NodeInstance:
    """A node of the system; ``type`` is ``None`` when no import defines ``type_name``.

    ``activated_by`` names, as written, the node that brings it to active. ``plugin`` is the class
    that a container loads, where the instance names one. A container is such a node, too;
    ``other_type`` is then its type for some values of the arguments. With ``own_name``, the program
    names the node, and ``name`` is how it does; so it is of one that is ``inside`` the process of
    another program.
    """

    name: str
    type_name: str
    type: NodeType | None = field(compare=False, repr=False)
    span: Span = field(compare=False, repr=False)
    name_span: Span = field(compare=False, repr=False)
    type_span: Span = field(compare=False, repr=False)
    namespace: str | None = None
    namespace_span: Span | None = field(default=None, compare=False, repr=False)
    parameters: tuple[ParameterSetting, ...] = ()
    wirings: tuple[Wiring, ...] = ()
    respawn: Respawn | None = None
    log_level: str | None = None
    activated_by: str | None = None
    activated_by_span: Span | None = field(default=None, compare=False, repr=False)
    autostart: Autostart | None = None
    description: str = ""
    namespace_from: Expression | None = None
    when: Condition | None = None
    arguments: tuple[Word, ...] = ()
    environment: tuple[Variable, ...] = ()
    prefix: Word | None = None
    files: tuple[ParameterFile, ...] = ()
    into: Into | None = None
    plugin: Name | None = None
    intra_process: IntraProcess | None = None
    other_type: OtherType | None = None
    is_container: bool = False
    inside: Inside | None = None
    own_name: Span | None = field(default=None, compare=False, repr=False)
    starting: Starting = AT_ONCE
    remappings: tuple[Remapping, ...] = ()
    host: Name | None = None

    @property
    def component(self) -> Name | None:
        """The class that a container loads: its own, or else that of its type."""
        return self.plugin or (self.type.plugin if self.type is not None else None)


class RulesReference:
    """The rules that a ``safety`` statement names: the loader resolves it when both are loaded.

    The rules use the system that names them, so neither file can be complete before the other.
    ``rules`` is ``None`` when the file could not be loaded, or holds an error of syntax.
    """

    __slots__ = ("rules",)

    def __init__(self) -> None:
        """Create a reference that is not resolved yet."""
        self.rules: Rules | None = None


@dataclass(frozen=True, slots=True)
class SafetyInstance:
    """``safety "FILE.deros"``: the safety node of these rules and its gates, wired as they say.

    Attributes:
        path: of the rules, as written.
        node_name: of the safety node in the ROS graph, if given.
        target: the language that the nodes are generated in.
        package: that they are generated in, without what the target appends; if given.
        parameters: each is for all of the nodes that have it.
        wirings: of ports that the rules do not name, such as ``~/heartbeat``.
    """

    path: str
    reference: RulesReference = field(compare=False, repr=False)
    span: Span = field(compare=False, repr=False)
    path_span: Span = field(compare=False, repr=False)
    node_name: str | None = None
    node_name_span: Span | None = field(default=None, compare=False, repr=False)
    target: Literal["python", "cpp"] = "python"
    package: str | None = None
    package_span: Span | None = field(default=None, compare=False, repr=False)
    namespace: str | None = None
    namespace_span: Span | None = field(default=None, compare=False, repr=False)
    parameters: tuple[ParameterSetting, ...] = ()
    wirings: tuple[Wiring, ...] = ()
    respawn: Respawn | None = None
    log_level: str | None = None
    description: str = ""
    namespace_from: Expression | None = None
    when: Condition | None = None
    environment: tuple[Variable, ...] = ()
    prefix: Word | None = None
    files: tuple[ParameterFile, ...] = ()
    host: Name | None = None

    @property
    def rules(self) -> Rules | None:
        """The rules, or ``None`` when they could not be loaded."""
        return self.reference.rules


@dataclass(frozen=True, slots=True)
class Subsystem:
    """A named group of nodes and subsystems, or the use of an imported system.

    ``subsystem left : Arm namespace /left`` has ``system_name`` and, when an import defines it,
    ``system``; it has no topics and members of its own. A ``launch`` statement is a subsystem with
    ``launch``, whose members are the nodes that the launch file starts, as far as they are known.
    """

    name: str
    span: Span = field(compare=False, repr=False)
    name_span: Span = field(compare=False, repr=False)
    namespace: str | None = None
    namespace_span: Span | None = field(default=None, compare=False, repr=False)
    topics: tuple[Topic, ...] = ()
    members: tuple[NodeInstance | Subsystem, ...] = ()
    safety: tuple[SafetyInstance, ...] = ()
    system_name: str | None = None
    system_span: Span | None = field(default=None, compare=False, repr=False)
    system: System | None = field(default=None, compare=False, repr=False)
    description: str = ""
    namespace_from: Expression | None = None
    passed: tuple[Passed, ...] = ()
    when: Condition | None = None
    autostart: Autostart | None = None
    settings: GroupSettings = GroupSettings()
    processes: tuple[ProcessInstance, ...] = ()
    files: tuple[ParameterFile, ...] = ()
    launch: LaunchFile | None = None
    host: Name | None = None
    made: tuple[MadeFile, ...] = ()


@dataclass(frozen=True, slots=True)
class System:
    """A whole system description.

    ``node_types`` and ``systems`` are what its imports define, by name. ``is_computed`` where a
    part of it, or of a system that it uses, is computed from arguments or has a condition.
    """

    name: str
    source: SourceFile = field(compare=False, repr=False)
    span: Span = field(compare=False, repr=False)
    name_span: Span = field(compare=False, repr=False)
    imports: tuple[Import, ...] = ()
    topics: tuple[Topic, ...] = ()
    members: tuple[NodeInstance | Subsystem, ...] = ()
    safety: tuple[SafetyInstance, ...] = ()
    node_types: Mapping[str, NodeType] = field(default_factory=dict, compare=False, repr=False)
    systems: Mapping[str, System] = field(default_factory=dict, compare=False, repr=False)
    description: str = ""
    arguments: tuple[Parameter, ...] = ()
    is_computed: bool = False
    autostart: Autostart | None = None
    settings: GroupSettings = GroupSettings()
    processes: tuple[ProcessInstance, ...] = ()
    files: tuple[ParameterFile, ...] = ()
    hosts: tuple[Host, ...] = ()
    host: Name | None = None
    made: tuple[MadeFile, ...] = ()
