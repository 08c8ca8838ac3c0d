"""``deros test``: play timelines against safety rules, and report what differs."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from deros.cli.findings import show
from deros.cli.interrupts import held
from deros.cli.options import grace_option, interfaces_option
from deros.cli.streams import say
from deros.metamodels.languages import DEROS, language_of
from deros.pipeline.outcome import CLEAN, FINDINGS, UNUSABLE

if TYPE_CHECKING:
    from collections.abc import Sequence

    from deros.simulation.timelines.results import RuleTests


@click.command()
@click.argument("files", nargs=-1, required=True, type=click.Path())
@click.option("--strict", is_flag=True, help="Fail the run on what no timeline reaches, too.")
@click.option(
    "--format",
    "output_format",
    type=click.Choice(("text", "json")),
    default="text",
    show_default=True,
    help="How to report the results.",
)
@click.option(
    "--junit",
    metavar="FILE",
    type=click.Path(dir_okay=False, path_type=Path),
    help="Write the results to this file, too, as JUnit has them in XML.",
)
@grace_option
@interfaces_option
@click.pass_context
def test(
    ctx: click.Context,
    files: tuple[str, ...],
    strict: bool,
    output_format: str,
    junit: Path | None,
    grace_ns: int,
    interfaces: tuple[Path, ...],
) -> None:
    """Test safety rules on timelines.

    FILES are timelines in Markdown (*.md, *.timeline), and folders, of which all timelines are
    played. A timeline is a table of what comes and what has to happen:

    \b
        Rules: [robot.deros](robot.deros)

    \b
        | time                  | message     | effect |
        |-----------------------|-------------|--------|
        | every 0.1 s until 3 s | speed = 0.6 |        |
        | 2.1 s                 |             | stop   |

    Reports what differs, and why; and which rules, behaviours and sides of conditions no timeline
    reaches. Exits with 0 if all timelines pass, 1 if something differs (what is not reached counts
    under --strict), 2 if a timeline, a trace or the rules cannot be used.
    """  # noqa: D301 - click knows a block by the character itself
    from deros.pipeline.rule_tests import run_rule_tests
    from deros.report import rule_tests as report

    timelines, rules = _named(files)
    results = run_rule_tests(timelines, rules, interfaces, grace_ns)
    show(results.diagnostics)
    if output_format == "json":
        say(report.render_json(results), end="")
    else:
        report.print_text(results, sys.stdout)
    if junit is not None:
        try:
            with held():
                junit.write_text(report.render_junit(results), encoding="utf-8")
        except OSError as error:
            raise click.ClickException(f"cannot write '{junit}': {error.strerror}") from error
    ctx.exit(_exit_code(results, strict=strict))


def _exit_code(results: RuleTests, *, strict: bool) -> int:
    if any(each.is_error for each in results.diagnostics):
        return UNUSABLE
    has_gaps = bool(results.unplayed) or any(each.coverage.gaps() for each in results.players)
    differs = any(each.differences for each in results.outcomes)
    return FINDINGS if differs or (strict and has_gaps) else CLEAN


def _named(files: Sequence[str]) -> tuple[list[str], list[str]]:
    """Return the files of timelines that the arguments name, and those of rules beside them.

    Raises:
        click.UsageError: there are none in a folder, or a model is named.
    """
    from deros.cli.models import files_below
    from deros.pipeline.rule_tests import SUFFIXES, is_timeline_file

    timelines: dict[str, None] = {}
    rules: dict[str, None] = {}
    for path in files:
        if not Path(path).is_dir():
            if language_of(path) is not None:
                hint = "name the timelines, or the folder that they are in"
                raise click.UsageError(f"'{path}' is a model, not a file of timelines: {hint}")
            timelines[path] = None
            continue
        found = files_below(path, is_timeline_file)
        if not found:
            suffixes = ", ".join(SUFFIXES)
            raise click.UsageError(f"the folder '{path}' contains no timeline ({suffixes})")
        timelines.update(dict.fromkeys(found))
        rules.update(dict.fromkeys(files_below(path, lambda each: language_of(each) is DEROS)))
    return list(timelines), list(rules)
