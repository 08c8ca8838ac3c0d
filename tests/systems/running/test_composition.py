"""Containers at run time: which node is loaded into which, and under which names."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.systems.arguments.resolve import resolve
from deros.systems.flatten import flatten
from tests.support.systems import load_text

PART = 'node part : parts plugin "parts::Part" publishes topic out : std_msgs.Bool'


def flat(folder: Path, body: str, **values: bool) -> dict[str, str | None]:
    """Return the nodes of a system by full name, each with the container that it is loaded into."""
    system = load_text(folder, f'system S imports import "*.rnd" {body}', part=PART)
    nodes = flatten(resolve(system, values)).nodes
    return {node.full_name: node.container for node in nodes}


def test_namespace_of_a_container_is_its_own(tmp_path: Path) -> None:
    """What is in it is called as it would be beside it, and so are its topics."""
    body = (
        "subsystem robot namespace /robot { container main namespace boxes { "
        "node a : part node b : part namespace deep } node c : part }"
    )
    system = load_text(tmp_path, f'system S imports import "*.rnd" {body}', part=PART)
    found = flatten(system).nodes
    assert {node.full_name: node.container for node in found} == {
        "/robot/boxes/main": None,
        "/robot/a": "/robot/boxes/main",
        "/robot/deep/b": "/robot/boxes/main",
        "/robot/c": None,
    }
    topics = {node.full_name: [port.topic for port in node.ports] for node in found}
    assert topics["/robot/a"] == ["/robot/out"]
    assert topics["/robot/deep/b"] == ["/robot/deep/out"]


@pytest.mark.parametrize(
    ("name", "container"),
    [
        ("inner", "/s/x/inner"),
        ("main", "/boxes/main"),
        ("/boxes/main", "/boxes/main"),
        ("boxes/main", "/boxes/main"),
        ("x/inner", "/s/x/inner"),
        ("/anywhere/else", "/anywhere/else"),
        ("beside", None),
    ],
)
def test_into_names_a_container_around_the_node(
    tmp_path: Path, name: str, container: str | None
) -> None:
    """A plain name is looked for in the subsystem and around it, whatever the namespaces are."""
    body = (
        "container main namespace /boxes { } subsystem t { container beside namespace /t { } }"
        " subsystem s namespace /s { container inner namespace x { } "
        f"node n : part into {name} }}"
    )
    assert flat(tmp_path, body)["/s/n"] == container


def test_used_system_has_containers_of_its_own(tmp_path: Path) -> None:
    """Each instance has its own, and none of them has that of the other or of its user."""
    (tmp_path / "arm.system").write_text(
        'system Arm imports import "part.rnd" container main { node a : part } '
        "node b : part into main"
    )
    found = flat(
        tmp_path,
        'import "arm.system" container main { } '
        "subsystem left : Arm namespace /left subsystem right : Arm namespace /right",
    )
    assert found == {
        "/main": None,
        "/left/main": None,
        "/left/a": "/left/main",
        "/left/b": "/left/main",
        "/right/main": None,
        "/right/a": "/right/main",
        "/right/b": "/right/main",
    }


def test_node_is_a_process_where_the_condition_of_into_fails(tmp_path: Path) -> None:
    """With its container, everything in its braces is left out."""
    body = (
        "argument composed : bool = true container main when composed { node a : part } "
        "node b : part into main when composed"
    )
    assert flat(tmp_path, body) == {"/main": None, "/a": "/main", "/b": "/main"}
    assert flat(tmp_path, body, composed=False) == {"/b": None}
