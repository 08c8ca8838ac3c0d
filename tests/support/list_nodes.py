"""``composition_interfaces``, which the wheels of ROS 2 lack: the service that lists components.

It is generated and compiled as the build of ROS 2 does it, for one type support.
"""

from __future__ import annotations

import os
import subprocess
import sys
import sysconfig
from pathlib import Path

PACKAGE = "composition_interfaces"

LIST_NODES = """\
---
# List of full node names including namespace.
string[] full_node_names

# corresponding unique ids (must have same length as full_node_names).
uint64[] unique_ids
"""
"""``srv/ListNodes.srv`` of Jazzy."""

_LIBRARIES = (
    "rosidl_runtime_c",
    "rosidl_typesupport_c",
    "rosidl_typesupport_fastrtps_c",
    "rosidl_typesupport_fastrtps_cpp",
    "fastcdr",
    "rmw",
    "rcutils",
    "service_msgs__rosidl_generator_c",
    "service_msgs__rosidl_generator_py",
    "service_msgs__rosidl_typesupport_fastrtps_c",
    "stdc++",
)

_GENERATE = f"""
import sys
from pathlib import Path
from rosidl_generator_c.cli import GenerateC
from rosidl_generator_py.cli import GeneratePython
from rosidl_typesupport_c.cli import GenerateCTypesupport
from rosidl_typesupport_fastrtps_c.cli import GenerateFastRTPSCTypesupport

what = "{PACKAGE}", ["srv/ListNodes.srv"], [sys.prefix + "/share"], Path(sys.argv[1])
GenerateC("").generate(*what)
GenerateFastRTPSCTypesupport("").generate(*what)
GeneratePython("", typesupport_implementations=["rosidl_typesupport_c"]).generate(*what)
one = ["rosidl_typesupport_fastrtps_c"]
GenerateCTypesupport("", typesupport_implementations=one).generate(*what)
"""


def build(folder: Path) -> Path:
    """Make the package; return the folder to be put on the path of Python.

    Args:
        folder: an empty one.
    """
    source, out = folder / "source", folder / "modules"
    package = out / PACKAGE
    (source / "srv").mkdir(parents=True)
    (source / "srv/ListNodes.srv").write_text(LIST_NODES, encoding="utf-8")
    package.mkdir(parents=True)
    env = os.environ | {"AMENT_PREFIX_PATH": sys.prefix}
    _run([sys.executable, "-c", _GENERATE, str(package)], source, env)
    (package / "__init__.py").touch()
    import numpy as np

    include = Path(sys.prefix, "include")
    folders = [include, *(each for each in include.iterdir() if each.is_dir())]
    options = ["-shared", "-fPIC", "-w", f"-I{out}", f"-I{sysconfig.get_path('include')}"]
    options += [f"-I{np.get_include()}", *(f"-I{each}" for each in folders)]
    library = Path(sys.prefix, "lib")
    libraries = [f"-L{library}", f"-Wl,-rpath,{library}", *(f"-l{each}" for each in _LIBRARIES)]
    suffix = sysconfig.get_config_var("EXT_SUFFIX")
    extension = package / f"{PACKAGE}_s__rosidl_typesupport_c{suffix}"
    files = (str(each) for ending in ("c", "cpp") for each in sorted(package.rglob(f"*.{ending}")))
    _run(["gcc", *options, *files, *libraries, "-o", str(extension)], folder, env)
    return out


def _run(command: list[str], folder: Path, env: dict[str, str]) -> None:
    outcome = subprocess.run(
        command, cwd=folder, env=env, capture_output=True, text=True, timeout=120, check=False
    )
    assert outcome.returncode == 0, outcome.stdout + outcome.stderr
