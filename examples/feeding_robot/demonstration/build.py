"""Checks the models and generates every package of the robot into one folder.

The files that belong to the user (the nodes' bodies and what they import) lie in ``src``; they are
put in place first, and the generators leave them alone.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path, PurePosixPath

from deros.diagnostics import Diagnostic, has_errors, in_file_order
from deros.generators.api.protocol import Context, Files
from deros.generators.api.registry import discover
from deros.generators.output.writer import write
from deros.generators.runtime.interface import with_runtime
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import LoadedFile, Repository
from deros.validators.check import check


class BuildError(Exception):
    """The models do not check clean, or the environment lacks a generator or a compiler."""


def build(example: Path, folder: Path) -> list[str]:
    """Generate the packages of all nodes and of the safety node; return their names.

    The runtime that the safety node depends on is put beside them.

    Args:
        example: the folder with the models, those of the nodes in it or below, and ``src``.
        folder: where the packages go; it may hold those of an earlier run.

    Raises:
        BuildError: if a model has an error.
    """
    repository = Repository()
    context = Context(InterfaceStore(), repository)
    rules = _load(repository, sorted(example.glob("*.deros")))
    nodes = _load(repository, sorted(example.rglob("*.rnd")))
    systems = _load(repository, sorted(example.glob("*.system")))
    findings = check([*rules, *nodes, *systems], repository, context.store)
    if has_errors(findings):
        raise BuildError("\n".join(map(_line, in_file_order(findings))))
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copytree(
        example / "src",
        folder,
        dirs_exist_ok=True,
        ignore=shutil.ignore_patterns("__pycache__", "ruff.toml"),
    )
    packages: list[str] = []
    for file in [*rules, *nodes]:
        files = _generate(file, context)
        write(with_runtime(files), folder, overwrite=True)
        packages += sorted({PurePosixPath(path).parts[0] for path in files} - set(packages))
    return packages


def generate_cpp(example: Path, folder: Path) -> None:
    """Generate the package with the safety node and the gate in C++ into a folder."""
    repository = Repository()
    context = Context(InterfaceStore(), repository)
    for file in _load(repository, sorted(example.glob("*.deros"))):
        write(with_runtime(_generate(file, context, "cpp")), folder, overwrite=True)


def build_cpp(example: Path, folder: Path) -> Path:
    """Generate the safety node and the gate in C++, and build them; return the install folder.

    Args:
        example: the folder with the models.
        folder: where sources and builds go; what has been built of the same sources stays.

    Raises:
        BuildError: if colcon is not there, or does not build the package.
    """
    generate_cpp(example, folder / "src")
    # Of this environment, unless a workspace has put another one in front.
    colcon = shutil.which("colcon") or str(Path(sys.executable).with_name("colcon"))
    command = [colcon, "--log-base", "log", "build", "--merge-install"]
    settings = ["--cmake-args", "-DCMAKE_BUILD_TYPE=Release", "-DBUILD_TESTING=OFF"]
    log = folder / "build.log"
    try:
        with log.open("w", encoding="utf-8") as output:
            subprocess.run(
                [*command, *settings], cwd=folder, stdout=output, stderr=output, check=True
            )
    except (OSError, subprocess.CalledProcessError) as error:
        raise BuildError(f"the package in C++ is not built: {error}; see {log}") from None
    return folder / "install"


def in_cpp(system: Path, folder: Path) -> Path:
    """Write a system with the safety node and the gate in C++; return the model's path.

    Two words more in one line are the whole difference.
    """
    rules = f'safety "{system.stem}.deros"'
    return changed_system(system, folder, ((rules, f"{rules} target cpp"),))


def changed_system(system: Path, folder: Path, changes: Iterable[tuple[str, str]]) -> Path:
    """Write a system with changes to a folder, and its rules, which use it, beside it.

    Args:
        system: the model.
        folder: where the copy goes, under the same name.
        changes: texts that the model has once, and what stands in their place.

    Returns:
        The path of the changed model.

    Raises:
        ValueError: if a text is not there once.
    """
    text = system.read_text(encoding="utf-8")
    here = system.parent.resolve()
    for old, new in changes:
        if text.count(old) != 1:
            raise ValueError(f"{system} does not say '{old}' once")
        text = text.replace(old, new)
    text = re.sub(r'import "([^"]*)"', lambda found: f'import "{here / found[1]}"', text)
    folder.mkdir(parents=True, exist_ok=True)
    for rules in system.parent.glob("*.deros"):
        shutil.copyfile(rules, folder / rules.name)
    path = folder / system.name
    path.write_text(text, encoding="utf-8")
    return path


def _load(repository: Repository, paths: Iterable[Path]) -> list[LoadedFile]:
    return [repository.load(str(path)) for path in paths]


def _generate(file: LoadedFile, context: Context, target: str = "python") -> Files:
    generator = discover().find(file.language.name, target) if file.language else None
    if generator is None:
        raise BuildError(f"no generator makes {target} of {file.path}")
    return generator(file.model, context)


def _line(finding: Diagnostic) -> str:
    return f"{finding.span.file}:{finding.span.line}: {finding.message}"
