"""A managed node that says which of its transitions run, and fails in one of them as it is told."""

from __future__ import annotations

from pathlib import Path

from deros.generators.node.python.generate import generate
from deros.generators.output.writer import write
from tests.support.node_packages import model_of

DESCRIPTION = """\
node member : crew lifecycle
parameters
  name place : string = ""
  name way : string = ""
"""
_CODE = '''"""The user's code."""

import os
import signal
import threading
from pathlib import Path

from crew.member_base import MemberBase, run
from rclpy.lifecycle import TransitionCallbackReturn


class Member(MemberBase):
    def work(self, place):
        print(f'{place} runs', flush=True)
        if self.parameters.place != place:
            return TransitionCallbackReturn.SUCCESS
        if self.parameters.way == 'hang':
            threading.Event().wait()
        if self.parameters.way == 'die':
            os.kill(os.getpid(), signal.SIGKILL)
        if self.parameters.way == 'die once':
            mark = Path(os.environ['MARK'])
            if not mark.exists():
                mark.touch()
                os.kill(os.getpid(), signal.SIGKILL)
            return TransitionCallbackReturn.SUCCESS
        return TransitionCallbackReturn.FAILURE
'''
_HOOK = """
    def on_{name}(self, state):
        result = self.work('{name}')
        return result if result != TransitionCallbackReturn.SUCCESS else super().on_{name}(state)
"""


def build(workspace: Path) -> Path:
    """Generate the package into a workspace, fill it in, and return what it can be found in."""
    workspace.mkdir(exist_ok=True)
    (workspace / "member.rnd").write_text(DESCRIPTION)
    model, context = model_of(workspace / "member.rnd")
    write(generate(model, context, {}), workspace)
    hooks = ("configure", "activate", "deactivate", "cleanup", "shutdown")
    code = (*(_HOOK.format(name=name) for name in hooks),)
    end = "\n\ndef main(args=None):\n    run(Member)\n"
    (workspace / "crew/crew/member.py").write_text("".join((_CODE, *code, end)))
    return workspace
