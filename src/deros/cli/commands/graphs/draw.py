"""``deros draw``: draw the zones of safety rules to scale."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from deros.cli.findings import show, wrong_language
from deros.cli.options import interfaces_option
from deros.cli.streams import say

if TYPE_CHECKING:
    from deros.report.areas.plans import Area


@click.command()
@click.argument("file", type=click.Path())
@click.option(
    "--format",
    "form",
    type=click.Choice(["svg", "html"]),
    default="svg",
    show_default=True,
    help="A picture, or a page for the browser.",
)
@click.option(
    "--outline",
    metavar="SHAPE",
    help="The robot itself, as zones are written: 'circle (0, 0) 0.2 m'.",
)
@interfaces_option
@click.pass_context
def draw(
    ctx: click.Context, file: str, form: str, outline: str | None, interfaces: tuple[Path, ...]
) -> None:
    """Draw the zones of the rules in FILE to scale, with the scanners that look into them.

    There is one plan for each place that zones are measured from: the robot, where scanners say
    with 'mounted' where they are; a scanner that does not; a position. Findings go to standard
    error. Errors fail the command, and nothing is drawn: deros draw X.deros > X.svg
    """
    from deros.metamodels.languages import DEROS
    from deros.models.rules import Rules
    from deros.pipeline.outcome import exit_code
    from deros.pipeline.workspace import load
    from deros.report.areas import picture
    from deros.report.areas.plans import plans

    robot = _outline(outline)
    workspace = load([file], interfaces)
    findings = workspace.check_models().findings
    show(findings)
    (loaded,) = workspace.files
    if loaded.model is not None and not isinstance(loaded.model, Rules):
        raise wrong_language(file, DEROS)
    code = exit_code(findings)
    program = None
    if isinstance(loaded.model, Rules) and not any(each.is_error for each in findings):
        program = workspace.builds.of(loaded.model).program
    if program is not None and isinstance(loaded.model, Rules):
        found = plans(loaded.model, program)
        if not found:
            raise click.UsageError(
                f"the rules in {file} ask for no zone; 'zone front = rectangle (0, -0.4) (1, 0.4)"
                " m' declares one, and 'scan.points_in(front) >= 4' asks for it"
            )
        write = {"svg": picture.as_svg, "html": picture.as_html}[form]
        say(write(program.name, found, robot), end="")
    ctx.exit(code)


def _outline(text: str | None) -> Area | None:
    from deros.report.areas.plans import outline

    if text is None:
        return None
    try:
        return outline(text)
    except ValueError as fault:
        hint = "write it as a zone: 'rectangle (-0.3, -0.2) (0.3, 0.2) m'"
        raise click.BadParameter(f"{fault}; {hint}", param_hint="--outline") from None
