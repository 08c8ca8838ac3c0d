"""What ``launch`` does with the events of managed nodes, for the launch files that bring them up.

Written after ``launch`` and ``launch_ros`` (branch ``jazzy``); each class accepts only what the
generator writes. A test plays the nodes: it says what happens to them, and reads what is asked.
"""

# ruff: noqa: D101, D102 - the names are those of launch, and so is what they do

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from types import ModuleType, SimpleNamespace
from typing import Any

from tests.support import launch
from tests.support.launch import Context, described, performed

_Handler = Callable[..., Any]


@dataclass(frozen=True, kw_only=True, eq=False)
class LifecycleNode(launch.Node):
    node_name: str = field(init=False, default="<node_name_unspecified>")

    def begin(self, context: Context) -> None:
        """Find out the full name, as the action does when it is executed."""
        name = f"{performed(self.namespace, context).rstrip('/')}/{self.name}"
        object.__setattr__(self, "node_name", name)


@dataclass(frozen=True, kw_only=True, eq=False)
class ComposableNodeContainer(launch.ComposableNodeContainer, LifecycleNode):
    pass


@dataclass(frozen=True, kw_only=True, eq=False)
class ExecuteProcess(launch.ExecuteProcess):
    @property
    def node_name(self) -> str:
        return self.name

    def begin(self, context: Context) -> None:
        """Do nothing: its name is known before."""


@dataclass(frozen=True)
class OpaqueFunction:
    function: _Handler
    args: Sequence[Any] = ()


class PushLaunchConfigurations:
    pass


class PopLaunchConfigurations:
    pass


class PushEnvironment:
    pass


class PopEnvironment:
    pass


@dataclass(frozen=True)
class LogInfo:
    msg: str


@dataclass(frozen=True)
class Shutdown:
    reason: str


@dataclass(frozen=True)
class EmitEvent:
    event: ChangeState


@dataclass(eq=False)
class TimerAction:
    period: float
    actions: Sequence[OpaqueFunction]
    is_canceled: bool = False

    def cancel(self) -> None:
        self.is_canceled = True


@dataclass(frozen=True)
class OnProcessStart:
    target_action: LifecycleNode
    on_start: _Handler


@dataclass(frozen=True)
class OnProcessExit:
    target_action: LifecycleNode | ExecuteProcess
    on_exit: _Handler


@dataclass(frozen=True)
class OnStateTransition:
    target_lifecycle_node: LifecycleNode
    entities: Sequence[OpaqueFunction]


@dataclass(frozen=True)
class RegisterEventHandler:
    event_handler: OnProcessStart | OnProcessExit | OnStateTransition


def matches_action(action: LifecycleNode) -> LifecycleNode:
    """Return the action itself, which is all that there is to match."""
    return action


@dataclass(frozen=True, kw_only=True)
class ChangeState:
    lifecycle_node_matcher: LifecycleNode
    transition_id: str


@dataclass
class Graph:
    """What is in the ROS graph, as a node of rclpy sees it.

    Attributes:
        nodes: pairs of a name and a namespace.
        services: those that a server is there for.
        publishers: topics that are published.
        states: of managed nodes, by full name.
    """

    nodes: list[tuple[str, str]] = field(default_factory=list)
    services: list[str] = field(default_factory=list)
    publishers: list[str] = field(default_factory=list)
    states: dict[str, int] = field(default_factory=dict)

    def get_node_names_and_namespaces(self) -> list[tuple[str, str]]:
        return self.nodes

    def count_services(self, name: str) -> int:
        return self.services.count(name)

    def count_publishers(self, name: str) -> int:
        return self.publishers.count(name)

    def create_client(self, kind: type, name: str) -> StateClient:
        assert kind is GetState
        return StateClient(self, name)


class GetState:
    Request = SimpleNamespace


@dataclass(frozen=True)
class StateClient:
    graph: Graph
    name: str

    def service_is_ready(self) -> bool:
        return self.name.removesuffix("/get_state") in self.graph.states

    def call_async(self, _: SimpleNamespace) -> Any:
        state = self.graph.states[self.name.removesuffix("/get_state")]
        answer = SimpleNamespace(current_state=SimpleNamespace(id=state))
        return SimpleNamespace(done=lambda: True, result=lambda: answer)


def get_ros_node(context: Any) -> Graph:
    """Return the node that launch_ros has."""
    graph = context.graph
    assert isinstance(graph, Graph)
    return graph


def prefix_namespace(base: str, name: str) -> str:
    """Return a name in a namespace, as ``launch_ros.utilities`` does."""
    return name if not base or name.startswith("/") else f"{base.rstrip('/')}/{name}"


def make_namespace_absolute(name: str) -> str:
    """Return a name with a slash before it."""
    return name if name.startswith("/") else f"/{name}"


def normalize_to_list_of_substitutions(found: Any) -> list[Any]:
    """Return several pieces of a text."""
    return list(found) if isinstance(found, list | tuple) else [found]


def perform_substitutions(context: Any, found: list[Any]) -> str:
    """Return the text that pieces make."""
    return performed(found, Context(context.values))


_MODULES: Mapping[str, Sequence[Any]] = {
    "launch": [launch.LaunchDescription],
    "launch.actions": [
        *(launch.DeclareLaunchArgument, EmitEvent, LogInfo, OpaqueFunction),
        *(RegisterEventHandler, Shutdown, TimerAction, ExecuteProcess),
        *(PushLaunchConfigurations, PopLaunchConfigurations, PushEnvironment, PopEnvironment),
    ],
    "launch.conditions": [launch.IfCondition, launch.UnlessCondition],
    "launch.event_handlers": [OnProcessExit, OnProcessStart],
    "launch.events": [matches_action],
    "launch.substitutions": [launch.LaunchConfiguration, launch.IfElseSubstitution],
    "launch.utilities": [normalize_to_list_of_substitutions, perform_substitutions],
    "launch_ros": [],
    "launch_ros.actions": [launch.Node, LifecycleNode, ComposableNodeContainer],
    "launch_ros.descriptions": [launch.ComposableNode],
    "launch_ros.event_handlers": [OnStateTransition],
    "launch_ros.events": [],
    "launch_ros.events.lifecycle": [ChangeState],
    "lifecycle_msgs": [],
    "launch_ros.ros_adapters": [get_ros_node],
    "launch_ros.utilities": [make_namespace_absolute, prefix_namespace],
    "lifecycle_msgs.msg": [],
    "lifecycle_msgs.srv": [GetState],
}


def _modules() -> dict[str, ModuleType]:
    found = {}
    for name, members in _MODULES.items():
        found[name] = ModuleType(name)
        for member in members:
            setattr(found[name], member.__name__, member)
    transitions = {f"TRANSITION_{name.upper()}": name for name in ("configure", "activate")}
    found["lifecycle_msgs.msg"].Transition = SimpleNamespace(**transitions)  # type: ignore[attr-defined]
    found["lifecycle_msgs.msg"].State = SimpleNamespace(PRIMARY_STATE_ACTIVE=3)  # type: ignore[attr-defined]
    return found


@dataclass
class Launched:
    """A launch file at work.

    Attributes:
        requests: the transitions that have been asked for: a node's full name, and which.
        logged: what it has said.
        reasons: why it has stopped everything, if it has.
        timers: those that have been started.
        nodes: the programs that have been started, by name.
        started_ones: the same in their order, also those of one name.
        locals: those that an action has put back.
        seen: the values of arguments, and the variables, that each of them was started with.
        graph: what is in the ROS graph.
    """

    values: Mapping[str, str]
    requests: list[tuple[str, str]] = field(default_factory=list)
    logged: list[str] = field(default_factory=list)
    reasons: list[str] = field(default_factory=list)
    timers: list[TimerAction] = field(default_factory=list)
    nodes: dict[str, LifecycleNode | ExecuteProcess] = field(default_factory=dict)
    started_ones: list[LifecycleNode | ExecuteProcess] = field(default_factory=list)
    locals: dict[str, Any] = field(default_factory=dict)
    seen: dict[str, tuple[dict[str, str], dict[str, str]]] = field(default_factory=dict)
    graph: Graph = field(default_factory=Graph)
    _handlers: list[Any] = field(default_factory=list)
    _configurations: list[dict[str, str]] = field(default_factory=list)
    _environments: list[dict[str, str]] = field(default_factory=lambda: [{}])

    def __post_init__(self) -> None:
        """Begin with the given values."""
        self._configurations.append(dict(self.values))

    @property
    def _top(self) -> dict[str, str]:
        return self._configurations[-1]

    @property
    def awaited(self) -> dict[str, str]:
        """What each program that waits for the graph waits for."""
        looks = [each.actions[0].function for each in self.timers if each.period == 0.1]
        waits = [getattr(each, "__self__") for each in looks]  # noqa: B009 - of the file under test
        return {each.program: each.full_name for each in waits}

    def leave_scope(self) -> None:
        """Forget the values and variables, as at the end of a group that includes the file."""
        self._top.clear()
        self._environments[-1].clear()

    def set_variable(self, name: str, value: str) -> None:
        """Set an environment variable, as a group around the file does."""
        self._environments[-1][name] = value

    def started(self, name: str) -> None:
        """Say that the process of a node has started."""
        self._happens(OnProcessStart, self.nodes[name], lambda each: each.on_start)

    def exited(self, name: str) -> None:
        """Say that the process of a node has ended."""
        self.exited_one(self.nodes[name])

    def exited_one(self, node: LifecycleNode | ExecuteProcess) -> None:
        """Say so of one of several processes that have one name."""
        self._happens(OnProcessExit, node, lambda each: each.on_exit)

    def changed(self, name: str, start: str, goal: str) -> None:
        """Say that a node has made a transition."""
        event = SimpleNamespace(action=self.nodes[name], start_state=start, goal_state=goal)
        context = SimpleNamespace(locals=SimpleNamespace(event=event))
        for each in self._handlers:
            if isinstance(each, OnStateTransition) and each.target_lifecycle_node is event.action:
                for entity in each.entities:
                    self.execute(entity.function(context))

    def comes_up(self, name: str) -> None:
        """Say that a node has been configured and activated."""
        for start, between, goal in (
            ("unconfigured", "configuring", "inactive"),
            ("inactive", "activating", "active"),
        ):
            self.changed(name, start, between)
            self.changed(name, between, goal)

    def expire(self, period: float) -> None:
        """Let the timers of a period expire that have not been canceled."""
        running = [each for each in self.timers if each.period == period and not each.is_canceled]
        for each in running:
            each.cancel()
            for action in each.actions:
                self.execute(action.function(self._context))

    def execute(self, entities: Iterable[Any] | None) -> None:
        """Do what actions say."""
        for each in entities or ():
            if isinstance(each, LifecycleNode | ExecuteProcess):
                if each.condition is None or each.condition.evaluate(Context(self._top)):
                    each.begin(Context(self._top))
                    self.nodes[each.node_name] = each
                    self.started_ones.append(each)
                    self.seen[each.node_name] = (dict(self._top), dict(self._environments[-1]))
            elif isinstance(each, OpaqueFunction):
                self.execute(each.function(self._context, *each.args))
            elif isinstance(each, PushLaunchConfigurations):
                self._configurations.append(dict(self._top))
            elif isinstance(each, PopLaunchConfigurations):
                self._configurations.pop()
            elif isinstance(each, PushEnvironment):
                self._environments.append(dict(self._environments[-1]))
            elif isinstance(each, PopEnvironment):
                self._environments.pop()
            elif isinstance(each, RegisterEventHandler):
                self._handlers.append(each.event_handler)
            elif isinstance(each, EmitEvent):
                node = each.event.lifecycle_node_matcher.node_name
                self.requests.append((node, each.event.transition_id))
            elif isinstance(each, TimerAction):
                self.timers.append(each)
            elif isinstance(each, LogInfo):
                self.logged.append(each.msg)
            elif isinstance(each, Shutdown):
                self.reasons.append(each.reason)

    @property
    def _context(self) -> Any:
        return SimpleNamespace(
            values=self._top,
            launch_configurations=self._top,
            environment=self._environments[-1],
            get_locals_as_dict=lambda: {"event": None, "current_launch_file_directory": "/"},
            extend_locals=self.locals.update,
            is_shutdown=bool(self.reasons),
            graph=self.graph,
        )

    def _happens(self, kind: type, action: Any, reaction: Callable[[Any], _Handler]) -> None:
        event = SimpleNamespace(action=action)
        for each in self._handlers:
            if isinstance(each, kind) and each.target_action is event.action:  # type: ignore[attr-defined]
                self.execute(reaction(each)(event, self._context))


def launched(text: str, **values: str) -> Launched:
    """Run a launch file up to where something has to happen."""
    return launched_with(text, {}, **values)


def launched_with(text: str, variables: Mapping[str, str], **values: str) -> Launched:
    """Run a launch file likewise, with environment variables of a group around it."""
    result = Launched(values)
    for name, value in variables.items():
        result.set_variable(name, value)
    # Of what events change nothing about, the classes are those for all launch files.
    found = dict(launch.modules())
    for name, module in _modules().items():
        found.setdefault(name, module).__dict__.update(vars(module))
    result.execute(described(text, found).entities)
    return result
