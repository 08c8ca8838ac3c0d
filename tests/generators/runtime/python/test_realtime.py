"""Real-time settings of the process."""

from __future__ import annotations

import ctypes
import gc
import os
import subprocess
import sys
from collections.abc import Iterator
from unittest.mock import Mock

import pytest

from deros.generators.runtime.python.deros_runtime import realtime


@pytest.fixture(autouse=True)
def collecting() -> Iterator[None]:
    """Restore the garbage collection of the test process afterwards."""
    yield
    gc.enable()


def test_defaults_change_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """No priority, no locked memory, garbage collection as it is."""
    monkeypatch.setattr(os, "sched_setscheduler", Mock(side_effect=AssertionError))
    monkeypatch.setattr(ctypes, "CDLL", Mock(side_effect=AssertionError))
    assert realtime.configure_process(0, lock_memory=False, garbage_collection=True) == []
    assert gc.isenabled()


def test_every_thread_gets_the_priority(monkeypatch: pytest.MonkeyPatch) -> None:
    """This includes threads of the middleware, which deliver the messages."""
    setting = Mock()
    monkeypatch.setattr(os, "sched_setscheduler", setting)
    assert realtime.configure_process(40, lock_memory=False, garbage_collection=True) == []
    threads = {call.args[0] for call in setting.call_args_list}
    assert threads == {int(thread) for thread in os.listdir("/proc/self/task")}  # noqa: PTH208
    for call in setting.call_args_list:
        assert call.args[1] == os.SCHED_FIFO
        assert call.args[2].sched_priority == 40


def test_missing_permission_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    """The node runs without the setting."""
    refusing = Mock(side_effect=PermissionError(1, "Operation not permitted"))
    monkeypatch.setattr(os, "sched_setscheduler", refusing)
    library = Mock()
    library.mlockall.return_value = -1
    monkeypatch.setattr(ctypes, "CDLL", lambda *_, **__: library)
    monkeypatch.setattr(ctypes, "get_errno", lambda: 1)
    monkeypatch.setattr(realtime, "can_lock_memory", lambda: True)
    priority, memory = realtime.configure_process(40, lock_memory=True, garbage_collection=True)
    assert priority.startswith("realtime_priority 40 is not permitted")
    assert memory == "lock_memory is not permitted: Operation not permitted"


def test_memory_is_locked_permanently(monkeypatch: pytest.MonkeyPatch) -> None:
    """Current and future pages are locked."""
    library = Mock()
    library.mlockall.return_value = 0
    monkeypatch.setattr(ctypes, "CDLL", lambda *_, **__: library)
    monkeypatch.setattr(realtime, "can_lock_memory", lambda: True)
    assert realtime.configure_process(0, lock_memory=True, garbage_collection=True) == []
    library.mlockall.assert_called_once_with(3)


def test_memory_is_not_locked_under_a_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    """Otherwise the node would end when it needs more than the limit, hours later."""
    monkeypatch.setattr(ctypes, "CDLL", Mock(side_effect=AssertionError))
    monkeypatch.setattr(realtime, "can_lock_memory", lambda: False)
    (refusal,) = realtime.configure_process(0, lock_memory=True, garbage_collection=True)
    assert refusal == "lock_memory is not permitted: it needs an unlimited RLIMIT_MEMLOCK"


def test_garbage_collection_can_be_disabled() -> None:
    """The parameter decides."""
    assert realtime.configure_process(0, lock_memory=False, garbage_collection=False) == []
    assert not gc.isenabled()


def test_timer_slack_is_minimised() -> None:
    """This thread's timers have the smallest slack of Linux."""
    realtime.minimize_timer_slack()
    assert ctypes.CDLL(None).prctl(30, 0, 0, 0, 0) == 1  # PR_GET_TIMERSLACK


def test_full_pipe_does_not_block() -> None:
    """Excess output is lost; other users of the pipe still wait for its reader."""
    reader, writer = os.pipe()
    code = (
        "import os; from deros.generators.runtime.python.deros_runtime import realtime\n"
        "realtime.make_output_nonblocking()\n"
        "try:\n while True: os.write(2, bytes(4096))\nexcept BlockingIOError: os._exit(7)"
    )
    done = subprocess.run([sys.executable, "-c", code], stderr=writer, timeout=60)
    assert done.returncode == 7
    assert os.get_blocking(writer)
    for end in (reader, writer):
        os.close(end)
