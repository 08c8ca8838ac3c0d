"""Policies of SROS2: their form, what they allow, and what a running graph shows of the same."""

from __future__ import annotations

import contextlib
import fnmatch
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as Xml

from deros.generators.builtin import rossystem_sros2
from deros.models.system import System
from tests.support.ros import Peer
from tests.support.systems import CONTEXT

Allowed = Mapping[str, frozenset[tuple[str, str]]]
"""By the full name of a node: pairs of a right and a name, with actions as their parts."""

_CHILDREN = {
    "policy": {"enclaves"},
    "enclaves": {"enclave"},
    "enclave": {"profiles"},
    "profiles": {"profile"},
    "topics": {"topic"},
    "services": {"service"},
    "actions": {"action"},
}
_ATTRIBUTES = {
    "topics": {"publish", "subscribe"},
    "services": {"reply", "request"},
    "actions": {"call", "execute"},
}
_REQUIRED = {"policy": {"version"}, "enclave": {"path"}, "profile": {"ns", "node"}}

_ACTION_SERVICES = ("send_goal", "cancel_goal", "get_result")
_ACTION_TOPICS = ("feedback", "status")
_PARTS = {"execute": ("reply", "publish"), "call": ("request", "subscribe")}


def policy_text(model: System, **options: str) -> str:
    """Return the policy that is generated for a system."""
    (file,) = rossystem_sros2(model, CONTEXT, options).values()
    return file.text


def faults_of_form(text: str) -> Iterator[str]:
    """Yield in what a text differs from the schema of sros2 (``policy.xsd``, version 0.2.0)."""
    root = Xml.fromstring(text)
    if root.tag != "policy" or root.get("version") != "0.2.0":
        yield "no policy of version 0.2.0"
    for element in root.iter():
        yield from _faults_of(element)


def _faults_of(element: Xml.Element) -> Iterator[str]:
    children = [child.tag for child in element]
    if element.tag in ("topic", "service", "action"):
        if children or element.attrib or not element.text:
            yield f"{element.tag} has to be a name"
        return
    if element.tag == "profile":
        if not set(children) <= set(_ATTRIBUTES):
            yield f"unknown permissions in {children}"
    elif not children or set(children) != _CHILDREN.get(element.tag):
        yield f"{element.tag} has {children}"
    if element.tag in _ATTRIBUTES:
        if not element.attrib or not set(element.attrib) <= _ATTRIBUTES[element.tag]:
            yield f"{element.tag} has attributes {element.attrib}"
        if not set(element.attrib.values()) <= {"ALLOW", "DENY"}:
            yield f"{element.tag} neither allows nor denies: {element.attrib}"
    elif set(element.attrib) != _REQUIRED.get(element.tag, set()):
        yield f"{element.tag} has attributes {element.attrib}"


def allowed_by(text: str) -> dict[str, frozenset[tuple[str, str]]]:
    """Return what each node may do, with the parts of actions as sros2 expands them."""
    found = {}
    for profile in Xml.fromstring(text).iter("profile"):
        namespace = profile.attrib["ns"].rstrip("/")
        found[f"{namespace}/{profile.attrib['node']}"] = frozenset(_rights(profile))
    return found


def _rights(profile: Xml.Element) -> Iterator[tuple[str, str]]:
    for listed in profile:
        assert set(listed.attrib.values()) == {"ALLOW"}
        for right in listed.attrib:
            for entry in listed:
                name = entry.text or ""
                if listed.tag != "actions":
                    yield right, name
                    continue
                of_service, of_topic = _PARTS[right]
                for part in _ACTION_SERVICES:
                    yield of_service, f"{name}/_action/{part}"
                for part in _ACTION_TOPICS:
                    yield of_topic, f"{name}/_action/{part}"


def enclaves_of(text: str) -> dict[str, list[str]]:
    """Return the names of the nodes by the paths of their enclaves."""
    return {
        enclave.attrib["path"]: [each.attrib["node"] for each in enclave.iter("profile")]
        for enclave in Xml.fromstring(text).iter("enclave")
    }


# What a graph shows -------------------------------------------------------------------------------


def shown_by(peer: Peer) -> dict[str, frozenset[tuple[str, str]]]:
    """Return what each node of the graph other than the peer does now."""
    node = peer.node
    found = {}
    for name, namespace in node.get_node_names_and_namespaces():
        if name != node.get_name():
            ends = frozenset(_ends(node, name, namespace))
            found[f"{namespace.rstrip('/')}/{name}"] = ends
    return found


def _ends(node: Any, name: str, namespace: str) -> Iterator[tuple[str, str]]:
    from rclpy.node import NodeNameNonExistentError

    queries = {
        "publish": node.get_publisher_names_and_types_by_node,
        "subscribe": node.get_subscriber_names_and_types_by_node,
        "reply": node.get_service_names_and_types_by_node,
        "request": node.get_client_names_and_types_by_node,
    }
    with contextlib.suppress(NodeNameNonExistentError):  # it has left the graph meanwhile
        for right, query in queries.items():
            yield from ((right, found) for found, _ in query(name, namespace))


@dataclass(frozen=True)
class Difference:
    """What only one of the two has, by the full name of a node; ``None``: the node itself."""

    not_allowed: Mapping[str, frozenset[tuple[str, str]] | None]
    not_shown: Mapping[str, frozenset[tuple[str, str]] | None]


def difference(allowed: Allowed, shown: Allowed) -> Difference:
    """Compare a policy with a graph; names in the policy may be patterns, as for DDS."""
    too_little: dict[str, frozenset[tuple[str, str]] | None] = {}
    too_much: dict[str, frozenset[tuple[str, str]] | None] = dict.fromkeys(allowed)
    for node, ends in shown.items():
        entry = next((each for each in allowed if fnmatch.fnmatchcase(node, each)), None)
        if entry is None:
            too_little[node] = None
            continue
        del too_much[entry]
        permissions = allowed[entry]
        missing = frozenset(end for end in ends if not any(_covers(p, end) for p in permissions))
        unused = frozenset(p for p in permissions if not any(_covers(p, end) for end in ends))
        if missing:
            too_little[node] = missing
        if unused:
            too_much[node] = unused
    return Difference(too_little, too_much)


def _covers(permission: tuple[str, str], end: tuple[str, str]) -> bool:
    return permission[0] == end[0] and fnmatch.fnmatchcase(end[1], permission[1])


ONLY_CPP = frozenset({("subscribe", "/parameter_events")})
"""What a node in C++ needs, and one in Python has no use for; no description says which it is."""


def await_policy(text: str, peer: Peer, *exact: str) -> None:
    """Wait until a graph shows what a policy allows, no more and no less.

    Args:
        text: of the policy.
        peer: in the graph.
        exact: the nodes whose language the model knows; all others are in Python.

    Raises:
        AssertionError: if they differ after all; it says in what.
    """
    allowed = {
        node: rights if node in exact else rights - (ONLY_CPP if node != BRING_UP else set())
        for node, rights in allowed_by(text).items()
    }
    equal = Difference({}, {})
    try:
        peer.until(lambda: difference(allowed, shown_by(peer)) == equal)
    except AssertionError:
        raise AssertionError(difference(allowed, shown_by(peer))) from None


BRING_UP = "/_bring_up_*"


def schema_of(folder: Path) -> Path | None:
    """Return the schema of an installed sros2, made to need nothing from the network.

    Args:
        folder: where it is put.
    """
    from importlib.util import find_spec

    found = find_spec("sros2")
    if found is None or found.origin is None:
        return None
    schema = Path(found.origin).parent / "policy/schemas/policy.xsd"
    return local_schema(schema.read_text(encoding="utf-8"), folder)


def local_schema(text: str, folder: Path) -> Path:
    """Write a schema whose import of ``xml:base`` is a file beside it."""
    (folder / "xml.xsd").write_text(
        '<xs:schema targetNamespace="http://www.w3.org/XML/1998/namespace"'
        ' xmlns:xs="http://www.w3.org/2001/XMLSchema">'
        '<xs:attribute name="base" type="xs:anyURI"/></xs:schema>',
        encoding="utf-8",
    )
    path = folder / "policy.xsd"
    imported = "http://www.w3.org/2001/03/xml.xsd"
    assert imported in text
    path.write_text(text.replace(imported, "xml.xsd"), encoding="utf-8")
    return path
