"""Examples, started as their README says."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

from tests.support.examples import EXAMPLES


def start_example(
    example: str, folder: Path, env: dict[str, str], fault: str, system: str | None = None
) -> list[str]:
    """Generate the packages of an example by its README's commands; return the one that runs them.

    Args:
        example: its folder among the examples.
        folder: where the packages are written, in place of the README's.
        env: the environment of the commands.
        fault: the value of the system's argument ``fault``, in place of the README's.
        system: the one to start, where the README starts several.
    """
    system = system or example
    readme = (EXAMPLES / example / "README.md").read_text(encoding="utf-8")
    block = readme.split("```sh\n")[1].split("```")[0].replace(f".demo/{example}", str(folder))
    lines = block.strip().splitlines()
    generate = [line for line in lines if not line.startswith("deros up ")]
    (up,) = [line for line in lines if line not in generate and f"/{system}.system" in line]
    scripts = str(Path(sys.executable).parent)
    for line in generate:
        path = {**env, "PATH": f"{scripts}:{env['PATH']}"}
        subprocess.run(line, shell=True, check=True, cwd=EXAMPLES.parent, env=path)
    command = re.sub(r"(?<=fault:=)\w+", fault, up).split()
    assert f"fault:={fault}" in command
    command[2] = str(EXAMPLES.parent / command[2])
    assert shutil.which(command[0], path=scripts)
    return [str(Path(scripts) / command[0]), *command[1:]]
