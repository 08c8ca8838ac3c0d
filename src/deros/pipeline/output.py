"""Writing of generated files, with dependency file and stamp for build systems."""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from deros.generators.output.writer import WriteReport
from deros.pipeline.generate import Refused
from deros.pipeline.outcome import FINDINGS

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from deros.diagnostics import Diagnostic
    from deros.generators.api.protocol import File, Files
    from deros.generators.output.claims import Origin
    from deros.pipeline.generate import Generated


@dataclass(frozen=True, slots=True)
class OutputSpec:
    """The destinations of a run.

    Attributes:
        output: the folder to write to.
        overwrite: whether generated files that were edited by hand are replaced.
        source: where the hand-written files of the package are, if not in the output.
        depfile: where to write the dependencies of the output as a Make rule.
        stamp: the file that stands for the whole output; the rule's target.
        rests_on: dependencies besides the files that are read here.
    """

    output: Path
    overwrite: bool = False
    source: Path | None = None
    depfile: Path | None = None
    stamp: Path | None = None
    rests_on: tuple[Path, ...] = ()


@dataclass(frozen=True, slots=True)
class Written:
    """What a run has written.

    Attributes:
        files: the outcomes of the generated files.
        runtime: the outcomes of the runtime packages beside them.
        notes: a line for each runtime package that the generated ones depend on.
        lacking: the findings about the user's files.
    """

    files: WriteReport
    runtime: WriteReport
    notes: tuple[str, ...]
    lacking: tuple[Diagnostic, ...]

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """The findings about all files."""
        return (*self.files.diagnostics, *self.runtime.diagnostics, *self.lacking)


def write(generated: Generated, spec: OutputSpec, started_ns: int) -> Written:
    """Write the files, and then dependency file and stamp.

    The runtime packages that they depend on are part of it, unless a build system generates one
    package in its source tree: there, the workspace must have them.

    Args:
        generated: the files, as :func:`~deros.pipeline.generate.generate` returned them.
        spec: the destinations.
        started_ns: when the run began, by ``time.time_ns``.

    Raises:
        Refused: if another target or model has made a file that would be replaced.
        WriteError: if something cannot be written, or the workspace has another version of the
            runtime.
        SourceTreeError: if the source tree lacks a file, or has one that is in the way.
    """
    from deros.generators.api.protocol import GenerationError, Owner
    from deros.generators.output import writer
    from deros.generators.output.claims import RUNTIME, Origin, check_claims, record_claims
    from deros.generators.output.source_tree import (
        Merged,
        merge,
        place,
        remove_stale,
    )
    from deros.pipeline.depfile import depfile, inputs, read_stamp, write_if_changed, write_stamp
    from deros.pipeline.runtime import Placement, place_runtime

    generated = _without_originals(generated, spec.output)
    if spec.source is not None:
        merged = merge(generated.files, spec.source, spec.output)
        runtime = Placement()
    else:
        merged = Merged(generated.files, (), ())
        runtime = place_runtime(generated.files, spec.output, overwrite=spec.overwrite)
    claims = [
        (
            {path: file for path, file in merged.files.items() if path in files},
            Origin.of(generator.language, generator.target, model, spec.output),
        )
        for generator, (model, files) in zip(generated.generators, generated.outputs, strict=True)
    ]
    claims = list(_claims_of_copies(claims, spec.output))
    if runtime.files:
        claims.append((dict(runtime.files), RUNTIME))
    try:
        for files, origin in claims:
            check_claims(files, spec.output, origin)
    except GenerationError as error:
        raise Refused(error.diagnostics, FINDINGS) from error
    # Before anything is written: it reads the texts of generated files.
    lacking = _review(generated, _users_files(generated, spec.source, spec.output))
    everything = {**merged.files, **runtime.files}
    written = writer.write(everything, spec.output, overwrite=spec.overwrite)
    if spec.stamp is None and spec.source is None:  # else the build system owns the folder
        for files, origin in claims:
            record_claims(files, spec.output, origin)
    place(merged.placed, spec.output)
    ours = {path for path, file in everything.items() if file.owner is Owner.GENERATOR}
    ours |= {each.path for each in merged.placed}
    if spec.depfile is not None:
        paths = [str(spec.output / path) for path in sorted(ours)]
        targets = paths if spec.stamp is None else [str(spec.stamp)]
        more = [*merged.inputs, *spec.rests_on, *generated.rests_on]
        found = inputs(generated.context, generated.generators, more)
        write_if_changed(spec.depfile, depfile(targets, found))
    if spec.stamp is not None:
        stale = sorted(set(read_stamp(spec.stamp)) - ours)
        remove_stale(stale, spec.output, overwrite=spec.overwrite)
        write_stamp(spec.stamp, sorted(ours), started_ns)
    own, beside = written.apart(runtime.files)
    return Written(own, beside, runtime.notes(beside), lacking)


def _without_originals(generated: Generated, output: Path) -> Generated:
    """Leave out the copies whose originals lie where they would be written."""

    def apart(files: Files) -> Files:
        return {
            path: file
            for path, file in files.items()
            if file.original is None
            or os.path.realpath(output / path) != os.path.realpath(file.original)
        }

    outputs = tuple((model, apart(files)) for model, files in generated.outputs)
    return replace(generated, files=apart(generated.files), outputs=outputs)


def _claims_of_copies(
    claims: Iterable[tuple[dict[str, File], Origin]], output: Path
) -> Iterator[tuple[dict[str, File], Origin]]:
    """Yield claims, those of copies apart: several targets and models may need one."""
    from deros.generators.output.claims import Origin

    for files, origin in claims:
        yield {path: each for path, each in files.items() if each.original is None}, origin
        for path, each in files.items():
            if each.original is not None:
                yield {path: each}, Origin.of("YAML", "copy", str(each.original), output)


def write_scaffold(
    generated: Generated, files: Files, source: Path, *, overwrite: bool = False
) -> Written:
    """Write the source tree of a package that is generated when it is built.

    In a workspace, the runtime packages that it depends on are written beside it.

    Args:
        generated: the files of the whole package.
        files: those that its source tree has.
        source: the folder of the source tree.
        overwrite: whether generated files that were edited by hand are replaced.

    Raises:
        Refused: if another target or model has made a file that would be replaced.
        WriteError: as :func:`write`.
    """
    from deros.generators.api.protocol import GenerationError
    from deros.generators.output import writer
    from deros.generators.output.claims import RUNTIME, check_claims, record_claims
    from deros.pipeline.runtime import place_runtime, workspace_of

    beside = source.parent if source.name not in ("", "..") else source.resolve().parent
    runtime = place_runtime(generated.files, beside, overwrite=overwrite)
    lacking = review_source_tree(generated, source)
    if runtime.files and workspace_of(beside.resolve()) is None:
        written = writer.write(files, source, overwrite=overwrite)
        needed = ", ".join(runtime.versions)
        note = f"the package depends on {needed}: 'deros runtime' writes it into your workspace"
        return Written(written, WriteReport(beside, ()), (*runtime.found, note), lacking)
    try:
        check_claims(runtime.files, beside, RUNTIME)
    except GenerationError as error:
        raise Refused(error.diagnostics, FINDINGS) from error
    written = writer.write(files, source, overwrite=overwrite)
    placed = writer.write(runtime.files, beside, overwrite=overwrite)
    if runtime.files:
        record_claims(runtime.files, beside, RUNTIME)
    return Written(written, placed, runtime.notes(placed), lacking)


def review_source_tree(generated: Generated, source: Path) -> tuple[Diagnostic, ...]:
    """Return the findings about the user's files in the source tree of a package."""
    return _review(generated, _users_files(generated, source, source))


def _users_files(generated: Generated, source: Path | None, output: Path) -> dict[str, Path]:
    """Return the user's files that exist, in the source tree of the package if it has one."""
    from deros.generators.output.source_tree import package_folder
    from deros.generators.user_files.review import users_files

    if source is None:
        return users_files(generated.files, output)
    return users_files(generated.files, source, package_folder(generated.files))


def _review(generated: Generated, present: Mapping[str, Path]) -> tuple[Diagnostic, ...]:
    from deros.generators.user_files.review import review

    return tuple(review(generated.files, present))
