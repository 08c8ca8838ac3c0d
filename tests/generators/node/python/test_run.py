"""Generated packages in either language build with colcon, and their installed nodes run."""

from __future__ import annotations

import select
import signal
from collections.abc import Callable
from pathlib import Path
from subprocess import Popen
from typing import Any

import pytest

from deros.generators.api.protocol import Context
from deros.generators.system.params.generate import generate as generate_params
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from tests.support.needs import needs
from tests.support.node_packages import MODELS, CppPackages, NodePackages, PythonPackages, Start
from tests.support.ros import LIMIT, Peer, read_line, set_parameter, stop
from tests.support.systems import load_text

pytestmark = pytest.mark.ros


@pytest.fixture(
    scope="module",
    params=[
        pytest.param(PythonPackages, id="python"),
        pytest.param(CppPackages, id="cpp", marks=needs("rclcpp")),
    ],
)
def packages(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> NodePackages:
    """Return the built packages, in each language."""
    built: NodePackages = request.param(tmp_path_factory.mktemp("workspace"))
    return built


@pytest.fixture
def start(packages: NodePackages, ros_env: dict[str, str]) -> Start:
    """Return a function that starts a program of the packages."""
    return packages.starting(ros_env)


# Messages, services, parameters -------------------------------------------------------------------


def odometry_for(peer: Peer, count: int) -> Callable[[], float]:
    """Return a function that sends a count and waits for the resulting position."""
    from nav_msgs.msg import Odometry
    from rclpy.duration import Duration
    from rclpy.qos import DurabilityPolicy, QoSProfile
    from std_msgs.msg import Int32

    received: list[float] = []
    latched = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    peer.node.create_subscription(
        Odometry, "/odom", lambda msg: received.append(msg.pose.pose.position.x), latched
    )
    lively = QoSProfile(depth=5, liveliness_lease_duration=Duration(seconds=1))
    ticks = peer.node.create_publisher(Int32, "/ticks", lively)
    peer.until(lambda: ticks.get_subscription_count() and peer.node.count_publishers("/odom"))

    def exchange() -> float:
        received.clear()
        ticks.publish(Int32(data=count))
        return float(peer.until(lambda: received)[-1])

    return exchange


def test_node_handles_messages_parameters_and_termination(
    packages: NodePackages, start: Start, ros_peer: Peer
) -> None:
    """It answers a message, rejects invalid parameters with a reason, and ends with 0."""
    with start("differential_odometry", "odometry_node") as process:
        exchange = odometry_for(ros_peer, 3)
        assert exchange() == 3.0

        (good,) = set_parameter(ros_peer, "odometry_node", scale=2.0)
        assert good.successful
        assert exchange() == 6.0

        refusals = {
            "scale": (0.0, "scale must lie in (0.0, 2.0]"),
            "mode": ("idle", "mode must be one of 'auto', 'manual'"),
            "gains": ([1.0], "gains must have 3 elements"),
            "ticks_per_turn": (0, packages.out_of_range["ticks_per_turn"]),
            "wheel_base": (1.0, "read-only"),
            "imu_topic": ("/other", "read-only"),
            "frames": (1.5, "Wrong parameter type"),
        }
        for name, (value, reason) in refusals.items():
            (result,) = set_parameter(ros_peer, "odometry_node", **{name: value})
            assert not result.successful, name
            assert reason in result.reason
        assert exchange() == 6.0

        code, output = stop(process, signal.SIGINT)
    assert (code, "Traceback" in output) == (0, False), output
    assert output.count("scale was 1 and is 2") == 1
    assert output.count("on_control does nothing yet") == 1


PEER = "/test_peer"
UNKNOWN = "a node that is not known yet"
"""Placeholder for the name of a node whose topics are discovered first."""


def until_printed(process: Popen[str], text: str) -> str:
    """Read the output of a program up to the line that contains a text, and return it."""
    while text not in (line := read_line(process)):
        assert line, f"it ended without printing {text!r}"
    return line


def test_timers_follow_simulated_time(start: Start, ros_peer: Peer) -> None:
    """They rest while there is none, unlike the handlers of messages, and run when it passes."""
    from rosgraph_msgs.msg import Clock  # type: ignore[import-untyped]

    simulated = ("--ros-args", "-p", "use_sim_time:=true")
    with start("differential_odometry", "odometry_node", *simulated) as process:
        assert odometry_for(ros_peer, 3)() == 3.0
        set_parameter(ros_peer, "odometry_node", scale=2.0)
        assert "scale was 1 and is 2" in read_line(process)  # its timer would have come first

        clock = ros_peer.node.create_publisher(Clock, "/clock", 10)
        now = Clock()

        def tick() -> None:
            now.clock.sec += 1
            clock.publish(now)

        ros_peer.node.create_timer(0.02, tick)
        output = process.stdout
        assert output is not None
        ros_peer.until(lambda: select.select([output], [], [], 0)[0])
        assert "on_control does nothing yet" in read_line(process)


def test_incompatible_subscription_is_reported(start: Start, ros_peer: Peer) -> None:
    """The error names topic, node and each policy, since no message would ever be delivered."""
    from rclpy.duration import Duration
    from rclpy.qos import DurabilityPolicy, QoSProfile
    from std_msgs.msg import String

    asked = QoSProfile(
        depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL, deadline=Duration(seconds=1)
    )
    with start("chat", "talker") as process:
        ros_peer.until(lambda: ros_peer.node.count_publishers("/chatter"))
        ros_peer.node.create_subscription(String, "/chatter", lambda _: None, asked)
        line = until_printed(process, "/chatter does not reach ")
    assert "[ERROR]" in line
    assert f"reach {PEER}: " in line or f"reach {UNKNOWN}: " in line
    assert "Volatile publisher and transient local subscription; " in line
    assert "Subscription" in line.partition("; ")[2]  # the deadline, in the words of each library


def test_incompatible_publisher_is_reported(start: Start, ros_peer: Peer) -> None:
    """A matching publisher is not reported."""
    from rclpy.qos import QoSProfile, ReliabilityPolicy
    from std_msgs.msg import String

    ros_peer.node.create_publisher(String, "/chatter", 1)
    with start("chat", "listener") as process:
        ros_peer.until(lambda: ros_peer.node.count_subscribers("/chatter"))
        offered = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        ros_peer.node.create_publisher(String, "/chatter", offered)
        line = until_printed(process, "/chatter is not received from ")
        assert "[ERROR]" in line
        assert f"from {PEER}: " in line or f"from {UNKNOWN}: " in line
        assert "Best effort publisher and reliable subscription" in line
        code, output = stop(process, signal.SIGINT)
    assert (code, "[ERROR]" in output) == (0, False), output


def test_atomic_parameter_request_is_checked_as_a_whole(start: Start, ros_peer: Peer) -> None:
    """One invalid value leaves all parameters unchanged."""
    from rcl_interfaces.srv import GetParameters, SetParametersAtomically
    from rclpy.parameter import Parameter

    with start("differential_odometry", "odometry_node"):
        node = "/odometry_node"
        setter = ros_peer.node.create_client(
            SetParametersAtomically, f"{node}/set_parameters_atomically"
        )
        values = {"scale": 2.0, "gains": [1.0, 2.0, 11.0]}
        wanted = [Parameter(n, value=value).to_parameter_msg() for n, value in values.items()]
        request = SetParametersAtomically.Request(parameters=wanted)
        result = ros_peer.call(setter, request).result
        assert not result.successful
        assert result.reason == "gains must have all elements in [0.0, 10.0]"
        getter = ros_peer.node.create_client(GetParameters, f"{node}/get_parameters")
        found = ros_peer.call(getter, GetParameters.Request(names=["scale", "gains"])).values
        assert (found[0].double_value, list(found[1].double_array_value)) == (1.0, [1.0, 0.1, 0.0])


def test_descriptors_describe_the_parameters(start: Start, ros_peer: Peer) -> None:
    """Description with unit, range and constraints is available at run time."""
    from rcl_interfaces.msg import ParameterType
    from rcl_interfaces.srv import DescribeParameters

    with start("differential_odometry", "odometry_node"):
        client = ros_peer.node.create_client(
            DescribeParameters, "/odometry_node/describe_parameters"
        )
        names = ["wheel_base", "scale", "mode", "frames", "pid.lambda"]
        descriptors = ros_peer.call(client, DescribeParameters.Request(names=names)).descriptors
    wheel_base, scale, mode, frames, bytes_ = descriptors
    assert wheel_base.description == "Distance between the wheels [m]"
    assert wheel_base.read_only
    (bounds,) = wheel_base.floating_point_range
    assert (bounds.from_value, bounds.to_value) == (0.1, 2.0)
    assert scale.additional_constraints == "must lie in (0.0, 2.0]"
    assert mode.additional_constraints == "must be one of 'auto', 'manual'"
    assert frames.type == ParameterType.PARAMETER_STRING_ARRAY
    assert bytes_.type == ParameterType.PARAMETER_BYTE_ARRAY


def test_initial_parameters_come_from_the_file(
    packages: NodePackages, start: Start, ros_peer: Peer
) -> None:
    """The generated parameter file is read, and the topic name follows its parameter."""
    config = packages.share("differential_odometry") / "config/odometry_node.yaml"
    arguments = ["--ros-args", "--params-file", str(config), "-p", "imu_topic:=/other_imu"]
    with start("differential_odometry", "odometry_node", *arguments):
        ros_peer.until(lambda: ros_peer.node.count_subscribers("/other_imu"))
        assert ros_peer.node.count_subscribers("/fmInformation/imu") == 0


def test_empty_topic_parameter_keeps_the_port_name(start: Start, ros_peer: Peer) -> None:
    """The port has the name of the node description."""
    arguments = ["--ros-args", "-p", "imu_topic:=''"]
    with start("differential_odometry", "odometry_node", *arguments):
        ros_peer.until(lambda: ros_peer.node.count_subscribers("/imu"))


def test_node_subscribes_to_each_topic_of_a_list(start: Start, ros_peer: Peer) -> None:
    """The entries are names as in code: relative ones are below the node's namespace."""
    arguments = ["--ros-args", "-p", "needed:=1.0", "-p", "sources:=[/far, near]"]
    with start("mapping", "mapper", *arguments, "-r", "__ns:=/robot"):
        count = ros_peer.node.count_subscribers
        ros_peer.until(lambda: count("/far") and count("/robot/near"))
        assert not count("/left/map")


def test_handler_is_told_for_which_entry_a_message_is(start: Start, ros_peer: Peer) -> None:
    """Each entry of a map has its own topic; one without a name has no subscription."""
    from std_msgs.msg import String

    received: list[str] = []
    ros_peer.node.create_subscription(String, "/map", lambda m: received.append(m.data), 10)
    names = ("gains.elbow.target:=/bend", "gains.wrist.target:=/turn")
    arguments = ["needed:=1.0", "joints:=[elbow, shoulder, wrist]", *names]
    given = [word for argument in arguments for word in ("-p", argument)]
    with start("mapping", "mapper", "--ros-args", *given):
        bend, turn = (
            ros_peer.node.create_publisher(String, name, 10) for name in ("/bend", "/turn")
        )
        for publisher in (bend, turn):
            ros_peer.until(publisher.get_subscription_count)
        ros_peer.until(lambda: ros_peer.node.count_publishers("/map"))
        for publisher, answer in ((turn, "wrist: now"), (bend, "elbow: now")):
            publisher.publish(String(data="now"))
            ros_peer.until(lambda: received)
            assert received == [answer]
            received.clear()
        assert not ros_peer.node.count_subscribers("/target")


def refused_at_start(start: Start, setting: str) -> str:
    """Return the output of a node that does not start because of an invalid value."""
    with start("differential_odometry", "odometry_node", "--ros-args", "-p", setting) as node:
        output, _ = node.communicate(timeout=LIMIT)
    assert node.returncode == 1, output
    return output


@pytest.mark.parametrize(
    ("setting", "reason"),
    [
        ("gains:=[1.0, 2.0]", "gains must have 3 elements"),
        ("mode:=idle", "mode must be one of 'auto', 'manual'"),
        ("scale:=fast", "scale"),
    ],
)
def test_invalid_initial_value_prevents_the_start(start: Start, setting: str, reason: str) -> None:
    """The node says why."""
    assert reason in refused_at_start(start, setting)


def test_initial_value_out_of_range_prevents_the_start(
    packages: NodePackages, start: Start
) -> None:
    """The client library rejects it with its own message."""
    assert packages.out_of_range["scale"] in refused_at_start(start, "scale:=2.5")


@pytest.mark.essential
def test_service_is_answered_and_sigterm_ends_the_node(start: Start, ros_peer: Peer) -> None:
    """An empty service handler returns an empty response; SIGTERM ends with 0."""
    from std_srvs.srv import Trigger

    with start("differential_odometry", "odometry_node") as process:
        client = ros_peer.node.create_client(Trigger, "/reset")
        assert ros_peer.call(client, Trigger.Request()) == Trigger.Response()
        assert ros_peer.call(client, Trigger.Request()) == Trigger.Response()
        code, output = stop(process, signal.SIGTERM)
    assert (code, "Traceback" in output) == (0, False), output
    assert output.count("handle_reset does nothing yet") == 1


# Lifecycle nodes, actions -------------------------------------------------------------------------


def test_lifecycle_node_is_idle_until_activated(start: Start, ros_peer: Peer) -> None:
    """Handlers and publishers of a lifecycle node work only while it is active."""
    from lifecycle_msgs.msg import Transition
    from lifecycle_msgs.srv import ChangeState
    from std_msgs.msg import Bool

    with start("process", "valve") as process:
        client = ros_peer.node.create_client(ChangeState, "/valve/change_state")

        def change(transition: int) -> bool:
            request = ChangeState.Request(transition=Transition(id=transition))
            return bool(ros_peer.call(client, request).success)

        states: list[bool] = []
        ros_peer.node.create_subscription(Bool, "/state", lambda msg: states.append(msg.data), 10)
        command = ros_peer.node.create_publisher(Bool, "/command", 10)
        ros_peer.until(
            lambda: command.get_subscription_count() and ros_peer.node.count_publishers("/state")
        )
        command.publish(Bool(data=True))  # has no effect while inactive
        assert change(Transition.TRANSITION_CONFIGURE)
        assert change(Transition.TRANSITION_ACTIVATE)
        command.publish(Bool(data=False))
        ros_peer.until(lambda: states)
        assert states == [False]
        assert "on_report does nothing yet" in read_line(process)  # from the handler of the timer
        assert change(Transition.TRANSITION_DEACTIVATE)
        code, output = stop(process, signal.SIGINT)
    assert (code, "Traceback" in output) == (0, False), output


def test_nodes_of_one_package_run_together(start: Start, ros_peer: Peer) -> None:
    """Both programs of a package run under their own names."""
    with start("chat", "talker"), start("chat", "listener"):
        names = ros_peer.until(
            lambda: {"talker", "listener"} <= set(ros_peer.node.get_node_names())
        )
    assert names


@pytest.mark.parametrize(("order", "outcome"), [(5, 0 + 1 + 2 + 3 + 4), (0, -1)])
def test_goal_runs_in_parallel_with_other_handlers(
    order: int, outcome: int, start: Start, ros_peer: Peer
) -> None:
    """A message is handled during a goal; a goal left open is aborted."""
    from std_msgs.msg import Empty, Int32

    with start("counting", "counter") as counter, start("counting", "asker") as asker:
        outcomes: list[int] = []
        ros_peer.node.create_subscription(
            Int32, "/outcome", lambda msg: outcomes.append(msg.data), 10
        )
        ask = ros_peer.node.create_publisher(Int32, "/ask", 10)
        release = ros_peer.node.create_publisher(Empty, "/release", 10)
        ros_peer.until(
            lambda: (
                ask.get_subscription_count()
                and release.get_subscription_count()
                and ros_peer.node.count_publishers("/outcome")
                and ros_peer.node.count_publishers("/count/_action/feedback")
                and ros_peer.node.count_subscribers("/count/_action/feedback")
            )
        )
        ask.publish(Int32(data=order))
        assert "feedback [0]" in read_line(asker)
        release.publish(Empty())
        ros_peer.until(lambda: outcomes)
        assert outcomes == [outcome]
        for process in (counter, asker):
            code, output = stop(process, signal.SIGINT)
            assert (code, "Traceback" in output) == (0, False), output


# Ports of one name, parameters of every kind ------------------------------------------------------


def shown_by(peer: Peer, service: str) -> list[str]:
    """Return the reported parameters of the mapper."""
    from std_srvs.srv import Trigger

    client = peer.node.create_client(Trigger, service)
    words = str(peer.call(client, Trigger.Request()).message).split()
    peer.node.destroy_client(client)
    return words


def clients_of(peer: Peer, node: str) -> set[str]:
    """Return the services of which a node is known to have clients: none before its discovery."""
    from rclpy.node import NodeNameNonExistentError

    try:
        return {name for name, _ in peer.node.get_client_names_and_types_by_node(node, "/")}
    except NodeNameNonExistentError:
        return set()


def test_node_publishes_and_subscribes_to_one_name(start: Start, ros_peer: Peer) -> None:
    """Both ends follow the remapping of a topic, server and client that of a service."""
    from std_msgs.msg import String

    received: list[str] = []
    ros_peer.node.create_subscription(String, "/world", lambda m: received.append(m.data), 10)
    publisher = ros_peer.node.create_publisher(String, "/world", 10)
    rules = ("-r", "rostopic://map:=/world", "-r", "rosservice://map:=/show")
    with start("mapping", "mapper", "--ros-args", "-p", "needed:=1.0", *rules):
        ros_peer.until(lambda: ros_peer.node.count_subscribers("/world") == 2)
        ros_peer.until(lambda: publisher.get_subscription_count() == 2)
        publisher.publish(String(data="ping"))
        ros_peer.until(lambda: "pong" in received)
        assert shown_by(ros_peer, "/show")
        expected = {"/show", "/count", "/count/_action/send_goal"}
        ros_peer.until(lambda: expected <= clients_of(ros_peer, "mapper"))
        assert not ros_peer.node.count_publishers("/map")


def test_nan_infinity_and_special_names_arrive_from_a_parameter_file(
    start: Start, ros_peer: Peer, tmp_path: Path
) -> None:
    """The node has the values set by ``param``, and defaults otherwise."""
    system = """
        system Test imports import "*.rnd" topics topic /map
        node mapper : mapper
        parameters
          param offset = -inf
          param corners = [nan, inf, -1]
          param joints = ["wrist", "elbow"]
          param gains.wrist.p = inf
          param limits.elbow = [1, 2]
          param max-age./tf = -2
          param "3d" = false
          param needed = nan
        wirings connect map to /map
    """
    system_model = load_text(tmp_path, system, mapper=(MODELS / "mapper.rnd").read_text())
    file = tmp_path / "test.params.yaml"
    context = Context(InterfaceStore(), Repository())
    file.write_text(generate_params(system_model, context, {})[file.name].text)
    with start("mapping", "mapper", "--ros-args", "--params-file", str(file)):
        words = shown_by(ros_peer, "/map")
    expected = "inf -inf nan inf -1 elbow=1 wrist=inf elbow:2 wrist:0 -2 0"
    assert words == expected.split()


CONSTRAINTS: list[tuple[str, list[Any], str, list[Any]]] = [
    ("range.max", [0.0, float("nan"), -1.0], "range.max must be > 0.0", [1e-9, float("inf")]),
    ("corners", [[1.0]], "must have at least 2 elements", [[float("nan")] * 2]),
    ("corners", [[1.0] * 5], "must have at most 4 elements", [[1.0] * 4]),
    ("label", [""], "must not be empty", ["a"]),
    ("label", ["abcde", "öööö!"], "must have at most 4 characters", ["öööö"]),
    ("code", ["a", "abc", "ö"], "must have 2 characters", ["öä"]),
    ("levels", [[1, 2, 1]], "must have no element twice", [[3, 4]]),
    ("levels", [[6]], "must have all elements <= 5", [[5, -6]]),
    ("shares", [[0.5, 0.1, 0.5]], "must have no element twice", [[0.5, 0.1]]),
    ("shares", [[1.0], [float("nan")]], "must have all elements < 1.0", [[float("-inf")]]),
    ("teeth", [7], "teeth must be even", [8]),
    ("teeth", [102], "teeth must be small", [100]),
    ("teeth", [2], "", [4]),
    ("max-age./tf", [1.5, float("nan"), float("inf")], "must be < 1.5", [1.4999999, -1.0]),
    ("gains.elbow.p", [-1e-9, float("nan")], "gains.elbow.p must be >= 0.0", [0.0]),
    ("limits.elbow", [[1.0] * 3], "must have at most 2 elements", [[1.0, 2.0]]),
    ("joints", [["wrist"]], "read-only", []),
]
"""Parameter, rejected values, the reason, and accepted values."""


def test_each_constraint_is_enforced(start: Start, ros_peer: Peer) -> None:
    """A change is rejected with the reason, or accepted if all constraints hold."""
    with start("mapping", "mapper", "--ros-args", "-p", "needed:=1.0"):
        for parameter, refused, reason, accepted in CONSTRAINTS:
            for value in refused:
                (result,) = set_parameter(ros_peer, "mapper", **{parameter: value})
                assert not result.successful, (parameter, value)
                assert reason in result.reason or "range" in result.reason
            for value in accepted:
                (result,) = set_parameter(ros_peer, "mapper", **{parameter: value})
                assert result.successful, (parameter, value, result.reason)


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        ((), "needed"),
        (("needed:=1.0", 'label:=""'), "label"),
        (("needed:=1.0", "teeth:=13"), "teeth"),
        (("needed:=1.0", "gains.elbow.p:=-1.0"), "gains.elbow.p"),
        (("needed:=1.0", "joints:=[shoulder, knee]"), "joints"),
    ],
)
def test_invalid_initial_value_is_named(
    start: Start, arguments: tuple[str, ...], named: str
) -> None:
    """The program fails, and names the parameter."""
    given = [word for argument in arguments for word in ("-p", argument)]
    with start("mapping", "mapper", "--ros-args", *given) as process:
        output = process.communicate(timeout=LIMIT)[0]
    assert process.returncode != 0
    assert named in output
