"""The command line of a script whose system has hosts: the part of one, or all over ssh."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
import contextlib
import json
import os
from pathlib import Path
import shlex
import shutil
import sys
from types import SimpleNamespace
from typing import Any

from ..arguments import _ASSIGNMENT, about_arguments, Argument, given, main_with_arguments
from ..command import _parser, _seconds, _signals_blocked
from ..node import Preparation, Row, Scalar
from ..supervisor import Supervisor
from ..watch.display import Display
from ..watch.logs import OpenError
from .connection import Host, sent, ssh_command
from .part import AS_PART, run_part
from .starting import HostsSupervisor, PartProcess

HOST = 'host'  # the argument that says on which of them this is started
EVERYWHERE = 'all'
SSH_HELP = """all hosts at once, from this one:
  --ssh                 start the part of each host there, over ssh, and stop them together; with
                        host:=NAME the part of that one here
  --ssh-command WORDS   what to run instead of ssh, as in 'ssh -F robots.conf'
  --ssh-timeout SECONDS time after which a host that is silent counts as lost (default: 10)

"""

Hosts = Callable[..., Sequence[Host]]


def main_with_hosts(
    system: str,
    declared: Sequence[Argument],
    nodes: Callable[..., Sequence[Row]],
    hosts: Hosts,
    files: Sequence[str],
    script: str,
    start: object = None,
    supervisor: type[Supervisor] | None = None,
    preparation: Preparation | None = None,
) -> int:
    """
    Run the part of a host, or have those of all run, and return the exit code.

    The files are those beside the script that it names; they go with it to other hosts.
    """
    words = sys.argv[1:]
    if words[:1] == [AS_PART]:
        return run_part(system, declared, nodes, words[1:], start, supervisor, preparation)
    program = Path(sys.argv[0]).name
    assigned = [word for word in words if _ASSIGNMENT.match(word)]
    others = [word for word in words if not _ASSIGNMENT.match(word)]
    parser = _ssh_parser(system, program, about_arguments(declared) + SSH_HELP)
    options = parser.parse_args(others)
    if not options.ssh:
        if options.ssh_command != 'ssh' or options.ssh_timeout != 10.0:
            parser.error('--ssh-command and --ssh-timeout go with --ssh')
        return main_with_arguments(
            system,
            declared,
            nodes,
            start=start,
            supervisor=supervisor,
            preparation=preparation,
        )
    try:
        context = () if start is None else (start,)
        here, rows, used = _checked(declared, assigned, hosts, context, options)
        texts = _read(files, Path(script))
    except (ValueError, ArithmeticError) as fault:
        print(f'{program}: error: {fault}', file=sys.stderr)
        return 2
    except OSError as fault:
        print(f'{fault}, so nothing was started', file=sys.stderr)
        return 2
    given_words = [word for word in assigned if not word.startswith(f'{HOST}:=')] + used
    parts = [
        _part(host, host.name == here, options, given_words, Path(script), texts) for host in rows
    ]
    return _run(system, parts, options)


def _ssh_parser(system: str, program: str, about: str) -> argparse.ArgumentParser:
    parser = _parser(system, program, about)
    hidden = argparse.SUPPRESS  # they are explained together
    parser.add_argument('--ssh', action='store_true', help=hidden)
    parser.add_argument('--ssh-command', default='ssh', help=hidden)
    parser.add_argument('--ssh-timeout', type=_seconds, default=10.0, help=hidden)
    return parser


def _checked(
    declared: Sequence[Argument],
    words: Sequence[str],
    hosts: Hosts,
    context: Sequence[object],
    options: argparse.Namespace,
) -> tuple[str, Sequence[Host], list[str]]:
    """
    Return the host that is here, or nothing, all of them, and words for what they are made of.

    These words are the same everywhere: what is looked up for an address is looked up here.

    Raises ValueError when the arguments are wrong, as far as that can be told here: what is looked
    up on a host is not known.
    """
    named = {word.partition(':=')[0] for word in words}
    sure = [
        each
        for each in declared
        if each.name in named or (not callable(each.default) and each.name != HOST)
    ]
    if named - {each.name for each in declared}:
        given(declared, words, context)  # which says so
    values = vars(given(sure, words, context))
    here = values.get(HOST, '')
    if here == EVERYWHERE:
        raise ValueError(
            f'{HOST}:={EVERYWHERE} starts everything here, and --ssh each on its host'
        )
    for each in declared:
        if each.name not in values and each.name != HOST:
            with contextlib.suppress(ValueError, ArithmeticError, AttributeError):
                value = each.computed(values, context)
                if value is not None:
                    values[each.name] = value
    try:
        used = _Asked(**values)
        rows = hosts(used, *context)
    except AttributeError as lack:
        name = lack.name
        raise ValueError(f'a host needs the argument {name!r}, which is not known here') from None
    for host in rows:
        fault = host.fault()
        if fault is not None and host.name != here:
            raise ValueError(fault)
    if options.table:
        raise ValueError('--table shows the programs of one computer, and --ssh starts several')
    if not options.ssh_timeout:
        raise ValueError('--ssh-timeout has to be positive')
    ssh = (shlex.split(options.ssh_command) or [''])[0]
    if any(host.name != here for host in rows) and shutil.which(ssh) is None:
        raise ValueError(f'no program {ssh!r} in the PATH: it has to reach the other hosts')
    asked = [name for name in values if name in used.asked and name not in named]
    return str(here), rows, [f'{name}:={_as_given(values[name])}' for name in asked]


class _Asked(SimpleNamespace):
    """Values that note which of them are asked for."""

    def __init__(self, **values: Scalar) -> None:
        """Hold the values by their names."""
        super().__init__(**values)
        self.asked: set[str] = set()

    def __getattribute__(self, name: str) -> Any:
        """Return a value."""
        found = super().__getattribute__(name)
        if name != 'asked':
            self.asked.add(name)
        return found


def _as_given(value: Scalar) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def _read(files: Sequence[str], script: Path) -> dict[str, str]:
    """Return the texts of the script and the files beside it; raise OSError without one."""
    found = {}
    for path in (script.name, *files):
        with (script.resolve().parent / path).open(encoding='utf-8', newline='') as file:
            found[path] = file.read()
    return found


def _part(
    host: Host,
    is_here: bool,
    options: argparse.Namespace,
    assigned: Sequence[str],
    script: Path,
    texts: dict[str, str],
) -> PartProcess:
    note = {
        'only': options.only,
        'excluded': options.excluded,
        'colour': sys.stdout.isatty() and not os.environ.get('NO_COLOR'),
        'silence': options.ssh_timeout,
    }
    words = [AS_PART, json.dumps(note), f'{HOST}:={host.name}', *assigned]
    words += [f'--package-path={folder}' for folder in options.package_path]
    words += [f'--stop-timeout={options.stop_timeout}']
    words += ['--keep-going'] * options.keep_going + ['--dry-run'] * options.dry_run
    if is_here:
        command, data = [sys.executable, str(script.resolve()), *words], b''
    else:
        data, size = sent(host.setup, script.name, texts, words)
        command = ssh_command(options.ssh_command, host, options.ssh_timeout, size)
    return PartProcess(host, command, data, options.stop_timeout, is_here)


def _run(system: str, parts: Sequence[PartProcess], options: argparse.Namespace) -> int:
    with _signals_blocked():
        environment = dict(os.environ)
        patience, keep_going = options.stop_timeout, options.keep_going
        kind = HostsSupervisor
        kind.silence, kind.dry_run = options.ssh_timeout, options.dry_run
        running = kind(system, parts, environment, patience, keep_going)
        try:
            running.show(Display, options.log_dir)
        except OpenError as error:
            print(f'Logs cannot be written, so nothing was started:\n  {error}', file=sys.stderr)
            return 2
        return running.run()
