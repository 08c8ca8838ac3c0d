"""The project file: what it sets, that the command line wins, and what is wrong with it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from deros import codes
from deros.diagnostics import Code
from deros.pipeline.project import project_of
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
def test_interfaces_come_from_the_project(shared: bool) -> None:
    """The nearest file above the model counts, wherever the command runs."""
    assert [code for code, *_ in _findings("models/talker.rnd")] == ["DRS101"]
    _project('interfaces = ["msgs"]\n', shared)
    assert _findings("models/talker.rnd") == []


def test_every_command_that_reads_models_knows_them() -> None:
    """Simulating, showing, starting and generating find the same definitions."""
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
    )  # no program
    simulated = deros("simulate", "models/r.deros", "--trace", "t.jsonl")
    assert (simulated.code, "trigger" in simulated.out) == (0, True)
    assert deros("generate", "models/s.system", "--target", "launch", "-o", "out").code == 0
    assert deros("generate", "models/talker.rnd", "--target", "python", "-o", "out").code == 0


def test_the_command_line_wins() -> None:
    """Definitions, options, target and output of the command line go before the project's."""
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
def test_the_licence_is_that_of_the_project(target: str) -> None:
    """It stands in the manifest, and above each file where there is a copyright holder."""
    _project('licence = "BSD-3-Clause"\ncopyright = "2020 P"\n')
    assert deros("generate", "models/plain.rnd", "--target", target, "-o", "ws").code == 0
    manifest = Path("ws/plain_nodes/package.xml").read_text()
    assert "<license>BSD-3-Clause</license>" in manifest
    assert "copyright" not in manifest  # ament's test knows other words for it
    texts = [p.read_text() for p in Path("ws").rglob("*.py" if target == "python" else "*.cpp")]
    for text in filter(None, texts):
        assert "SPDX-License-Identifier: BSD-3-Clause" in text
        assert "Apache" not in text


@pytest.mark.parametrize("licence", ["", "x\ny", "a;b", "*/"])
def test_a_licence_is_an_identifier(licence: str) -> None:
    """Anything else could not stand in a manifest or a comment."""
    outcome = deros("generate", "models/plain.rnd", "--target", "cpp", "--licence", licence)
    assert outcome.code == 2
    assert "SPDX" in outcome.err


def test_a_copyright_stays_in_its_comment() -> None:
    """A project file from somebody else cannot bring code into what is generated."""
    _project('copyright = "2020 P\\nimport os"\n')
    assert deros("generate", "models/plain.rnd", "--target", "python", "-o", "ws").code == 0
    assert "# Copyright 2020 P import os\n" in Path("ws/plain_nodes/setup.py").read_text()
    _project('copyright = "2020 P \\\\"\n')
    assert deros("generate", "models/plain.rnd", "--target", "cpp", "-o", "ws").code == 2


def _allow(code: str = "DRS212", path: str = "models/**", reason: str = "known") -> str:
    return f'[[allow]]\ncode = "{code}"\npath = "{path}"\nreason = "{reason}"\n'


@pytest.mark.parametrize("shared", [False, True])
def test_a_project_allows_by_code_and_path(shared: bool) -> None:
    """Files of the pattern are silent; SARIF names the entry as an external suppression."""
    assert [code for code, *_ in _findings("models/deep/lone.system")] == ["DRS212"]
    allowance = _allow()
    _project(allowance.replace("[[allow", "[[tool.deros.allow") if shared else allowance, shared)
    assert _findings("models/deep/lone.system") == []
    log = json.loads(deros("check", "--format", "sarif", "models/deep/lone.system").out)
    (suppression,) = log["runs"][0]["results"][0]["suppressions"]
    assert (suppression["kind"], suppression["justification"]) == ("external", "known")
    _project(_allow(path="models/*"))
    assert [code for code, *_ in _findings("models/deep/lone.system")] == ["DRS212"]


@pytest.mark.parametrize(
    ("text", "code"),
    [
        (_allow(code="DRS999"), codes.NOT_ALLOWABLE),
        (_allow(code="DRS103"), codes.NOT_ALLOWABLE),
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
def test_what_is_wrong_with_it_is_a_finding(text: str, code: Code) -> None:
    """It points into the project file; generating sees it as well."""
    Path("deros.toml").write_bytes(text.encode(errors="surrogateescape"))
    found = [(c, f) for c, f, _ in _findings("models/plain.rnd")]
    assert (code.name, "deros.toml") in found
    outcome = deros("generate", "models/plain.rnd", "--target", "python", "-o", "ws")
    assert code.name in outcome.err
    assert (outcome.code == 0) == (
        not any(codes.ALL_CODES[c].severity.value == "error" for c, _ in found)
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
def test_the_table_counts_however_it_is_written(text: str, expected: Code | None) -> None:
    """What is no table is a finding; a file that does not speak of deros is left alone."""
    Path("pyproject.toml").write_text(text)
    found = [(code, file) for code, file, _ in _findings("models/plain.rnd")]
    assert found == ([] if expected is None else [(expected.name, "pyproject.toml")])


def test_findings_name_the_line_and_near_keys() -> None:
    """The place is that of the key."""
    _project('copyright = "2020 P"\nmaintaner = "P <p@example.com>"\n')
    outcome = deros("check", "models/plain.rnd")
    assert "deros.toml:2:1: warning[DRS026]" in outcome.out
    assert "did you mean 'maintainer'?" in outcome.out


def test_the_nearest_file_counts_and_others_are_passed_over() -> None:
    """A pyproject.toml without the table is none, nor one that is broken elsewhere."""
    _project('copyright = "above"\n')
    Path("models/pyproject.toml").write_text("[tool.ruff]\n")
    assert project_of("models/plain.rnd").options == {"copyright": "above"}
    Path("models/pyproject.toml").write_text("[tool.ruff\n")
    assert project_of("models/plain.rnd").options == {"copyright": "above"}
    Path("models/pyproject.toml").write_text('[tool.deros]\ncopyright = "near"\n')
    assert project_of("models/plain.rnd").options == {"copyright": "near"}
    assert project_of("models/deep").options == {"copyright": "near"}
    assert project_of("msgs/own_msgs").options == {"copyright": "above"}


def test_an_unneeded_entry_is_a_finding_of_the_whole_project() -> None:
    """Checking one file says nothing about an entry for others."""
    _project(_allow() + _allow(code="DRS211", path="vendor/**"))
    Path("models/talker.rnd").unlink()
    assert _findings("models/plain.rnd") == []
    assert _findings("models") == []
    assert _findings(".") == [("DRS022", "deros.toml", 5)]


def _depends(outcome: Outcome) -> str:
    assert outcome.code == 0, outcome
    return Path("d").read_text()


def test_a_build_depends_on_the_project_file() -> None:
    """A change of it generates anew."""
    command = ("generate", "models/plain.rnd", "--target", "python", "-o", "ws", "--depfile", "d")
    assert "deros.toml" not in _depends(deros(*command))
    _project('copyright = "2020 P"\n')
    assert str(Path("deros.toml").absolute()) in _depends(deros(*command))
