"""Writing of generated files, with dependency file and stamp for build systems."""

from __future__ import annotations

import time
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
    made: Generated, where: OutputSpec, started_ns: int
) -> tuple[WriteReport, tuple[Diagnostic, ...]]:
    """Write the files, and then dependency file and stamp.

    Returns a report on the files, and the findings about the user's files.

    Args:
        made: what :func:`~deros.pipeline.generate.generate` returned.
        where: the places.
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
    present = _users_files(made, where.source, where.output)
    written = writer.write(merged.files, where.output, overwrite=where.overwrite)
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
        stale = sorted(set(read_stamp(where.stamp)) - ours)
        remove_stale(stale, where.output, overwrite=where.overwrite)
        write_stamp(where.stamp, sorted(ours), started_ns)
    return written, _review(made, present)


def review_source_tree(made: Generated, source: Path) -> tuple[Diagnostic, ...]:
    """Return the findings about the user's files in the source tree of a package."""
    return _review(made, _users_files(made, source, source))


def _users_files(made: Generated, source: Path | None, output: Path) -> dict[str, Path]:
    """Return the user's files that exist, in the source tree of the package if it has one."""
    from deros.generators.output.source_tree import package_folder
    from deros.generators.user_files.review import users_files

    if source is None:
        return users_files(made.files, output)
    return users_files(made.files, source, package_folder(made.files))


def _review(made: Generated, present: Mapping[str, Path]) -> tuple[Diagnostic, ...]:
    from deros.generators.user_files.review import review

    return tuple(review(made.files, present))


def now_ns() -> int:
    """Return the current time on the clock of file modification times."""
    return time.time_ns()
