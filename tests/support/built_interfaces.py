"""Packages of interfaces that the wheels of ROS 2 lack.

They are generated as the build of ROS 2 does it, and compiled into one library.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import subprocess
import sys
import sysconfig
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

_TYPE_SUPPORTS = ("rosidl_typesupport_fastrtps_c", "rosidl_typesupport_introspection_c")


@dataclass(frozen=True, slots=True)
class Interfaces:
    """A package of interfaces, as far as the tests need it.

    Attributes:
        package: its name.
        file: the path of its only definition.
        definition: what that says.
        uses: the package whose types it has.
    """

    package: str
    file: str
    definition: str
    uses: str

    @property
    def supports(self) -> tuple[str, ...]:
        """The type supports that it needs; messages are registered by their description, too."""
        return _TYPE_SUPPORTS if self.file.startswith("msg/") else _TYPE_SUPPORTS[:1]


LIST_NODES = Interfaces(
    "composition_interfaces",
    "srv/ListNodes.srv",
    """\
---
# List of full node names including namespace.
string[] full_node_names

# corresponding unique ids (must have same length as full_node_names).
uint64[] unique_ids
""",
    uses="service_msgs",
)
"""The service that lists components, of Jazzy."""

TRANSFORMS = Interfaces(
    "tf2_msgs",
    "msg/TFMessage.msg",
    "geometry_msgs/TransformStamped[] transforms\n",
    uses="geometry_msgs",
)
"""The message in which transforms are broadcast."""

_LIBRARIES = (
    "rosidl_runtime_c",
    "rosidl_typesupport_c",
    "rosidl_typesupport_fastrtps_c",
    "rosidl_typesupport_fastrtps_cpp",
    "rosidl_typesupport_introspection_c",
    "fastcdr",
    "rmw",
    "rcutils",
    "stdc++",
)
_OF_PACKAGES = ("rosidl_generator_c", "rosidl_generator_py", *_TYPE_SUPPORTS)

_GENERATE = """
import sys
from pathlib import Path
from rosidl_generator_c.cli import GenerateC
from rosidl_generator_py.cli import GeneratePython
from rosidl_typesupport_c.cli import GenerateCTypesupport
from rosidl_typesupport_fastrtps_c.cli import GenerateFastRTPSCTypesupport
from rosidl_typesupport_introspection_c.cli import GenerateIntrospectionCTypesupport

what = sys.argv[1], [sys.argv[2]], [sys.prefix + "/share"], Path(sys.argv[3])
GenerateC("").generate(*what)
GenerateFastRTPSCTypesupport("").generate(*what)
if "rosidl_typesupport_introspection_c" in sys.argv:
    GenerateIntrospectionCTypesupport("").generate(*what)
GeneratePython("", typesupport_implementations=["rosidl_typesupport_c"]).generate(*what)
GenerateCTypesupport("", typesupport_implementations=sys.argv[4:]).generate(*what)
"""


def build(interfaces: Interfaces, folder: Path) -> Path:
    """Make the package; return the folder to be put on the paths of Python and of libraries.

    Args:
        interfaces: the package.
        folder: an empty one.
    """
    source, out = folder / "source", folder / "modules"
    package, file = out / interfaces.package, source / interfaces.file
    file.parent.mkdir(parents=True)
    file.write_text(interfaces.definition, encoding="utf-8")
    package.mkdir(parents=True)
    env = os.environ | {"AMENT_PREFIX_PATH": sys.prefix}
    names = (interfaces.package, interfaces.file, str(package), *interfaces.supports)
    _run([sys.executable, "-c", _GENERATE, *names], source, env)
    (package / "__init__.py").touch()
    import numpy as np

    include = Path(sys.prefix, "include")
    folders = [include, *(each for each in include.iterdir() if each.is_dir())]
    options = ["-shared", "-fPIC", "-w", f"-I{out}", f"-I{sysconfig.get_path('include')}"]
    options += [f"-I{np.get_include()}", *(f"-I{each}" for each in folders)]
    library = Path(sys.prefix, "lib")
    used = (f"{interfaces.uses}__{each}" for each in _OF_PACKAGES)
    libraries = [f"-L{library}", f"-Wl,-rpath,{library}", *(f"-l{x}" for x in (*_LIBRARIES, *used))]
    suffix = sysconfig.get_config_var("EXT_SUFFIX")
    extension = package / f"{interfaces.package}_s__rosidl_typesupport_c{suffix}"
    files = (str(each) for ending in ("c", "cpp") for each in sorted(package.rglob(f"*.{ending}")))
    _run(["gcc", *options, *files, *libraries, "-o", str(extension)], folder, env)
    if len(interfaces.supports) > 1:  # then the one that is needed is looked for, by this name
        for each in interfaces.supports:
            name = f"lib{interfaces.package}__{each}.so"
            stub = ["-shared", f"-Wl,-soname,{name}", "-Wl,--no-as-needed", str(extension)]
            _run(["gcc", *stub, f"-Wl,-rpath,{package}", "-o", str(out / name)], folder, env)
    return out


@contextlib.contextmanager
def known(interfaces: Interfaces, folder: Path) -> Iterator[dict[str, str]]:
    """Let this process know a package; give what others need in their environment.

    Where ROS 2 brings the package, nothing is made.

    Args:
        interfaces: the package.
        folder: an empty one.
    """
    if find_spec(interfaces.package) is not None:
        yield {}
        return
    made = build(interfaces, folder)
    before = {name: os.environ.get(name) for name in ("PYTHONPATH", "LD_LIBRARY_PATH")}
    sys.path.insert(0, str(made))
    for name, value in before.items():
        os.environ[name] = os.pathsep.join(filter(None, (str(made), value)))
    for library in made.glob("*.so"):
        ctypes.CDLL(str(library))  # found by its name from now on: the path was read at the start
    try:
        yield {name: os.environ[name] for name in before}
    finally:
        for name, value in before.items():
            os.environ.pop(name) if value is None else os.environ.update({name: value})
        sys.path.remove(str(made))
        for name in [*sys.modules]:
            if name.partition(".")[0] == interfaces.package:
                del sys.modules[name]


def _run(command: list[str], folder: Path, env: dict[str, str]) -> None:
    outcome = subprocess.run(
        command, cwd=folder, env=env, capture_output=True, text=True, timeout=120, check=False
    )
    assert outcome.returncode == 0, outcome.stdout + outcome.stderr
