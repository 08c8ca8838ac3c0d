"""The project file: its settings, the precedence of the command line, and findings about it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from deros import codes
from deros.diagnostics import Code
from deros.interfaces.files import read_regular
from deros.pipeline.project import project_of, projects_of
from tests.support.cli import Outcome, deros

NODE = "node talker : talking\npublishes\n  topic out : own_msgs.State\n"
PLAIN = "node plain : plain_nodes\npublishes\n  topic out : std_msgs.Bool\n"
UNUSED = "system Lone\ntopics\n  topic /a\n"


@pytest.fixture(autouse=True)
def _in_own_directory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name, text in (
        ("models/talker.rnd", NODE),
        ("models/plain.rnd", PLAIN),
        ("models/deep/lone.system", UNUSED),
        ("msgs/own_msgs/msg/State.msg", "float64 charge\n"),
    ):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


def _project(text: str, shared: bool = False) -> None:
    if shared:
        Path("pyproject.toml").write_text(f'[project]\nname = "x"\n\n[tool.deros]\n{text}')
    else:
        Path("deros.toml").write_text(text)


def _findings(*arguments: str) -> list[tuple[str, str, int]]:
    outcome = deros("check", "--format", "json", *arguments)
    return [(d["code"], d["file"], d["line"]) for d in json.loads(outcome.out)]


@pytest.mark.parametrize("shared", [False, True])
def test_interfaces_come_from_the_project_file(shared: bool) -> None:
    """The nearest file above the model applies, from any working directory."""
    assert [code for code, *_ in _findings("models/talker.rnd")] == ["DRS101"]
    _project('interfaces = ["msgs"]\n', shared)
    assert _findings("models/talker.rnd") == []


def test_all_commands_use_the_interfaces_of_the_project() -> None:
    """Simulating, graphing, starting and generating find the same definitions."""
    _project('interfaces = ["msgs"]\n')
    Path("models/s.system").write_text(
        'system S\nimports import "talker.rnd"\ntopics external topic /out : own_msgs.State\n'
        "node talker : talker wirings connect out to /out\n"
    )
    Path("models/r.deros").write_text(
        'use "s.system" import S\naction stop publishes true on /stop : std_msgs.Bool latched;\n'
        "input c = topic /out.charge timeout 1 sec\nentity e { low: c < 1 or c.missing(); }\n"
        "if e.low then { stop; };\n"
    )
    Path("t.jsonl").write_text('{"t": "0.1", "topic": "/out", "data": {"charge": 0.5}}\n')
    assert deros("check", "models/s.system").code == 0
    assert deros("graph", "models/s.system").code == 0
    assert (
        deros("up", "models/s.system", "--dry-run", "--package-path", ".").code == 2
    )  # there is no program to start
    simulated = deros("simulate", "models/r.deros", "--trace", "t.jsonl")
    assert (simulated.code, "trigger" in simulated.out) == (0, True)
    assert deros("generate", "models/s.system", "--target", "launch", "-o", "out").code == 0
    assert deros("generate", "models/talker.rnd", "--target", "python", "-o", "out").code == 0


def test_command_line_overrides_the_project_file() -> None:
    """This holds for interfaces, options, target and output."""
    _project(
        'output = "ws"\ncopyright = "2020 Project"\nmaintainer = "P <p@example.com>"\n'
        '[targets]\nrnd = "python"\n'
    )
    assert deros("generate", "models/plain.rnd").code == 0
    assert "2020 Project" in Path("ws/plain_nodes/setup.py").read_text()
    outcome = deros(
        "generate", "models/plain.rnd", "--target", "cpp", "-o", "own", "--copyright", "2021 Me"
    )
    assert outcome.code == 0
    assert "2021 Me" in Path("own/plain_nodes/src/plain_base.cpp").read_text()
    assert "p@example.com" in Path("own/plain_nodes/package.xml").read_text()


@pytest.mark.parametrize("target", ["python", "cpp"])
def test_licence_is_that_of_the_project(target: str) -> None:
    """It is in the manifest, and above each file if there is a copyright holder."""
    _project('licence = "BSD-3-Clause"\ncopyright = "2020 P"\n')
    assert deros("generate", "models/plain.rnd", "--target", target, "-o", "ws").code == 0
    manifest = Path("ws/plain_nodes/package.xml").read_text()
    assert "<license>BSD-3-Clause</license>" in manifest
    assert "copyright" not in manifest  # ament's test uses other words for it
    texts = [p.read_text() for p in Path("ws").rglob("*.py" if target == "python" else "*.cpp")]
    for text in filter(None, texts):
        assert "SPDX-License-Identifier: BSD-3-Clause" in text
        assert "Apache" not in text


@pytest.mark.parametrize("licence", ["", "x\ny", "a;b", "*/"])
def test_licence_must_be_an_spdx_identifier(licence: str) -> None:
    """Other text would not be valid in a manifest or a comment."""
    outcome = deros("generate", "models/plain.rnd", "--target", "cpp", "--licence", licence)
    assert outcome.code == 2
    assert "SPDX" in outcome.err


def test_copyright_cannot_leave_its_comment() -> None:
    """A project file from a third party cannot inject code into generated files."""
    _project('copyright = "2020 P\\nimport os"\n')
    assert deros("generate", "models/plain.rnd", "--target", "python", "-o", "ws").code == 0
    assert "# Copyright 2020 P import os\n" in Path("ws/plain_nodes/setup.py").read_text()
    _project('copyright = "2020 P \\\\"\n')
    assert deros("generate", "models/plain.rnd", "--target", "cpp", "-o", "ws").code == 2


def _allow(code: str = "DRS212", path: str = "models/**", reason: str = "known") -> str:
    return f'[[allow]]\ncode = "{code}"\npath = "{path}"\nreason = "{reason}"\n'


@pytest.mark.parametrize("shared", [False, True])
def test_project_allows_by_code_and_path(shared: bool) -> None:
    """Matching files give no findings; SARIF lists the entry as an external suppression."""
    assert [code for code, *_ in _findings("models/deep/lone.system")] == ["DRS212"]
    allowance = _allow()
    _project(allowance.replace("[[allow", "[[tool.deros.allow") if shared else allowance, shared)
    assert _findings("models/deep/lone.system") == []
    log = json.loads(deros("check", "--format", "sarif", "models/deep/lone.system").out)
    (suppression,) = log["runs"][0]["results"][0]["suppressions"]
    assert (suppression["kind"], suppression["justification"]) == ("external", "known")
    _project(_allow(code="unused-topic"))
    assert _findings("models/deep/lone.system") == []
    _project(_allow(path="models/*"))
    assert [code for code, *_ in _findings("models/deep/lone.system")] == ["DRS212"]


@pytest.mark.parametrize(
    ("text", "code"),
    [
        (_allow(code="DRS999"), codes.NOT_ALLOWABLE),
        (_allow(code="DRS103"), codes.NOT_ALLOWABLE),
        (_allow(code="wrong-default"), codes.NOT_ALLOWABLE),
        (_allow(code="unused-topik"), codes.NOT_ALLOWABLE),
        (_allow(reason=" "), codes.BAD_ALLOWANCE),
        ('[[allow]]\ncode = "DRS212"\nreason = "known"\n', codes.BAD_ALLOWANCE),
        ('allow = "DRS212"\n', codes.BAD_PROJECT_VALUE),
        (_allow() + 'why = "x"\n', codes.UNKNOWN_PROJECT_KEY),
        ('interface = ["msgs"]\n', codes.UNKNOWN_PROJECT_KEY),
        ('license = "MIT"\n', codes.UNKNOWN_PROJECT_KEY),
        ('[targets]\nnode = "python"\n', codes.UNKNOWN_PROJECT_KEY),
        ('interfaces = "msgs"\n', codes.BAD_PROJECT_VALUE),
        ('interfaces = ["nowhere"]\n', codes.BAD_PROJECT_VALUE),
        ("[targets]\nrnd = 1\n", codes.BAD_PROJECT_VALUE),
        ("targets = 1\n", codes.BAD_PROJECT_VALUE),
        ("copyright = 2026\n", codes.BAD_PROJECT_VALUE),
        ('output = "../elsewhere"\n', codes.BAD_PROJECT_VALUE),
        ('output = "/tmp/elsewhere"\n', codes.BAD_PROJECT_VALUE),
        ("output = []\n", codes.BAD_PROJECT_VALUE),
        ("interfaces = [\n", codes.UNREADABLE_PROJECT),
        ('copyright = "\udcff"\n', codes.UNREADABLE_PROJECT),
    ],
)
def test_faults_in_the_project_file_are_findings(text: str, code: Code) -> None:
    """They point into the project file, and ``generate`` reports them too."""
    Path("deros.toml").write_bytes(text.encode(errors="surrogateescape"))
    findings = [(c, f) for c, f, _ in _findings("models/plain.rnd")]
    assert (code.name, "deros.toml") in findings
    outcome = deros("generate", "models/plain.rnd", "--target", "python", "-o", "ws")
    assert code.name in outcome.err
    assert (outcome.code == 0) == (
        not any(codes.ALL_CODES[c].severity.value == "error" for c, _ in findings)
    )


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("[tool]\nderos.output = 1\n", codes.BAD_PROJECT_VALUE),
        ("[tool]\nderos = {output = 1}\n", codes.BAD_PROJECT_VALUE),
        ("[[tool]]\n[tool.deros]\noutput = 1\n", codes.BAD_PROJECT_VALUE),
        ("[[tool.deros]]\n", codes.BAD_PROJECT_VALUE),
        ("[tool]\nderos = 1\n", codes.BAD_PROJECT_VALUE),
        ("[tool.deros\n", None),
        ('tool = "deros"\n', None),
        ('tool = "deros\n', None),
    ],
)
def test_table_in_pyproject_may_have_any_notation(text: str, expected: Code | None) -> None:
    """A value that is not a table is a finding; a file without the table is ignored."""
    Path("pyproject.toml").write_text(text)
    findings = [(code, file) for code, file, _ in _findings("models/plain.rnd")]
    assert findings == ([] if expected is None else [(expected.name, "pyproject.toml")])


def test_finding_has_the_line_of_the_key_and_similar_keys() -> None:
    """The place is that of the key."""
    _project('copyright = "2020 P"\nmaintaner = "P <p@example.com>"\n')
    outcome = deros("check", "models/plain.rnd")
    assert "deros.toml:2:1: warning[DRS026 unknown-project-key]" in outcome.out
    assert "did you mean 'maintainer'?" in outcome.out


def test_mistyped_slug_gets_suggestions() -> None:
    """An allowance with a slug that does not exist names the nearest one."""
    _project(_allow(code="unused-topik"))
    assert "did you mean 'unused-topic'" in deros("check", "models/plain.rnd").out


def test_nearest_file_with_the_table_applies() -> None:
    """A pyproject.toml without the table, or with other syntax errors, is skipped."""
    _project('copyright = "above"\n')
    Path("models/pyproject.toml").write_text("[tool.ruff]\n")
    assert project_of("models/plain.rnd").options == {"copyright": "above"}
    Path("models/pyproject.toml").write_text("[tool.ruff\n")
    assert project_of("models/plain.rnd").options == {"copyright": "above"}
    Path("models/pyproject.toml").write_text('[tool.deros]\ncopyright = "near"\n')
    assert project_of("models/plain.rnd").options == {"copyright": "near"}
    assert project_of("models/deep").options == {"copyright": "near"}
    assert project_of("msgs/own_msgs").options == {"copyright": "above"}


def test_unneeded_entry_is_reported_for_the_whole_project_only() -> None:
    """Checking one file gives no finding about entries for others."""
    _project(_allow() + _allow(code="DRS211", path="vendor/**"))
    Path("models/talker.rnd").unlink()
    assert _findings("models/plain.rnd") == []
    assert _findings("models") == []
    assert _findings(".") == [("DRS022", "deros.toml", 5)]


def _depends(outcome: Outcome) -> str:
    assert outcome.code == 0, outcome
    return Path("d").read_text()


def test_depfile_contains_the_project_file() -> None:
    """A changed project file triggers generation."""
    command = ("generate", "models/plain.rnd", "--target", "python", "-o", "ws", "--depfile", "d")
    assert "deros.toml" not in _depends(deros(*command))
    _project('copyright = "2020 P"\n')
    assert str(Path("deros.toml").absolute()) in _depends(deros(*command))


def test_each_project_file_is_read_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """A pyproject.toml is read and parsed once for all models of a run."""
    Path("pyproject.toml").write_text('[tool.deros]\ninterfaces = ["msgs"]\n')
    read: list[str] = []
    genuine = read_regular

    def counting(path: Path, most: int) -> bytes:
        read.append(path.name)
        return genuine(path, most)

    monkeypatch.setattr("deros.pipeline.project.read_regular", counting)
    (found,) = projects_of(["models/plain.rnd", "models/deep/lone.system"])
    assert [folder.name for folder in found.interfaces] == ["msgs"]
    assert read == ["pyproject.toml"]
