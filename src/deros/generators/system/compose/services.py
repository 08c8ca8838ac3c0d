"""What stands in the service of one node or process."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from deros.generators.system.script.standalone.command_line import parameter_file
from deros.generators.system.script.standalone.node import Node, Row
from deros.generators.system.systemd.units import shell_words

FOLDER = "/deros"
"""Where parameter files are in a container."""


@dataclass(frozen=True, slots=True)
class Config:
    """A file that compose puts into containers.

    Attributes:
        name: by which services name it.
        target: its path in them.
        text: that it holds.
    """

    name: str
    target: str
    text: str

    @classmethod
    def of_file(cls, path: str, text: str) -> Config:
        """Return a parameter file, given its path from the folder of the system."""
        return cls(path.replace("/", "-"), f"{FOLDER}/files/{path}", text)


def own_file(row: Row, name: str) -> Config | None:
    """Return the file with what no command line can hold of a service; ``None`` without any."""
    text = parameter_file(row)
    return None if text is None else Config(f"{name}.own", f"{FOLDER}/own/{name}.yaml", text)


@dataclass(frozen=True, slots=True)
class Service:
    """The service of one node or process, its texts not yet spelled for compose.

    Attributes:
        name: of the service.
        description: on one line, or nothing.
        shell: the words of the shell, with its code and the setup file.
        program: the words that name the program.
        own: the words of its own, before those of ROS 2.
        for_ros: flags, each with its word.
        folder: that it runs in, if any.
        restarts: whether it is started again, however it ends.
        after: the services to be started before.
        configs: the files that it is given.
    """

    name: str
    description: str
    shell: tuple[str, ...]
    program: tuple[str, ...]
    own: tuple[str, ...]
    for_ros: tuple[tuple[str, ...], ...]
    folder: str
    restarts: bool
    after: tuple[str, ...]
    configs: tuple[Config, ...]


def service(
    row: Row,
    name: str,
    description: str,
    after: Sequence[str],
    setup: str,
    files: Sequence[Config],
    own: Config | None,
) -> Service:
    """Return the service of a row.

    Args:
        row: of the table of the script.
        name: of the service.
        description: on one line, or nothing.
        after: the services to be started before.
        setup: the absolute path of the setup file to source, in the container.
        files: its parameter files.
        own: what :func:`own_file` returns.
    """
    code, head, arguments = shell_words(
        row, None if own is None else own.target, [each.target for each in files]
    )
    count = len(row.arguments)
    rest = arguments[count:]
    flags = rest[1:] if rest else []
    return Service(
        name=name,
        description=description,
        shell=("/bin/bash", "-c", code, setup),
        program=tuple(head),
        own=tuple(arguments[:count]),
        for_ros=((rest[0],), *zip(flags[::2], flags[1::2], strict=True)) if rest else (),
        folder="" if isinstance(row, Node) else row.folder,
        restarts=row.respawn_delay is not None,
        after=tuple(after),
        configs=(*files, *([own] if own is not None else [])),
    )
