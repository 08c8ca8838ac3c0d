"""``deros import``: write models of a robot that runs, or of what describes one."""

from __future__ import annotations

import sys
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from deros.cli.options import domain_option, interfaces_option, output_option, settling_option
from deros.cli.streams import say
from deros.cli.writing import file_errors, say_next, write_files
from deros.pipeline.outcome import CLEAN, FINDINGS, UNUSABLE

if TYPE_CHECKING:
    from deros.importers.readers import Kind, Request
    from deros.importers.results import Imported
    from deros.live.snapshots import Snapshot

_RECORDING = "recording"
"""The kind of files that ``--bag`` is for."""


@click.command(
    "import",
    epilog="Exit codes: 0 if the models say all that was seen, 1 if something is left out or "
    "yours differs, 2 if there is nothing to import or it cannot be written.",
)
@click.argument("files", nargs=-1, type=click.Path(path_type=Path))
@click.option("--live", is_flag=True, help="From the running graph of ROS 2.")
@click.option(
    "--bag",
    "bags",
    metavar="PATH",
    multiple=True,
    type=click.Path(path_type=Path),
    help="From a recording of rosbag2: its folder, or an .mcap or .db3 file; may be given several "
    "times.",
)
@click.option(
    "--as",
    "word",
    metavar="KIND",
    help="What FILES are, where neither name nor text tells. A wrong one lists all kinds.",
)
@output_option
@click.option("--name", help="Name of the system.  [default: that in FILES, or 'robot']")
@domain_option
@click.option(
    "--node",
    "pattern",
    metavar="PATTERN",
    default="*",
    help="With --live: only nodes whose full names match, as in '/left/*'.",
)
@settling_option("With --live: time for the graph to stay the same.")
@interfaces_option
@click.pass_context
def import_(
    ctx: click.Context,
    files: tuple[Path, ...],
    live: bool,
    bags: tuple[Path, ...],
    word: str | None,
    output: Path,
    name: str | None,
    domain: int | None,
    pattern: str,
    timeout: float,
    interfaces: tuple[Path, ...],
) -> None:
    """Write what runs, or what FILES describe, as models that check clean.

    A running graph is read until it stays the same for three seconds. Each file that is written has
    two parts: the next import keeps what you write in the upper one, and replaces the lower one.
    What you write above of something that is imported, a port or a node, counts in its place.

    A launch file in Python is run, by '--as launch-python' alone. Values of its arguments are given
    as NAME:=VALUE, beside FILES.
    """
    from deros.importers.readers import Request, UnreadableError
    from deros.interfaces.store import InterfaceStore
    from deros.names.names import check_identifier

    if bags:
        if word not in (None, _RECORDING):
            raise click.UsageError(f"--bag is for recordings, and --as says '{word}'")
        # FILES may be further recordings, as in `--bag first second`.
        files, word = (*bags, *files), _RECORDING
    files, values = _values(files)
    if live == bool(files):
        raise click.UsageError(
            "say what to import: FILES, --bag for a recording, or --live for the running graph"
        )
    if name is not None and (fault := check_identifier(name)):
        raise click.UsageError(f"'{name}' cannot be the name of a system: it {fault}")
    store = InterfaceStore(interfaces)
    request = Request(files, name, output, store.exists, store, values)
    if live and values:
        raise _useless(values)
    if live:
        seen = _seen(domain, pattern, timeout)
        if not seen.nodes:
            say(f"deros: no node was found within {timeout:g} s (see ROS_DOMAIN_ID)", to=sys.stderr)
            ctx.exit(UNUSABLE)
        imported = _from_graph(seen, request)
    else:
        kind = _kind(files, word)
        if values and not kind.runs:
            raise _useless(values)
        try:
            imported = kind.read(request)
        except UnreadableError as error:
            raise click.ClickException(str(error)) from error
    ctx.exit(_write(imported, output, live, interfaces))


def _values(said: Sequence[Path]) -> tuple[tuple[Path, ...], dict[str, str]]:
    """Return the files that are named, and the values of arguments beside them."""
    files, values = [], {}
    for each in said:
        name, mark, value = str(each).partition(":=")
        if mark and name.isidentifier():
            values[name] = value
        else:
            files.append(each)
    return tuple(files), values


def _useless(values: Mapping[str, str]) -> click.UsageError:
    return click.UsageError(f"values such as {next(iter(values))}:=… are for files in Python")


def _kind(files: Sequence[Path], word: str | None) -> Kind:
    """Return the kind of files, which they have to share."""
    from deros.importers.kinds import KINDS, kinds_of

    known = "\n".join(f"  {kind.word}: {kind.what}" for kind in KINDS)
    if word is not None:
        named = next((kind for kind in KINDS if kind.word == word), None)
        if named is None:
            raise click.UsageError(f"'{word}' is no kind of files; these are:\n{known}")
        return named
    found = list(kinds_of(files))
    for file, kind in zip(files, found, strict=True):
        if kind is None and not file.exists():
            raise click.ClickException(f"cannot read '{file}': there is no such file")
        if kind is None:
            raise click.UsageError(
                f"what {file} is does not show: say it with --as KIND, one of\n{known}"
            )
        if kind.runs:
            raise click.UsageError(
                f"{file} is {kind.what} when it is imported: say --as {kind.word} if that is wanted"
            )
        if kind is not found[0]:
            raise click.UsageError(
                f"{files[0]} and {file} are of different kinds: import one after the other"
            )
    assert found[0] is not None
    return found[0]


def _from_graph(seen: Snapshot, request: Request) -> Imported:
    from deros.importers.node_types import imported
    from deros.importers.results import Imported
    from deros.importers.texts import files

    graph = imported(seen, request.is_known)
    return Imported(files(graph, request.name or "robot"), graph.problems)


def _seen(domain: int | None, pattern: str, timeout: float) -> Snapshot:
    from deros.live.looks import UnsteadyGraphError, snapshot
    from deros.live.observer import Observer, RosUnavailableError

    try:
        with Observer(domain) as observer:
            return snapshot(observer, pattern, timeout)
    except (RosUnavailableError, UnsteadyGraphError) as error:
        raise click.ClickException(str(error)) from error


def _write(imported: Imported, output: Path, live: bool, interfaces: Sequence[Path]) -> int:
    """Write the models, and the definitions they need; return the exit code."""
    from deros.generators.api.protocol import File
    from deros.generators.output.writer import Outcome
    from deros.importers.kept.files import ASIDE, renewed
    from deros.importers.results import INTERFACES

    with file_errors():
        new = renewed(imported.files, output)
    definitions = {path: File(text) for path, text in imported.interfaces.items()}
    report = write_files({**new.files, **definitions}, output)
    for path in new.edited:
        say(
            f"kept {output / path}: what was imported was edited there; compare it with "
            f"{path}{ASIDE}"
        )
    for path in report.of(Outcome.HAND_EDITED):
        say(f"kept {output / path}: it was edited, or is not from an import")
    for path in _no_longer_seen(output, imported.files) if live else ():
        say(f"kept {output / path}: no node of this type runs now")
    if new.otherwise:
        say("what you wrote counts, and the import has:")
    for each in new.otherwise:
        say(f"  {each}")
    if imported.missing:
        say("not in the models:")
    for missing in imported.missing:
        say(f"  {missing}")
    folders = [*interfaces, *([output / INTERFACES] if imported.interfaces else ())]
    say_next(output / next(iter(imported.files)), folders)
    differs = imported.missing or new.otherwise or new.edited or report.of(Outcome.HAND_EDITED)
    return FINDINGS if differs else CLEAN


def _no_longer_seen(output: Path, parts: Collection[str]) -> list[str]:
    """Return the node descriptions that are there and not among the imported ones."""
    there = (f"nodes/{path.name}" for path in (output / "nodes").glob("*.rnd"))
    return sorted(path for path in there if path not in parts)
