"""``deros new``: start a model that checks clean."""

from __future__ import annotations

from pathlib import Path

import click

from deros.cli.interrupts import held
from deros.cli.scaffolds import KINDS, scaffold
from deros.cli.streams import say


@click.command()
@click.argument("kind", type=click.Choice(list(KINDS)))
@click.argument("name")
@click.option("--package", help="ROS package of its nodes.  [default: NAME in lower case]")
@click.option(
    "-o",
    "--output",
    type=click.Path(file_okay=False, path_type=Path),
    default=Path(),
    help="Folder to write to; created if it does not exist.  [default: the current folder]",
)
def new(kind: str, name: str, package: str | None, output: Path) -> None:
    """Start a new model called NAME that checks clean.

    A node is one file; a system comes with two nodes, rules with a system that they monitor. If one
    of the files exists already, nothing is written.
    """
    from deros.generators.api.protocol import File, Owner
    from deros.generators.output.writer import WriteError, write
    from deros.names.names import check_node_name, check_package_name

    package = package if package is not None else name.lower()
    for word, text, fault in (
        ("NAME", name, check_node_name(name)),
        ("package", package, check_package_name(package)),
    ):
        if fault is not None:
            raise click.UsageError(f"ROS 2 rejects '{text}' as {word}: it {fault}")
    texts = scaffold(kind, name, package)
    files = [output / path for path in texts]
    if there := [str(path) for path in files if path.exists() or path.is_symlink()]:
        raise click.UsageError(f"not overwriting {', '.join(there)}")
    try:
        with held():
            write({name: File(text, Owner.USER) for name, text in texts.items()}, output)
    except WriteError as error:
        raise click.ClickException(str(error)) from error
    for path in files:
        say(f"wrote {path}")
    say(f"next: deros check {files[0]}")
