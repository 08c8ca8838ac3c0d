"""Parameter files become descriptions of the nodes that they name, and a system that reads them."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.importers.parameter_files import read_parameter_files
from deros.importers.readers import Request, UnreadableError
from deros.systems.flatten import flatten
from tests.support.checks import checked
from tests.support.imported_launch import model_of

TEXT = """\
/**:
  ros__parameters:
    common: 1
/front/lidar:
  ros__parameters:
    use_sim_time: false
    rate: 10.0
    angles: [-1.5, 0.0, 1.5]
    name: "${x}"
back:
  lidar:
    ros__parameters: {deep: {on: true}}
"""


def written(folder: Path, text: str) -> Path:
    """Write a parameter file."""
    path = folder / "params.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def test_nodes_have_the_values_of_the_file(tmp_path: Path) -> None:
    """With their types, in a system that checks without findings."""
    system = model_of(written(tmp_path, TEXT), tmp_path / "models")
    assert checked(tmp_path / "models" / "robot.system") == []
    found = {node.full_name: dict(node.parameters) for node in flatten(system).nodes}
    assert found == {
        "/front/lidar": {
            "common": 1,
            "use_sim_time": False,
            "rate": 10.0,
            "angles": (-1.5, 0.0, 1.5),
            "name": "${x}",
        },
        "/back/lidar": {"common": 1, "deep.on": True},
    }
    kinds = {
        each.name: each.type.value
        for each in system.node_types["lidar"].parameters
        if each.has_default
    }
    assert kinds == {
        "common": "integer",
        "rate": "double",
        "angles": "double[]",
        "name": "string",
    }


def test_dump_of_a_node_in_cpp_declares_its_own_parameters(tmp_path: Path) -> None:
    """Not those that every node of rclcpp has, which the file sets all the same."""
    text = """\
/talker:
  ros__parameters:
    qos_overrides:
      /parameter_events:
        publisher: {depth: 1000, durability: volatile, history: keep_last, reliability: reliable}
    rate: 10.0
    start_type_description_service: true
    use_sim_time: false
"""
    system = model_of(written(tmp_path, text), tmp_path / "models")
    assert checked(tmp_path / "models" / "robot.system") == []
    assert [each.name for each in system.node_types["talker"].parameters] == ["rate"]
    (talker,) = flatten(system).nodes
    assert dict(talker.parameters)["qos_overrides./parameter_events.publisher.depth"] == 1000


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("n:\n  ros__parameters:\n    empty: []\n", ":3: parameter 'empty' is left out"),
        ("n:\n  ros__parameters: {a: 1}\n/x/*:\n  ros__parameters: {b: 1}\n", ":3: key '/x/*'"),
        ("n:\n  ros__parameters:\n    a$: 1\n", ":3: parameter 'a$' is left out"),
    ],
)
def test_what_a_model_cannot_say_is_listed(text: str, said: str, tmp_path: Path) -> None:
    """With the line of the file."""
    path = written(tmp_path, text)
    found = read_parameter_files(Request((path,), None, tmp_path / "out", lambda _: True))
    assert any(each.startswith(f"{path}{said}") for each in found.missing), found.missing


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("/**:\n  ros__parameters: {a: 1}\n", "no key is the name of one node"),
        ("n:\n  ros__parameters: [\n", r"params\.yaml:\d+:\d+: "),
        ("n:\n  ros__parameters: {a: [1, x]}\n", r"params\.yaml:2:\d+: "),
        ("n: 5\n", r"params\.yaml"),
        ("", r"params\.yaml"),
    ],
)
def test_file_without_nodes_is_refused(text: str, said: str, tmp_path: Path) -> None:
    """And one that ROS 2 refuses."""
    path = written(tmp_path, text)
    with pytest.raises(UnreadableError, match=said):
        read_parameter_files(Request((path,), None, tmp_path / "out", lambda _: True))
