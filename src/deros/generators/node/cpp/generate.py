"""Node descriptions to an ament_cmake package."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from deros import codes
from deros.diagnostics import report
from deros.generators.api.protocol import Context, File, Files, GenerationError, Options, Owner
from deros.generators.node.cpp.includes import base_header, base_source, user_header
from deros.generators.node.cpp.view import (
    NodeView,
    PackageView,
    Provided,
    custom_stem,
    package_view,
)
from deros.generators.node.files import shared_files
from deros.generators.node.package import maintainer, nodes_beside, refuse_legacy, unsupported
from deros.generators.node.view import MAX_GOALS
from deros.generators.runtime.cpp.interface import cpp_runtime
from deros.generators.text.cpp import (
    Text,
    arguments,
    call,
    comment,
    cpp_string,
    expression,
    include_lines,
    is_reserved,
    mark_long_lines,
    standard_headers,
    statement,
    tidied,
)
from deros.generators.text.notice import licence, licensed_cpp, notice
from deros.generators.text.reserved_names import hidden_from_cpp
from deros.generators.text.templates import environment
from deros.interfaces.store import InterfaceStore
from deros.models.node import NodeType
from deros.models.qos import DEFAULT


def generate(model: NodeType, context: Context, options: Options) -> Files:
    """Return the package of ``model``, with the other nodes of that package described beside it.

    A package is built as a whole: its CMakeLists.txt names the library and the program of every
    node. So the node descriptions of the same package in the same folder are always generated
    together.

    Raises:
        GenerationError: if the node, or one beside it, cannot be made.
    """
    refuse_legacy(model)
    return package_files([model, *nodes_beside(model, context)], options, store=context.store)


def package_files(
    models: Sequence[NodeType],
    options: Options,
    provided: Mapping[str, Provided] | None = None,
    store: InterfaceStore | None = None,
) -> dict[str, File]:
    """Return the files of the package that ``models``, all of one package, make up.

    Args:
        models: one or more nodes; their order does not matter.
        options: ``maintainer`` as ``Name <address>``, ``copyright`` as years and holder,
            ``licence`` as an SPDX identifier, and ``runtime``.
        provided: the nodes whose class the caller adds, by the name of the node type. Of such a
            node there is no user's file.
        store: the interfaces that are known: no package of theirs may be hidden.

    Raises:
        GenerationError: if names collide, or a construct has no counterpart in rclcpp.
        OptionError: if an option cannot be read.
    """
    ordered = tuple(sorted(models, key=lambda model: model.name))
    for model in ordered:
        _check_supported(model)
    holder = notice(options)
    runtime = cpp_runtime(ordered[0].package, options)
    package = package_view(
        ordered, maintainer(options), holder, licence(options), provided or {}, runtime
    )
    scopes = [
        (function.text.partition("::")[0], function.span)
        for model in ordered
        for parameter in model.parameters
        for function in parameter.custom
    ]
    hidden = list(hidden_from_cpp(ordered, package.libraries, scopes, store))
    if hidden:
        raise GenerationError(hidden)
    root = package.name
    files = {
        f"{root}/package.xml": File(_render("package.xml", package=package), Owner.USER),
        f"{root}/CMakeLists.txt": File(_render("CMakeLists.txt", package=package)),
    }
    for node in package.nodes:
        files |= _node_files(package, node)
    files |= _custom_files(package)
    for model in ordered:
        files |= shared_files(model, holder)
    shared = sorted({part for node in package.nodes for part in node.runtime_parts})
    return files | runtime.files(shared, holder)


def _custom_files(package: PackageView) -> dict[str, File]:
    """Return headers and sources of the user's functions that check parameters."""
    scopes: dict[str, dict[str, None]] = {}
    for node in package.nodes:
        for scope, functions in node.custom:
            scopes.setdefault(scope, {}).update(dict.fromkeys(functions))
    files: dict[str, File] = {}
    for scope, names_of_functions in scopes.items():
        stem = custom_stem(scope)
        names: dict[str, object] = {
            "package": package,
            "scope": scope,
            "stem": stem,
            "functions": tuple(names_of_functions),
            "guard": f"{package.name}__{stem}_hpp_".upper(),
        }
        header = mark_long_lines(licensed_cpp(_render("custom.hpp", **names), package.copyright))
        files[f"{package.name}/include/{package.name}/{stem}.hpp"] = File(header)
        source = mark_long_lines(licensed_cpp(_render("custom.cpp", **names), package.copyright))
        files[f"{package.name}/src/{stem}.cpp"] = File(source, Owner.USER)
    return files


def _node_files(package: PackageView, node: NodeView) -> dict[str, File]:
    root, include = package.name, f"{package.name}/include/{package.name}"
    header = _cpp("base.hpp", package, node, base_header(node))
    source = _cpp("base.cpp", package, node, base_source(package.name, node))
    files = {
        f"{include}/{node.stem}_base.hpp": File(header),
        f"{root}/src/{node.stem}_base.cpp": File(source),
    }
    if not (node.provided and node.provided.main):
        files[f"{root}/src/{node.stem}_main.cpp"] = File(_cpp("main.cpp", package, node, ()))
    if node.provided is None:
        header = _cpp("node.hpp", package, node, user_header(package.name, node))
        source = _cpp("node.cpp", package, node, ())
        files[f"{include}/{node.stem}.hpp"] = File(header, Owner.USER)
        files[f"{root}/src/{node.stem}.cpp"] = File(source, Owner.USER)
    return files


# Texts --------------------------------------------------------------------------------------------


def _cpp(template: str, package: PackageView, node: NodeView, headers: Sequence[str]) -> str:
    """Return a C++ file, which includes ``headers`` and what it uses of the standard library."""
    suffix = "_base" if template == "base.hpp" else ""
    names = {
        "package": package,
        "node": node,
        "guard": f"{package.name}__{node.stem}{suffix}_hpp_".upper(),
        "includes": include_lines(headers),
    }
    bare = _render(template, standard=[], **names)
    text = _render(template, standard=standard_headers(bare), **names)
    return mark_long_lines(tidied(licensed_cpp(text, package.copyright)))


def _render(template: str, **names: object) -> str:
    loaded = environment("deros.generators.node.cpp").get_template(f"{template}.j2")
    return loaded.render(
        names,
        arguments=arguments,
        call=call,
        comment=comment,
        expression=expression,
        default_depth=str(DEFAULT.depth),
        max_goals=MAX_GOALS,
        pursue=_pursue,
        statement=statement,
        string=cpp_string,
        text=Text,
    )


def _pursue(action: str) -> str:
    """Return the description of the function that executes the goals of an action."""
    return (
        f"Execute a goal of {action}, in a thread of its own: succeed, abort or cancel it. Return "
        "soon when is_executing() is false: a cancel was accepted, or the node ends."
    )


# Unsupported constructs ---------------------------------------------------------------------------


def _check_supported(model: NodeType) -> None:
    found = unsupported(model)
    if is_reserved(model.package) or model.package in ("std", "posix"):
        message = f"package name {model.package!r} is not a C++ namespace"
        found.insert(0, report(codes.UNSUPPORTED_BY_TARGET, message, model.package_span))
    if found:
        raise GenerationError(found)
