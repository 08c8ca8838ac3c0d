"""From the textX objects of a system description to a :class:`~deros.models.system.System`."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any

from deros import codes
from deros.diagnostics import Related
from deros.metamodels.converters.convert import Sections, unknown
from deros.metamodels.converters.convert_arguments import ArgumentConverter
from deros.metamodels.converters.convert_composition import (
    COMPOSITION_WORDS,
    CompositionConverter,
)
from deros.metamodels.converters.convert_inside import InsideConverter
from deros.metamodels.converters.convert_lifecycle import LifecycleConverter
from deros.metamodels.converters.convert_parameter_files import ParameterFileConverter
from deros.metamodels.converters.convert_programs import (
    PROGRAM_WORDS,
    ProgramConverter,
    with_setting,
)
from deros.metamodels.converters.convert_starting import STARTING_WORDS
from deros.metamodels.converters.convert_xacro import XacroConverter
from deros.metamodels.languages import DEROS, IMPORTED_BY_SYSTEMS
from deros.metamodels.scoping import FileIndex, attach_index
from deros.models.common import QosProfile
from deros.models.launch_files import MadeFile
from deros.models.node import KINDS_BY_WORD, NodeType, Parameter, as_double
from deros.models.parameter_files import ParameterFile
from deros.models.programs import ProcessInstance, Variable
from deros.models.qos import pinned_policies
from deros.models.starting import Host
from deros.models.system import (
    GroupSettings,
    Import,
    NodeInstance,
    ParameterSetting,
    RulesReference,
    SafetyInstance,
    Subsystem,
    System,
    Topic,
    Wiring,
)

if TYPE_CHECKING:
    from deros.metamodels.load import Loading
    from deros.metamodels.scoping import Reference

_WORDS = {
    **PROGRAM_WORDS,
    **COMPOSITION_WORDS,
    **STARTING_WORDS,
    "Namespace": "namespace",
    "When": "when",
    "LogLevel": "log_level",
    "ActivatedBy": "activated by",
    "Autostart": "autostart",
    "Qos": "qos",
    "AnyPublishers": "publishers",
    "TopicRate": "rate",
    "FieldUnits": "field units",
    "NodeName": "as",
    "Target": "target",
    "Package": "package",
}

_GROUP = frozenset({"GroupVariable", "Settings", "GroupRemappings", "ParameterFile"})
"""The rules of settings for all that is below; a used system may be given these, and no parts."""


def load_system(loading: Loading) -> System:
    """Load a system description, its imports before its references are resolved."""
    index = FileIndex()
    imports: list[Import] = []

    def follow_imports(model: Any) -> None:
        statements = [
            statement
            for part in model.parts
            if type(part).__name__ == "Imports"
            for statement in part.imports
        ]
        imports.extend(loading.follow(each, index, IMPORTED_BY_SYSTEMS) for each in statements)
        index.complete &= not loading.source.mentions_lost("import")
        attach_index(model, index)

    model = loading.parse(follow_imports)
    converter = SystemConverter(loading, index)
    result = converter.system(model, imports)
    loading.diagnostics += converter.diagnostics
    for statement in converter.safety:
        loading.refer(statement, (DEROS,))
    return result


@dataclass(slots=True)
class _Parts:
    """What stands in a system or a subsystem."""

    topics: list[Topic] = field(default_factory=list)
    members: list[NodeInstance | Subsystem] = field(default_factory=list)
    safety: list[SafetyInstance] = field(default_factory=list)
    processes: list[ProcessInstance] = field(default_factory=list)
    files: list[ParameterFile] = field(default_factory=list)
    made: list[MadeFile] = field(default_factory=list)
    settings: GroupSettings = field(default_factory=GroupSettings)

    def fields(self) -> dict[str, Any]:
        """Return them as fields of a system or a subsystem."""
        lists = (each.name for each in fields(self) if each.name != "settings")
        return {"settings": self.settings, **{name: tuple(getattr(self, name)) for name in lists}}


class SystemConverter(
    LifecycleConverter,
    CompositionConverter,
    InsideConverter,
    ProgramConverter,
    ParameterFileConverter,
    XacroConverter,
):
    """Converts one system description; ``index`` is what its imports define."""

    def __init__(self, loading: Loading, index: FileIndex) -> None:
        ArgumentConverter.__init__(self, loading.source)
        self.load_parameter_file = loading.parameter_files.load
        self.load_launch_file = loading.launch_files.load
        self.load_xacro_file = loading.launch_files.load_xacro
        self._index = index
        self.arguments: list[Parameter] = []
        self.hosts: list[Host] = []
        self.safety: list[SafetyInstance] = []
        """Every ``safety`` statement, for the loader to resolve."""

    def system(self, model: Any, imports: Iterable[Import]) -> System:
        """Return the system that the file describes."""
        self.note_made_files(model.parts)
        parts = self._parts(model.parts)
        system = System(
            name=str(model.name),
            source=self.source,
            span=self.span(model),
            name_span=self.token_span(model.name),
            imports=tuple(imports),
            node_types={name: found[0] for name, found in self._index.node_types.items()},
            systems={name: found[0] for name, found in self._index.systems.items()},
            arguments=tuple(self.arguments),
            hosts=tuple(self.hosts),
            is_computed=self.is_computed,
            **parts.fields(),
            **self._modifiers(model.modifiers),
        )
        return self.with_owners(system)

    def _parts(self, parts: Any) -> _Parts:
        """Convert the parts of a system or a subsystem."""
        sections = Sections(self)
        found = _Parts()
        member, is_imported = None, False
        for part in parts:
            if not is_imported and part._tx_position >= self.imported_from:
                is_imported, member = True, None  # members above are in the part of the user's
            kind = type(part).__name__
            if kind == "NodeInstance":
                found.members.append(self._node(part))
                member = f"node '{part.name}'"
            elif kind == "Container":
                found.members += self._container(part)
                member = f"container '{part.name}'"
            elif kind == "InsideProcess":
                found.members += self.inside_nodes(part, map(self._node, part.nodes))
                member = "an 'inside' statement"
            elif kind == "Subsystem":
                found.members.append(self._subsystem(part))
                member = f"subsystem '{part.name}'"
            elif kind == "LaunchInstance":
                found.members.append(self._launched(part))
                member = "a 'launch' statement"
            elif kind == "SafetyInstance":
                found.safety.append(self._safety(part))
                member = "a 'safety' statement"
            elif kind == "ProcessInstance":
                found.processes.append(self.process(part))
                member = f"process '{part.name}'"
            elif kind == "ParameterFile":
                found.files.append(self.parameter_file(part))
                self.check_before_members(part, member is not None)
            elif kind == "MadeFile":
                found.made.append(self.made_file(part))
            elif kind == "ArgumentDeclaration":
                argument = self.argument(part)
                self.arguments += [] if argument is None else [argument]
            elif kind == "HostDeclaration":
                self.hosts.append(self.host(part))
            elif kind == "GroupVariable":
                self.check_place(part, member)
                variable = self.variable(part)
                found.settings = with_setting(found.settings, environment=(variable,))
            else:
                sections.once(str(part.keyword), self.token_span(part.keyword))
                if kind == "DeclaredTopics":
                    found.topics += map(self._topic, part.topics)
                elif kind != "Imports":
                    self.check_place(part, member)
                    found.settings = self._group(found.settings, part)
        self.safety += found.safety
        return found

    def _group(self, settings: GroupSettings, part: Any) -> GroupSettings:
        if type(part).__name__ == "Settings":
            made = (self._setting(each, None) for each in part.settings)
            return with_setting(settings, parameters=tuple(made))
        return with_setting(settings, remappings=tuple(map(self.remapping, part.remappings)))

    def _topic(self, found: Any) -> Topic:
        settings: dict[str, Any] = {}
        if found.type is not None:
            of_type, place = self.interface(found.type, "msg"), self.token_span(found.type)
            settings = {"type": of_type, "type_span": place}
        if found.attributes:
            attributes = Sections(self)
            for attribute in found.attributes:
                what = _WORDS.get(type(attribute).__name__, "description")
                if not attributes.once(what, self.span(attribute)):
                    continue
                if what == "qos":
                    settings["qos"] = self._pin(attribute)
                elif what == "field units":
                    if found.type is None:
                        message = "fields have units where the topic has a type"
                        hint = f"write 'topic {found.name} : PACKAGE.TYPE {{ ... }}'"
                        self.report(codes.SYNTAX_ERROR, message, self.span(attribute), hint)
                        continue
                    settings["units"] = tuple(map(self.field_unit, attribute.fields))
                elif what == "publishers":
                    settings["any_publishers"] = True
                elif what == "rate":
                    settings["rate_hz"] = self.rate_hz(attribute.rate)
                elif what == "when":
                    settings["when"] = self.condition(attribute.condition)
                else:
                    settings["description"] = self.text(attribute.text)
        name, name_from = self.computed_name(found.name)
        return Topic(
            name,
            self.span(found),
            self.token_span(found.name),
            external=found.external,
            name_from=name_from,
            **settings,
        )

    def _pin(self, found: Any) -> QosProfile:
        before = len(self.diagnostics)
        qos = self.qos(found)
        if not pinned_policies(qos) and len(self.diagnostics) == before:
            self.report(
                codes.EMPTY_QOS_PIN,
                "this pins nothing: with system_default, the middleware chooses every policy",
                self.span(found),
                "write the policies that the ends have to meet, as 'qos reliable'",
            )
        return qos

    def _subsystem(self, found: Any) -> Subsystem:
        settings = self._modifiers(found.modifiers)
        reference: Reference[System] | None = found.system
        if reference is not None:
            self._check_known(reference, "system", self._index.systems)
            settings |= {
                "system_name": str(reference.name),
                "system_span": self.token_span(reference.name),
                "system": reference.target,
                "passed": tuple(map(self.passed, found.passed)),
            }
            self.is_computed |= reference.target is not None and reference.target.is_computed
            if any(type(each).__name__ not in _GROUP for each in found.parts):
                message = f"'{found.name}' uses a system and also has its own parts"
                hint = "put the parts into a subsystem of their own"
                self.report(codes.SYNTAX_ERROR, message, self.token_span(found.name), hint)
        return Subsystem(
            str(found.name),
            self.span(found),
            self.token_span(found.name),
            **self._parts(found.parts).fields(),
            **settings,
        )

    def _node(self, found: Any) -> NodeInstance:
        reference: Reference[NodeType] = found.type
        self._check_known(reference, "node type", self._index.node_types)
        node_type = reference.target
        sections = self._sections(found.sections, node_type)
        return NodeInstance(
            str(found.name),
            str(reference.name),
            node_type,
            self.span(found),
            self.token_span(found.name),
            self.token_span(reference.name),
            **sections,
            **(self._modifiers(found.modifiers) if found.modifiers else {}),
        )

    def _container(self, found: Any) -> list[NodeInstance]:
        container = self.container(found, self._modifiers(found.modifiers))
        return [
            container,
            *(self.in_container(self._node(each), container) for each in found.nodes),
        ]

    def _launched(self, found: Any) -> Subsystem:
        nodes = () if found.provides is None else tuple(map(self._node, found.provides.nodes))
        return self.launched(found, self._modifiers(found.modifiers), nodes)

    def _safety(self, found: Any) -> SafetyInstance:
        return SafetyInstance(
            self.text(found.path),
            RulesReference(),
            self.span(found),
            self.token_span(found.path),
            **self._sections(found.sections, None),
            **self._modifiers(found.modifiers),
        )

    def _sections(self, found: Any, node_type: NodeType | None) -> dict[str, Any]:
        """Return the fields that the sections of a node set."""
        files: list[ParameterFile] = []
        fields: dict[str, Any] = {}
        sections = Sections(self)
        for section in found:
            if type(section).__name__ == "ParameterFile":
                files.append(self.parameter_file(section))
                continue
            sections.once(str(section.keyword), self.token_span(section.keyword))
            kind = type(section).__name__
            if kind == "Settings":
                made = (self._setting(each, node_type) for each in section.settings)
                fields["parameters"] = (*fields.get("parameters", ()), *made)
            elif kind == "Wirings":
                wirings = map(self._wiring, section.wirings)
                fields["wirings"] = (*fields.get("wirings", ()), *wirings)
            else:
                remappings = map(self.remapping, section.remappings)
                fields["remappings"] = (*fields.get("remappings", ()), *remappings)
        return {"files": tuple(files), **fields}

    def _setting(self, found: Any, node_type: NodeType | None) -> ParameterSetting:
        if found.xacro is not None:
            return self.made_setting(found)
        value, value_from = self.computed_value(found)
        name = self.written(found.name)
        parameter = node_type.parameter_for(name) if node_type is not None else None
        return ParameterSetting(
            name,
            value if parameter is None else as_double(value, parameter.type),
            self.span(found),
            self.token_span(found.name),
            self.setting_span(found),
            self.unit(found.unit),
            None if found.unit is None else self.token_span(found.unit),
            value_from,
            None if found.when is None else self.condition(found.when.condition),
            element_conditions=self.element_conditions(found),
        )

    def _wiring(self, found: Any) -> Wiring:
        target, target_from = self.computed_name(found.target)
        return Wiring(
            self.written(found.port),
            target,
            self.span(found),
            self.token_span(found.port),
            self.token_span(found.target),
            None if found.kind is None else KINDS_BY_WORD[found.kind],
            target_from,
            None if found.when is None else self.condition(found.when.condition),
        )

    def _modifiers(self, modifiers: Any) -> dict[str, Any]:
        settings: dict[str, Any] = {}
        variables: list[Variable] = []
        once = Sections(self)
        for modifier in modifiers:
            if type(modifier).__name__ == "Variable":
                variables.append(self.variable(modifier))
                continue
            what = _WORDS.get(type(modifier).__name__, "description")
            if not once.once(what, self.span(modifier)):
                continue
            if what == "namespace":
                namespace, namespace_from = self.computed_name(modifier.namespace)
                settings |= {
                    "namespace": namespace,
                    "namespace_span": self.token_span(modifier.namespace),
                    "namespace_from": namespace_from,
                }
            elif what == "when":
                settings["when"] = self.condition(modifier.condition)
            elif what in PROGRAM_WORDS.values():
                settings |= self.program_modifier(what, modifier)
            elif what in COMPOSITION_WORDS.values():
                settings |= self.composition_modifier(what, modifier)
            elif what == "log_level":
                settings["log_level"] = str(modifier.level)
            elif what == "activated by":
                settings |= {
                    "activated_by": str(modifier.manager),
                    "activated_by_span": self.token_span(modifier.manager),
                }
            elif what == "autostart":
                settings["autostart"] = self.autostart(modifier)
            elif what == "as":
                settings |= {
                    "node_name": str(modifier.name),
                    "node_name_span": self.token_span(modifier.name),
                }
            elif what == "target":
                settings["target"] = str(modifier.target)
            elif what == "package":
                settings |= {
                    "package": str(modifier.package),
                    "package_span": self.token_span(modifier.package),
                }
            elif what not in STARTING_WORDS.values():
                settings["description"] = self.text(modifier.text)
        if variables:
            settings["environment"] = tuple(variables)
        return settings | self.starting(modifiers)

    def _check_known(
        self, reference: Reference[Any], what: str, known: dict[str, tuple[Any, ...]]
    ) -> None:
        found = reference.candidates
        if len(found) == 1:
            return
        span = self.token_span(reference.name)
        if found:
            files = " and ".join(f"'{each.source.path}'" for each in found)
            message = f"the {what} '{reference.name}' is defined in {files}"
            places = (Related(each.name_span, "defined here") for each in found)
            hint = "import only one of them, or rename one"
            self.report(codes.AMBIGUOUS_NODE_TYPE, message, span, hint, *places)
        elif self._index.complete:
            code = codes.UNKNOWN_SYSTEM if what == "system" else codes.UNKNOWN_NODE_TYPE
            self.report(code, *unknown(reference.name, what, known, span))
