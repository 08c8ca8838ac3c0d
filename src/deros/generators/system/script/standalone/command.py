"""The command line of a script that runs a system."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping, Sequence
import contextlib
from fnmatch import fnmatchcase
import os
from pathlib import Path
import shlex
import signal
import sys
import tempfile

from .command_line import command_line, parameter_file
from .node import awaited_by, is_loaded, Node, Preparation, Program, Row, without_left_out
from .process import Process
from .programs import Programs, programs_of
from .supervisor import Supervisor, WATCHED
from .watch.display import Display
from .watch.logs import OpenError
from .watch.table import Table

PACKAGE_PATH = ('--package-path', '--install')
EXIT_CODES = """exit codes: 0 when every node has ended well, by itself or because it was told to;
130 when a Ctrl-C (SIGINT) was the cause; 1 when a node has failed, or did not stop as told; 2 when
nothing was started, because an argument is wrong or a program is not found."""


def main(
    system: str,
    nodes: Sequence[Row],
    arguments: Sequence[str] | None = None,
    program: str | None = None,
    about: str = '',
    supervisor: type[Supervisor] | None = None,
    preparation: Preparation | None = None,
) -> int:
    """Run the nodes as the command line says and return the exit code."""
    prepared = preparation or Preparation()
    kind = supervisor or Supervisor
    parser = _parser(system, program, about)
    options = parser.parse_args(arguments)
    for pattern in [*options.only, *options.excluded]:
        if not any(_matches(node, pattern) for node in nodes):
            known = ', '.join(node.full_name for node in nodes)
            parser.error(f'no node is called {pattern!r}; there are: {known}')
    chosen = [
        node
        for node in nodes
        if (not options.only or any(_matches(node, pattern) for pattern in options.only))
        and not any(_matches(node, pattern) for pattern in options.excluded)
    ]
    runs = set(map(id, chosen))
    left_out = [node for node in nodes if id(node) not in runs]
    chosen = [without_left_out(node, left_out) for node in chosen]
    programs = programs_of(options.package_path, os.environ)
    chosen = [row.located(lambda file: _located(file, programs)) for row in chosen]
    sources = [file for row in chosen for file in row.sources]
    sources = list(prepared.sources(sources, lambda file: _located(file, programs)))
    unreadable = [f'  {row.full_name}: {fault}' for row in chosen for fault in _prefix_faults(row)]
    if unreadable:
        print('\n'.join(['Nothing was started:', *unreadable]), file=sys.stderr)
        return 2
    found = [None if is_loaded(row) else programs.start_of(row) for row in chosen]
    files = [row.files for row in chosen]
    if options.dry_run:
        print(*(f'{line}\n' for line in prepared.by_hand()), sep='', end='')
        _print_commands(chosen, found, files, programs.additions(), kind)
    faults = [
        f'  {row.full_name}: {fault}'
        for row, start in zip(chosen, found, strict=True)
        for fault in programs.faults(row, start, chosen)
    ]
    if faults:
        print(_not_found(faults, chosen, found), file=sys.stderr)
        return 2
    absent = [file for file in sources if not Path(file).is_file()]
    if absent:
        lines = ['Files not found, so nothing was started:', *dict.fromkeys(absent)]
        print('\n  '.join(lines), file=sys.stderr)
        return 2
    if options.dry_run:
        return 0
    if options.table and not sys.stdout.isatty():
        print('--table draws on a terminal, and the output is none', file=sys.stderr)
        return 2
    environment = programs.environment()
    try:
        prepared.make(environment)
        chosen = [r.complete(environment) if isinstance(r, Node) else r for r in chosen]
    except ValueError as fault:
        print(f'Not everything can be made, so nothing was started:\n  {fault}', file=sys.stderr)
        return 2
    with (
        _signals_blocked(),
        prepared.in_place(),
        tempfile.TemporaryDirectory(prefix='deros-') as folder,
    ):
        processes: list[Process] = []
        for node, label, start, own in zip(chosen, _labels(chosen), found, files, strict=True):
            if start is not None:
                is_text = isinstance(node, Program) and node.file_text
                name = f'{len(processes)}{".py" if is_text else ".yaml"}'
                file = _write_file(node, Path(folder, name))
                processes.append(Process(node, label, command_line(node, start, file, own)))
        patience, keep_going = options.stop_timeout, options.keep_going
        running = kind(system, processes, environment, patience, keep_going, chosen)
        try:
            running.show(Table if options.table else Display, options.log_dir)
        except OpenError as error:
            print(f'Logs cannot be written, so nothing was started:\n  {error}', file=sys.stderr)
            return 2
        return running.run()


@contextlib.contextmanager
def _signals_blocked() -> Iterator[None]:
    """Block signals where nobody handles them in order, so that no file is left behind."""
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, WATCHED)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)


def _write_file(row: Row, file: Path) -> str | None:
    """Write what no command line can hold; return the file, None without any."""
    text = parameter_file(row)
    if text is None:
        return None
    file.write_text(text, encoding='utf-8')
    return str(file)


def _parser(system: str, program: str | None, about: str) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog=program,
        description=f'Run the nodes of {system}.',
        epilog=about + EXIT_CODES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        '--dry-run', action='store_true', help='print the commands that would be run'
    )
    parser.add_argument(
        '--only',
        metavar='NODE',
        action='append',
        default=[],
        help='run this node, process or subsystem alone: a name, a full name, or a pattern '
        "such as '/front/*'; may be repeated",
    )
    parser.add_argument(
        '--except',
        metavar='NODE',
        dest='excluded',
        action='append',
        default=[],
        help='leave this node, process or subsystem out; may be repeated',
    )
    parser.add_argument(
        *PACKAGE_PATH,
        metavar='DIR',
        type=Path,
        action='append',
        default=[],
        help='look for programs in this install space, or folder of Python packages, before '
        'those of DEROS_PACKAGE_PATH and AMENT_PREFIX_PATH; may be repeated',
    )
    parser.add_argument(
        '--stop-timeout',
        metavar='SECONDS',
        type=_seconds,
        default=5.0,
        help='time to end after SIGINT, and again after SIGTERM (default: %(default)s)',
    )
    parser.add_argument(
        '--keep-going',
        action='store_true',
        help='let the other nodes run on when one fails; the exit code is 1 all the same',
    )
    parser.add_argument(
        '--log-dir',
        metavar='DIR',
        type=Path,
        help='write what each program says into DIR, too: a file for each, and one of all; '
        'a full file of 10 MB begins anew, and five older ones are kept',
    )
    parser.add_argument(
        '--table',
        action='store_true',
        help='show a table of the programs (process, load, memory, restarts, state) instead of '
        'their output, of which only the last lines are seen',
    )
    return parser


def _seconds(text: str) -> float:
    value = float(text)
    if not 0 <= value < 1e6:
        raise ValueError(text)
    return value


def _matches(node: Row, pattern: str) -> bool:
    parts = node.subsystem.split('/') if node.subsystem else []
    subsystems = ['/'.join(parts[: end + 1]) for end in range(len(parts))]
    return any(fnmatchcase(name, pattern) for name in [node.name, node.full_name, *subsystems])


def _labels(nodes: Sequence[Row]) -> list[str]:
    """Return the labels of nodes in the output: names where they are unique, else full names."""
    names = [node.name for node in nodes]
    return [node.name if names.count(node.name) == 1 else node.full_name for node in nodes]


def _prefix_faults(row: Row) -> Iterator[str]:
    try:
        shlex.split(row.prefix)
    except ValueError as fault:
        yield f'its prefix {row.prefix!r} cannot be taken apart: {fault}'


def _located(file: str, programs: Programs) -> str:
    """Return the path of a parameter file: of a package, or beside this file."""
    if not file.startswith('share:'):
        return str(Path(__file__).resolve().parent / file)
    package, _, path = file.removeprefix('share:').partition('/')
    share = programs.share(package)
    return file if share is None else str(share / path)


def _print_commands(
    rows: Sequence[Row],
    found: Sequence[list[str] | None],
    files: Sequence[Sequence[str]],
    additions: Mapping[str, str],
    kind: type[Supervisor],
) -> None:
    """Print the commands for bash, in the environment of this program."""
    managed = [row for row in rows if isinstance(row, Node) and row.autostart is not None]
    for row, start, own in zip(rows, found, files, strict=True):
        place = f' ({row.subsystem})' if row.subsystem else ''
        turn = f', activated as number {managed.index(row) + 1}' if row in managed else ''
        print(f'# {row.full_name}{place}{_first_start(row, rows)}{turn}')
        if isinstance(row, Node) and row.container:
            print(kind.by_hand(row) + row.by_hand())
            continue
        needed = {**additions, **row.environment}
        variables = ''.join(f'{name}={shlex.quote(value)} ' for name, value in needed.items())
        line = variables + shlex.join(command_line(row, start or _unknown(row), files=own))
        text = parameter_file(row)
        if text is not None and isinstance(row, Program) and row.file_text:
            line = f'f=$(mktemp --suffix=.py) && echo {shlex.quote(text)} > "$f" && {line} "$f"'
        elif text is not None:
            line += f' --params-file <(echo {shlex.quote(text)})'
        if isinstance(row, Node):
            line += row.by_hand()
        if isinstance(row, Program) and row.folder:
            line = f'(cd {shlex.quote(row.folder)} && {line})'
        print(line)


def _first_start(row: Row, rows: Sequence[Row]) -> str:
    awaited = awaited_by(row, rows)
    delay = f'{row.delay:g} s ' if row.delay else ''
    if row.ready is not None and not row.ready.left_out:
        start = f', {delay}after waiting for {row.ready}, {row.ready.timeout:g} s at most'
    elif awaited is None:
        start = f', {delay}after the start of the system' if delay else ''
    else:
        start = f', {delay}after the exit of {awaited.full_name}'
    return start + (', whose exit stops all' if row.stops_all else '')


def _unknown(row: Row) -> list[str]:
    if isinstance(row, Program):
        return [row.program]
    return ['ros2', 'run', row.package, row.executable]


def _not_found(
    faults: Sequence[str], rows: Sequence[Row], found: Sequence[list[str] | None]
) -> str:
    lines = ['Programs not found, so nothing was started:', *faults]
    starts = zip(rows, found, strict=True)
    if any(start is None and not isinstance(row, Program) for row, start in starts):
        lines.append(
            'Build the packages and source their setup file, or name their install space with '
            '--install.'
        )
    return '\n'.join(lines)
