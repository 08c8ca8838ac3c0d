"""A node gets from parameter files what rclpy gives it, and what its system sets wins."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from deros.generators.system.script.standalone.command_line import parameter_file, yaml
from deros.generators.system.script.standalone.node import Node
from deros.models.common import Value
from deros.systems.flat import FlatNode
from deros.systems.flatten import flatten
from deros.systems.parameters.overrides import matches
from tests.support.systems import load_text

rclpy: Any = pytest.importorskip("rclpy")

TYPE = """node lidar : lidar_driver
  executable "lidar"
parameters open
  name p : integer = 0
"""
KEYS = st.sampled_from(
    ["/**", "/*", "lidar", "/front/lidar", "front/lidar", "/**/lidar", "/front/*", "/*/lidar", "**"]
)
VALUES = st.sampled_from([1, 2, 3, True, 2.5, "x", (1, 2), ("a",)])
FILE = st.lists(
    st.tuples(KEYS, st.dictionaries(st.sampled_from("pqr"), VALUES, min_size=1)), max_size=4
)


def _text(file: list[tuple[str, dict[str, Value]]]) -> str:
    sections = []
    for key, values in file:
        listed = ", ".join(f"{name}: {yaml(value)}" for name, value in values.items())
        sections.append(f'"{key}":\n  ros__parameters: {{{listed}}}\n')
    return "".join(sections)


def _node(folder: Path, files: list[str], own: dict[str, int]) -> FlatNode:
    """Return the flat node of a system with these files, the first of them around the node."""
    names = [f"{number}.yaml" for number in range(len(files))]
    for name, text in zip(names, files, strict=True):
        (folder / name).write_text(text, encoding="utf-8")
    outer, *inner = [f'parameters from "{name}"\n' for name in names]
    settings_ = "".join(f"  param {name} = {value}\n" for name, value in own.items())
    system = load_text(
        folder,
        f'system Robot\nimports import "lidar.rnd"\n{outer}subsystem s namespace front {{\n'
        f"node lidar : lidar\n{''.join(inner)}parameters\n{settings_}}}",
        lidar=TYPE,
    )
    (node,) = flatten(system).nodes
    return node


@settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
@given(
    files=st.lists(FILE, min_size=1, max_size=3),
    own=st.dictionaries(st.sampled_from("pq"), st.integers(7, 9)),
)
@example([[("/**", {"p": 1}), ("/front/lidar", {"p": 2})], [("/**", {"p": 3})]], {})
@example([[("/front/lidar", {"p": 2}), ("/**", {"p": 1})]], {"p": 7})
@example([[("/front/lidar", {"p": True})]], {"p": 7})
def test_node_gets_what_the_model_says(
    tmp_path_factory: pytest.TempPathFactory,
    files: list[list[tuple[str, dict[str, Value]]]],
    own: dict[str, int],
) -> None:
    """Values, types and which of them wins; a value that a file beats is known to be beaten."""
    folder = tmp_path_factory.mktemp("files")
    node = _node(folder, [_text(each) for each in files], own)
    row = Node(
        "lidar", "/front", "p", "p", parameters=own, files=[each.path for each in node.files]
    )
    last = parameter_file(row)
    paths = [folder / each.path for each in node.files]
    if last is not None:
        paths.append(folder / "own.yaml")
        paths[-1].write_text(last, encoding="utf-8")
    arguments = [word for path in paths for word in ("--params-file", str(path))]
    context = rclpy.Context()
    rclpy.init(args=["--ros-args", *arguments], context=context)
    try:
        real = rclpy.create_node(
            "lidar",
            namespace="/front",
            context=context,
            automatically_declare_parameters_from_overrides=True,
            enable_rosout=False,
            start_parameter_services=False,
        )
        try:
            found = {
                name: real.get_parameter(name).value for name in "pqr" if real.has_parameter(name)
            }
        finally:
            real.destroy_node()
    finally:
        context.shutdown()
    expected = {name: value for name, value in node.parameters if name in "pqr"}
    beaten = {setting.name for setting, _ in node.beaten}
    assert {name for name in own if found[name] != own[name] or type(found[name]) is bool} == beaten
    assert {n: _plain(v) for n, v in found.items() if n not in beaten} == {
        n: _plain(v) for n, v in expected.items() if n not in beaten
    }


def _plain(value: Any) -> tuple[str, object]:
    """Return a value with its type; rclpy has arrays of its own for lists."""
    if isinstance(value, (bool, int, float, str)):
        return type(value).__name__, value
    items = list(value)
    return f"list of {type(items[0]).__name__}", items


@pytest.mark.parametrize(
    ("key", "yes", "no"),
    [
        ("/**", "/a /a/b /a/b/c", ""),
        ("a", "/a", "/a/b /b/a /aa"),
        ("/a/*", "/a/b", "/a /a/b/c /b/a"),
        ("/**/a", "/a /b/a /b/c/a", "/b /a/b"),
        ("/*/a", "/b/a", "/a /b/c/a"),
        ("a/**", "/a /a/b /a/b/c", "/b/a"),
        ("//a", "", "/a"),
    ],
)
def test_keys_match_full_names(key: str, yes: str, no: str) -> None:
    """As the regular expression says that ROS 2 makes of a key."""
    for name in (*yes.split(), *no.split()):
        expected = name in yes.split()
        assert matches(key, name) == expected, name
        pattern = (key if key.startswith("/") else f"/{key}").replace("/*", r"(/\w+)")
        assert (re.fullmatch(pattern, name) is not None) == expected


def test_files_reach_used_systems_and_safety_nodes(tmp_path: Path) -> None:
    """A file of the outer system comes before one of the used system, whose folder is its own."""
    inner = tmp_path / "inner"
    inner.mkdir()
    (inner / "lidar.rnd").write_text(TYPE)
    (inner / "x.yaml").write_text("/**: {ros__parameters: {p: 2}}")
    (inner / "inner.system").write_text(
        'system Inner imports import "lidar.rnd" parameters from "x.yaml" node lidar : lidar'
    )
    (tmp_path / "x.yaml").write_text("/**: {ros__parameters: {p: 1, q: 1}}")
    (tmp_path / "robot.deros").write_text('use "test.system" import Robot\n')
    system = load_text(
        tmp_path,
        'system Robot\nimports import "inner/inner.system"\nparameters from "x.yaml"\n'
        'subsystem s : Inner\nsafety "robot.deros"\n',
    )
    lidar, safety, *_ = flatten(system).nodes
    assert dict(lidar.parameters) == {"p": 2, "q": 1}
    assert [each.path for each in safety.files] == ["x.yaml"]
    assert dict(safety.parameters) == {"p": 1, "q": 1}
