"""``deros graph``: show how the nodes of a system are connected."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from deros.cli.findings import show, wrong_language
from deros.cli.options import interfaces_option
from deros.cli.streams import say
from deros.pipeline.outcome import exit_code

if TYPE_CHECKING:
    from deros.diagnostics import Diagnostic
    from deros.models.system import System
    from deros.systems.flat import FlatNode, FlatSystem
    from deros.validators.wiring.graph import End, Vertex


@click.command()
@click.argument("file", type=click.Path())
@click.option(
    "--format",
    "form",
    type=click.Choice(["text", "mermaid", "dot", "html"]),
    default="text",
    show_default=True,
    help="Lines to read, a Mermaid flowchart, a Graphviz graph, or a page for the browser.",
)
@click.option(
    "--elkjs",
    metavar="FILE",
    type=click.Path(path_type=Path),
    help="The elk.bundled.js that lays the page out, in place of the installed one.",
)
@interfaces_option
@click.pass_context
def graph(
    ctx: click.Context, file: str, form: str, elkjs: Path | None, interfaces: tuple[Path, ...]
) -> None:
    """Show the wiring of the system in FILE: its topics, services and actions, and their ends.

    Ports that are not connected use their own names; their ends are marked, or dashed. Findings go
    to standard error. Errors fail the command, but the wiring is shown as far as it is known. The
    page is one file with all that it needs: deros graph --format html X.system > X.html
    """
    from deros.metamodels.languages import ROSSYSTEM
    from deros.models.system import System
    from deros.pipeline.workspace import check_one
    from deros.systems.flatten import flatten

    elk = _elkjs(elkjs) if form == "html" else ""
    loaded, findings = check_one(file, interfaces)
    show(findings)
    code = exit_code(findings)
    if isinstance(loaded.model, System) and form == "html":
        say(_page(loaded.model, findings, elk), end="")
    elif isinstance(loaded.model, System):
        wiring = Wiring(flatten(loaded.model))
        write: dict[str, Callable[[Wiring], Iterator[str]]] = {
            "text": as_text,
            "mermaid": as_mermaid,
            "dot": as_dot,
        }
        say("\n".join(write[form](wiring)))
    elif loaded.model is not None:
        raise wrong_language(file, ROSSYSTEM)
    ctx.exit(code)


def _elkjs(path: Path | None) -> str:
    from deros.report.page.elkjs import NoElkjs, read_elkjs

    try:
        return read_elkjs(path)
    except NoElkjs as fault:
        raise click.UsageError(str(fault)) from None


def _page(system: System, findings: Sequence[Diagnostic], elkjs: str) -> str:
    from deros.report.page.build import build
    from deros.report.page.render import render

    return render(build(system, findings), elkjs)


class Wiring:
    """The wiring graph of a system, ready to be written: its ends by channel, and short names."""

    def __init__(self, flat: FlatSystem) -> None:
        """Build the graph of ``flat``."""
        from deros.validators.wiring.graph import channels, node_vertex, wiring_graph

        self.name = flat.system.name
        self.nodes = flat.nodes
        self.graph = wiring_graph(flat)
        self.channels: list[Vertex] = sorted(channels(self.graph), key=lambda v: (v[1], v[0]))
        vertices = [*(node_vertex(node.full_name) for node in flat.nodes), *self.channels]
        self.ids = {vertex: f"{vertex[0][0]}{number}" for number, vertex in enumerate(vertices)}

    def ends(self, channel: Vertex) -> tuple[list[End], list[End]]:
        """Return the ends that feed a channel, and those that it feeds."""
        from deros.validators.wiring.graph import publishers, subscribers

        return publishers(self.graph, channel), subscribers(self.graph, channel)

    def types(self, channel: Vertex) -> str:
        """Return the type, or types, that the ends of a channel have."""
        sources, targets = self.ends(channel)
        topic = self.graph.nodes[channel].get("topic")
        pinned = topic.declaration.type if topic is not None else None
        found = [*([pinned] if pinned else []), *(end.type for end in (*sources, *targets))]
        return ", ".join(dict.fromkeys(each.short for each in found)) or "unknown type"

    def edges(self) -> Iterator[tuple[str, str, bool]]:
        """Yield from, to and whether a ``connect`` says so, by short names."""
        from deros.validators.wiring.graph import node_vertex

        for channel in self.channels:
            sources, targets = self.ends(channel)
            for end in sources:
                yield self.ids[node_vertex(end.node.full_name)], self.ids[channel], end.wired
            for end in targets:
                yield self.ids[channel], self.ids[node_vertex(end.node.full_name)], end.wired


def as_text(wiring: Wiring) -> Iterator[str]:
    """Write each channel with its ends, and the nodes that have none."""
    for channel in wiring.channels:
        kind, name = channel
        yield f"{kind} {name} : {wiring.types(channel)}{_external(wiring, channel)}"
        sources, targets = wiring.ends(channel)
        for word, ends in (("from", sources), ("to  ", targets)):
            for end in ends:
                yield f"  {word} {end.name}{'' if end.wired else ', not connected'}"
        for untyped in wiring.graph.nodes[channel].get("untyped", ()):
            yield f"  with {untyped.node.full_name} ({untyped.wiring.wiring.port}), type unknown"
    for node in wiring.nodes:
        if not node.ports and not node.untyped:
            yield f"node {node.full_name}, without ports"
        if node.instance.inside is not None:
            yield f"node {_label(node)}"


def as_mermaid(wiring: Wiring) -> Iterator[str]:
    """Write a Mermaid flowchart: boxes are nodes, rounded ones channels, frames subsystems."""
    yield "flowchart LR"
    yield from _grouped(wiring, wiring.nodes, 0, _MermaidShapes())
    for channel in wiring.channels:
        yield f'  {wiring.ids[channel]}(["{channel[1]}"])'
    for source, target, wired in wiring.edges():
        yield f"  {source} {'-->' if wired else '-.->'} {target}"


def as_dot(wiring: Wiring) -> Iterator[str]:
    """Write a Graphviz graph: boxes are nodes, ellipses channels, clusters subsystems."""
    yield f'digraph "{wiring.name}" {{'
    yield "  rankdir=LR;"
    yield "  node [shape=box];"
    yield from _grouped(wiring, wiring.nodes, 0, _DotShapes())
    for channel in wiring.channels:
        label = f"{channel[1]}\\n{wiring.types(channel)}"
        yield f'  {wiring.ids[channel]} [shape=ellipse, label="{label}"];'
    for source, target, wired in wiring.edges():
        yield f"  {source} -> {target}{'' if wired else ' [style=dashed]'};"
    yield "}"


def _label(node: FlatNode) -> str:
    """Return the name of a node, with the program in whose process it is."""
    inside = node.instance.inside
    return node.full_name + ("" if inside is None else f" (inside {inside.process})")


class _MermaidShapes:
    def node(self, identifier: str, node: FlatNode) -> str:
        return f'{identifier}["{_label(node)}"]'

    def opening(self, identifier: str, name: str) -> str:
        return f'subgraph {identifier}["{name}"]'

    def closing(self) -> str:
        return "end"


class _DotShapes:
    def node(self, identifier: str, node: FlatNode) -> str:
        return f'{identifier} [label="{_label(node)}"];'

    def opening(self, identifier: str, name: str) -> str:
        return f'subgraph cluster_{identifier} {{ label="{name}";'

    def closing(self) -> str:
        return "}"


def _grouped(
    wiring: Wiring, nodes: Sequence[FlatNode], depth: int, shapes: _MermaidShapes | _DotShapes
) -> Iterator[str]:
    """Write nodes, those of a subsystem within its frame; ``depth`` frames are open."""
    from deros.validators.wiring.graph import node_vertex

    margin = "  " * (depth + 1)
    for inside, members in itertools.groupby(nodes, key=lambda node: node.path[depth : depth + 1]):
        group = list(members)
        if not inside:
            for node in group:
                yield margin + shapes.node(wiring.ids[node_vertex(node.full_name)], node)
            continue
        first = wiring.ids[node_vertex(group[0].full_name)]
        yield margin + shapes.opening(f"s{depth}_{first}", inside[0])
        yield from _grouped(wiring, group, depth + 1, shapes)
        yield margin + shapes.closing()


def _external(wiring: Wiring, channel: Vertex) -> str:
    topic = wiring.graph.nodes[channel].get("topic")
    return ", external" if topic is not None and topic.declaration.external else ""
