"""Generated packages build with colcon, and their nodes run from the install space."""

from __future__ import annotations

import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from deros.generators.protocol import Context
from deros.generators.rosnode_cpp.generate import generate
from deros.generators.rosnode_python.generate import generate as generate_python
from deros.generators.writer import write
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.metamodels.node import NodeType
from tests.support.cpp import colcon_build, needs_rclcpp, overlay, program
from tests.support.ros import LIMIT, Peer, running, set_parameter, stop

pytestmark = [pytest.mark.ros, needs_rclcpp]

SHARED = Path(__file__).resolve().parents[1] / "rosnode_python/models"
OWN = Path(__file__).resolve().parent / "models"

ON_TICKS = """
  nav_msgs::msg::Odometry odometry;
  odometry.pose.pose.position.x = msg.data * parameters()->scale;
  publish_odom(odometry);
"""
ON_PARAMETERS_CHANGED = """
void OdometryNode::on_parameters_changed(const Parameters & previous)
{
  RCLCPP_INFO(get_logger(), "scale was %g and is %g", previous.scale, parameters()->scale);
}
"""
ON_COMMAND = """
  publish_state(msg);
"""
ON_RELEASE = """
  released_.set_value();
"""
EXECUTE_COUNT = """
  auto feedback = std::make_shared<test_msgs::action::Fibonacci::Feedback>();
  feedback->sequence = {0};
  goal_handle.publish_feedback(feedback);
  released_.get_future().wait();  // blocks this thread, as a user's loop may
  auto result = std::make_shared<test_msgs::action::Fibonacci::Result>();
  for (int32_t i = 0; i < goal_handle.get_goal()->order; ++i) {
    result->sequence.push_back(i);
  }
  if (goal_handle.get_goal()->order > 0) {
    goal_handle.succeed(result);
  }
"""
ON_CHATTER = """
  throw std::runtime_error("cannot bear " + msg.data);
"""
ON_ASK = """
  rclcpp_action::Client<test_msgs::action::Fibonacci>::SendGoalOptions options;
  options.feedback_callback = [this](const auto &, const auto & feedback) {
      RCLCPP_INFO(get_logger(), "feedback [%d]", feedback->sequence.at(0));
    };
  options.result_callback = [this](const auto & wrapped) {
      std_msgs::msg::Int32 sum;
      for (const int32_t each : wrapped.result->sequence) {
        sum.data += each;
      }
      sum.data += wrapped.code == rclcpp_action::ResultCode::ABORTED ? -1 : 0;
      publish_outcome(sum);
    };
  client_count_->wait_for_action_server();
  test_msgs::action::Fibonacci::Goal goal;
  goal.order = msg.data;
  send_count(goal, options);
"""


def model_of(path: Path) -> tuple[NodeType, Context]:
    """Return the model of a node description, and the context to generate in."""
    context = Context(InterfaceStore(), Repository())
    loaded = context.repository.load(path)
    assert loaded.diagnostics == ()
    assert isinstance(loaded.model, NodeType)
    return loaded.model, context


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the install space of a workspace with the generated packages, some of them filled in."""
    source = tmp_path_factory.mktemp("workspace")
    for path in (
        *(SHARED / f"{name}.rnd" for name in ("odometry_node", "valve", "talker", "counter")),
        OWN / "picky.rnd",
    ):
        model, context = model_of(path)
        write(generate(model, context, {}), source)
    odometry = source / "differential_odometry"
    _fill_in(odometry / "src/odometry_node.cpp", "on_ticks", ON_TICKS)
    _insert(odometry / "src/odometry_node.cpp", "}  // namespace", ON_PARAMETERS_CHANGED)
    hook = "  void on_parameters_changed(const Parameters & previous) override;\n"
    _insert(odometry / "include/differential_odometry/odometry_node.hpp", "  void on_ticks", hook)
    _fill_in(source / "process/src/valve.cpp", "on_command", ON_COMMAND)
    _fill_in(source / "chat/src/listener.cpp", "on_chatter", ON_CHATTER)
    counting = source / "counting"
    _insert(counting / "include/counting/counter.hpp", "};", "  std::promise<void> released_;\n")
    _insert(counting / "include/counting/counter.hpp", "#include", "#include <future>\n\n")
    _fill_in(counting / "src/counter.cpp", "on_release", ON_RELEASE)
    _fill_in(counting / "src/counter.cpp", "execute_count", EXECUTE_COUNT)
    _fill_in(counting / "src/asker.cpp", "on_ask", ON_ASK)
    return colcon_build(source)


def _fill_in(path: Path, handler: str, code: str) -> None:
    """Do a user's work: fill one handler."""
    pattern = rf"(::{handler}\([^{{]*)\{{\n.*?\n\}}"

    def filled(match: re.Match[str]) -> str:
        used = re.sub(r"/\*(\w+)\*/", lambda n: n[1] if n[1] in code else n[0], match[1])
        return f"{used}{{{code}}}"

    text, count = re.subn(pattern, filled, path.read_text(), count=1, flags=re.DOTALL)
    assert count == 1
    path.write_text(text)


def _insert(path: Path, before: str, text: str) -> None:
    old = path.read_text()
    assert before in old
    path.write_text(old.replace(before, text.removeprefix("\n") + before, 1))


Start = Callable[..., Any]


@pytest.fixture
def start(installed: Path, ros_env: dict[str, str]) -> Start:
    """Give a function that runs a program of the install space, as its setup.sh would have it."""

    def run(package: str, name: str, *arguments: str) -> Any:
        env = overlay(installed, ros_env)
        return running([program(installed, package, name), *arguments], env)

    return run


# Messages, services, parameters -------------------------------------------------------------------


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
            "ticks_per_turn": (0, "doesn't comply with integer range"),
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
    assert code == 0, output
    assert output.count("scale was 1 and is 2") == 1
    assert output.count("on_control does nothing yet") == 1


def test_parameters_set_together_are_checked_together(start: Start, ros_peer: Peer) -> None:
    """One bad value in an atomic request leaves all parameters as they were."""
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


@pytest.mark.parametrize(
    ("package", "node", "model"),
    [
        ("differential_odometry", "odometry_node", SHARED / "odometry_node.rnd"),
        ("fussy", "picky", OWN / "picky.rnd"),
    ],
)
def test_parameters_are_those_of_the_python_node(
    package: str,
    node: str,
    model: Path,
    start: Start,
    ros_peer: Peer,
    ros_env: dict[str, str],
    tmp_path: Path,
) -> None:
    """Names, values and descriptors that can be asked for do not tell the two targets apart."""
    loaded, context = model_of(model)
    write(generate_python(loaded, context, {}), tmp_path)
    script = f"from {package}.{node} import main; main()"
    env = {**ros_env, "PYTHONPATH": str(tmp_path / package)}
    names = [parameter.name for parameter in loaded.parameters]
    with start(package, node):
        cpp = _told(ros_peer, node, names)
    ros_peer.until(lambda: node not in ros_peer.node.get_node_names())
    with running([sys.executable, "-c", script], env):
        python = _told(ros_peer, node, names)
    for parameter in loaded.parameters:
        (descriptor, value), (other, other_value) = (n[parameter.name] for n in (cpp, python))
        assert descriptor == other
        # rclpy cannot declare an empty sequence with a value; rclcpp can.
        assert parameter.default == () or value == other_value


def _told(peer: Peer, node: str, names: list[str]) -> dict[str, Any]:
    """Return descriptor and value of each parameter, as the services of a node tell them."""
    from rcl_interfaces.srv import DescribeParameters, GetParameters

    peer.until(lambda: node in peer.node.get_node_names())
    describe = peer.node.create_client(DescribeParameters, f"/{node}/describe_parameters")
    get = peer.node.create_client(GetParameters, f"/{node}/get_parameters")
    descriptors = peer.call(describe, DescribeParameters.Request(names=names)).descriptors
    # One by one: rclpy answers nothing at all if one of the parameters has no value.
    values = [list(peer.call(get, GetParameters.Request(names=[n])).values) for n in names]
    peer.node.destroy_client(describe)
    peer.node.destroy_client(get)
    return dict(zip(names, zip(descriptors, values, strict=True), strict=True))


def test_parameters_at_start_come_from_the_file(
    start: Start, ros_peer: Peer, installed: Path
) -> None:
    """The generated parameter file is read, and the topic's name follows its parameter."""
    config = installed / "share/differential_odometry/config/odometry_node.yaml"
    arguments = ["--ros-args", "--params-file", str(config), "-p", "imu_topic:=/other_imu"]
    with start("differential_odometry", "odometry_node", *arguments):
        ros_peer.until(lambda: ros_peer.node.count_subscribers("/other_imu"))
        assert ros_peer.node.count_subscribers("/fmInformation/imu") == 0


def test_an_empty_topic_parameter_leaves_the_ports_own_name(start: Start, ros_peer: Peer) -> None:
    """A port whose parameter holds no name keeps the one of the node description."""
    arguments = ["--ros-args", "-p", "imu_topic:=''"]
    with start("differential_odometry", "odometry_node", *arguments):
        ros_peer.until(lambda: ros_peer.node.count_subscribers("/imu"))


@pytest.mark.parametrize(
    ("setting", "reason"),
    [
        ("scale:=2.5", "range"),
        ("gains:=[1.0, 2.0]", "gains must have 3 elements"),
        ("mode:=idle", "mode must be one of 'auto', 'manual'"),
        ("scale:=fast", "scale"),
    ],
)
def test_a_bad_value_at_start_is_refused(start: Start, setting: str, reason: str) -> None:
    """A node that is given a forbidden value does not start, and says why."""
    with start("differential_odometry", "odometry_node", "--ros-args", "-p", setting) as node:
        output, _ = node.communicate(timeout=LIMIT)
    assert node.returncode == 1, output
    assert reason in output


def test_arguments_that_ros_cannot_read_are_refused(start: Start) -> None:
    """A remapping with no meaning ends the program with a reason, not with an abort."""
    with start("chat", "talker", "--ros-args", "-r", "nonsense") as node:
        output, _ = node.communicate(timeout=LIMIT)
    assert node.returncode == 1, output
    assert "nonsense" in output


def test_a_service_is_answered_and_sigterm_ends_the_node(start: Start, ros_peer: Peer) -> None:
    """An unfilled service handler answers with an empty response; SIGTERM ends with 0."""
    from std_srvs.srv import Trigger

    with start("differential_odometry", "odometry_node") as process:
        client = ros_peer.node.create_client(Trigger, "/reset")
        assert ros_peer.call(client, Trigger.Request()) == Trigger.Response()
        assert ros_peer.call(client, Trigger.Request()) == Trigger.Response()
        code, output = stop(process, signal.SIGTERM)
    assert code == 0, output
    assert output.count("handle_reset does nothing yet") == 1


def test_what_a_handler_throws_ends_the_program(start: Start, ros_peer: Peer) -> None:
    """An exception that nobody catches is told, and the program fails without an abort."""
    from std_msgs.msg import String

    with start("chat", "listener") as process:
        publisher = ros_peer.node.create_publisher(String, "/chatter", 10)
        ros_peer.until(publisher.get_subscription_count)
        publisher.publish(String(data="noise"))
        output, _ = process.communicate(timeout=LIMIT)
    assert process.returncode == 1, output
    assert "cannot bear noise" in output


# Managed nodes, actions, components ---------------------------------------------------------------


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
        assert "on_report does nothing yet" in process.stdout.readline()  # the timer's handler
        assert change(Transition.TRANSITION_DEACTIVATE)
        code, output = stop(process, signal.SIGINT)
    assert code == 0, output


@pytest.mark.parametrize("value", [float("inf"), float("-inf"), float("nan"), 1.001])
def test_no_number_passes_a_range(value: float, start: Start, ros_peer: Peer) -> None:
    """What rclcpp's own check of a range lets pass, infinity and NaN, is refused all the same."""
    with start("process", "valve"):
        ros_peer.until(lambda: "valve" in ros_peer.node.get_node_names())
        (result,) = set_parameter(ros_peer, "valve", opening=value)
    assert not result.successful


@pytest.mark.parametrize(("order", "outcome"), [(5, 0 + 1 + 2 + 3 + 4), (0, -1)])
def test_a_goal_runs_beside_the_other_handlers(
    order: int, outcome: int, start: Start, ros_peer: Peer
) -> None:
    """A message reaches the server while a goal is pursued; a goal left open is aborted."""
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
        assert "feedback [0]" in asker.stdout.readline()
        release.publish(Empty())
        ros_peer.until(lambda: outcomes)
        assert outcomes == [outcome]
        for process in (counter, asker):
            code, output = stop(process, signal.SIGINT)
            assert code == 0, output


@pytest.mark.skipif(shutil.which("ros2") is None, reason="no command ros2")
def test_nodes_are_components(installed: Path, ros_env: dict[str, str], ros_peer: Peer) -> None:
    """Two nodes of one package run in one process, one of them under another name."""
    from std_srvs.srv import Trigger

    env = overlay(installed, ros_env)
    (prefix,) = (p for p in env["AMENT_PREFIX_PATH"].split(":") if (Path(p) / CONTAINER).exists())
    with running([f"{prefix}/{CONTAINER}", "--ros-args", "-r", "__node:=box"], env) as process:
        ros_peer.until(lambda: _serves(ros_peer, "/box/_container/load_node"))
        _load(env, "chat", "chat::Talker")
        _load(env, "chat", "chat::Listener", "--node-name", "ear")
        _load(env, "differential_odometry", "differential_odometry::OdometryNode")
        ros_peer.until(lambda: {"talker", "ear"} <= set(ros_peer.node.get_node_names()))
        client = ros_peer.node.create_client(Trigger, "/reset")
        assert ros_peer.call(client, Trigger.Request()) == Trigger.Response()
        code, output = stop(process, signal.SIGINT)
    assert code == 0, output


CONTAINER = "lib/rclcpp_components/component_container"


def _serves(peer: Peer, name: str) -> bool:
    return any(service == name for service, _ in peer.node.get_service_names_and_types())


def _load(env: dict[str, str], package: str, plugin: str, *options: str) -> None:
    """Load a component into the container /box, as soon as the command has discovered it."""
    command = ["ros2", "component", "load", "--no-daemon", "--spin-time", "1", *options]
    end = time.monotonic() + 2 * LIMIT
    while True:
        done = subprocess.run(
            [*command, "/box", package, plugin],
            env=env,
            capture_output=True,
            text=True,
            timeout=LIMIT,
            check=False,
        )
        if "Unable to find" not in done.stderr or time.monotonic() > end:
            break
    assert done.returncode == 0, done.stdout + done.stderr
