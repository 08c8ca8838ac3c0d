"""Repeated imports: what people wrote stays, what comes from the graph is replaced."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.importers.kept.files import renewed
from deros.importers.node_types import imported
from deros.importers.texts import files
from deros.live.snapshots import End, SeenNode, Snapshot
from deros.models.common import QosProfile
from deros.models.node import PortKind
from tests.support.checks import checked
from tests.support.imported import described, import_into

PATH = "nodes/lidar.rnd"
MINE = """\
// The lidar on the bumper.
node lidar : lidar_driver "Measures distances"
  executable "driver_node"
timers
  timer watchdog every 100 ms
"""


@pytest.fixture(autouse=True)
def all_is_formatted() -> None:
    """Do not ask it of what people write."""


def seen(*topics: str) -> Snapshot:
    """Return a graph with a lidar that publishes some topics."""
    qos = QosProfile(reliability="reliable", durability="volatile")
    ends = (End(PortKind.PUBLISHER, topic, "std_msgs/msg/Bool", qos) for topic in topics)
    return Snapshot((SeenNode("/lidar", tuple(ends), ()),))


def with_head(folder: Path, path: str, head: str) -> None:
    """Replace the upper part of a file as a person does in an editor."""
    lines = (folder / path).read_text(encoding="utf-8").splitlines(keepends=True)
    mark = next(n for n, line in enumerate(lines) if line.startswith("// Imported: "))
    (folder / path).write_text(head + "\n" + "".join(lines[mark:]), encoding="utf-8")


def test_upper_part_stays_and_lower_one_is_replaced(tmp_path: Path) -> None:
    """In node descriptions and in the system, where people add hosts, arguments and processes."""
    import_into(tmp_path, seen("/a"))
    with_head(tmp_path, PATH, MINE)
    system = 'system robot\nimports\n  import "nodes/*.rnd"\nprocess view : "rviz2"\n'
    with_head(tmp_path, "robot.system", system)
    import_into(tmp_path, seen("/a", "/b"))
    text = (tmp_path / PATH).read_text(encoding="utf-8")
    assert text.startswith(MINE)
    assert "topic /b : std_msgs.Bool" in text
    assert (tmp_path / "robot.system").read_text(encoding="utf-8").startswith(system)
    assert checked(tmp_path / "robot.system") == []
    assert {name for _, name, _ in described(tmp_path / "robot.system")["/lidar"].ends} == {
        "/a",
        "/b",
    }


def test_same_graph_changes_no_file(tmp_path: Path) -> None:
    """Not even its time of modification, with edits of the upper part, too."""
    import_into(tmp_path, seen("/a"))
    with_head(tmp_path, PATH, MINE)
    before = {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*")}
    import_into(tmp_path, seen("/a"))
    assert {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*")} == before


@pytest.mark.parametrize(
    "edit",
    [
        lambda text: text.replace("std_msgs.Bool", "std_msgs.Bool { data [m] }"),
        lambda text: text + "timers\n  timer t every 1 sec\n",
        lambda text: text.replace("// digest", "// the digest"),
        lambda _: "node lidar : mine\n",
        lambda _: "",
    ],
)
def test_edited_lower_part_is_kept(tmp_path: Path, edit: object) -> None:
    """The new text lies beside it, where no import of a system finds it."""
    assert callable(edit)
    import_into(tmp_path, seen("/a"))
    edited = edit((tmp_path / PATH).read_text(encoding="utf-8"))
    (tmp_path / PATH).write_text(edited, encoding="utf-8")
    import_into(tmp_path, seen("/a", "/b"))
    assert (tmp_path / PATH).read_text(encoding="utf-8") == edited
    assert "topic /b" in (tmp_path / f"{PATH}.new").read_text(encoding="utf-8")
    assert "topic /b" in (tmp_path / "robot.system").read_text(encoding="utf-8")


def test_line_endings_of_a_checkout_are_no_edit(tmp_path: Path) -> None:
    """As git writes them on Windows."""
    import_into(tmp_path, seen("/a"))
    text = (tmp_path / PATH).read_bytes().replace(b"\n", b"\r\n")
    (tmp_path / PATH).write_bytes(text)
    parts = files(imported(seen("/a"), lambda _: True), "robot")
    assert renewed(parts, tmp_path).edited == ()
