"""``deros import --live``: what runs is what the models say."""

from __future__ import annotations

import math
import sys
from pathlib import Path

import pytest

from deros.interfaces.durations import NS_PER_S
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.node import NodeType
from deros.models.qos import Policies
from tests.support.checks import checked
from tests.support.imported import Described, described
from tests.support.ros import read_line, running
from tests.support.shell import deros_at

PROGRAM = str(Path(__file__).resolve().parent.parent / "support" / "graph_program.py")

USUAL = Policies()
LATCHED = Policies(durability="transient_local")
SENSOR = Policies(reliability="best_effort")
WATCHED = Policies(
    deadline=NS_PER_S // 4,
    lifespan=2 * NS_PER_S,
    liveliness="manual_by_topic",
    lease=3 * NS_PER_S // 2,
)


def lidar(side: str, rate: float) -> Described:
    """Return the lidar of a side, as its program makes it."""
    return Described(
        {
            ("publisher", f"/{side}/scan", "sensor_msgs/msg/LaserScan"): SENSOR,
            ("publisher", f"/{side}/lidar/health", "std_msgs/msg/String"): LATCHED,
            ("subscriber", "/stop", "std_msgs/msg/Bool"): LATCHED,
            ("service", f"/{side}/lidar/enable", "std_srvs/srv/SetBool"): None,
        },
        {"rate": ("double", rate), "frame_id": ("string", f"{side}_lidar")},
    )


PILOT = Described(
    {
        ("publisher", "/stop", "std_msgs/msg/Bool"): LATCHED,
        ("publisher", "/beat", "std_msgs/msg/Bool"): WATCHED,
        ("subscriber", "/left/scan", "sensor_msgs/msg/LaserScan"): SENSOR,
        ("subscriber", "/right/scan", "sensor_msgs/msg/LaserScan"): SENSOR,
        ("subscriber", "/nobody", "std_msgs/msg/String"): USUAL,
        ("client", "/left/lidar/enable", "std_srvs/srv/SetBool"): None,
        ("client", "/elsewhere", "std_srvs/srv/Trigger"): None,
        ("action_client", "/count", "test_msgs/action/Fibonacci"): None,
    },
    {
        "on": ("bool", True),
        "steps": ("integer", 4),
        "text": ("string", 'a "text" of ${two}\nlines \\ with a tab\t'),
        "bytes": ("byte[]", (0, 255)),
        "bools": ("bool[]", (True, False)),
        "integers": ("integer[]", (-1, 2**40)),
        "doubles": ("double[]", (0.1, math.inf, -1e-7)),
        "texts": ("string[]", ("", "x, y")),
        "qos_overrides./beat.publisher.depth": ("integer", 3),
    },
)
"""What its program makes but ``no_value``. No graph shows depths, so they are the usual ones."""

GRAPH = {
    "/left/lidar": lidar("left", 10.0),
    "/right/lidar": lidar("right", 12.5),
    "/pilot": PILOT,
    "/far/away/counter": Described({("action", "/count", "test_msgs/action/Fibonacci"): None}, {}),
    "/crane": Described({("publisher", "/crane/load", "std_msgs/msg/String"): USUAL}, {}),
}


@pytest.mark.ros
@pytest.mark.essential
def test_models_say_what_runs(ros_env: dict[str, str], tmp_path: Path) -> None:
    """Every node, end, type, QoS and parameter is in the flat system, and no finding."""
    folder = tmp_path / "models"
    with running([sys.executable, PROGRAM], ros_env) as program:
        assert read_line(program) == "up\n"
        outcome = deros_at(ros_env, "import", "--live", "-o", str(folder))
        again = deros_at(ros_env, "import", "--live", "-o", str(folder))
    assert (outcome.code, outcome.err) == (1, "")
    assert described(folder / "robot.system") == GRAPH
    assert checked(folder / "robot.system", store=InterfaceStore()) == []
    assert outcome.out.splitlines()[-5:-1] == [
        "not in the models:",
        "  /far/away/counter has no parameter services: its parameters are not known",
        "  /pilot: parameter no_value is left out: it has no value",
        "  /pilot: parameter steps goes in steps of 2",
    ]
    # The first import has left nothing behind in the graph.
    assert "wrote" not in again.out


def _type(folder: Path, name: str) -> NodeType:
    model = Repository().load(folder / "nodes" / f"{name}.rnd").model
    assert isinstance(model, NodeType)
    return model


@pytest.mark.ros
def test_descriptors_and_states_are_imported(ros_env: dict[str, str], tmp_path: Path) -> None:
    """Ranges, descriptions and read-only parameters; two nodes of one kind share a type."""
    with running([sys.executable, PROGRAM, "left", "right", "crane"], ros_env) as program:
        assert read_line(program) == "up\n"
        outcome = deros_at(ros_env, "import", "--live", "-o", str(tmp_path), "--name", "yard")
    assert (outcome.code, outcome.err) == (0, "")
    names = {path.name for path in (tmp_path / "nodes").iterdir()}
    assert names == {"lidar.rnd", "crane.rnd"}
    kind = _type(tmp_path, "lidar")
    rate, frame = kind.parameter("rate"), kind.parameter("frame_id")
    assert rate is not None
    assert frame is not None
    assert rate.interval is not None
    assert (rate.interval.lower, rate.interval.upper) == (0.5, 40.0)
    assert (rate.description, rate.read_only) == ('Turns a second, "nominal"', False)
    assert (frame.description, frame.read_only) == ("Of the scans", True)
    assert [port.name for port in kind.ports] == ["~/health", "scan", "/stop", "~/enable"]
    assert _type(tmp_path, "crane").lifecycle
    text = (tmp_path / "yard.system").read_text(encoding="utf-8")
    assert "node crane : crane  // it was inactive\n" in text


@pytest.mark.ros
def test_part_of_a_graph_has_its_other_ends_outside(
    ros_env: dict[str, str], tmp_path: Path
) -> None:
    """With a pattern and a domain of its own, only those nodes are there, without findings."""
    env = ros_env | {"ROS_DOMAIN_ID": "0"}
    with running([sys.executable, PROGRAM], ros_env) as program:
        assert read_line(program) == "up\n"
        options = ["--node", "/left/*", "--domain", ros_env["ROS_DOMAIN_ID"]]
        outcome = deros_at(env, "import", "--live", "-o", str(tmp_path), *options)
    assert (outcome.code, outcome.err) == (0, "")
    assert described(tmp_path / "robot.system") == {"/left/lidar": lidar("left", 10.0)}
    assert checked(tmp_path / "robot.system", store=InterfaceStore()) == []


@pytest.mark.ros
def test_empty_domain_is_no_import(ros_env: dict[str, str], tmp_path: Path) -> None:
    """Nothing is written."""
    folder = str(tmp_path / "out")
    outcome = deros_at(ros_env, "import", "--live", "--timeout", "1", "-o", folder)
    assert (outcome.code, outcome.out) == (2, "")
    assert outcome.err == "deros: no node was found within 1 s (see ROS_DOMAIN_ID)\n"
    assert not (tmp_path / "out").exists()
