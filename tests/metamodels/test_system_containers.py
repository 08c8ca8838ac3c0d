"""Containers, as they are written."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros import codes
from deros.metamodels.load import Repository
from deros.models.common import Name
from deros.models.system import NodeInstance, System
from tests.support.systems import load_text

PART = 'node part : parts plugin "parts::Part"'


def members(folder: Path, body: str) -> dict[str, NodeInstance]:
    """Return the nodes of a system by their names."""
    system = load_text(folder, f'system S imports import "*.rnd" {body}', part=PART)
    return {each.name: each for each in system.members if isinstance(each, NodeInstance)}


@pytest.mark.parametrize(
    ("kind", "program"),
    [
        ("", "component_container"),
        ("multi_threaded", "component_container_mt"),
        ("isolated", "component_container_isolated"),
    ],
)
def test_container_is_a_node_of_rclcpp_components(tmp_path: Path, kind: str, program: str) -> None:
    """Its kind is a program of that package; what is in it comes after it, in order."""
    found = members(tmp_path, f"container main {kind} respawn {{ node b : part node a : part }}")
    assert list(found) == ["main", "b", "a"]
    main = found["main"]
    assert main.is_container
    assert main.respawn is not None
    assert main.type is not None
    assert (main.type.package, main.type.executable_name) == ("rclcpp_components", program)
    assert not found["a"].is_container


def test_condition_of_a_container_is_that_of_all_in_it(tmp_path: Path) -> None:
    """A node in it has its own condition besides."""
    found = members(
        tmp_path,
        "argument x : bool = true argument y : bool = true "
        "container main when x { node a : part node b : part when y }",
    )
    texts = {name: each.when and str(each.when) for name, each in found.items()}
    assert found["a"].when == found["main"].when
    assert found["b"].when is not None
    assert "and" in str(texts["b"])
    assert found["a"].into is not None
    assert found["a"].into.when is None


def test_condition_behind_into_is_about_that_alone(tmp_path: Path) -> None:
    """Anywhere else among the modifiers it is about the node."""
    head = "argument x : bool = true container main { }"
    found = members(
        tmp_path,
        f"{head} node a : part into main when x node b : part when x into main "
        "node c : part into main respawn when x node d : part into main when x when not x",
    )
    into = {name: found[name].into for name in "abcd"}
    assert [(each is not None and each.when is not None) for each in into.values()] == [
        True,
        False,
        False,
        True,
    ]
    assert [found[name].when is not None for name in "abcd"] == [False, True, True, True]


def test_plugin_of_the_node_counts_before_that_of_its_description(tmp_path: Path) -> None:
    """Either is the class that is loaded."""
    found = members(tmp_path, 'node a : part node b : part plugin "other::Part"')
    assert [str(found[name].component) for name in "ab"] == ["parts::Part", "other::Part"]
    assert isinstance(found["b"].plugin, Name)


def test_new_keywords_are_still_names(tmp_path: Path) -> None:
    """What was called like them before is still read."""
    text = """
    system into imports import "*.rnd"
    argument isolated : bool = true
    topics topic container topic /into topic /plugin
    node container : plugin when isolated
      parameters param into = 1 param intra_process = 2
      wirings connect container to container connect plugin to /plugin
    subsystem multi_threaded { node into : plugin wirings connect container to /into }
    """
    description = """
    node plugin : plugin
    parameters name into : int = 1 name intra_process : int = 2
    publishes topic container : std_msgs.Bool topic plugin : std_msgs.Bool
    """
    system = load_text(tmp_path, text, plugin=description)
    assert isinstance(system, System)
    assert [each.name for each in system.members] == ["container", "multi_threaded"]


def test_node_in_braces_needs_no_into(tmp_path: Path) -> None:
    """Whichever container it would name, the braces say where it is loaded."""
    (tmp_path / "part.rnd").write_text(PART)
    path = tmp_path / "s.system"
    path.write_text(
        'system S imports import "part.rnd" container a { node x : part into b } container b { }'
    )
    repository = Repository()
    loaded = repository.load(path)
    assert [each.code for each in loaded.diagnostics] == [codes.SYNTAX_ERROR]
    assert "is loaded there" in loaded.diagnostics[0].message
