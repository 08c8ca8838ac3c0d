"""``deros export``: write models in formats of other tools."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from deros.cli.findings import show, wrong_language
from deros.cli.interrupts import held
from deros.cli.options import interfaces_option
from deros.cli.streams import say
from deros.pipeline.outcome import CLEAN, FINDINGS, exit_code

if TYPE_CHECKING:
    from deros.exporters.results import Exported
    from deros.metamodels.load import LoadedFile


@click.command(
    epilog="Exit codes: 0 if the files say all that is in the model, 1 if something is missing or "
    "the model has errors, 2 if it cannot be read, or the files cannot be written.",
)
@click.argument("file", type=click.Path())
@click.option(
    "--target",
    type=click.Choice(["nodl", "graph"]),
    required=True,
    help="nodl: a node description as NoDL 2. graph: the nodes and ends of a system, as a message "
    "rosgraph_msgs/msg/Graph.",
)
@click.option(
    "-o",
    "--output",
    type=click.Path(file_okay=False, path_type=Path),
    default=Path(),
    help="Folder to write to; created if it does not exist.  [default: the current folder]",
)
@interfaces_option
@click.pass_context
def export(
    ctx: click.Context, file: str, target: str, output: Path, interfaces: tuple[Path, ...]
) -> None:
    """Write the model in FILE in the format of another tool.

    A file that is there is replaced. What the format cannot say is listed with file and line.
    """
    from deros.pipeline.workspace import check_one

    loaded, findings = check_one(file, interfaces)
    show(findings)
    if code := exit_code(findings):
        ctx.exit(code)
    exports = {"nodl": _nodl, "graph": _graph}
    name, exported = exports[target](file, loaded)
    _write(name, exported.text, output)
    if exported.missing:
        say(f"not in {output / name}:")
    for missing in exported.missing:
        say(f"  {missing}")
    ctx.exit(FINDINGS if exported.missing else CLEAN)


def _nodl(file: str, loaded: LoadedFile) -> tuple[str, Exported]:
    from deros.exporters.nodl import file_name, nodl
    from deros.metamodels.languages import ROSNODE
    from deros.models.node import NodeType

    if not isinstance(loaded.model, NodeType):
        raise wrong_language(file, ROSNODE)
    return file_name(loaded.model), nodl(loaded.model)


def _graph(file: str, loaded: LoadedFile) -> tuple[str, Exported]:
    from deros.exporters.graph_message import file_name, graph_message
    from deros.metamodels.languages import ROSSYSTEM
    from deros.models.system import System
    from deros.systems.flatten import flatten

    if not isinstance(loaded.model, System):
        raise wrong_language(file, ROSSYSTEM)
    flat = flatten(loaded.model)
    return file_name(flat), graph_message(flat)


def _write(name: str, text: str, output: Path) -> None:
    from deros.generators.api.protocol import File, Owner
    from deros.generators.output.writer import Outcome, WriteError, write

    try:
        with held():
            report = write({name: File(text, Owner.SHARED)}, output)
    except OSError as error:
        raise click.ClickException(f"cannot read {error.filename}: {error.strerror}") from error
    except WriteError as error:
        raise click.ClickException(str(error)) from error
    for path in report.of(Outcome.WRITTEN):
        say(f"wrote {output / path}")
