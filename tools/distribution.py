"""Build the files of a release, and use them as after a fresh installation.

The source distribution is built from this tree and the wheel from the source distribution. Both
must hold every source file. The wheel is then installed into empty environments, with the lowest
versions of all dependencies on the lowest supported Python and with the newest on the newest, and
there ``check``, ``generate`` and ``simulate`` run on copies of the examples.

Of the supported versions of Python that this machine lacks, the next ones are taken, and those that
were not tried are named. Exit code 1 says that something failed.
"""

from __future__ import annotations

import argparse
import email.parser
import json
import os
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
_PAGES = "docs/diagnostics/"
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]*")
_FLOOR = re.compile(r">=\s*(?P<version>[0-9][0-9.]*)")
_PYTHON = re.compile(r"Programming Language :: Python :: (?P<version>3\.\d+)")
_OF_THIS_PROCESS = ("PYTHON", "AMENT", "ROS", "_ROS", "LD_LIBRARY", "VIRTUAL_ENV", "COLCON")
_TRACE = """\
{"t": 0.1, "topic": "/odometry", "data": {"twist": {"twist": {"linear": {"x": 0.0}}}}}
{"t": 0.1, "topic": "/imu", "data": {"orientation": {"w": 1.0}}}
"""
"""A robot that stands still, until both sensors are silent."""


class Failure(Exception):  # noqa: N818 - what a check of the distribution found, not a program error
    """Something is wrong with the distribution; the text says what."""


@dataclass(frozen=True)
class Promises:
    """What a wheel says it needs.

    Attributes:
        pythons: the supported versions, lowest first.
        floors: the lowest version of each required package, by its name.
    """

    pythons: tuple[str, ...]
    floors: dict[str, str]


def read_promises(metadata: str) -> Promises:
    """Return the promises in the ``METADATA`` of a wheel; extras do not count.

    Raises:
        Failure: a required package has no floor, or no Python is named.
    """
    fields = email.parser.HeaderParser().parsestr(metadata)
    matches = (_PYTHON.fullmatch(each) for each in fields.get_all("Classifier", []))
    pythons = sorted((match["version"] for match in matches if match), key=_version_key)
    if not pythons:
        raise Failure("the classifiers name no Python version")
    floors = {}
    for requirement in fields.get_all("Requires-Dist", []):
        if "extra ==" in requirement:
            continue
        name, floor = _NAME.match(requirement), _FLOOR.search(requirement)
        if name is None or floor is None:
            raise Failure(f"the requirement {requirement!r} has no floor")
        floors[_normalized(name[0])] = floor["version"]
    return Promises(tuple(pythons), floors)


def missing_files(tracked: Iterable[str], packed: Iterable[str]) -> list[str]:
    """Return the tracked files of the package that an archive lacks, sorted.

    Args:
        tracked: paths below the repository.
        packed: paths in the archive, below its top folder.
    """
    needed = {path for path in tracked if path.startswith("src/")}
    return sorted(needed - set(packed))


def find_pythons(versions: Iterable[str]) -> dict[str, Path]:
    """Return the interpreters of this machine, by their version, in the order given.

    Args:
        versions: such as ``3.10``. They are looked for on the PATH and in pyenv's folder.
    """
    candidates = ((version, _find_python(version)) for version in versions)
    return {version: path for version, path in candidates if path is not None}


def _find_python(version: str) -> Path | None:
    """Return an interpreter that can make environments."""
    name = f"python{version}"
    on_path = shutil.which(name)
    pyenv = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv")) / "versions"
    candidates = [Path(on_path)] if on_path else []
    candidates += sorted(pyenv.glob(f"{version}.*/bin/{name}"))
    for path in candidates:
        # pyenv's stand-ins on the PATH exist for versions that are not active, too, and then fail.
        command = [str(path), "-c", "import ensurepip, ssl, sys; print(sys.version_info[:2])"]
        result = subprocess.run(command, capture_output=True, text=True, check=False)
        if result.stdout.strip() == str(_version_key(version)):
            return path
    return None


def build(folder: Path) -> tuple[Path, Path]:
    """Build the source distribution, and the wheel from it; return both paths.

    Raises:
        Failure: the build fails, or a source file is missing from the result.
    """
    _run([sys.executable, "-m", "build", "--outdir", folder, REPOSITORY], cwd=folder)
    (sdist,) = folder.glob("*.tar.gz")
    (wheel,) = folder.glob("*.whl")
    names = _run(["git", "ls-files"], cwd=REPOSITORY).splitlines()
    # What a link leads to is packed in its place.
    tracked = [name for name in names if not (REPOSITORY / name).is_symlink()]
    tracked += [f"src/deros/pages/{Path(name).name}" for name in names if name.startswith(_PAGES)]
    with tarfile.open(sdist) as archive:
        in_sdist = [name.partition("/")[2] for name in archive.getnames()]
    in_wheel = [f"src/{name}" for name in zipfile.ZipFile(wheel).namelist()]
    for archive_name, names in ((sdist.name, in_sdist), (wheel.name, in_wheel)):
        lost = missing_files(tracked, names)
        if lost:
            shown = ", ".join(lost[:5])
            raise Failure(f"{archive_name} lacks {len(lost)} files: {shown}")
    return sdist, wheel


def use(
    wheel: Path, python: Path, constraints: Mapping[str, str], names: Collection[str], folder: Path
) -> str:
    """Install a wheel into an empty environment and use it; return the versions of some packages.

    Args:
        wheel: what to install.
        python: the interpreter of the environment.
        constraints: versions that pip must choose, by the package's name.
        names: the packages whose versions to return.
        folder: where the environment, copies of the examples and all output go.

    Raises:
        Failure: a command fails.
    """
    home = folder / "environment"
    _run([python, "-m", "venv", home], cwd=folder)
    limits = folder / "constraints.txt"
    limits.write_text(
        "".join(f"{name}=={version}\n" for name, version in constraints.items()), encoding="utf-8"
    )
    pip = [str(home / "bin/python"), "-m", "pip", "--disable-pip-version-check"]
    _run([*pip, "install", "--quiet", "--constraint", limits, wheel], cwd=folder)
    _run([*pip, "check"], cwd=folder)
    for command in commands(folder):
        _run([home / "bin" / command[0], *command[1:]], cwd=folder)
    _expect_usage_error([home / "bin/deros", "check", "--no-such-option"], folder)
    listed = json.loads(_run([*pip, "list", "--format", "json"], cwd=folder))
    return ", ".join(
        f"{each['name']} {each['version']}" for each in listed if _normalized(each["name"]) in names
    )


def main(arguments: Sequence[str] | None = None) -> int:
    """Build and use the distribution; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.parse_args(arguments)
    with tempfile.TemporaryDirectory(prefix="deros-distribution-") as name:
        folder = Path(name)
        try:
            sdist, wheel = build(folder)
            print(f"{sdist.name} and {wheel.name} hold every source file", flush=True)
            promises = read_promises(_metadata(wheel))
            pythons = find_pythons(promises.pythons)
            if not pythons:
                raise Failure(f"none of Python {', '.join(promises.pythons)} is on this machine")
            absent = [each for each in promises.pythons if each not in pythons]
            if absent:
                print(f"not tried, as not on this machine: Python {', '.join(absent)}")
            tried: tuple[tuple[str, Mapping[str, str], str], ...] = (
                (next(iter(pythons)), promises.floors, "lowest"),
                (next(reversed(pythons)), {}, "newest"),
            )
            # Both at once, as each command keeps one processor busy.
            with ThreadPoolExecutor() as pool:
                running = {}
                for version, constraints, which in tried:
                    place = folder / which
                    place.mkdir()
                    python = pythons[version]
                    task = pool.submit(use, wheel, python, constraints, promises.floors, place)
                    running[task] = f"Python {version}, {which} versions"
                for task in as_completed(running):
                    print(f"{running[task]}: passed ({task.result()})", flush=True)
        except Failure as failure:
            print(failure, file=sys.stderr)
            return 1
    return 0


def commands(folder: Path) -> Iterator[tuple[str, ...]]:
    """Yield what is run on copies of the examples, every built-in target among it."""
    examples = folder / "examples"
    shutil.copytree(REPOSITORY / "examples", examples)
    yield "deros", "--version"
    yield "deros", "explain", "input-without-timeout"
    yield "textx", "list-generators"
    for rules in sorted(examples.glob("*/*.deros")):
        yield "deros", "check", str(rules)
        for target in ("python", "cpp", "c"):
            yield "deros", "generate", str(rules), "--target", target, "-o", str(folder / target)
    for system in sorted(examples.glob("*/*.system")):
        yield "textx", "check", str(system)
        yield "deros", "graph", str(system), "--format", "html"
        # A parameter file holds values, and those of some systems follow from their arguments.
        is_fixed = "\nargument " not in system.read_text(encoding="utf-8")
        for target in ("launch", "script", *(["params"] if is_fixed else [])):
            yield "deros", "generate", str(system), "--target", target, "-o", str(folder / target)
    trace = folder / "trace.jsonl"
    trace.write_text(_TRACE, encoding="utf-8")
    rules = examples / "intelligent_one/intelligent_one.deros"
    for monitor in ("reference", "python"):
        yield (
            "deros",
            "simulate",
            str(rules),
            "--trace",
            str(trace),
            "--until",
            "3",
            "--monitor",
            monitor,
        )
    for node in sorted(examples.glob("intelligent_one/*.rnd")):
        for target in ("python", "cpp"):
            yield "deros", "generate", str(node), "--target", target, "-o", str(folder / target)


def _expect_usage_error(command: Sequence[str | Path], folder: Path) -> None:
    result = subprocess.run(
        command, cwd=folder, env=_clean_environment(), capture_output=True, text=True, check=False
    )
    if result.returncode != 2 or "Traceback" in result.stderr:
        raise Failure(f"{_shown(command)}: exit code {result.returncode}\n{result.stderr}")


def _run(command: Sequence[str | Path], cwd: Path) -> str:
    result = subprocess.run(
        command, cwd=cwd, env=_clean_environment(), capture_output=True, text=True, check=False
    )
    if result.returncode != 0:
        output = (result.stdout + result.stderr)[-4000:]
        raise Failure(f"{_shown(command)}: exit code {result.returncode}\n{output}")
    return result.stdout


def _clean_environment() -> dict[str, str]:
    """Return the environment without what leads Python to this process's own packages."""
    return {
        name: value for name, value in os.environ.items() if not name.startswith(_OF_THIS_PROCESS)
    }


def _shown(command: Sequence[str | Path]) -> str:
    return " ".join(str(word) for word in command)


def _metadata(wheel: Path) -> str:
    with zipfile.ZipFile(wheel) as archive:
        (name,) = (each for each in archive.namelist() if each.endswith(".dist-info/METADATA"))
        return archive.read(name).decode()


def _version_key(version: str) -> tuple[int, ...]:
    return tuple(int(part) for part in version.split("."))


def _normalized(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


if __name__ == "__main__":
    sys.exit(main())
