"""Components in containers, and what rules become, run as modelled, however they are started.

Their programs are those that are generated: containers load components in C++, so that their test
runs where ``rclcpp`` is; the safety node and its gate are in Python.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

import pytest

from deros.generators.output.writer import write
from deros.generators.runtime.interface import PYTHON_RUNTIME, with_runtime
from deros.generators.safety_package.python.generate import generate
from tests.support.cli import deros
from tests.support.cpp import colcon_build, python_overlay
from tests.support.generating import output_of
from tests.support.needs import needs
from tests.support.started_graph import install_program
from tests.support.started_site import OURS, THEIRS, Site, Values, compare, sets, site_at
from tests.support.systems import MODELS

BOXES: Mapping[str, Values] = {
    "defaults": {},
    "others": {"robot": "r2", "speed": 1.5},
    "not composed": {"composed": False},
}
MANAGED: Mapping[str, Values] = {"defaults": {}, "not composed": {"composed": False}}
GUARDED: Mapping[str, Values] = {"defaults": {}, "others": {"limit": 0.75}}


@pytest.fixture(scope="module")
def components(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return an install folder with the components, as they are generated and built."""
    packages = tmp_path_factory.mktemp("packages")
    files = (MODELS / "started" / f"{name}.rnd" for name in ("lens", "sink"))
    assert deros("generate", *files, "--target", "cpp", "-o", packages).code == 0
    return colcon_build(packages)


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Site:
    """Return a folder with the systems, and an install space with their programs."""
    return site_at(tmp_path, monkeypatch)


def _provide(components: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Have the components and their libraries found."""
    for name, value in python_overlay(components, os.environ).items():
        monkeypatch.setenv(name, value)


@pytest.mark.ros
@needs("rclcpp")
@pytest.mark.parametrize("starter", [*OURS, *THEIRS])
@pytest.mark.parametrize("values", sets(BOXES))
def test_containers_are_started_as_modelled(
    site: Site, components: Path, monkeypatch: pytest.MonkeyPatch, values: Values, starter: str
) -> None:
    """With what is loaded into them, or is a process where a condition says so."""
    _provide(components, monkeypatch)
    compare(site, starter, "boxes", values, {}, silent={"boxed"})


@pytest.mark.ros
@needs("rclcpp")
@pytest.mark.parametrize("starter", [*OURS, *THEIRS[:1]])
@pytest.mark.parametrize("values", sets(MANAGED))
def test_managed_nodes_in_containers_are_started_as_modelled(
    site: Site, components: Path, monkeypatch: pytest.MonkeyPatch, values: Values, starter: str
) -> None:
    """They are brought up when they have been loaded."""
    _provide(components, monkeypatch)
    compare(site, starter, "managed_boxes", values, {}, silent={"boxed"})


@pytest.mark.ros
@pytest.mark.parametrize("starter", [*OURS, *THEIRS])
@pytest.mark.parametrize("values", sets(GUARDED))
def test_safety_nodes_are_started_as_modelled(site: Site, values: Values, starter: str) -> None:
    """The node of the rules and its gate, with a constant that the system sets."""
    source = site.prefix / "src"
    write(with_runtime(output_of(generate, site.folder / "guard.deros")), source)
    folders = (source / "guard_safety", source / PYTHON_RUNTIME)
    for node in ("guard_safety_node", "command_gate"):
        module = f"guard_safety.{node}"
        install_program(site.prefix, "guard_safety", node, module, *folders)
    compare(site, starter, "guarded", values, {}, silent={"guard_safety"})
