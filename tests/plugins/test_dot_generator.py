"""A generator of another distribution is available in both commands, tested from outside."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

PLUGIN = Path(__file__).resolve().parent / "dot_generator"

NODE = "node talker : chat\npublishes\n  topic chatter : std_msgs.String\n"
SYSTEM = """system Chat
imports
  import "talker.rnd"
topics
  external topic /chatter
subsystem Talking {
  node talker : talker
  wirings
    connect chatter to /chatter
}
"""
GRAPH = """digraph Chat {
  rankdir=TB;
  "/talker" -> "/chatter";
}
"""


@pytest.fixture(scope="module")
def plugged_in(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Create an environment with the plug-in installed by its own build backend."""
    site = tmp_path_factory.mktemp("site")
    shutil.copytree(PLUGIN, site, dirs_exist_ok=True)
    build = [sys.executable, "-c", "import setuptools; setuptools.setup()", "-q", "egg_info"]
    subprocess.run(build, cwd=site, check=True, capture_output=True)
    return {**os.environ, "PYTHONPATH": str(site)}


@pytest.fixture
def model(tmp_path: Path) -> Path:
    """Create a folder with a small system."""
    (tmp_path / "talker.rnd").write_text(NODE)
    (tmp_path / "chat.system").write_text(SYSTEM)
    return tmp_path


def run(program: str, *arguments: str, env: dict[str, str], cwd: Path) -> str:
    """Run a program of this environment, which must succeed, and return its output."""
    command = [str(Path(sys.executable).with_name(program)), *arguments]
    done = subprocess.run(command, env=env, cwd=cwd, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout + done.stderr


def test_textx_lists_the_plugin(plugged_in: dict[str, str], tmp_path: Path) -> None:
    """``textx list-generators`` shows target, distribution and description."""
    listed = run("textx", "list-generators", env=plugged_in, cwd=tmp_path)
    (line,) = (line for line in listed.splitlines() if "rossystem -> dot" in line)
    assert "dot-generator[0.1.0]" in line.replace("dot_generator", "dot-generator")


def test_textx_runs_the_plugin(plugged_in: dict[str, str], model: Path) -> None:
    """``textx generate`` passes options on and writes the file."""
    arguments = ["chat.system", "--target", "dot", "-o", "out", "--rank-dir", "TB"]
    run("textx", "generate", *arguments, env=plugged_in, cwd=model)
    assert (model / "out/Chat.dot").read_text().endswith(GRAPH)


def test_deros_runs_the_plugin(plugged_in: dict[str, str], model: Path) -> None:
    """``deros generate`` does the same."""
    arguments = ["chat.system", "--target", "dot", "-o", "out", "--rank-dir", "TB"]
    run("deros", "generate", *arguments, env=plugged_in, cwd=model)
    assert (model / "out/Chat.dot").read_text().endswith(GRAPH)


def test_deros_lists_the_plugin(plugged_in: dict[str, str], tmp_path: Path) -> None:
    """``deros generate --help`` shows target and options of the plug-in."""
    listed = run("deros", "generate", "--help", env=plugged_in, cwd=tmp_path)
    assert "rossystem -> dot" in listed
    assert "--rank-dir" in listed
