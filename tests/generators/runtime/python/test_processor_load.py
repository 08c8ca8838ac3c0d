"""The processor load of real processes, found by the name that their command line gives a node."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator

import pytest

from deros.generators.runtime.python.deros_runtime import processor_load
from deros.generators.runtime.python.deros_runtime.processor_load import (
    Found,
    LoadMeter,
    NoProcess,
    find_process,
    node_of,
)
from tests.support.burners import (
    HAS_CHILD_BURN,
    HAS_COPY,
    STANDS_IN_FRONT,
    burning,
    named,
    processor_time,
    until_used,
)

TICK = 0.01
"""The step in s in which the system counts processor time."""

FINDS = f"""
import sys
from {processor_load.__name__} import find_process
print(find_process(sys.argv[1]).pid)
"""
"""A program that finds the process of a node."""


@pytest.fixture
def node() -> str:
    """Return the full name of a node that no other test uses, in this process or another."""
    return f"/load_{os.getpid()}/burner_{time.monotonic_ns()}"


@pytest.mark.parametrize("share", [0.2, 0.5, 1.0])
def test_load_is_the_share_of_one_processor_that_the_process_uses(node: str, share: float) -> None:
    """It agrees with the kernel's own clock of the process, within the steps that it is counted in.

    How much of a processor the process really gets depends on what else runs.
    """
    with burning(node, share) as (process, _):
        meter = LoadMeter(node)
        assert meter.measure() is None
        assert meter.process == process.pid
        until_used(process.pid, 0.1)
        meter.measure()
        began, used = time.monotonic(), processor_time(process.pid)
        until_used(process.pid, 0.4)
        load = meter.measure()
        seconds = time.monotonic() - began
        expected = 100.0 * (processor_time(process.pid) - used) / seconds
        assert load == pytest.approx(expected, abs=100.0 * 3 * TICK / seconds)
        assert load is not None
        assert load < 100.0 * (share + 0.1)


def test_load_of_what_a_process_has_started_is_not_its_own(node: str) -> None:
    """The child uses a processor, and its parent none."""
    with burning(node, program=HAS_CHILD_BURN) as (process, (_, child)):
        meter = LoadMeter(node)
        meter.measure()
        until_used(int(child), 0.3)
        load = meter.measure()
        assert load is not None
        assert load < 20.0
        assert meter.process == process.pid
        process.communicate()  # its input ends, so the child does


def test_process_that_is_gone_has_no_load(node: str) -> None:
    """Neither once it has ended, nor while nobody has waited for it yet."""
    meter = LoadMeter(node)
    with pytest.raises(
        NoProcess, match=f"no process on this computer has been started as .*{node}"
    ):
        meter.measure()
    with burning(node, 1.0) as (process, _):
        meter.measure()
        assert meter.measure() is not None
        process.kill()
        os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)  # it is a zombie now
        with pytest.raises(NoProcess):
            meter.measure()
    with pytest.raises(NoProcess):
        meter.measure()
    assert meter.process is None


def test_process_that_is_started_again_is_measured_anew(node: str) -> None:
    """Its first load is one since it was found; that of the old process does not count."""
    meter = LoadMeter(node)
    with burning(node, 1.0) as (first, _):
        meter.measure()
        until_used(first.pid, 0.3)
    with burning(node, 0.0) as (second, _):
        assert meter.measure() is None
        assert meter.process == second.pid
        load = meter.measure()
        assert load is not None
        assert load >= 0.0


def test_number_of_a_process_that_is_used_again_is_another_process(node: str) -> None:
    """The time of the start tells them apart."""
    with burning(node) as (process, _):
        sample = processor_load.read_sample(process.pid)
        assert sample is not None
        later = processor_load.Sample(
            sample.pid, sample.parent, sample.began, sample.used + 5, sample.taken + 1.0
        )
        other = processor_load.Sample(
            sample.pid, sample.parent, sample.began + 1, 0, sample.taken + 1.0
        )
        assert later.is_later_than(sample)
        assert not other.is_later_than(sample)


def test_program_behind_a_prefix_is_found(node: str) -> None:
    """A debugger has the words of the program in its own command line."""
    prefix = [sys.executable, "-c", STANDS_IN_FRONT]
    with burning(node, 0.0, before=prefix) as (process, _):
        found = find_process(node).pid
        try:
            assert found != process.pid
            assert processor_load.read_sample(found).parent == process.pid  # type: ignore[union-attr]
        finally:
            os.kill(found, signal.SIGKILL)
            process.wait()


def test_copy_that_a_process_has_made_of_itself_is_not_the_node(node: str) -> None:
    """It has the same command line."""
    with burning(node, program=HAS_COPY) as (process, (_, copy)):
        assert find_process(node).pid == process.pid != int(copy)
        process.communicate()


def test_several_processes_of_one_name_are_none(node: str) -> None:
    """The text names both."""
    with burning(node) as (first, _), burning(node) as (second, _), pytest.raises(NoProcess) as why:
        find_process(node)
    low, high = sorted([first.pid, second.pid])
    assert str(why.value) == f"2 processes have been started as node {node}: {low}, {high}"


def test_node_in_another_domain_is_left_out(node: str) -> None:
    """Two robots of one name may be on a computer."""
    other = {**os.environ, "ROS_DOMAIN_ID": "77"}
    with burning(node, env=other):
        with pytest.raises(NoProcess):
            find_process(node)
        with burning(node) as (ours, _):
            assert find_process(node).pid == ours.pid


def test_what_the_same_program_has_started_counts_first(node: str) -> None:
    """Another robot of the same names, in the same domain, has its own starter."""
    with _started_elsewhere(node) as elsewhere:
        assert find_process(node) == Found(elsewhere, beside=False)
        with burning(node) as (ours, _):
            found = subprocess.run(
                [sys.executable, "-c", FINDS, node], capture_output=True, text=True, check=True
            )
            assert int(found.stdout) == ours.pid


MEASURES = f"""
import sys
from {processor_load.__name__} import LoadMeter, NoProcess
meter = LoadMeter(sys.argv[1])
for _ in sys.stdin:
    try:
        meter.measure()
        print(meter.process, flush=True)
    except NoProcess as why:
        print(why, flush=True)
"""
"""A program that measures for each line of its input, and prints of which process."""


def test_stranger_does_not_take_the_place_of_a_process_that_has_ended(node: str) -> None:
    """Its load would be published as that of the robot's own node."""
    with (
        _started_elsewhere(node),
        subprocess.Popen(
            [sys.executable, "-c", MEASURES, node],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        ) as meter,
    ):
        with burning(node) as (first, _):
            assert _asked(meter) == str(first.pid)
        assert _asked(meter) == f"no process beside this one has been started as node {node}"
        with burning(node) as (second, _):
            assert _asked(meter) == str(second.pid)
        meter.communicate()


def _asked(meter: subprocess.Popen[str]) -> str:
    """Have a program of :data:`MEASURES` measure, and return what it prints."""
    assert meter.stdin is not None
    assert meter.stdout is not None
    meter.stdin.write("\n")
    meter.stdin.flush()
    return meter.stdout.readline().rstrip("\n")


@contextlib.contextmanager
def _started_elsewhere(node: str) -> Iterator[int]:
    """Run a process of the name of a node that another program has started; give its number."""
    start = (
        "import subprocess, sys; sys.path.insert(0, '.')\n"
        "from tests.support.burners import burning\n"
        f"with burning({node!r}) as (process, _):\n"
        "    print(process.pid, flush=True)\n"
        "    sys.stdin.read()\n"
    )
    with subprocess.Popen(
        [sys.executable, "-c", start], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as starter:
        assert starter.stdout is not None
        yield int(starter.stdout.readline())
        starter.communicate()


@pytest.mark.parametrize(
    ("words", "node"),
    [
        (["eye", "--ros-args", "-r", "__node:=eye"], "/eye"),
        (["eye", "--ros-args", "--remap", "__ns:=/front", "--remap", "__node:=eye"], "/front/eye"),
        (["eye", "--ros-args", "-r", "__ns:=/", "-r", "__node:=eye"], "/eye"),
        (["eye", "--ros-args", "-r", "__node:=eye", "-r", "__node:=ear"], "/eye"),
        (["eye", "-r", "__node:=eye"], None),
        (["eye", "--ros-args", "-p", "x:=1", "--", "-r", "__node:=eye"], None),
        (["eye", "--ros-args", "-r", "part:__node:=eye"], None),
        (["eye", "--ros-args", "-r"], None),
        (["echo __node:=eye"], None),
        ([""], None),
    ],
)
def test_name_of_a_node_is_read_as_ros_reads_it(words: list[str], node: str | None) -> None:
    """Rules count behind --ros-args, until a --; those for one node of several are not for all."""
    assert node_of(words) == node


def test_words_of_a_command_line_round_trip() -> None:
    """What deros gives a node is what is read back."""
    assert node_of(["x", *named("/a/b/c")]) == "/a/b/c"
    assert node_of(["x", *named("/c")]) == "/c"
