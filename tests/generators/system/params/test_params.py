"""The parameter file, as YAML and as read by rcl."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import yaml

from deros.generators.builtin import rossystem_params
from deros.models.system import System
from tests.support.golden import Golden
from tests.support.systems import CONTEXT, EVERYTHING, load, load_text

NODE = """
    node worker : tools
    parameters
      name a.b.x : int = 1
      name a.b.y : double = 1.0
      name a.c : string = ""
      name text : string = ""
      name big : double = 0.0
"""


def text_of(system: System) -> str:
    """Return the parameter file of a system."""
    (file,) = rossystem_params(system, CONTEXT).values()
    return file.text


def settings(folder: Path, *params: str) -> Any:
    """Return the parameters of one node, as parsed from YAML."""
    members = "node a : worker parameters " + " ".join(f"param {p}" for p in params)
    system = load_text(folder, f'system T imports import "*.rnd" {members}', worker=NODE)
    return yaml.safe_load(text_of(system))["/a"]["ros__parameters"]


def test_parameter_file_matches_golden(golden: Golden) -> None:
    """The text for a system with every construct matches the reviewed one."""
    golden.check("rossystem_params", rossystem_params(load(EVERYTHING), CONTEXT))


def test_nodes_are_keyed_by_full_name() -> None:
    """Namespaces are part of the key; nodes without settings are omitted."""
    assert list(yaml.safe_load(text_of(load(EVERYTHING)))) == [
        "/front/left/eye",
        "/front/relay_of_pictures",
    ]


def test_names_with_dots_are_nested(tmp_path: Path) -> None:
    """``a.b.x`` and ``a.b.y`` are both under ``a`` and ``b``."""
    parsed = settings(tmp_path, "a.b.x = 2", 'text = "t"', 'a.c = "c"', "a.b.y = 3")
    assert parsed == {"a": {"b": {"x": 2, "y": 3.0}, "c": "c"}, "text": "t"}


def test_doubles_stay_doubles(tmp_path: Path) -> None:
    """A whole number has a decimal point, and a power of ten the form of YAML 1.1."""
    parsed = settings(tmp_path, "a.b.y = 3", "big = 1e22")
    assert repr(parsed["a"]["b"]["y"]) == "3.0"
    assert repr(parsed["big"]) == "1e+22"


@pytest.mark.parametrize(
    "text", ["", "true", "12", "~", "a: b # c", "it's", '\\"', "ünicode ☃", "\\n\\t", "- x", "{}"]
)
def test_strings_stay_strings(tmp_path: Path, text: str) -> None:
    """YAML reads the string of the model, whatever the bare word would mean."""
    node = f'node a : worker parameters param text = "{text}"'
    system = load_text(tmp_path, f'system T imports import "*.rnd" {node}', worker=NODE)
    (instance,) = system.members
    value = instance.parameters[0].value  # type: ignore[union-attr]
    assert yaml.safe_load(text_of(system)) == {"/a": {"ros__parameters": {"text": value}}}


READ_BY_RCL = """
import json, sys
import rclpy
rclpy.init(args=sys.argv)
node = rclpy.create_node("x", automatically_declare_parameters_from_overrides=True)
own = ("use_sim_time", "start_type_description_service")
values = {p: node.get_parameter(p).value for p in node._parameters if p not in own}
print(json.dumps({p: list(v) if hasattr(v, "tolist") else v for p, v in values.items()}))
"""


@pytest.mark.ros
def test_node_reads_the_values_of_the_system(tmp_path: Path, ros_env: dict[str, str]) -> None:
    """A real node gets every value under its full name, in its declared type."""
    file = tmp_path / "every_thing.params.yaml"
    file.write_text(text_of(load(EVERYTHING)), encoding="utf-8")
    names = ["-r", "__node:=eye", "-r", "__ns:=/front/left"]
    done = subprocess.run(
        [sys.executable, "-c", READ_BY_RCL, "--ros-args", *names, "--params-file", file],
        env=ros_env,
        capture_output=True,
        text=True,
        check=True,
    )
    assert json.loads(done.stdout) == {
        "exposure": 1.0,
        "gains": [1.0, 2.5],
        "lens.name": 'Zeiss "T*" 50\\mm: # it\'s a very good lens, with so long a name that it '
        "does not fit on a line",
        "lens.focal_length": 1e-07,
        "lens": "on",
        "calibrated": True,
        "labels": ["yes", "12", "", "it is ünicode ☃"],
        "topic": "/pictures",
    }


@pytest.mark.ros
def test_rcl_accepts_a_file_without_settings(tmp_path: Path, ros_env: dict[str, str]) -> None:
    """A file with only comments is not an error."""
    file = tmp_path / "empty.params.yaml"
    file.write_text(text_of(load_text(tmp_path, "system Empty")), encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-c", READ_BY_RCL, "--ros-args", "--params-file", file],
        env=ros_env,
        capture_output=True,
        text=True,
        check=True,
    )
    assert json.loads(done.stdout) == {}
