"""The packages of nodes as they are kept: each beside those before it, of either language."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from pathlib import PurePath

from deros.generators.api.protocol import Files, GenerateFunction
from deros.generators.node.cpp.generate import generate as generate_cpp
from deros.generators.node.python.generate import generate as generate_python
from tests.support.golden_alike import Part, parts_of, unlike_those_before
from tests.support.node_packages import MODELS, PICKY, model_of

GENERATORS: Mapping[str, GenerateFunction] = {
    "rosnode_cpp": generate_cpp,
    "rosnode_python": generate_python,
}
SIMPLEST_FIRST = {
    "rosnode_cpp": ("talker", "valve", "counter", PICKY.stem, "mapper"),
    "rosnode_python": ("talker", "valve", "counter", "odometry_node", "mapper"),
}
"""Node descriptions by target, in the order in which their packages are read.

Of an ordinary node and the picky one, which has each construct of the former, one is enough.
"""


def packages_kept(folder: str) -> Files:
    """Return what is kept of a package, each file whole or as its difference from another one."""
    return unlike_those_before(folder, _parts())


@functools.cache
def _parts() -> list[Part]:
    """Return the files of each node, with those of its package."""
    parts: list[Part] = []
    for target, generate in GENERATORS.items():
        for name in SIMPLEST_FIRST[target]:
            path = PICKY if name == PICKY.stem else MODELS / f"{name}.rnd"
            files = generate(*model_of(path), {})
            package = next(iter(files)).split("/")[0]
            ends = (PurePath(each).name.split(".launch.py") for each in files)
            nodes = {each[0] for each in ends if len(each) > 1}
            ordered = [name, *sorted(nodes - {name})]
            parts += parts_of(f"{target}/{name}", package, ordered, files)
    return parts
