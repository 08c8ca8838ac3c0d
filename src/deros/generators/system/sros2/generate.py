"""The policy: an enclave for each node, with the permissions that the wiring implies."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

from deros import codes
from deros.diagnostics import Diagnostic, report
from deros.generators.api.protocol import (
    Context,
    File,
    Files,
    GenerationError,
    OptionError,
    Options,
)
from deros.generators.system.sros2.permissions import (
    RIGHTS,
    Permission,
    Right,
    permissions_of,
    permissions_of_bring_up,
)
from deros.generators.system.unsupported import composed_node
from deros.generators.system.view import system_view
from deros.generators.text.templates import environment
from deros.models.arguments import Argument, Expression, open_in
from deros.models.node import ParameterType
from deros.models.system import System
from deros.names.names import check_namespace
from deros.systems.arguments.symbolic import SymbolicNode, SymbolicSystem, as_written
from deros.systems.arguments.variants import Variants
from deros.systems.flat import FlatNode, FlatSystem
from deros.systems.flatten import flatten

OVERRIDE = "ROS_SECURITY_ENCLAVE_OVERRIDE"
"""The variable by which rcl gives a process another enclave than its command line does."""

BRING_UP = "/_bring_up_*"
"""The full name of the node that brings managed nodes up; it ends with the number of a process."""


class NodeName(NamedTuple):
    """A node of the graph: the enclave of its process, its namespace and its own name."""

    enclave: str
    namespace: str
    name: str


@dataclass(slots=True)
class Policy:
    """What each node may do, by right."""

    profiles: dict[NodeName, dict[Right, set[str]]] = field(default_factory=dict)

    def allow(self, node: NodeName, permissions: Iterator[Permission]) -> None:
        """Allow a node more."""
        rights = self.profiles.setdefault(node, defaultdict(set))
        for right, name in permissions:
            rights[right].add(name)

    @property
    def enclaves(self) -> list[tuple[str, list[tuple[NodeName, list[tuple[Right, list[str]]]]]]]:
        """The enclaves with their profiles and the permissions of these, all in order."""
        found: dict[str, list[tuple[NodeName, list[tuple[Right, list[str]]]]]] = defaultdict(list)
        for node, rights in sorted(self.profiles.items(), key=lambda each: each[0]):
            listed = [(right, sorted(rights[right])) for right in RIGHTS if right in rights]
            found[node.enclave].append((node, listed))
        return sorted(found.items())


def generate(model: System, context: Context, options: Options) -> Files:  # noqa: ARG001
    """Return the one file of the policy.

    Raises:
        GenerationError: if it depends on what is known only when the system is started who may do
            what, or a topic is connected to a parameter, so that its direction is unknown.
        OptionError: if the option ``enclave`` is not an absolute name.
    """
    enclave = options.get("enclave")
    if enclave is not None:
        why = check_namespace(enclave)
        if why is None and not enclave.startswith("/"):
            why = "does not start with '/'"
        if why is not None:
            raise OptionError(f"enclave {enclave!r} {why}")
    view = system_view(model)
    policy = policy_of(model, enclave)
    made = environment("deros.generators.system.sros2")
    text = made.get_template("policy.xml.j2").render(system=view, enclaves=policy.enclaves)
    return {f"{view.stem}.policy.xml": File(text)}


def policy_of(model: System, enclave: str | None = None) -> Policy:
    """Return what each node may do, in any start of the system.

    Args:
        model: of which all node types are known.
        enclave: of all nodes; by default each has one of its own.

    Raises:
        GenerationError: as :func:`generate` does.
    """
    variants = Variants(model) if model.is_computed else None
    if variants is None:
        flats = [flatten(model)]
    else:
        flats = [variants.flat(number) for number in variants.numbers]
    faults = [*_undescribed(flats), *_untyped(flats), *_composed(flats)]
    if variants is not None:
        too_many = variants.gap is not None
        faults += [_too_many(model)] if too_many else _unknown_before_start(model)
    if not any(flat.nodes for flat in flats):
        faults.append(_without_nodes(model))
    if faults:
        raise GenerationError(dict.fromkeys(faults))
    policy = Policy()
    for flat in flats:
        nodes = {node.full_name: node for node in flat.nodes}
        for node in flat.nodes:
            of_process = _enclave(nodes.get(node.process, node) if node.process else node)
            name = NodeName(enclave or of_process, node.namespace, node.instance.name)
            policy.allow(name, permissions_of(node))
        managed = tuple(node.full_name for node in flat.nodes if node.autostart is not None)
        if managed:
            # Whatever starts the system does that, and so has the enclave of no node.
            name = NodeName(enclave or "/", "/", BRING_UP.removeprefix("/"))
            policy.allow(name, permissions_of_bring_up(BRING_UP, managed))
    return policy


def _enclave(node: FlatNode) -> str:
    stated = {variable.name: variable.value.text for variable in node.environment}
    # A process that is not a node is given no enclave: rcl takes the outermost one.
    return stated.get(OVERRIDE, node.full_name if node.process is None else "/")


# What cannot be said in a policy ------------------------------------------------------------------


def _untyped(flats: list[FlatSystem]) -> Iterator[Diagnostic]:
    for flat in flats:
        for node in flat.nodes:
            for each in node.untyped:
                yield report(
                    codes.UNSUPPORTED_BY_TARGET,
                    f"'{each.topic}' is connected to parameter '{each.wiring.port}' of"
                    f" '{node.instance.name}', and no port says whether it is published there",
                    each.wiring.span,
                    f"declare the port in the node description, with 'via {each.wiring.port}'",
                )


def _composed(flats: list[FlatSystem]) -> Iterator[Diagnostic]:
    for flat in flats:
        for node in flat.nodes:
            if node.container is not None:
                name = node.instance.name
                yield composed_node(node, f"'{name}' runs in the enclave of another process")


def _undescribed(flats: Iterable[FlatSystem]) -> Iterator[Diagnostic]:
    """Yield the launch files that start nodes for which nothing would be allowed."""
    for flat in flats:
        for each in flat.launches:
            if not each.launch.is_described:
                yield report(
                    codes.UNSUPPORTED_BY_TARGET,
                    f"a policy names all that is allowed, and what '{each.launch.path}' starts is"
                    " not known",
                    each.launch.path_span,
                    "describe its nodes: 'provides { node NAME : TYPE … }'",
                )


def _unknown_before_start(model: System) -> Iterator[Diagnostic]:
    """Yield names that are made of any text, and what depends on the machine."""
    symbolic = SymbolicSystem(model)
    enumerable = {
        each.name
        for each in model.arguments
        if each.choices is not None or each.type is ParameterType.BOOL
    }
    for each in symbolic.nodes:
        if not isinstance(each.node, FlatNode):
            continue
        for what, text in _names(each):
            for piece in symbolic.pieces(as_written(text)):
                if not isinstance(piece, str):
                    yield from _faults(what, piece, enumerable)


def _names(each: SymbolicNode) -> Iterator[tuple[str, str]]:
    node = each.node
    assert isinstance(node, FlatNode)
    yield f"the namespace of '{node.instance.name}'", node.namespace
    for port in node.ports:
        yield f"the name of '{port.port.name}' of '{node.instance.name}'", port.topic
    for variable in node.environment:
        if variable.name == OVERRIDE:
            yield f"the enclave of '{node.instance.name}'", variable.value.text


def _faults(what: str, expression: Expression, enumerable: set[str]) -> Iterator[Diagnostic]:
    for use in open_in(expression):
        if not isinstance(use, Argument):
            yield report(
                codes.UNSUPPORTED_BY_TARGET,
                f"a policy names all that is allowed, and {what} is looked up where the system is"
                " started",
                use.span,
                "make it an argument with 'one_of'",
            )
        elif use.name not in enumerable:
            yield report(
                codes.UNSUPPORTED_BY_TARGET,
                f"a policy names all that is allowed, and {what} depends on argument"
                f" '{use.name}', which may have any value",
                use.span,
                f"declare the values that '{use.name}' may have, with 'one_of'",
            )


def _too_many(model: System) -> Diagnostic:
    return report(
        codes.UNSUPPORTED_BY_TARGET,
        "the arguments of the system have too many combinations to allow for each of them",
        model.name_span,
        "split the system, and start its parts with a policy for each",
    )


def _without_nodes(model: System) -> Diagnostic:
    return report(
        codes.UNSUPPORTED_BY_TARGET,
        "a policy has at least one enclave, and this system has no node",
        model.name_span,
        "add a node",
    )
