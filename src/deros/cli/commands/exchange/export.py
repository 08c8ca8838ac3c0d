"""``deros export``: write models in formats of other tools."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from deros.cli.findings import show, wrong_language
from deros.cli.options import interfaces_option, output_option
from deros.cli.streams import say
from deros.cli.systems import system_as_started
from deros.cli.writing import write_files
from deros.pipeline.outcome import CLEAN, FINDINGS, exit_code

if TYPE_CHECKING:
    from deros.exporters.results import Exported
    from deros.metamodels.load import LoadedFile


@click.command(
    epilog="Exit codes: 0 if the files say all that is in the model, 1 if something is missing or "
    "the model has errors, 2 if it cannot be read, or the files cannot be written.",
)
@click.argument("file", type=click.Path())
@click.argument("arguments", nargs=-1)
@click.option(
    "--target",
    type=click.Choice(["nodl", "graph"]),
    required=True,
    help="nodl: a node description as NoDL 2. graph: the nodes and ends of a system, as a message "
    "rosgraph_msgs/msg/Graph.",
)
@output_option
@interfaces_option
@click.pass_context
def export(
    ctx: click.Context,
    file: str,
    arguments: tuple[str, ...],
    target: str,
    output: Path,
    interfaces: tuple[Path, ...],
) -> None:
    """Write the model in FILE in the format of another tool.

    A file that is there is replaced. What the format cannot say is listed with file and line. A
    graph is that of the system started with these ARGUMENTS, each NAME:=VALUE, as for 'deros up'.
    """
    from deros.generators.api.protocol import File, Owner
    from deros.pipeline.workspace import check_one

    if arguments and target != "graph":
        raise click.UsageError(f"a node has no arguments like '{arguments[0]}'; a system has")
    loaded, findings = check_one(file, interfaces)
    show(findings)
    if code := exit_code(findings):
        ctx.exit(code)
    if target == "nodl":
        name, exported = _nodl(file, loaded)
    else:
        name, exported = _graph(ctx, file, loaded, arguments)
    write_files({name: File(exported.text, Owner.SHARED)}, output)
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


def _graph(
    ctx: click.Context, file: str, loaded: LoadedFile, arguments: Sequence[str]
) -> tuple[str, Exported]:
    from deros.exporters.graph_message import file_name, graph_message
    from deros.generators.system.script.standalone.start import Start
    from deros.metamodels.languages import ROSSYSTEM
    from deros.models.system import System
    from deros.systems.flatten import flatten

    if not isinstance(loaded.model, System):
        raise wrong_language(file, ROSSYSTEM)
    started, _ = system_as_started(ctx, loaded.model, Start(file, []), arguments)
    flat = flatten(started)
    return file_name(flat), graph_message(flat)
