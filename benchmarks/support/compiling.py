"""The C compiler of this machine, and what it makes of a source."""

from __future__ import annotations

import os
import shlex
import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path

from support.processes import run

_SECTIONS = ("text", "rodata", "data", "bss")


def c_compiler() -> str | None:
    """Return the path of the C compiler: what CC names, else gcc, else cc; None without one."""
    named = shlex.split(os.environ.get("CC", ""))
    found = map(shutil.which, (*named[:1], "gcc", "cc"))
    return next((path for path in found if path), None)


def compile_c(sources: Sequence[Path], output: Path, include: Sequence[Path] = ()) -> None:
    """Compile C99 with -O2, to a program, or to an object file if ``output`` is called so.

    Raises:
        ProcessError: if it does not compile, with what the compiler wrote.
    """
    compiler = c_compiler()
    assert compiler is not None
    folders = [f"-I{folder}" for folder in include]
    link = ["-c"] if output.suffix == ".o" else []
    files = [str(each) for each in sources]
    flags = ["-std=c99", "-O2", "-Wall", "-Wextra", *folders, *link]
    run([compiler, *flags, *files, "-o", str(output), *([] if link else ["-lm"])])


def section_sizes(object_file: Path) -> Mapping[str, int] | None:
    """Return the bytes in .text, .rodata, .data and .bss; None without the tool ``size``."""
    if shutil.which("size") is None:
        return None
    sizes = dict.fromkeys(_SECTIONS, 0)
    for line in run(["size", "-A", str(object_file)]).splitlines():
        match line.split():
            case [name, number, _] if name.split(".")[1:2] and number.isdigit():
                kind = name.split(".")[1]
                if kind in sizes:
                    sizes[kind] += int(number)
    return sizes
