"""The C++ safety node without rclcpp: its runtime and its messages, compiled against the wheels."""

from __future__ import annotations

import subprocess
from pathlib import Path

import deros.generators.runtime.cpp
from deros.generators.api.protocol import Files
from deros.generators.runtime.cpp.interface import copied_text
from tests.support.cpp import compile_cpp, message_flags, ros_prefix

RUNTIME = Path(deros.generators.runtime.cpp.__path__[0])
"""The folder of the package ``deros_runtime_cpp``."""

HEADERS = ("bound_service", "descriptor", "flags", "place_of", "refusal")
PURE = (
    *("digest", "event_loop", "instance", "latches", "look_ahead", "monitor_runner", "realtime"),
    *("regular_file", "report_types", "service_call", "start_order", "text", "worker"),
)
"""The parts of the runtime that need only the system and rcutils."""
WITH_MESSAGES = ("diagnostics", "event_reporter")
"""The parts of the runtime that need the headers of messages, too."""
TOGETHER = (
    *("digest", "event_loop", "event_reporter", "instance", "realtime", "regular_file"),
    *("report_types", "start_order", "text", "worker"),
)
"""The parts that compile as one source; each of the others defines some name of these again."""


def compiled(source: Path, folder: Path, files: Files | None = None) -> Path:
    """Compile a program with the parts of the runtime that need no rclcpp.

    Args:
        source: the program.
        folder: where to compile it.
        files: a generated package whose messages, metadata and monitor are compiled, too; it brings
            its copy of the runtime. Without it, the runtime is that of ``deros_runtime_cpp``.
    """
    if files is None:
        sources = [RUNTIME / f"src/{part}.cpp" for part in (*PURE, *WITH_MESSAGES)]
        include = RUNTIME / "include"
    else:
        sources = [*_copied(folder, next(iter(files)).partition("/")[0]), *_written(folder, files)]
        include = folder
    libraries = ros_prefix() / "lib"
    flags = ("-O1", "-pthread")
    includes = (f"-I{include}", *message_flags())
    linked = (f"-L{libraries}", f"-Wl,-rpath,{libraries}", "-lrcutils")
    program = folder / "program"
    return compile_cpp([source, *sources], program, *flags, includes=includes, libraries=linked)


def _copied(folder: Path, package: str) -> list[Path]:
    """Write the runtime of a package, and return its sources.

    They are two, as headers take longer than what is in the parts. That each part includes what it
    needs is seen where ``deros_runtime_cpp``, of which they are copies, is compiled.
    """
    runtime = folder / package / "runtime"
    runtime.mkdir(parents=True, exist_ok=True)
    for name in (*HEADERS, *PURE, *WITH_MESSAGES):
        (runtime / f"{name}.hpp").write_text(copied_text(f"{name}.hpp", package))
    for name in (*PURE, *WITH_MESSAGES):
        (runtime / f"{name}.cpp").write_text(copied_text(f"{name}.cpp", package))
    rest = [part for part in (*PURE, *WITH_MESSAGES) if part not in TOGETHER]
    sources = []
    for parts in (TOGETHER, rest):
        sources.append(runtime / f"with_{parts[0]}.cpp")
        sources[-1].write_text("".join(f'#include "{part}.cpp"\n' for part in parts))
    return sources


def _written(folder: Path, files: Files) -> list[Path]:
    """Write the parts of a package that need no rclcpp, and return their sources."""
    sources = []
    for path, file in files.items():
        name = Path(path).name
        if name.endswith(("_messages.hpp", "_rule_metadata.hpp", "_monitor.h")):
            (folder / name).write_text(file.text, encoding="utf-8")
        elif name.endswith(("_messages.cpp", "_rule_metadata.cpp", "_monitor.c")):
            sources.append(folder / name)
            sources[-1].write_text(file.text, encoding="utf-8")
    return sources


class Harness:
    """A compiled program that answers a line with a line."""

    def __init__(self, program: Path) -> None:
        """Start it."""
        self.process = subprocess.Popen(
            [program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )

    def ask(self, *words: object) -> str:
        """Return the answer to a line of words."""
        pipes = self.process.stdin, self.process.stdout
        assert pipes[0] is not None
        assert pipes[1] is not None
        pipes[0].write("\t".join(map(str, words)) + "\n")
        pipes[0].flush()
        return pipes[1].readline().removesuffix("\n")

    def close(self) -> None:
        """End it."""
        self.process.kill()
        self.process.communicate()
