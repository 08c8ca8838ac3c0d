"""``deros generate``: run one generator on one model and write what it returns."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING

import click

from deros.cli.findings import show
from deros.cli.interrupts import held
from deros.cli.options import interfaces_option
from deros.cli.streams import say

if TYPE_CHECKING:
    from collections.abc import Sequence

    from deros.generators.output.writer import WriteReport


class _GenerateCommand(click.Command):
    """Lists the generators of this environment, with their options, below the help."""

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the targets by language."""
        from deros.generators.api.registry import discover

        super().format_epilog(ctx, formatter)
        registry = discover()
        rows: list[tuple[str, str]] = []
        for each in registry.generators:
            rows.append((f"{each.language} -> {each.target}", each.description))
            rows.extend((f"    --{o.name} TEXT", o.description) for o in each.options)
        with formatter.section("Targets and their options"):
            formatter.write_dl(rows)
        for broken in registry.broken:
            formatter.write_text(
                f"not usable: {broken.entry_point} of {broken.distribution}: {broken.reason}"
            )


@click.command(
    cls=_GenerateCommand,
    context_settings={"ignore_unknown_options": True, "allow_extra_args": True},
)
@click.argument("files", nargs=-1, required=True, type=click.Path())
@click.option(
    "--target",
    help="What to generate; see below.  [default: what the project file says]",
)
@click.option(
    "-o",
    "--output",
    type=click.Path(file_okay=False, path_type=Path),
    help="Folder to write to; created if it does not exist.  [default: what the project file "
    "says, or the current folder]",
)
@click.option("--overwrite", is_flag=True, help="Replace generated files that were edited by hand.")
@interfaces_option
@click.option(
    "--depfile",
    type=click.Path(dir_okay=False, path_type=Path),
    help="Write the dependencies of the output as a Make rule, for build systems.",
)
@click.option(
    "--stamp",
    type=click.Path(dir_okay=False, path_type=Path),
    help="Write this file last, for build systems; files made only by an earlier run are removed.",
)
@click.option(
    "--source",
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    help="Folder of the package's hand-written files, which are combined with the output.",
)
@click.option(
    "--scaffold",
    type=click.Path(file_okay=False, path_type=Path),
    help="Write only the source tree of a package that is generated when built, to this folder.",
)
@click.pass_context
def generate(
    ctx: click.Context,
    files: tuple[str, ...],
    target: str | None,
    output: Path | None,
    overwrite: bool,
    interfaces: tuple[Path, ...],
    depfile: Path | None,
    stamp: Path | None,
    source: Path | None,
    scaffold: Path | None,
) -> None:
    """Generate code, launch files or parameters from the models in FILES.

    FILES are models, and folders, of which every model that has the target is used. Models are
    checked first, and nothing is written if an error is found. Files for you to fill in are written
    once and never overwritten.
    """
    from deros.cli.plan import output_of, plan
    from deros.generators.api.protocol import OptionError
    from deros.generators.output.source_tree import SourceTreeError
    from deros.generators.output.writer import WriteError
    from deros.pipeline import generate as pipeline
    from deros.pipeline.output import OutputSpec, write, write_scaffold
    from deros.pipeline.scaffold import scaffold_command, scaffold_files

    if scaffold is not None and (depfile or stamp or source):
        raise click.UsageError("--scaffold cannot be combined with --depfile, --stamp or --source")
    started = time.time_ns()
    models, options = _apart(files)
    requests = plan(models, target, options, interfaces)
    request = requests[0]
    if len(requests) > 1 and (depfile or stamp or source or scaffold):
        raise click.UsageError(
            "--depfile, --stamp, --source and --scaffold apply to one model only"
        )
    if output is None:
        output = output_of(requests)
    try:
        generated = pipeline.generate(*requests)
        show(generated.findings)
        if scaffold is not None:
            kept = scaffold_files(generated, request, scaffold)
            with held():
                written = write_scaffold(generated, kept, scaffold, overwrite=overwrite)
        else:
            spec = OutputSpec(output, overwrite, source, depfile, stamp)
            with held():
                written = write(generated, spec, started)
    except pipeline.Refused as refused:
        show(refused.diagnostics)
        ctx.exit(refused.code)
    except pipeline.UnknownOption as error:
        raise click.NoSuchOption(error.option, str(error)) from error
    except SourceTreeError as error:
        hint = scaffold_command(request, source or Path())
        mend = f"\n  to fix it: {hint}" if error.mended_by_scaffold else ""
        raise click.ClickException(f"{error}{mend}") from error
    except WriteError as error:
        raise click.ClickException(str(error)) from error
    except OptionError as error:
        raise click.UsageError(str(error)) from error
    show(written.diagnostics)
    say("\n".join(filter(None, [report_written(written.files), *written.notes])))


def _apart(arguments: Sequence[str]) -> tuple[list[str], dict[str, str]]:
    """Return the files, and the generators' own options, ``--name value`` or ``--name=value``."""
    words: list[str] = []
    pairs: dict[str, str] = {}
    left = list(arguments)
    while left:
        first = left.pop(0)
        if not first.startswith("-"):
            words.append(first)
            continue
        if not first.startswith("--"):
            raise click.NoSuchOption(first)
        name, equals, value = first[2:].partition("=")
        if not equals:
            if not left:
                raise click.UsageError(f"Option '--{name}' requires an argument.")
            value = left.pop(0)
        pairs[name] = value
    if not words:
        raise click.UsageError("Missing argument 'FILES...'.")
    return words, pairs


def report_written(written: WriteReport) -> str:
    """Return a report on the files that names the written ones."""
    from deros.generators.output.writer import Outcome

    lines = [f"wrote {written.directory / path}" for path in written.of(Outcome.WRITTEN)]
    for outcome, text in (
        (Outcome.UNCHANGED, "unchanged"),
        (Outcome.USER, "yours, left unchanged"),
        (Outcome.HAND_EDITED, "edited by hand, kept (--overwrite replaces them)"),
    ):
        if count := len(written.of(outcome)):
            lines.append(f"{count} {'file' if count == 1 else 'files'} {text}")
    return "\n".join(lines)
