"""What ``launch`` and ``launch_ros`` do with the launch files of systems with arguments.

Written after their documentation and text (branch ``jazzy``); each class accepts only what the
generator writes. Where the real ones can be imported, a test holds these against them.
"""

# ruff: noqa: ARG002, D101, D102 - the names are those of launch, and so is what they do

from __future__ import annotations

import importlib
import itertools
import math
import os
import shlex
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from types import ModuleType, SimpleNamespace
from typing import Any, get_args

import yaml

from deros.metamodels.parameter_files.scalars import value_of
from deros.names.graph_names import resolve_name

HERE = "/folder/of/the/launch/file"


@dataclass(frozen=True)
class Context:
    """The values of the launch configurations, the folder of the launch file, and a namespace.

    This is the one that the file is included in.
    """

    values: Mapping[str, str]
    folder: str = HERE
    namespace: str = "/"
    handlers: list[OnShutdown] = field(default_factory=list, compare=False)

    @property
    def environment(self) -> Mapping[str, str]:
        return os.environ

    def register_event_handler(self, handler: OnShutdown) -> None:
        self.handlers.append(handler)

    @property
    def launch_configurations(self) -> dict[str, str]:
        """Those that actions of launch_ros set."""
        return {} if self.namespace == "/" else {"ros_namespace": self.namespace}

    def get_locals_as_dict(self) -> dict[str, str]:
        return {"current_launch_file_directory": self.folder}

    def extend_locals(self, known: Mapping[str, str]) -> None:
        assert known == self.get_locals_as_dict()


@dataclass(frozen=True, kw_only=True)
class OnShutdown:
    on_shutdown: Callable[[object, Context], None]


class Substitution:
    """Becomes a text when the file is launched."""

    def perform(self, context: Context) -> str:
        raise NotImplementedError


Text = str | Substitution | Sequence[str | Substitution]


def performed(found: Text, context: Context) -> str:
    """Return the text of a substitution, or of several in a row."""
    if isinstance(found, str):
        return found
    if isinstance(found, Substitution):
        return found.perform(context)
    return "".join(performed(each, context) for each in found)


@dataclass(frozen=True)
class LaunchConfiguration(Substitution):
    name: str

    def perform(self, context: Context) -> str:
        return context.values[self.name]


@dataclass(frozen=True)
class EnvironmentVariable(Substitution):
    name: str
    default_value: str | None = None

    def perform(self, context: Context) -> str:
        value = os.environ.get(self.name, self.default_value)
        if value is None:
            raise ValueError(f"{self.name} is not set")
        return value


@dataclass(frozen=True)
class FindPackageShare(Substitution):
    package: Text

    def perform(self, context: Context) -> str:
        package = performed(self.package, context)
        for prefix in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep):
            if prefix and Path(prefix, "share", package).is_dir():
                return f"{prefix}/share/{package}"
        return f"/share/{package}"


class ThisLaunchFileDir(Substitution):
    def perform(self, context: Context) -> str:
        return context.folder


@dataclass(frozen=True)
class PathJoinSubstitution(Substitution):
    parts: Sequence[str | Substitution]

    def perform(self, context: Context) -> str:
        return str(PurePosixPath(*(performed(each, context) for each in self.parts)))


@dataclass(frozen=True)
class FindExecutable(Substitution):
    name: str

    def perform(self, context: Context) -> str:
        found = shutil.which(self.name)
        if found is None:
            raise ValueError(f"executable '{self.name}' not found on the PATH")
        return found


@dataclass(frozen=True)
class Command(Substitution):
    command: Text
    on_stderr: str = "fail"

    def perform(self, context: Context) -> str:
        words = shlex.split(performed(self.command, context))
        found = subprocess.run(words, capture_output=True, text=True, check=False)
        if found.returncode:
            raise ValueError(f"executed command failed: {words}")
        if found.stderr and self.on_stderr == "fail":
            raise ValueError(f"executed command showed stderr output: {found.stderr}")
        return found.stdout


@dataclass(frozen=True)
class PythonExpression(Substitution):
    expression: Text
    modules: Sequence[str] = ()

    def perform(self, context: Context) -> str:
        known = {name: importlib.import_module(name) for name in self.modules}
        return str(eval(performed(self.expression, context), {}, known or vars(math)))


def truth(found: Text, context: Context) -> bool:
    """Return what a text means as a condition."""
    return {"true": True, "1": True, "false": False, "0": False}[performed(found, context).lower()]


@dataclass(frozen=True)
class NotSubstitution(Substitution):
    operand: Text

    def perform(self, context: Context) -> str:
        return str(not truth(self.operand, context)).lower()


class _Several(Substitution):
    together: Callable[[Iterable[bool]], bool]

    def __init__(self, *operands: Text) -> None:
        self.operands = operands

    def perform(self, context: Context) -> str:
        return str(type(self).together(truth(each, context) for each in self.operands)).lower()


class AllSubstitution(_Several):
    together = staticmethod(all)


class AnySubstitution(_Several):
    together = staticmethod(any)


@dataclass(frozen=True)
class IfElseSubstitution(Substitution):
    condition: Text
    if_value: Text
    else_value: Text

    def perform(self, context: Context) -> str:
        chosen = truth(self.condition, context)
        return performed(self.if_value if chosen else self.else_value, context)


@dataclass(frozen=True)
class EqualsSubstitution(Substitution):
    left: Text
    right: Text

    def perform(self, context: Context) -> str:
        one, other = performed(self.left, context), performed(self.right, context)
        truths = {"true": True, "1": True, "false": False, "0": False}
        if one.lower() in truths and other.lower() in truths:
            return str(truths[one.lower()] == truths[other.lower()]).lower()
        try:
            return str(math.isclose(float(one), float(other))).lower()
        except ValueError:
            return str(one == other).lower()


class NotEqualsSubstitution(EqualsSubstitution):
    def perform(self, context: Context) -> str:
        return "false" if super().perform(context) == "true" else "true"


@dataclass(frozen=True)
class IfCondition:
    predicate: Text

    def evaluate(self, context: Context) -> bool:
        return truth(self.predicate, context)


class UnlessCondition(IfCondition):
    def evaluate(self, context: Context) -> bool:
        return not super().evaluate(context)


@dataclass(frozen=True)
class ParameterValue:
    value: Any
    value_type: Any

    def evaluate(self, context: Context) -> Any:
        if not get_args(self.value_type):
            return self._coerced(performed(self.value, context), self.value_type)
        (kind,) = get_args(self.value_type)
        return [
            self._coerced(performed(each, context), kind) if isinstance(each, list) else each
            for each in self.value
        ]

    def _coerced(self, text: str, kind: Any) -> Any:
        return yaml.safe_load(text) if kind is bool else kind(text)


def as_ros_reads(value: Any) -> Any:
    """Return a value that launch_ros has written as YAML: a text without quotes may be another."""
    if isinstance(value, list):
        return [as_ros_reads(each) for each in value]
    if not isinstance(value, str):
        return value
    return value_of(str(value), is_text=yaml.dump(value)[0] in "'\"")


@dataclass(frozen=True)
class DeclareLaunchArgument:
    name: str
    default_value: Text | None = None
    description: str = ""
    choices: Sequence[str] | None = None


@dataclass(frozen=True)
class OpaqueFunction:
    function: Callable[..., Any]
    args: Sequence[Any] = ()
    kwargs: Mapping[str, Any] = field(default_factory=dict)
    condition: IfCondition | None = None


class Action:
    """An action of which only what it is given counts."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        self.given = (*args, *kwargs.values())

    @property
    def words(self) -> tuple[Any, ...]:
        """Its class, and what it is given."""
        given = (each.given[0] if isinstance(each, Action) else each for each in self.given)
        values = (each.value if isinstance(each, ParameterValue) else each for each in given)
        return (type(self).__name__, *values)


class AnyLaunchDescriptionSource(Action):
    pass


class GroupAction(Action):
    pass


class IncludeLaunchDescription(Action):
    pass


class PushRosNamespace(Action):
    pass


class SetEnvironmentVariable(Action):
    pass


class SetParameter(Action):
    pass


class SetParametersFromFile(Action):
    pass


class SetRemap(Action):
    pass


class UnsetLaunchConfiguration(Action):
    pass


@dataclass(frozen=True, kw_only=True)
class Node:
    package: str
    executable: str
    name: str | None = None
    namespace: Text
    output: str
    parameters: Sequence[Mapping[str, Any] | Text] = ()
    remappings: Sequence[tuple[Text, Text]] = ()
    ros_arguments: Sequence[Text] = ()
    arguments: Sequence[Text] = ()
    additional_env: Mapping[str, Text] | None = None
    prefix: Text | None = None
    respawn: bool = False
    respawn_delay: float | None = None
    respawn_max_retries: int = -1
    on_exit: Any = None
    condition: IfCondition | None = None


class LifecycleNode(Node):
    pass


@dataclass(frozen=True, kw_only=True)
class ComposableNode:
    package: str
    plugin: str
    name: str
    namespace: Text
    parameters: Sequence[Mapping[str, Any]] = ()
    remappings: Sequence[tuple[Text, Text]] = ()
    extra_arguments: Sequence[Mapping[str, Any]] = ()
    condition: IfCondition | None = None


@dataclass(frozen=True, kw_only=True)
class ComposableNodeContainer(Node):
    composable_node_descriptions: Sequence[ComposableNode]


@dataclass(frozen=True, kw_only=True)
class LoadComposableNodes:
    target_container: Text
    composable_node_descriptions: Sequence[ComposableNode]
    condition: None = None


@dataclass(frozen=True, kw_only=True)
class ExecuteProcess:
    cmd: Sequence[Text]
    name: str
    output: str
    cwd: Text | None = None
    additional_env: Mapping[str, Text] | None = None
    prefix: Text | None = None
    respawn: bool = False
    respawn_delay: float | None = None
    respawn_max_retries: int = -1
    on_exit: Any = None
    condition: IfCondition | None = None


@dataclass(frozen=True)
class LaunchDescription:
    entities: Sequence[DeclareLaunchArgument | OpaqueFunction | Node | ExecuteProcess]


_MODULES: Mapping[str, Sequence[type]] = {
    "launch": [LaunchDescription, Substitution],
    "launch.actions": [
        DeclareLaunchArgument,
        ExecuteProcess,
        GroupAction,
        IncludeLaunchDescription,
        OpaqueFunction,
        SetEnvironmentVariable,
        UnsetLaunchConfiguration,
    ],
    "launch.launch_description_sources": [AnyLaunchDescriptionSource],
    "launch.conditions": [IfCondition, UnlessCondition],
    "launch.event_handlers": [OnShutdown],
    "launch.substitutions": [
        AllSubstitution,
        AnySubstitution,
        Command,
        EnvironmentVariable,
        EqualsSubstitution,
        FindExecutable,
        IfElseSubstitution,
        LaunchConfiguration,
        NotEqualsSubstitution,
        NotSubstitution,
        PathJoinSubstitution,
        PythonExpression,
        ThisLaunchFileDir,
    ],
    "launch_ros": [],
    "launch_ros.actions": [
        ComposableNodeContainer,
        LoadComposableNodes,
        Node,
        LifecycleNode,
        PushRosNamespace,
        SetParameter,
        SetParametersFromFile,
        SetRemap,
    ],
    "launch_ros.descriptions": [ComposableNode],
    "launch_ros.parameter_descriptions": [ParameterValue],
    "launch_ros.substitutions": [FindPackageShare],
    "launch_ros.utilities": [],
    "launch.utilities": [],
}


def modules() -> Iterator[tuple[str, ModuleType]]:
    """Yield the modules that stand for ``launch`` and ``launch_ros``."""
    for name, members in _MODULES.items():
        module = ModuleType(name)
        for member in members:
            setattr(module, member.__name__, member)
        if name == "launch.utilities":
            vars(module)["normalize_to_list_of_substitutions"] = lambda text: text
            vars(module)["perform_substitutions"] = lambda context, text: performed(text, context)
        if name == "launch_ros.utilities":
            vars(module)["normalize_parameters"] = lambda parameters: parameters
            vars(module)["evaluate_parameters"] = lambda context, parameters: [
                {name: _value(value, context) for name, value in each.items()}
                for each in parameters
            ]
            vars(module)["prefix_namespace"] = _prefixed
            vars(module)["make_namespace_absolute"] = lambda name: f"/{name.removeprefix('/')}"
        yield name, module


def _value(value: Any, context: Context) -> Any:
    return value.evaluate(context) if isinstance(value, ParameterValue) else value


def _prefixed(base: str, name: str) -> str:
    """Return a name below a namespace, as ``launch_ros.utilities`` does."""
    if name.startswith("/") or not base:
        return name if name == "/" else name.rstrip("/")
    return f"{base.rstrip('/')}/{name}".rstrip("/")


def described(
    text: str, stand_ins: Mapping[str, ModuleType], names: Mapping[str, Any] | None = None
) -> Any:
    """Return what a launch file describes, with modules in the place of others.

    ``names`` replace what it has imported.
    """
    before = {name: sys.modules.get(name) for name in stand_ins}
    sys.modules.update(stand_ins)
    try:
        found: dict[str, Any] = {}
        exec(compile(text, "generated.launch.py", "exec"), found)
        found.update(names or {})
        return found["generate_launch_description"]()
    finally:
        for name, module in before.items():
            if module is None:
                del sys.modules[name]
            else:
                sys.modules[name] = module


def started(
    text: str, given: Mapping[str, str], folder: str = HERE, namespace: str = "/"
) -> list[tuple[Any, ...]]:
    """Return the nodes that a launch file starts: full name, program, parameters and remappings.

    ``namespace``: that it is included in.

    Raises:
        ValueError: a value is refused, or one is missing.
    """
    found = _started(text, given, folder, namespace=namespace)
    return [_node(each, context) for each, context in found if isinstance(each, Node)]


def loaded(text: str, given: Mapping[str, str], folder: str = HERE) -> list[tuple[Any, ...]]:
    """Return what a launch file loads: container, full name, class, what it is given.

    Raises:
        ValueError: a value is refused, or one is missing.
    """
    found = []
    for each, context in _started(text, given, folder):
        if isinstance(each, ComposableNodeContainer):
            target = f"{_pushed(each.namespace, context).rstrip('/')}/{each.name}"
        elif isinstance(each, LoadComposableNodes):
            target = performed(each.target_container, context)
        else:
            continue
        for node in each.composable_node_descriptions:
            if node.condition is None or node.condition.evaluate(context):
                name, plugin, parameters, remappings = _node(node, context)
                inside = [dict(one) for one in node.extra_arguments]
                found.append((target, name, node.package, plugin, parameters, remappings, inside))
    return found


def commands(text: str, given: Mapping[str, str]) -> list[tuple[Any, ...]]:
    """Return what a launch file starts: name, words, variables and folder of each program.

    The words of a node are those of its prefix, its program, and its own arguments.

    Raises:
        ValueError: a value is refused, or one is missing.
    """
    found = _started(text, given)
    return [_command(each, at) for each, at in found if not isinstance(each, LoadComposableNodes)]


def restarts(text: str, given: Mapping[str, str]) -> list[tuple[Any, ...]]:
    """Return the delay and the number of the restarts of each program, after its name."""
    started = (
        each for each, _ in _started(text, given) if not isinstance(each, LoadComposableNodes)
    )
    return [
        (each.name, each.respawn_delay, None if most < 0 else most)
        if each.respawn
        else (each.name, None, None)
        for each in started
        for most in [each.respawn_max_retries]
    ]


def parameter_files(
    text: str, given: Mapping[str, str], checked: list[str]
) -> list[tuple[str, list[str]]]:
    """Return the full names of the nodes that a launch file starts, and their parameter files.

    The files that it looks for before that join ``checked``.
    """

    def is_file(path: str) -> bool:
        checked.append(path)
        return True

    found = []
    for node, context in _started(text, given, is_file=is_file):
        if isinstance(node, Node):
            named = (each for each in node.parameters if not isinstance(each, Mapping))
            found.append((_node(node, context)[0], [performed(each, context) for each in named]))
    return found


def shared(
    text: str, given: Mapping[str, str], namespace: str = "/"
) -> list[tuple[list[str], dict[str, Any]]]:
    """Return what a launch file gives to processes of several nodes.

    That is the rules of each in their order, and the parameters by the full names of nodes.
    """
    found = []
    for program, context in _started(text, given, is_file=lambda _: True, namespace=namespace):
        files: list[str] = []
        if isinstance(program, Node):
            rules = [performed(each, context) for each in program.ros_arguments]
            rules += [] if program.name is None else [f"__node:={program.name}"]
            rules.append(f"__ns:={_pushed(program.namespace, context)}")
            rules += [f"{name}:={performed(to, context)}" for name, to in program.remappings]
            assert not any(isinstance(each, Mapping) for each in program.parameters)
            files = [performed(each, context) for each in program.parameters]  # type: ignore[arg-type]
        elif isinstance(program, ExecuteProcess):
            rules = [performed(each, context) for each in program.cmd]
            files = [file for flag, file in itertools.pairwise(rules) if flag == "--params-file"]
        parameters: dict[str, Any] = {}
        for file in map(Path, files):
            sections = yaml.safe_load(file.read_text(encoding="utf-8"))
            parameters |= {name: each["ros__parameters"] for name, each in sections.items()}
            file.unlink()
        found.append(([each for each in rules if ":=" in each], parameters))
    return found


def texts_of_files(
    text: str, given: Mapping[str, str], folder: str, before_nodes: Callable[[], None] | None = None
) -> list[tuple[str, list[tuple[str, str]]]]:
    """Return the full names of the nodes of a launch file, and what their parameter files say.

    Each file comes with its path. After that, launch shuts down. ``before_nodes`` is called before
    the first node is started.
    """
    handlers: list[OnShutdown] = []
    found = []
    try:
        for node, context in _started(text, given, folder, handlers=handlers):
            if before_nodes is not None:
                before_nodes()
                before_nodes = None
            assert isinstance(node, Node)
            named = [performed(e, context) for e in node.parameters if not isinstance(e, Mapping)]
            read = [(path, Path(path).read_bytes().decode()) for path in named]
            found.append((_node(node, context)[0], read))
    finally:  # it does so, too, when it has caught an exception
        for each in handlers:
            each.on_shutdown(None, Context(given))
    return found


def with_files(
    text: str, given: Mapping[str, str], folder: str
) -> Iterator[tuple[Sequence[str], Mapping[str, str]]]:
    """Yield the words and variables of each program while what is made for it is there.

    Before the first one, all has been made; after the last one, launch shuts down.
    """
    handlers: list[OnShutdown] = []
    try:
        for program, context in _started(text, given, folder, handlers=handlers):
            assert isinstance(program, Node | ExecuteProcess)
            _, words, variables, _ = _command(program, context)
            yield words, variables
    finally:
        for each in handlers:
            each.on_shutdown(None, Context(given))


def included(
    text: str, given: Mapping[str, str], folder: str | None = None
) -> list[list[tuple[Any, ...]]]:
    """Return what a launch file does around each file that it includes, that file last.

    Each action is the name of its class, and what it is given. Without a ``folder``, whatever file
    it looks for is there.
    """
    found: list[list[tuple[Any, ...]]] = []
    is_file = (lambda _: True) if folder is None else None
    done = _started(text, given, folder or HERE, is_file=is_file, groups=found)
    assert all(isinstance(each, Node | ExecuteProcess) for each, _ in done)
    return found


def _started(
    text: str,
    given: Mapping[str, str],
    folder: str = HERE,
    is_file: Callable[[str], bool] | None = None,
    groups: list[list[tuple[Any, ...]]] | None = None,
    namespace: str = "/",
    handlers: list[OnShutdown] | None = None,
) -> Iterator[tuple[Node | ExecuteProcess | LoadComposableNodes, Context]]:
    """Yield what a launch file starts, each with the values of the arguments.

    The groups of actions that it makes while it is launched join ``groups``.
    """
    names = {} if is_file is None else {"os": SimpleNamespace(path=SimpleNamespace(isfile=is_file))}
    description = described(text, dict(modules()), names)
    values = dict(given)
    for entity in description.entities:
        context = Context(values, folder, namespace, [] if handlers is None else handlers)
        if isinstance(entity, DeclareLaunchArgument):
            if entity.default_value is not None and entity.name not in values:
                values[entity.name] = performed(entity.default_value, context)
            if entity.name not in values:
                raise ValueError(f"{entity.name} is required")
            if entity.choices is not None and values[entity.name] not in entity.choices:
                raise ValueError(f"{entity.name} is none of {entity.choices}")
        elif entity.condition is not None and not entity.condition.evaluate(context):
            continue
        elif isinstance(entity, OpaqueFunction):
            for action in entity.function(context, *entity.args, **entity.kwargs) or ():
                if isinstance(action, GroupAction) and groups is not None:
                    groups.append([each.words for each in action.given[0]])
                elif isinstance(action, OpaqueFunction):
                    action.function(context)
        else:
            yield entity, context


def _command(program: Node | ExecuteProcess, context: Context) -> tuple[Any, ...]:
    folder: Text | None = None
    if isinstance(program, Node):
        words: Sequence[Text] = [program.executable, *program.arguments]
    else:
        words, folder = program.cmd, program.cwd
    prefix = shlex.split(performed(program.prefix or "", context))
    given = (program.additional_env or {}).items()
    variables = {name: performed(value, context) for name, value in given}
    return (
        program.name,
        [*prefix, *(performed(each, context) for each in words)],
        variables,
        None if folder is None else performed(folder, context),
    )


def _node(node: Node | ComposableNode, context: Context) -> tuple[Any, ...]:
    parameters: dict[str, Any] = {}
    for each in node.parameters:
        for name, value in each.items() if isinstance(each, Mapping) else ():
            is_typed = isinstance(value, ParameterValue)
            found = value.evaluate(context) if is_typed else value
            parameters[name] = found if isinstance(node, ComposableNode) else as_ros_reads(found)
    namespace = _pushed(node.namespace, context)
    remappings = {
        performed(name, context): resolve_name(
            performed(target, context), namespace, node.name or ""
        )
        for name, target in node.remappings
    }
    program = node.plugin if isinstance(node, ComposableNode) else node.executable
    return f"{namespace.rstrip('/')}/{node.name}", program, parameters, remappings


def _pushed(namespace: Text, context: Context) -> str:
    """Return the namespace of a node in the file, which is included in another."""
    return resolve_name(performed(namespace, context), context.namespace).rstrip("/") or "/"
