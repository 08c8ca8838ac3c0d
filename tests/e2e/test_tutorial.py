"""``docs/index.md``, the tutorial, is played word for word, from the install to the log."""

from __future__ import annotations

import contextlib
import re
import shlex
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.support.needs import needs
from tests.support.page_reader import RobotReader, blocks_of
from tests.support.pages import ROOT
from tests.support.ros import Peer

PAGE = "docs/index.md"
_LASTING = ("python3 robot.py", "deros up")
_NUMBERS = {"fifteen": 15, "sixteen": 16, "seventeen": 17, "eighteen": 18}


@pytest.fixture
def reader(tmp_path: Path, ros_env: dict[str, str]) -> Iterator[RobotReader]:
    """Return somebody in an empty folder, in a domain of their own."""
    folder = tmp_path / "my_robot"
    folder.mkdir()
    path = f"{Path(sys.executable).parent}:{ros_env['PATH']}"  # as an activated environment has it
    env = {**ros_env, "PATH": path, "XDG_CACHE_HOME": str(tmp_path / "cache")}
    with contextlib.closing(Peer(int(ros_env["ROS_DOMAIN_ID"]), "_reader")) as peer:
        found = RobotReader(folder, env=env, peer=peer, lasting=_LASTING)
        try:
            yield found
        finally:
            found.close()


def _play(reader: RobotReader) -> None:
    """Do what the page says, and print how long that took and how many commands were typed."""
    began = time.monotonic()
    for block in blocks_of(PAGE):
        reader.play(block)
    taken = time.monotonic() - began
    print(f"the tutorial: {reader.commands} commands, {taken:.0f} s")
    page = (ROOT / PAGE).read_text(encoding="utf-8")
    said = re.search(r"You type (\w+) commands", page)
    assert said is not None
    assert _NUMBERS[said[1]] == reader.commands
    assert taken < 15 * 60


@needs("cat")
@pytest.mark.ros
def test_tutorial_is_true_word_for_word(reader: RobotReader) -> None:
    """From a folder without a file to a robot that was stopped, drove again, and left a log."""
    reader.commands = len(_install())
    _play(reader)


@needs("cat")
@pytest.mark.ros
@pytest.mark.slow(seconds=120)
def test_tutorial_is_true_in_what_it_installs(reader: RobotReader, tmp_path: Path) -> None:
    """The same with nothing but what the page has the reader install."""
    here = tmp_path / "install"
    here.mkdir()
    ignored = shutil.ignore_patterns(".*", "tests", "site", "build", "dist")
    shutil.copytree(ROOT, here / "deros", ignore=ignored)
    for command in _install():
        program, *words = shlex.split(command)
        reader.commands += 1
        if program == ".":
            reader.programs = (here / words[0]).parent
            reader.env["PATH"] = f"{reader.programs}:{reader.env['PATH']}"
            continue
        found = {"python3": sys.executable, "pip": str(reader.programs / "pip")}[program]
        subprocess.run([found, *words], cwd=here, env=reader.env, check=True, timeout=600)
    reader.env.pop("AMENT_PREFIX_PATH")
    assert not reader.programs.samefile(Path(sys.executable).parent)
    _play(reader)


def _install() -> list[str]:
    (block,) = (block for block in blocks_of(PAGE) if block.language == "sh")
    return block.text.splitlines()
