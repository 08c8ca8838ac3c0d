"""Packages import downward only, and each heavy library has one home."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections import Counter
from functools import cache
from pathlib import Path

import networkx
import pytest

from tests.support.imports import imports

ROOT = Path(__file__).resolve().parent.parent
SOURCE = ROOT / "src" / "deros"

HOMES = {
    "textx": {"metamodels"},
    "arpeggio": {"metamodels"},
    "networkx": {"validators"},
    "pint": {"interfaces"},
    "rapidfuzz": {"names"},
    "rosbags": {"importers", "interfaces"},
    "jinja2": {"generators"},
    "click": {"cli"},
    "rich": {"cli", "report"},
    "pygments": {"formatting"},
    "rclpy": {"live"},
    "yaml": {"metamodels"},
    "launch": set[str](),
    "launch_ros": set[str](),
}
"""Packages that may import a library; generated code, with its imports of ``rclpy``, is text."""

_RUNTIME = "deros.generators.runtime.python.deros_runtime"
_TEXT = (
    f"{_RUNTIME}.",
    "deros.generators.system.script.standalone.",
    "deros.importers.launch.python_files.visit.",
)
"""Packages whose modules run in generated packages, or in a process that has launch."""


@cache
def _modules() -> list[Path]:
    return sorted(SOURCE.rglob("*.py"))


@pytest.mark.essential
def test_packages_import_downward_only() -> None:
    """The contract in pyproject.toml holds for every import of every module."""
    command = [str(Path(sys.executable).with_name("lint-imports")), "--no-cache"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize("library", HOMES)
def test_each_library_has_one_home(library: str) -> None:
    """No package but its home imports a library, not even lazily."""
    strangers = {
        name
        for name in imports().find_modules_that_directly_import(library)
        if not f"{name}.".startswith(_TEXT) and name.split(".")[1] not in HOMES[library]
    }
    assert strangers == set()


def test_generators_import_each_other_through_interfaces() -> None:
    """Names outside the interface of a part may change at any time."""
    shared = ("api", "output", "text", "user_files")
    strangers = {
        f"{module} imports {name}"
        for module in imports().modules
        if _is_part(own := _part(module))
        for name in imports().find_modules_directly_imported_by(module)
        if _is_part(other := _part(name))
        and other[: len(own)] != own
        and own[: len(other)] != other
        and other[0] not in shared
        and not name.endswith(".interface")
    }
    assert strangers == set()


def test_logic_of_gates_needs_only_python() -> None:
    """It runs here and in generated packages."""
    for name, own in (
        ("gate_logic", {"gate_limits", "gate_ramps", "gate_sources", "gate_table"}),
        ("gate_limits", {"gate_sources", "gate_table"}),
        ("gate_ramps", {"gate_limits", "gate_table"}),
        ("gate_sources", {"gate_table"}),
        ("gate_table", set()),
    ):
        imported = imports().find_modules_directly_imported_by(f"{_RUNTIME}.{name}")
        assert imported <= sys.stdlib_module_names | {f"{_RUNTIME}.{each}" for each in own}


def _part(module: str) -> tuple[str, ...]:
    """Return the part of the generators that a module belongs to, with its language if any."""
    if not module.startswith("deros.generators."):
        return ()
    thing, *rest = module.split(".")[2:]
    return (thing, *rest[:1]) if rest[:1] and rest[0] in ("python", "c", "cpp") else (thing,)


def _is_part(part: tuple[str, ...]) -> bool:
    return bool(part) and (SOURCE / "generators" / part[0]).is_dir()


def test_importing_deros_loads_no_heavy_modules() -> None:
    """``import deros`` and the command overview load no third-party library but click."""
    script = (
        "import sys; import deros, deros.codes, deros.diagnostics, deros.cli.main;"
        "print(*sorted({name.split('.')[0] for name in sys.modules}))"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    loaded = set(done.stdout.split())
    assert loaded.isdisjoint(set(HOMES) - {"click"})


_ASKS = {
    *("is_file", "is_dir", "is_symlink", "iterdir", "rglob", "read_text", "read_bytes"),
    *("stat", "lstat", "samefile", "scandir", "listdir", "walk", "realpath", "readlink"),
    *("isfile", "isdir", "islink", "lexists", "getmtime"),
}
"""The functions of ``os``, ``os.path`` and ``pathlib`` that ask the file system."""

_OWN_DATA = {"embedded.py", "rep103.py", "standard_topics.py", "units.py"}
"""Modules of the interfaces that read tables of deros itself."""


@pytest.mark.essential
def test_checks_ask_the_file_system_in_one_place() -> None:
    """What a check rests on is known, so that its findings can be recalled while that is so."""
    rooms = ("interfaces", "models", "metamodels", "names", "systems", "rules", "validators")
    asking = {
        f"{path.relative_to(SOURCE)}: {node.func.attr}"
        for path in _modules()
        if path.relative_to(SOURCE).parts[0] in rooms
        or path.relative_to(SOURCE).as_posix()
        in ("pipeline/workspace.py", "pipeline/project.py", "pipeline/refusals.py", "cli/models.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute)
        if node.func.attr in _ASKS and ast.unparse(node.func.value) != "ast"
        if path != SOURCE / "interfaces/files.py" and path.name not in _OWN_DATA
    }
    assert asking == set()


def test_modules_stay_short() -> None:
    """Every module can be reviewed in one sitting."""
    lengths = {str(p.relative_to(SOURCE)): len(p.read_text().splitlines()) for p in _modules()}
    assert {name: lines for name, lines in lengths.items() if lines > 450} == {}


def test_rooms_stay_small() -> None:
    """A file is found in one guess: a room has few of them, or rooms of its own."""
    rooms = Counter(str(p.parent.relative_to(SOURCE)) for p in _modules() if p.stem != "__init__")
    del rooms["generators/runtime/python/deros_runtime"]  # one package of ROS 2, which is flat
    assert {room: files for room, files in rooms.items() if files > 15} == {}


@pytest.mark.essential
def test_no_modules_import_one_another_in_a_circle() -> None:
    """What a module needs is complete when it is imported; types alone may refer back."""
    executed = imports(of_types=False)
    graph = networkx.DiGraph(
        (module, imported)
        for module in executed.modules
        for imported in executed.find_modules_directly_imported_by(module)
    )
    circles = networkx.strongly_connected_components(graph)
    assert [sorted(circle) for circle in circles if len(circle) > 1] == []
