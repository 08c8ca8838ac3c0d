"""Runs the parts of a system, each on its host, and stops them together."""

from __future__ import annotations

from collections.abc import Sequence
import json
import os
import signal
import time
from typing import Any, ClassVar

from ..guard import Guard, signal_group
from ..node import Program
from ..output import Output
from ..process import Process, State
from ..supervisor import INTERRUPTED, Supervisor
from .connection import FAILED, Host, meaning
from .part import CONTROL, GO, READY, STOP, STOP_ALL

BEATS = 5  # how often a part hears of us in the time after which the connection counts as lost
LONGER = 10.0  # seconds that a part may take to stop, besides those of its own three signals


class Talk(Output):
    """What is said to a part, as fast as it listens."""

    def close(self) -> None:
        """Forget what has not been read."""
        if not self.is_empty:
            self._selector.unregister(self._descriptor)
            self._held.clear()


class PartProcess(Process):
    """The part of one host: ssh, or the script itself where that is here."""

    def __init__(
        self, host: Host, command: list[str], data: bytes, patience: float, is_here: bool
    ) -> None:
        """Set the command, and what it is sent first, without starting it."""
        super().__init__(Program(host.name, command[0]), host.name, command)
        self.host = host
        self.is_here = is_here
        self.data = data
        self.ready = False
        self.failed = False  # before it was told to go
        self.told_to_go = False
        self.unmatched: list[str] = []  # patterns that none of its programs matches
        self.held: list[bytes] = []  # what it has said before all were ready
        self._longer = 3 * patience + LONGER
        self.standard_input, self.line_of_life = os.pipe()
        self.talk: Talk | None = None

    def start(self, environment: dict[str, str], guard: Guard) -> int:
        """Start it as any process; its end of the pipe is its own."""
        try:
            return super().start(environment, guard)
        finally:
            os.close(self.standard_input)

    def tell(self, what: bytes) -> None:
        """Tell it something, if it still listens."""
        if self.talk is not None:
            self.talk.write(what + b'\n')

    def close_talk(self) -> None:
        """Let it know that nothing more is to be told."""
        if self.talk is not None:
            self.talk.close()
            os.close(self.line_of_life)
            self.talk = None

    def still_importing(self) -> bool:
        """Return False: it is told to stop by no signal."""
        return False

    def send(self, number: int) -> float:
        """Have it stop its programs, and again more urgently; in the end, cut the connection."""
        if not (self.told_to_go or self.ready) or number == signal.SIGKILL:
            signal_group(self.group, number)
            return 0.0
        self.tell(STOP)
        return self._longer


class HostsSupervisor(Supervisor):
    """Starts all parts, has them begin when the last one is ready, and stops them together."""

    silence: ClassVar[float] = 10.0  # seconds after which a connection counts as lost
    dry_run: ClassVar[bool] = False
    _processes: Sequence[PartProcess]

    def __init__(self, *arguments: Any, **named: Any) -> None:
        """Prepare to run the parts; the arguments are those of a Supervisor."""
        super().__init__(*arguments, **named)
        self._under_way = False
        self._is_muted = False
        self._unsaid = ''

    def run(self) -> int:
        """Run the parts; return 2 when one of them could not be made ready."""
        code = super().run()
        if self._under_way:
            return code
        if any(part.failed for part in self._processes):
            return 2
        if self._interrupted:
            return INTERRUPTED
        return 0 if self.dry_run and not self._stopping else 2

    def _plan(self) -> None:
        # The loop goes on when the display is due, which is all that a plain one does.
        self._display.due = time.monotonic()

    def _next_due(self) -> None:
        now = time.monotonic()
        if self._display.due is not None and self._display.due <= now:
            self._display.due = now + self.silence / BEATS
            for part in self._processes:
                part.tell(b'')
        super()._next_due()

    def _start(self, process: Process) -> None:
        part = self._part(process)
        self._is_muted = True
        super()._start(part)
        self._is_muted = False
        if not part.group:
            self._say(self._unsaid)
            part.failed = True
            self._answered()
            return
        where = 'here' if part.is_here else f'over ssh to {part.host.address}'
        self._say(f'{part.label} is prepared {where}, process {part.group}')
        os.set_blocking(part.line_of_life, False)
        part.talk = Talk(part.line_of_life, self._selector)
        part.talk.write(part.data)

    def _part(self, process: Process) -> PartProcess:
        assert isinstance(process, PartProcess)
        return process

    # Before all are ready -------------------------------------------------------------------

    def _pass_on(self, process: Process, lines: Sequence[bytes]) -> None:
        part = self._part(process)
        own = [line for line in lines if not line.startswith(CONTROL)]
        if part.told_to_go:
            super()._pass_on(part, own)
        else:
            part.held += own
        for line in lines:
            if line.startswith(CONTROL):
                self._hear(part, line.removeprefix(CONTROL))

    def _hear(self, part: PartProcess, line: bytes) -> None:
        what, _, rest = line.partition(b' ')
        if what == READY and not part.ready:
            part.ready, part.unmatched = True, json.loads(rest)
            self._answered()
        elif what == STOP_ALL and self._under_way and not self._stopping:
            self._stop(f'{part.label} says so')

    def _answered(self) -> None:
        """Go on once each part is ready, or has failed."""
        waiting = [p for p in self._processes if not p.ready and p.state is not State.ENDED]
        if waiting or self._under_way or self._stopping or self.dry_run:
            return
        common = set.intersection(*(set(part.unmatched) for part in self._processes))
        if any(part.failed for part in self._processes):
            self._stop('nothing has been started')
        elif common:
            unknown = ', '.join(map(repr, sorted(common)))
            self._say(f'no node is called {unknown} on any of the hosts')
            self._stop('nothing has been started')
        else:
            self._go()

    def _go(self) -> None:
        self._under_way = True
        for part in self._processes:
            part.told_to_go = True
            part.tell(GO)
            super()._pass_on(part, part.held)

    def _goes_on_without(self, process: Process) -> bool:
        return not self._under_way or super()._goes_on_without(process)

    # The end of a part ----------------------------------------------------------------------

    def _ended(self, process: Process) -> None:
        part = self._part(process)
        part.close_talk()
        if self._under_way:
            if part.exit_code == FAILED and not part.is_here:
                self._say(f'the connection to {part.label} is lost')
            super()._ended(part)
            return
        stopping = self._stopping
        self._is_muted = True
        super()._ended(part)
        self._is_muted = False
        if stopping:
            return
        part.failed = part.exit_code != 0 or not (part.ready or self.dry_run)
        if part.failed or self.dry_run:
            reached = part.is_here or part.exit_code != FAILED
            super()._pass_on(part, part.held if reached else [])
        if part.failed:
            self._say(meaning(part.host, part.exit_code or 0, part.held))
        self._answered()

    def _say(self, text: str) -> None:
        if self._is_muted:
            self._unsaid = text
        else:
            super()._say(text)
