"""Who includes a launch file below a namespace has what the system leaves relative there."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from deros.generators.builtin import rossystem_launch
from deros.models.system import System
from tests.support import launch
from tests.support.systems import CONTEXT, load_text

EYE = """node eye : eyes
parameters
  name topic : string = "pictures"
publishes
  topic scan : sensor_msgs.LaserScan
  topic image : sensor_msgs.Image via topic
"""
SYSTEM = """system Whole
argument robot : string = "r1"
imports import "*.rnd"
node first : eye
wirings
  connect scan to near/scan
  connect image to near/image
node second : eye namespace /fixed
wirings
  connect scan to near/scan
  connect image to /all/images
subsystem left namespace left {
  node third : eye namespace $robot
  wirings
    connect scan to ~/scan
    connect image to near/image
  subsystem outside namespace /outside {
    node fourth : eye namespace inner
    wirings
      connect scan to /scan
      connect image to image
  }
}
"""


def _file(system: System) -> str:
    file, *_ = rossystem_launch(system, CONTEXT).values()
    return file.text


@pytest.mark.parametrize("root", ["/", "/fleet", "/fleet/r7"])
def test_relative_names_go_with_the_namespace(tmp_path: Path, root: str) -> None:
    """Absolute ones stay where they are; a topic that is set by a parameter is resolved so, too."""
    system = load_text(tmp_path, SYSTEM, eye=EYE)
    below = root.rstrip("/")
    started = launch.started(_file(system), {}, namespace=root)
    found: dict[str, tuple[Any, Any]] = {
        name: (remappings.get("scan"), parameters["topic"])
        for name, _, parameters, remappings in started
    }
    assert found == {
        f"{below}/first": (f"{below}/near/scan", "near/image"),
        "/fixed/second": ("/fixed/near/scan", "/all/images"),
        f"{below}/left/r1/third": (f"{below}/left/r1/third/scan", "near/image"),
        "/outside/inner/fourth": ("/scan", "/outside/inner/image"),
    }


def test_file_has_no_mark_in_it(tmp_path: Path) -> None:
    """What stands for the namespace while the file is made is nobody's name."""
    assert "\ue003" not in _file(load_text(tmp_path, SYSTEM, eye=EYE))
