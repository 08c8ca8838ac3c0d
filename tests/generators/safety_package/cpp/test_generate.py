"""The package of the C++ safety node."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from deros.generators.api.protocol import Context, Files, GenerationError, Owner
from deros.generators.output.writer import write
from deros.generators.safety_package.cpp.generate import generate
from deros.generators.safety_package.python.generate import generate as generate_python
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.node import NodeType
from deros.models.rules import Rules
from tests.support.cpp_lint import assert_cpp_lint_clean
from tests.support.generating import output_of
from tests.support.golden import Golden
from tests.support.golden_alike import Part, parts_of, unlike_those_before
from tests.support.golden_runtime import is_copy
from tests.support.needs import may_run
from tests.support.profiles import slow

MODELS = Path(__file__).resolve().parents[2] / "safety_node/python/models"
HEAD = 'use "robot.system" import Robot\ninput v = topic /speed.data\n'


def files_of(name: str, **options: str) -> Files:
    """Return the generated files of one of the models."""
    return output_of(generate, MODELS / f"{name}.deros", **options)


def files_of_text(text: str) -> Files:
    """Return the generated files of rules that are next to the models."""
    return output_of(generate, str(MODELS / "text.deros"), HEAD + text)


KEPT = {
    "every_thing": ("", "_main", "_messages", "_actions", "_actions_base", "_cpp"),
    "two_rules": ("", "_rule_metadata"),
    "calls": ("",),
}
"""The files that are read, by the ends of their names, those of the metadata for few rules.

For any other rules ``test_causes.py`` holds what the metadata says against the reference.
"""


def parts(name: str) -> list[Part]:
    """Return node, description, messages, metadata, actions, and the runtime's files of a copy.

    Other files come from the generators of nodes and of monitors, and are compared in their tests.
    """
    stems = {f"{name}_safety_node{part}" for part in KEPT[name]}
    files = {
        path: file
        for path, file in files_of(name).items()
        if Path(path).suffix in (".cpp", ".hpp", ".rnd") and Path(path).stem in stems
    }
    copied = files_of(name, runtime="copy")
    files |= {path: file for path, file in copied.items() if is_copy(path)}
    return parts_of(f"safety_cpp/{name}", name, [name], files)


@pytest.mark.parametrize("name", KEPT)
@pytest.mark.essential
def test_files_match_golden(name: str, golden: Golden) -> None:
    """What is of the safety node alone matches, whole or as its difference from another one."""
    both = [part for each in KEPT for part in parts(each)]
    golden.check(f"safety_cpp/{name}", unlike_those_before(f"safety_cpp/{name}", both))


def test_nodes_of_both_languages_differ_only_in_type_name() -> None:
    """Ports and parameters are the same, so that one can replace the other."""
    context = Context(InterfaceStore(), Repository())
    model = context.repository.load(MODELS / "every_thing.deros").model
    assert isinstance(model, Rules)
    python = generate_python(model, context, {})["every_thing_safety/every_thing_safety_node.rnd"]
    files = files_of("every_thing")
    cpp = files["every_thing_safety_cpp/every_thing_safety_node_cpp.rnd"].text
    head = "node every_thing_safety_node : every_thing_safety "
    assert python.text.startswith(head)
    longer = "node every_thing_safety_node_cpp : every_thing_safety_cpp "
    assert cpp == python.text.replace(head, longer)
    described = Repository().load_text("every_thing_safety_node_cpp.rnd", cpp).model
    assert isinstance(described, NodeType)


@pytest.mark.parametrize("package", ["guard", "guard_cpp"])
def test_options_name_the_python_node(package: str) -> None:
    """With or without its suffix, the package is the same."""
    files = files_of("two_rules", package=package, node="watchdog")
    assert "guard_cpp/watchdog_cpp.rnd" in files
    assert "guard_cpp/src/watchdog.cpp" in files


def test_user_files_are_the_manifest_and_the_actions() -> None:
    """All other files are generated again."""
    owned = {path for path, file in files_of("every_thing").items() if file.owner is Owner.USER}
    root = "every_thing_safety_cpp"
    assert owned == {
        f"{root}/package.xml",
        f"{root}/include/{root}/every_thing_safety_node_actions.hpp",
        f"{root}/src/every_thing_safety_node_actions.cpp",
    }


def test_bound_actions_need_no_user_file() -> None:
    """There is no code to write."""
    rules = "action stop publishes true on /stop : std_msgs.Bool;\n"
    files = files_of_text(f"{rules}entity e {{ r: v > 0.5; }} if e.r then {{ stop; }};")
    assert not [path for path in files if "actions" in path]


def test_class_hides_no_method_of_its_base_class() -> None:
    """A topic /state_stop does not collide with the function that publishes /stop."""
    rules = (
        "action stop publishes true on /stop : std_msgs.Bool;\n"
        "action report publishes true on /state_stop : std_msgs.Bool;\n"
        "entity e { r: v > 0.5; } if e.r then { stop; report; };"
    )
    files = files_of_text(rules)
    headers = {Path(path).name: file.text for path, file in files.items() if path.endswith(".hpp")}
    base = headers["text_safety_node_base.hpp"]
    own = re.findall(r"  void (\w+)\([^;]*\);", headers["text_safety_node.hpp"])
    assert "show_state_stop" in own
    assert "publish_state_stop" in base
    assert [name for name in own if re.search(rf"\b{name}\(", base)] == []


def test_argument_of_two_types_is_rejected() -> None:
    """A method has one type for each parameter, whatever the rules pass."""
    rules = (
        'action beep(how); entity e { r: v > 1; s: v > 2; } if e.r then { beep("loud"); };'
        "if e.s then { beep(3); };"
    )
    with pytest.raises(GenerationError, match="several types") as refused:
        files_of_text(rules)
    (diagnostic,) = refused.value.diagnostics
    assert diagnostic.code.name == "DRS402"


@pytest.mark.parametrize("name", ["node", "Node"])
def test_action_cannot_have_the_name_of_the_accessor(name: str) -> None:
    """Only the identical name collides."""
    rules = f"action {name}; entity e {{ r: v > 1; }} if e.r then {{ {name}; }};"
    if name == "node":
        with pytest.raises(GenerationError, match="both become"):
            files_of_text(rules)
    else:
        assert files_of_text(rules)


def test_each_package_has_its_own_namespace() -> None:
    """Nothing of the runtime that it has a copy of is defined outside it."""
    files = files_of("two_rules", runtime="copy")
    assert not [path for path, file in files.items() if "deros_runtime" in file.text.lower()]
    for path, file in files.items():
        if "/runtime/" in path and path.endswith(".cpp"):
            assert "namespace two_rules_safety_cpp::runtime\n" in file.text, path


def test_rules_with_errors_are_rejected() -> None:
    """The generator reports the errors of the rules."""
    with pytest.raises(GenerationError) as refused:
        files_of_text("entity e { r: w > 1; }")
    assert "DRS310" in [diagnostic.code.name for diagnostic in refused.value.diagnostics]


@may_run("cppcheck")
@pytest.mark.parametrize(
    ("name", "options"),
    [
        slow("every_thing", {}),
        ("two_rules", {"copyright": "2026 Jane Doe"}),
        ("calls", {"runtime": "copy", "copyright": "2026 Jane Doe"}),
    ],
)
def test_files_pass_the_ament_linters(name: str, options: dict[str, str], tmp_path: Path) -> None:
    """uncrustify, cpplint and cppcheck with ament's settings accept all files, including C."""
    write(files_of(name, **options), tmp_path)
    assert_cpp_lint_clean(tmp_path / f"{name}_safety_cpp")
