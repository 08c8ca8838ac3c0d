"""The packages of the node descriptions in either language, built, with a user's code in them."""

from __future__ import annotations

import ast
import re
import subprocess
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from pathlib import Path

from deros.generators.api.protocol import Context, GenerateFunction
from deros.generators.node.cpp.generate import generate as generate_cpp
from deros.generators.node.python.generate import generate as generate_python
from deros.generators.output.writer import write
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.node import NodeType
from tests.support.builds import colcon
from tests.support.cpp import colcon_build, overlay, program
from tests.support.fill_in import fill_in, insert
from tests.support.ros import running

_TESTS = Path(__file__).resolve().parent.parent / "generators"
MODELS = _TESTS / "node/python/models"
PICKY = _TESTS / "node/cpp/models/picky.rnd"
"""A node whose parameters are as strict as they can be."""

Start = Callable[..., AbstractContextManager[subprocess.Popen[str]]]
"""Runs a program: its package, its name, its arguments."""


def model_of(path: Path) -> tuple[NodeType, Context]:
    """Return the model of a node description, and the context to generate in."""
    context = Context(InterfaceStore(), Repository())
    loaded = context.repository.load(path)
    assert loaded.diagnostics == ()
    assert isinstance(loaded.model, NodeType)
    return loaded.model, context


class NodePackages(ABC):
    """Five packages or more, with handlers that do the same in each language.

    Attributes:
        out_of_range: what the client library says of a value out of range, by the parameter's name.
    """

    out_of_range: Mapping[str, str]

    @abstractmethod
    def command(
        self, package: str, name: str, env: dict[str, str]
    ) -> tuple[list[str], dict[str, str]]:
        """Return what runs a program, and ``env`` as the setup.sh of the install space makes it."""

    @abstractmethod
    def share(self, package: str) -> Path:
        """Return the folder of a package's data."""

    def starting(self, env: dict[str, str]) -> Start:
        """Return a function that runs the programs in ``env``."""

        def run(
            package: str, name: str, *arguments: str
        ) -> AbstractContextManager[subprocess.Popen[str]]:
            command, own = self.command(package, name, env)
            return running([*command, *arguments], own)

        return run


def _write(generate: GenerateFunction, folder: Path, *others: Path) -> None:
    """Write the packages of the models that both languages have, and of further ones."""
    names = ("odometry_node", "valve", "talker", "counter", "mapper")
    for path in (*(MODELS / f"{name}.rnd" for name in names), *others):
        model, context = model_of(path)
        write(generate(model, context, {}), folder)


# Python -------------------------------------------------------------------------------------------

_PYTHON_ON_TICKS = """
    def on_ticks(self, msg: Int32) -> None:
        from nav_msgs.msg import Odometry
        odometry = Odometry()
        odometry.pose.pose.position.x = msg.data * self.parameters.scale
        self.publish_odom(odometry)

    def on_parameters_changed(self, previous: object) -> None:
        self.get_logger().info(f'scale was {previous.scale:g} and is {self.parameters.scale:g}')
"""
_PYTHON_ON_COMMAND = """
    def on_command(self, msg: Bool) -> None:
        self.publish_state(msg)
"""
_PYTHON_ON_RELEASE = """
    def on_release(self, msg: Empty) -> None:
        self.released.set()
"""
_PYTHON_EXECUTE_COUNT = """
    import threading
    released = threading.Event()

    def execute_count(self, goal_handle: ServerGoalHandle) -> Fibonacci.Result:
        # It blocks this thread, as a user's loop may. Feedback that arrives before the client knows
        # that the goal was accepted is lost, so it is repeated.
        while not self.released.wait(0.02):
            goal_handle.publish_feedback(Fibonacci.Feedback(sequence=[0]))
        if goal_handle.request.order > 0:
            goal_handle.succeed()
        return Fibonacci.Result(sequence=list(range(goal_handle.request.order)))
"""
_PYTHON_ON_ASK = """
    def on_ask(self, msg: Int32) -> None:
        from action_msgs.msg import GoalStatus
        from std_msgs.msg import Int32
        from test_msgs.action import Fibonacci

        def accepted(future):
            future.result().get_result_async().add_done_callback(done)

        def done(future):
            response = future.result()
            aborted = response.status == GoalStatus.STATUS_ABORTED
            self.publish_outcome(Int32(data=sum(response.result.sequence) - aborted))

        def feedback(message):
            self.get_logger().info(f'feedback {list(message.feedback.sequence)}')

        self.client_count.wait_for_server()
        future = self.send_count(Fibonacci.Goal(order=msg.data), feedback)
        future.add_done_callback(accepted)
"""
_PYTHON_ON_MAP = """
    def on_map(self, msg: String) -> None:
        if msg.data == 'ping':
            self.publish_map(String(data='pong'))
"""
_PYTHON_ON_TARGET = """
    def on_target(self, entry: str, msg: String) -> None:
        self.publish_map(String(data=f'{entry}: {msg.data}'))
"""
_PYTHON_HANDLE_MAP = """
    def handle_map(
        self,
        request: Trigger.Request,
        response: Trigger.Response,
    ) -> Trigger.Response:
        now = self.parameters
        texts = [f'{now.range_max:g}', f'{now.offset:g}', *(f'{x:g}' for x in now.corners)]
        texts += [f'{joint}={now.gains[joint].p:g}' for joint in sorted(now.gains)]
        texts += [f'{joint}:{len(now.limits[joint])}' for joint in sorted(now.limits)]
        response.message = ' '.join([*texts, f'{now.max_age_tf:g}', str(int(now._3d))])
        return response
"""
_PYTHON_CHECKS = {
    "limits": """
from rclpy.parameter import Parameter


def is_even(parameter: Parameter) -> str:
    return 'must be even' if parameter.value % 2 else ''
""",
    "checks": """
from rclpy.parameter import Parameter


def small(parameter: Parameter) -> str:
    return 'must be small' if parameter.value > 100 else ''
""",
}


class PythonPackages(NodePackages):
    """The packages in Python, each in a folder of the install space once it is asked for."""

    out_of_range: Mapping[str, str] = {
        "ticks_per_turn": "Parameter ticks_per_turn out of range",
        "scale": "Parameter scale out of range",
    }

    def __init__(self, workspace: Path) -> None:
        """Generate the packages into a workspace, and fill them in."""
        self._workspace = workspace
        source = workspace / "src"
        _write(generate_python, source)
        odometry = source / "differential_odometry/differential_odometry/odometry_node.py"
        _replace_method(odometry, "on_ticks", _PYTHON_ON_TICKS)
        _replace_method(source / "process/process/valve.py", "on_command", _PYTHON_ON_COMMAND)
        counting = source / "counting/counting"
        _replace_method(counting / "counter.py", "on_release", _PYTHON_ON_RELEASE)
        _replace_method(counting / "counter.py", "execute_count", _PYTHON_EXECUTE_COUNT)
        _replace_method(counting / "asker.py", "on_ask", _PYTHON_ON_ASK)
        mapping = source / "mapping/mapping"
        _replace_method(mapping / "mapper.py", "on_map", _PYTHON_ON_MAP)
        _replace_method(mapping / "mapper.py", "on_target", _PYTHON_ON_TARGET)
        _replace_method(mapping / "mapper.py", "handle_map", _PYTHON_HANDLE_MAP)
        for module, text in _PYTHON_CHECKS.items():
            (mapping / f"{module}.py").write_text(text)

    def _built(self, package: str) -> Path:
        """Return the prefix of a package, which is built if it is not yet."""
        prefix = self._workspace / "install" / package
        if not prefix.exists():
            done = colcon(self._workspace, "--packages-select", package)
            assert done.returncode == 0, done.stdout
            assert "1 package finished" in done.stdout
        return prefix

    def command(
        self, package: str, name: str, env: dict[str, str]
    ) -> tuple[list[str], dict[str, str]]:
        """Return what runs a program, and its environment."""
        prefix = self._built(package)
        (site,) = prefix.glob("lib/python*/site-packages")
        path = f"{prefix}:{env['AMENT_PREFIX_PATH']}"
        own = {**env, "PYTHONPATH": str(site), "AMENT_PREFIX_PATH": path}
        return [str(prefix / "lib" / package / name)], own

    def share(self, package: str) -> Path:
        """Return the folder of a package's data."""
        return self._built(package) / "share" / package


def _replace_method(path: Path, handler: str, code: str) -> None:
    """Do a user's work: replace one handler."""
    lines = path.read_text().splitlines()
    functions = (f for f in ast.walk(ast.parse("\n".join(lines))) if isinstance(f, ast.FunctionDef))
    (found,) = (f for f in functions if f.name == handler)
    lines[found.lineno - 1 : found.end_lineno] = code.strip("\n").splitlines()
    path.write_text("\n".join([*lines, ""]))


# C++ ----------------------------------------------------------------------------------------------

_CPP_ON_TICKS = """
  nav_msgs::msg::Odometry odometry;
  odometry.pose.pose.position.x = msg.data * parameters()->scale;
  publish_odom(odometry);
"""
_CPP_ON_PARAMETERS_CHANGED = """
void OdometryNode::on_parameters_changed(const Parameters & previous)
{
  RCLCPP_INFO(get_logger(), "scale was %g and is %g", previous.scale, parameters()->scale);
}
"""
_CPP_ON_COMMAND = """
  publish_state(msg);
"""
_CPP_ON_RELEASE = """
  released_.set_value();
"""
_CPP_EXECUTE_COUNT = """
  auto feedback = std::make_shared<test_msgs::action::Fibonacci::Feedback>();
  feedback->sequence = {0};
  // It blocks this thread, as a user's loop may. Feedback that arrives before the client knows
  // that the goal was accepted is lost, so it is repeated.
  auto released = released_.get_future();
  while (released.wait_for(std::chrono::milliseconds(20)) == std::future_status::timeout) {
    goal_handle.publish_feedback(feedback);
  }
  auto result = std::make_shared<test_msgs::action::Fibonacci::Result>();
  for (int32_t i = 0; i < goal_handle.get_goal()->order; ++i) {
    result->sequence.push_back(i);
  }
  if (goal_handle.get_goal()->order > 0) {
    goal_handle.succeed(result);
  }
"""
_CPP_ON_CHATTER = """
  throw std::runtime_error("cannot bear " + msg.data);
"""
_CPP_ON_ASK = """
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
_CPP_ON_MAP = """
  if (msg.data == "ping") {
    std_msgs::msg::String answer;
    answer.data = "pong";
    publish_map(answer);
  }
"""
_CPP_ON_TARGET = """
  std_msgs::msg::String answer;
  answer.data = entry + ": " + msg.data;
  publish_map(answer);
"""
_CPP_HANDLE_MAP = """
  const auto now = parameters();
  std::ostringstream text;
  text << now->range_max << " " << now->offset;
  for (const double x : now->corners) {
    text << " " << x;
  }
  for (const auto & [joint, gains] : now->gains) {
    text << " " << joint << "=" << gains.p;
  }
  for (const auto & [joint, limits] : now->limits) {
    text << " " << joint << ":" << limits.size();
  }
  text << " " << now->max_age_tf << " " << now->x3d;
  response.message = text.str();
"""


class CppPackages(NodePackages):
    """The packages in C++, and that of the picky node, in one install space.

    The listener throws what it cannot bear.
    """

    out_of_range: Mapping[str, str] = {
        "ticks_per_turn": "doesn't comply with integer range",
        "scale": "doesn't comply with floating point range",
    }

    def __init__(self, source: Path) -> None:
        """Generate the packages into a folder, fill them in, and build them."""
        _write(generate_cpp, source, PICKY)
        odometry = source / "differential_odometry"
        fill_in(odometry / "src/odometry_node.cpp", "on_ticks", _CPP_ON_TICKS)
        insert(odometry / "src/odometry_node.cpp", "}  // namespace", _CPP_ON_PARAMETERS_CHANGED)
        hook = "  void on_parameters_changed(const Parameters & previous) override;\n"
        header = odometry / "include/differential_odometry/odometry_node.hpp"
        insert(header, "  void on_ticks", hook)
        fill_in(source / "process/src/valve.cpp", "on_command", _CPP_ON_COMMAND)
        fill_in(source / "chat/src/listener.cpp", "on_chatter", _CPP_ON_CHATTER)
        counting = source / "counting"
        header = counting / "include/counting/counter.hpp"
        insert(header, "};", "  std::promise<void> released_;\n")
        insert(header, "#include", "#include <chrono>\n#include <future>\n\n")
        fill_in(counting / "src/counter.cpp", "on_release", _CPP_ON_RELEASE)
        fill_in(counting / "src/counter.cpp", "execute_count", _CPP_EXECUTE_COUNT)
        fill_in(counting / "src/asker.cpp", "on_ask", _CPP_ON_ASK)
        mapper = source / "mapping/src/mapper.cpp"
        fill_in(mapper, "on_map", _CPP_ON_MAP)
        fill_in(mapper, "on_target", _CPP_ON_TARGET)
        fill_in(mapper, "handle_map", _CPP_HANDLE_MAP)
        insert(mapper, "#include", "#include <sstream>\n")
        for name, condition in (("limits", "% 2 != 0"), ("checks", "> 100")):
            path = source / f"mapping/src/{name}.cpp"
            text = path.read_text().replace("/*parameter*/", "parameter")
            word = "even" if name == "limits" else "small"
            code = f'return parameter.as_int() {condition} ? "must be {word}" : "";'
            path.write_text(re.sub(r"return [^;]*;", code, text))
        self.install = colcon_build(source)

    def command(
        self, package: str, name: str, env: dict[str, str]
    ) -> tuple[list[str], dict[str, str]]:
        """Return what runs a program, and its environment."""
        return [program(self.install, package, name)], overlay(self.install, env)

    def share(self, package: str) -> Path:
        """Return the folder of a package's data."""
        return self.install / "share" / package
