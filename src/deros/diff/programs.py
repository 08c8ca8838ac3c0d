"""Changes of what a system starts: nodes, processes and launch files."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from deros.diagnostics import Span
from deros.diff.changes import Aspect, Change, PartKind, breaking, compare, compatible
from deros.diff.expressions import ALWAYS
from deros.diff.symbolic import Version, Way, common, condition_list, in_ways, when_of
from deros.diff.texts import joined
from deros.interfaces.durations import duration_text
from deros.models.arguments import LaunchArgument
from deros.models.launch_files import XacroFile
from deros.models.parameter_files import ParameterFile
from deros.models.programs import Respawn, Word
from deros.systems.arguments.symbolic import SymbolicNode
from deros.systems.flat import FlatLaunch, FlatNode, FlatProcess

Fields = Iterator[tuple[str, str | None]]
"""What a program has: the name of each setting, and its value as text."""


@dataclass(frozen=True, slots=True)
class Program:
    """One program of a version, in all ways in which it may be there.

    Attributes:
        word: ``node``, ``process`` or ``launch file``.
        name: by which it is known at run time.
        place: the subsystems that hold it, and its name as written.
        span: of that name.
        settings: by name; of each the values that it has, with their conditions.
        when: the conditions that hold in all ways.
        ways: the conditions of each way.
    """

    word: str
    name: str
    place: tuple[str, ...]
    span: Span
    settings: dict[str, tuple[str, ...]]
    when: frozenset[str]
    ways: frozenset[frozenset[str]]


def programs_of(version: Version) -> list[Program]:
    """Return the programs of a version, in the order written."""
    groups: dict[tuple[str, str], list[SymbolicNode]] = {}
    for each in version.programs:
        word = _WORDS[type(each.node)]
        groups.setdefault((word, version.name(each.node.full_name)), []).append(each)
    return [_program(version, *key, group) for key, group in groups.items()]


_WORDS = {FlatNode: "node", FlatProcess: "process", FlatLaunch: "launch file"}


def _program(version: Version, word: str, name: str, group: Sequence[SymbolicNode]) -> Program:
    ways = [when_of(each.when) for each in group]
    settings: dict[str, list[Way]] = {}
    for each, when in zip(group, ways, strict=True):
        for setting, value in _fields(version, each.node):
            if value:
                settings.setdefault(setting, []).append(Way(value, when))
    first = group[0].node
    return Program(
        word,
        name,
        (*first.path, first.instance.name),
        first.instance.name_span,
        {setting: tuple(in_ways(found, ways)) for setting, found in settings.items()},
        common(ways),
        frozenset(ways),
    )


def _fields(version: Version, program: FlatNode | FlatProcess | FlatLaunch) -> Fields:
    match program:
        case FlatNode():
            yield from _node(version, program)
        case FlatProcess():
            yield from _process(version, program)
        case FlatLaunch():
            yield from _launch(version, program)
    yield "host", program.host
    yield from (
        (f"variable {each.name}", version.text(each.value.text)) for each in program.environment
    )
    yield "parameter files", joined(_file(version, each) for each in program.files)
    yield "description", program.instance.description


def _node(version: Version, node: FlatNode) -> Fields:
    instance = node.instance
    if node.type is not None:
        yield "type", f"{node.type.name} ({node.type.package}/{node.type.executable_name})"
    yield "plugin", None if instance.component is None else instance.component.text
    set_by_wiring = {each.port.via for each in node.ports if each.sets_parameter}
    made = {each.name: each.xacro for each in instance.parameters if each.xacro is not None}
    for name, value in node.parameters:
        if name in made:
            yield f"parameter {name}", _xacro(version, made[name])
        elif name not in set_by_wiring:
            yield f"parameter {name}", version.value(value)
    ports = {each.port.name for each in node.ports}
    yield from (
        (f"remap of {version.text(name)}", version.name(target))
        for name, target in node.remappings
        if name not in ports
    )
    yield "safety rules", None if node.statement is None else node.statement.path
    yield "container", None if node.container is None else version.name(node.container)
    yield "inside", None if node.process is None else version.name(node.process)
    yield "log level", instance.log_level
    yield "activated by", instance.activated_by
    if node.autostart is not None:
        optional = ", optional" * node.autostart.is_optional
        yield "autostart", f"within {node.autostart.timeout_s:g} sec{optional}"
    yield "intra process", "yes" if instance.intra_process is not None else None
    yield from _started(version, instance.arguments, instance.prefix)
    yield from _starting(version, node)
    yield "respawn", _respawn(instance.respawn)


def _process(version: Version, process: FlatProcess) -> Fields:
    instance = process.instance
    yield "program", version.text(instance.program.text)
    yield "folder", None if instance.folder is None else version.text(instance.folder.text)
    yield from _started(version, instance.arguments, instance.prefix)
    yield from _starting(version, process)
    yield "respawn", _respawn(instance.respawn)


def _launch(version: Version, launch: FlatLaunch) -> Fields:
    yield "file", version.text(launch.launch.path)
    yield "namespace", version.name(launch.namespace)
    yield from (
        (f"argument {each.name}", version.text(each.value)) for each in launch.launch.arguments
    )
    yield from ((f"parameter {each.name}", version.value(each.value)) for each in launch.parameters)
    yield from (
        (f"remap of {version.text(each.name)}", version.text(each.target))
        for each in launch.remappings
    )


def _file(version: Version, file: ParameterFile) -> str:
    text = version.text(file.path)
    if file.given is not None:
        text += f" ({joined(_given(version, each) for each in file.given)})"
    if file.plain is not None:
        text += f" plain as {file.plain.parameter}" if file.plain.parameter else " plain"
    if file.below is not None and file.below.namespace:
        text += f" below {version.text(file.below.namespace)}"
    return text


def _started(version: Version, words: Iterable[Word], prefix: Word | None) -> Fields:
    yield "words", " ".join(version.value(each.text) for each in words)
    yield "prefix", None if prefix is None else version.text(prefix.text)


def _starting(version: Version, program: FlatNode | FlatProcess) -> Fields:
    starting = program.instance.starting
    yield "delay", None if starting.delay is None else duration_text(starting.delay.ns)
    yield "after exit of", starting.awaited
    if starting.ready is not None:
        ready = starting.ready
        name = ready.name if ready.names_program else version.name(program.awaited_end)
        yield f"after {ready.kind}", f"{name}, within {ready.timeout_s:g} sec"
    yield "exit stops all", "yes" if starting.stops_all is not None else None


def _respawn(respawn: Respawn | None) -> str | None:
    if respawn is None:
        return None
    limit = "" if respawn.max_restarts is None else f", at most {respawn.max_restarts} times"
    return f"after {duration_text(respawn.delay_ns)}{limit}"


def _xacro(version: Version, file: XacroFile) -> str:
    given = [version.text(file.path), *(_given(version, each) for each in file.arguments)]
    return f"xacro({joined(given)})"


def _given(version: Version, argument: LaunchArgument) -> str:
    return f"{argument.name} = {version.value(argument.value)}"


# Comparison -------------------------------------------------------------------------------------


def _is_there_less(old: frozenset[str], new: frozenset[str]) -> str:
    return "" if new <= old else "it is not there where it was"


def _condition_text(conditions: frozenset[str]) -> str:
    return condition_list(conditions) or ALWAYS


def _setting(name: str) -> Aspect[Program]:
    return Aspect(name, lambda p: p.settings.get(name), compatible, "; ".join)


def _aspects_of(old: Program, new: Program) -> Iterator[Aspect[Program]]:
    """Yield the settings that either has; if those are the same, the ways in which it is there."""
    names = dict.fromkeys((*old.settings, *new.settings))
    yield from map(_setting, names)
    if old.settings == new.settings and old.when == new.when:
        yield Aspect(
            "conditions",
            lambda p: p.ways,
            breaking("it may not be there where it was"),
            lambda ways: " or ".join(sorted(map(_condition_text, ways))),
        )


def _kind(word: str) -> PartKind[Program]:
    return PartKind(
        word,
        lambda p: p.name,
        lambda p: p.span,
        (
            Aspect("name", lambda p: p.name, breaking("those who find it by its name")),
            Aspect("condition", lambda p: p.when, _is_there_less, _condition_text),
        ),
        lambda p: "; ".join(next((p.settings[each] for each in _SAID if each in p.settings), ())),
        removed=lambda _: "those who find it by its name",
        keys=(lambda p: p.name, lambda p: p.place),
        aspects_of=lambda old, new: tuple(_aspects_of(old, new)),
    )


_SAID = ("type", "program", "file")
"""The settings that say what a program is."""


def compare_programs(old: Version, new: Version) -> Iterator[Change]:
    """Yield the changes of what is started."""
    before, after = programs_of(old), programs_of(new)
    for word in _WORDS.values():
        yield from compare(
            _kind(word),
            [each for each in before if each.word == word],
            [each for each in after if each.word == word],
        )
