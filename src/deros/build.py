"""Support for setup.py of an ament_python package that is generated when it is built.

The package keeps its models, its package.xml and what is written by hand::

    from deros.build import setup

    setup('models/robot.deros')

Everything else is made in the folder ``.deros`` beside setup.py, each time that setup.py runs;
unchanged files are not touched. Do not edit it or check it in.
"""

from __future__ import annotations

import configparser
import os
import runpy
import sys
import time
import xml.etree.ElementTree as ElementTree
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from deros.diagnostics import Diagnostic
    from deros.pipeline.generate import Request

FOLDER = ".deros"
"""The folder of generated files, in the source tree: setup.py may not name files outside it."""


def setup(
    model: str,
    *,
    target: str = "python",
    options: Mapping[str, str] | None = None,
    interfaces: Sequence[str] = (),
    **more: Any,
) -> None:
    """Generate an ament_python package and run setuptools on it and the hand-written files.

    An error in the model ends the build with deros' own diagnostics on standard error.

    Args:
        model: the model's path, relative to the folder of setup.py.
        target: the generator; it must make an ament_python package.
        options: the generator's options, ``{"maintainer": "Jane Doe <jane@example.com>"}``.
        interfaces: folders with message definitions, relative to the folder of setup.py.
        more: further arguments of setuptools' ``setup``. Lists and dictionaries are joined with
            the generated ones, anything else takes their place.
    """
    import setuptools

    from deros.metamodels.imports import shown_path
    from deros.pipeline.generate import Request

    # colcon's symlink-install runs a link to setup.py; the package is where the file itself is.
    source = Path(sys._getframe(1).f_globals["__file__"]).resolve().parent
    folders = tuple(source / each for each in interfaces)
    request = Request(shown_path(str(source / model)), target, dict(options or {}), folders)
    outcome = _generate(request, source)
    arguments = _placeholder(source)
    if outcome.package is not None:
        arguments = _joined(_arguments(source, outcome.package), more)
    setuptools.setup(**{**arguments, "distclass": _distribution(outcome)})


@dataclass(frozen=True, slots=True)
class _Outcome:
    """The generated package, or the reason why there is none, and the findings."""

    package: str | None
    findings: Sequence[Diagnostic] = ()
    failure: str | int = 0


def _generate(request: Request, source: Path) -> _Outcome:
    """Bring the generated package up to date.

    colcon runs a setup.py half a dozen times for one build, so it pays to see that nothing changed.
    """
    from deros.generators.output.source_tree import SourceTreeError, package_folder
    from deros.generators.output.writer import WriteError
    from deros.pipeline.depfile import is_current, read_stamp, write_if_changed
    from deros.pipeline.generate import Refused, generate
    from deros.pipeline.output import OutputSpec, write
    from deros.pipeline.scaffold import scaffold_command

    output = source / FOLDER
    stamp, depfile, ros = output / "stamp", output / "depends.d", output / "ament_prefix_path"
    rests_on = (source / "setup.py", ros)
    spec = OutputSpec(output, True, source, depfile, stamp, rests_on)
    findings: Sequence[Diagnostic] = ()
    try:
        write_if_changed(output / ".gitignore", "*\n")
        write_if_changed(ros, os.environ.get("AMENT_PREFIX_PATH", ""))
        started = time.time_ns()
        there = read_stamp(stamp)
        whole = bool(there) and all((output / each).exists() for each in there)
        if whole and is_current(stamp, depfile):
            return _Outcome(there[0].partition("/")[0])
        generated = generate(request)
        findings = generated.findings
        package = package_folder(generated.files)
        if f"{package}/setup.py" not in generated.files:
            raise ValueError(
                f"the target {request.target} does not generate an ament_python package"
            )
        lacking = write(generated, spec, started).lacking
        findings = (*findings, *lacking)
        if lacking:  # so that the next build reports it again
            os.utime(stamp, ns=(0, 0))
    except Refused as refused:
        return _Outcome(None, refused.diagnostics, refused.code)
    except SourceTreeError as error:
        hint = f"\n  to fix it: {scaffold_command(request, source)}"
        failure = f"deros: {error}{hint if error.mended_by_scaffold else ''}"
        return _Outcome(None, findings, failure)
    except (OSError, ValueError, WriteError) as error:
        return _Outcome(None, findings, f"deros: {error}")
    return _Outcome(package, findings)


def _distribution(outcome: _Outcome) -> type[Any]:
    """Return the class of a distribution that prints the findings when commands are run.

    colcon asks a setup.py several questions before it builds, and its own complaint about one that
    fails to answer would bury ours.
    """
    from setuptools import Distribution

    class Package(Distribution):  # type: ignore[misc]  # setuptools has no type hints
        def run_commands(self) -> None:
            from deros.report.text import print_text

            print_text(outcome.findings, sys.stderr)
            if outcome.failure:
                sys.exit(outcome.failure)
            super().run_commands()

    return Package


def _placeholder(source: Path) -> dict[str, Any]:
    """Return the arguments that colcon needs for a package that cannot be generated."""
    try:
        name = ElementTree.parse(source / "package.xml").findtext("name", source.name).strip()
    except (OSError, ElementTree.ParseError):
        name = source.name
    resource = f"{FOLDER}/{name}/resource/{name}"
    marker = ("share/ament_index/resource_index/packages", [resource])
    return {"name": name, "data_files": [marker, (f"share/{name}", ["package.xml"])]}


def _arguments(source: Path, package: str) -> dict[str, Any]:
    """Return the arguments of the generated setup.py and setup.cfg, for the source tree."""
    root = source / FOLDER / package
    arguments = _called_with(root / "setup.py")
    below = f"{FOLDER}/{package}"
    tops = [name for name in arguments.get("packages", ()) if "." not in name]
    arguments["package_dir"] = {name: f"{below}/{name}" for name in tops}
    arguments["data_files"] = [
        # colcon looks for the manifest under its own name.
        (folder, [name if name == "package.xml" else f"{below}/{name}" for name in names])
        for folder, names in arguments.get("data_files", ())
    ]
    config = configparser.RawConfigParser()
    config.read(root / "setup.cfg", encoding="utf-8")
    arguments["options"] = {name: dict(config[name]) for name in config.sections()}
    return arguments


def _called_with(script: Path) -> dict[str, Any]:
    """Run a setup.py and return the arguments that it passes to setuptools' ``setup``."""
    import setuptools

    taken: dict[str, Any] = {}
    here, genuine = Path.cwd(), setuptools.setup
    setuptools.setup = taken.update
    os.chdir(script.parent)
    try:
        runpy.run_path(script.name)
    finally:
        os.chdir(here)
        setuptools.setup = genuine
    return taken


def _joined(ours: Any, theirs: Any) -> Any:
    """Join lists and dictionaries; for anything else ``theirs`` takes precedence."""
    if isinstance(ours, dict) and isinstance(theirs, Mapping):
        both = {name: _joined(ours[name], theirs[name]) for name in ours.keys() & theirs.keys()}
        return {**ours, **theirs, **both}
    if isinstance(ours, list) and isinstance(theirs, (list, tuple)):
        return [*ours, *theirs]
    return theirs
