"""The runtime of the C++ safety node, held to that of the Python one."""

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
from tests.support.cpp import needs_compiler
from tests.support.safety_cpp import RUNTIME, Harness, compiled

pytestmark = needs_compiler

OWNER = "/robot_safety"
KNOWN = ("halt", "stop")


def latch_file(folder: Path) -> LatchFile:
    """Return the file of a node as the Python node sees it."""
    return LatchFile(folder / "deros" / "robot.latches", OWNER)


def test_event_loop(tmp_path: Path) -> None:
    """Sources are served in order, timers fire when they are due, and nothing is lost."""
    program = compiled(RUNTIME / "test/test_event_loop.cpp", tmp_path)
    done = subprocess.run([program], capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stdout) == (0, "all is so\n")


def test_numbers_are_shown_as_python_shows_them(harness: Harness) -> None:
    """The reports of both nodes say the same of any value."""
    drawn = random.Random(1)
    numbers = [0.0, -0.0, 0.9, 1e16, 1e15, 123456789012345680.0, 1e-4, 1e-5, 5e-324, 1.5, 100.0]
    numbers += [float("inf"), float("-inf"), float("nan"), 0.1 + 0.2, 1 / 3, 2.0**53]
    numbers += [struct.unpack("d", drawn.randbytes(8))[0] for _ in range(300)]
    numbers += [round(drawn.uniform(-1e6, 1e6), drawn.randrange(8)) for _ in range(300)]
    for value in numbers:
        bits = struct.pack(">d", value).hex()
        assert harness.ask("number", bits) == str(value)


def test_nodes_of_both_languages_give_way_alike(harness: Harness) -> None:
    """They meet each other, too."""
    drawn = random.Random(2)
    for _ in range(100):
        times = sorted(drawn.randrange(0, 15 * 10**9, 10**8) for _ in range(40))
        gone = drawn.randrange(40)
        looks = [(time, number != gone) for number, time in enumerate(times)]
        order = StartOrder(0)
        decided = "".join("ny"[order.gives_way(double, time)] for time, double in looks)
        text = ",".join(f"{time}{'+' if double else '-'}" for time, double in looks)
        assert harness.ask("order", text) == decided


@pytest.mark.parametrize("length", [0, 1, 55, 56, 63, 64, 65, 119, 120, 1000])
def test_the_digest_is_sha_256(harness: Harness, length: int) -> None:
    """At the ends of its blocks, too."""
    text = "".join(chr(97 + i % 26) for i in range(length))
    assert harness.ask("digest", text) == hashlib.sha256(text.encode()).hexdigest()


@pytest.mark.parametrize("name", ["/robot_safety", "/cell/one/robot_safety", "/" + "n" * 201])
def test_files_are_named_alike(harness: Harness, name: str) -> None:
    """One node takes over the other's files."""
    assert harness.ask("stem", name, 7) == file_stem(name, 7)


def test_the_usual_place_is_the_same(
    program: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """In ROS_HOME, or else in the home folder."""
    for home in (str(tmp_path), ""):
        monkeypatch.setenv("ROS_HOME", home)
        harness = Harness(program)
        assert harness.ask("place", "robot.0") == str(default_path("robot.0"))
        harness.close()


# The latch file -------------------------------------------------------------------------------


@pytest.mark.parametrize("active", [(), ("stop",), ("halt", "stop")])
def test_each_node_reads_what_the_other_wrote(
    harness: Harness, tmp_path: Path, active: tuple[str, ...]
) -> None:
    """Byte for byte the same file."""
    file = latch_file(tmp_path)
    assert harness.ask("save", file.path, OWNER, ",".join(active)) == "done"
    written = file.path.read_bytes()
    assert file.load(KNOWN) == (frozenset(active), "")
    file.path.unlink()
    file.save(frozenset(active))
    assert file.path.read_bytes() == written
    assert harness.ask("load", file.path, OWNER, ",".join(KNOWN)) == f"{','.join(active)}|"


def test_without_a_file_nothing_is_active(harness: Harness, tmp_path: Path) -> None:
    """The first start of a node is no fault."""
    assert harness.ask("load", tmp_path / "none", OWNER, "halt,stop") == "|"


def test_every_flipped_bit_and_every_shorter_file_is_noticed(
    harness: Harness, tmp_path: Path
) -> None:
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
def test_a_file_that_is_not_the_nodes_own_counts_as_active(
    harness: Harness, tmp_path: Path, names: str, owner: str, fragment: str
) -> None:
    """Another node's, or that of a node with other rules."""
    path = tmp_path / "robot.latches"
    harness.ask("save", path, owner, names)
    answer = harness.ask("load", path, OWNER, "halt,stop")
    assert answer.startswith("halt,stop|")
    assert fragment in answer


@pytest.mark.parametrize("how", ["mark_dirty", "truncate"])
def test_dirty_or_truncated_file_counts_as_active_in_both_languages(
    harness: Harness, tmp_path: Path, how: str
) -> None:
    """Whichever node comes next starts with all actions active."""
    file = latch_file(tmp_path)
    assert harness.ask(how, file.path, OWNER, "") == "done"
    assert file.load(KNOWN)[0] == frozenset(KNOWN)
    assert harness.ask("load", file.path, OWNER, "halt,stop").startswith("halt,stop|")


def test_a_file_that_cannot_be_written_says_why(harness: Harness, tmp_path: Path) -> None:
    """The text is for whoever has to mend it."""
    (tmp_path / "file").write_text("")
    answer = harness.ask("save", tmp_path / "file" / "robot.latches", OWNER, "stop")
    assert answer == "Not a directory"


def test_no_half_written_file_is_left(harness: Harness, tmp_path: Path) -> None:
    """Where the new file cannot take the old one's place, it goes."""
    (tmp_path / "robot.latches").mkdir()
    assert harness.ask("save", tmp_path / "robot.latches", OWNER, "stop") == (
        "it is a directory, not a regular file"
    )
    assert [path.name for path in tmp_path.iterdir()] == ["robot.latches"]


def put_link(path: Path) -> None:
    """Put a link to another file."""
    path.symlink_to(path.with_name("other"))


def put_pipe(path: Path) -> None:
    """Put a pipe, which would block whoever opens it."""
    os.mkfifo(path)


@pytest.mark.parametrize("put", [put_link, put_pipe, Path.mkdir])
def test_what_is_no_regular_file_is_left_alone(
    harness: Harness, tmp_path: Path, put: Callable[[Path], object]
) -> None:
    """Nothing else is read, emptied or replaced, nor locked."""
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


def test_what_a_killed_process_left_half_written_is_removed(
    harness: Harness, tmp_path: Path
) -> None:
    """Only that: other files in the folder are not the node's."""
    path = tmp_path / "robot.latches"
    kept = {"robot.latches.new", "other.latches.0123456789abcdef.new"}
    for name in (*kept, "robot.latches.0123456789abcdef.new"):
        (tmp_path / name).touch()
    assert harness.ask("leftovers", path, OWNER) == "done"
    assert {each.name for each in tmp_path.iterdir()} == kept


def test_a_missing_folder_is_made_for_the_user_alone(harness: Harness, tmp_path: Path) -> None:
    """As the Python node does it."""
    path = tmp_path / "made" / "for" / "robot.latches"
    assert harness.ask("save", path, OWNER, "stop") == "done"
    assert stat.S_IMODE(path.parent.stat().st_mode) == 0o700


# One instance ---------------------------------------------------------------------------------


def test_a_node_in_cpp_is_refused_beside_one_in_python(harness: Harness, tmp_path: Path) -> None:
    """The lock is one, whatever the language."""
    with claim("/robot", 7, tmp_path):
        answer = harness.ask("claim", tmp_path, 7, "/robot")
        assert answer == (
            f"/robot runs already in domain 7, as process {os.getpid()}: this second one ends now"
        )
    assert harness.ask("claim", tmp_path, 7, "/robot") == "held"


def test_a_node_in_python_is_refused_beside_one_in_cpp(harness: Harness, tmp_path: Path) -> None:
    """And other names and domains are free."""
    assert harness.ask("claim", tmp_path, 7, "/robot") == "held"
    with pytest.raises(Refusal, match=f"as process {harness.process.pid}"):
        claim("/robot", 7, tmp_path)
    with claim("/robot", 8, tmp_path), claim("/cell/robot", 7, tmp_path):
        pass
    harness.close()
    with claim("/robot", 7, tmp_path):
        pass
