"""The C++ runtime, compared with the Python one."""

from __future__ import annotations

import hashlib
import os
import random
import stat
import struct
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from deros.generators.runtime.python.deros_runtime.instance import Refusal, claim, file_stem
from deros.generators.runtime.python.deros_runtime.latches import LatchFile, default_path
from deros.generators.runtime.python.deros_runtime.start_order import StartOrder
from deros.rules.program.bounds import shortest_decimal
from tests.support.cpp import compile_cpp
from tests.support.needs import needs
from tests.support.safety_cpp import RUNTIME, Harness, compiled

pytestmark = needs("c++")

HERE = Path(__file__).resolve().parent
OWNER = "/robot_safety"
KNOWN = ("halt", "stop")


def latch_file(folder: Path) -> LatchFile:
    """Return the file of a node as used by the Python node."""
    return LatchFile(folder / "deros" / "robot.latches", OWNER)


def test_flags_are_copied_without_allocating_again(tmp_path: Path) -> None:
    """The entries of each place stand for themselves; only a longer array takes memory."""
    program = compile_cpp(
        [HERE / "flags.cpp"], tmp_path / "program", includes=(f"-I{RUNTIME / 'include'}",)
    )
    done = subprocess.run([program], timeout=60, check=False)
    assert done.returncode == 0


def test_event_loop_serves_sources_and_timers_in_order(tmp_path: Path) -> None:
    """Sources are served in order, timers fire when they are due, and nothing is lost."""
    program = compiled(RUNTIME / "test/test_event_loop.cpp", tmp_path)
    done = subprocess.run([program], capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stdout) == (0, "passed\n")


def test_numbers_are_formatted_like_python(harness: Harness) -> None:
    """The reports of both nodes show the same text for any value; -0.0 is shown as 0.0."""
    drawn = random.Random(1)
    numbers = [0.0, -0.0, 0.9, 1e16, 1e15, 123456789012345680.0, 1e-4, 1e-5, 5e-324, 1.5, 100.0]
    numbers += [float("inf"), float("-inf"), float("nan"), 0.1 + 0.2, 1 / 3, 2.0**53]
    numbers += [struct.unpack("d", drawn.randbytes(8))[0] for _ in range(300)]
    numbers += [round(drawn.uniform(-1e6, 1e6), drawn.randrange(8)) for _ in range(300)]
    for value in numbers:
        bits = struct.pack(">d", value).hex()
        assert harness.ask("number", bits) == str(value + 0.0)


def test_floats_are_formatted_as_the_monitor_does(harness: Harness) -> None:
    """A float32 is told by the shortest decimal that gives it."""
    drawn = random.Random(3)
    bits = [drawn.randbytes(4) for _ in range(500)] + [struct.pack(">f", 51.2), b"\x7f\x7f\xff\xff"]
    for each in bits:
        (value,) = struct.unpack(">f", each)
        assert harness.ask("single", each.hex()) == str(shortest_decimal(value) + 0.0)


def test_duplicate_detection_agrees_with_python(harness: Harness) -> None:
    """Nodes of both languages may meet each other."""
    drawn = random.Random(2)
    for _ in range(100):
        times = sorted(drawn.randrange(0, 15 * 10**9, 10**8) for _ in range(40))
        gone = drawn.randrange(40)
        looks = [(time, number != gone) for number, time in enumerate(times)]
        order = StartOrder(0)
        decided = "".join("ny"[order.gives_way(double, time)] for time, double in looks)
        text = ",".join(f"{time}{'+' if double else '-'}" for time, double in looks)
        assert harness.ask("order", text) == decided


def test_service_calls_agree_with_python(harness: Harness) -> None:
    """Both call, report and give up alike, whenever a server comes, answers, hangs or goes."""
    pytest.importorskip("rclpy")
    from tests.support.service_calls import called, drawn_script

    drawn = random.Random(4)
    seen = set()
    for _ in range(300):
        script = drawn_script(drawn)
        expected = called(script)
        assert harness.ask("service", ",".join(script)) == expected, script
        seen |= set(expected.split("|"))
    assert seen == {
        *("", "call", "/arm done", "fault ", "fault /arm is not available"),
        *("fault /arm has not answered", "fault /arm has answered no success"),
        "fault /arm has answered no success: busy?é",
    }


@pytest.mark.parametrize("length", [0, 1, 55, 56, 63, 64, 65, 119, 120, 1000])
def test_digest_is_sha_256(harness: Harness, length: int) -> None:
    """Lengths include the block boundaries."""
    text = "".join(chr(97 + i % 26) for i in range(length))
    assert harness.ask("digest", text) == hashlib.sha256(text.encode()).hexdigest()


@pytest.mark.parametrize("name", ["/robot_safety", "/cell/one/robot_safety", "/" + "n" * 201])
def test_file_names_agree_with_python(harness: Harness, name: str) -> None:
    """A node of one language takes over the files of the other."""
    assert harness.ask("stem", name, 7) == file_stem(name, 7)


def test_default_folder_agrees_with_python(
    program: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """It is in ROS_HOME, or else in the home folder."""
    for home in (str(tmp_path), ""):
        monkeypatch.setenv("ROS_HOME", home)
        harness = Harness(program)
        assert harness.ask("place", "robot.0") == str(default_path("robot.0"))
        harness.close()


# Latch file -----------------------------------------------------------------------------------


@pytest.mark.parametrize("active", [(), ("stop",), ("halt", "stop")])
def test_latch_files_agree_with_python(
    harness: Harness, tmp_path: Path, active: tuple[str, ...]
) -> None:
    """The files are equal byte for byte, and each node reads the other's."""
    file = latch_file(tmp_path)
    assert harness.ask("save", file.path, OWNER, ",".join(active)) == "done"
    written = file.path.read_bytes()
    assert file.load(KNOWN) == (frozenset(active), "")
    file.path.unlink()
    file.save(frozenset(active))
    assert file.path.read_bytes() == written
    assert harness.ask("load", file.path, OWNER, ",".join(KNOWN)) == f"{','.join(active)}|"


def test_nothing_is_active_without_a_file(harness: Harness, tmp_path: Path) -> None:
    """The first start of a node is not an error."""
    assert harness.ask("load", tmp_path / "none", OWNER, "halt,stop") == "|"


def test_every_flipped_bit_and_truncation_is_detected(harness: Harness, tmp_path: Path) -> None:
    """No damage makes an active action inactive."""
    file = latch_file(tmp_path)
    file.save(frozenset({"stop"}))
    whole = file.path.read_bytes()
    damaged = [whole[:length] for length in range(len(whole))]
    for position in range(len(whole) * 8):
        changed = bytearray(whole)
        changed[position // 8] ^= 1 << position % 8
        damaged.append(bytes(changed))
    for content in damaged:
        file.path.write_bytes(content)
        answer = harness.ask("load", file.path, OWNER, "halt,stop")
        assert answer.startswith(f"halt,stop|{file.path} is damaged"), content


@pytest.mark.parametrize(
    ("names", "owner", "fragment"),
    [
        ("stop", "/other", "is damaged, or not of /robot_safety"),
        ("freeze", OWNER, "names freeze, unknown by now"),
    ],
)
def test_file_of_another_node_counts_as_active(
    harness: Harness, tmp_path: Path, names: str, owner: str, fragment: str
) -> None:
    """This includes a node with other rules."""
    path = tmp_path / "robot.latches"
    harness.ask("save", path, owner, names)
    answer = harness.ask("load", path, OWNER, "halt,stop")
    assert answer.startswith("halt,stop|")
    assert fragment in answer


@pytest.mark.parametrize("how", ["mark_dirty", "truncate"])
def test_dirty_or_truncated_file_counts_as_active(
    harness: Harness, tmp_path: Path, how: str
) -> None:
    """The next node of either language starts with all actions active."""
    file = latch_file(tmp_path)
    assert harness.ask(how, file.path, OWNER, "") == "done"
    assert file.load(KNOWN)[0] == frozenset(KNOWN)
    assert harness.ask("load", file.path, OWNER, "halt,stop").startswith("halt,stop|")


def test_write_error_has_a_reason(harness: Harness, tmp_path: Path) -> None:
    """The text helps to fix the cause."""
    (tmp_path / "file").write_text("")
    answer = harness.ask("save", tmp_path / "file" / "robot.latches", OWNER, "stop")
    assert answer == "Not a directory"


def test_no_partial_file_is_left(harness: Harness, tmp_path: Path) -> None:
    """If the new file cannot replace the old one, it is deleted."""
    (tmp_path / "robot.latches").mkdir()
    assert harness.ask("save", tmp_path / "robot.latches", OWNER, "stop") == (
        "it is a directory, not a regular file"
    )
    assert [path.name for path in tmp_path.iterdir()] == ["robot.latches"]


def put_link(path: Path) -> None:
    """Create a link to another file."""
    path.symlink_to(path.with_name("other"))


def put_pipe(path: Path) -> None:
    """Create a pipe, which would block an open call."""
    os.mkfifo(path)


@pytest.mark.parametrize("put", [put_link, put_pipe, Path.mkdir])
def test_irregular_file_is_left_alone(
    harness: Harness, tmp_path: Path, put: Callable[[Path], object]
) -> None:
    """No other file is read, truncated, replaced or locked."""
    path = tmp_path / f"{file_stem('/robot', 7)}.lock"
    put(path)
    before = path.lstat()
    answer = harness.ask("load", path, OWNER, "halt,stop")
    assert answer.startswith("halt,stop|")
    for words in (("save", path, OWNER, "stop"), ("claim", tmp_path, 7, "/robot")):
        assert "not a regular file" in harness.ask(*words)
    assert "not a regular file" in answer
    assert list(tmp_path.iterdir()) == [path]
    assert (path.lstat().st_ino, path.lstat().st_mode) == (before.st_ino, before.st_mode)


def test_partial_files_of_a_killed_process_are_removed(harness: Harness, tmp_path: Path) -> None:
    """Other files in the folder are kept."""
    path = tmp_path / "robot.latches"
    kept = {"robot.latches.new", "other.latches.0123456789abcdef.new"}
    for name in (*kept, "robot.latches.0123456789abcdef.new"):
        (tmp_path / name).touch()
    assert harness.ask("leftovers", path, OWNER) == "done"
    assert {each.name for each in tmp_path.iterdir()} == kept


def test_missing_folder_is_created_private(harness: Harness, tmp_path: Path) -> None:
    """This agrees with the Python node."""
    path = tmp_path / "made" / "for" / "robot.latches"
    assert harness.ask("save", path, OWNER, "stop") == "done"
    assert stat.S_IMODE(path.parent.stat().st_mode) == 0o700


# Single instance ------------------------------------------------------------------------------


def test_cpp_node_is_refused_next_to_a_python_node(harness: Harness, tmp_path: Path) -> None:
    """The lock is the same in both languages."""
    with claim("/robot", 7, tmp_path):
        answer = harness.ask("claim", tmp_path, 7, "/robot")
        assert answer == (
            f"/robot runs already in domain 7, as process {os.getpid()}: this second one ends now"
        )
    assert harness.ask("claim", tmp_path, 7, "/robot") == "held"


def test_python_node_is_refused_next_to_a_cpp_node(harness: Harness, tmp_path: Path) -> None:
    """Other names and domains are free."""
    assert harness.ask("claim", tmp_path, 7, "/robot") == "held"
    with pytest.raises(Refusal, match=f"as process {harness.process.pid}"):
        claim("/robot", 7, tmp_path)
    with claim("/robot", 8, tmp_path), claim("/cell/robot", 7, tmp_path):
        pass
    harness.close()
    with claim("/robot", 7, tmp_path):
        pass
