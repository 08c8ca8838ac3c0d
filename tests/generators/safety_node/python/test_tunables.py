"""A safety node with tunable constants, on the real middleware."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest

from deros.generators.output.writer import write
from deros.generators.runtime.interface import PYTHON_RUNTIME, with_runtime
from deros.generators.safety_package.cpp import generate as safety_cpp
from deros.generators.safety_package.python import generate as safety_python
from tests.support.generating import output_of
from tests.support.ros import LIMIT, Peer, running

MODELS = Path(__file__).with_name("models")
RULES = """use "robot.system" import Robot
action stop publishes true on /stop : std_msgs.Bool;
input speed = topic /speed.data [m/s] timeout 100 sec
const limit = 50 cm/s tunable in [0.1, 1] m/s "Greatest speed near people"
entity drive { fast: speed > limit; gone: speed.missing(); }
behaviour slow: if drive.fast or drive.gone then { stop; };
"""
NODE = "tuned_safety_node"


def command(folder: Path, env: dict[str, str], limit: str) -> tuple[list[str], dict[str, str]]:
    """Generate the node, and return what runs it with a limit."""
    files = output_of(safety_python.generate, MODELS / "tuned.deros", RULES)
    write(with_runtime(files), folder)
    path = f"{folder / 'tuned_safety'}:{folder / PYTHON_RUNTIME}"
    arguments = ["--ros-args", "-p", f"limit:={limit}"] if limit else []
    return [sys.executable, "-m", f"tuned_safety.{NODE}", *arguments], {**env, "PYTHONPATH": path}


@pytest.mark.ros
@pytest.mark.parametrize(
    ("limit", "reason"),
    [
        ("9.9", "out of range"),
        ("100.1", "out of range"),
        (".nan", "limit"),
        ("50", "expecting type 'DOUBLE'"),
        ("fast", "expecting type 'DOUBLE'"),
    ],
)
def test_wrong_value_prevents_the_start(
    limit: str, reason: str, ros_env: dict[str, str], tmp_path: Path
) -> None:
    """A value outside the interval, NaN or another type: the node says why, and ends."""
    words, env = command(tmp_path, ros_env, limit)
    with running(words, env) as process:
        output, _ = process.communicate(timeout=LIMIT)
    assert process.returncode == 1
    assert reason in output


@pytest.mark.ros
def test_value_is_a_fixed_parameter_that_reports_show(
    ros_env: dict[str, str], ros_peer: Peer, tmp_path: Path
) -> None:
    """The parameter is described; the rule's status and its cause have the value that is set."""
    from diagnostic_msgs.msg import DiagnosticArray
    from rcl_interfaces.srv import DescribeParameters
    from std_msgs.msg import Float64

    shown: dict[str, dict[str, str]] = {}

    def take(message: Any) -> None:
        for status in message.status:
            shown[status.name] = {each.key: each.value for each in status.values}

    node = ros_peer.node
    node.create_subscription(DiagnosticArray, "/diagnostics", take, 10)
    speed = node.create_publisher(Float64, "/speed", 10)
    client = node.create_client(DescribeParameters, f"/{NODE}/describe_parameters")
    words, env = command(tmp_path, ros_env, "40.0")
    with running(words, env):
        ros_peer.until(client.service_is_ready)
        answer = ros_peer.call(client, DescribeParameters.Request(names=["limit"]))
        (described,) = answer.descriptors
        ros_peer.until(lambda: speed.get_subscription_count())
        speed.publish(Float64(data=0.45))
        status = f"/{NODE}: drive.fast"
        ros_peer.until(lambda: "cause" in shown.get(status, {}))
    assert described.read_only
    assert described.description == "Greatest speed near people [cm/s]"
    (ends,) = described.floating_point_range
    assert (ends.from_value, ends.to_value, ends.step) == (10.0, 100.0, 0.0)
    assert shown[status]["cause"] == "speed 0.45 m/s > limit 40.0 cm/s"
    assert shown[status]["limit"] == "40.0"


def test_node_in_cpp_hands_its_parameters_to_the_monitor() -> None:
    """It does not run with a value that the monitor refuses."""
    files = output_of(safety_cpp.generate, MODELS / "tuned.deros", RULES)
    (text,) = (each.text for path, each in files.items() if str(path).endswith(f"src/{NODE}.cpp"))
    assert "#include <stdexcept>" in text
    assert (
        "  const auto chosen = parameters();\n"
        "  tuned_constants constants = tuned_default_constants;\n"
        "  constants.limit = chosen->limit;\n"
        "  if (!tuned_start(&memory_->monitor, this, start, grace, &constants)) {\n"
        '    throw std::invalid_argument("a tunable constant is outside its interval");\n'
        "  }\n"
    ) in text
