"""The managed node leaver in either language: user transitions that fail as parameters say."""

from __future__ import annotations

import sys
from abc import ABC, abstractmethod
from collections.abc import Mapping
from pathlib import Path

from deros.generators.node.cpp.generate import generate as generate_cpp
from deros.generators.node.python.generate import generate as generate_python
from deros.generators.output.writer import write
from tests.support.breakers import CppBreaker, PythonBreaker
from tests.support.cpp import colcon_build, overlay, program
from tests.support.fill_in import fill_in, insert
from tests.support.node_packages import MODELS, model_of

TRANSITIONS = ("configure", "activate", "deactivate", "cleanup", "shutdown")


class Leaver(ABC):
    """The built package.

    Attributes:
        reasons: what is printed, by the way in which a handler fails.
        codes: the exit codes where it ends the program, likewise.
    """

    reasons: Mapping[str, str]
    codes: Mapping[str, int]

    @abstractmethod
    def command(self, env: dict[str, str]) -> tuple[list[str], dict[str, str]]:
        """Return what runs the program, and its environment."""


# Python -------------------------------------------------------------------------------------------

_PYTHON = '''"""The user's code."""

import sys

from leaving.leaver_base import LeaverBase, run
from rclpy.lifecycle import TransitionCallbackReturn
from std_msgs.msg import Empty


class Leaver(LeaverBase):
    def fail(self, place):
        if self.parameters.place != place:
            return TransitionCallbackReturn.SUCCESS
        if self.parameters.way == 'error':
            raise RuntimeError('broken on purpose')
        if self.parameters.way == 'exit':
            sys.exit(3)
        if self.parameters.way == 'odd':
            raise KeyboardInterrupt('broken on purpose')
        if self.parameters.way == 'ERROR':
            return TransitionCallbackReturn.ERROR
        return TransitionCallbackReturn.FAILURE

    def on_poke(self, msg):
        self.fail('topic')

    def on_tick(self):
        self.fail('timer')
        self.publish_echo(Empty())

    def handle_ask(self, request, response):
        self.publish_echo(Empty())
        return response
'''
_PYTHON_HOOK = """
    def on_{name}(self, state):
        super().on_{name}(state)
        return self.fail('{name}')
"""
_PYTHON_DEACTIVATE = """
    def on_deactivate(self, state):
        result = self.fail('deactivate')
        if result == TransitionCallbackReturn.SUCCESS:
            super().on_deactivate(state)
        return result
"""


class PythonLeaver(Leaver):
    """The package in Python, run where it was written."""

    reasons = PythonBreaker.reasons
    codes = PythonBreaker.codes

    def __init__(self, workspace: Path) -> None:
        """Generate the package into a workspace, and fill it in."""
        model, context = model_of(MODELS / "leaver.rnd")
        write(generate_python(model, context, {}), workspace)
        self._root = workspace / "leaving"
        hooks = (_PYTHON_HOOK.format(name=n) for n in TRANSITIONS if n != "deactivate")
        code = (
            _PYTHON,
            *hooks,
            _PYTHON_DEACTIVATE,
            "\n\nif __name__ == '__main__':\n    run(Leaver)\n",
        )
        (self._root / "leaving/leaver.py").write_text("".join(code))

    def command(self, env: dict[str, str]) -> tuple[list[str], dict[str, str]]:
        """Return what runs the program, and its environment."""
        path = f"{self._root}:{env.get('PYTHONPATH', '')}"
        return [sys.executable, "-m", "leaving.leaver"], {**env, "PYTHONPATH": path}


# C++ ----------------------------------------------------------------------------------------------

_CPP_FAIL = """
Leaver::CallbackReturn Leaver::fail(const std::string & place) const
{
  if (parameters()->place != place) {
    return CallbackReturn::SUCCESS;
  }
  if (parameters()->way == "error") {
    throw std::runtime_error("broken on purpose");
  }
  if (parameters()->way == "exit") {
    std::exit(3);
  }
  if (parameters()->way == "odd") {
    throw 7;
  }
  return parameters()->way == "ERROR" ? CallbackReturn::ERROR : CallbackReturn::FAILURE;
}
"""
_CPP_HOOK = """
Leaver::CallbackReturn Leaver::on_{name}(const rclcpp_lifecycle::State & state)
{{
  LeaverBase::on_{name}(state);
  return fail("{name}");
}}
"""
_CPP_DEACTIVATE = """
Leaver::CallbackReturn Leaver::on_deactivate(const rclcpp_lifecycle::State & state)
{
  const CallbackReturn result = fail("deactivate");
  return result == CallbackReturn::SUCCESS ? LeaverBase::on_deactivate(state) : result;
}

"""


class CppLeaver(Leaver):
    """The package in C++."""

    reasons = CppBreaker.reasons
    codes = CppBreaker.codes

    def __init__(self, workspace: Path) -> None:
        """Generate the package into a workspace, fill it in, and build it."""
        model, context = model_of(MODELS / "leaver.rnd")
        write(generate_cpp(model, context, {}), workspace)
        declared = "".join(
            f"  CallbackReturn on_{name}(const rclcpp_lifecycle::State & state) override;\n"
            for name in TRANSITIONS
        )
        fail = "  CallbackReturn fail(const std::string & place) const;\n"
        header = workspace / "leaving/include/leaving/leaver.hpp"
        insert(header, "};", f"\npublic:\n{fail}{declared}")
        insert(header, "#include", "#include <string>\n\n")
        source = workspace / "leaving/src/leaver.cpp"
        echo = "  publish_echo(std_msgs::msg::Empty());\n"
        fill_in(source, "on_poke", '\n  fail("topic");\n')
        fill_in(source, "on_tick", f'\n  fail("timer");\n{echo}')
        fill_in(source, "handle_ask", f"\n{echo}")
        hooks = (_CPP_HOOK.format(name=n) for n in TRANSITIONS if n != "deactivate")
        insert(source, "}  // namespace", "".join((_CPP_FAIL, *hooks, _CPP_DEACTIVATE)))
        source.write_text("#include <cstdlib>\n#include <stdexcept>\n" + source.read_text())
        self._install = colcon_build(workspace)

    def command(self, env: dict[str, str]) -> tuple[list[str], dict[str, str]]:
        """Return what runs the program, and its environment."""
        return [program(self._install, "leaving", "leaver")], overlay(self._install, env)
