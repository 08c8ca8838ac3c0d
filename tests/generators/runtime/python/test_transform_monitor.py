"""The transform monitor on real middleware: it publishes one transform out of many."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator, Sequence
from typing import Any

import pytest

from deros.generators.runtime.python.deros_runtime.process import run
from tests.support.built_interfaces import TRANSFORMS, known
from tests.support.needs import needs
from tests.support.ros import Peer, read_line, running

PROGRAM = f"{run.__module__.rpartition('.')[0]}.transform_monitor"

pytestmark = [pytest.mark.ros, needs("gcc")]


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, str]]:
    """Give what processes need to know the message, as this one does then."""
    with known(TRANSFORMS, tmp_path_factory.mktemp("transforms")) as variables:
        yield variables


@pytest.fixture
def env(built: dict[str, str], ros_env: dict[str, str]) -> dict[str, str]:
    """Give the environment of processes that know the message."""
    return ros_env | built


def command(*parameters: str) -> list[str]:
    """Return the command line of a monitor with some parameters."""
    words = [word for each in parameters for word in ("-p", each)]
    return [sys.executable, "-m", PROGRAM, "--ros-args", "-r", "__ns:=/base", *words]


def message(*transforms: tuple[str, str, float]) -> Any:
    """Return the message that broadcasts transforms: parent, child, and the distance ahead."""
    from geometry_msgs.msg import TransformStamped
    from tf2_msgs.msg import TFMessage

    stamped = []
    for parent, child, ahead in transforms:
        each = TransformStamped(child_frame_id=child)
        each.header.frame_id = parent
        each.header.stamp.sec = 7
        each.transform.translation.x = ahead
        stamped.append(each)
    return TFMessage(transforms=stamped)


def test_one_transform_is_published_out_of_many(env: dict[str, str], ros_peer: Peer) -> None:
    """Those of other frames are not, nor is one of the same frame in another: that is said."""
    from geometry_msgs.msg import TransformStamped
    from tf2_msgs.msg import TFMessage

    heard: list[tuple[str, str, int, float]] = []

    def listen(transform: Any) -> None:
        header = transform.header
        ahead = transform.transform.translation.x
        heard.append((header.frame_id, transform.child_frame_id, header.stamp.sec, ahead))

    node = ros_peer.node
    node.create_subscription(TransformStamped, "/base/transform", listen, 10)
    publisher = node.create_publisher(TFMessage, "/tf", 100)
    with running(command("parent:=odom", "child:=/base_link"), env) as monitor:
        ros_peer.until(lambda: publisher.get_subscription_count() == 1)
        ros_peer.until(lambda: node.count_publishers("/base/transform") == 1)
        publisher.publish(message(("map", "odom", 1.0), ("odom", "base_link", 2.0)))
        publisher.publish(message(("base_link", "laser", 3.0)))
        publisher.publish(message(("map", "base_link", 4.0), ("map", "base_link", 4.0)))
        publisher.publish(message(("/odom", "/base_link", 5.0), ("odom", "base_link", 6.0)))
        ros_peer.until(lambda: len(heard) == 3)
        publisher.publish(message(("earth", "base_link", 7.0)))
        assert "'base_link' is broadcast in 'map', too" in read_line(monitor)
        assert "'base_link' is broadcast in 'earth', too" in read_line(monitor), "said twice"
    assert heard == [
        ("odom", "base_link", 7, 2.0),
        ("/odom", "/base_link", 7, 5.0),
        ("odom", "base_link", 7, 6.0),
    ]


@pytest.mark.parametrize(
    ("parameters", "refusal"),
    [
        ((), "parameter 'parent' has to name a frame\n"),
        (("parent:=odom", "child:=/"), "parameter 'child' has to name a frame\n"),
    ],
)
def test_a_frame_without_a_name_is_refused(
    env: dict[str, str], parameters: Sequence[str], refusal: str
) -> None:
    """It would be silent for ever, which looks like a transform that is not broadcast."""
    done = subprocess.run(
        command(*parameters), env=env, capture_output=True, text=True, timeout=60, check=False
    )
    assert (done.returncode, done.stderr) == (1, refusal)
