"""``deros run``: start the safety node of rules and its gates at once, without a package."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from deros.cli.findings import show, wrong_language
from deros.cli.options import FiniteRange, dry_run_option, interfaces_option, stop_timeout_option

_GRACE = "startup_grace"
"""The parameter of a safety node that says how long inputs may be late at the start."""

if TYPE_CHECKING:
    from collections.abc import Sequence

    from deros.generators.api.protocol import Files
    from deros.generators.system.script.standalone.node import Node, Value
    from deros.models.rules import Rules


@click.command(
    epilog="Exit codes: 0 if every node ended normally, by itself or on request; 130 if that was a "
    "Ctrl-C; 1 if the rules have errors, or a node failed or did not stop on request; 2 if nothing "
    "was started."
)
@click.argument("rules", type=click.Path())
@click.option(
    "--params-file",
    "params_files",
    multiple=True,
    metavar="FILE",
    type=click.Path(exists=True, dir_okay=False),
    help="Parameters of the nodes, tunable constants among them; may be given several times.",
)
@click.option(
    "--shadow",
    is_flag=True,
    help="Only watch: no gate is started, no action reaches the robot. What the rules find is "
    "reported, and the states of actions are below ~/shadow.",
)
@click.option(
    "--startup-grace",
    metavar="SECONDS",
    type=FiniteRange(min=0, max=86400),
    help="How long inputs may be late at the start, whatever parameter files say: until all have "
    "come, there is no heartbeat, so that gates stand.",
)
@dry_run_option
@stop_timeout_option
@click.option(
    "--log-dir",
    metavar="DIR",
    type=click.Path(file_okay=False),
    help="Write what each node says into DIR, too, as 'deros up' does.",
)
@interfaces_option
@click.pass_context
def run(
    ctx: click.Context,
    rules: str,
    params_files: tuple[str, ...],
    shadow: bool,
    startup_grace: float | None,
    dry_run: bool,
    stop_timeout: str,
    log_dir: str | None,
    interfaces: tuple[Path, ...],
) -> None:
    """Start the safety node of RULES and its gates; stop them on Ctrl-C.

    The rules are checked, and the package that 'deros generate --target python' writes is made in
    a cache and run from there: no workspace, no colcon. All actions have to say in the rules what
    they do.
    """
    from deros.generators.system.script.standalone.command import main
    from deros.systems.safety_nodes import is_gate

    words = ["--stop-timeout", stop_timeout, *(["--dry-run"] if dry_run else [])]
    words += [] if log_dir is None else ["--log-dir", log_dir]
    model, files = _generated(ctx, rules, interfaces)
    try:
        folder = _kept(files)
    except OSError as error:
        raise click.ClickException(f"the package cannot be kept: {error}") from error
    nodes = _nodes(files, params_files)
    if shadow:
        nodes = [_as_shadow(each, model) for each in nodes if not is_gate(each.name)]
    if startup_grace is not None:
        nodes = [_patient(each, startup_grace) for each in nodes]
    words += ["--package-path", str(folder)]
    ctx.exit(main(Path(rules).stem, nodes, words, f"deros run {rules}"))


def _generated(ctx: click.Context, rules: str, interfaces: tuple[Path, ...]) -> tuple[Rules, Files]:
    from deros.generators.api.protocol import Owner
    from deros.metamodels.languages import DEROS, language_of
    from deros.models.rules import Rules as RulesModel
    from deros.pipeline import generate as pipeline

    if language_of(rules) not in (DEROS, None):
        raise wrong_language(rules, DEROS)
    request = pipeline.Request(rules, "python", {"runtime": "copy"}, interfaces)
    try:
        generated = pipeline.generate(request)
    except pipeline.Refused as refused:
        show(refused.diagnostics)
        ctx.exit(refused.code)
    show(generated.findings)
    (model,) = generated.models
    assert isinstance(model, RulesModel)
    code = (each for path, each in generated.files.items() if path.endswith(".py"))
    if any(each.owner is Owner.USER for each in code):
        raise click.ClickException(_unbound(model, rules))
    return model, generated.files


def _unbound(rules: Rules, path: str) -> str:
    names = [f"'{each.name}'" for each in rules.actions if not (each.binding or each.service)]
    which = ", ".join(names) or "an action"
    return (
        f"the rules do not say what {which} does: write 'publishes' or 'calls', or write the code"
        f" in a package: deros generate {path} --target python"
    )


def _kept(files: Files) -> Path:
    from deros.pipeline.caches import caches
    from deros.pipeline.kept import kept

    place = caches()
    if place is None:
        raise click.ClickException("there is no home folder: set XDG_CACHE_HOME")
    return kept(files, place / "run")


def _nodes(files: Files, params_files: Sequence[str]) -> list[Node]:
    """Return the nodes of a package, the safety node first: each has a description."""
    from deros.generators.system.script.standalone.node import Node
    from deros.systems.safety_nodes import is_gate

    described = [Path(path) for path in files if path.endswith(".rnd")]
    return [
        Node(
            name=each.stem,
            namespace="/",
            package=each.parts[0],
            executable=each.stem,
            files=tuple(map(os.path.abspath, params_files)),
        )
        for each in sorted(described, key=lambda each: (is_gate(each.stem), each.stem))
    ]


def _patient(node: Node, startup_grace: float) -> Node:
    """Return a safety node that waits for its inputs; a gate as it is."""
    from deros.systems.safety_nodes import is_gate

    if is_gate(node.name):
        return node
    own = {**node.parameters, **_values(node.files, node.full_name), _GRACE: startup_grace}
    return replace(node, files=(), parameters=own)


def _as_shadow(node: Node, rules: Rules) -> Node:
    """Return the safety node under a name of its own, its actions where nobody listens."""
    shadow = replace(node, name=f"{node.name}_shadow")
    # Keys of parameter files are for the real name. The shadow keeps its latches apart, whatever
    # these say.
    given = _values(node.files, node.full_name, shadow.full_name)
    own = {**given, "state_file": ""}
    # A topic that the rules watch may have the name of a service that they call.
    acting = [("rostopic", each.binding.topic.text) for each in rules.actions if each.binding]
    acting += [("rosservice", each.service.service.text) for each in rules.actions if each.service]
    hidden = {
        f"{kind}://{name}": f"~/shadow/{name.removeprefix('~').lstrip('/')}"
        for kind, name in acting
    }
    return replace(shadow, files=(), remappings=hidden, parameters=own)


def _values(files: Sequence[str], full_name: str, alias: str = "") -> dict[str, Value]:
    """Return what parameter files set for a node; keys for its other name alone come last.

    Given with the files, a value of ours would give way to ``/**`` in them where their key of the
    node's full name comes before that.
    """
    from deros.diagnostics import SourceFile, Span
    from deros.metamodels.parameter_files.library import ParameterFiles
    from deros.models.parameter_files import Fault, Missing, ParameterFile
    from deros.systems.parameters.overrides import file_parameters, matches

    nowhere, load = Span(SourceFile("", ""), 0, 0), ParameterFiles().load
    statements = [ParameterFile(path, nowhere, nowhere, load) for path in files]
    for each in statements:
        match each.load():
            case Fault(message, span):
                place = f"{span.source.path}:{span.line}:{span.column}"
                raise click.ClickException(f"{place}: {message}")
            case Missing(path, reason):
                raise click.ClickException(reason or f"{path} is not there")
    found = file_parameters(statements, full_name, ()).settings
    if alias:
        others = file_parameters(statements, alias, ()).settings
        found += tuple(o for o in others if o.origin and not matches(o.origin.key, full_name))
    return {each.name: each.value for each in found}
