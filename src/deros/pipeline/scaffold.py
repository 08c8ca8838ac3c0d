"""The source tree of a package that is generated while it is built."""

from __future__ import annotations

import os
import posixpath
import re
import shlex
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from deros.generators.api.protocol import File
    from deros.pipeline.generate import Generated, Request


def scaffold_files(generated: Generated, request: Request, source: Path) -> dict[str, File]:
    """Return the files in the source tree of a package that is generated while it is built.

    They include the build script, which belongs to the user once it is written.
    """
    from deros.generators.api.protocol import File, Owner
    from deros.generators.output.source_tree import package_folder, scaffold

    top = package_folder(generated.files)
    model = Path(os.path.relpath(request.file, source)).as_posix()
    folder = posixpath.dirname(model)
    files = scaffold(generated.files, source, "" if folder.startswith("..") else folder)
    if f"{top}/CMakeLists.txt" in generated.files:
        files["CMakeLists.txt"] = File(_cmake_script(top, model, request), Owner.USER)
    elif f"{top}/setup.py" in generated.files:
        files["setup.py"] = File(_setup_script(model, request), Owner.USER)
    return files


def scaffold_command(request: Request, source: Path) -> str:
    """Return the command that creates or repairs the source tree of a package."""
    words = ["deros", "generate", request.file, "--target", request.target]
    for name, value in request.options.items():
        words += [f"--{name}", value]
    for folder in request.interfaces:
        words += ["--interfaces", str(folder)]
    return shlex.join([*words, "--scaffold", str(source)])


def _cmake_script(package: str, model: str, request: Request) -> str:
    more = "".join(
        f"\n  OPTIONS {_cmake_argument(f'--{name}={value}')}"
        for name, value in sorted(request.options.items())
    )
    return (
        "cmake_minimum_required(VERSION 3.22)\n"
        f"project({package})\n\n"
        "find_package(deros REQUIRED)\n"
        f"deros_package(MODEL {_cmake_argument(model)} GENERATOR {request.target}{more})\n"
    )


def _cmake_argument(text: str) -> str:
    """Return a text as a quoted argument of CMake, in which nothing is replaced."""
    escaped = re.sub(r'[\\"$]', r"\\\g<0>", text)
    return '"' + escaped.replace("\n", "\\n").replace("\r", "\\r") + '"'


def _setup_script(model: str, request: Request) -> str:
    arguments = [repr(model)]
    if request.target != "python":
        arguments.append(f"target={request.target!r}")
    if request.options:
        arguments.append(f"options={dict(sorted(request.options.items()))!r}")
    return f"from deros.build import setup\n\nsetup({', '.join(arguments)})\n"
