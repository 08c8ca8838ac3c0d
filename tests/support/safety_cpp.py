"""The C++ safety node without rclcpp: its runtime and its messages, compiled against the wheels."""

from __future__ import annotations

import subprocess
from pathlib import Path

from deros.generators.api.protocol import Files
from deros.generators.runtime.interface import cpp_runtime_text
from tests.support.cpp import compile_cpp, message_flags

HEADERS = ("descriptor", "refusal")
PURE = (
    *("event_loop", "instance", "latches", "monitor_runner", "realtime", "regular_file"),
    *("report_types", "sha256", "start_order", "text", "worker"),
)
"""The runtime that needs nothing but the system."""
WITH_MESSAGES = ("diagnostics", "events")
"""The runtime that needs the headers of messages, too."""


def runtime_in(folder: Path, package: str) -> list[Path]:
    """Write the runtime without rclcpp below a folder, and return its sources."""
    runtime = folder / package / "runtime"
    runtime.mkdir(parents=True, exist_ok=True)
    for name in (*HEADERS, *PURE, *WITH_MESSAGES):
        (runtime / f"{name}.hpp").write_text(cpp_runtime_text(f"{name}.hpp", package))
    for name in (*PURE, *WITH_MESSAGES):
        (runtime / f"{name}.cpp").write_text(cpp_runtime_text(f"{name}.cpp", package))
    return [runtime / f"{name}.cpp" for name in (*PURE, *WITH_MESSAGES)]


def compiled(source: Path, folder: Path, files: Files | None = None) -> Path:
    """Compile a program with the runtime, and with what of a package needs no rclcpp.

    The namespace of a runtime without a package is ``tested::runtime``.
    """
    package = next(iter(files)).partition("/")[0] if files else "tested"
    sources = [source, *runtime_in(folder, package)]
    for path, file in (files or {}).items():
        name = Path(path).name
        if name.endswith(("_messages.hpp", "_rule_metadata.hpp", "_monitor.h")):
            (folder / name).write_text(file.text, encoding="utf-8")
        elif name.endswith(("_messages.cpp", "_rule_metadata.cpp", "_monitor.c")):
            sources.append(folder / name)
            sources[-1].write_text(file.text, encoding="utf-8")
    flags = ("-O1", "-pthread", f"-I{folder}", *message_flags())
    return compile_cpp(sources, folder / "program", *flags)


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
