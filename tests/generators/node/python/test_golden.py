"""The generated packages, compared with golden files and checked with ament's linters."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
import yaml
from ament_flake8.main import main_with_errors as ament_flake8
from ament_pep257.main import main as ament_pep257

from deros.generators.api.protocol import Files, Owner
from deros.generators.node.python.generate import generate
from deros.generators.output.writer import write
from tests.support.generating import output_of
from tests.support.golden import Golden
from tests.support.golden_packages import SIMPLEST_FIRST, packages_kept
from tests.support.lint import assert_lint_clean

MODELS = Path(__file__).resolve().parent / "models"
NAMES = ["odometry_node", "valve", "dock", "talker", "counter", "mapper"]
COPYRIGHT = {"copyright": "2026 Jane Doe", "maintainer": "Jane Doe <jane@example.org>"}


def files_of(name: str, options: dict[str, str] | None = None) -> Files:
    """Return the generated files of one of the models."""
    return output_of(generate, MODELS / f"{name}.rnd", **(options or {}))


@pytest.fixture(scope="module")
def packages(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Create a folder with the package of every model."""
    folder = tmp_path_factory.mktemp("packages")
    for name in NAMES:
        write(files_of(name), folder)
    return folder


@pytest.mark.parametrize("name", SIMPLEST_FIRST["rosnode_python"])
def test_package_matches_golden(name: str, golden: Golden) -> None:
    """Every generated file matches the reviewed text, or its difference from another one."""
    golden.check(f"rosnode_python/{name}", packages_kept(f"rosnode_python/{name}"))


def test_package_is_independent_of_the_node_order() -> None:
    """Either node of a package leads to the same package with both nodes."""
    assert files_of("talker") == files_of("listener")
    setup = files_of("talker")["chat/setup.py"].text
    assert "'listener = chat.listener:main'" in setup
    assert "'talker = chat.talker:main'" in setup


def test_generation_is_deterministic() -> None:
    """Another interpreter, with other hashes, generates the same bytes."""
    script = (
        "import sys; sys.path.insert(0, '.');"
        "from deros.generators.builtin import rosnode_python as g;"
        "from deros.generators.api.protocol import Context;"
        "from deros.metamodels.load import Repository; r = Repository();"
        f"f = g(r.load({str(MODELS / 'odometry_node.rnd')!r}).model, Context(None, r));"
        "print('\\0'.join(p + '\\0' + f[p].text for p in f), end='')"
    )
    outputs = {
        subprocess.run(
            [sys.executable, "-c", script],
            env={"PYTHONHASHSEED": seed, "PATH": "/usr/bin:/bin", "HOME": "/nonexistent"},
            cwd=MODELS,
            capture_output=True,
            check=True,
        ).stdout
        for seed in ("1", "2")
    }
    assert len(outputs) == 1
    assert str(MODELS).encode() not in outputs.pop()


def test_user_files_are_manifest_and_node_module() -> None:
    """All other files belong to the generator."""
    files = files_of("odometry_node")
    users = [path for path, file in files.items() if file.owner is Owner.USER]
    assert sorted(users) == [
        "differential_odometry/differential_odometry/odometry_node.py",
        "differential_odometry/package.xml",
    ]


def test_user_class_overrides_every_handler(packages: Path) -> None:
    """The user file has a method for each abstract one, with the same signature."""
    for base in packages.glob("*/*/*_base.py"):
        user = base.with_name(base.name.replace("_base.py", ".py"))
        abstract = _methods(
            base, lambda f: any(ast.unparse(d) == "abstractmethod" for d in f.decorator_list)
        )
        assert abstract == _methods(
            user, lambda f: f.name != "main" and f.args.args[0].arg == "self"
        )


def _methods(path: Path, wanted: Callable[[ast.FunctionDef], bool]) -> dict[str, str]:
    tree = ast.parse(path.read_text())
    functions = (node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef))
    return {f.name: ast.unparse(f.args) for f in functions if f.name != "main" and wanted(f)}


# Linters ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("options", [{}, COPYRIGHT], ids=["plain", "copyright"])
def test_packages_pass_the_ament_linters(options: dict[str, str], tmp_path: Path) -> None:
    """flake8 and pep257 with ament's settings find nothing in any file."""
    for name in NAMES:
        write(files_of(name, options), tmp_path)
    assert_lint_clean(tmp_path)


def test_long_names_pass_the_linters(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Names of maximum length and hostile descriptions still give a clean package."""
    long = "n" * 200
    text = (
        f'node talker : chat "Say \\\\d \\"\\"\\" and more, {"very " * 40}often"\n'
        f'parameters name {long} : string = "{long}" one_of ["{long}", "b"] "it\'s {long}"\n'
        f"publishes topic {long}/a : std_msgs.String\n"
        f'subscribes topic {long}/b : std_msgs.String via {long} qos sensor_data "about {long}"\n'
        f"services service {long} : std_srvs.Trigger\n"
        f"timers timer {long} every 3 ns\n"
    )
    write(output_of(generate, tmp_path / "long.rnd", text), tmp_path)
    monkeypatch.chdir(tmp_path)
    assert ament_flake8(argv=[]) == (0, [])
    assert ament_pep257(argv=["."]) == 0


def test_types_are_consistent(packages: Path) -> None:
    """The generated code passes mypy with the settings of ament_mypy."""
    modules = sorted(str(p) for p in packages.glob("*/*/*.py") if p.parent.name == p.parts[-3])
    options = ["--ignore-missing-imports", "--config-file=", "--check-untyped-defs"]
    command = [sys.executable, "-m", "mypy", *options, *modules]
    env_path = ":".join(str(path) for path in sorted(packages.iterdir()))
    done = subprocess.run(
        command, cwd=packages, env={"MYPYPATH": env_path}, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr


# Other files --------------------------------------------------------------------------------------


def test_package_xml_lists_all_dependencies(packages: Path) -> None:
    """The manifest is well-formed, has format 3, and depends on each message package."""
    root = ElementTree.parse(packages / "differential_odometry/package.xml").getroot()
    assert root.get("format") == "3"
    depends = {element.text for element in root.findall("exec_depend")}
    assert depends >= {"rclpy", "nav_msgs", "sensor_msgs", "std_msgs", "std_srvs", "launch_ros"}
    assert [element.text for element in root.findall("license")] == ["Apache-2.0"]


def test_parameter_file_contains_the_defaults(packages: Path) -> None:
    """It is YAML that ROS 2 reads; values that it cannot represent are omitted."""
    config: Any = yaml.safe_load(
        (packages / "differential_odometry/config/odometry_node.yaml").read_text()
    )
    assert config["/**"]["ros__parameters"] == {
        "wheel_base": 0.52,
        "scale": 1.0,
        "ticks_per_turn": 512,
        "mode": "auto",
        "gains": [1.0, 0.1, 0.0],
        "imu_topic": "/fmInformation/imu",
    }
