"""``deros new``: start a model that checks clean."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from deros.cli.findings import show, wrong_language
from deros.cli.options import interfaces_option, output_option
from deros.cli.scaffolds import KINDS, scaffold
from deros.cli.streams import say
from deros.cli.writing import say_next, write_files
from deros.diagnostics import Severity
from deros.names.names import check_topic_name
from deros.pipeline.outcome import FINDINGS

if TYPE_CHECKING:
    from deros.importers.first_rules import FirstRules


@click.command(
    epilog="With --from: exit code 1 if the system has errors; else 0, or 2 if nothing was written."
)
@click.argument("kind", type=click.Choice(list(KINDS)))
@click.argument("name")
@click.option("--package", help="ROS package of its nodes.  [default: NAME in lower case]")
@output_option
@click.option(
    "--from",
    "system",
    metavar="SYSTEM",
    type=click.Path(),
    help="For rules: the system to watch. Each topic of it that moves or senses something gets an "
    "input and a timeout.",
)
@click.option(
    "--gate",
    nargs=2,
    metavar="FROM TO",
    help="With --from: what is commanded on FROM reaches TO through a gate, which stops the robot.",
)
@interfaces_option
@click.pass_context
def new(
    ctx: click.Context,
    kind: str,
    name: str,
    package: str | None,
    output: Path,
    system: str | None,
    gate: tuple[str, str] | None,
    interfaces: tuple[Path, ...],
) -> None:
    """Start a new model called NAME that checks clean.

    A node is one file; a system comes with two nodes, rules with a system that they monitor, or
    with --from for one that there is. If one of the files exists already, nothing is written.
    """
    from deros.names.names import check_node_name, check_package_name

    own_package = package if package is not None else name.lower()
    for word, text, fault in (
        ("NAME", name, check_node_name(name)),
        ("package", own_package, check_package_name(own_package)),
    ):
        if fault is not None:
            raise click.UsageError(f"ROS 2 rejects '{text}' as {word}: it {fault}")
    if system is None:
        if gate is not None:
            raise click.UsageError("--gate is for rules --from a system")
        _write(scaffold(kind, name, own_package), output, interfaces)
        return
    if kind != "rules" or package is not None:
        raise click.UsageError("--from is for rules, which have no package of their own")
    found = _rules(ctx, name, system, os.path.relpath(system, output), gate, interfaces)
    _write({f"{name}.deros": found.text}, output, interfaces)
    if gate is not None:
        rules = Path(os.path.relpath(output / f"{name}.deros", Path(system).parent)).as_posix()
        say(f'the gate becomes a node of {system} with this line in it: safety "{rules}"')
    if found.left:
        say("no input for these, whose messages are not known to move or sense something:")
    for topic, interface in found.left:
        say(f"  {topic} : {interface.short}")


def _write(texts: Mapping[str, str], output: Path, interfaces: Sequence[Path]) -> None:
    """Write new files, the first one being the one to check."""
    from deros.generators.api.protocol import File, Owner

    files = [output / path for path in texts]
    if there := [str(path) for path in files if path.exists() or path.is_symlink()]:
        raise click.UsageError(f"not overwriting {', '.join(there)}")
    write_files({name: File(text, Owner.USER) for name, text in texts.items()}, output)
    say_next(files[0], interfaces)


def _rules(
    ctx: click.Context,
    name: str,
    system: str,
    used: str,
    gate: tuple[str, str] | None,
    interfaces: tuple[Path, ...],
) -> FirstRules:
    """Return the rules to start with for a system, which has no errors."""
    from deros.importers.first_rules import NoGateError, first_rules
    from deros.metamodels.keywords import keywords
    from deros.metamodels.languages import DEROS, ROSSYSTEM, language_of
    from deros.models.system import System
    from deros.pipeline.workspace import check_one
    from deros.rules.functions.functions import FUNCTIONS
    from deros.systems.arguments.resolve import resolve
    from deros.systems.flatten import flatten

    if language_of(system) not in (ROSSYSTEM, None):
        raise wrong_language(system, ROSSYSTEM)
    loaded, findings = check_one(system, interfaces)
    errors = [each for each in findings if each.severity is Severity.ERROR]
    if errors:
        show(errors)
        ctx.exit(FINDINGS)
    assert isinstance(loaded.model, System)
    taken = keywords(DEROS) | FUNCTIONS.keys()
    for topic in gate or ():
        if fault := check_topic_name(topic):
            raise click.UsageError(f"'{topic}' is no name of a topic: it {fault}")
    try:
        flat = flatten(resolve(loaded.model))
        return first_rules(flat, Path(used).as_posix(), name, taken, gate)
    except NoGateError as error:
        raise click.UsageError(str(error)) from error
