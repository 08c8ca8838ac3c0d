"""What stands in the unit of one node or process, with the spelling of systemd.

Sources: systemd.service(5), "Command lines"; systemd.syntax(7), "Quoting"; systemd.unit(5),
"Specifiers".
"""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from deros.generators.system.script.standalone.command_line import command_line
from deros.generators.system.script.standalone.node import Node, Row

_PLAIN = re.compile(r"[\w@+=:,./~-]+", re.ASCII)
_CONTROL = re.compile("[\x00-\x1f\x7f]")
_PROGRAM = "\ue000"
"""Stands for the program in a command line: a character that no word has."""

_PROCESS_CODE = 'source "$0" && exec {prefix}"$@"'
_NODE_CODE = (
    'source "$0" || exit 1; IFS=:; for prefix in $AMENT_PREFIX_PATH; do '
    'program="$prefix/lib/$1/$2"; test -x "$program" && exec {prefix}"$program" "${{@:3}}"; done; '
    'echo "package $1 has no program $2" >&2; exit 127'
)


@dataclass(frozen=True, slots=True)
class Service:
    """The unit of one node or process; texts are spelled for systemd.

    Attributes:
        name: of the file.
        after: the units that are to be started before this one, and stopped after it.
        folder: that it runs in, if any.
        command: the lines of ``ExecStart``.
        restart_delay: seconds until it is started again; ``None``: it is not.
        most_starts: how often it may be started; ``None``: without limit.
    """

    name: str
    description: str
    after: tuple[str, ...]
    folder: str
    command: tuple[str, ...]
    restart_delay: str | None
    most_starts: int | None


def service(row: Row, name: str, description: str, after: Sequence[str], setup: str) -> Service:
    """Return the unit of a row.

    Args:
        row: of the table of the script; no parameter of it needs a file.
        name: of the unit's file.
        description: on one line; of a node without any, its name is enough.
        after: the units to be started before.
        setup: the absolute path of the setup file to source.
    """
    limit = row.respawn_max
    return Service(
        name=name,
        description=specified(f"{row.full_name}: {description}" if description else row.full_name),
        after=tuple(after),
        folder="" if isinstance(row, Node) else specified(row.folder),
        command=tuple(_command(row, setup)),
        restart_delay=None if row.respawn_delay is None else _seconds(row.respawn_delay),
        most_starts=None if limit is None else limit + 1,
    )


def word(text: str) -> str:
    """Return a word as systemd reads it back; quoted only where it has to be."""
    if _PLAIN.fullmatch(text):
        return text
    quote = "'" if '"' in text else '"'
    escaped = text.replace("\\", "\\\\").replace(quote, f"\\{quote}")
    return quote + _CONTROL.sub(_escaped, escaped) + quote


def _escaped(found: re.Match[str]) -> str:
    return f"\\x{ord(found[0]):02x}"


def specified(text: str) -> str:
    """Return a text in which systemd finds no specifier such as ``%h``."""
    return text.replace("%", "%%")


def _argument(text: str) -> str:
    """Return a word of a command line, in which systemd finds no variable either."""
    return word(specified(text).replace("$", "$$"))


def shell_words(
    row: Row, file: str | None = None, files: Sequence[str] = ()
) -> tuple[str, list[str], list[str]]:
    """Return code for bash that becomes a program, words that name that, and its arguments.

    Args:
        row: of the table of the script.
        file: that holds what no command line can, if there is such.
        files: of parameters.
    """
    line = command_line(row, [_PROGRAM], file, files)
    place = line.index(_PROGRAM)
    # The variables come after the setup file, since they replace what that may set.
    assignments = [f"{key}={value}" for key, value in row.environment.items()]
    before = [*(["env", *assignments] if assignments else []), *line[:place]]
    prefix = f"{shlex.join(before)} " if before else ""
    if isinstance(row, Node):
        code, head = _NODE_CODE, [row.package, row.executable]
    else:
        code, head = _PROCESS_CODE, [row.program]
    return code.format(prefix=prefix), head, line[place + 1 :]


def _command(row: Row, setup: str) -> Iterator[str]:
    """Yield the lines of a command: the shell with its code, the program, its arguments.

    The shell sources the setup file and becomes the program, so that systemd watches and signals
    the program itself.
    """
    code, head, arguments = shell_words(row)
    yield f"/bin/bash -c {_argument(code)}"
    yield " ".join(map(_argument, [setup, *head]))
    own = len(row.arguments)
    if own:
        yield " ".join(map(_argument, arguments[:own]))
    if isinstance(row, Node) or row.inside:
        enclave = ["--enclave", row.full_name] if isinstance(row, Node) else []
        for_ros = [*arguments[own + 1 :], *enclave]
        yield from arguments[own : own + 1]
        for flag, value in zip(for_ros[::2], for_ros[1::2], strict=True):
            yield f"{flag} {_argument(value)}"


def _seconds(seconds: float) -> str:
    return f"{seconds:.6f}".rstrip("0").rstrip(".")
