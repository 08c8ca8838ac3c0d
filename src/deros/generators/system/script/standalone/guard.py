"""Ends the nodes when the script itself is killed."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
import contextlib
import ctypes
import os
import select
import signal
import sys

STOP_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGKILL)


def _linux_prctl() -> Callable[[int, int], int] | None:
    if not sys.platform.startswith('linux'):
        return None
    call: Callable[[int, int], int] = ctypes.CDLL(None, use_errno=True).prctl
    return call


PRCTL = _linux_prctl()
PR_SET_PDEATHSIG = 1
PR_SET_CHILD_SUBREAPER = 36


def signal_group(group: int, number: int) -> bool:
    """Send a signal to a process group (0 sends nothing); return whether the group exists."""
    try:
        os.killpg(group, number)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True


class Guard:
    """
    A process beside the script that ends the nodes if the script dies without having done so.

    It is told of each process group through a pipe, whose end of file says that the script is
    gone. A second pipe is held open by the nodes and all that they start: its end of file says
    that they are gone, too.
    """

    def __init__(self, patience: float, handled: Sequence[int] = ()) -> None:
        """
        Start the guard, which gives the nodes so many seconds from one signal to the next.

        The script's handlers of the handled signals are nothing for its children.
        """
        self._handled = handled
        notes, self._notes = os.pipe()
        alive, self._alive = os.pipe()
        with self.signals_held():
            self.pid = os.fork()
            if self.pid == 0:
                try:
                    os.setsid()  # a Ctrl-C is for the script alone
                    self._take_signals()
                    _watch(notes, alive, patience)
                finally:
                    os._exit(0)
        os.close(notes)
        os.close(alive)
        self.lost = False
        self._ticket = 0

    @contextlib.contextmanager
    def signals_held(self) -> Iterator[None]:
        """
        Hold signals back while a child begins.

        Until it runs its own program it has the script's handlers, which would tell the script
        of a signal, such as a terminal's to all, a second time: it would hurry.
        """
        self._mask = signal.pthread_sigmask(signal.SIG_BLOCK, self._handled)
        try:
            yield
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, self._mask)

    def _take_signals(self, blocked: Sequence[int] = ()) -> None:
        """Restore the default handling of signals in the calling child process."""
        signal.set_wakeup_fd(-1)
        for number in self._handled:
            signal.signal(number, signal.SIG_DFL)
        signal.pthread_sigmask(signal.SIG_SETMASK, {*self._mask, *blocked})

    @property
    def inherited(self) -> tuple[int, ...]:
        """Return the descriptors that the nodes have to keep open."""
        return (self._alive,)

    def ticket(self) -> int:
        """Return a new number, under which the next process is to be enrolled and released."""
        self._ticket += 1
        return self._ticket

    def enrol(self, blocked: Sequence[int] = ()) -> None:
        """
        Put the calling process, a new group's first, under guard before it runs its program.

        The program itself unblocks the blocked signals.
        """
        self._take_signals(blocked)
        if not self.lost:
            os.write(self._notes, b'%d %d\n' % (self._ticket, os.getpid()))
        if PRCTL is not None:
            PRCTL(PR_SET_PDEATHSIG, signal.SIGINT)

    def release(self, ticket: int) -> None:
        """Let a group go that has ended, or could not be started."""
        with contextlib.suppress(OSError):
            os.write(self._notes, b'%d\n' % ticket)

    def close(self) -> None:
        """End the guard, and with it what is still enrolled."""
        os.close(self._notes)
        os.close(self._alive)
        with contextlib.suppress(ChildProcessError):
            os.waitpid(self.pid, 0)


def _watch(notes: int, alive: int, patience: float) -> None:
    nothing = os.open(os.devnull, os.O_RDWR)
    for standard in (0, 1, 2):
        os.dup2(nothing, standard)
    low, high = sorted((notes, alive))
    os.closerange(3, low)
    os.closerange(low + 1, high)
    os.closerange(high + 1, os.sysconf('SC_OPEN_MAX'))
    groups: dict[int, int] = {}  # by ticket
    with open(notes, 'rb') as lines:
        for line in lines:
            ticket, *enrolled = map(int, line.split())
            groups.pop(ticket, None)
            groups.update((ticket, group) for group in enrolled)
    for stop_signal in STOP_SIGNALS if groups else ():
        # Where the kernel has passed on the script's end as a SIGINT, a second one would disturb
        # a node in the middle of its orderly end.
        if PRCTL is None or stop_signal is not signal.SIGINT:
            for group in groups.values():
                signal_group(group, stop_signal)
        if select.select([alive], [], [], patience)[0]:
            return
