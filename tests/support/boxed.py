"""Two components in C++ for containers: a camera, and a managed node that takes its images."""

from __future__ import annotations

from pathlib import Path

from tests.support.cli import deros
from tests.support.cpp import colcon_build

PACKAGE = "boxed"
CAMERA = """node camera : boxed plugin "boxed::Camera"
parameters
  name label : string = "none"
  name rate : double = 1.0 in [0, 10]
publishes topic image : std_msgs.String
"""
SINK = """node sink : boxed plugin "boxed::Sink" lifecycle
subscribes topic image : std_msgs.String
"""


def installed(folder: Path) -> Path:
    """Generate the components into an empty folder, and return the install folder with them."""
    for name, text in (("camera", CAMERA), ("sink", SINK)):
        (folder / f"{name}.rnd").write_text(text, encoding="utf-8")
    files = (folder / "camera.rnd", folder / "sink.rnd")
    assert deros("generate", *files, "--target", "cpp", "-o", folder / "src").code == 0
    return colcon_build(folder / "src")
