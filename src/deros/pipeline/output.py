"""Writing of generated files, with dependency file and stamp for build systems."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from deros.pipeline.generate import Refused
from deros.pipeline.outcome import FINDINGS

if TYPE_CHECKING:
    from collections.abc import Mapping

    from deros.diagnostics import Diagnostic
    from deros.generators.output.writer import WriteReport
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


def write(
    generated: Generated, spec: OutputSpec, started_ns: int
) -> tuple[WriteReport, tuple[Diagnostic, ...]]:
    """Write the files, and then dependency file and stamp.

    Returns a report on the files, and the findings about the user's files.

    Args:
        generated: the files, as :func:`~deros.pipeline.generate.generate` returned them.
        spec: the destinations.
        started_ns: when the run began, by ``time.time_ns``.

    Raises:
        Refused: if another target or model has made a file that would be replaced.
        WriteError: if something cannot be written.
        SourceTreeError: if the source tree lacks a file, or has one that is in the way.
    """
    from deros.generators.api.protocol import GenerationError, Owner
    from deros.generators.output import writer
    from deros.generators.output.claims import Origin, check_claims, record_claims
    from deros.generators.output.source_tree import (
        Merged,
        merge,
        place,
        remove_stale,
    )
    from deros.pipeline.depfile import depfile, inputs, read_stamp, write_if_changed, write_stamp

    merged = Merged(generated.files, (), ())
    if spec.source is not None:
        merged = merge(generated.files, spec.source, spec.output)
    claims = [
        (
            {path: file for path, file in merged.files.items() if path in files},
            Origin.of(generator.language, generator.target, model, spec.output),
        )
        for generator, (model, files) in zip(generated.generators, generated.outputs, strict=True)
    ]
    try:
        for files, origin in claims:
            check_claims(files, spec.output, origin)
    except GenerationError as error:
        raise Refused(error.diagnostics, FINDINGS) from error
    present = _users_files(generated, spec.source, spec.output)
    written = writer.write(merged.files, spec.output, overwrite=spec.overwrite)
    if spec.stamp is None and spec.source is None:  # else the build system owns the folder
        for files, origin in claims:
            record_claims(files, spec.output, origin)
    place(merged.placed, spec.output)
    ours = {path for path, file in merged.files.items() if file.owner is Owner.GENERATOR}
    ours |= {each.path for each in merged.placed}
    if spec.depfile is not None:
        everything = [str(spec.output / path) for path in sorted(ours)]
        targets = everything if spec.stamp is None else [str(spec.stamp)]
        more = [*merged.inputs, *spec.rests_on, *generated.rests_on]
        found = inputs(generated.context, generated.generators, more)
        write_if_changed(spec.depfile, depfile(targets, found))
    if spec.stamp is not None:
        stale = sorted(set(read_stamp(spec.stamp)) - ours)
        remove_stale(stale, spec.output, overwrite=spec.overwrite)
        write_stamp(spec.stamp, sorted(ours), started_ns)
    return written, _review(generated, present)


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
