"""Node descriptions to an ament_python package."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from importlib import resources

from deros import codes
from deros.diagnostics import report
from deros.generators.names import python_identifier
from deros.generators.node_package import maintainer, nodes_beside, refuse_legacy, unsupported
from deros.generators.notice import licence, notice
from deros.generators.protocol import Context, File, Files, GenerationError, Options, Owner
from deros.generators.python_source import call, expression, mark_long_lines, wrapped
from deros.generators.reserved_names import hidden_from_python
from deros.generators.rosnode_python.imports import base_imports, user_imports
from deros.generators.rosnode_python.view import (
    GOAL_THREADS,
    MANAGED_NODE,
    QOS_REPORT,
    PackageView,
    package_view,
)
from deros.generators.templates import environment
from deros.interfaces.store import InterfaceStore
from deros.metamodels.node import NodeType

_MAX_GOALS = 8
"""How many goals a node executes at the same time, unless its class says otherwise."""

_EXECUTION = (
    "It runs in a thread of its own. Return soon when goal_handle.is_active is false, because the "
    "node ends, or goal_handle.is_cancel_requested is true."
)
"""What holds for every function that executes goals."""


def generate(model: NodeType, context: Context, options: Options) -> Files:
    """Return the package of ``model``, with the other nodes of that package described beside it.

    A package is built as a whole: its setup.py names the program of every node. So the node
    descriptions of the same package in the same folder are always generated together.

    Raises:
        GenerationError: if the node, or one beside it, cannot be made.
    """
    refuse_legacy(model)
    return package_files([model, *nodes_beside(model, context)], options, store=context.store)


def package_files(
    models: Sequence[NodeType],
    options: Options,
    raw: Collection[str] = (),
    needs: Collection[str] = (),
    store: InterfaceStore | None = None,
) -> dict[str, File]:
    """Return the files of the package that ``models``, all of one package, make up.

    Args:
        models: one or more nodes; their order does not matter.
        options: ``maintainer`` as ``Name <address>``, ``copyright`` as years and holder, and
            ``licence`` as an SPDX identifier.
        raw: the names of the nodes whose subscriptions hand over serialized messages. Of such a
            node there is no user's module: the caller adds its class and its ``main``.
        needs: what the modules that the caller adds import, by the keys of rosdep.
        store: the interfaces that are known: no package of theirs may be hidden.

    Raises:
        GenerationError: if names collide, or a construct has no counterpart in rclpy.
        ValueError: if an option cannot be read.
    """
    ordered = tuple(sorted(models, key=lambda model: model.name))
    for model in ordered:
        _check_supported(model)
    copyright_line = notice(options)
    package = package_view(
        ordered, maintainer(options), copyright_line, licence(options), raw, needs
    )
    modules = [(each.module, ordered[0].package_span) for each in package.custom]
    hidden = list(hidden_from_python(ordered, package.dependencies, modules, store))
    if hidden:
        raise GenerationError(hidden)
    files = _package_level(package)
    root = f"{package.name}/{package.name}"
    for node in package.nodes:
        base = _render(
            "base.py", package=package, node=node, imports=base_imports(package.name, node)
        )
        files[f"{root}/{node.base_module}.py"] = File(base)
        if not node.raw:
            imports = user_imports(package, node)
            user = _render("node.py", package=package, node=node, imports=imports)
            files[f"{root}/{node.module}.py"] = File(user, Owner.USER)
        launch = _render("launch.py", package=package, node=node)
        files[f"{package.name}/launch/{node.name}.launch.py"] = File(launch)
        if node.parameters:
            config = _render("config.yaml", package=package, node=node)
            files[f"{package.name}/config/{node.name}.yaml"] = File(config)
    for each in package.custom:
        text = _render("custom.py", package=package, custom=each)
        files[f"{root}/{each.module}.py"] = File(text, Owner.USER)
    shared = {GOAL_THREADS for node in package.nodes if node.actions}
    shared |= {MANAGED_NODE for node in package.nodes if node.lifecycle}
    shared |= {QOS_REPORT for node in package.nodes if node.reports_qos}
    folder = resources.files("deros.generators.rosnode_python.runtime")
    for module in sorted(shared):
        text = (folder / f"{module}.py").read_text(encoding="utf-8")
        files[f"{root}/{module}.py"] = File(licensed(text, copyright_line))
    return files


def _package_level(package: PackageView) -> dict[str, File]:
    templates = {
        "setup.py": "setup.py",
        "setup.cfg": "setup.cfg",
        "test/test_flake8.py": "test_flake8.py",
        "test/test_pep257.py": "test_pep257.py",
    }
    if package.checks_copyright:
        templates["test/test_copyright.py"] = "test_copyright.py"
    files = {
        f"{package.name}/{path}": File(_render(template, package=package))
        for path, template in templates.items()
    }
    manifest = _render("package.xml", package=package)
    files[f"{package.name}/package.xml"] = File(manifest, Owner.USER)
    files[f"{package.name}/resource/{package.name}"] = File("")
    files[f"{package.name}/{package.name}/__init__.py"] = File("")
    return files


def licensed(text: str, copyright_line: str) -> str:
    """Put the licence header of a package's modules above a text, if there is a holder."""
    return _render("_header", package={"copyright": copyright_line}) + text


def _render(template: str, **names: object) -> str:
    loaded = environment("deros.generators.rosnode_python").get_template(f"{template}.j2")
    text = loaded.render(
        names,
        call=call,
        expression=expression,
        max_goals=_MAX_GOALS,
        execution=wrapped(_EXECUTION, indent=8),
    )
    return mark_long_lines(text) if template.endswith(".py") else text


# What the target refuses --------------------------------------------------------------------------


def _check_supported(model: NodeType) -> None:
    found = unsupported(model)
    if python_identifier(model.package) != model.package:
        message = f"package name {model.package!r} is no Python module name"
        found.insert(0, report(codes.UNSUPPORTED_BY_TARGET, message, model.package_span))
    if found:
        raise GenerationError(found)
