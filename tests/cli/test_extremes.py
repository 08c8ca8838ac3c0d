"""Resource limits: any file is handled within 500 MB, by work that is linear in its size.

How long it takes is measured by ``benchmarks/extremes.py``.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

from benchmarks.support.extreme_models import MB, MODELS, NODE
from deros.diagnostics import Diagnostic
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.validators.check import check as check_loaded
from tests.support.measured import Measured, run
from tests.support.profiles import slow
from tests.support.work import calls

MOST_MB = 500.0


def check(folder: Path, name: str, *options: object) -> Measured:
    """Check a model and assert the limits."""
    done = run("check", *options, name, folder=folder)
    assert "bug in deros" not in done.out, done.out[-2000:]
    assert done.code in (0, 1, 2), done.out[-2000:]
    assert done.peak_mb < MOST_MB
    return done


LONG = ("20,000 imports", "escapes of 3 MB", "a topic of 1 MB", "units that name each other")
"""The models that take longest."""


@pytest.mark.parametrize("what", [slow(each) if each in LONG else each for each in MODELS])
def test_extreme_models_stay_within_the_limits(tmp_path: Path, what: str) -> None:
    """Broken models give a finding at its place, sound ones none, all within the limits."""
    suffix, text, code = MODELS[what]
    (tmp_path / f"model{suffix}").write_text(text())
    done = check(tmp_path, f"model{suffix}")
    assert code in done.out[:5000]
    assert (f"model{suffix}:" in done.out) == bool(code)
    assert done.code == (2 if code in ("DRS008", "DRS005") else bool(code))


GROWING: dict[str, tuple[str, Callable[[int], str], int]] = {
    # name: suffix, text of a size, and the size to begin with
    "parameters": (
        ".rnd",
        lambda n: f"{NODE}parameters\n" + "".join(f"  name p{i} : double = 1\n" for i in range(n)),
        500,
    ),
    "escapes": (".rnd", lambda n: NODE[:-1] + ' "' + r"\n" * n + '"', 500),
    "factors of a unit": (".deros", lambda n: "const a = 1 " + "x*" * n + "x", 500),
    "factors of a unit in brackets": (
        ".rnd",
        lambda n: f"{NODE}parameters name p : double = 1 [{'x*' * n}x]",
        500,
    ),
    "units that name each other": (
        ".deros",
        lambda n: "".join(f"unit u{i} = 2 u{i + 1}\n" for i in range(n)) + f"unit u{n} = 1 m",
        500,
    ),
    "constants that name each other": (
        ".deros",
        lambda n: "".join(f"const u{i} = u{i + 1}\n" for i in range(n)) + f"const u{n} = 1",
        500,
    ),
    "parts of a topic": (".rnd", lambda n: f"{NODE}publishes topic {'/a' * n} : a.B", 500),
    "letters of a name": (".rnd", lambda n: f"node {'n' * n} : demo", 500),
    "signs": (".deros", lambda n: f"const a = {'-' * n}1", 500),
    "nested functions": (".deros", lambda n: f"const a = {'f(' * n}1{')' * n}", 20),
    "alternating not and for": (
        ".deros",
        lambda n: f"entity e {{ r: {'(not ' * n}x{' or x for 1 sec)' * n}; }}",
        20,
    ),
    "imports": (".system", lambda n: "system s imports " + 'import "x" ' * n, 500),
}


@pytest.mark.parametrize("what", GROWING)
def test_work_is_linear_in_the_size(tmp_path: Path, what: str) -> None:
    """Four times the text is about four times the work."""
    suffix, text, size = GROWING[what]

    def work(count: int) -> int:
        return calls(lambda: _findings(tmp_path / f"model{suffix}", text(count)))

    work(4 * size)  # what is done once, for each word too
    assert work(4 * size) < 5 * work(size)


RULES = """\
use "robot.system" import Robot
input x = topic /x.data timeout 1 sec
entity e {{
  lost: x.missing();
  {}
}}
if e.r0 or e.lost then {{ log_state("x"); }};
"""

GROWING_RULES: dict[str, Callable[[int], str]] = {
    "operands of an or": lambda n: f"r0: {' or '.join(f'x > {i}' for i in range(n))};",
    "operands of an and": lambda n: f"r0: {' and '.join(f'x > {i}' for i in range(n))};",
    "rules that each name the next three": lambda n: "".join(
        f"r{i}: r{i + 1} or r{i + 2} and r{i + 3};\n" if i < n else f"r{i}: x > {i};\n"
        for i in range(n + 3)
    ),
}


@pytest.mark.parametrize("what", GROWING_RULES)
def test_work_on_sound_rules_is_linear_in_the_size(tmp_path: Path, what: str) -> None:
    """Four times the rules are about four times the work, all checks included."""
    system = "system Robot topics external topic /x : std_msgs.Float64"
    (tmp_path / "robot.system").write_text(system)

    def check_rules(count: int) -> None:
        repository = Repository()
        text = RULES.format(GROWING_RULES[what](count))
        loaded = repository.load_text(tmp_path / "model.deros", text)
        findings = check_loaded([loaded], repository, InterfaceStore())
        assert [each for each in findings if each.is_error] == []

    check_rules(150)  # what is done once
    assert calls(lambda: check_rules(600)) < 5 * calls(lambda: check_rules(150))


def _findings(path: Path, text: str) -> Sequence[Diagnostic]:
    repository = Repository()
    loaded = repository.load_text(path, text)
    return check_loaded([loaded], repository, InterfaceStore((), ()))


@pytest.mark.slow
def test_file_of_100_mb_is_not_read(tmp_path: Path) -> None:
    """A file too large for a model is rejected by its size."""
    for name in ("a.rnd", "a.system", "a.deros"):
        with (tmp_path / name).open("wb") as file:
            file.truncate(100 * MB)
        done = check(tmp_path, name)
        assert "DRS008" in done.out
        assert done.peak_mb < 150


NUMBERS = {
    "default": "node n : demo parameters name p : int = @",
    "element": "node n : demo parameters name p : int[] = [@]",
    "lower end": "node n : demo parameters name p : int = 1 in [@, 2]",
    "upper end": "node n : demo parameters name p : double = 1 in [0, @]",
    "choice": "node n : demo parameters name p : int = 1 one_of [@]",
    "size": "node n : demo parameters name p : int[] size @",
    "power": "node n : demo parameters name p : double = 1 [m^@]",
    "depth": "node n : demo publishes topic a : std_msgs.Bool qos depth @",
    "deadline": "node n : demo publishes topic a : std_msgs.Bool qos deadline @ ms",
    "lease": "node n : demo publishes topic a : std_msgs.Bool qos liveliness automatic lease @ s",
    "field": "node n : demo publishes topic a : std_msgs.Bool { data[@] [m] }",
    "period": "node n : demo timers timer t every @ sec",
}


@pytest.mark.parametrize("place", NUMBERS)
def test_number_out_of_range_is_a_finding(tmp_path: Path, place: str) -> None:
    """A number that no type can represent is reported at its place, wherever it is."""
    for number in ("9" * 5000, "1e400", "1" * 300, "18446744073709551616"):
        text = NUMBERS[place].replace("@", number)
        errors = [each for each in _findings(tmp_path / "model.rnd", text) if each.is_error]
        fits = place in ("lower end", "upper end") and number in ("1" * 300, "18446744073709551616")
        assert errors or fits, number[:30]


# Special files ------------------------------------------------------------------------------------


@pytest.mark.slow
def test_pipes_and_devices_are_rejected_without_blocking(tmp_path: Path) -> None:
    """Models, imports and definitions that lead to a pipe or a device are findings."""
    os.mkfifo(tmp_path / "pipe.rnd")
    (tmp_path / "zero.rnd").symlink_to("/dev/zero")
    (tmp_path / "folder.rnd").mkdir()
    (tmp_path / "one.system").write_text('system s imports import "pipe.rnd"')
    (tmp_path / "all.system").write_text('system s imports import "*.rnd"')
    for name in ("pipe.rnd", "zero.rnd"):
        assert "not a regular file" in check(tmp_path, name).out
    assert "DRS201" in check(tmp_path, "one.system").out
    assert check(tmp_path, "all.system").out.count("DRS001") == 2
    definitions = tmp_path / "own_msgs" / "msg"
    definitions.mkdir(parents=True)
    os.mkfifo(definitions / "Pipe.msg")
    (definitions / "Zero.msg").symlink_to("/dev/zero")
    (tmp_path / "model.rnd").write_text(
        f"{NODE}publishes topic a : own_msgs.Pipe topic b : own_msgs.Zero"
    )
    output = check(tmp_path, "model.rnd", "--interfaces", ".").out
    assert output.count("DRS112") == 2
    assert output.count("not a regular file") == 2


@pytest.mark.parametrize(
    "place", ["demo/demo/n.py", slow("demo/package.xml"), slow("demo/demo/__init__.py")]
)
def test_pipe_in_place_of_an_output_is_kept(tmp_path: Path, place: str) -> None:
    """It is neither opened nor replaced, and no other file is written."""
    (tmp_path / "n.rnd").write_text(NODE)
    assert run("generate", "n.rnd", "--target", "python", "-o", "out", folder=tmp_path).code == 0
    written = sorted(path for path in (tmp_path / "out").rglob("*") if path.is_file())
    target = next(path for path in written if path.as_posix().endswith(place.partition("/")[2]))
    target.unlink()
    os.mkfifo(target)
    changed = [path for path in written if path != target]
    for path in changed:
        path.unlink()
    done = run("generate", "n.rnd", "--target", "python", "-o", "out", folder=tmp_path)
    assert done.code == 2, done.out
    assert "not a regular file" in done.out
    assert target.is_fifo()
    assert not any(path.exists() for path in changed)


def test_endless_trace_is_rejected(tmp_path: Path) -> None:
    """A device without end is rejected at the size limit."""
    (tmp_path / "r.deros").write_text("action stop")
    done = run("simulate", "r.deros", "--trace", "/dev/zero", folder=tmp_path)
    assert done.code == 2, done.out[-300:]
    assert "DRS008" in done.out


@pytest.mark.slow
def test_import_globs_over_link_loops_terminate(tmp_path: Path) -> None:
    """Each folder is searched once, however many links lead to it."""
    folder = tmp_path / "nodes" / "inner"
    folder.mkdir(parents=True)
    (folder / "n.rnd").write_text(NODE)
    for name in ("a", "b", "c"):
        (folder / name).symlink_to("..")
        (tmp_path / "nodes" / name).symlink_to(".")
    for pattern in ("nodes/**/*.rnd", "**/**/**/**/n.rnd", "*/*/*/*/*/*/*/*/*/*/*/*.rnd"):
        text = f'system s imports import "{pattern}" node n : n'
        (tmp_path / "s.system").write_text(text)
        assert check(tmp_path, "s.system").code == 0, pattern


def test_recursive_or_exploding_definitions_are_rejected(tmp_path: Path) -> None:
    """They are rejected when they are named, before they are expanded."""
    definitions = tmp_path / "own_msgs" / "msg"
    definitions.mkdir(parents=True)
    (definitions / "A.msg").write_text("B[] b\n")
    (definitions / "B.msg").write_text("A a\n")
    for level in range(30):
        (definitions / f"L{level}.msg").write_text(f"L{level + 1} a\nL{level + 1} b\n")
    (definitions / "L30.msg").write_text("float64 x\n")
    (definitions / "C0.msg").write_text("float64 x\n")
    for level in range(1, 200):
        (definitions / f"C{level}.msg").write_text(f"C{level - 1} inner\n")
    (tmp_path / "s.system").write_text(
        "system s topics external topic /a : own_msgs.A external topic /l : own_msgs.L0"
        " external topic /c : own_msgs.C199"
    )
    (tmp_path / "r.deros").write_text(
        'use "s.system" import s\ninput a = topic /a.b\ninput l = topic /l.a\ninput c = topic /c'
    )
    for name, count in (("s.system", 3), ("r.deros", 3)):
        done = check(tmp_path, name, "--interfaces", ".")
        assert done.out.count("DRS112") == count, done.out
        assert "contains itself: own_msgs/msg/A → own_msgs/msg/B → own_msgs/msg/A" in done.out
        assert "more than 10,000 fields" in done.out
        assert "more than 50 levels deep" in done.out


def test_file_names_that_are_not_utf8(tmp_path: Path) -> None:
    """A file whose name is not UTF-8 is reported in every format."""
    name = os.fsdecode(b"\xff.rnd")
    (tmp_path / name).write_text("node")
    for output in ("text", "json", "sarif", "github"):
        done = subprocess.run(
            [Path(sys.executable).with_name("deros"), "check", "--format", output, name],
            cwd=tmp_path,
            capture_output=True,
            check=False,
        )
        assert done.returncode == 1, done.stderr
        assert b"bug in deros" not in done.stderr


def test_lone_surrogate_in_a_trace_is_reported(tmp_path: Path) -> None:
    """JSON may contain a character that no stream accepts; it is still reported."""
    (tmp_path / "r.deros").write_text("action stop")
    (tmp_path / "t").write_text('{"t": 1, "topic": "\\ud800", "data": {}}\n')
    done = run("simulate", "r.deros", "--trace", "t", folder=tmp_path)
    assert done.code == 0, done.out
    assert "DRS505" in done.out
