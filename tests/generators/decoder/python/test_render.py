"""The text of decoders: short, deterministic, lint-clean, with few imports."""

from __future__ import annotations

import ast
import random
from pathlib import Path

import pytest

from deros.generators.api.protocol import File
from deros.generators.decoder.python.interface import Topic, render_decoders
from deros.interfaces.fields import FieldPath, Key
from deros.interfaces.types import InterfaceType
from tests.support.golden import Golden
from tests.support.lint import assert_lint_clean
from tests.support.messages import STORE, message_types, random_paths


def _topic(name: str, kind: str, *paths: FieldPath) -> Topic:
    package, message = kind.split(".")
    return Topic(name, InterfaceType(package, "msg", message), paths)


FEW = [
    _topic("imu", "sensor_msgs.Imu", *(("orientation", axis) for axis in "xyzw")),
    _topic("odometry", "nav_msgs.Odometry", ("twist", "twist", "linear", "x")),
    _topic(
        "scan",
        "sensor_msgs.LaserScan",
        ("ranges",),
        ("angle_min",),
        ("angle_increment",),
        ("range_min",),
        ("range_max",),
    ),
    _topic("cloud", "sensor_msgs.PointCloud2", ("width",), ("is_dense",)),
    _topic("joints", "sensor_msgs.JointState", ("position", 2), ("name",)),
    _topic("diagnostics", "diagnostic_msgs.DiagnosticArray", ("status", 1, "level"), ("status",)),
    _topic(
        "named",
        "diagnostic_msgs.DiagnosticArray",
        ("status", Key("name", "lidar"), "level"),
        ("status", Key("name", "arm"), "values", Key("key", "brake"), "value"),
    ),
    _topic("joint", "sensor_msgs.JointState", ("position", Key("name", "elbow_joint"))),
    _topic("path", "nav_msgs.Path", ("poses", 0, "pose", "position", "x")),
    _topic("poses", "geometry_msgs.PoseArray", ("poses", 2, "position", "z")),
    _topic("twist", "geometry_msgs.Twist", ("angular", "z"), ("linear", "x")),
    _topic("mode", "std_msgs.String", ("data",)),
    _topic("alive", "std_msgs.Empty"),
]


@pytest.mark.essential
def test_decoder_text_matches_golden(golden: Golden) -> None:
    """The text for common messages matches the reviewed one."""
    golden.check("cdr_python", {"decoders.py": File(render_decoders(FEW, STORE))})


def test_decoders_pass_the_linters(tmp_path: Path) -> None:
    """The ament linters accept decoders of any messages and fields."""
    rng = random.Random(1)
    packages = ("std_msgs", "sensor_msgs", "nav_msgs", "test_msgs", "geometry_msgs")
    topics = []
    for kind in message_types(*packages):
        paths = random_paths(STORE, kind, rng, keys=True)
        topics.append(Topic(f"{kind.package}_{kind.name}", kind, paths))
        (tmp_path / f"only_{len(topics)}.py").write_text(render_decoders(topics[-1:], STORE))
    (tmp_path / "decoders.py").write_text(render_decoders(topics, STORE))
    (tmp_path / "few.py").write_text(render_decoders(FEW, STORE))
    assert_lint_clean(tmp_path)


def test_rendering_is_deterministic() -> None:
    """Two renderings of the same topics are equal."""
    assert render_decoders(FEW, STORE) == render_decoders(FEW, STORE)


def test_only_used_modules_are_imported() -> None:
    """NumPy is imported for arrays, math for optional elements, and ROS never."""
    assert _imported([_topic("twist", "geometry_msgs.Twist", ("linear", "x"))]) == {"struct"}
    arrays = [_topic("scan", "sensor_msgs.LaserScan", ("ranges",))]
    assert _imported(arrays) == {"struct", "numpy"}
    elements = [_topic("joints", "sensor_msgs.JointState", ("position", 2))]
    assert _imported(elements) == {"struct", "math"}


def _imported(topics: list[Topic]) -> set[str]:
    tree = ast.parse(render_decoders(topics, STORE))
    imports = (node for node in ast.walk(tree) if isinstance(node, ast.Import))
    return {name.name for node in imports for name in node.names}


def test_every_name_is_defined_and_used() -> None:
    """The module has no unused constant, helper or import."""
    for topics in ([each] for each in FEW):
        tree = ast.parse(render_decoders(topics, STORE))
        used = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
        for node in tree.body:
            names = []
            if isinstance(node, ast.Import):
                names = [alias.asname or alias.name for alias in node.names]
            elif isinstance(node, ast.FunctionDef) and not node.name.startswith("decode_"):
                names = [node.name]
            elif isinstance(node, ast.Assign):
                names = [target.id for target in node.targets if isinstance(target, ast.Name)]
            assert set(names) - {"DECODING_ERRORS"} <= _loaded(tree), (topics[0].name, names, used)


def _loaded(tree: ast.AST) -> set[str]:
    return {
        node.id
        for node in ast.walk(tree)
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)
    }


def test_names_do_not_collide() -> None:
    """Topics and fields may have names of the module's own functions and of Python."""
    store_type = "std_msgs.Float64MultiArray"
    topics = [
        _topic("data", store_type, ("data",), ("layout", "dim", 0, "label")),
        _topic("float64", "geometry_msgs.Twist", ("linear", "x"), ("linear", "y")),
        _topic("range", "sensor_msgs.Range", ("range",)),
    ]
    module: dict[str, object] = {}
    exec(render_decoders(topics, STORE), module)
    assert {f"decode_{topic.name}" for topic in topics} <= set(module)


@pytest.mark.parametrize(
    ("kind", "path", "reason"),
    [
        ("std_msgs.Bool", ("no_such",), "no field 'no_such'"),
        ("nav_msgs.Odometry", ("pose",), "is a message"),
        ("nav_msgs.Odometry", (), "whole message"),
        ("no_such.Thing", ("data",), "not known"),
    ],
)
def test_path_without_a_value_is_rejected(kind: str, path: tuple[str, ...], reason: str) -> None:
    """A path to a missing field, or to a message, raises with the path."""
    with pytest.raises(ValueError, match=reason):
        render_decoders([_topic("topic", kind, path)], STORE)
