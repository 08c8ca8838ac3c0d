"""From a model's file to generated files on the disk, as commands and build systems ask for it."""

from __future__ import annotations

import os
import posixpath
import re
import shlex
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from deros.cli.options import FINDINGS, UNUSABLE, exit_code, in_the_way_of_generating

if TYPE_CHECKING:
    from collections.abc import Sequence

    from deros.diagnostics import Diagnostic
    from deros.generators.api.protocol import Context, File, Files
    from deros.generators.api.registry import Generator, Registry
    from deros.generators.output.writer import WriteReport
    from deros.metamodels.load import LoadedFile


class Refused(Exception):  # noqa: N818 - it carries findings, and is no fault of the program
    """Nothing is generated; the diagnostics say why, ``code`` is what to exit with."""

    def __init__(self, diagnostics: Sequence[Diagnostic], code: int) -> None:
        """Carry the findings."""
        self.diagnostics = tuple(diagnostics)
        self.code = code
        super().__init__("; ".join(each.message for each in self.diagnostics))


@dataclass(frozen=True, slots=True)
class Request:
    """What to generate: a model, a target of it, and what both need.

    Attributes:
        file: the model's path, as diagnostics are to show it.
        target: which generator.
        options: those of the generator.
        interfaces: folders with message definitions.
    """

    file: str
    target: str
    options: Mapping[str, str] = field(default_factory=dict)
    interfaces: tuple[Path, ...] = ()


@dataclass(frozen=True, slots=True)
class Made:
    """The files of models, not written yet, with what they were made by and what was found.

    Attributes:
        files: what is to be written.
        context: what the generators looked at.
        generators: those that ran.
        findings: what was found in the models, none of it in the way.
        outputs: the model of each generator, and what it has made.
        rests_on: files besides the models that the result depends on.
    """

    files: Files
    context: Context
    generators: tuple[Generator, ...]
    findings: tuple[Diagnostic, ...]
    outputs: tuple[tuple[str, Files], ...]
    rests_on: tuple[Path, ...] = ()


def make(*requests: Request) -> Made:
    """Load, check and generate; of several models either all or nothing.

    Raises:
        Refused: if a model has an error, if a target cannot be made from it, or if two of them make
            one file differently.
        ValueError: if a generator cannot read an option; ``UnknownOption`` if none has such a one.
    """
    from deros.cli.project import interfaces_of, projects_of
    from deros.diagnostics import in_file_order
    from deros.generators.api.protocol import Context, GenerationError
    from deros.generators.output.writer import join
    from deros.interfaces.store import InterfaceStore
    from deros.metamodels.load import Repository
    from deros.validators.check import check as check_loaded
    from deros.validators.check import check_file

    projects = projects_of(each.file for each in requests)
    folders = interfaces_of(requests[0].interfaces, projects)
    context = Context(InterfaceStore(folders), Repository(), check_file)
    loaded = [context.repository.load(each.file) for each in requests]
    allowances = [each for project in projects for each in project.allowances]
    findings = check_loaded(loaded, context.repository, context.store, allowances)
    findings = in_file_order([*findings, *(d for each in projects for d in each.diagnostics)])
    # What is made of a system itself needs its gates: then nothing is yet to be mended.
    order = sorted((each.file for each in requests), key=lambda file: not file.endswith(".system"))
    code = exit_code(in_the_way_of_generating(findings, order[0]))
    if code or any(each.language is None for each in loaded):
        raise Refused(findings, code or FINDINGS)
    generators = [_generator(*pair, findings) for pair in zip(requests, loaded, strict=True)]
    options = _options(requests, generators)
    try:
        outputs = [
            (file.path, generator(file.model, context, given))
            for file, generator, given in zip(loaded, generators, options, strict=True)
        ]
    except GenerationError as error:
        raise Refused([*findings, *error.diagnostics], FINDINGS) from error
    rests_on = tuple(each.path for each in projects if each.path is not None)
    files = join(outputs)
    return Made(files, context, tuple(generators), tuple(findings), tuple(outputs), rests_on)


def _generator(request: Request, loaded: LoadedFile, findings: Sequence[Diagnostic]) -> Generator:
    from deros.generators.api.registry import discover

    assert loaded.language is not None
    generator = discover().find(loaded.language, request.target)
    if generator is None:
        unknown = _unknown_target(discover(), loaded, request.target)
        raise Refused([*findings, unknown], UNUSABLE)
    return generator


def _options(
    requests: Sequence[Request], generators: Sequence[Generator]
) -> list[Mapping[str, str]]:
    """Return what each generator is given: its own of the options, and what the project says.

    Raises:
        UnknownOption: no generator of the run has an option that the command line gives.
    """
    from deros.cli.project import project_of

    _know_options(generators, requests[0].options)
    result: list[Mapping[str, str]] = []
    for request, generator in zip(requests, generators, strict=True):
        known = {option.name for option in generator.options}
        given = {**project_of(request.file).options, **request.options}
        result.append({name: text for name, text in given.items() if name in known})
    return result


@dataclass(frozen=True, slots=True)
class Place:
    """Where files go, and what a build system is to know of it.

    Attributes:
        output: the folder to write to.
        overwrite: whether files of the generator that a hand has edited are replaced.
        source: where the hand-written files of the package are, if not in the output.
        depfile: where to write what the output rests on, as a rule of Make.
        stamp: the file that stands for the whole output; the rule's target.
        rests_on: files that it rests on besides those that are read here.
    """

    output: Path
    overwrite: bool = False
    source: Path | None = None
    depfile: Path | None = None
    stamp: Path | None = None
    rests_on: tuple[Path, ...] = ()


def put(made: Made, where: Place, started_ns: int) -> tuple[WriteReport, tuple[Diagnostic, ...]]:
    """Write the files, and last what the build system is to know.

    Returns what became of the files, and what those of the user lack now.

    Args:
        made: what :func:`make` returned.
        where: the places.
        started_ns: when the run began, by ``time.time_ns``.

    Raises:
        Refused: if another target or model has made a file that would be replaced.
        WriteError: if something cannot be written.
        SourceTreeError: if the source tree lacks a file, or has one that is in the way.
    """
    from deros.cli.depfile import depfile, inputs, stamp, stamped, write_if_changed
    from deros.generators.api.protocol import GenerationError, Owner
    from deros.generators.output.claims import Origin, check_claims, record_claims
    from deros.generators.output.source_tree import (
        Merged,
        merge,
        package_folder,
        place,
        remove_stale,
    )
    from deros.generators.output.writer import write
    from deros.generators.user_files.review import review, users_files

    merged = Merged(made.files, (), ())
    if where.source is not None:
        merged = merge(made.files, where.source, where.output)
    claims = [
        (
            {path: file for path, file in merged.files.items() if path in files},
            Origin.of(generator.language, generator.target, model, where.output),
        )
        for generator, (model, files) in zip(made.generators, made.outputs, strict=True)
    ]
    try:
        for files, origin in claims:
            check_claims(files, where.output, origin)
    except GenerationError as error:
        raise Refused(error.diagnostics, FINDINGS) from error
    if where.source is None:
        users = users_files(made.files, where.output)
    else:
        users = users_files(made.files, where.source, package_folder(made.files))
    written = write(merged.files, where.output, overwrite=where.overwrite)
    if where.stamp is None and where.source is None:  # else the build system owns the folder
        for files, origin in claims:
            record_claims(files, where.output, origin)
    place(merged.placed, where.output)
    ours = {path for path, file in merged.files.items() if file.owner is Owner.GENERATOR}
    ours |= {each.path for each in merged.placed}
    if where.depfile is not None:
        everything = [str(where.output / path) for path in sorted(ours)]
        targets = everything if where.stamp is None else [str(where.stamp)]
        more = [*merged.inputs, *where.rests_on, *made.rests_on]
        found = inputs(made.context, made.generators, more)
        write_if_changed(where.depfile, depfile(targets, found))
    if where.stamp is not None:
        stale = sorted(set(stamped(where.stamp)) - ours)
        remove_stale(stale, where.output, overwrite=where.overwrite)
        stamp(where.stamp, sorted(ours), started_ns)
    return written, tuple(review(made.files, users))


def lacking(made: Made, source: Path) -> tuple[Diagnostic, ...]:
    """Return what the user's files in the source tree of a package lack now."""
    from deros.generators.output.source_tree import package_folder
    from deros.generators.user_files.review import review, users_files

    return tuple(review(made.files, users_files(made.files, source, package_folder(made.files))))


def now_ns() -> int:
    """Return the time of the files' clock."""
    return time.time_ns()


def scaffold_files(made: Made, request: Request, source: Path) -> dict[str, File]:
    """Return what the source tree of a package has that is generated while it is built.

    The script that has it generated is part of it; it is the user's once it is written.
    """
    from deros.generators.api.protocol import File, Owner
    from deros.generators.output.source_tree import package_folder, scaffold

    top = package_folder(made.files)
    model = Path(os.path.relpath(request.file, source)).as_posix()
    folder = posixpath.dirname(model)
    files = scaffold(made.files, source, "" if folder.startswith("..") else folder)
    if f"{top}/CMakeLists.txt" in made.files:
        files["CMakeLists.txt"] = File(_cmake_script(top, model, request), Owner.USER)
    elif f"{top}/setup.py" in made.files:
        files["setup.py"] = File(_setup_script(model, request), Owner.USER)
    return files


def scaffold_command(request: Request, source: Path) -> str:
    """Return the command that makes, or mends, what a package has in its source tree."""
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


class UnknownOption(ValueError):  # noqa: N818 - named after what it is
    """The generator has no option of that name."""

    def __init__(self, name: str, hint: str) -> None:
        """Name it, with the nearest ones."""
        self.option = f"--{name}"
        super().__init__(f"No such option: --{name}" + (f"; {hint}" if hint else ""))


def _unknown_target(registry: Registry, loaded: LoadedFile, target: str) -> Diagnostic:
    from deros import codes
    from deros.diagnostics import SourceFile, Span
    from deros.diagnostics import report as finding
    from deros.validators.hints import did_you_mean

    assert loaded.language is not None
    targets = registry.targets(loaded.language)
    hint = did_you_mean(target, targets, f"it has {', '.join(targets)}" if targets else "")
    for broken in registry.broken:
        hint += f"; {broken.entry_point} of {broken.distribution} is unusable: {broken.reason}"
    source = loaded.source or SourceFile(loaded.path, "")
    message = f"no generator makes '{target}' from {loaded.language}"
    return finding(codes.UNKNOWN_TARGET, message, Span(source, 0, 0), hint.removeprefix("; "))


def _know_options(generators: Sequence[Generator], given: Mapping[str, str]) -> None:
    from deros.validators.hints import did_you_mean

    known = [f"--{option.name}" for generator in generators for option in generator.options]
    for name in given:
        if f"--{name}" not in known:
            raise UnknownOption(
                name, did_you_mean(f"--{name}", [*known, "--overwrite", "--interfaces"])
            )
