"""Termination of generated nodes: a signal at any time ends them between two callbacks."""

from __future__ import annotations

import signal
import sys
from pathlib import Path

import pytest

from deros.generators.builtin import rosnode_python
from deros.generators.output.writer import write
from deros.metamodels.load import Repository
from tests.support.ros import read_line, running
from tests.support.systems import CONTEXT

pytestmark = pytest.mark.ros

MODEL = """
    node worker : stopping
    publishes
      topic words : std_msgs.String
    timers
      timer tick every 10 ms
"""

SIGNALLED = """\
        import os, signal
        from std_msgs.msg import String
        if not hasattr(self, 'signalled'):  # a second signal would end the program at once
            self.signalled = True
            os.kill(os.getpid(), signal.{signal})
        try:
            total = sum(range(1_000_000))  # the interpreter looks for signals again and again
            self.publish_words(String(data=str(total)))
        except BaseException as error:
            print(f'broken off by {{error!r}}', flush=True)
            raise
        print('carried out', flush=True)
"""

HANGING = """\
        import time
        print('hangs', flush=True)
        while True:
            time.sleep(1.0)
"""


def make_node(folder: Path, body: str) -> tuple[list[str], dict[str, str]]:
    """Generate the node with a body for its timer; return its command and environment."""
    model = folder / "worker.rnd"
    model.write_text(MODEL)
    loaded = Repository().load(model)
    assert loaded.diagnostics == ()
    write(rosnode_python(loaded.model, CONTEXT), folder)
    path = folder / "stopping" / "stopping" / "worker.py"
    text = path.read_text()
    line = "        self.get_logger().warning('on_tick does nothing yet', once=True)\n"
    assert line in text
    path.write_text(text.replace(line, body))
    return [sys.executable, "-m", "stopping.worker"], {"PYTHONPATH": str(folder / "stopping")}


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signal_does_not_interrupt_a_callback(
    tmp_path: Path, ros_env: dict[str, str], number: signal.Signals
) -> None:
    """A running callback completes, including publishing; then the node ends with 0."""
    command, env = make_node(tmp_path, SIGNALLED.format(signal=number.name))
    with running(command, {**ros_env, **env}) as process:
        assert read_line(process) == "carried out\n"
        output, _ = process.communicate(timeout=30)
        assert (process.returncode, output) == (0, "")


def test_second_signal_ends_a_hung_callback(tmp_path: Path, ros_env: dict[str, str]) -> None:
    """After SIGINT, SIGTERM ends the process by default action."""
    command, env = make_node(tmp_path, HANGING)
    with running(command, {**ros_env, **env}) as process:
        assert read_line(process) == "hangs\n"
        process.send_signal(signal.SIGINT)
        process.send_signal(signal.SIGINT)
        with pytest.raises(Exception, match="timed out"):
            process.wait(2.0)
        process.send_signal(signal.SIGTERM)
        assert process.wait(30) == -signal.SIGTERM
