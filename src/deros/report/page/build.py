"""The contents of a page, made of a system and its findings."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from deros import __version__
from deros.diagnostics import Diagnostic
from deros.models.arguments import Condition
from deros.models.node import FieldUnit, Parameter
from deros.models.qos import Policies, Policy, PolicyValue, pinned_policies, policies, words
from deros.models.system import Subsystem, System
from deros.report.page import contents
from deros.report.page.contents import Contents, Place, place_of
from deros.report.page.expressions import Encoder, Json, literal
from deros.report.page.subjects import Subjects
from deros.systems.arguments.diagrams import TooManyCombinations
from deros.systems.arguments.evaluate import CannotEvaluate
from deros.systems.arguments.scopes import usual_values
from deros.systems.arguments.symbolic import (
    SymbolicNode,
    SymbolicSystem,
    SymbolicTopic,
    as_written,
)
from deros.systems.flat import (
    FlatLaunch,
    FlatNode,
    FlatPort,
    FlatProcess,
    FlatProgram,
    UntypedWiring,
)
from deros.systems.flatten import flatten
from deros.validators.wiring.graph import CHANNEL, SOURCES, End

FAULTY_ARGUMENTS = (
    "What this system computes from its arguments has errors or too many combinations, so the page"
    " shows it with the usual values only."
)


def build(system: System, findings: Sequence[Diagnostic]) -> Contents:
    """Return what the page of a system shows.

    Args:
        system: which may have faults; what is unknown is left out, as in :func:`flatten`.
        findings: of its check, in the order in which the page lists them.
    """
    return _Builder(system, findings).result()


class _Builder:
    def __init__(self, system: System, findings: Sequence[Diagnostic]) -> None:
        self._system = system
        self._findings = findings
        symbolic = _symbolic(system)
        self._note = FAULTY_ARGUMENTS if system.is_computed and symbolic is None else ""
        self._encoder = Encoder(symbolic)
        self._groups = dict(_groups(system, (), (system,)))
        if symbolic is None:
            flat = flatten(system)
            programs: Iterable[SymbolicNode] = (SymbolicNode(each, None) for each in flat.parts)
            self._topics = tuple(SymbolicTopic(each, None) for each in flat.topics)
        else:
            programs, self._topics = symbolic.nodes, symbolic.topics
        self._programs = tuple(each for each in programs if not _is_group(each.node))
        self._subjects = Subjects(
            (each.node for each in self._programs),
            (each.topic for each in self._topics),
            self._groups.values(),
            findings,
        )

    def result(self) -> Contents:
        system = self._system
        usual = usual_values(system.arguments)
        arguments = () if self._note else system.arguments
        return Contents(
            name=system.name,
            description=system.description,
            version=__version__,
            note=self._note,
            arguments=tuple(self._argument(each, literal(usual[each.name])) for each in arguments),
            programs=tuple(map(self._program, self._programs)),
            topics=tuple(map(self._topic, self._topics)),
            groups=tuple(self._group(path, each) for path, each in self._groups.items()),
            findings=tuple(map(_finding, self._findings)),
            lookups=tuple(
                contents.Lookup(each.key, each.usual) for each in self._encoder.lookups.values()
            ),
        )

    def _argument(self, argument: Parameter, usual: Json) -> contents.Argument:
        default: Json = None
        if argument.default_from is not None:
            default = self._encoder.expression(argument.default_from)
        elif argument.default is not None:
            default = usual
        bounds = argument.interval
        return contents.Argument(
            argument.name,
            argument.type.value,
            default,
            usual,
            tuple(map(literal, argument.choices or ())),
            None
            if bounds is None
            else (
                literal(bounds.lower),
                literal(bounds.upper),
                bounds.lower_closed,
                bounds.upper_closed,
            ),
            "" if bounds is None else bounds.clause(),
            argument.unit or "",
            argument.description,
        )

    def _when(self, condition: Condition | None) -> Json:
        return None if condition is None else self._encoder.condition(condition)

    def _program(self, symbolic: SymbolicNode) -> contents.Program:
        flat = symbolic.node
        if not isinstance(flat, FlatNode):
            return self._process(flat, self._when(symbolic.when))
        instance, node_type = flat.instance, flat.type
        return contents.Program(
            kind="node" if flat.statement is None else "safety",
            name=instance.name,
            full_name=self._encoder.name(flat.full_name),
            path=flat.path,
            when=self._when(symbolic.when),
            type=instance.type_name,
            package=node_type.package if node_type is not None else "",
            executable=_executable(flat),
            host=flat.host,
            lifecycle=node_type is not None and node_type.lifecycle,
            description=_description(flat),
            parameters=tuple(
                (name, self._encoder.setting(value)) for name, value in flat.parameters
            ),
            ports=(
                *(self._port(flat, port) for port in flat.ports),
                *(self._untyped(flat, wiring) for wiring in flat.untyped),
            ),
            place=place_of(instance.name_span),
            declared=place_of(node_type.name_span) if node_type is not None else None,
            findings=self._subjects.of(flat),
        )

    def _process(self, flat: FlatProcess | FlatLaunch, when: Json) -> contents.Program:
        instance = flat.instance
        return contents.Program(
            kind="process",
            name=instance.name,
            full_name=flat.full_name,
            path=flat.path,
            when=when,
            type=self._encoder.text(as_written(_program_of(flat))),
            package="",
            executable="",
            host=flat.host,
            lifecycle=False,
            description=instance.description,
            parameters=(),
            ports=(),
            place=place_of(instance.name_span),
            declared=None,
            findings=self._subjects.of(flat),
        )

    def _port(self, node: FlatNode, flat: FlatPort) -> contents.Port:
        port, end = flat.port, End(node, flat)
        channel = CHANNEL[port.kind]
        return contents.Port(
            name=port.name if flat.entry is None else f"{port.name} ({flat.entry})",
            kind=port.kind.word,
            channel=channel,
            feeds=port.kind in SOURCES,
            directed=True,
            to=self._encoder.name(flat.topic),
            type=port.type.short,
            qos=_qos(policies(end.qos)) if channel == "topic" else "",
            assumed=channel == "topic" and end.is_assumed,
            wired=end.wired,
            units=_units(port.units),
            description=port.description,
            place=place_of(end.span),
            findings=self._subjects.of(node, flat),
        )

    def _untyped(self, node: FlatNode, untyped: UntypedWiring) -> contents.Port:
        wiring = untyped.wiring
        return contents.Port(
            name=wiring.port,
            kind="parameter",
            channel="topic",
            feeds=True,
            directed=False,
            to=self._encoder.name(untyped.topic),
            type="",
            qos="",
            assumed=False,
            wired=True,
            units=(),
            description="No port of the node says what is read or written there",
            place=place_of(wiring.span),
            findings=self._subjects.of(node, untyped),
        )

    def _topic(self, symbolic: SymbolicTopic) -> contents.Topic:
        topic = symbolic.topic
        declared = topic.declaration
        return contents.Topic(
            name=self._encoder.name(topic.name),
            path=topic.path,
            when=self._when(symbolic.when),
            type=declared.type.short if declared.type is not None else "",
            qos=""
            if declared.qos is None
            else ", ".join(words(each, v) for each, v in pinned_policies(declared.qos).items()),
            external=declared.external,
            units=_units(declared.units),
            description=declared.description,
            place=place_of(declared.name_span),
            findings=self._subjects.of(topic),
        )

    def _group(self, path: tuple[str, ...], group: Subsystem) -> contents.Group:
        used = group.system.description if group.system is not None else ""
        return contents.Group(
            path,
            group.system_name or "",
            group.description or used,
            place_of(group.name_span),
            self._subjects.of(group),
        )


def _symbolic(system: System) -> SymbolicSystem | None:
    """Return a system in terms of its arguments; ``None`` if it has none, or faults in them."""
    if not system.is_computed:
        return None
    try:
        return SymbolicSystem(system)
    except (CannotEvaluate, TooManyCombinations):  # which the check reports
        return None


def _program_of(flat: FlatProcess | FlatLaunch) -> str:
    return flat.launch.path if isinstance(flat, FlatLaunch) else flat.instance.program.text


def _executable(node: FlatNode) -> str:
    if node.type is None or node.instance.inside is not None:
        return ""
    return node.type.executable_name


def _description(node: FlatNode) -> str:
    instance = node.instance
    found = instance.description or (node.type.description if node.type is not None else "")
    if instance.inside is None:
        return found
    return f"In the process of {instance.inside.process}{f': {found}' if found else ''}"


def _is_group(program: FlatProgram) -> bool:
    """Return whether it is a launch file whose nodes the system describes: these are shown."""
    return isinstance(program, FlatLaunch) and program.launch.is_described


def _groups(
    part: System | Subsystem, path: tuple[str, ...], open_systems: tuple[System, ...]
) -> Iterator[tuple[tuple[str, ...], Subsystem]]:
    """Yield every subsystem by its path, those of used systems, too."""
    for member in part.members:
        if isinstance(member, Subsystem) and (member.launch is None or member.members):
            inside = (*path, member.name)
            yield inside, member
            yield from _groups(member, inside, open_systems)
            used = member.system
            if used is not None and not any(used is one for one in open_systems):
                yield from _groups(used, inside, (*open_systems, used))


_SHOWN: tuple[Policy, ...] = ("reliability", "durability", "depth")
_SHOWN_IF_STATED: tuple[Policy, ...] = ("deadline", "lifespan", "lease")


def _qos(found: Policies) -> str:
    """Return policies in the words of the languages, without those that say nothing."""
    shown: list[tuple[Policy, PolicyValue]] = [(each, getattr(found, each)) for each in _SHOWN]
    if found.liveliness != "automatic":
        shown.append(("liveliness", found.liveliness))
    stated = ((each, getattr(found, each)) for each in _SHOWN_IF_STATED)
    shown += [pair for pair in stated if pair[1] is not None]
    return ", ".join(
        "system_default" if policy == "depth" and value is None else words(policy, value)
        for policy, value in shown
    )


def _units(units: Sequence[FieldUnit]) -> tuple[str, ...]:
    return tuple(
        f"{each.path} [{each.unit}]{' wrapping' if each.wrapping else ''}" for each in units
    )


def _finding(found: Diagnostic) -> contents.Finding:
    others: Iterator[tuple[Place, str]] = (
        (place_of(each.span), each.message) for each in found.related
    )
    return contents.Finding(
        found.code.name,
        found.code.slug,
        found.severity.value,
        found.message,
        found.hint,
        place_of(found.span),
        tuple(others),
        tuple((name, literal(value)) for name, value in found.where),
    )
