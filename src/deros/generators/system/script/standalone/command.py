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
from .node import Node
from .process import Process
from .programs import Programs
from .supervisor import Supervisor, WATCHED

EXIT_CODES = """exit codes: 0 when every node has ended well, by itself or because it was told to;
130 when a Ctrl-C (SIGINT) was the cause; 1 when a node has failed, or did not stop as told; 2 when
nothing was started, because an argument is wrong or a program is not found."""


def main(
    system: str,
    nodes: Sequence[Node],
    arguments: Sequence[str] | None = None,
    program: str | None = None,
    about: str = '',
    supervisor: type[Supervisor] | None = None,
) -> int:
    """Run the nodes as the command line says and return the exit code."""
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
    from_environment = filter(None, os.environ.get('DEROS_PACKAGE_PATH', '').split(os.pathsep))
    programs = Programs([*options.package_path, *map(Path, from_environment)], os.environ)
    found = [programs.find(node.package, node.executable) for node in chosen]
    if options.dry_run:
        _print_commands(chosen, found, programs.additions())
    missing = [node for node, start in zip(chosen, found, strict=True) if start is None]
    if missing:
        print(_not_found(missing), file=sys.stderr)
        return 2
    if options.dry_run:
        return 0
    with _signals_blocked(), tempfile.TemporaryDirectory(prefix='deros-') as folder:
        processes: list[Process] = []
        for node, label, start in zip(chosen, _labels(chosen), found, strict=True):
            if start is not None:
                file = _write_parameters(node, Path(folder, f'{len(processes)}.yaml'))
                processes.append(Process(node, label, command_line(node, start, file)))
        environment = programs.environment()
        patience, keep_going = options.stop_timeout, options.keep_going
        return (supervisor or Supervisor)(
            system, processes, environment, patience, keep_going
        ).run()


@contextlib.contextmanager
def _signals_blocked() -> Iterator[None]:
    """Block signals where nobody handles them in order, so that no file is left behind."""
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, WATCHED)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)


def _write_parameters(node: Node, file: Path) -> str | None:
    """Write the parameters that no command line can name; return the file, None without any."""
    text = parameter_file(node)
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
        help='run this node alone, or this subsystem: a name, a full name, or a pattern such as '
        "'/front/*'; may be repeated",
    )
    parser.add_argument(
        '--except',
        metavar='NODE',
        dest='excluded',
        action='append',
        default=[],
        help='leave this node or subsystem out; may be repeated',
    )
    parser.add_argument(
        '--package-path',
        '--install',
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
    return parser


def _seconds(text: str) -> float:
    value = float(text)
    if not 0 <= value < 1e6:
        raise ValueError(text)
    return value


def _matches(node: Node, pattern: str) -> bool:
    parts = node.subsystem.split('/') if node.subsystem else []
    subsystems = ['/'.join(parts[: end + 1]) for end in range(len(parts))]
    return any(fnmatchcase(name, pattern) for name in [node.name, node.full_name, *subsystems])


def _labels(nodes: Sequence[Node]) -> list[str]:
    """Return the labels of nodes in the output: names where they are unique, else full names."""
    names = [node.name for node in nodes]
    return [node.name if names.count(node.name) == 1 else node.full_name for node in nodes]


def _print_commands(
    nodes: Sequence[Node], found: Sequence[list[str] | None], additions: Mapping[str, str]
) -> None:
    """Print the commands for bash, in the environment of this program."""
    needed = ''.join(f'{name}={shlex.quote(value)} ' for name, value in additions.items())
    managed = [node for node in nodes if node.autostart is not None]
    for node, start in zip(nodes, found, strict=True):
        place = f' ({node.subsystem})' if node.subsystem else ''
        turn = f', activated as number {managed.index(node) + 1}' if node in managed else ''
        print(f'# {node.full_name}{place}{turn}')
        unknown = ['ros2', 'run', node.package, node.executable]
        line = needed + shlex.join(command_line(node, start or unknown))
        text = parameter_file(node)
        print(line if text is None else f'{line} --params-file <(echo {shlex.quote(text)})')


def _not_found(nodes: Sequence[Node]) -> str:
    lines = [
        f'  {node.full_name}: package {node.package!r} has no program {node.executable!r}'
        for node in nodes
    ]
    advice = (
        'Build the packages and source their setup file, or name their install space with '
        '--install.'
    )
    return '\n'.join(['Programs not found, so nothing was started:', *lines, advice])
