"""Gates in C++ as processes; the rest of the robot is what it is for gates in Python."""

from __future__ import annotations

import functools
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from subprocess import Popen

from deros.generators.api.protocol import Files
from deros.generators.gate.cpp.interface import gate_files, gate_nodes
from deros.generators.node.cpp.generate import package_files
from deros.generators.output.writer import write
from deros.generators.runtime.cpp.interface import CppRuntime
from deros.generators.safety_node.cpp.interface import RUNTIME
from deros.generators.safety_node.node import safety_node
from deros.generators.text.notice import notice
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.rules.compiler.build import build
from tests.support.cpp import colcon_build, overlay, program
from tests.support.gate_nodes import MODELS
from tests.support.ros import running

PACKAGE = "gates_safety_cpp"


def gate_package(text: str, options: Mapping[str, str] | None = None, name: str = "gates") -> Files:
    """Return the package of the gates of some rules, as if in a file of a name beside the models.

    The safety node is left out.
    """
    store, repository = InterfaceStore(), Repository()
    loaded = repository.load_text(str(MODELS / f"{name}.deros"), text)
    assert isinstance(loaded.model, Rules), loaded.diagnostics
    built = build(loaded.model, store)
    assert built.program is not None, built.diagnostics
    chosen = dict(options or {})
    safety = safety_node(built.program, built.topics, {}, loaded.model.source)
    nodes = gate_nodes(built.program, built.topics, safety)
    holder = notice(chosen)
    runtime = CppRuntime(nodes[0].package)
    gates = gate_files(built.program, nodes, safety, store, runtime, holder)
    package = package_files(gates.nodes, chosen, gates.provided)
    return {**package, **runtime.files(RUNTIME, holder), **gates.files}


@functools.cache
def installed_gates() -> Path:
    """Return an install folder with the gates of the model that all tests of gates share."""
    with tempfile.TemporaryDirectory() as folder:
        write(gate_package((MODELS / "gates.deros").read_text(encoding="utf-8")), Path(folder))
        return colcon_build(Path(folder))


@contextmanager
def running_gate(gate: str, env: Mapping[str, str], *parameters: str) -> Iterator[Popen[str]]:
    """Run a gate, by the name of its Python twin."""
    install = installed_gates()
    command = [program(install, PACKAGE, f"{gate}_cpp")]
    arguments = [word for each in parameters for word in ("-p", each)]
    ros = ["--ros-args", *arguments] if arguments else []
    with running([*command, *ros], overlay(install, env)) as process:
        yield process
