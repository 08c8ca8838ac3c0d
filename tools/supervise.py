"""Run a command and leave none of its descendants behind, however it ends.

    python tools/supervise.py COMMAND [ARGUMENT…]

The command's exit code is passed on. SIGINT, SIGTERM and SIGHUP are passed to the command, which
gets time to stop what it started; whatever outlives it is terminated, then killed. Should our own
parent die, or this process itself be killed, the kernel sends SIGTERM in its place. Linux only (see
prctl(2): PR_SET_CHILD_SUBREAPER hands us the orphans of our descendants, PR_SET_PDEATHSIG ties a
process to its parent).
"""

from __future__ import annotations

import ctypes
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from types import FrameType

_PR_SET_PDEATHSIG = 1
_PR_SET_CHILD_SUBREAPER = 36
_GRACE_S = 10.0
_FORWARDED = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)

_libc = ctypes.CDLL(None, use_errno=True)


def main(command: list[str]) -> int:
    """Run ``command`` and return its exit code, 128 + N if signal N ended it."""
    _libc.prctl(_PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    _die_with_parent()
    received: list[int] = []
    # Handlers, not SIG_IGN: what is ignored here would stay ignored in the command.
    for number in _FORWARDED:
        signal.signal(number, lambda got, _frame: received.append(got))
    child = subprocess.Popen(command, preexec_fn=_die_with_parent, start_new_session=True)

    def forward(number: int, _frame: FrameType | None) -> None:
        child.send_signal(number)

    for number in _FORWARDED:
        signal.signal(number, forward)
    for early in received:
        child.send_signal(early)
    try:
        code = child.wait()
    finally:
        _clear()
    return code if code >= 0 else 128 - code


def _die_with_parent() -> None:
    _libc.prctl(_PR_SET_PDEATHSIG, signal.SIGTERM, 0, 0, 0)


def _clear() -> None:
    """Terminate what the command left, then kill it; orphans come to us as their parents die."""
    deadline = time.monotonic() + _GRACE_S
    asked: set[int] = set()
    signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGCHLD])
    while _reap():
        late = time.monotonic() > deadline
        for pid in _children():
            if late or pid not in asked:
                asked.add(pid)
                _signal(pid, signal.SIGKILL if late else signal.SIGTERM)
        # SIGCHLD ends the wait early; an orphan that comes to us without one is seen soon after.
        signal.sigtimedwait([signal.SIGCHLD], 0.1)


def _children() -> list[int]:
    return [int(pid) for pid in Path(f"/proc/self/task/{os.getpid()}/children").read_text().split()]


def _signal(pid: int, number: int) -> None:
    try:
        os.kill(pid, number)
    except ProcessLookupError:
        return


def _reap() -> bool:
    """Collect finished children; tell whether any are left."""
    while True:
        try:
            pid, _ = os.waitpid(-1, os.WNOHANG)
        except ChildProcessError:
            return False
        if pid == 0:
            return True


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1:]))
