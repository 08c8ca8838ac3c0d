"""How long lines may be changes no program: only where its lines break."""

from __future__ import annotations

import ast
from collections.abc import Mapping
from difflib import unified_diff
from pathlib import Path
from typing import Any

import pytest

from deros.generators.api.protocol import GenerateFunction
from deros.generators.node.python.generate import generate as node
from deros.generators.safety_package.python.generate import generate as safety_package
from deros.generators.system.launch.generate import generate as launch_file
from deros.generators.system.script.generate import generate as script
from tests.support.generating import output_of
from tests.support.narrow import narrow

ROOT = Path(__file__).resolve().parents[2]
MODELS: tuple[tuple[GenerateFunction, str], ...] = (
    *((safety_package, f"examples/{each}/{each}.deros") for each in ("frobit", "feeding_robot")),
    (safety_package, "examples/intelligent_one/intelligent_one.deros"),
    (safety_package, "examples/kobuki/kobuki.deros"),
    (safety_package, "tests/generators/gate/python/models/gates.deros"),
    (node, "tests/generators/node/python/models/mapper.rnd"),
    (node, "tests/generators/node/python/models/counter.rnd"),
    (launch_file, "examples/feeding_robot/feeding_robot.system"),
    (script, "examples/feeding_robot/feeding_robot.system"),
)
LONG_NAMES = f"""
use "robot.system" import Robot
action stop_{"a" * 110} publishes true on /stop : std_msgs.Bool latched;
action slow_{"a" * 110} publishes 1 on /mode : std_msgs.UInt8 latched;
input v_{"a" * 110} = topic /speed.data
entity e {{ r_{"a" * 110}: v_{"a" * 110} > 0.5 m/s; }}
if e.r_{"a" * 110} then {{ stop_{"a" * 110}; }};
if stop_{"a" * 110}.active then {{ slow_{"a" * 110}; }};
gate /wish -> /command : geometry_msgs.Twist rate 20 Hz {{
    stop_{"a" * 110}: zero;
    always: limit linear.x to [0, 1];
}}
"""


@pytest.mark.parametrize(("generate", "model"), MODELS)
def test_width_changes_no_program(
    generate: GenerateFunction, model: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With narrower lines, each file in Python is the same program as with lines of 99 letters.

    A tuple of one that is broken once had two commas, and one in brackets where there was none.
    """
    wide = _programs(generate, ROOT / model)
    for width in (20, 45, 70):
        narrow(width, monkeypatch)
        assert _differences(wide, _programs(generate, ROOT / model)) == []


def test_long_names_are_laid_out_as_short_ones() -> None:
    """Where each name takes a line of its own, the files are programs as well."""
    path = ROOT / "tests/generators/gate/python/models/long.deros"
    long = _programs(safety_package, path, LONG_NAMES)
    short = _programs(safety_package, path, LONG_NAMES.replace("_" + "a" * 110, ""))
    long = {path: text.replace("_" + "a" * 110, "") for path, text in long.items()}
    assert _differences(short, long) == []


def _differences(ones: Mapping[str, str], others: Mapping[str, str]) -> list[str]:
    assert ones.keys() == others.keys()
    differing = [path for path, text in ones.items() if text != others[path]]
    return [
        "\n".join([path, *unified_diff(ones[path].splitlines(), others[path].splitlines())])
        for path in differing
    ]


def _programs(generate: GenerateFunction, *model: Any) -> Mapping[str, str]:
    """Return the statements of each generated file in Python, without what documents them.

    Decoders have other statements where a line is short; what they read is compared elsewhere.
    """
    files = output_of(generate, *model)
    trees = {
        path: ast.parse(file.text)
        for path, file in files.items()
        if path.endswith(".py") and not path.endswith("decoding.py")
    }
    assert trees
    for tree in trees.values():
        for each in ast.walk(tree):
            if isinstance(each, ast.Module | ast.ClassDef | ast.FunctionDef):
                each.body = [one for written in each.body for one in _alike(written)]
    return {path: ast.dump(tree, indent=1) for path, tree in trees.items()}


def _alike(statement: ast.stmt) -> list[ast.stmt]:
    """Return what stands for a statement: nothing for a text, two of ``return … if … else …``."""
    match statement:
        case ast.Expr(ast.Constant()):
            return []
        case ast.Return(ast.IfExp(test, value, other)):
            return [ast.If(test, [ast.Return(value)], []), ast.Return(other)]
        case _:
            return [statement]
