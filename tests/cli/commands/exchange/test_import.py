"""``deros import``: what is wrong on the command line, and what the output says of files."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from deros.cli.commands.exchange import import_
from deros.live.snapshots import End, SeenNode, Snapshot
from deros.models.common import QosProfile
from deros.models.node import PortKind
from tests.support.cli import deros
from tests.support.needs import needs
from tests.support.recorded import Topic, record


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([], "say what to import: FILES, --bag for a recording, or --live for the running graph"),
        (["--bag", "x.mcap", "--live"], "say what to import: FILES, --bag for a recording, or"),
        (["--bag", "x.mcap", "--as", "nodl"], "--bag is for recordings, and --as says 'nodl'"),
        (["--bag", "x.mcap"], "Error: x.mcap: there is no such file"),
        ([__file__], "say it with --as KIND, one of\n  recording: a recording of rosbag2"),
        (["nope.launch.py"], "which is run when it is imported: say --as launch-python if that is"),
        (
            ["--as", "nodl", "nope.yaml", "robot:=r2"],
            "values such as robot:=… are for files in Python",
        ),
        (["--live", "robot:=r2"], "values such as robot:=… are for files in Python"),
        (["nope.yaml"], "cannot read 'nope.yaml': there is no such file"),
        (["--live", "--name", "my robot"], "'my robot' cannot be the name of a system"),
        (["--live", "--name", "../x"], "'../x' cannot be the name of a system"),
        (["--live", "--domain", "233"], "Invalid value for '--domain'"),
        (["--live", "--timeout", "0"], "Invalid value for '--timeout'"),
    ],
)
def test_mistakes_are_usage_errors(arguments: list[str], said: str, tmp_path: Path) -> None:
    """Nothing is looked at or written."""
    outcome = deros("import", *arguments, "-o", tmp_path / "out")
    assert outcome.code == 2
    assert said in outcome.err
    assert not (tmp_path / "out").exists()


def test_environment_without_rclpy_says_what_to_install(tmp_path: Path) -> None:
    """It is a usage error like any other, without a traceback."""
    script = (
        "import sys; sys.modules['rclpy'] = None; from deros.cli.main import main;"
        "main(['import', '--live'])"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=False, cwd=tmp_path
    )
    assert done.returncode == 2
    assert "source the setup file of ROS 2" in done.stderr
    assert list(tmp_path.iterdir()) == []


def _at(monkeypatch: pytest.MonkeyPatch, *topics: str) -> None:
    """Let a graph with a lidar run, which publishes some topics."""
    qos = QosProfile(reliability="reliable", durability="volatile")
    ends = tuple(End(PortKind.PUBLISHER, each, "std_msgs/msg/Bool", qos) for each in topics)
    seen = Snapshot((SeenNode("/lidar", ends, ()),))
    monkeypatch.setattr(import_, "_seen", lambda *_: seen)


def test_launch_file_in_python_is_not_run_unless_that_is_said(tmp_path: Path) -> None:
    """It may come from anybody."""
    file = tmp_path / "robot.launch.py"
    file.write_text(f"open({str(tmp_path / 'run')!r}, 'w')\n")
    outcome = deros("import", file, "-o", tmp_path / "out")
    assert outcome.code == 2
    assert "say --as launch-python" in outcome.err
    assert not (tmp_path / "run").exists()


@needs("launch_ros")
def test_launch_file_in_python_is_run_with_values(tmp_path: Path) -> None:
    """As they are given to ros2 launch."""
    file = tmp_path / "robot.launch.py"
    file.write_text(
        "from launch import LaunchDescription\n"
        "from launch.actions import DeclareLaunchArgument\n"
        "def generate_launch_description():\n"
        "    return LaunchDescription([DeclareLaunchArgument('robot', default_value='r1')])\n"
    )
    outcome = deros("import", file, "--as", "launch-python", "-o", tmp_path, "robot:=a b")
    assert outcome.code == 0, outcome.out + outcome.err
    assert 'argument robot : string = "a b"' in (tmp_path / "robot.system").read_text()


def test_output_names_the_files(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Written ones, then nothing for those that have not changed."""
    _at(monkeypatch, "/a")
    first, second = (deros("import", "--live", "-o", tmp_path) for _ in range(2))
    following = f"next: deros check {tmp_path}/robot.system\n"
    written = f"wrote {tmp_path}/nodes/lidar.rnd\nwrote {tmp_path}/robot.system\n"
    assert (first.code, first.out) == (0, written + following)
    assert (second.code, second.out) == (0, following)


def test_edited_and_old_files_are_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """An edit below the line makes the exit code 1: the model is not what runs."""
    _at(monkeypatch, "/a")
    deros("import", "--live", "-o", tmp_path)
    path = tmp_path / "nodes/lidar.rnd"
    path.write_text(path.read_text(encoding="utf-8") + "// mine\n", encoding="utf-8")
    (tmp_path / "nodes/radar.rnd").write_text("node radar : radar\n", encoding="utf-8")
    _at(monkeypatch, "/b")
    outcome = deros("import", "--live", "-o", tmp_path)
    assert outcome.code == 1
    lines = outcome.out.splitlines()
    edited = "what was imported was edited there; compare it with nodes/lidar.rnd.new"
    assert f"kept {path}: {edited}" in lines
    assert f"kept {tmp_path}/nodes/radar.rnd: no node of this type runs now" in lines


def test_own_words_for_an_imported_port_are_kept(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Silently while they fit; where the graph has another type, it is said, with code 1."""
    _at(monkeypatch, "/a", "/b")
    deros("import", "--live", "-o", tmp_path)
    path = tmp_path / "nodes/lidar.rnd"
    mine = 'publishes\n  topic /a : std_msgs.Bool "Mine"\n\n// Imported'
    text = path.read_text(encoding="utf-8").replace("// Imported", mine, 1)
    path.write_text(text, encoding="utf-8")
    assert deros("check", tmp_path).code == 1  # the port is there twice
    fits = deros("import", "--live", "-o", tmp_path)
    following = f"next: deros check {tmp_path}/robot.system"
    assert (fits.code, fits.out.splitlines()) == (0, [f"wrote {path}", following])
    assert deros("check", "--strict", tmp_path).code == 0
    path.write_text(path.read_text(encoding="utf-8").replace('Bool "Mine"', "Int8"))
    differs = deros("import", "--live", "-o", tmp_path)
    assert (differs.code, differs.out.splitlines()) == (
        1,
        [
            "what you wrote counts, and the import has:",
            f"  {path}:6: publisher /a: topic /a : std_msgs.Bool qos reliable volatile",
            following,
        ],
    )


def test_folder_that_cannot_be_written_is_an_error(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """A file where the folder has to be, and a folder where a file has to be."""
    _at(monkeypatch, "/a")
    (tmp_path / "nodes").write_text("", encoding="utf-8")
    assert deros("import", "--live", "-o", tmp_path).code == 2
    (tmp_path / "other" / "robot.system").mkdir(parents=True)
    outcome = deros("import", "--live", "-o", tmp_path / "other")
    assert outcome.code == 2
    assert "Traceback" not in outcome.err


def test_recordings_become_models_that_check_clean(tmp_path: Path) -> None:
    """The last line is the command that checks them; rules can be started from them."""
    wheel = Topic("/wheel", "own_msgs/msg/Wheel", definition="float64 speed  # [m/s]\n")
    first = record(tmp_path / "first", Topic("/imu", "sensor_msgs/msg/Imu", 3))
    second = record(tmp_path / "second", wheel)
    out = tmp_path / "out"
    system = out / "courier.system"
    outcome = deros("import", "--bag", first, "--bag", second, "-o", out, "--name", "courier")
    assert (outcome.code, outcome.err) == (0, "")
    *_, last = outcome.out.splitlines()
    assert last == f"next: deros check {system} --interfaces {out}/interfaces"
    checked = deros("check", "--strict", system, "--interfaces", out / "interfaces")
    assert checked.code == 0, checked.err
    written = (out / "courier.system").read_text(encoding="utf-8")
    for more in (["--bag", first, second], [first, second]):
        again = deros("import", *more, "-o", out, "--name", "courier")
        assert (again.code, again.out) == (0, f"{last}\n")
        known = deros("import", *more, "-o", out, "--name", "courier", *last.split()[-2:])
        assert (known.code, known.out) == (0, f"{last}\n")
    assert (out / "courier.system").read_text(encoding="utf-8") == written


def test_rules_begin_with_what_was_recorded(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Sensors of the recording are inputs, with a timeout from how often they were heard."""
    monkeypatch.chdir(tmp_path)
    imu, scan = ("/imu", "sensor_msgs/msg/Imu", 3), ("/scan", "sensor_msgs/msg/LaserScan", 21)
    record(Path("bag"), Topic(*imu), Topic(*scan))
    assert deros("import", "--bag", "bag").code == 0
    outcome = deros("new", "rules", "guard", "--from", "robot.system")
    assert outcome.code == 0, outcome.err
    text = Path("guard.deros").read_text(encoding="utf-8")
    assert "input imu = topic /imu timeout 1 sec\n" in text
    assert "input scan = topic /scan timeout 300 ms  // 3 periods at 10 Hz, its rate" in text
    assert deros("check", "--strict", "guard.deros").code == 0


def test_import_of_a_recording_keeps_what_people_wrote(tmp_path: Path) -> None:
    """The upper part of the system, and a definition that was edited."""
    wheel = Topic("/wheel", "own_msgs/msg/Wheel", definition="float64 speed\n")
    path = record(tmp_path / "bag", wheel)
    deros("import", "--bag", path, "-o", tmp_path)
    system, message = tmp_path / "robot.system", tmp_path / "interfaces/own_msgs/msg/Wheel.msg"
    text = system.read_text(encoding="utf-8")
    system.write_text(text.replace("system robot", 'system robot "Ours"'), encoding="utf-8")
    newer = record(tmp_path / "newer", wheel, Topic("/imu", "sensor_msgs/msg/Imu"))
    assert deros("import", "--bag", newer, "-o", tmp_path).code == 0
    text = system.read_text(encoding="utf-8")
    assert text.startswith('system robot "Ours"\n')
    assert "external topic /imu : sensor_msgs.Imu" in text
    message.write_text(message.read_text(encoding="utf-8") + "# mine\n", encoding="utf-8")
    changed = wheel._replace(definition="float64 speed\nfloat64 load\n")
    outcome = deros("import", "--bag", record(tmp_path / "third", changed), "-o", tmp_path)
    assert outcome.code == 1
    assert f"kept {message}: it was edited, or is not from an import\n" in outcome.out
    assert message.read_text(encoding="utf-8").endswith("# mine\n")


def test_recordings_are_read_without_ros_and_their_library_is_loaded_late(tmp_path: Path) -> None:
    """Another kind of import loads none of it."""
    record(tmp_path / "bag", Topic("/imu", "sensor_msgs/msg/Imu"))
    script = (
        "import sys; sys.modules['rclpy'] = None; from deros.cli.main import run;"
        "import deros.importers.kinds; assert 'rosbags' not in sys.modules;"
        "sys.exit(run(['import', '--bag', 'bag']))"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=False, cwd=tmp_path
    )
    assert (done.returncode, done.stderr) == (0, "")
