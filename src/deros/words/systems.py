"""The words of system descriptions.

A name in a system is resolved in the namespace where it is written; of a subsystem that is there
several times, the first one counts.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from deros.diagnostics import Span
from deros.models.arguments import Condition, Expression, arguments_in
from deros.models.common import Name
from deros.models.node import NodeType, Parameter
from deros.models.programs import ProcessInstance
from deros.models.starting import Host
from deros.models.system import (
    NodeInstance,
    ParameterSetting,
    SafetyInstance,
    Subsystem,
    System,
    Topic,
    Wiring,
)
from deros.systems.flat import FlatPort, FlatSystem, UntypedWiring
from deros.systems.known_topics import KnownTopic, TopicTable
from deros.words.nodes import (
    node_type_word,
    parameter_word,
    port_word,
    type_word,
    unit_word,
    words_of_units,
)
from deros.words.words import Word, WordKind

_Member = NodeInstance | Subsystem | ProcessInstance


def words_of_system(system: System, flat: FlatSystem) -> Iterator[Word]:
    """Yield the words of a system description; ``flat`` is the system, expanded."""
    return _System(system, flat).words()


def system_word(span: Span, system: System) -> Word:
    """Return the word for a system."""
    return Word(
        span,
        WordKind.SYSTEM,
        system.name,
        system.name_span,
        description=system.description,
        meaning=system,
    )


def topic_word(span: Span, name: str, known: KnownTopic | None) -> Word:
    """Return the word for a topic, whose type and place the system may know."""
    kind = known.type if known is not None else None
    description = ""
    if known is not None and known.declarations:
        description = known.declarations[0].declaration.description
    return Word(
        span,
        WordKind.TOPIC,
        name,
        None,
        kind.short if kind is not None else "",
        description=description,
        meaning=known,
    )


def file_word(span: Span, files: Iterable[str]) -> Word:
    """Return the word for the path of files, as written."""
    return Word(span, WordKind.FILE, span.text.strip('"'), meaning=tuple(files))


class _System:
    """Collects the words of one system."""

    def __init__(self, system: System, flat: FlatSystem) -> None:
        self._system = system
        self._arguments = {each.name: each for each in system.arguments}
        self._made = {each.name: each for each in system.made}
        self._topics = TopicTable([flat])
        self._targets: dict[int, str] = {}
        self._names: dict[int, str] = {}
        for node in flat.nodes:
            wired: list[FlatPort | UntypedWiring] = [*node.ports, *node.untyped]
            for port in wired:
                if port.wiring is not None:
                    self._targets.setdefault(id(port.wiring), port.topic)
        for topic in flat.topics:
            self._names.setdefault(id(topic.declaration), topic.name)

    def words(self) -> Iterator[Word]:
        system = self._system
        yield system_word(system.name_span, system)
        for each in system.imports:
            text = Span(each.span.source, _path_start(each.span), each.span.end)
            yield file_word(text, each.files)
        for argument in system.arguments:
            yield parameter_word(argument.name_span, argument, WordKind.ARGUMENT)
            yield from self._computed(argument.default_from)
        yield from (_host_word(each.name_span, each) for each in system.hosts)
        yield from self._group(system)

    def _group(self, group: System | Subsystem) -> Iterator[Word]:
        for topic in group.topics:
            yield from self._topic(topic)
        for setting in group.settings.parameters:
            yield from self._setting(setting, None)
        for statement in group.safety:
            yield from self._safety(statement)
        for process in group.processes:
            yield self._member(process)
            yield from self._at(process.host)
            yield from self._computed(process.when)
        for made in group.made:
            yield Word(made.name_span, WordKind.ARGUMENT, made.name, made.name_span, meaning=made)
        for member in group.members:
            if isinstance(member, NodeInstance):
                yield from self._node(member)
            else:
                yield from self._subsystem(member)

    def _member(self, member: _Member) -> Word:
        kinds = {NodeInstance: WordKind.NODE, Subsystem: WordKind.SUBSYSTEM}
        kind = kinds.get(type(member), WordKind.PROCESS)
        return Word(
            member.name_span,
            kind,
            member.name,
            member.name_span,
            member.type_name if isinstance(member, NodeInstance) else "",
            description=member.description,
            meaning=member,
        )

    def _subsystem(self, group: Subsystem) -> Iterator[Word]:
        if group.launch is None:
            yield self._member(group)
        else:
            yield file_word(group.launch.path_span, ())
            yield from self._computed(*group.launch.computed)
        yield from self._at(group.host)
        yield from self._computed(group.when, group.namespace_from)
        if group.system is not None and group.system_span is not None:
            yield system_word(group.system_span, group.system)
            arguments = {each.name: each for each in group.system.arguments}
            for passed in group.passed:
                yield from _named(passed.name.span, arguments.get(passed.name.text))
        for passed in group.passed:
            yield from self._computed(passed.value)
        if group.launch is None:
            yield from self._group(group)

    def _node(self, node: NodeInstance) -> Iterator[Word]:
        yield self._member(node)
        if node.type is not None and not node.is_container:
            yield node_type_word(node.type_span, node.type)
        yield from self._at(node.host)
        yield from self._computed(node.when, node.namespace_from)
        for setting in node.parameters:
            yield from self._setting(setting, node.type)
        for wiring in node.wirings:
            yield from self._wiring(wiring, node.type)

    def _setting(self, setting: ParameterSetting, kind: NodeType | None) -> Iterator[Word]:
        if setting.origin is not None:
            return  # it stands in a parameter file
        parameter = kind.parameter_for(setting.name) if kind is not None else None
        if parameter is not None:
            yield parameter_word(setting.name_span, parameter)
        if setting.unit is not None and setting.unit_span is not None:
            yield unit_word(setting.unit_span, setting.unit)
        yield from self._computed(setting.when, *setting.computed, *setting.switches)

    def _wiring(self, wiring: Wiring, kind: NodeType | None) -> Iterator[Word]:
        if kind is not None:
            port = kind.port(wiring.port, wiring.kind)
            parameter = kind.parameter(wiring.port)
            if port is not None:
                yield port_word(wiring.port_span, port)
            elif parameter is not None:
                yield parameter_word(wiring.port_span, parameter)
        yield from self._computed(wiring.when, wiring.target_from)
        if wiring.target_from is None:
            yield self._target(wiring)

    def _target(self, wiring: Wiring) -> Word:
        name = self._targets.get(id(wiring), wiring.target)
        return topic_word(wiring.target_span, name, self._topics.get(name))

    def _topic(self, topic: Topic) -> Iterator[Word]:
        name = self._names.get(id(topic), topic.name)
        yield topic_word(topic.name_span, name, self._topics.get(name))
        if topic.type is not None and topic.type_span is not None:
            yield type_word(topic.type_span, topic.type)
            yield from words_of_units(topic.type, topic.units)
        yield from self._computed(topic.when, topic.name_from)

    def _safety(self, statement: SafetyInstance) -> Iterator[Word]:
        rules = statement.rules
        yield file_word(statement.path_span, () if rules is None else (rules.source.path,))
        yield from self._at(statement.host)
        yield from self._computed(statement.when, statement.namespace_from)
        yield from map(self._target, statement.wirings)

    def _at(self, host: Name | None) -> Iterator[Word]:
        known = next((h for h in self._system.hosts if host and h.name == host.text), None)
        if host is not None and known is not None:
            yield _host_word(host.span, known)

    def _computed(self, *computed: Expression | Condition | None) -> Iterator[Word]:
        for each in computed:
            for use in arguments_in(each) if each is not None else ():
                span = _without_dollar(use.span)
                yield from _named(span, self._arguments.get(use.name))
                made = self._made.get(use.name)
                if made is not None:
                    yield Word(span, WordKind.ARGUMENT, made.name, made.name_span, meaning=made)


def _host_word(span: Span, host: Host) -> Word:
    place, text = host.name_span, host.description
    return Word(span, WordKind.HOST, host.name, place, description=text, meaning=host)


def _named(span: Span, argument: Parameter | None) -> Iterator[Word]:
    if argument is not None:
        yield parameter_word(span, argument, WordKind.ARGUMENT)


def _without_dollar(span: Span) -> Span:
    """Return the place of the name alone in ``$speed``."""
    return Span(span.source, span.start + span.text.startswith("$"), span.end)


def _path_start(span: Span) -> int:
    """Return where the path begins in an ``import`` statement."""
    return span.start + max(0, span.text.find('"'))
