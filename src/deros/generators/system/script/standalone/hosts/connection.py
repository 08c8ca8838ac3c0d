"""The command that runs a part of the system on its host, and what its failure means."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
import inspect
import json
import math
import re
import shlex

from .far import run_script, source_first

FAILED = 255  # the exit code of ssh itself
NOT_FOUND = 127  # that of a shell without a program
_UNFIT = re.compile(r'-|.*[\s\x00-\x1f\x7f]|$', re.DOTALL)

# No shell finds anything in it but two words and one in quotes: it may be the shell of any user.
READ = (
    'import functools,os;'
    'exec(functools.reduce(lambda d,_:d+os.read(0,{size}-len(d)),range({size}),b""))'
)


@dataclass(frozen=True)
class Host:
    """A computer of the system: its name, where ssh finds it, and what to source there."""

    name: str
    address: str
    setup: str = ''

    def fault(self) -> str | None:
        """Return why ssh cannot be given the address; None if it can."""
        if _UNFIT.match(self.address):
            return f'the address {self.address!r} of host {self.name!r} is none for ssh'
        return None


def ssh_command(words: str, host: Host, timeout: float, size: int) -> list[str]:
    """
    Return the command that runs Python on a host, which runs what it reads first.

    The words are those of ssh itself: of an option that is there twice, ssh takes the first.
    """
    options = {
        'BatchMode': 'yes',  # a question in the middle of a start would hang it
        'ConnectTimeout': math.ceil(timeout),
        'ServerAliveInterval': math.ceil(timeout / 2),
        'ServerAliveCountMax': 2,
        'ControlPath': 'none',  # one that is shared would outlive us
    }
    given = [word for name, value in options.items() for word in ('-o', f'{name}={value}')]
    command = f"exec python3 -c '{READ.format(size=size)}'"
    return [*shlex.split(words), '-T', *given, '--', host.address, command]


def sent(
    setup: str, script: str, files: Mapping[str, str], words: Sequence[str]
) -> tuple[bytes, int]:
    """
    Return what a Python that runs what it reads first is sent, and how long that first is.

    With the script, one of the files, it is started there with these words.
    """
    note = json.dumps({'script': script, 'files': files, 'words': list(words)}).encode()
    code = f'{inspect.getsource(run_script)}\nrun_script({len(note)})\n'.encode()
    if not setup:
        return code + note, len(code)
    command = f"exec python3 -c '{READ.format(size=len(code))}'"
    first = f'{inspect.getsource(source_first)}\nsource_first({setup!a}, {command!a})\n'.encode()
    return first + code + note, len(first)


def meaning(host: Host, exit_code: int, lines: Sequence[bytes]) -> str:
    """Return in one line why nothing runs on a host, given what has been said, and what to do."""
    said = [line.decode(errors='replace').strip() for line in lines]
    last = next((line for line in reversed(said) if line), '')
    if exit_code == NOT_FOUND:
        return f'{host.name} ({host.address}) does not find python3: install it there'
    if exit_code != FAILED:
        return f'nothing can be started on {host.name}, for the reason above'
    advice = "is it on, and does it run sshd? The address is in the system's 'host' statement"
    if 'Permission denied' in last:
        advice = f'no password is asked for: ssh-copy-id {host.address} puts your key there'
    elif any('Host key verification failed' in line for line in said):
        last = 'Host key verification failed.'
        advice = f'connect once by hand to accept it, if it is right: ssh {host.address}'
    return f'{host.name} ({host.address}) cannot be reached: {last.rstrip(".")}; {advice}'
