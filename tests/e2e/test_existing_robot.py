"""``docs/howto/existing-robot.md`` is played word for word, on nodes that deros does not know."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.support.page_reader import RobotReader, blocks_of
from tests.support.ros import Peer

PAGE = "docs/howto/existing-robot.md"
_LASTING = ("python3 robot.py", "deros run")


@pytest.fixture
def reader(tmp_path: Path, ros_env: dict[str, str]) -> Iterator[RobotReader]:
    """Return somebody in an empty folder, in a domain of their own."""
    folder = tmp_path / "robot"
    folder.mkdir()
    env = {**ros_env, "XDG_CACHE_HOME": str(tmp_path / "cache")}
    with contextlib.closing(Peer(int(ros_env["ROS_DOMAIN_ID"]), "_reader")) as peer:
        found = RobotReader(folder, env=env, peer=peer, lasting=_LASTING)
        try:
            yield found
        finally:
            found.close()


@pytest.mark.ros
def test_page_is_true_word_for_word(reader: RobotReader) -> None:
    """From the first look at the graph to a robot that stands because its lidar is silent."""
    blocks = blocks_of(PAGE)
    for block in blocks:
        if block.language == "rossystem":
            _write_upper_part(reader.folder / "safety/robot.system", block.text)
        else:
            reader.play(block)
    typed = sum(block.text.count("\nsafety ") for block in blocks)
    assert (reader.commands, typed) == (16, 1)  # five of them start the robot's own programs


def _write_upper_part(path: Path, text: str) -> None:
    """Replace what is above the line that the import has written."""
    _, mark, lower = path.read_text(encoding="utf-8").partition("// Imported: ")
    assert mark
    path.write_text(f"{text}\n{mark}{lower}", encoding="utf-8")
