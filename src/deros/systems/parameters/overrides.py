"""What the parameter files of a node set: read one after the other, as ROS 2 reads them.

ROS 2 keeps one list of keys for all files of a node, each where it was mentioned first. A node goes
through that list and takes what matches its full name; what comes later wins. So a file beats those
before it under the same key, but ``/**`` of a later file does not beat the node's own key of an
earlier one, if ``/**`` was there before that. Source: ``rcl_parse_yaml_file``,
``parameter_map_from`` of rclcpp, ``Node::get_parameters`` of rclpy (Jazzy).

Systems start nodes with their files first, and then what they set themselves, under the node's full
name. :attr:`FileParameters.beaten` is what does not get through for all that.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from deros.metamodels.parameter_files.reading import Entry, Overrides
from deros.models.parameter_files import Document, FileValue, Origin, ParameterFile
from deros.models.system import ParameterSetting, Wiring

Read = tuple[ParameterFile, Document]
"""A file with the statement that names it."""


@dataclass(frozen=True, slots=True)
class FileParameters:
    """The parameters of one node, as far as files set them.

    Attributes:
        settings: what the node gets from files, by the names of parameters.
        beaten: what the system sets itself and a file overrides all the same, with the value that
            wins.
    """

    settings: tuple[ParameterSetting, ...] = ()
    beaten: tuple[tuple[ParameterSetting, FileValue], ...] = ()


NOTHING = FileParameters()


ALL_NODES = "/**"
"""The key for every node."""


def matches(key: str, full_name: str) -> bool:
    """Return whether a key of a parameter file is for a node, by its full name."""
    return key == ALL_NODES or _pattern(key).fullmatch(full_name) is not None


def may_match(key: str, name: str) -> bool:
    """Return whether a key can be for a node of a name, whatever its namespace is."""
    return key.rpartition("/")[2] in (name, "*", "**")


@functools.cache
def _pattern(key: str) -> re.Pattern[str]:
    absolute = key if key.startswith("/") else f"/{key}"
    return re.compile(absolute.replace("/*", r"(?:/\w+)"), re.ASCII)


def documents(files: Iterable[ParameterFile]) -> list[Read]:
    """Return the files that can be read; what is wrong with the others is reported elsewhere."""
    loaded = ((each, each.load()) for each in files)
    return [(each, found) for each, found in loaded if isinstance(found, Document)]


def file_parameters(
    files: Sequence[ParameterFile], full_name: str, own: Sequence[ParameterSetting]
) -> FileParameters:
    """Return what files set for a node.

    Args:
        files: those of the node, in order.
        full_name: of the node.
        own: what the system sets itself.
    """
    read = documents(files)
    if not read:
        return NOTHING
    overrides: Overrides[ParameterFile] = Overrides()
    for statement, document in read:
        overrides.read(document.events, statement)
    own_key = overrides.slot(full_name)
    given = {each.name: each for each in own}
    found: dict[str, ParameterSetting] = {}
    beaten: dict[str, tuple[ParameterSetting, FileValue]] = {}
    for slot in overrides.slots:
        if not matches(slot.key, full_name):
            continue
        if slot is own_key:
            beaten.clear()
        for entry in slot.entries:
            own_value = given.get(entry.name)
            if own_value is None:
                found.pop(entry.name, None)
                found[entry.name] = _setting(entry.value(), Origin(entry.giver, slot.key))
            elif slot is not own_key or not _gives_way(entry, own_value):
                beaten[entry.name] = own_value, entry.value()
    return FileParameters(tuple(found.values()), tuple(beaten.values()))


def _gives_way(entry: Entry[ParameterFile], setting: ParameterSetting) -> bool:
    """Return whether a value under the node's own key is replaced by what the system sets.

    It is not where it is of another type: of several, ROS 2 takes a bool before a number, say.
    """
    value = setting.value
    kind = (True, type(value[0])) if isinstance(value, tuple) and value else (False, type(value))
    both = {**entry.values, kind: (value, setting.value_span)}
    return replace(entry, values=both).value().value_span == setting.value_span


def _setting(found: FileValue, origin: Origin) -> ParameterSetting:
    span = found.name_span
    value = () if found.value is None else found.value
    return ParameterSetting(found.name, value, span, span, found.value_span, origin=origin)


def wired_setting(name: str, wiring: Wiring, topic: str) -> ParameterSetting:
    """Return what a connection sets, of a port that takes its name from a parameter."""
    return ParameterSetting(name, topic, wiring.span, wiring.port_span, wiring.target_span)
