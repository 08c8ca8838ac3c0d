"""Node descriptions to an ament_python package."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from deros import codes
from deros.diagnostics import report
from deros.generators.api.protocol import Context, File, Files, GenerationError, Options, Owner
from deros.generators.node.files import shared_files
from deros.generators.node.package import maintainer, nodes_beside, refuse_legacy, unsupported
from deros.generators.node.python.imports import base_imports, user_imports
from deros.generators.node.python.view import (
    ENDPOINTS,
    GOAL_THREADS,
    MANAGED_NODE,
    QOS_REPORT,
    PackageView,
    package_view,
)
from deros.generators.node.view import MAX_GOALS
from deros.generators.runtime.python.interface import python_runtime
from deros.generators.text.identifiers import python_identifier
from deros.generators.text.notice import licence, licensed_python, notice
from deros.generators.text.python import call, expression, mark_long_lines, wrapped
from deros.generators.text.reserved_names import hidden_from_python
from deros.generators.text.templates import environment
from deros.interfaces.store import InterfaceStore
from deros.models.node import NodeType
from deros.models.qos import DEFAULT

_EXECUTION = (
    "It runs in a thread of its own. Return soon when goal_handle.is_active is false, because the "
    "node ends, or goal_handle.is_cancel_requested is true."
)
"""The notes on every function that executes goals."""


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
            ``licence`` as an SPDX identifier; ``runtime``.
        raw: the names of the nodes whose subscriptions hand over serialized messages. Of such a
            node there is no user's module: the caller adds its class and its ``main``.
        needs: what the modules that the caller adds import, by the keys of rosdep.
        store: the interfaces that are known: no package of theirs may be hidden.

    Raises:
        GenerationError: if names collide, or a construct has no counterpart in rclpy.
        OptionError: if an option cannot be read.
    """
    ordered = tuple(sorted(models, key=lambda model: model.name))
    for model in ordered:
        _check_supported(model)
    copyright_line = notice(options)
    runtime = python_runtime(ordered[0].package, options, copyright_line)
    package = package_view(
        ordered, maintainer(options), copyright_line, licence(options), raw, needs, runtime.version
    )
    modules = [(each.module, ordered[0].package_span) for each in package.custom]
    hidden = list(hidden_from_python(ordered, package.dependencies, modules, store))
    if hidden:
        raise GenerationError(hidden)
    files = _package_level(package)
    root = f"{package.name}/{package.name}"
    for node in package.nodes:
        needed = base_imports(package.name, node, runtime.module)
        base = _module("base.py", package, node=node, imports=needed)
        files[f"{root}/{node.base_module}.py"] = File(base)
        if not node.raw:
            imports = user_imports(package, node)
            user = _module("node.py", package, node=node, imports=imports)
            files[f"{root}/{node.module}.py"] = File(user, Owner.USER)
    for model in ordered:
        files |= shared_files(model, copyright_line)
    for each in package.custom:
        text = _module("custom.py", package, custom=each)
        files[f"{root}/{each.module}.py"] = File(text, Owner.USER)
    shared = {GOAL_THREADS for node in package.nodes if node.actions}
    shared |= {MANAGED_NODE for node in package.nodes if node.lifecycle}
    if any(node.reports_qos for node in package.nodes):
        shared |= {ENDPOINTS, QOS_REPORT}
    return files | runtime.files(package.name, sorted(shared))


def _package_level(package: PackageView) -> dict[str, File]:
    templates = {
        "setup.py": "setup.py",
        "test/test_flake8.py": "test_flake8.py",
        "test/test_pep257.py": "test_pep257.py",
    }
    if package.checks_copyright:
        templates["test/test_copyright.py"] = "test_copyright.py"
    files = {
        f"{package.name}/{path}": File(_module(template, package))
        for path, template in templates.items()
    }
    files[f"{package.name}/setup.cfg"] = File(_render("setup.cfg", package=package))
    manifest = _render("package.xml", package=package)
    files[f"{package.name}/package.xml"] = File(manifest, Owner.USER)
    files[f"{package.name}/resource/{package.name}"] = File("")
    init = _module("__init__.py", package)
    files[f"{package.name}/{package.name}/__init__.py"] = File(init)
    return files


def _module(template: str, package: PackageView, **names: object) -> str:
    """Return a module, with the notice of the package above it."""
    text = _render(template, package=package, **names)
    return mark_long_lines(licensed_python(text, package.copyright))


def _render(template: str, **names: object) -> str:
    loaded = environment("deros.generators.node.python").get_template(f"{template}.j2")
    return loaded.render(
        names,
        call=call,
        expression=expression,
        default_depth=str(DEFAULT.depth),
        max_goals=MAX_GOALS,
        execution=wrapped(_EXECUTION, indent=8),
    )


# Unsupported constructs ---------------------------------------------------------------------------


def _check_supported(model: NodeType) -> None:
    found = unsupported(model)
    if python_identifier(model.package) != model.package:
        message = f"package name {model.package!r} is not a Python module name"
        found.insert(0, report(codes.UNSUPPORTED_BY_TARGET, message, model.package_span))
    if found:
        raise GenerationError(found)
