"""The part of the system on one host, as the one who has started it lets it run."""

from __future__ import annotations

from collections.abc import Callable, Sequence
import json
import os
import selectors
import sys
import time
from types import SimpleNamespace
from typing import Any, ClassVar

from ..arguments import Argument, main_with_arguments
from ..command import _matches
from ..node import Preparation, Row
from ..process import Process, State
from ..supervisor import Supervisor

AS_PART = '--as-part'  # in front of the words of a script that another one has started
CONTROL = b'\0deros '  # begins what is said to the starter; the lines of nodes begin with a label
READY, STOP_ALL = b'ready', b'stop-all'
GO, STOP = b'go', b'stop'


class PartSupervisor(Supervisor):
    """
    Starts the processes when the starter says so, at the standard input, and stops them likewise.

    The end of that input, and silence there, mean that the connection is lost, or the starter
    gone: the processes are stopped then, too.
    """

    in_colour: ClassVar[bool] = False
    silence: ClassVar[float] = 10.0  # seconds after which the connection is lost
    unmatched: ClassVar[Sequence[str]] = ()  # patterns that no program here matches

    def __init__(self, *arguments: Any, **named: Any) -> None:
        """Prepare to run the processes; the arguments are those of a Supervisor."""
        super().__init__(*arguments, **named)
        if self.in_colour:
            self._in_colour = True
            self._environment.setdefault('RCUTILS_COLORIZED_OUTPUT', '1')
        self._heard = b''

    def _plan(self) -> None:
        for process in self._processes:
            process.due = None
        os.set_blocking(0, False)
        self._selector.register(0, selectors.EVENT_READ, self._hear_starter)
        self._heard_now()
        self._tell_starter(READY + b' ' + json.dumps(list(self.unmatched)).encode())

    def _heard_now(self) -> None:
        # The loop goes on when the display is due, which is all that a plain one does.
        self._display.due = time.monotonic() + self.silence

    def _tell_starter(self, what: bytes) -> None:
        self._output.write(CONTROL + what + b'\n')

    def _hear_starter(self) -> None:
        try:
            data = os.read(0, 4096)
        except BlockingIOError:
            return
        except OSError:
            data = b''
        if not data:
            self._selector.unregister(0)
            self._lose('the connection is lost')
            return
        self._heard_now()
        *words, self._heard = (self._heard + data).split(b'\n')
        for word in words:
            if word == STOP:
                self._told('all hosts are stopped')
            elif word == GO and not self._stopping:
                for process in self._processes:
                    process.due = 0.0
                super()._plan()

    def _lose(self, reason: str) -> None:
        """Stop without the starter, and as a failure, for whoever still reads that."""
        self._failed = True
        if not self._stopping:
            self._stop(reason)

    def _told(self, reason: str) -> None:
        if self._stopping:
            self._hurry()
        else:
            self._stop(reason)

    def _next_due(self) -> None:
        due = self._display.due
        if due is not None and due <= time.monotonic():
            self._display.due = None
            self._lose(f'nothing has come through the connection for {self.silence:g} s')
        super()._next_due()

    def _ended(self, process: Process) -> None:
        super()._ended(process)
        if process.node.stops_all and process.state is State.ENDED:
            self._tell_starter(STOP_ALL)


def run_part(
    system: str,
    declared: Sequence[Argument],
    nodes: Callable[..., Sequence[Row]],
    words: Sequence[str],
    start: object = None,
    supervisor: type[Supervisor] | None = None,
    preparation: Preparation | None = None,
) -> int:
    """Run the rows of a host, given the words behind AS_PART."""
    said, *others = words
    note = json.loads(said)
    only, excluded = note['only'], note['excluded']
    bases: tuple[type, ...] = (PartSupervisor, *([supervisor] if supervisor else []))
    kind: type[PartSupervisor] = type('Part', bases, {})
    kind.in_colour, kind.silence = note['colour'], note['silence']

    def chosen(given: SimpleNamespace, *context: object) -> Sequence[Row]:
        rows = nodes(given, *context)
        kind.unmatched = [
            each for each in (*only, *excluded) if not any(_matches(row, each) for row in rows)
        ]
        return [
            row
            for row in rows
            if (not only or any(_matches(row, each) for each in only))
            and not any(_matches(row, each) for each in excluded)
        ]

    code = main_with_arguments(
        system,
        declared,
        chosen,
        others,
        start=start,
        supervisor=kind,
        preparation=preparation,
    )
    if code == 2 and not os.environ.get('AMENT_PREFIX_PATH'):
        print(
            'No setup file of ROS 2 has been sourced here: name one at the host in the system, as '
            'in \'host … setup "/opt/ros/jazzy/setup.bash"\'',
            file=sys.stderr,
        )
    return code
