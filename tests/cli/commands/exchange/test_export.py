"""``deros export``: what is written, what is said of it, and exit codes."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from tests.support.cli import deros

NODE = "node base : base_driver\npublishes\n  topic odom : nav_msgs.Odometry\n"


def write(folder: Path, text: str, name: str = "base.rnd") -> Path:
    """Write a model."""
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def test_a_node_is_written_as_a_document(tmp_path: Path) -> None:
    """Its name is that of the node; a second run changes nothing."""
    path = write(tmp_path, NODE)
    first, second = (deros("export", path, "--target", "nodl", "-o", tmp_path) for _ in range(2))
    assert (first.code, first.out) == (0, f"wrote {tmp_path}/base.nodl.yaml\n")
    assert (second.code, second.out) == (0, "")
    assert (tmp_path / "base.nodl.yaml").read_text(encoding="utf-8").startswith("nodl_version: 2\n")


def test_a_system_is_written_as_a_graph(tmp_path: Path) -> None:
    """Its name is that of the system; a node description is none."""
    path = write(tmp_path, NODE)
    robot = 'system robot\nimports\n  import "base.rnd"\nnode base : base\n'
    done = deros("export", write(tmp_path, robot, "r.system"), "--target", "graph", "-o", tmp_path)
    assert (done.code, done.out) == (0, f"wrote {tmp_path}/robot.graph.yaml\n")
    assert "name: /odom" in (tmp_path / "robot.graph.yaml").read_text(encoding="utf-8")
    assert deros("export", path, "--target", "graph", "-o", tmp_path).code == 2


SYSTEM = """system robot
imports
  import "base.rnd"
argument robot : string
argument maps : string = share("no_such_package")
argument both : bool = false
topics
  external topic "/${robot}/odom"
  external topic /second
node base : base namespace $robot
  parameters
    param side = "${robot}_side"
    param map = "${maps}/floor.yaml"
  wirings
    connect odom to "/${robot}/odom"
node second : base when both
  wirings
    connect odom to /second
"""
PARAMETERS = """parameters
  name side : string = "none"
  name map : string = "none.yaml"
"""


def test_a_graph_is_that_of_the_arguments(tmp_path: Path) -> None:
    """Names, values and conditions follow them; a value that nobody knows here is listed."""
    write(tmp_path, NODE.replace("publishes", f"{PARAMETERS}publishes"))
    path = write(tmp_path, SYSTEM, "r.system")
    options = ["--target", "graph", "-o", tmp_path]
    done = deros("export", path, *options, "robot:=left", "both:=true")
    why = "is known only where the system is started"
    assert (done.code, done.out.splitlines()[1:]) == (
        1,
        [
            f"not in {tmp_path}/robot.graph.yaml:",
            f"  {path}:10: the value of parameter 'map' of '/left/base' {why}",
        ],
    )
    exported = yaml.safe_load((tmp_path / "robot.graph.yaml").read_text(encoding="utf-8"))
    values = {
        node["name"]: {
            each["name"]: value["string_value"]
            for each, value in zip(node["parameters"], node["parameter_values"], strict=True)
        }
        for node in exported["nodes"]
    }
    assert values == {
        "/left/base": {"side": "left_side"},
        "/second": {"side": "none", "map": "none.yaml"},
    }
    done = deros("export", path, *options, "robot:=right", "maps:=/maps")
    assert (done.code, done.out) == (0, f"wrote {tmp_path}/robot.graph.yaml\n")
    (node,) = yaml.safe_load((tmp_path / "robot.graph.yaml").read_text(encoding="utf-8"))["nodes"]
    assert [each["name"] for each in node["publishers"]] == ["/right/odom"]
    assert {"string_value": "/maps/floor.yaml", "type": 4} in node["parameter_values"]


@pytest.mark.parametrize(
    ("target", "arguments", "said"),
    [
        ("graph", [], "argument 'robot' has to be given"),
        ("graph", ["robot:=a", "both:=maybe"], "argument 'both': 'maybe' is not true or false"),
        ("graph", ["robot:=a", "speed:=1"], "the system has no argument 'speed'"),
        ("nodl", ["robot:=a"], "a node has no arguments like 'robot:=a'; a system has"),
    ],
)
def test_wrong_arguments_are_usage_errors(
    target: str, arguments: list[str], said: str, tmp_path: Path
) -> None:
    """Nothing is written."""
    write(tmp_path, NODE.replace("publishes", f"{PARAMETERS}publishes"))
    path = write(tmp_path, SYSTEM, "r.system")
    done = deros("export", path, *arguments, "--target", target, "-o", tmp_path / "out")
    assert done.code == 2
    assert said in done.err
    assert not (tmp_path / "out").exists()


def test_what_is_missing_is_listed(tmp_path: Path) -> None:
    """With the line of the model; the exit code says so, too."""
    path = write(tmp_path, f"{NODE}timers\n  timer t every 10 ms\n")
    done = deros("export", path, "--target", "nodl", "-o", tmp_path)
    assert done.code == 1
    assert done.out.splitlines()[1:] == [
        f"not in {tmp_path}/base.nodl.yaml:",
        f"  {path}:5: timer 't' is not in the document",
    ]


def test_a_model_with_errors_is_not_exported(tmp_path: Path) -> None:
    """Its findings are shown, and nothing is written."""
    path = write(tmp_path, NODE.replace("Odometry", "Odometri"))
    done = deros("export", path, "--target", "nodl", "-o", tmp_path / "out")
    assert done.code == 1
    assert "DRS102" in done.err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("name", "text", "code", "said"),
    [
        ("base.system", "system base\n", 2, "it takes node descriptions (*.rnd), not"),
        ("none.rnd", None, 2, "cannot read"),
        ("base.rnd", "node base\n", 1, "DRS"),
    ],
)
def test_other_files_are_refused(
    name: str, text: str | None, code: int, said: str, tmp_path: Path
) -> None:
    """A target is for one language."""
    path = tmp_path / name if text is None else write(tmp_path, text, name)
    done = deros("export", path, "--target", "nodl", "-o", tmp_path / "out")
    assert done.code == code
    assert said in done.err + done.out
    assert not (tmp_path / "out").exists()


def test_a_folder_that_cannot_be_written_is_an_error(tmp_path: Path) -> None:
    """The message names it."""
    path = write(tmp_path, NODE)
    done = deros("export", path, "--target", "nodl", "-o", path / "below")
    assert done.code != 0
    assert str(path) in done.err
    assert "Traceback" not in done.err
