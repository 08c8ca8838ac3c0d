"""The names that fit: a row for each attribute of the grammars that takes one."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from deros.interfaces.files import entries
from deros.interfaces.types import InterfaceKind
from deros.lsp.completion.fields import rules_of
from deros.lsp.completion.offers import Kind, Offer, Place
from deros.metamodels.imports import library_files
from deros.models.node import KINDS_BY_WORD, NodeType, ParameterType, PortKind
from deros.models.system import NodeInstance, Subsystem, System
from deros.rules.functions.functions import WRITTEN, Argument
from deros.systems.flat import is_topic_parameter
from deros.words.words import WordKind

Offered = Callable[[Place], Iterable[Offer]]


def _system(place: Place) -> System | None:
    model = place.analysis.file.model
    return model if isinstance(model, System) else None


def node_types(place: Place) -> Iterator[Offer]:
    """Yield the node types that the imports of a system define."""
    system = _system(place)
    for name, each in (system.node_types if system is not None else {}).items():
        yield Offer(name, Kind.Class, each.package, each.description, 0)


def systems(place: Place) -> Iterator[Offer]:
    """Yield the systems that may be named: imported ones or, in rules, those of the used file."""
    system = _system(place)
    found = dict(system.systems) if system is not None else {}
    for file in place.analysis.workspace.repository.files:
        if isinstance(file.model, System) and system is None:
            found.setdefault(file.model.name, file.model)
    for name, each in found.items():
        yield Offer(name, Kind.Module, "system", each.description, 0)


def topics(place: Place) -> Iterator[Offer]:
    """Yield the topics of the system, or of those that rules use."""
    for each in place.analysis.topics or ():
        kind = each.type
        text = each.declarations[0].declaration.description if each.declarations else ""
        yield Offer(each.name, Kind.Reference, kind.short if kind is not None else "", text, 0)


def actions(place: Place) -> Iterator[Offer]:
    """Yield the declared actions, and the one that is built in."""
    found = rules_of(place.analysis)
    for each in found[0].actions if found is not None else ():
        arguments = ", ".join(map(str, each.parameters))
        text = f"({arguments})" if arguments else ""
        yield Offer(each.name.text, Kind.Function, f"action{text}", each.description, 0)
    if place.slot.rule == "ActionCall":
        yield Offer("log_state", Kind.Function, "writes a text to the log")


def names_of_terms(place: Place) -> Iterator[Offer]:
    """Yield what a term may begin with: inputs, constants, entities, actions and conversions.

    In the parentheses of a function that is held against a zone, these are the zones.
    """
    found = rules_of(place.analysis)
    if found is None:
        return
    model = found[0]
    row = WRITTEN.get(place.slot.read("Call", "function"))
    if row is not None and row.of_zone:
        yield from (Offer(z.name.text, Kind.Constant, "zone", z.description) for z in model.zones)
        return
    for word in place.analysis.index:
        if word.declares and word.kind in (WordKind.INPUT, WordKind.CONSTANT):
            unit = f" in {word.unit}" if word.unit else ""
            kind = Kind.Variable if word.kind is WordKind.INPUT else Kind.Constant
            detail = f"{word.type}{unit}" or word.kind.value
            yield Offer(word.name, kind, detail, word.description, 0)
    entity = place.slot.read("Entity", "name")
    for each in model.entities:
        yield Offer(each.name.text, Kind.Module, "entity", each.description)
        if each.name.text == entity:
            yield from (Offer(r.name.text, Kind.Event, "rule", r.description) for r in each.rules)
    yield from (Offer(each.name.text, Kind.Function, "action") for each in model.actions)
    for row in WRITTEN.values():
        if row.argument is Argument.CONSTANT:
            yield Offer(f"{row.name}()", Kind.Function, row.gives)


def _type_here(place: Place) -> NodeType | None:
    """Return the type of the node that a place is in."""
    system = _system(place)
    name = place.slot.read("NodeInstance", "type")
    return None if system is None else system.node_types.get(name)


def ports(place: Place) -> Iterator[Offer]:
    """Yield the ports of the node, and parameters that may hold the name of a topic."""
    kind = _type_here(place)
    if kind is None:
        return
    # A kind is read as one only where a port follows.
    words = (place.slot.read("Wiring", "kind"), place.slot.read("Wiring", "port"))
    wanted = next((KINDS_BY_WORD[word] for word in words if word in KINDS_BY_WORD), None)
    if wanted is None and place.slot.attribute != "port":
        return
    for port in kind.ports:
        if wanted is None or port.kind is wanted:
            detail = f"{port.kind.word} {port.type.short}"
            yield Offer(port.name, Kind.Interface, detail, port.description, 0)
    for parameter in kind.parameters:
        if wanted is None and is_topic_parameter(kind, parameter.name):
            yield Offer(parameter.name, Kind.Property, "parameter", parameter.description)


def parameters(place: Place) -> Iterator[Offer]:
    """Yield the parameters of the node; those that have to be given come first."""
    kind = _type_here(place)
    for each in kind.parameters if kind is not None else ():
        unit = f" in {each.unit}" if each.unit else ""
        rank = int(each.has_default)
        yield Offer(each.name, Kind.Property, f"{each.type.value}{unit}", each.description, rank)


def own_parameters(place: Place) -> Iterator[Offer]:
    """Yield the parameters of the node description itself."""
    model = place.analysis.file.model
    for each in model.parameters if isinstance(model, NodeType) else ():
        yield Offer(each.name, Kind.Property, each.type.value, each.description, 0)


def arguments(place: Place) -> Iterator[Offer]:
    """Yield the arguments of the system; in expressions they have a ``$``."""
    system = _system(place)
    sign = "" if place.slot.token == "ArgumentInCondition" else "$"
    for each in system.arguments if system is not None else ():
        yield Offer(f"{sign}{each.name}", Kind.Variable, each.type.value, each.description, 0)
    for made in system.made if system is not None and sign else ():
        yield Offer(f"{sign}{made.name}", Kind.File, "file that is made")


def passed(place: Place) -> Iterator[Offer]:
    """Yield the arguments of the system that a subsystem uses."""
    system = _system(place)
    used = None if system is None else system.systems.get(place.slot.read("Subsystem", "system"))
    for each in used.arguments if used is not None else ():
        yield Offer(each.name, Kind.Variable, each.type.value, each.description, 0)


def hosts(place: Place) -> Iterator[Offer]:
    """Yield the hosts of the system."""
    system = _system(place)
    for each in system.hosts if system is not None else ():
        yield Offer(each.name, Kind.Variable, each.address, each.description, 0)


def programs(place: Place) -> Iterator[Offer]:
    """Yield the nodes and processes of the system, by the names that are written."""
    system = _system(place)
    if system is not None:
        yield from _programs(system)


def _programs(group: System | Subsystem) -> Iterator[Offer]:
    for process in group.processes:
        yield Offer(process.name, Kind.Variable, "process", process.description)
    for member in group.members:
        if isinstance(member, NodeInstance):
            yield Offer(member.name, Kind.Variable, member.type_name, member.description, 0)
        else:
            yield from _programs(member)


_FOLDERS: dict[str, InterfaceKind] = {
    "ServicePort": "srv",
    "ClientPort": "srv",
    "ServiceCall": "srv",
    "ActionPort": "action",
}


def interface_types(place: Place) -> Iterator[Offer]:
    """Yield packages of interfaces or, behind one, its types of the kind that fits."""
    store = place.analysis.workspace.store
    folder = _FOLDERS.get(place.slot.rule, "msg")
    package = place.chain.partition(".")[0]
    if package:
        for name in sorted(store.names(package, folder)):
            yield Offer(name, Kind.Class, f"{package}/{folder}/{name}", rank=0)
        return
    for name in sorted(store.packages()):
        if store.names(name, folder):
            yield Offer(name, Kind.Module, "package")


def parameter_types(place: Place) -> Iterator[Offer]:
    """Yield the types of parameters."""
    del place
    return (Offer(each.value, Kind.TypeParameter, rank=0) for each in ParameterType)


def port_kinds(place: Place) -> Iterator[Offer]:
    """Yield the words for kinds of ports, for which the node has a port."""
    kind = _type_here(place)
    there = {port.kind for port in kind.ports} if kind is not None else set(PortKind)
    return (Offer(word, Kind.Keyword) for word, each in KINDS_BY_WORD.items() if each in there)


_SUFFIXES = {
    "Import": (".rnd", ".system"),
    "Use": (".system",),
    "SafetyInstance": (".deros",),
    "ParameterFile": (".yaml", ".yml"),
    "LaunchInstance": (".py", ".xml", ".yaml"),
    "Xacro": (".xacro", ".urdf"),
}


def files(place: Place) -> Iterator[Offer]:
    """Yield the files and folders beside the model that a path may lead to."""
    suffixes = _SUFFIXES.get(place.slot.rule)
    if suffixes is None:
        return
    folder = Path(place.analysis.file.path).parent / os.path.dirname(place.chain)  # noqa: PTH120
    own = Path(place.analysis.file.path).name
    if place.slot.rule == "Import" and not place.chain:
        yield from (Offer(each, Kind.File, "comes with deros") for each in library_files())
    for each in entries(folder):
        if each.is_folder and not each.name.startswith("."):
            yield Offer(f"{each.name}/", Kind.Folder)
        elif each.name.endswith(suffixes) and each.name != own:
            yield Offer(each.name, Kind.File, rank=0)


OFFERED: dict[tuple[str, str], Offered] = {
    ("NodeInstance", "type"): node_types,
    ("Subsystem", "system"): systems,
    ("Use", "system"): systems,
    ("Wiring", "port"): ports,
    ("Wiring", "kind"): port_kinds,
    ("Wiring", ""): ports,
    ("Wiring", "target"): topics,
    ("Remapping", "target"): topics,
    ("Setting", "name"): parameters,
    ("Passed", "name"): passed,
    ("OnHost", "host"): hosts,
    ("ActivatedBy", "manager"): programs,
    ("Into", "container"): programs,
    ("InsideProcess", "process"): programs,
    ("After", "awaited"): programs,
    ("ActionCall", "action"): actions,
    ("ResetBy", "action"): actions,
    ("GateLine", "action"): actions,
    ("NameTerm", "name"): names_of_terms,
    ("TopicTerm", "topic"): topics,
    ("GateSource", "topic"): topics,
    ("Gate", "target"): topics,
    ("Via", "parameter"): own_parameters,
    ("Frame", "switch"): own_parameters,
}
"""Rule and attribute of the grammar, and what gives the names for it."""

OF_TOKENS: dict[str, Offered] = {
    "InterfaceName": interface_types,
    "ParameterTypeName": parameter_types,
    "ArgumentUse": arguments,
    "ArgumentInCondition": arguments,
}
"""The same for tokens that mean the same wherever they stand."""
