"""Two launch files, compared by what the real ``launch`` and ``launch_ros`` make of them.

``DEROS_REAL_PYTHON`` names a Python that imports ``launch_ros`` and what the launch files import,
and ``AMENT_PREFIX_PATH`` has the packages.
"""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Mapping
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import canonicalize

import pytest

from deros.names.graph_names import resolve_name
from tests.support.resolved_launch import command

REPOSITORY = Path(__file__).resolve().parents[2]
PYTHON = os.environ.get("DEROS_REAL_PYTHON", "")

needs_launch = pytest.mark.skipif(
    not PYTHON, reason="DEROS_REAL_PYTHON names no Python that has launch_ros"
)


def share(package: str) -> Path:
    """Return the share folder of an installed package; skip the test if it is not installed."""
    prefixes = os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    for each in prefixes:
        if (folder := Path(each, "share", package)).is_dir():
            return folder
    pytest.skip(f"AMENT_PREFIX_PATH names no prefix that has {package}")


def resolved(
    path: Path, arguments: Mapping[str, str], environment: Mapping[str, str] | None = None
) -> dict[str, dict[str, Any]]:
    """Return what a launch file starts with these arguments, by the full names of the nodes.

    ``environment``: variables beside those that are set.
    """
    run = subprocess.run(
        command(PYTHON, path, arguments),
        cwd=REPOSITORY,
        env={**os.environ, **(environment or {})},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert run.returncode == 0, run.stderr
    nodes = json.loads(run.stdout.splitlines()[-1])
    by_name = {each["name"]: each for each in nodes}
    assert len(by_name) == len(nodes), "two nodes have one name"
    return by_name


def differences(
    wanted: Mapping[str, dict[str, Any]], found: Mapping[str, dict[str, Any]]
) -> list[str]:
    """Return in what two launch files differ."""
    made = [f"{name}: not started" for name in sorted(wanted.keys() - found.keys())]
    made += [f"{name}: started, too" for name in sorted(found.keys() - wanted.keys())]
    for name in sorted(wanted.keys() & found.keys()):
        one, other = wanted[name], found[name]
        made += [
            f"{name}: {what} {one[what]} is {other[what]}"
            for what in ("program", "container", "words", "inside", "delay", "respawns", "ends_all")
            if one[what] != other[what]
        ]
        for what in ("parameters", "remappings"):
            made += [
                f"{name}: {what[:-1]} {key} {one[what].get(key)!r} is {other[what].get(key)!r}"
                for key in sorted(one[what].keys() | other[what].keys())
                if not _is_same(one[what].get(key), other[what].get(key), name)
            ]
    return made


def _is_same(one: Any, other: Any, node: str) -> bool:
    """Return whether two values are equal and of one type, or name one topic, or are the same XML.

    Nav2's file has absolute names, and the program xacro indents its output, unlike its library.
    Where a launch file leaves the type of a text open, launch_ros reads it as YAML, which joins the
    lines of a description.
    """
    if not (isinstance(one, str) and isinstance(other, str)):
        return repr(one) == repr(other)  # 1, 1.0 and True are equal, but three types in ROS 2
    if one.startswith("<?xml") and other.startswith("<?xml"):
        is_alike = canonicalize(one, strip_text=True) == canonicalize(other, strip_text=True)
        return is_alike or one.split() == other.split()
    is_name = one.startswith("/")
    return one == other or (is_name and resolve_name(other, node.rpartition("/")[0]) == one)
