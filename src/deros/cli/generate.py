"""``deros generate``: run one generator on one model and write what it returns."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from deros.cli.options import (
    FINDINGS,
    UNUSABLE,
    exit_code,
    in_the_way_of_generating,
    interfaces_option,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from deros.diagnostics import Diagnostic
    from deros.generators.registry import Generator, Registry
    from deros.generators.writer import WriteReport
    from deros.metamodels.load import LoadedFile


class _GenerateCommand(click.Command):
    """Lists the generators of this environment, with their options, below the help."""

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the targets by language."""
        from deros.generators.registry import discover

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
@click.argument("file", type=click.Path())
@click.option("--target", required=True, help="What to generate; see below.")
@click.option(
    "-o",
    "--output",
    type=click.Path(file_okay=False, path_type=Path),
    default=Path(),
    help="Folder to write to; made if it is not there.  [default: the current folder]",
)
@click.option("--overwrite", is_flag=True, help="Replace generated files that were edited by hand.")
@interfaces_option
@click.pass_context
def generate(
    ctx: click.Context,
    file: str,
    target: str,
    output: Path,
    overwrite: bool,
    interfaces: tuple[Path, ...],
) -> None:
    """Generate code, launch files or parameters from the model in FILE.

    The model is checked first, and nothing is written if an error is found. Files that are made
    for you to fill in are written once and never again.
    """
    from deros.generators.protocol import Context, GenerationError
    from deros.generators.registry import discover
    from deros.generators.writer import WriteError, write
    from deros.interfaces.store import InterfaceStore
    from deros.metamodels.load import Repository
    from deros.validators.check import check as check_loaded

    given = _pairs(ctx.args)
    store, repository = InterfaceStore(interfaces), Repository()
    loaded = repository.load(file)
    findings = check_loaded([loaded], repository, store)
    _show(findings)
    code = exit_code(in_the_way_of_generating(findings, file))
    if code or loaded.language is None:
        ctx.exit(code or FINDINGS)
    generator = discover().find(loaded.language, target)
    if generator is None:
        _show([_unknown_target(discover(), loaded, target)])
        ctx.exit(UNUSABLE)
    _know_options(generator, given)
    try:
        files = generator(loaded.model, Context(store, repository), given)
        written = write(files, output, overwrite=overwrite)
    except GenerationError as error:
        _show(error.diagnostics)
        ctx.exit(FINDINGS)
    except WriteError as error:
        raise click.ClickException(str(error)) from error
    except ValueError as error:
        raise click.UsageError(str(error)) from error
    _show(written.diagnostics)
    click.echo(_report(written))


def _pairs(arguments: Sequence[str]) -> dict[str, str]:
    """Read the generator's own options, ``--name value`` or ``--name=value``."""
    pairs: dict[str, str] = {}
    left = list(arguments)
    while left:
        first = left.pop(0)
        if not first.startswith("--"):
            raise click.UsageError(f"Got unexpected extra argument ({first})")
        name, equals, value = first[2:].partition("=")
        if not equals:
            if not left:
                raise click.UsageError(f"Option '--{name}' requires an argument.")
            value = left.pop(0)
        pairs[name] = value
    return pairs


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


def _know_options(generator: Generator, given: dict[str, str]) -> None:
    from deros.validators.hints import did_you_mean

    known = [f"--{option.name}" for option in generator.options]
    for name in given:
        if f"--{name}" not in known:
            hint = did_you_mean(f"--{name}", [*known, "--overwrite", "--interfaces"])
            raise click.NoSuchOption(
                f"--{name}", f"No such option: --{name}" + (f"; {hint}" if hint else "")
            )


def _show(diagnostics: Sequence[Diagnostic]) -> None:
    import sys

    from deros.cli.render import print_text

    print_text(diagnostics, sys.stderr)


def _report(written: WriteReport) -> str:
    """Say what became of the files, naming those that were written."""
    from deros.generators.writer import Outcome

    lines = [f"wrote {written.directory / path}" for path in written.of(Outcome.WRITTEN)]
    for outcome, text in (
        (Outcome.UNCHANGED, "unchanged"),
        (Outcome.USER, "yours, left as they are"),
        (Outcome.HAND_EDITED, "edited by hand, kept (--overwrite replaces them)"),
    ):
        if count := len(written.of(outcome)):
            lines.append(f"{count} {'file' if count == 1 else 'files'} {text}")
    return "\n".join(lines)
