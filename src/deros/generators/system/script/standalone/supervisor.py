"""Starts the nodes, watches them, and stops them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
import contextlib
import os
from pathlib import Path
import selectors
import shlex
import signal
import sys
import time

from .command_line import load_command
from .guard import Guard, PR_SET_CHILD_SUBREAPER, PRCTL, STOP_SIGNALS
from .node import awaited_by, Node, Row
from .output import Output
from .process import describe, Process, starting, State
from .watch.display import Display
from .watch.logs import Logs

# A node that is still starting is told to stop when it is up, or after so many seconds. Nothing
# tells of the moment at which it is up, so one looks again and again.
START_PATIENCE = 2.0
LOOK_AGAIN = 0.02

INTERRUPTED = 128 + signal.SIGINT  # the exit code after a Ctrl-C

WATCHED = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGCHLD)

# A node that was told to stop has done so when it ends by itself or by the signal it was sent.
STOPPED_BY = {
    signal.SIGINT: {0, -signal.SIGINT, 128 + signal.SIGINT},
    signal.SIGTERM: {-signal.SIGTERM, 128 + signal.SIGTERM},
    signal.SIGKILL: set[int](),
}


class Supervisor:
    """
    Runs processes until the last has ended.

    There is one thread, which waits for the next of these: output of a node, a reader that takes
    ours, a signal (SIGCHLD among them), and the moment at which something is due.
    """

    def __init__(
        self,
        system: str,
        processes: Sequence[Process],
        environment: dict[str, str],
        patience: float = 5.0,
        keep_going: bool = False,
        rows: Sequence[Row] = (),  # noqa: ARG002
    ) -> None:
        """
        Prepare to run the processes; the rows are those of the table, nodes inside included.

        The patience is the time in seconds that nodes have from one stop signal to the next; to
        keep going is to leave the others alone when a node fails.
        """
        self._system = system
        self._processes = processes
        self._environment = environment
        self._patience = patience
        self._keep_going = keep_going
        self._selector = selectors.PollSelector()
        sys.stdout.flush()
        self._output = Output(sys.stdout.fileno(), self._selector)
        self._held_back: list[Process] = []  # whose output waits until ours is read
        self._in_colour = sys.stdout.isatty() and not os.environ.get('NO_COLOR')
        if self._in_colour:
            environment.setdefault('RCUTILS_COLORIZED_OUTPUT', '1')
        self.show(Display)
        self._stopping = False
        self._interrupted = False
        self._failed = False

    @classmethod
    def by_hand(cls, node: Node) -> str:
        """Return the command for bash that loads a node into its container."""
        return shlex.join(load_command(node))

    def show(self, display: type[Display], log_folder: Path | None = None) -> None:
        """
        Set how the programs are shown, and where their log files are.

        Raises OpenError when these cannot be opened.
        """
        labels = [process.label for process in self._processes]
        logs = None if log_folder is None else Logs(log_folder, self._system, labels)
        self._display = display(self._system, labels, self._output, self._in_colour, logs)

    def run(self) -> int:
        """
        Start the processes and return 1 when one has failed, 130 after SIGINT, otherwise 0.

        The watched signals, if they are blocked, are handled meanwhile.
        """
        if PRCTL is not None:
            # What a node leaves behind becomes our child, so that its end is told to us.
            PRCTL(PR_SET_CHILD_SUBREAPER, 1)
        with self._signals():
            self._guard = Guard(self._patience, WATCHED)
            try:
                self._plan()
                self._loop()
                self._display.close(self._processes)
                self._output.drain(self._patience)
            finally:
                self._guard.close()
        if self._failed:
            return 1
        return INTERRUPTED if self._interrupted else 0

    # What is waited for ---------------------------------------------------------------------

    def _loop(self) -> None:
        while any(process.state is not State.ENDED for process in self._processes):
            self._display.draw(self._processes)
            dues = [self._display.due, *(process.due for process in self._processes)]
            moments = [due for due in dues if due is not None]
            timeout = max(0.0, min(moments) - time.monotonic()) if moments else None
            for key, _ in self._selector.select(timeout):
                # What was done for an earlier one may have closed this one.
                if self._selector.get_map().get(key.fd) is key:
                    key.data()
            if self._output.broken and not self._stopping:
                self._stop('nobody reads the output any more')
            if self._stopping or not self._output.full:
                self._take_up_again()
            self._next_due()

    @contextlib.contextmanager
    def _signals(self) -> Iterator[None]:
        """Turn signals into bytes in a pipe that the selector watches."""
        read, write = os.pipe()
        os.set_blocking(read, False)
        os.set_blocking(write, False)
        # In this order: a signal that came in between would wake nobody up.
        wakeup = signal.set_wakeup_fd(write, warn_on_full_buffer=False)
        before = {number: signal.signal(number, lambda *_: None) for number in WATCHED}
        self._selector.register(read, selectors.EVENT_READ, lambda: self._on_signals(read))
        mask = signal.pthread_sigmask(signal.SIG_UNBLOCK, WATCHED)
        try:
            yield
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, mask)
            self._selector.unregister(read)
            for number, handler in before.items():
                signal.signal(number, handler)
            signal.set_wakeup_fd(wakeup)
            os.close(read)
            os.close(write)

    def _on_signals(self, pipe: int) -> None:
        for number in os.read(pipe, 4096):
            if number == signal.SIGCHLD:
                continue
            self._interrupted |= number == signal.SIGINT
            if self._stopping:
                self._hurry()
            else:
                self._stop(f'received {signal.Signals(number).name}')
        self._reap()

    def _reap(self) -> None:
        """Reap ended programs, and find the process groups that are empty now."""
        running = {process.group: process for process in self._processes if process.group}
        with contextlib.suppress(ChildProcessError):
            while True:
                pid, status = os.waitpid(-1, os.WNOHANG)
                if pid == 0:
                    break
                if pid == self._guard.pid:
                    self._guard.lost = True
                    self._say('the guard is gone: nodes may live on if this script is killed')
                if pid in running:
                    running[pid].exit_code = os.waitstatus_to_exitcode(status)
        for process in running.values():
            if process.gone():
                self._ended(process)
            elif process.exit_code is not None and process.state is State.RUNNING:
                self._stop_process(process)  # its program has ended and left others behind

    def _next_due(self) -> None:
        """Do what is due, but start one node at most, so that no signal waits for all of them."""
        now = time.monotonic()
        for process in self._processes:
            if process.due is None or process.due > now:
                continue
            if process.state is State.WAITING:
                self._start(process)
                return
            self._next_signal(process)

    # The first start ------------------------------------------------------------------------

    def _plan(self) -> None:
        """Set when each program is started: at once, later, or after the exit of another one."""
        of_rows = {id(process.node): process for process in self._processes}
        rows = [process.node for process in self._processes]
        for process in self._processes:
            row = process.node
            awaited = awaited_by(row, rows)
            if awaited is not None:
                process.awaited, process.due = of_rows[id(awaited)], None
                continue
            if row.after:
                self._say(f'{process.label} does not wait for {row.after}, which is left out')
            if row.delay:
                process.due = time.monotonic() + row.delay

    def _waiting_for(self, process: Process) -> list[Process]:
        waiting = (each for each in self._processes if each.state is State.WAITING)
        return [each for each in waiting if each.awaited is process and each.due is None]

    def _start_next(self, process: Process) -> bool:
        """Have those started that wait for the exit of a program; return whether there are any."""
        waiting = self._waiting_for(process)
        for each in waiting:
            each.due = time.monotonic() + each.node.delay
        return bool(waiting)

    # The life of a node ---------------------------------------------------------------------

    def _start(self, process: Process) -> None:
        try:
            pipe = process.start(self._environment, self._guard)
        except OSError as error:
            self._guard.release(process.ticket)
            self._say(f'{process.label} cannot be started: {error}')
            self._failure(process)
            return
        self._say(f'{process.label} started, process {process.group}')
        self._listen(process, pipe)

    def _listen(self, process: Process, pipe: int) -> None:
        def on_output() -> None:
            if self._output.full and not self._stopping:
                self._selector.unregister(pipe)
                self._held_back.append(process)
                return
            lines, more = process.read()
            self._pass_on(process, lines)
            if not more:
                self._selector.unregister(pipe)

        self._selector.register(pipe, selectors.EVENT_READ, on_output)

    def _take_up_again(self) -> None:
        for process in self._held_back:
            if process.pipe is not None:
                self._listen(process, process.pipe)
        self._held_back.clear()

    def _ended(self, process: Process) -> None:
        """Decide what follows the end of a node: nothing, a restart, or the end of all."""
        self._guard.release(process.ticket)
        if process.pipe is not None:
            with contextlib.suppress(KeyError):  # after its end of file, or while it is held back
                self._selector.unregister(process.pipe)
            self._held_back = [held for held in self._held_back if held is not process]
        self._pass_on(process, process.close())
        assert process.exit_code is not None
        process.state, process.due, process.group = State.ENDED, None, 0
        well = self._stopping and self._has_stopped_well(process)
        process.end = 'stopped' if well else describe(process.exit_code)
        if self._stopping:
            self._failed |= not well
            self._say(f'{process.label} {process.end}')
        elif self._may_restart(process):
            self._say(f'{process.label} {process.end}; {self._restart(process)}')
        else:
            self._say(f'{process.label} {process.end}')
            is_awaited = self._start_next(process)
            if process.exit_code != 0:
                self._failure(process, is_awaited)
            if process.node.stops_all and not self._stopping:
                self._stop(f'{process.label} has ended')

    def _has_stopped_well(self, process: Process) -> bool:
        sent = STOP_SIGNALS[: max(1, process.signals_sent)]  # none yet while it starts
        if any(process.exit_code in STOPPED_BY[number] for number in sent):
            return True
        # A signal in the middle of Python's start ends it with any code, and harms nothing.
        return process.told_at_its_start and process.exit_code in range(1, 128)

    def _may_restart(self, process: Process) -> bool:
        most = process.node.respawn_max
        wanted = process.node.respawn_delay is not None
        return wanted and (most is None or process.restarts < most)

    def _restart(self, process: Process) -> str:
        delay = process.node.respawn_delay or 0.0
        most = process.node.respawn_max
        process.restarts += 1
        process.state = State.WAITING
        process.due = time.monotonic() + delay
        return f'restart {process.restarts}{"" if most is None else f" of {most}"} in {delay:g} s'

    def _failure(self, process: Process, is_awaited: bool = False) -> None:
        process.state, process.due = State.ENDED, None
        self._failed = True
        for each in self._waiting_for(process):
            self._say(f'{each.label} is not started: it waits for the exit of {process.label}')
            self._failure(each, is_awaited=True)
        if not self._stopping and not is_awaited and not self._goes_on_without(process):
            self._stop(f'{process.label} has failed')

    def _goes_on_without(self, process: Process) -> bool:  # noqa: ARG002
        return self._keep_going

    def _never_active(self, name: str) -> None:
        """Do what follows when a managed node could not be brought to active."""

    # The end --------------------------------------------------------------------------------

    def _stop(self, reason: str) -> None:
        self._stopping = True
        self._say(f'stopping: {reason}')
        self._stop_all()

    def _stop_all(self) -> None:
        for process in self._processes:
            if process.state is State.WAITING:
                process.state, process.due = State.ENDED, None
            elif process.state is State.RUNNING:
                self._stop_process(process)

    def _stop_process(self, process: Process) -> None:
        process.state, process.signals_sent = State.STOPPING, 0
        process.patient_until = time.monotonic() + min(START_PATIENCE, self._patience)
        self._next_signal(process)

    def _next_signal(self, process: Process) -> None:
        """Send a node's process group the next stop signal."""
        if process.signals_sent == len(STOP_SIGNALS):
            self._say(f'{process.label} cannot be killed, process {process.group} is left behind')
            process.end = 'left behind'
            self._failure(process)
            return
        now = time.monotonic()
        if process.signals_sent == 0 and now < process.patient_until and process.still_importing():
            process.due = now + LOOK_AGAIN
            return
        number = STOP_SIGNALS[process.signals_sent]
        if process.signals_sent > 0:
            self._say(f'{process.label} is still running, sending {number.name}')
        else:
            process.told_at_its_start = starting(process.group)
        process.signals_sent += 1
        process.due = now + self._patience + process.send(number)

    def _hurry(self) -> None:
        for process in self._processes:
            if process.state is State.STOPPING and process.signals_sent < len(STOP_SIGNALS):
                process.due = process.patient_until = 0.0

    # What is said ---------------------------------------------------------------------------

    def _pass_on(self, process: Process, lines: Sequence[bytes]) -> None:
        self._display.pass_on(process.label, lines, self._output.full and self._stopping)

    def _say(self, text: str) -> None:
        self._display.say(text)
