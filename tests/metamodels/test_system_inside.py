"""Nodes in the process of another program, as they are written."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros import codes
from deros.metamodels.load import Repository
from deros.models.system import NodeInstance, Subsystem, System
from tests.support.systems import load_text

PART = "node part : parts lifecycle"


def system(folder: Path, body: str) -> System:
    """Return a system of parts."""
    return load_text(folder, f'system S imports import "*.rnd" {body}', part=PART)


def nodes(group: System | Subsystem) -> dict[str, NodeInstance]:
    """Return the nodes in a group and below by their names."""
    found: dict[str, NodeInstance] = {}
    for each in group.members:
        found |= nodes(each) if isinstance(each, Subsystem) else {each.name: each}
    return found


def test_program_of_the_innermost_group_is_meant(tmp_path: Path) -> None:
    """It may stand behind the statement, and in a group around it."""
    model = system(
        tmp_path,
        "inside host { node a : part } node host : part own_name "
        "subsystem Sub { inside host { node b : part } inside sim { node c : part } "
        'process sim : "x" }'
        ' subsystem Other { inside host { node d : part } process host : "x" }',
    )
    found = nodes(model)
    assert found["host"].own_name is not None
    places = {}
    for name in "abcd":
        inside = found[name].inside
        assert inside is not None
        assert all(span.text == inside.process for span in inside.owners)
        places[name] = (inside.process, inside.levels, len(inside.owners))
    assert places == {
        "a": ("host", 0, 1),
        "b": ("host", 1, 1),
        "c": ("sim", 0, 1),
        "d": ("host", 0, 1),
    }


def test_nodes_are_there_where_their_program_is(tmp_path: Path) -> None:
    """Their own condition comes besides; of two programs with conditions, one is enough."""
    model = system(
        tmp_path,
        "argument x : bool = true argument y : bool = true "
        "node one : part when x inside one { node a : part node b : part when y } "
        "node two : part when x node two : part when not x inside two { node c : part } "
        "node three : part when x node three : part inside three { node d : part }",
    )
    found = nodes(model)
    assert found["a"].when == found["one"].when
    assert "'and'" in str(found["b"].when)
    assert "'or'" in str(found["c"].when)
    assert found["d"].when is None


def test_what_is_of_processes_is_refused_by_name(tmp_path: Path) -> None:
    """Each is reported at its place and left out, so that nothing else follows from it."""
    words = (
        *(
            "respawn",
            "log_level debug",
            "autostart",
            'arguments ["-x"]',
            "env A = 1",
            'prefix "nice"',
        ),
        *('plugin "a::B"', "into main", "intra_process", "own_name"),
        *("after exit of host", "on exit stop all"),
    )
    path = tmp_path / "test.system"
    (tmp_path / "part.rnd").write_text(PART)
    text = f"node host : part inside host {{ node a : part {' '.join(words)} when c }}"
    path.write_text(f'system S imports import "*.rnd" argument c : bool = true {text}')
    repository = Repository()
    model = repository.load(path).model
    assert {each.code for each in repository.diagnostics} == {codes.NOT_OF_COMPOSED_NODE}
    assert [each.span.text for each in repository.diagnostics] == list(words)
    assert all(each.hint for each in repository.diagnostics)
    assert isinstance(model, System)
    node = nodes(model)["a"]
    assert (node.respawn, node.autostart, node.into, node.own_name) == (None,) * 4
    assert node.when is not None


@pytest.mark.parametrize("word", ["inside", "own_name"])
def test_new_keywords_are_still_names(tmp_path: Path, word: str) -> None:
    """Of nodes, types, topics, ports, arguments, parameters, processes and subsystems."""
    model = load_text(
        tmp_path,
        f'system {word} imports import "*.rnd" argument {word} : bool = true '
        f"topics topic /{word} topic {word} "
        f"node {word} : {word} namespace {word} parameters param {word} = 1 "
        f"wirings connect {word} to {word} "
        f'subsystem {word} {{ process p : "x" inside p {{ node {word} : {word} }} }}',
        name=f"node {word} : {word} parameters name {word} : int = 1 "
        f"publishes topic {word} : std_msgs.Bool",
    )
    assert len(model.members) == 2


def test_nodes_of_launch_files_have_the_names_of_these(tmp_path: Path) -> None:
    """``own_name`` says how a node is started, and the launch file starts it."""
    path = tmp_path / "test.system"
    (tmp_path / "part.rnd").write_text(PART)
    text = 'launch "a.launch.py" provides { node a : part own_name }'
    path.write_text(f'system S imports import "*.rnd" {text}')
    repository = Repository()
    repository.load(path)
    assert [each.span.text for each in repository.diagnostics] == ["own_name"]
