"""Generated and hand-written files as one package: ownership, and rejected combinations."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from deros.generators.api.protocol import File, Owner
from deros.generators.output.banner import with_banner
from deros.generators.output.source_tree import (
    Merged,
    SourceTreeError,
    merge,
    package_folder,
    place,
    remove_stale,
    scaffold,
)

MANIFEST = (
    "<package><name>p</name><depend>rclpy</depend><exec_depend>launch</exec_depend></package>"
)
PYTHON = {
    "p/package.xml": File(MANIFEST),
    "p/setup.py": File("setup()\n"),
    "p/p/__init__.py": File(""),
    "p/p/base.py": File("BASE = 1\n"),
    "p/p/node.py": File("# fill in\n", Owner.USER),
    "p/node.rnd": File("node node : p\n"),
}
CMAKE = {
    "p/package.xml": File(MANIFEST),
    "p/CMakeLists.txt": File("project(p)\n"),
    "p/include/p/node.hpp": File("// fill in\n", Owner.USER),
    "p/src/node.cpp": File("// fill in\n", Owner.USER),
    "p/src/base.cpp": File("int base;\n"),
}


@pytest.fixture
def source(tmp_path: Path) -> Path:
    """Create a source tree with the user files of the Python package."""
    source = tmp_path / "source"
    _write(source, {"package.xml": MANIFEST, "setup.py": "build()\n", "p/node.py": "mine\n"})
    return source


def _write(folder: Path, files: dict[str, str]) -> None:
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)


def _merge(files: dict[str, File], source: Path) -> Merged:
    return merge(files, source, source / "made here/out")


def test_user_files_join_the_package(source: Path) -> None:
    """All files of the source tree join the package, except build scripts and models."""
    more = ["p/more.py", "p/sub/x.py", "config/mine.yaml", "README.md", "p/__init__.py"]
    others = [
        ".git/x",
        ".hidden",
        "build/x.py",
        "p/__pycache__/x.pyc",
        "made here/x",
        "sub/package.xml",
        "a.rnd",
    ]
    _write(source, dict.fromkeys([*more, *others], "mine\n"))
    merged = _merge(PYTHON, source)
    assert {each.path for each in merged.placed} == {
        *("p/package.xml", "p/p/node.py", *(f"p/{name}" for name in more))
    }
    assert set(merged.files) == {"p/setup.py", "p/p/base.py", "p/node.rnd"}
    assert {source, source / "p", source / "p/sub", source / "config"} <= set(merged.inputs)


def test_missing_user_files_are_named(source: Path) -> None:
    """The user files are required by name, and not created."""
    (source / "p/node.py").unlink()
    (source / "package.xml").unlink()
    with pytest.raises(SourceTreeError, match=r"lacks p/node\.py, package\.xml") as error:
        _merge(PYTHON, source)
    assert error.value.mended_by_scaffold


def test_outdated_generated_file_in_the_source_tree_is_rejected(source: Path) -> None:
    """It would shadow the current file, or be shadowed by it."""
    _write(source, {"p/base.py": with_banner("base.py", "BASE = 1\n")})
    _merge(PYTHON, source)
    _write(source, {"p/base.py": with_banner("base.py", "BASE = 0\n")})
    with pytest.raises(SourceTreeError, match="not generated from the present version"):
        _merge(PYTHON, source)


def test_outdated_generated_description_is_rejected(source: Path) -> None:
    """A description generated from rules must be current; a hand-written one is not checked."""
    _write(source, {"models/node.rnd": with_banner("node.rnd", "node node : p\n")})
    _merge(PYTHON, source)
    _write(source, {"models/node.rnd": with_banner("node.rnd", "node old : p\n")})
    with pytest.raises(
        SourceTreeError, match=r"models/node\.rnd was not generated from the present version"
    ):
        _merge(PYTHON, source)
    _write(source, {"models/node.rnd": "node by_hand : p\n"})
    _merge(PYTHON, source)


@pytest.mark.parametrize(
    ("manifest", "complaint"),
    [
        (
            MANIFEST.replace("<name>p", "<name>q"),
            "of package 'q', but the generated package is 'p'",
        ),
        (MANIFEST.replace(">rclpy<", ">x<"), "lacks <depend> tags for .*: rclpy"),
        ("<package>", "cannot be read"),
    ],
)
def test_manifest_must_fit_the_package(source: Path, manifest: str, complaint: str) -> None:
    """The manifest is a user file, but must contain the package name and its dependencies."""
    (source / "package.xml").write_text(manifest)
    with pytest.raises(SourceTreeError, match=complaint):
        _merge(PYTHON, source)


def test_python_files_are_linked_and_cmake_files_copied(source: Path, tmp_path: Path) -> None:
    """CMake installs a link as a link, which is broken on another machine."""
    _write(source, {"src/node.cpp": "mine\n", "include/p/node.hpp": "mine\n"})
    for files, linked in ((PYTHON, {"p/package.xml", "p/p/node.py"}), (CMAKE, {"p/src/node.cpp"})):
        output = tmp_path / f"out{len(linked)}"
        merged = _merge(files, source)
        place(merged.placed, output)
        links = {p.relative_to(output).as_posix() for p in output.rglob("*") if p.is_symlink()}
        assert linked <= links
        assert ("p/include/p/node.hpp" in links) == (files is PYTHON)
        for each in merged.placed:
            assert (output / each.path).read_text() == each.source.read_text()
    assert source / "include/p/node.hpp" in _merge(CMAKE, source).inputs
    assert source / "src/node.cpp" not in _merge(CMAKE, source).inputs


def test_current_links_and_copies_are_not_touched(source: Path, tmp_path: Path) -> None:
    """A changed source, or mode, is copied again."""
    header = source / "include/p/node.hpp"
    _write(source, {"src/node.cpp": "mine\n", "include/p/node.hpp": "mine\n"})
    output = tmp_path / "out"
    placed = _merge(CMAKE, source).placed

    def states() -> dict[str, tuple[int, int]]:
        stats = [(each.path, os.lstat(output / each.path)) for each in placed]
        return {path: (state.st_ino, state.st_mtime_ns) for path, state in stats}

    place(placed, output)
    before = states()
    place(placed, output)
    assert states() == before
    header.write_text("changed\n")
    header.chmod(0o755)
    place(placed, output)
    assert {path for path, state in states().items() if before[path] != state} == {
        "p/include/p/node.hpp"
    }
    copy = output / "p/include/p/node.hpp"
    assert copy.read_text() == "changed\n"
    assert os.access(copy, os.X_OK)


def test_links_survive_moving_both_trees(source: Path, tmp_path: Path) -> None:
    """A workspace mounted elsewhere, as in a container, still finds its files."""
    output = source / ".deros"
    place(_merge(PYTHON, source).placed, output)
    moved = source.rename(tmp_path / "moved")
    assert (moved / ".deros/p/p/node.py").read_text() == "mine\n"


def test_output_that_is_not_a_package(tmp_path: Path) -> None:
    """Of other outputs, only the user files are expected in the source tree."""
    files = {"a.py": File("x\n"), "b/mine.py": File("fill in\n", Owner.USER)}
    assert package_folder(files) == ""
    with pytest.raises(SourceTreeError, match=r"lacks b/mine\.py"):
        _merge(files, tmp_path)
    _write(tmp_path, {"b/mine.py": "mine\n", "other.py": ""})
    merged = _merge(files, tmp_path)
    assert [each.path for each in merged.placed] == ["b/mine.py"]
    assert set(merged.files) == {"a.py"}


def test_scaffold_contains_the_user_files(source: Path) -> None:
    """Manifest, hand-written files and descriptions are written; other files only if they exist."""
    assert set(scaffold(PYTHON, source, "models")) == {
        "package.xml",
        "p/node.py",
        "models/node.rnd",
    }
    _write(source, {"p/base.py": "old\n", "models/node.rnd": "node by_hand : p\n"})
    assert set(scaffold(PYTHON, source, "models")) == {"package.xml", "p/node.py", "p/base.py"}


def test_stale_files_are_removed_with_their_folders(source: Path, tmp_path: Path) -> None:
    """Links, unedited files and empty files are removed; edited ones only with overwrite."""
    output = tmp_path / "out"
    generated = with_banner("x.py", "x = 1\n")
    _write(output, {"a/b/x.py": generated, "a/empty": "", "edited.py": generated + "# mine\n"})
    (output / "a/link").symlink_to(source / "p/node.py")
    stale = ["a/b/x.py", "a/empty", "a/link", "edited.py", "never/was", "../source/p/node.py"]
    remove_stale(stale, output, overwrite=False)
    assert [path.name for path in output.rglob("*")] == ["edited.py"]
    remove_stale(stale, output, overwrite=True)
    assert list(output.iterdir()) == []
    assert (source / "p/node.py").exists()
