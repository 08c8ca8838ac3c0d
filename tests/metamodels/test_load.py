"""The repository: each file loaded once, imports, and all ways in which reading a file fails."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from deros import codes
from deros.diagnostics import Diagnostic, SourceFile
from deros.metamodels.languages import DEROS, ROSSYSTEM
from deros.metamodels.load import LoadedFile, Repository
from deros.models.node import NodeType
from deros.models.rules import Rules
from deros.models.system import Subsystem, System

NODE = "node camera : cameras publishes topic image : sensor_msgs.Image"


def _write(directory: Path, **files: str) -> None:
    for name, text in files.items():
        stem, _, suffix = name.rpartition("_")
        (directory / f"{stem}.{suffix}").write_text(text, encoding="utf-8")


def _only(loaded: LoadedFile) -> Diagnostic:
    (found,) = loaded.diagnostics
    return found


def test_each_file_is_loaded_once(tmp_path: Path) -> None:
    """Two systems that import one node description share the same node type."""
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


def test_symbolic_link_is_the_same_file(tmp_path: Path) -> None:
    """A symbolic link leads to the same loaded file."""
    _write(tmp_path, camera_rnd=NODE)
    (tmp_path / "link.rnd").symlink_to("camera.rnd")
    repository = Repository()
    assert repository.load(tmp_path / "link.rnd") is repository.load(tmp_path / "camera.rnd")


def test_glob_imports_sorted_node_descriptions(tmp_path: Path) -> None:
    """A glob imports all node descriptions of a folder, sorted, and nothing else."""
    nodes = tmp_path / "nodes"
    nodes.mkdir()
    _write(nodes, b_rnd="node b : p", a_rnd="node a : p", notes_txt="no model")
    _write(tmp_path, x_system='system X imports import "nodes/*" node n : b')
    repository = Repository()
    system = repository.load(tmp_path / "x.system").model
    assert repository.diagnostics == []
    assert isinstance(system, System)
    assert list(system.node_types) == ["a", "b"]


def test_empty_glob_is_an_unknown_import(tmp_path: Path) -> None:
    """An empty glob is reported like a missing file."""
    _write(tmp_path, x_system='system X imports import "nodes/*.rnd"')
    assert _only(Repository().load(tmp_path / "x.system")).code is codes.UNKNOWN_IMPORT


def test_imported_system_becomes_a_subsystem(tmp_path: Path) -> None:
    """``subsystem left : Arm namespace /left`` refers to the imported system."""
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
    """``use … import`` gives the rules the loaded system."""
    _write(tmp_path, arm_system="system Arm", x_deros='use "arm.system" import Arm')
    rules = Repository().load(tmp_path / "x.deros").model
    assert isinstance(rules, Rules)
    assert rules.name == "x"
    assert rules.uses[0].system is not None


def test_all_unknown_names_are_reported(tmp_path: Path) -> None:
    """An unknown node type does not hide the next one, and similar names are suggested."""
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


def test_part_of_another_file_is_loaded(tmp_path: Path) -> None:
    """It is found under its own path, and its findings name the place that it stands in."""
    text = (
        'system Robot\ntopics\n  external topic /x : std_msgs.Bool\n\nuse "r.system" import Rob\n'
    )
    page = tmp_path / "page.md"
    system, _, rules = text.partition("\n\n")
    above = "\n" * system.count("\n") + "\n\n"
    repository = Repository()
    repository.load_part(tmp_path / "r.system", SourceFile(str(page), system), ROSSYSTEM)
    finding = _only(repository.load_part(page, SourceFile(str(page), above + rules), DEROS))
    assert (finding.code, finding.span.file, finding.span.line) == (
        codes.UNKNOWN_USED_SYSTEM,
        str(page),
        5,
    )
    assert "Robot" in finding.hint


def test_unknown_system_in_use_is_reported(tmp_path: Path) -> None:
    """A ``use`` of a system that the file does not define is reported at the name."""
    _write(tmp_path, arm_system="system Arm", x_deros='use "arm.system" import Amr')
    finding = _only(Repository().load(tmp_path / "x.deros"))
    assert (finding.code, finding.span.text) == (codes.UNKNOWN_USED_SYSTEM, "Amr")
    assert "'Arm'" in finding.hint


def test_missing_import_suggests_a_similar_file(tmp_path: Path) -> None:
    """The hint names an existing file, and there are no further findings."""
    _write(
        tmp_path, camera_rnd=NODE, x_system='system X imports import "camra.rnd" node a : camera'
    )
    finding = _only(Repository().load(tmp_path / "x.system"))
    assert (finding.code, finding.span.text) == (codes.UNKNOWN_IMPORT, '"camra.rnd"')
    assert "'camera.rnd'" in finding.hint


@pytest.mark.parametrize(
    "name",
    ["a" * 5000 + ".rnd", "a/" * 3000 + "*.rnd", "[.rnd", "*.rnd", "~/nix/*.rnd", ".rnd"],
)
def test_impossible_import_path_is_an_unknown_import(tmp_path: Path, name: str) -> None:
    """Any import that cannot be resolved is one finding."""
    loaded = Repository().load_text(tmp_path / "x.system", f'system X imports import "{name}"')
    assert _only(loaded).code is codes.UNKNOWN_IMPORT


@pytest.mark.parametrize("name", ["a\0.rnd", "a" * 5000 + ".rnd"])
def test_impossible_path_is_an_unreadable_file(name: str) -> None:
    """A path that the operating system rejects is an unreadable file."""
    assert _only(Repository().load(name)).code is codes.UNREADABLE_FILE


def test_hint_for_an_import_from_a_missing_folder(tmp_path: Path) -> None:
    """If the folder is missing too, the hint says so."""
    _write(tmp_path, x_system='system X imports import "nix/camera.rnd"')
    assert "does not exist either" in _only(Repository().load(tmp_path / "x.system")).hint


def test_rules_cannot_be_imported_into_a_system(tmp_path: Path) -> None:
    """Only node descriptions and systems can be imported."""
    _write(tmp_path, a_deros="action stop;", x_system='system X imports import "a.deros"')
    assert _only(Repository().load(tmp_path / "x.system")).code is codes.UNKNOWN_LANGUAGE


def test_syntax_error_is_reported_in_the_imported_file(tmp_path: Path) -> None:
    """Names that the broken file would have defined are not reported as missing."""
    _write(
        tmp_path,
        camera_rnd="node camera",
        x_system='system X imports import "camera.rnd" node a : camera',
    )
    repository = Repository()
    assert repository.load(tmp_path / "x.system").diagnostics == ()
    (finding,) = repository.diagnostics
    assert finding.code is codes.SYNTAX_ERROR
    assert finding.span.file.endswith("camera.rnd")


def test_import_cycle_is_reported_with_its_chain(tmp_path: Path) -> None:
    """A cycle of three systems is reported once, with every import in it."""
    _write(
        tmp_path,
        a_system='system A imports import "b.system"',
        b_system='system B imports import "c.system"',
        c_system='system C imports import "a.system"',
    )
    repository = Repository()
    repository.load(tmp_path / "a.system")
    (finding,) = repository.diagnostics
    assert finding.code is codes.CYCLIC_IMPORT
    assert finding.span.file.endswith("c.system")
    assert [Path(each.span.file).name for each in finding.related] == ["a.system", "b.system"]
    assert "a.system' → " in finding.message


def test_system_that_imports_itself(tmp_path: Path) -> None:
    """The shortest cycle is one file."""
    _write(tmp_path, a_system='system A imports import "a.system" subsystem s : A')
    assert _only(Repository().load(tmp_path / "a.system")).code is codes.CYCLIC_IMPORT


def test_long_import_chain_is_rejected(tmp_path: Path) -> None:
    """A chain of hundreds of systems gives a diagnostic, not a recursion error."""
    for number in range(300):
        text = f'system S{number} imports import "s{number + 1}.system"'
        (tmp_path / f"s{number}.system").write_text(text, encoding="utf-8")
    repository = Repository()
    repository.load(tmp_path / "s0.system")
    assert [finding.code for finding in repository.diagnostics] == [codes.NESTED_TOO_DEEPLY]


def test_node_type_defined_twice_is_ambiguous(tmp_path: Path) -> None:
    """A node whose type two imports define is reported with both places."""
    _write(
        tmp_path,
        a_rnd="node camera : p",
        b_rnd="node camera : q",
        x_system='system X imports import "a.rnd" import "b.rnd" node n : camera',
    )
    finding = _only(Repository().load(tmp_path / "x.system"))
    assert finding.code is codes.AMBIGUOUS_NODE_TYPE
    assert [Path(each.span.file).name for each in finding.related] == ["a.rnd", "b.rnd"]


def test_importing_one_file_twice_is_not_ambiguous(tmp_path: Path) -> None:
    """A file imported by name and by glob defines its node type once."""
    _write(
        tmp_path,
        a_rnd="node camera : p",
        x_system='system X imports import "a.rnd" import "*.rnd" node n : camera',
    )
    assert Repository().load(tmp_path / "x.system").diagnostics == ()


def test_imported_paths_are_relative_to_the_working_directory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Diagnostics show named files as the user wrote them, and imports relative to here."""
    (tmp_path / "nodes").mkdir()
    _write(tmp_path / "nodes", a_rnd="node")
    _write(tmp_path, x_system='system X imports import "./nodes/../nodes/a.rnd"')
    monkeypatch.chdir(tmp_path)
    for name in ("x.system", str(tmp_path / "x.system")):
        repository = Repository()
        assert repository.load(name).path == name
        assert repository.files[0].path == "nodes/a.rnd"


# Unreadable files --------------------------------------------------------------------------------


def test_missing_file_is_unreadable(tmp_path: Path) -> None:
    """A missing file has no source, and a finding says why."""
    loaded = Repository().load(tmp_path / "nix.rnd")
    assert loaded.source is None
    assert loaded.model is None
    assert _only(loaded).code is codes.UNREADABLE_FILE


def test_directory_is_unreadable(tmp_path: Path) -> None:
    """A folder named like a model is unreadable."""
    (tmp_path / "a.system").mkdir()
    assert _only(Repository().load(tmp_path / "a.system")).code is codes.UNREADABLE_FILE


def test_named_pipe_does_not_block(tmp_path: Path) -> None:
    """A named pipe without a writer is unreadable at once."""
    os.mkfifo(tmp_path / "a.rnd")
    assert _only(Repository().load(tmp_path / "a.rnd")).code is codes.UNREADABLE_FILE


def test_unknown_suffix_is_reported(tmp_path: Path) -> None:
    """A suffix of no language is reported as such."""
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
def test_bytes_that_are_not_utf8_give_one_finding(tmp_path: Path, data: bytes) -> None:
    """Other encodings and binary files are one diagnostic."""
    (tmp_path / "a.rnd").write_bytes(data)
    assert _only(Repository().load(tmp_path / "a.rnd")).code is codes.NOT_UTF8


@pytest.mark.parametrize("text", ["", " \r\n\t", "// nothing\n", "/* nothing */"])
@pytest.mark.parametrize("suffix", ["rnd", "system", "deros"])
def test_empty_file_is_a_syntax_error(tmp_path: Path, text: str, suffix: str) -> None:
    """A file without a model is a syntax error."""
    (tmp_path / f"a.{suffix}").write_text(text, encoding="utf-8")
    assert _only(Repository().load(tmp_path / f"a.{suffix}")).code is codes.SYNTAX_ERROR


def test_byte_order_mark_and_crlf_keep_positions(tmp_path: Path) -> None:
    """A BOM is not part of the text, and CRLF does not change lines and columns."""
    data = b"\xef\xbb\xbf// one\r\nnode a : p\r\nparameters\r\n  name x double\r\n"
    (tmp_path / "a.rnd").write_bytes(data)
    finding = _only(Repository().load(tmp_path / "a.rnd"))
    assert (finding.span.line, finding.span.column, finding.span.text) == (4, 10, "double")


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
def test_deep_nesting_gives_one_finding(name: str, text: str) -> None:
    """Five thousand levels give one diagnostic, not a recursion error."""
    assert _only(Repository().load_text(name, text)).code is codes.NESTED_TOO_DEEPLY


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.deros", "entity e { r: " + "(" * 95 + "a" + ")" * 95 + "; }"),
        ("a.deros", "if a.b then { " * 95 + "}" * 95),
        ("a.system", "system A " + "subsystem s { " * 95 + "}" * 95),
    ],
)
def test_nesting_up_to_the_limit_is_accepted(name: str, text: str) -> None:
    """Ninety-five levels load without findings."""
    loaded = Repository().load_text(name, text)
    assert loaded.diagnostics == ()
    assert loaded.model is not None


# Text from an editor -----------------------------------------------------------------------------


def test_loaded_text_replaces_the_file(tmp_path: Path) -> None:
    """A text stands in for a file, whether or not it exists, and a later text replaces it."""
    _write(tmp_path, camera_rnd="node other : p")
    repository = Repository()
    repository.load_text(tmp_path / "camera.rnd", "node")
    loaded = repository.load_text(tmp_path / "camera.rnd", NODE)
    assert isinstance(loaded.model, NodeType)
    assert loaded.model.name == "camera"
    assert repository.load(tmp_path / "camera.rnd") is loaded
    assert repository.diagnostics == []


def test_what_is_forgotten_is_read_again_with_all_that_rests_on_it(tmp_path: Path) -> None:
    """A system that imports it, rules that use that; what it does not rest on is kept."""
    _write(
        tmp_path,
        arm_rnd="node Arm : arm\n",
        hand_rnd="node Hand : hand\n",
        robot_system='system R\nimports\n  import "*.rnd"\nnode a : Arm\n',
        rules_deros='use "robot.system" import R\n',
    )
    repository = Repository()
    repository.load(tmp_path / "rules.deros")
    before = {each.path: each for each in repository.files}
    assert len(before) == 4
    repository.forget(tmp_path / "arm.rnd")
    repository.load(tmp_path / "rules.deros")
    kept = {Path(each.path).name for each in repository.files if before[each.path] is each}
    assert kept == {"hand.rnd"}


def test_a_system_and_its_rules_are_forgotten_together(tmp_path: Path) -> None:
    """Each rests on the other: the ``safety`` statement names rules that use the system."""
    _write(
        tmp_path,
        robot_system='system R\nsafety "rules.deros"\n',
        rules_deros='use "robot.system" import R\n',
    )
    for changed in ("robot.system", "rules.deros"):
        repository = Repository()
        repository.load(tmp_path / "robot.system")
        repository.forget(tmp_path / changed)
        assert repository.files == []
