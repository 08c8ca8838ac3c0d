"""The repository: each file once, imports, and every way in which reading a file can fail."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from deros import codes
from deros.diagnostics import Diagnostic
from deros.metamodels.load import LoadedFile, Repository
from deros.metamodels.node import NodeType
from deros.metamodels.rules import Rules
from deros.metamodels.system import Subsystem, System

NODE = "node camera : cameras publishes topic image : sensor_msgs.Image"


def _write(directory: Path, **files: str) -> None:
    for name, text in files.items():
        stem, _, suffix = name.rpartition("_")
        (directory / f"{stem}.{suffix}").write_text(text, encoding="utf-8")


def _only(loaded: LoadedFile) -> Diagnostic:
    (found,) = loaded.diagnostics
    return found


def test_each_file_is_loaded_once(tmp_path: Path) -> None:
    """Two systems that import one node description share the very same node type."""
    _write(
        tmp_path,
        camera_rnd=NODE,
        a_system='system A imports import "camera.rnd" node x : camera',
        b_system='system B imports import "camera.rnd" node y : camera',
    )
    repository = Repository()
    a = repository.load(tmp_path / "a.system").model
    b = repository.load(tmp_path / "b.system").model
    assert isinstance(a, System)
    assert isinstance(b, System)
    assert a.node_types["camera"] is b.node_types["camera"]
    assert len(repository.files) == 3
    assert repository.load(tmp_path / "a.system").model is a


def test_one_file_under_two_names_is_loaded_once(tmp_path: Path) -> None:
    """A symbolic link leads to the same loaded file."""
    _write(tmp_path, camera_rnd=NODE)
    (tmp_path / "link.rnd").symlink_to("camera.rnd")
    repository = Repository()
    assert repository.load(tmp_path / "link.rnd") is repository.load(tmp_path / "camera.rnd")


def test_a_glob_imports_in_order_of_names(tmp_path: Path) -> None:
    """A glob finds all node descriptions of a folder, sorted, and nothing else there."""
    nodes = tmp_path / "nodes"
    nodes.mkdir()
    _write(nodes, b_rnd="node b : p", a_rnd="node a : p", notes_txt="no model")
    _write(tmp_path, x_system='system X imports import "nodes/*" node n : b')
    repository = Repository()
    system = repository.load(tmp_path / "x.system").model
    assert repository.diagnostics == []
    assert isinstance(system, System)
    assert list(system.node_types) == ["a", "b"]


def test_a_glob_that_matches_nothing_is_an_unknown_import(tmp_path: Path) -> None:
    """An empty glob is reported like a missing file."""
    _write(tmp_path, x_system='system X imports import "nodes/*.rnd"')
    assert _only(Repository().load(tmp_path / "x.system")).code is codes.UNKNOWN_IMPORT


def test_a_system_is_used_as_a_subsystem(tmp_path: Path) -> None:
    """``subsystem left : Arm namespace /left`` holds the imported system."""
    _write(
        tmp_path,
        arm_system="system Arm",
        robot_system='system R imports import "arm.system" subsystem left : Arm namespace /left',
    )
    system = Repository().load(tmp_path / "robot.system").model
    assert isinstance(system, System)
    (left,) = system.members
    assert isinstance(left, Subsystem)
    assert left.system is system.systems["Arm"]
    assert (left.system_name, left.namespace) == ("Arm", "/left")


def test_rules_use_a_system(tmp_path: Path) -> None:
    """``use … import`` hands the rules the loaded system."""
    _write(tmp_path, arm_system="system Arm", x_deros='use "arm.system" import Arm')
    rules = Repository().load(tmp_path / "x.deros").model
    assert isinstance(rules, Rules)
    assert rules.name == "x"
    assert rules.uses[0].system is not None


def test_all_unknown_names_are_reported_together(tmp_path: Path) -> None:
    """An unknown node type does not hide the next one, and near names are offered."""
    _write(
        tmp_path,
        camera_rnd=NODE,
        x_system='system X imports import "camera.rnd" '
        "node a : camra node b : Camera subsystem s : Arm node c : camera",
    )
    loaded = Repository().load(tmp_path / "x.system")
    assert [(d.code, d.span.text) for d in loaded.diagnostics] == [
        (codes.UNKNOWN_NODE_TYPE, "camra"),
        (codes.UNKNOWN_NODE_TYPE, "Camera"),
        (codes.UNKNOWN_SYSTEM, "Arm"),
    ]
    assert "'camera'" in loaded.diagnostics[0].hint
    assert "'camera'" in loaded.diagnostics[1].hint


def test_an_unknown_used_system(tmp_path: Path) -> None:
    """A ``use`` that names no system of its file is reported at the name."""
    _write(tmp_path, arm_system="system Arm", x_deros='use "arm.system" import Amr')
    found = _only(Repository().load(tmp_path / "x.deros"))
    assert (found.code, found.span.text) == (codes.UNKNOWN_USED_SYSTEM, "Amr")
    assert "'Arm'" in found.hint


def test_a_missing_import_names_the_near_file(tmp_path: Path) -> None:
    """The hint of a missing file is the name of one that is there, and nothing follows from it."""
    _write(
        tmp_path, camera_rnd=NODE, x_system='system X imports import "camra.rnd" node a : camera'
    )
    found = _only(Repository().load(tmp_path / "x.system"))
    assert (found.code, found.span.text) == (codes.UNKNOWN_IMPORT, '"camra.rnd"')
    assert "'camera.rnd'" in found.hint


@pytest.mark.parametrize(
    "name",
    ["a" * 5000 + ".rnd", "a/" * 3000 + "*.rnd", "[.rnd", "*.rnd", "~/nix/*.rnd", ".rnd"],
)
def test_names_that_no_file_can_have(tmp_path: Path, name: str) -> None:
    """Whatever stands between the quotes, an import that leads nowhere is one finding."""
    loaded = Repository().load_text(tmp_path / "x.system", f'system X imports import "{name}"')
    assert _only(loaded).code is codes.UNKNOWN_IMPORT


@pytest.mark.parametrize("name", ["a\0.rnd", "a" * 5000 + ".rnd"])
def test_paths_that_no_file_can_have(name: str) -> None:
    """A path that the system refuses is an unreadable file."""
    assert _only(Repository().load(name)).code is codes.UNREADABLE_FILE


def test_an_import_from_a_missing_folder(tmp_path: Path) -> None:
    """Where the folder is missing too, the hint says so."""
    _write(tmp_path, x_system='system X imports import "nix/camera.rnd"')
    assert "no folder" in _only(Repository().load(tmp_path / "x.system")).hint


def test_only_models_can_be_imported(tmp_path: Path) -> None:
    """Rules cannot be imported into a system."""
    _write(tmp_path, a_deros="action stop;", x_system='system X imports import "a.deros"')
    assert _only(Repository().load(tmp_path / "x.system")).code is codes.UNKNOWN_LANGUAGE


def test_a_broken_import_is_reported_in_its_own_file(tmp_path: Path) -> None:
    """A syntax error stays with the imported file; what it would have defined is not missed."""
    _write(
        tmp_path,
        camera_rnd="node camera",
        x_system='system X imports import "camera.rnd" node a : camera',
    )
    repository = Repository()
    assert repository.load(tmp_path / "x.system").diagnostics == ()
    (found,) = repository.diagnostics
    assert found.code is codes.SYNTAX_ERROR
    assert found.span.file.endswith("camera.rnd")


def test_cyclic_imports_tell_the_chain(tmp_path: Path) -> None:
    """Three systems in a ring are reported once, with every import that closes the ring."""
    _write(
        tmp_path,
        a_system='system A imports import "b.system"',
        b_system='system B imports import "c.system"',
        c_system='system C imports import "a.system"',
    )
    repository = Repository()
    repository.load(tmp_path / "a.system")
    (found,) = repository.diagnostics
    assert found.code is codes.CYCLIC_IMPORT
    assert found.span.file.endswith("c.system")
    assert [Path(each.span.file).name for each in found.related] == ["a.system", "b.system"]
    assert "a.system' → " in found.message


def test_a_system_that_imports_itself(tmp_path: Path) -> None:
    """The shortest ring is one file."""
    _write(tmp_path, a_system='system A imports import "a.system" subsystem s : A')
    assert _only(Repository().load(tmp_path / "a.system")).code is codes.CYCLIC_IMPORT


def test_an_endless_chain_of_imports_is_cut(tmp_path: Path) -> None:
    """A chain of hundreds of systems ends in a diagnostic, not in a recursion error."""
    for number in range(300):
        text = f'system S{number} imports import "s{number + 1}.system"'
        (tmp_path / f"s{number}.system").write_text(text, encoding="utf-8")
    repository = Repository()
    repository.load(tmp_path / "s0.system")
    assert [found.code for found in repository.diagnostics] == [codes.NESTED_TOO_DEEPLY]


def test_a_node_type_defined_twice_is_ambiguous(tmp_path: Path) -> None:
    """A node of a type that two imports define is reported with both places."""
    _write(
        tmp_path,
        a_rnd="node camera : p",
        b_rnd="node camera : q",
        x_system='system X imports import "a.rnd" import "b.rnd" node n : camera',
    )
    found = _only(Repository().load(tmp_path / "x.system"))
    assert found.code is codes.AMBIGUOUS_NODE_TYPE
    assert [Path(each.span.file).name for each in found.related] == ["a.rnd", "b.rnd"]


def test_importing_one_file_twice_is_not_ambiguous(tmp_path: Path) -> None:
    """The same file by name and by glob defines its node type once."""
    _write(
        tmp_path,
        a_rnd="node camera : p",
        x_system='system X imports import "a.rnd" import "*.rnd" node n : camera',
    )
    assert Repository().load(tmp_path / "x.system").diagnostics == ()


def test_imported_paths_are_shown_below_the_current_directory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Paths in diagnostics are as the user named them; those of imports are relative to here."""
    (tmp_path / "nodes").mkdir()
    _write(tmp_path / "nodes", a_rnd="node")
    _write(tmp_path, x_system='system X imports import "./nodes/../nodes/a.rnd"')
    monkeypatch.chdir(tmp_path)
    for name in ("x.system", str(tmp_path / "x.system")):
        repository = Repository()
        assert repository.load(name).path == name
        assert repository.files[0].path == "nodes/a.rnd"


# Files that cannot be read -----------------------------------------------------------------------


def test_a_missing_file(tmp_path: Path) -> None:
    """A file that is not there has no source, and says why."""
    loaded = Repository().load(tmp_path / "nix.rnd")
    assert loaded.source is None
    assert loaded.model is None
    assert _only(loaded).code is codes.UNREADABLE_FILE


def test_a_directory_is_unreadable(tmp_path: Path) -> None:
    """A folder with the name of a model is unreadable."""
    (tmp_path / "a.system").mkdir()
    assert _only(Repository().load(tmp_path / "a.system")).code is codes.UNREADABLE_FILE


def test_a_pipe_is_not_waited_for(tmp_path: Path) -> None:
    """A named pipe that nobody writes to is unreadable at once."""
    os.mkfifo(tmp_path / "a.rnd")
    assert _only(Repository().load(tmp_path / "a.rnd")).code is codes.UNREADABLE_FILE


def test_another_kind_of_file(tmp_path: Path) -> None:
    """A suffix that belongs to none of the languages is reported as such."""
    _write(tmp_path, a_txt="node a : p")
    assert _only(Repository().load(tmp_path / "a.txt")).code is codes.UNKNOWN_LANGUAGE


@pytest.mark.parametrize(
    "data",
    [
        b"node \xff : p",
        "node ä : p".encode("utf-16"),
        b"node a : p\x00",
        os.urandom(64) + b"\x00\xff",
    ],
    ids=["latin-1", "utf-16", "nul", "random"],
)
def test_bytes_that_are_no_text(tmp_path: Path, data: bytes) -> None:
    """Other encodings and binary files are one diagnostic."""
    (tmp_path / "a.rnd").write_bytes(data)
    assert _only(Repository().load(tmp_path / "a.rnd")).code is codes.NOT_UTF8


@pytest.mark.parametrize("text", ["", " \r\n\t", "// nothing\n", "/* nothing */"])
@pytest.mark.parametrize("suffix", ["rnd", "system", "deros"])
def test_an_empty_file(tmp_path: Path, text: str, suffix: str) -> None:
    """A file without a model in it is a syntax error."""
    (tmp_path / f"a.{suffix}").write_text(text, encoding="utf-8")
    assert _only(Repository().load(tmp_path / f"a.{suffix}")).code is codes.SYNTAX_ERROR


def test_a_byte_order_mark_and_windows_line_ends(tmp_path: Path) -> None:
    """A BOM is no part of the text, and CRLF leaves lines and columns as they are."""
    data = b"\xef\xbb\xbf// one\r\nnode a : p\r\nparameters\r\n  name x double\r\n"
    (tmp_path / "a.rnd").write_bytes(data)
    found = _only(Repository().load(tmp_path / "a.rnd"))
    assert (found.span.line, found.span.column, found.span.text) == (4, 10, "double")


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.deros", "entity e { r: " + "(" * 5000 + "a" + ")" * 5000 + "; }"),
        ("a.deros", "if a.b then { " * 5000 + "}" * 5000),
        ("a.deros", "entity e { r: " + "not " * 5000 + "a; }"),
        ("a.deros", "entity e { r: a" + ".abs()" * 5000 + " > 1; }"),
        ("a.system", "system A " + "subsystem s { " * 5000 + "}" * 5000),
        ("a.rnd", "node a : p parameters name x : double[] = " + "[" * 5000),
    ],
    ids=["parentheses", "behaviours", "nots", "calls", "subsystems", "arrays"],
)
def test_deep_nesting_is_a_diagnostic(name: str, text: str) -> None:
    """Five thousand levels end in one diagnostic, never in a recursion error."""
    assert _only(Repository().load_text(name, text)).code is codes.NESTED_TOO_DEEPLY


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.deros", "entity e { r: " + "(" * 95 + "a" + ")" * 95 + "; }"),
        ("a.deros", "if a.b then { " * 95 + "}" * 95),
        ("a.system", "system A " + "subsystem s { " * 95 + "}" * 95),
    ],
)
def test_nesting_up_to_the_limit_is_fine(name: str, text: str) -> None:
    """Ninety-five levels load without a finding."""
    loaded = Repository().load_text(name, text)
    assert loaded.diagnostics == ()
    assert loaded.model is not None


# Texts from an editor ----------------------------------------------------------------------------


def test_load_text_needs_no_file_and_replaces(tmp_path: Path) -> None:
    """A text stands for a file, whatever the disk holds, and a later text replaces it."""
    _write(tmp_path, camera_rnd="node other : p")
    repository = Repository()
    repository.load_text(tmp_path / "camera.rnd", "node")
    loaded = repository.load_text(tmp_path / "camera.rnd", NODE)
    assert isinstance(loaded.model, NodeType)
    assert loaded.model.name == "camera"
    assert repository.load(tmp_path / "camera.rnd") is loaded
    assert repository.diagnostics == []
