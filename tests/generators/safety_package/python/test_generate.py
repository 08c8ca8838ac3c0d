"""The package of the Python safety node."""

from __future__ import annotations

import ast
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import pytest

from deros.generators.api.protocol import Files, GenerationError, Owner
from deros.generators.output.writer import write
from deros.generators.runtime.interface import with_runtime
from deros.generators.safety_package.python.generate import generate
from deros.metamodels.load import Repository
from deros.models.node import NodeType
from tests.support.generating import output_of
from tests.support.golden import Golden
from tests.support.golden_alike import Part, parts_of, unlike_those_before
from tests.support.golden_runtime import is_copy
from tests.support.lint import assert_lint_clean

MODELS = Path(__file__).resolve().parents[2] / "safety_node/python/models"
HEAD = 'use "robot.system" import Robot\ninput v = topic /speed.data\n'


def files_of_text(text: str, **options: str) -> Files:
    """Return the generated files of rules that are next to the models."""
    return output_of(generate, str(MODELS / "text.deros"), text, **options)


def files_of(name: str, **options: str) -> Files:
    """Return the generated files of one of the models."""
    return output_of(generate, MODELS / f"{name}.deros", **options)


KEPT = {
    "every_thing": (".rnd", ".py", "_actions.py", "_actions_base.py"),
    "two_rules": (".py",),
    "calls": (".rnd", ".py"),
}
"""The files that are read besides the metadata, by the ends of their names."""


def parts(name: str) -> list[Part]:
    """Return node, description, actions, and the runtime's files of a package with a copy.

    Other files come from the generators of nodes and of monitors, and are compared in their tests.
    """
    own = {"rule_metadata.py", *(f"{name}_safety_node{end}" for end in KEPT[name])}
    files = {path: file for path, file in files_of(name).items() if Path(path).name in own}
    assert len(files) == len(own)
    copied = files_of(name, runtime="copy")
    files |= {path: file for path, file in copied.items() if is_copy(path)}
    return parts_of(f"safety_python/{name}", name, [name], files)


@pytest.mark.parametrize("name", KEPT)
@pytest.mark.essential
def test_files_match_golden(name: str, golden: Golden) -> None:
    """What is of the safety node alone matches, whole or as its difference from another one."""
    both = [part for each in KEPT for part in parts(each)]
    golden.check(f"safety_python/{name}", unlike_those_before(f"safety_python/{name}", both))


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("every_thing", {}),
        ("two_rules", {"copyright": "2026 Jane Doe"}),
        ("calls", {"runtime": "copy", "copyright": "2026 Jane Doe"}),
    ],
)
def test_files_pass_the_ament_linters(name: str, options: dict[str, str], tmp_path: Path) -> None:
    """flake8 and pep257 with ament's settings accept all files."""
    write(files_of(name, **options), tmp_path)
    assert_lint_clean(tmp_path / f"{name}_safety")


KINDS = (
    "action stop; entity e { r: v > 0.5; } if e.r then { stop; };",
    "action stop publishes false on /go : std_msgs.Bool;"
    " entity e { r: v > 0.5; } if e.r then { stop; };",
    'action tell publishes "slow" on /told : std_msgs.String;'
    " entity e { r: v > 0.5; } if e.r then { tell; };",
    'entity e { r: v > 0.5; } if e.r then { log_state("it\'s {fast}"); };',
    "action a reset_by b; action b; entity e { r: v > 0.5; } if e.r then { a; b; };",
    "action stop calls /stop : std_srvs.Trigger; entity e { r: v > 0.5; } if e.r then { stop; };",
    "action gone; action stop publishes true on /gone : std_msgs.Bool latched;"
    " entity e { r: v > 0.5; } if e.r then { stop; };",
    "action very_long_name_of_an_action_that_goes_on_and_on(first_argument, second_argument);"
    " entity entity_with_a_long_name { rule_with_a_long_name_too_which_goes_on: v > 0.5; }"
    " if entity_with_a_long_name.rule_with_a_long_name_too_which_goes_on or"
    " not entity_with_a_long_name.rule_with_a_long_name_too_which_goes_on then {"
    ' very_long_name_of_an_action_that_goes_on_and_on(1, "two"); };',
)
"""Combinations of actions."""


def test_every_kind_of_program_is_lint_clean(tmp_path: Path) -> None:
    """No combination of actions leaves an unused import, name or empty block behind."""
    for number, rules in enumerate(KINDS):
        write(files_of_text(HEAD + rules, runtime="package"), tmp_path / f"kind_{number}")
    assert_lint_clean(tmp_path)


def test_description_matches_the_node() -> None:
    """The generated .rnd parses to the node whose base class is generated with it."""
    text = files_of("every_thing")["every_thing_safety/every_thing_safety_node.rnd"].text
    loaded = Repository().load_text("every_thing_safety_node.rnd", text)
    assert loaded.diagnostics == ()
    assert isinstance(loaded.model, NodeType)
    assert loaded.model.name == "every_thing_safety_node"
    assert loaded.model.port("/stop") is not None


def test_user_files_are_the_manifest_and_the_actions() -> None:
    """All other files are generated again."""
    files = files_of("every_thing")
    owned = [path for path, file in files.items() if file.owner is Owner.USER]
    assert sorted(owned) == [
        "every_thing_safety/every_thing_safety/every_thing_safety_node_actions.py",
        "every_thing_safety/package.xml",
    ]


def test_new_action_is_reported_until_it_is_written() -> None:
    """The existing user file lacks the method; the method of the base class reports this."""
    pytest.importorskip("rclpy")
    files = files_of("every_thing")
    module = "every_thing_safety/every_thing_safety/every_thing_safety_node_actions_base.py"
    names: dict[str, Any] = {}
    exec(compile(files[module].text, module, "exec"), names)
    base = names["EveryThingSafetyNodeActionsBase"]
    written_before = type("Actions", (base,), {"release": lambda *_: None})
    node = Mock()
    actions = written_before(node)
    assert actions.unfilled() == ["beep"]
    actions.beep(1, "near")
    (message,) = node.get_logger().error.call_args.args
    assert message.startswith("action beep(1, 'near') should have been carried out now")


def test_bound_actions_need_no_user_file() -> None:
    """There is no code to write."""
    rules = "action stop publishes true on /stop : std_msgs.Bool;\n"
    files = files_of_text(f"{HEAD}{rules}entity e {{ r: v > 0.5; }} if e.r then {{ stop; }};")
    assert not [path for path in files if "actions" in path]


def test_output_does_not_import_deros() -> None:
    """Every import is of ROS 2, the standard library, the package itself or its runtime."""
    allowed = {
        "__future__", "abc", "collections", "contextlib", "ctypes", "dataclasses", "enum", "fcntl",
        "functools", "gc", "hashlib", "itertools", "math", "numpy", "os", "resource", "select",
        "signal", "stat", "struct", "sys", "tempfile", "threading", "time", "traceback", "types",
        "typing", "glob", "pathlib", "setuptools", "launch", "launch_ros", "ament_index_python",
        "pytest", "ament_flake8", "ament_pep257", "rclpy", "rcl_interfaces",
        "every_thing_safety", "std_msgs", "std_srvs", "nav_msgs", "sensor_msgs", "diagnostic_msgs",
        "deros_runtime", "atexit", "copy", "geometry_msgs", "tf2_msgs",
    }  # fmt: skip
    imported: set[str] = set()
    for path, file in with_runtime(files_of("every_thing")).items():
        if path.endswith(".py"):
            for item in ast.walk(ast.parse(file.text)):
                if isinstance(item, ast.Import):
                    imported |= {name.name.partition(".")[0] for name in item.names}
                elif isinstance(item, ast.ImportFrom) and not item.level:
                    imported.add((item.module or "").partition(".")[0])
    assert imported <= allowed


@pytest.mark.parametrize(("field", "needed"), [("position.max()", True), ("position[0]", False)])
def test_numpy_is_a_dependency_if_arrays_are_read(field: str, needed: bool) -> None:
    """The package lists the imports of its modules."""
    rules = (
        'use "robot.system" import Robot\naction stop;\n'
        f"input j = topic /joints timeout 1 sec\nentity e {{ high: j.{field} > 1; }}\n"
        "if e.high then { stop; };\n"
    )
    files = files_of_text(rules)
    (package,) = (file.text for path, file in files.items() if Path(path).name == "package.xml")
    assert ("<exec_depend>python3-numpy</exec_depend>" in package) == needed
    assert any("import numpy" in file.text for file in files.values()) == needed


def test_output_does_not_depend_on_the_folder_of_the_rules(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """No file contains a path of the machine."""
    monkeypatch.chdir(MODELS)
    assert output_of(generate, "every_thing.deros") == files_of("every_thing")


def test_node_shadows_no_attribute_of_rclpy() -> None:
    """Members of the class differ from those of rclpy's node."""
    rclpy_node = pytest.importorskip("rclpy.node")
    source = Path(rclpy_node.__file__).read_text(encoding="utf-8")
    kept = _attributes(source) | set(dir(rclpy_node.Node))
    for name in ("every_thing_safety_node", "every_thing_safety_node_base"):
        text = files_of("every_thing")[f"every_thing_safety/every_thing_safety/{name}.py"].text
        assert not (_attributes(text) | _methods(text)) & kept - {"__init__"}


def _attributes(source: str) -> set[str]:
    return {
        item.attr
        for item in ast.walk(ast.parse(source))
        if isinstance(item, ast.Attribute)
        and isinstance(item.ctx, ast.Store)
        and isinstance(item.value, ast.Name)
        and item.value.id == "self"
    }


def _methods(source: str) -> set[str]:
    return {item.name for item in ast.walk(ast.parse(source)) if isinstance(item, ast.FunctionDef)}


@pytest.mark.parametrize(
    ("rules", "options", "fragment"),
    [
        ("action node; entity e { r: v > 1; } if e.r then { node; };", {}, "'node'"),
        (
            "action stop publishes true on /a/b : std_msgs.Bool;"
            "action halt publishes true on /a_b : std_msgs.Bool;"
            "entity e { r: v > 1; } if e.r then { stop; halt; };",
            {},
            "'/a_b' and publisher '/a/b' both become 'publish_a_b'",
        ),
        ("entity e { r: v > 1; }", {"node": "monitor"}, "module 'monitor'"),
        ("entity e { r: v > 1; }", {"node": "explanation"}, "module 'explanation'"),
    ],
)
def test_colliding_names_are_rejected(rules: str, options: dict[str, str], fragment: str) -> None:
    """Two elements with one name end the generation, with their places."""
    with pytest.raises(GenerationError, match="both become") as refused:
        files_of_text(HEAD + rules, **options)
    (diagnostic,) = refused.value.diagnostics
    assert diagnostic.code.name == "DRS401"
    assert fragment in diagnostic.message


def test_topic_with_both_ends_in_the_node_is_rejected() -> None:
    """A node description cannot distinguish the two ports."""
    rules = "action slow publishes 1.0 on /speed : std_msgs.Float64;\n"
    with pytest.raises(GenerationError, match="both publish and watch '/speed'") as refused:
        files_of_text(f"{HEAD}{rules}entity e {{ r: v > 1; }} if e.r then {{ slow; }};")
    (diagnostic,) = refused.value.diagnostics
    assert diagnostic.code.name == "DRS402"
    assert [related.span.line for related in diagnostic.related] == [2]


def test_rules_with_errors_are_rejected() -> None:
    """The generator reports the errors of the rules."""
    with pytest.raises(GenerationError) as refused:
        files_of_text(f"{HEAD}entity e {{ r: w > 1; }}")
    assert "DRS310" in [diagnostic.code.name for diagnostic in refused.value.diagnostics]
