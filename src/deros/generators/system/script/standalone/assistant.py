"""Processes beside the nodes that call services for the script, which needs no rclpy itself."""

from __future__ import annotations

from collections.abc import Callable, Sequence
import contextlib
from pathlib import Path
import socket
import subprocess
import sys

from .guard import Guard
from .node import Node, Row
from .process import Process
from .programs import QUIET_START

# The file that holds the function is the script itself, whose nodes are not started by that.
CALL = (
    f'{QUIET_START}import runpy; file, module, name, *rest = sys.argv[1:]; '
    'sys.exit(runpy.run_path(file, run_name=module)[name](*rest))'
)
MISSING = (
    'import importlib.util, sys; '
    'print(*(name for name in sys.argv[1:] if importlib.util.find_spec(name) is None))'
)


def location(function: Callable[..., object]) -> list[str]:
    """Return where a function is for another process: the file, the module and the name."""
    file = str(Path(function.__code__.co_filename).absolute())
    module = function.__module__
    return [file, module if '.' in module else 'assistant', function.__name__]  # never __main__


def calling(function: Callable[..., object], arguments: Sequence[str]) -> list[str]:
    """Return the command that calls a function and ends with what it returns."""
    return [sys.executable, '-c', CALL, *location(function), *arguments]


class Assistant(Process):
    """A process that is told of nodes through its standard input, and answers there."""

    def __init__(self, label: str, function: Callable[..., int], arguments: Sequence[str]) -> None:
        """Set the command that calls a function of a module, without starting it."""
        super().__init__(Node(label, '/', '', ''), label, calling(function, arguments))
        self.talk, self._its_end = socket.socketpair()
        self.talk.setblocking(False)
        self.standard_input = self._its_end.fileno()
        self._heard = b''

    def start(self, environment: dict[str, str], guard: Guard) -> int:
        """Start it as any process; its end of what we talk through is its own."""
        try:
            return super().start(environment, guard)
        finally:
            self._its_end.close()

    def tell(self, what: str, node: Row) -> None:
        """Tell it that a node has started, has ended, or is gone for good."""
        with contextlib.suppress(OSError):  # it has ended itself
            self.talk.sendall(f'{what} {node.full_name}\n'.encode())

    def finish(self) -> None:
        """Tell it that there is nothing more to tell."""
        with contextlib.suppress(OSError):
            self.talk.shutdown(socket.SHUT_WR)

    def hear(self) -> tuple[list[tuple[str, str]], bool]:
        """Return what it has said, each with the name of a node, and whether more may follow."""
        try:
            data = self.talk.recv(4096)
        except BlockingIOError:
            return [], True
        except OSError:
            data = b''
        *lines, self._heard = (self._heard + data).split(b'\n')
        said = (line.decode().partition(' ') for line in lines)
        return [(what, name) for what, _, name in said], bool(data)


def lacks(needed: Sequence[str], purpose: str, advice: str, environment: dict[str, str]) -> bool:
    """Return whether our interpreter lacks modules in an environment, and say so if it does."""
    command = [sys.executable, '-c', MISSING, *needed]
    found = subprocess.run(command, capture_output=True, text=True, env=environment)
    missing = found.stdout.split() if found.returncode == 0 else needed
    if missing:
        print(
            f'{purpose}, and {sys.executable} has no {" and no ".join(missing)}, so nothing was '
            f'started.\n{advice}',
            file=sys.stderr,
        )
    return bool(missing)


def complaint(
    function: Callable[..., int], arguments: Sequence[str], environment: dict[str, str]
) -> str:
    """Return what a function says in a process of its own when it returns 1, or what ends it."""
    command = calling(function, arguments)
    found = subprocess.run(command, capture_output=True, text=True, env=environment)
    return (found.stdout or found.stderr) if found.returncode else ''
