"""Generated packages build with colcon, and their nodes run from the install space."""

from __future__ import annotations

import ast
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from deros.generators.protocol import Context
from deros.generators.rosnode_python.generate import generate
from deros.generators.writer import write
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.metamodels.node import NodeType
from tests.support.ros import LIMIT, Peer, running, set_parameter, stop

pytestmark = pytest.mark.ros

MODELS = Path(__file__).resolve().parent / "models"

TICKS_TO_ODOMETRY = """
    def on_ticks(self, msg: Int32) -> None:
        from nav_msgs.msg import Odometry
        odometry = Odometry()
        odometry.pose.pose.position.x = msg.data * self.parameters.scale
        self.publish_odom(odometry)

    def on_parameters_changed(self, previous: object) -> None:
        self.get_logger().info(f'scale is {self.parameters.scale}')
"""
COMMAND_TO_STATE = """
    def on_command(self, msg: Bool) -> None:
        self.publish_state(msg)
"""
RELEASE = """
    def on_release(self, msg: Empty) -> None:
        self.released.set()
"""
COUNT = """
    import threading
    released = threading.Event()

    def execute_count(self, goal_handle: ServerGoalHandle) -> Fibonacci.Result:
        goal_handle.publish_feedback(Fibonacci.Feedback(sequence=[0]))
        self.released.wait()  # blocks this thread, as a user's loop may
        goal_handle.succeed()
        return Fibonacci.Result(sequence=list(range(goal_handle.request.order)))
"""
ASK = """
    def on_ask(self, msg: Int32) -> None:
        from std_msgs.msg import Int32
        from test_msgs.action import Fibonacci

        def accepted(future):
            future.result().get_result_async().add_done_callback(done)

        def done(future):
            self.publish_outcome(Int32(data=sum(future.result().result.sequence)))

        def feedback(message):
            self.get_logger().info(f'feedback {list(message.feedback.sequence)}')

        self.client_count.wait_for_server()
        future = self.send_count(Fibonacci.Goal(order=msg.data), feedback)
        future.add_done_callback(accepted)
"""


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the install space of a workspace with the generated packages."""
    workspace = tmp_path_factory.mktemp("workspace")
    for name in ("odometry_node", "valve", "talker", "counter"):
        context = Context(InterfaceStore(), Repository())
        model = context.repository.load(MODELS / f"{name}.rnd").model
        assert isinstance(model, NodeType)
        write(generate(model, context, {}), workspace / "src")
    source = workspace / "src/differential_odometry/differential_odometry/odometry_node.py"
    _fill_in(source, "on_ticks", TICKS_TO_ODOMETRY)
    _fill_in(workspace / "src/process/process/valve.py", "on_command", COMMAND_TO_STATE)
    counting = workspace / "src/counting/counting"
    _fill_in(counting / "counter.py", "on_release", RELEASE)
    _fill_in(counting / "counter.py", "execute_count", COUNT)
    _fill_in(counting / "asker.py", "on_ask", ASK)
    env = {**os.environ, "AMENT_PREFIX_PATH": sys.prefix}
    colcon = str(Path(sys.executable).with_name("colcon"))
    command = [colcon, "--log-base", "log", "build", "--executor", "sequential"]
    done = subprocess.run(
        command, cwd=workspace, env=env, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "4 packages finished" in done.stdout
    return workspace / "install"


def _fill_in(path: Path, handler: str, code: str) -> None:
    """Do a user's work: replace one handler."""
    lines = path.read_text().splitlines()
    functions = (f for f in ast.walk(ast.parse("\n".join(lines))) if isinstance(f, ast.FunctionDef))
    (found,) = (f for f in functions if f.name == handler)
    lines[found.lineno - 1 : found.end_lineno] = code.strip("\n").splitlines()
    path.write_text("\n".join([*lines, ""]))


Start = Callable[..., Any]


@pytest.fixture
def start(installed: Path, ros_env: dict[str, str]) -> Start:
    """Give a function that runs a program of the install space, as setup.sh would have it."""

    def run(package: str, program: str, *arguments: str) -> Any:
        prefix = installed / package
        (site,) = prefix.glob("lib/python*/site-packages")
        env = {
            **ros_env,
            "PYTHONPATH": str(site),
            "AMENT_PREFIX_PATH": f"{prefix}:{ros_env['AMENT_PREFIX_PATH']}",
        }
        return running([str(prefix / "lib" / package / program), *arguments], env)

    return run


def odometry_for(peer: Peer, count: int) -> Callable[[], float]:
    """Return a function that sends a count and waits for the position that comes back."""
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


def test_messages_parameters_and_the_end(start: Start, ros_peer: Peer) -> None:
    """The node answers a message, refuses bad parameters with a reason, and ends with 0."""
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
            "ticks_per_turn": (0, "Parameter ticks_per_turn out of range"),
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
    assert "scale is 2.0" in output
    assert "on_control does nothing yet" in output


def test_descriptors_tell_what_a_parameter_is(start: Start, ros_peer: Peer) -> None:
    """Description with unit, range and constraints can be asked for at run time."""
    from rcl_interfaces.msg import ParameterType
    from rcl_interfaces.srv import DescribeParameters

    with start("differential_odometry", "odometry_node"):
        client = ros_peer.node.create_client(
            DescribeParameters, "/odometry_node/describe_parameters"
        )
        names = ["wheel_base", "scale", "mode", "frames", "pid.lambda"]
        found = ros_peer.call(client, DescribeParameters.Request(names=names)).descriptors
    wheel_base, scale, mode, frames, bytes_ = found
    assert wheel_base.description == "Distance between the wheels [m]"
    assert wheel_base.read_only
    (bounds,) = wheel_base.floating_point_range
    assert (bounds.from_value, bounds.to_value) == (0.1, 2.0)
    assert scale.additional_constraints == "must lie in (0.0, 2.0]"
    assert mode.additional_constraints == "must be one of 'auto', 'manual'"
    assert frames.type == ParameterType.PARAMETER_STRING_ARRAY
    assert bytes_.type == ParameterType.PARAMETER_BYTE_ARRAY


def test_parameters_at_start_come_from_the_file(
    start: Start, ros_peer: Peer, installed: Path
) -> None:
    """The generated parameter file is read, and the topic's name follows its parameter."""
    config = (
        installed / "differential_odometry/share/differential_odometry/config/odometry_node.yaml"
    )
    arguments = ["--ros-args", "--params-file", str(config), "-p", "imu_topic:=/other_imu"]
    with start("differential_odometry", "odometry_node", *arguments):
        ros_peer.until(lambda: ros_peer.node.count_subscribers("/other_imu"))
        assert ros_peer.node.count_subscribers("/fmInformation/imu") == 0


def test_a_bad_value_at_start_is_refused(start: Start) -> None:
    """A node that is given a forbidden value does not start, and says why."""
    with start("differential_odometry", "odometry_node", "--ros-args", "-p", "scale:=2.5") as node:
        output, _ = node.communicate(timeout=LIMIT)
    assert node.returncode != 0
    assert "out of range" in output


def test_a_service_is_answered_and_sigterm_ends_the_node(start: Start, ros_peer: Peer) -> None:
    """An unfilled service handler answers with an empty response; SIGTERM ends with 0."""
    from std_srvs.srv import Trigger

    with start("differential_odometry", "odometry_node") as process:
        client = ros_peer.node.create_client(Trigger, "/reset")
        assert ros_peer.call(client, Trigger.Request()) == Trigger.Response()
        code, output = stop(process, signal.SIGTERM)
    assert (code, "Traceback" in output) == (0, False), output


def test_a_managed_node_rests_until_activated(start: Start, ros_peer: Peer) -> None:
    """Handlers and publishers of a lifecycle node work while it is active, and only then."""
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
        command.publish(Bool(data=True))  # nobody acts on this one
        assert change(Transition.TRANSITION_CONFIGURE)
        assert change(Transition.TRANSITION_ACTIVATE)
        command.publish(Bool(data=False))
        ros_peer.until(lambda: states)
        assert states == [False]
        assert change(Transition.TRANSITION_DEACTIVATE)
        code, output = stop(process, signal.SIGINT)
    assert (code, "Traceback" in output) == (0, False), output


def test_nodes_of_one_package_share_it(start: Start, ros_peer: Peer) -> None:
    """Both programs of a package run, each under its own name."""
    with start("chat", "talker"), start("chat", "listener"):
        names = ros_peer.until(
            lambda: {"talker", "listener"} <= set(ros_peer.node.get_node_names())
        )
    assert names


def test_a_goal_runs_beside_the_other_handlers(start: Start, ros_peer: Peer) -> None:
    """A client node sends a goal; a message still reaches the server while it is pursued."""
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
        ask.publish(Int32(data=5))
        line = asker.stdout.readline()
        assert "feedback [0]" in line
        release.publish(Empty())
        ros_peer.until(lambda: outcomes)
        assert outcomes == [0 + 1 + 2 + 3 + 4]
        for process in (counter, asker):
            code, output = stop(process, signal.SIGINT)
            assert (code, "Traceback" in output) == (0, False), output
