"""A running graph that is watched: what lasts is reported, and what a restart does is not."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from deros.interfaces.durations import NS_PER_S
from deros.live.looks import snapshot
from deros.live.observer import Observer
from deros.live.verify import restarts, watching
from deros.live.verify.differences import Kind
from deros.live.verify.expectation import expectation
from deros.live.verify.texts import event_line
from deros.live.verify.watching import Watch
from deros.systems.flatten import flatten
from tests.support.imported import import_into
from tests.support.processes import freeze, thaw
from tests.support.ros import LIMIT, Peer, read_line, running, set_parameter
from tests.support.shell import DEROS
from tests.support.systems import load

PROGRAM = str(Path(__file__).resolve().parents[2] / "support" / "graph_program.py")
LEFT = [sys.executable, PROGRAM, "left"]
ALL_BUT_PEER = "/[!t]*"
LONG = 1000 * NS_PER_S


@pytest.fixture
def observer(ros_env: dict[str, str], ros_peer: Peer) -> Iterator[Observer]:
    """Give an observer in the domain of the test, started after the peer, which is seen, too."""
    del ros_peer
    with Observer(int(ros_env["ROS_DOMAIN_ID"])) as found:
        yield found


class Watched:
    """A watch of the graph as it is, and what it has reported."""

    def __init__(
        self,
        observer: Observer,
        folder: Path,
        graces_ns: dict[Kind, int],
        brought_up: str = "",
        pattern: str = ALL_BUT_PEER,
    ) -> None:
        """Start it with a model that is made of the graph, with ``autostart`` at one node."""
        first = snapshot(observer, pattern, timeout=LIMIT)
        import_into(folder, first)
        if brought_up:
            system = folder / "robot.system"
            text = system.read_text(encoding="utf-8")
            node = f"node {brought_up} : {brought_up}"
            assert text.count(node) == 1
            system.write_text(text.replace(node, f"{node} autostart"), encoding="utf-8")
        expected = expectation(flatten(load(folder / "robot.system")), ignored=["/test_peer"])
        self.watch = Watch(observer, expected, first, graces_ns)
        self.lines: list[str] = []

    def turn(self) -> None:
        """Look once more."""
        for event in self.watch.turn():
            text = event_line(event).split("  (")[0]
            start, back, rest = text.partition(" s: ")
            self.lines.append(f"back: {rest}" if back else start)

    def until(self, *lines: str) -> None:
        """Look until these lines, and no others, have been reported since the last call."""
        deadline = time.monotonic() + LIMIT
        while len(self.lines) < len(lines) and time.monotonic() < deadline:
            self.turn()
        assert sorted(self.lines) == sorted(lines)
        self.lines.clear()

    def until_seen(self, name: str, *, is_there: bool) -> None:
        """Look until a node is there with its parameters, or is gone; nothing is reported."""
        deadline = time.monotonic() + LIMIT
        while (name in self.known()) != is_there:
            assert time.monotonic() < deadline
            self.turn()
        assert self.lines == []

    def known(self) -> set[str]:
        """Return the nodes whose parameters are known."""
        seen = self.watch.seen.nodes
        return {each.full_name for each in seen if each.parameters is not None}


@pytest.mark.ros
def test_restart_within_the_grace_is_not_reported(
    ros_env: dict[str, str], observer: Observer, tmp_path: Path
) -> None:
    """The node is gone, and comes back end by end: nothing. With no grace, it is reported."""
    with running(LEFT, ros_env) as left:
        assert read_line(left) == "up\n"
        patient = Watched(observer, tmp_path / "a", dict.fromkeys(Kind, LONG))
        left.send_signal(signal.SIGINT)
        left.wait(LIMIT)
        patient.until_seen("/left/lidar", is_there=False)
    with running(LEFT, ros_env) as again:
        assert read_line(again) == "up\n"
        patient.until_seen("/left/lidar", is_there=True)
        patient.watch.close()
        eager = Watched(observer, tmp_path / "b", {Kind.MISSING_NODE: 0})
        again.send_signal(signal.SIGINT)
        eager.until("missing-node /left/lidar")
    with running(LEFT, ros_env) as once_more:
        assert read_line(once_more) == "up\n"
        eager.until("back: missing-node /left/lidar")
    eager.watch.close()


@pytest.mark.ros
def test_node_that_starts_again_and_again_is_reported(
    ros_env: dict[str, str],
    observer: Observer,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """However patient one is with nodes that are missing."""
    monkeypatch.setattr(restarts, "WITHIN_S", 1000)
    with running(LEFT, ros_env) as left:
        assert read_line(left) == "up\n"
        patient = dict.fromkeys(Kind, LONG) | {Kind.RESTARTING_NODE: 0}
        watched = Watched(observer, tmp_path, patient)
        watched.turn()
        left.send_signal(signal.SIGINT)
        watched.until_seen("/left/lidar", is_there=False)
    for _ in range(restarts.MOST):
        with running(LEFT, ros_env) as again:
            watched.until_seen("/left/lidar", is_there=True)
            again.send_signal(signal.SIGINT)
            watched.until_seen("/left/lidar", is_there=False)
    with running(LEFT, ros_env):
        watched.until("restarting-node /left/lidar: more than 2 starts within 1000 s")
    watched.watch.close()


@pytest.mark.ros
def test_changes_of_a_living_node_are_reported(
    ros_env: dict[str, str], ros_peer: Peer, observer: Observer, tmp_path: Path
) -> None:
    """Values at once, by the events of parameters; ends and nodes by looking; then their ends."""
    from sensor_msgs.msg import LaserScan

    domain = int(ros_env["ROS_DOMAIN_ID"])
    with running(LEFT, ros_env) as left:
        assert read_line(left) == "up\n"
        watched = Watched(observer, tmp_path, dict.fromkeys(Kind, 0))
        assert set_parameter(ros_peer, "left/lidar", rate=20.0)[0].successful
        wrong = "wrong-value /left/lidar, rate: 20.0 in place of 10.0"
        watched.until(wrong)
        assert set_parameter(ros_peer, "left/lidar", rate=10.0)[0].successful
        watched.until(f"back: {wrong}")
        joker = Peer(domain, "joker")
        watched.until("extra-node /joker")
        joker.node.create_subscription(LaserScan, "/left/scan", lambda _: None, 1)
        less = "best_effort instead of reliable (/left/lidar)"
        lost = f"not-connected /joker, subscriber /left/scan: {less}"
        watched.until(lost)
        joker.close()
        watched.until("back: extra-node /joker", f"back: {lost}")
        watched.watch.close()


@pytest.mark.ros
def test_state_of_a_managed_node_is_followed(
    ros_env: dict[str, str], ros_peer: Peer, observer: Observer, tmp_path: Path
) -> None:
    """It has to be active; when somebody activates it, it is."""
    from lifecycle_msgs.msg import Transition
    from lifecycle_msgs.srv import ChangeState

    with running([sys.executable, PROGRAM, "crane"], ros_env) as crane:
        assert read_line(crane) == "up\n"
        watched = Watched(observer, tmp_path, dict.fromkeys(Kind, 0), brought_up="crane")
        wrong = "wrong-state /crane: inactive in place of active"
        watched.until(wrong)
        client = ros_peer.node.create_client(ChangeState, "/crane/change_state")
        up = Transition(id=Transition.TRANSITION_ACTIVATE)
        assert ros_peer.call(client, ChangeState.Request(transition=up)).success
        watched.until(f"back: {wrong}")
        watched.watch.close()


@pytest.mark.ros
def test_change_that_no_message_tells_of_is_found_in_its_turn(
    ros_env: dict[str, str],
    ros_peer: Peer,
    observer: Observer,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The events of parameters are lost: the node is asked for its values all the same."""
    monkeypatch.setattr(watching, "ASK_S", 0.1)
    monkeypatch.setattr(Watch, "_listen", lambda _: None)
    with running(LEFT, ros_env) as left:
        assert read_line(left) == "up\n"
        watched = Watched(observer, tmp_path, dict.fromkeys(Kind, 0))
        wrong = "wrong-value /left/lidar, rate: 20.0 in place of 10.0"
        for _ in range(2):  # once for all of it, and once for the values alone
            assert set_parameter(ros_peer, "left/lidar", rate=20.0)[0].successful
            watched.until(wrong)
            assert set_parameter(ros_peer, "left/lidar", rate=10.0)[0].successful
            watched.until(f"back: {wrong}")
        watched.watch.close()


@pytest.mark.ros
def test_end_with_another_qos_under_the_same_name_is_found(
    ros_env: dict[str, str], observer: Observer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The names of all ends are those of before."""
    from rclpy.qos import qos_profile_sensor_data
    from std_msgs.msg import Bool

    joker = Peer(int(ros_env["ROS_DOMAIN_ID"]), "joker")
    try:
        old = joker.node.create_publisher(Bool, "~/card", 1)
        graces = dict.fromkeys(Kind, LONG) | {Kind.WRONG_QOS: 0}
        watched = Watched(observer, tmp_path, graces, pattern="/joker")
        joker.node.destroy_publisher(old)
        joker.node.create_publisher(Bool, "~/card", qos_profile_sensor_data)
        monkeypatch.setattr(watching, "QOS_S", 0.1)
        monkeypatch.setattr(watching, "_QOS_SHARE", 1)
        watched.watch._qos_at = 0
        less = "best_effort in place of reliable"
        watched.until(f"wrong-qos /joker, publisher /joker/card: {less}")
        watched.watch.close()
    finally:
        joker.close()


@pytest.mark.ros
def test_node_that_hangs_keeps_no_other_from_being_seen(
    ros_env: dict[str, str], observer: Observer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its answer is awaited, and a new end of another node is found meanwhile."""
    from std_msgs.msg import Bool

    monkeypatch.setattr(watching, "ASK_S", 0.0)
    monkeypatch.setattr(watching, "ANSWER_S", 1000.0)
    joker = Peer(int(ros_env["ROS_DOMAIN_ID"]), "joker")
    with running(LEFT, ros_env) as left:
        assert read_line(left) == "up\n"
        graces = dict.fromkeys(Kind, LONG) | {Kind.EXTRA_END: 0}
        watched = Watched(observer, tmp_path, graces, pattern="/[!t]*")
        freeze(left.pid)
        try:
            joker.node.create_publisher(Bool, "~/card", 1)
            watched.until("extra-end /joker, publisher /joker/card: std_msgs/msg/Bool")
        finally:
            thaw(left.pid)
            watched.watch.close()
            joker.close()


@pytest.mark.ros
def test_graph_without_a_change_is_not_read(
    ros_env: dict[str, str], observer: Observer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nor compared: a turn waits, and nothing else."""
    monkeypatch.setattr(watching, "ASK_S", 1000.0)
    monkeypatch.setattr(watching, "TURN_S", 0.01)
    monkeypatch.setattr(watching, "ENDS_S", 0.0)
    monkeypatch.setattr(watching, "_ENDS_SHARE", 1)
    with running(LEFT, ros_env) as left:
        assert read_line(left) == "up\n"
        watched = Watched(observer, tmp_path, dict.fromkeys(Kind, 0))
        looks: list[int] = []
        names = observer.node.get_node_names_and_namespaces

        def counted() -> object:
            looks.append(observer.graph_version)
            return names()

        monkeypatch.setattr(observer.node, "get_node_names_and_namespaces", counted)
        joker = Peer(int(ros_env["ROS_DOMAIN_ID"]), "joker")
        watched.until("extra-node /joker")
        assert looks
        quiet, deadline = 0, time.monotonic() + LIMIT
        while quiet < 20:  # the last of what the joker brings has come
            assert time.monotonic() < deadline
            before = len(looks)
            watched.turn()
            quiet = quiet + 1 if len(looks) == before else 0
        joker.close()
        watched.until("back: extra-node /joker")
        watched.watch.close()


def _read_event(process: subprocess.Popen[str]) -> dict[str, object]:
    event: dict[str, object] = json.loads(read_line(process))
    return event


@pytest.mark.ros
@pytest.mark.parametrize("is_back", [True, False])
def test_command_watches_until_interrupted(
    ros_env: dict[str, str], ros_peer: Peer, tmp_path: Path, is_back: bool
) -> None:
    """A difference and its end are one line of JSON each; the code says what is so at the end."""
    with running(LEFT, ros_env) as left:
        assert read_line(left) == "up\n"
        with Observer(int(ros_env["ROS_DOMAIN_ID"])) as observer:
            import_into(tmp_path, snapshot(observer, "*/lidar", timeout=LIMIT))
        system = str(tmp_path / "robot.system")
        options = ["--except", "test_peer", "--grace", "wrong-value=0.2", "--format", "json"]
        command = [DEROS, "verify", "--live", "--watch", *options, system]
        with subprocess.Popen(
            command, env=ros_env, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        ) as verify:
            assert verify.stderr is not None
            assert verify.stderr.readline() == f"deros: watching 1 node of {system}\n"
            assert set_parameter(ros_peer, "left/lidar", rate=20.0)[0].successful
            event = _read_event(verify)
            assert (event["event"], event["kind"], event["seen"]) == (
                "differs",
                "wrong-value",
                "20.0",
            )
            assert float(str(event["lasted"])) >= 0.2
            if is_back:
                assert set_parameter(ros_peer, "left/lidar", rate=10.0)[0].successful
                assert _read_event(verify)["event"] == "over"
            verify.send_signal(signal.SIGINT)
            rest, errors = verify.communicate(timeout=LIMIT)
    assert (verify.returncode, rest, errors) == (0 if is_back else 1, "", "")


@pytest.mark.ros
def test_differences_are_published_as_diagnostics(
    ros_env: dict[str, str], ros_peer: Peer, tmp_path: Path
) -> None:
    """A status for each kind, again and again: OK, then ERROR with what differs."""
    from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

    statuses: dict[str, DiagnosticStatus] = {}

    def take(message: DiagnosticArray) -> None:
        statuses.update({each.name: each for each in message.status})

    ros_peer.node.create_subscription(DiagnosticArray, "/diagnostics", take, 10)
    with running(LEFT, ros_env) as left:
        assert read_line(left) == "up\n"
        with Observer(int(ros_env["ROS_DOMAIN_ID"])) as observer:
            import_into(tmp_path, snapshot(observer, "*/lidar", timeout=LIMIT), "yard")
        system = str(tmp_path / "yard.system")
        options = ["--except", "test_peer", "--grace", "wrong-value=0", "--diagnostics"]
        with running([DEROS, "verify", "--live", "--watch", *options, system], ros_env):
            ros_peer.until(lambda: len(statuses) == len(Kind))
            assert {each.level for each in statuses.values()} == {DiagnosticStatus.OK}
            assert set_parameter(ros_peer, "left/lidar", rate=20.0)[0].successful
            name = "yard as modelled: wrong-value"
            ros_peer.until(lambda: statuses[name].level == DiagnosticStatus.ERROR)
            (value,) = statuses[name].values
            assert (statuses[name].message, value.key) == ("1 difference", "/left/lidar, rate")
            assert "20.0 in place of 10.0" in value.value
            others = {each.level for each in statuses.values() if each.name != name}
            assert others == {DiagnosticStatus.OK}
            assert set_parameter(ros_peer, "left/lidar", rate=10.0)[0].successful
            ros_peer.until(lambda: statuses[name].level == DiagnosticStatus.OK)
