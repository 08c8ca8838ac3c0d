"""The script: the table of a system's nodes, and the code that runs them."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace

from deros.generators.api.protocol import Context, File, Files, GenerationError, Options
from deros.generators.system.composition import composes
from deros.generators.system.computed import Computed, Text, joined, plain_settings
from deros.generators.system.empty_parts import may_be_empty, without_empty_parts
from deros.generators.system.expressions import (
    python_choice,
    python_condition,
    python_expression,
    python_value,
    relative_folder,
)
from deros.generators.system.files import FileView, copies
from deros.generators.system.launched import LaunchView, is_launch_file
from deros.generators.system.literals import comment, listed, python_literal
from deros.generators.system.programs import InsideView
from deros.generators.system.script.assemble import module_names, runtime
from deros.generators.system.script.standalone.arguments import Argument
from deros.generators.system.script.standalone.launching import Launch
from deros.generators.system.script.standalone.made.files import MadeFiles
from deros.generators.system.script.standalone.made.xacro import DescribedNode, Xacro
from deros.generators.system.script.standalone.node import Inside, Node, Program, Ready, Row
from deros.generators.system.view import (
    NodeView,
    ProcessView,
    ProgramView,
    SystemView,
    snake_case,
    system_view,
)
from deros.generators.system.waiting.wait_view import WaitView
from deros.generators.text.python import LINE_LENGTH, mark_long_lines
from deros.generators.text.reserved_names import hidden_by_script
from deros.generators.text.templates import environment
from deros.models.arguments import Argument as ArgumentUse
from deros.models.arguments import (
    Chosen,
    Condition,
    Expression,
    Interpolation,
    Literally,
    Lookup,
)
from deros.models.common import Scalar, Value
from deros.models.node import Parameter, ParameterType
from deros.models.system import System
from deros.systems.arguments.evaluate import CannotEvaluate, Values, evaluate
from deros.systems.arguments.resolve import resolved
from deros.systems.running.placement import placed

_TYPES: dict[ParameterType, type[bool] | type[int] | type[float] | type[str]] = {
    ParameterType.BOOL: bool,
    ParameterType.INTEGER: int,
    ParameterType.DOUBLE: float,
    ParameterType.STRING: str,
}


def generate(model: System, context: Context, options: Options) -> Files:  # noqa: ARG001
    """Return the script, and copies of the parameter files that it names.

    Raises:
        GenerationError: if a node cannot be started as the model says, or the file would hide a
            module that it needs.
    """
    stem = snake_case(model.name)
    if faults := [*hidden_by_script(stem, model.name_span, context.store)]:
        raise GenerationError(faults)
    return script_files(model)


def script_files(model: System) -> Files:
    """Return the script, first, and copies of the parameter files that it names.

    Raises:
        GenerationError: if a node cannot be started as the model says.
    """
    view = without_empty_parts(system_view(placed(model), everywhere=model))
    beside = copies(model, view)
    return {f"{view.stem}.py": File(render(view, tuple(beside)), executable=True), **beside}


def render(view: SystemView, files: tuple[str, ...] = ()) -> str:
    """Return the script's text, given the paths of the files that go with it."""
    written = _Written(view)
    made = environment("deros.generators.system.script")
    made.filters["python"] = written.python
    made.filters["word"], made.filters["words"] = written.word_filters(view)
    made.filters["launch_text"] = written.launch_text(view)
    made.filters["comment"] = comment
    made.tests["launch_file"] = is_launch_file
    made.filters["rule"] = rule
    made.filters["condition"] = written.condition
    made.filters["list_of"] = _choices
    made.filters["path"] = written.path
    launches = any(view.launches)
    parts = module_names(
        bool(view.arguments),
        view.looks_up,
        view.brings_up,
        composes(view),
        launches,
        view.describes,
        view.makes_files,
        bool(view.hosts),
        bool(view.waits),
    )
    text = made.get_template("script.py.j2").render(
        system=view,
        composes=composes(view),
        files=files,
        supervisor=_supervisor(view),
        runtime=runtime(parts),
        parts_before=parts.index("command_line"),
        arguments=[
            (row, written.default(each))
            for row, each in zip(declared(view), view.arguments, strict=True)
        ],
    )
    return mark_long_lines(text)


def _supervisor(view: SystemView) -> str:
    """Return the rest of the arguments of the script's main function."""
    name = "ManagingSupervisor" if view.brings_up else ""
    if composes(view):
        name = "ComposingSupervisor"
    if view.waits:
        name = f"waiting({name})" if name else "GraphWaits"
    return f", supervisor={name}" if name else ""


class _Written:
    """Writes values and conditions as Python text."""

    def __init__(self, view: SystemView) -> None:
        self._folder = view.folder
        self._made = dict(view.made)
        self._given = self.launch_text(view)

    def python(self, value: object, column: int = 0, indent: int = 0, after: int = 1) -> str:
        """Return a value as Python text, computed where it is computed."""
        if isinstance(value, Computed):
            return python_value(value, self._named)
        if isinstance(value, tuple) and any(isinstance(each, Computed) for each in value):
            return f"[{', '.join(map(self.python, value))}]"
        return python_literal(value, column, indent, after)  # type: ignore[arg-type]

    def word_filters(self, view: SystemView) -> tuple[Callable[..., str], Callable[..., str]]:
        """Return the filters for a text that a program is started with, and for several."""
        texts = {each.name for each in view.arguments if each.type is ParameterType.STRING}

        def word(value: Text, column: int, indent: int) -> str:
            if isinstance(value, str):
                return python_literal(value, column, indent)
            (first, *others) = value.pieces
            is_text = others or isinstance(first, str | Interpolation | Lookup)
            is_text = is_text or (isinstance(first, ArgumentUse) and first.name in texts)
            return self.python(value) if is_text else f"str({self.python(value)})"

        def words(value: tuple[Text, ...], column: int, indent: int) -> str:
            if all(isinstance(each, str) for each in value):
                return python_literal(value, column, indent)  # type: ignore[arg-type]
            return listed((word(each, indent + 4, indent + 4) for each in value), indent)

        return word, words

    def launch_text(self, view: SystemView) -> Callable[..., str]:
        """Return the filter for the value of a launch argument, which is a text."""
        truths = {each.name for each in view.arguments if each.type is ParameterType.BOOL}
        word, _ = self.word_filters(view)

        def is_truth(found: str | Expression) -> bool:
            if isinstance(found, Chosen):
                return is_truth(found.chosen)
            if isinstance(found, Literally):
                return isinstance(found.value, bool)
            return isinstance(found, ArgumentUse) and found.name in truths

        def text(value: Text, column: int, indent: int) -> str:
            if isinstance(value, Computed) and len(value.pieces) == 1:
                (use,) = value.pieces
                if is_truth(use):
                    return f"str({self.python(value)}).lower()"
            return word(value, column, indent)

        return text

    def path(self, file: FileView, column: int = 0, indent: int = 0) -> str:
        """Return the path of a parameter file as the script finds it."""
        if not file.is_made:
            return self._path(file, column, indent)
        path = self._path(file)
        if file.given is not None:
            given = ", ".join(f"{name!r}: {self._given(v, 0, 0)}" for name, v in file.given)
            path = f"MADE.substituted({path}, {{{given}}})"
        if file.plain is not None:
            return f"MADE.plain({path}{file.plain and f', {file.plain!r}'})"
        return path if file.below is None else f"MADE.below({path}, {self.python(file.below)})"

    def _path(self, file: FileView, column: int = 0, indent: int = 0) -> str:
        path = file.path
        if file.package is not None:
            path = joined("share:", file.package, "/", path)
        if isinstance(path, str):
            return self.python(path, column, indent)
        text = self.python(path)
        return f"os.path.join({file.folder!r}, {text})" if file.folder else text

    def condition(self, found: Condition) -> str:
        return python_condition(found, self._named)

    def default(self, argument: Parameter) -> str | None:
        """Return the text of the function that computes the default of an argument, if any."""
        if argument.default_from is None:
            return None
        text = self.python(Computed((argument.default_from,), argument.type))
        return f"lambda given, start: {text}"

    def _named(self, found: ArgumentUse | Lookup | Chosen) -> str:
        if isinstance(found, ArgumentUse):
            return f"given.{found.name}"
        if isinstance(found, Chosen):
            return python_choice(found, self._named)
        if found.made is not None:
            made = self._made[found]
            given = ", ".join(f"{name!r}: {self._given(v, 0, 0)}" for name, v in made.arguments)
            return f"MADE.xacro({self._path(made.file)}, {{{given}}})"
        if found.function == "this_dir":
            folder = relative_folder(found, self._folder)
            return "start.this_dir" if folder is None else f"start.this_dir + {'/' + folder!r}"
        if found.name_from is not None:
            return f"start.share({python_expression(found.name_from, self._named)})"
        default = "" if found.default is None else f", {found.default!r}"
        return f"start.{found.function}({found.name!r}{default})"


def _choices(values: tuple[Scalar, ...]) -> str:
    return f"({', '.join(map(python_literal, values))}{',' * (len(values) == 1)})"


def declared(view: SystemView) -> tuple[Argument, ...]:
    """Return the arguments of the system, as the script reads them."""
    in_names, in_namespaces = view.arguments_in_names, view.arguments_in_namespaces
    empty = may_be_empty(view.arguments) & (in_names | in_namespaces)
    return tuple(
        Argument(
            each.name,
            _TYPES[each.type],
            _scalar(each.default),
            choices=each.choices or (),
            interval="" if each.interval is None else each.interval.spelled(_bound),
            least_size=each.least_size,
            most_size=min(
                (size for size in (each.size, each.max_size) if size is not None), default=None
            ),
            in_names=each.name in in_names,
            in_namespaces=each.name in in_namespaces,
            may_be_empty=each.name in empty,
            unit=each.unit or "",
            description=" ".join(each.description.split()),
            default_text="" if each.default_from is None else each.default_from.span.text,
        )
        for each in view.arguments
    )


def declared_to_run(view: SystemView, looked_up: Values) -> tuple[Argument, ...]:
    """Return the arguments of a system that is run without its script.

    Args:
        view: of the system.
        looked_up: what its computed defaults look up, by key.
    """

    def computed(found: Expression, given: SimpleNamespace) -> Scalar:
        try:
            return evaluate(found, {**vars(given), **looked_up})
        except CannotEvaluate as fault:
            raise ValueError(fault.message) from None

    return tuple(
        row
        if each.default_from is None
        else replace(row, default=functools.partial(computed, each.default_from))
        for row, each in zip(declared(view), view.arguments, strict=True)
    )


def system_to_run(system: System, given: SimpleNamespace, looked_up: Values) -> System:
    """Return a system for the values of its arguments and what it looks up.

    Raises:
        ValueError: if something in it has no value then.
    """
    found, faults = resolved(system, {**vars(given), **looked_up})
    for fault in faults:
        raise ValueError(f"'{fault.span.text}': {fault.message}")
    return found


def _scalar(value: Value | None) -> Scalar | None:
    assert not isinstance(value, tuple)
    return value


def _bound(value: float) -> str:
    return str(int(value)) if math.isfinite(value) and value == int(value) else repr(value)


def table(view: SystemView, made: MadeFiles | None = None) -> tuple[Row, ...]:
    """Return the rows that the script's table holds, for running them without the script.

    Args:
        view: of a system without arguments, or for certain values of them.
        made: gets the files that are to be made for them.
    """
    files = made or MadeFiles()
    return tuple(_row(each, group.path, files) for group in view.groups for each in group.programs)


def _row(program: ProgramView, path: tuple[str, ...], made: MadeFiles) -> Row:
    if isinstance(program, NodeView):
        return _node(program, path, made)
    if isinstance(program, ProcessView):
        return _program(program, path, made)
    return _launch(program, path, made)


def _node(node: NodeView, path: tuple[str, ...], files: MadeFiles) -> Node:
    made = {
        name: Xacro(_original(each.file), {n: _plain(value) for n, value in each.arguments})
        for name, each in node.described
    }
    kind = functools.partial(DescribedNode, xacro=made) if made else Node
    return kind(
        name=node.name,
        namespace=_plain(node.namespace),
        package=node.package,
        executable=node.executable,
        arguments=tuple(map(_plain, node.arguments)),
        subsystem="/".join(path),
        parameters=dict(node.plain_parameters),
        remappings={_plain(name): _plain(target) for name, target in node.remappings},
        log_level=node.log_level,
        environment={name: _plain(value) for name, value in node.environment},
        prefix="" if node.prefix is None else _plain(node.prefix),
        respawn_delay=node.respawn_delay,
        respawn_max=node.respawn_max,
        autostart=node.autostart.timeout_s if node.autostart else None,
        optional=node.autostart is not None and node.autostart.is_optional,
        files=tuple(_read(each, files) for each in node.files),
        container="" if node.container is None else _plain(node.container),
        plugin=node.plugin,
        intra_process=node.intra_process,
        delay=node.starting.delay_s,
        after=node.starting.awaited,
        stops_all=node.starting.stops_all is not None,
        own_name=node.own_name,
        inside=tuple(map(_inside, node.inside)),
        ready=_ready(node.wait),
    )


def _inside(node: InsideView) -> Inside:
    return Inside(
        node.name,
        _plain(node.namespace),
        dict(plain_settings(node.parameters)),
        {_plain(name): _plain(target) for name, target in node.remappings},
    )


def _program(process: ProcessView, path: tuple[str, ...], files: MadeFiles) -> Program:
    return Program(
        name=process.name,
        program=_plain(process.program),
        arguments=tuple(map(_plain, process.arguments)),
        subsystem="/".join(path),
        environment={name: _plain(value) for name, value in process.environment},
        prefix="" if process.prefix is None else _plain(process.prefix),
        folder="" if process.folder is None else _plain(process.folder),
        respawn_delay=process.respawn_delay,
        respawn_max=process.respawn_max,
        delay=process.starting.delay_s,
        after=process.starting.awaited,
        stops_all=process.starting.stops_all is not None,
        inside=tuple(map(_inside, process.inside)),
        files=tuple(_read(each, files) for each in process.files),
        ready=_ready(process.wait),
    )


def _ready(wait: WaitView | None) -> Ready | None:
    return None if wait is None else Ready(wait.ready.kind, _plain(wait.name), wait.ready.timeout_s)


def _launch(launch: LaunchView, path: tuple[str, ...], files: MadeFiles) -> Launch:
    return Launch(
        name=launch.name,
        file=_original(launch.file),
        launch_arguments={name: _plain(value) for name, value in launch.launch_arguments},
        subsystem="/".join(path),
        namespace=_plain(launch.namespace),
        environment={name: _plain(value) for name, value in launch.environment},
        parameters=dict(plain_settings(launch.parameters)),
        parameter_files=tuple(_read(each, files) for each in launch.files),
        remappings={_plain(name): _plain(target) for name, target in launch.remappings},
    )


def _read(file: FileView, made: MadeFiles) -> str:
    """Return where a parameter file is once the system is started."""
    path = _original(file)
    if file.given is not None:
        path = made.substituted(path, {name: _plain(value) for name, value in file.given})
    if file.plain is not None:
        return made.plain(path, file.plain)
    return path if file.below is None else made.below(path, _plain(file.below))


def _original(file: FileView) -> str:
    """Return where a parameter file itself is, for running a system without generated files."""
    path = _plain(file.path)
    if file.package is not None:
        return f"share:{_plain(file.package)}/{path}"
    return file.original or path


def _plain(text: str | Computed) -> str:
    assert isinstance(text, str)
    return text


def rule(title: str) -> str:
    """Return the comment line above a part of a file."""
    return f"# {title} ".ljust(LINE_LENGTH, "-")
