"""Every fenced block of the documentation is checked, run or parsed as what it is."""

from __future__ import annotations

import ast
import contextlib
import copy
import io
import re
import shlex
import shutil
import xml.etree.ElementTree as ET
from collections.abc import Callable
from importlib import import_module
from pathlib import Path

import click
import pytest

from deros.cli.main import COMMANDS
from deros.diagnostics import Diagnostic, SourceFile
from deros.interfaces.store import InterfaceStore
from deros.simulation.trace import read_trace
from tests.support import fragments, pages
from tests.support.checks import checked
from tests.support.cli import deros
from tests.support.pages import ROOT, Block
from tests.support.rules import embedded_store, program

BLOCKS = pages.blocks()
DATA = fragments.DATA

ELSEWHERE = {
    ("docs/patterns.md", "deros"): "tests/rules/engine/test_patterns.py",
    ("docs/reports.md", "deros"): "tests/cli/test_doc_reports.py",
    ("docs/comparison.md", "deros"): "tests/cli/test_doc_reports.py",
    ("README.md", ""): "tests/examples/test_walk_through.py",
    **{
        ("docs/index.md", language): "tests/e2e/test_tutorial.py"
        for language in (
            *("console", "deros", "diff", "markdown", "python"),
            *("rosnode", "rossystem", "sh", "text"),
        )
    },
    **{
        (f"docs/howto/{page}.md", language): "tests/cli/test_howtos.py"
        for page, languages in {
            "scaffold": ("console", "diff", "json", "rosnode"),
            "wire-a-system": ("console", "diff", "rosnode", "rossystem"),
            "timeouts": ("console", "deros", "markdown", "rossystem"),
            "write-an-action": ("console", "deros", "diff", "rosnode", "rossystem"),
            "certify": ("console", "diff"),
        }.items()
        for language in languages
    },
    ("docs/build-systems.md", "cmake"): "tests/builds/test_docs.py",
    ("docs/build-systems.md", "make"): "tests/builds/test_docs.py",
    ("docs/testing.md", "deros"): "tests/cli/test_doc_timelines.py",
    ("docs/testing.md", "markdown"): "tests/cli/test_doc_timelines.py",
    ("docs/testing.md", "console"): "tests/cli/test_doc_timelines.py",
    ("docs/diagnostics/DRS506.md", "markdown"): "tests/cli/test_doc_timelines.py",
    ("docs/howto/existing-robot.md", "console"): "tests/e2e/test_existing_robot.py",
    ("docs/howto/existing-robot.md", "python"): "tests/e2e/test_existing_robot.py",
    ("docs/howto/existing-robot.md", "rossystem"): "tests/e2e/test_existing_robot.py",
    ("docs/howto/existing-robot.md", "text"): "tests/e2e/test_existing_robot.py",
    ("docs/diff.md", "console"): "tests/cli/commands/test_diff.py",
    ("docs/running.md", "text"): "tests/generators/system/script/test_bring_up.py",
    ("docs/running-graph.md", "text"): "tests/live/verify/test_compare.py",
    ("docs/importing.md", "rossystem"): "tests/importers/launch/test_docs.py",
    ("docs/importing.md", "console"): "tests/importers/launch/test_docs.py",
    ("docs/formatting.md", "text"): "tests/formatting/test_docs.py",
    ("docs/c-monitor.md", "c"): "tests/generators/monitor/c/test_docs.py",
    ("docs/editors.md", "bash"): "tests/lsp/test_docs.py",
    ("docs/editors.md", "lua"): "tests/lsp/test_docs.py",
    ("docs/editors.md", "toml"): "tests/lsp/test_docs.py",
    ("docs/editors.md", "lisp"): "tests/lsp/test_docs.py",
}
"""Blocks that another test runs as they are printed."""

ALONGSIDE = {
    "DRS020": {"DRS210"},  # what it fails to allow
    "DRS021": {"DRS204"},
    "DRS238": {"DRS213", "DRS346"},  # its ports, and the state that both publish
    "DRS318": {"DRS210"},  # the same, seen from the system
    "DRS328": {"DRS217"},
    "DRS342": {"DRS357"},
    **{code: {"DRS386"} for code in ("DRS348", "DRS350", "DRS351", "DRS364", "DRS365")},
}
"""Findings that a bad example has besides its own."""

FRAMES = {
    "docs/command-line.md": "allowances.system",
    "docs/gate.md": "gate.system",
    "docs/languages/rules.md": "safety.system",
    "docs/languages/systems.md": "safety.system",
}
"""The frames of parts of systems on other pages than those of diagnostics."""

PROSE = {
    "docs/diagnostics/DRS008.md": "files by name: a large one takes megabytes",
    "docs/build-systems.md": "folders: tests/builds/test_docs.py builds them",
}
"""Texts that show files, not what is in them."""

OTHER_PROGRAMS = frozenset(
    {
        "pip",
        "make",
        "cmake",
        "cp",
        "mv",
        "mkdir",
        "cat",
        "cd",
        "echo",
        "file",
        "iconv",
        "colcon",
        "ros2",
        "./robot.py",
        ".",
    }
)


def _codes(findings: list[Diagnostic]) -> set[str]:
    return {each.code.name for each in findings}


def _expected(block: Block) -> set[str]:
    return {block.code} | ALONGSIDE.get(block.code, set()) if block.is_bad else set()


def _described(findings: list[Diagnostic]) -> str:
    return "\n".join(f"{each.span.line}: {each.code.name} {each.message}" for each in findings)


# Models ----------------------------------------------------------------------------------------


def _model(block: Block, folder: Path) -> None:
    """Check it strictly: a bad example has its finding, all others have none."""
    text = block.text
    if block.code == "DRS007":
        text = text.replace("…", "x" * 250)
    if block.code == "DRS004":
        text = text.replace("/* and a hundred more */", "subsystem x { " * 120 + "}" * 120)
    if block.code in ("DRS401", "DRS405") and block.is_bad:
        _generated(text, block.code, folder)
        return
    if block.language == "deros":
        code = block.code if block.is_bad else ""
        findings = fragments.check_rules(text, folder, code, _system(block))
    elif block.language == "rosnode":
        findings = fragments.check_node(text, folder, _frame(block))
    else:
        findings = fragments.check_system(text, _frame(block), folder)
    assert _codes(findings) == _expected(block), f"{block}:\n{_described(findings)}"


def _system(block: Block) -> str:
    """Return the name of the system that a page's rules use."""
    names = [f"{block.code}.bad"] if block.is_bad else []
    names = [f"{each}.Courier.system" for each in (*names, block.code)]
    found = (each for each in names if (DATA / "frames" / each).exists())
    return next(found, "")


def _frame(block: Block) -> str:
    """Return the name of the frame of a node or a system; empty for a whole one."""
    if re.match(r"system \w", block.text):
        return ""
    if block.text == 'safety "courier.deros"\n' and block.code == "DRS354":
        return "safety.system"
    names = [f"{block.code}.system", FRAMES.get(block.page, "")]
    if not block.is_bad:
        names.insert(0, f"{block.code}.good.system")
    names += ["plain.system"] if block.code else []
    found = (each for each in names if each and (DATA / "frames" / each).exists())
    frame = next(found, "")
    if block.language == "rosnode" and frame:
        system = (DATA / "frames" / frame).read_text(encoding="utf-8")
        return frame if '"shown.rnd"' in system else ""
    assert frame or block.language == "rosnode", f"{block}: no frame in tests/data/docs/frames"
    return frame


def _generated(text: str, code: str, folder: Path) -> None:
    file = folder / "shown.rnd"
    file.write_text(fragments.whole_node(text), encoding="utf-8")
    outcome = deros("generate", file, "--target", "python", "-o", folder / "out")
    assert code in outcome.out + outcome.err, outcome


# Commands --------------------------------------------------------------------------------------


def _commands(block: Block) -> list[str]:
    """Return the commands of a block for the shell, without what they print."""
    lines = block.text.splitlines()
    if block.language == "console":
        lines = [line.removeprefix("$ ") for line in lines if line.startswith("$ ")]
    return [
        part.strip()
        for line in lines
        for part in re.split(r"&&|\s>\s.*", re.sub(r"\s#\s.*", "", line.rstrip("\\")))
        if part.strip()
    ]


def _shell(block: Block, folder: Path) -> None:
    """Run it where it takes a moment, else parse it: its commands and their options exist."""
    for command in _commands(block):
        words = shlex.split(command)
        while words and re.match(r"\w+=", words[0]):
            words.pop(0)
        if not words:
            continue
        if words[0] != "deros":
            assert words[0] in OTHER_PROGRAMS, f"{block}: {command}"
        else:
            _parse(words[1:], is_bad=block.is_bad)
        if words[0] == "make":
            makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
            assert re.search(rf"^{words[1]}:", makefile, re.M), f"{block}: {command}"
    if block.code in RUNNABLE:
        _run(block, folder)


def _parse(words: list[str], *, is_bad: bool) -> None:
    """Parse a command of ``deros`` as the program does; a file need not exist."""
    assert words[0] in COMMANDS, words
    module, _, name = COMMANDS[words[0]][0].partition(":")
    command: click.Command = getattr(import_module(f"deros.cli.commands.{module}"), name)
    parsed = copy.copy(command)
    parsed.params = [copy.copy(each) for each in command.params]
    for parameter in parsed.params:
        if isinstance(parameter.type, click.Path):
            parameter.type = click.Path()
    context = parsed.make_context(words[0], words[1:])
    # Those of an export are no generators; they were checked when the command was parsed.
    targets = context.params.get("target") or () if words[0] != "export" else ()
    known = deros("generate", "--help").out
    for target in (targets,) if isinstance(targets, str) else targets:
        assert is_bad or target == "names" or target in known, words


RUNNABLE = frozenset(
    {
        "DRS001",
        "DRS005",
        "DRS024",
        "DRS239",
        "DRS353",
        "DRS355",
        "DRS402",
        "DRS403",
        "DRS404",
        "DRS406",
    }
)
"""Pages of diagnostics whose commands are run, in ``tests/data/docs/folder``."""


def _run(block: Block, folder: Path) -> None:
    shutil.copytree(DATA / "folder", folder, dirs_exist_ok=True)
    if block.code == "DRS403":
        deros("generate", "robot.rnd", "--target", "python", "-o", "ws/src")
        (base,) = Path("ws/src").rglob("robot_base.py")
        base.write_text(base.read_text(encoding="utf-8") + "# edited\n", encoding="utf-8")
    if block.code in ("DRS353", "DRS355"):
        shutil.copy(DATA / "rules" / "courier.deros", folder)
    outcomes = [
        deros(*shlex.split(each)[1:]) for each in _commands(block) if each.startswith("deros")
    ]
    printed = "".join(each.out + each.err for each in outcomes)
    assert (block.code in printed) == block.is_bad, printed
    for copied in (each for each in _commands(block) if each.startswith("cp ")):
        assert Path(copied.split()[1]).is_file(), copied
    if not block.is_bad:
        assert [each.code for each in outcomes] == [0] * len(outcomes), outcomes


# Data ------------------------------------------------------------------------------------------

TRACED = """\
input speed = topic /speed.data timeout 1 sec
input forward = topic /odom.twist.twist.linear.x timeout 1 sec
input mode = topic /mode.data timeout 1 sec
entity e { fast: speed > 1 or forward > 1 m/s or mode = 2; }
action stop;
if e.fast then { stop; };
"""


def _trace(block: Block, _: Path) -> None:
    """Read it as a trace."""
    trace = read_trace(SourceFile("trace", block.text), program(TRACED), embedded_store())
    assert _codes(list(trace.diagnostics)) == _expected(block), _described(list(trace.diagnostics))


def _toml(block: Block, folder: Path) -> None:
    """Read it as a project file, or as that of a Python package."""
    name = "pyproject.toml" if "[project." in block.text else "deros.toml"
    (folder / name).write_text(block.text, encoding="utf-8")
    (folder / "base.rnd").write_text("node base : base_driver\n", encoding="utf-8")
    for name in ("msgs", "vendor"):
        (folder / name).mkdir()
    outcome = deros("check", "base.rnd")
    found = set(re.findall(r"\[(DRS\d{3})", outcome.out + outcome.err))
    assert found == _expected(block), outcome


def _python(block: Block, _: Path) -> None:
    """Parse it, and find what it imports from deros."""
    for node in ast.walk(ast.parse(block.text)):
        if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("deros"):
            module = import_module(node.module)
            for each in node.names:
                assert hasattr(module, each.name), f"{block}: {node.module}.{each.name}"


def _graph(block: Block, folder: Path) -> None:
    """Run it on a system with what it names."""
    shutil.copytree(DATA / "graph", folder, dirs_exist_ok=True)
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(block.text, str(block), "exec"), {})
    assert {*printed.getvalue().splitlines()} == {
        "topic /imu",
        "topic /cmd_vel",
        "node /pilot",
        "/sensors/imu imu sensor_msgs/msg/Imu",
    }


def _decoding(block: Block, folder: Path) -> None:
    """Find it in the code that is generated for the same field."""
    shutil.copy(DATA / "Courier.system", folder)
    shutil.copy(DATA / "beeping.python.deros", folder / "robot.deros")
    assert deros("generate", "robot.deros", "--target", "python", "-o", "out").code == 0
    (decoding,) = Path("out").rglob("decoding.py")
    written = decoding.read_text(encoding="utf-8").replace("decode_odom(", "decode_odometry(")
    for line in block.text.splitlines():
        assert line in written.replace("'''", '"""'), f"{block}: {line}"


def _xml(block: Block, _: Path) -> None:
    """Parse it as a part of a document."""
    assert len(ET.fromstring(f"<package>{block.text}</package>")) > 0


def _yaml(block: Block, folder: Path) -> None:
    """Read it as the node description that its page says it is taken for."""
    file = folder / "parameters.rnd"
    file.write_text(block.text, encoding="utf-8")
    assert "DRS003" in _codes(checked(file))


def _parameter_file(block: Block, folder: Path) -> None:
    """Check it as the parameter file of a system."""
    shutil.copytree(DATA / "models", folder, dirs_exist_ok=True)
    (folder / "shown.yaml").write_text(block.text, encoding="utf-8")
    system = folder / "courier.system"
    shutil.copy(DATA / "frames" / "parameter_file.system", system)
    findings = checked(system)
    assert _codes(findings) == _expected(block), _described(findings)


def _actions(block: Block, folder: Path) -> None:
    """Generate the package whose class it shows."""
    (folder / "Courier.system").write_text((DATA / "Courier.system").read_text(encoding="utf-8"))
    (folder / "robot.deros").write_text(
        (DATA / f"beeping.{block.language}.deros").read_text(encoding="utf-8")
    )
    outcome = deros(
        "generate",
        "robot.deros",
        "--target",
        block.language,
        "-o",
        "out",
    )
    assert outcome.code == 0, outcome
    written = "\n".join(
        " ".join(each.read_text(encoding="utf-8").split())
        for each in Path("out").rglob("*actions*")
    )
    shown = [line.strip() for line in block.text.splitlines() if "beep" in line]
    assert shown, block
    for line in shown:
        assert re.sub(r"\s*override;|:$", "", line) in written, f"{block}: {line}"


def _message_definition(block: Block, folder: Path) -> None:
    """Read it as the message of a package."""
    messages = folder / "interfaces" / "demo_msgs" / "msg"
    messages.mkdir(parents=True)
    (messages / "Tree.msg").write_text(block.text, encoding="utf-8")
    file = folder / "shown.rnd"
    file.write_text("node shown : demo\npublishes\n  topic tree : demo_msgs.Tree\n")
    store = InterfaceStore([folder / "interfaces"], prefixes=())
    assert _codes(checked(file, store=store)) == _expected(block)


def _finding(block: Block, folder: Path) -> None:
    """Compare it with what ``deros check`` prints."""
    shutil.copytree(DATA / "finding", folder, dirs_exist_ok=True)
    outcome = deros("check", "robot.system")
    assert block.text in outcome.out, outcome.out


def _packages(block: Block, _: Path) -> None:
    """Find the packages that it names."""
    named = re.findall(r"\b([a-z]+)/(?=\s)", block.text)
    assert len(named) > 5
    for name in named:
        assert (ROOT / "src" / "deros" / name).is_dir(), f"{block}: {name}"


Check = Callable[[Block, Path], None]
CHECKS: dict[str, Check] = {
    "deros": _model,
    "rosnode": _model,
    "rossystem": _model,
    "console": _shell,
    "sh": _shell,
    "json": _trace,
    "toml": _toml,
    "python": _python,
    "xml": _xml,
    "yaml": _yaml,
}
"""The check of a block by its language."""

OF_PAGES: dict[tuple[str, str], Check] = {
    ("docs/safety-node.md", "python"): _actions,
    ("docs/safety-node.md", "cpp"): _actions,
    ("docs/diagnostics/DRS112.md", "text"): _message_definition,
    ("docs/command-line.md", "text"): _finding,
    ("docs/architecture.md", "text"): _packages,
    ("docs/graph.md", "python"): _graph,
    **{
        (f"docs/{page}.md", "yaml"): _parameter_file
        for page in (
            "diagnostics/DRS259",
            "diagnostics/DRS260",
            "diagnostics/DRS261",
            "diagnostics/DRS264",
            "languages/systems",
        )
    },
    ("docs/decoding.md", "python"): _decoding,
}
"""The checks of blocks for which their language is not enough."""


def _check_of(block: Block) -> Check | None:
    return OF_PAGES.get((block.page, block.language)) or CHECKS.get(block.language)


def _is_elsewhere(block: Block) -> bool:
    return (block.page, block.language) in ELSEWHERE


def _is_prose(block: Block) -> bool:
    return block.language == "text" and block.page in PROSE


def test_every_block_is_accounted_for() -> None:
    """A block that nothing checks is an error, with its place."""
    unknown = [
        str(each)
        for each in BLOCKS
        if not (_is_elsewhere(each) or _is_prose(each) or _check_of(each))
    ]
    assert not unknown, "no test checks the blocks at " + ", ".join(unknown)
    assert len(BLOCKS) > 350


@pytest.mark.parametrize(("place", "test"), ELSEWHERE.items(), ids=lambda each: str(each))
def test_other_test_reads_the_page(place: tuple[str, str], test: str) -> None:
    """The tests that check the blocks of a page name it."""
    text = (ROOT / test).read_text(encoding="utf-8")
    assert any(each.page == place[0] and each.language == place[1] for each in BLOCKS)
    assert Path(place[0]).name in text


@pytest.mark.parametrize(
    "block", [each for each in BLOCKS if not _is_elsewhere(each) and not _is_prose(each)], ids=str
)
def test_block_is_true(block: Block, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What it shows is checked, run or parsed."""
    check = _check_of(block)
    assert check is not None, f"no test checks the block at {block}"
    monkeypatch.chdir(tmp_path)
    check(block, tmp_path)


@pytest.mark.parametrize("code", sorted({each.code for each in BLOCKS if each.code}))
def test_page_has_a_bad_and_a_good_example(code: str) -> None:
    """Each page of a diagnostic shows what it reports, and what to write instead."""
    of_page = [each.is_bad for each in BLOCKS if each.code == code]
    assert True in of_page
    assert False in of_page
