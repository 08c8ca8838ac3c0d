"""The node breaker in either language: user code that fails where and how its parameters say."""

from __future__ import annotations

import sys
from abc import ABC, abstractmethod
from collections.abc import Mapping
from pathlib import Path

from deros.generators.node.cpp.generate import generate as generate_cpp
from deros.generators.node.python.generate import generate as generate_python
from deros.generators.output.writer import write
from tests.support.cpp import colcon_build, overlay, program
from tests.support.fill_in import fill_in, insert
from tests.support.node_packages import MODELS, model_of

STUBBORN = 1
"""The order of a goal that never returns."""

USUAL = 2
"""The order of one that checks for the end of ROS 2, as in tutorials, not for that of its goal."""


class Breaker(ABC):
    """The built package.

    Attributes:
        reasons: what is printed, by the way in which a handler fails.
        codes: the exit codes, likewise.
        goes_on: the ways in which a goal can fail without ending the node.
    """

    reasons: Mapping[str, str]
    codes: Mapping[str, int]
    goes_on: tuple[str, ...]

    @abstractmethod
    def command(self, env: dict[str, str]) -> tuple[list[str], dict[str, str]]:
        """Return what runs the program, and its environment."""


# Python -------------------------------------------------------------------------------------------

_PYTHON = '''"""The user's code."""

import sys
import time

from breaking.breaker_base import BreakerBase, run
import rclpy
from rclpy.action import CancelResponse, GoalResponse
from std_msgs.msg import Empty
from test_msgs.action import Fibonacci


class Breaker(BreakerBase):
    max_goals = 4

    def __init__(self):
        super().__init__()
        self.fail('constructor')

    def fail(self, place):
        if self.parameters.place == place:
            if self.parameters.way == 'error':
                raise RuntimeError('broken on purpose')
            if self.parameters.way == 'exit':
                sys.exit(3)
            raise KeyboardInterrupt('broken on purpose')

    def on_poke(self, msg):
        self.fail('topic')
        self.publish_echo(msg)

    def on_tick(self):
        self.fail('timer')

    def handle_ask(self, request, response):
        self.fail('service')
        return response

    def on_parameters_changed(self, previous):
        self.fail('parameters')

    def accept_count(self, goal):
        self.fail('accept')
        return GoalResponse.ACCEPT

    def cancel_count(self, goal_handle):
        self.fail('cancel')
        return CancelResponse.ACCEPT

    def execute_count(self, goal_handle):
        self.fail('execute')
        order = goal_handle.request.order
        while order == 1:
            time.sleep(0.01)
        while order == 2 and rclpy.ok() and not goal_handle.is_cancel_requested:
            goal_handle.publish_feedback(Fibonacci.Feedback(sequence=[0]))
            time.sleep(0.01)
        while goal_handle.is_active and not goal_handle.is_cancel_requested:
            goal_handle.publish_feedback(Fibonacci.Feedback(sequence=[0]))
            time.sleep(0.01)
        if goal_handle.is_cancel_requested:
            goal_handle.canceled()
        return Fibonacci.Result()


if __name__ == '__main__':
    run(Breaker)
'''


class PythonBreaker(Breaker):
    """The package in Python, run where it was written."""

    reasons: Mapping[str, str] = {
        "error": "broken on purpose",
        "exit": "",
        "odd": "broken on purpose",
    }
    codes: Mapping[str, int] = {
        "error": 1,
        "exit": 3,
        "odd": -2,
    }  # an uncaught interrupt, to Python
    goes_on = ("error",)

    def __init__(self, workspace: Path) -> None:
        """Generate the package into a workspace, and fill it in."""
        model, context = model_of(MODELS / "breaker.rnd")
        write(generate_python(model, context, {}), workspace)
        self._root = workspace / "breaking"
        (self._root / "breaking/breaker.py").write_text(_PYTHON)

    def command(self, env: dict[str, str]) -> tuple[list[str], dict[str, str]]:
        """Return what runs the program, and its environment."""
        path = f"{self._root}:{env.get('PYTHONPATH', '')}"
        return [sys.executable, "-m", "breaking.breaker"], {**env, "PYTHONPATH": path}


# C++ ----------------------------------------------------------------------------------------------

_CPP_MEMBERS = """
public:
  ~Breaker() override;
  void fail(const std::string & place) const;
  void on_parameters_changed(const Parameters & previous) override;
  std::size_t max_goals() const override;
  rclcpp_action::GoalResponse accept_count(
    const test_msgs::action::Fibonacci::Goal & goal) override;
  rclcpp_action::CancelResponse cancel_count(
    const rclcpp_action::ServerGoalHandle<test_msgs::action::Fibonacci> & goal_handle) override;
  std::vector<int> used_ = std::vector<int>(1000, 1);
"""
_CPP_CODE = """
Breaker::~Breaker()
{
  if (parameters()->place == "destructor") {
    fail("destructor");
  }
  used_.assign(1000, 0);
}

void Breaker::fail(const std::string & place) const
{
  if (parameters()->place == place) {
    if (parameters()->way == "error") {
      throw std::runtime_error("broken on purpose");
    }
    if (parameters()->way == "exit") {
      std::exit(3);
    }
    throw 7;
  }
}

void Breaker::on_parameters_changed(const Parameters & /*previous*/)
{
  fail("parameters");
}

std::size_t Breaker::max_goals() const
{
  return 4;
}

rclcpp_action::GoalResponse Breaker::accept_count(
  const test_msgs::action::Fibonacci::Goal & /*goal*/)
{
  fail("accept");
  return rclcpp_action::GoalResponse::ACCEPT_AND_EXECUTE;
}

rclcpp_action::CancelResponse Breaker::cancel_count(
  const rclcpp_action::ServerGoalHandle<test_msgs::action::Fibonacci> & /*goal_handle*/)
{
  fail("cancel");
  return rclcpp_action::CancelResponse::ACCEPT;
}

"""
_CPP_EXECUTE = """
  fail("execute");
  const auto result = std::make_shared<test_msgs::action::Fibonacci::Result>();
  const auto feedback = std::make_shared<test_msgs::action::Fibonacci::Feedback>();
  const int order = goal_handle.get_goal()->order;
  const std::chrono::milliseconds pause(10);
  while (order == 1) {
    std::this_thread::sleep_for(pause);
  }
  while (order == 2 && rclcpp::ok() && !goal_handle.is_canceling()) {
    goal_handle.publish_feedback(feedback);
    rclcpp::sleep_for(pause);
  }
  while (goal_handle.is_executing()) {
    goal_handle.publish_feedback(feedback);
    std::this_thread::sleep_for(pause);
    for (int & each : used_) {
      ++each;
    }
  }
  if (goal_handle.is_canceling()) {
    goal_handle.canceled(result);
  }
"""


class CppBreaker(Breaker):
    """The package in C++."""

    _odd = "threw what is not a std::exception"
    reasons: Mapping[str, str] = {
        "error": "broken on purpose",
        "exit": "exit() was called",
        "odd": _odd,
    }
    codes: Mapping[str, int] = {"error": 1, "exit": 1, "odd": 1}
    goes_on = ("error", "odd")

    def __init__(self, workspace: Path) -> None:
        """Generate the package into a workspace, fill it in, and build it."""
        self.install = colcon_build(cpp_breaker(workspace))

    def command(self, env: dict[str, str]) -> tuple[list[str], dict[str, str]]:
        """Return what runs the program, and its environment."""
        return [program(self.install, "breaking", "breaker")], overlay(self.install, env)


def cpp_breaker(workspace: Path) -> Path:
    """Generate the package in C++ into a workspace, fill it in, and return the workspace."""
    model, context = model_of(MODELS / "breaker.rnd")
    write(generate_cpp(model, context, {}), workspace)
    header = workspace / "breaking/include/breaking/breaker.hpp"
    insert(header, "};", _CPP_MEMBERS)
    insert(header, "#include", "#include <string>\n#include <vector>\n\n")
    source = workspace / "breaking/src/breaker.cpp"
    fill_in(source, "on_poke", '\n  fail("topic");\n  publish_echo(msg);\n')
    fill_in(source, "on_tick", '\n  fail("timer");\n')
    fill_in(source, "handle_ask", '\n  fail("service");\n')
    fill_in(source, "execute_count", _CPP_EXECUTE)
    text = source.read_text().replace("(options)\n{\n}", '(options)\n{\n  fail("constructor");\n}')
    includes = "#include <chrono>\n#include <cstdlib>\n#include <stdexcept>\n#include <thread>\n"
    source.write_text(includes + text)
    insert(source, "}  // namespace", _CPP_CODE)
    return workspace
