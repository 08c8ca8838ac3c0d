"""A real VS Code without a screen: code-server from npm, served to a browser.

It is installed once, into a folder of the repository that git ignores. Each server has folders for
settings and extensions of its own.
"""

from __future__ import annotations

import contextlib
import json
import os
import platform
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
CACHE = ROOT / ".tmp" / "code-server"
"""Where code-server is installed; ``make clean`` removes it."""

VERSION = "4.139.1"
NODE = "24.21.0"
"""What code-server runs with, whatever Node.js the machine has."""

NPM = "npm"
_INSTALL = ("install", "--ignore-scripts", "--no-audit", "--no-fund", "--loglevel=error")
_INSTALL_LIMIT = 900.0
_SERVED = re.compile(r"HTTP server listening on (http://\S+?)/?\s*$")
_STOP_LIMIT = 60.0


@dataclass(frozen=True)
class CodeServer:
    """An installed code-server, with the folders of one user.

    Attributes:
        command: what starts it, without options.
        home: the folder of the user's settings and extensions.
    """

    command: tuple[str, ...]
    home: Path

    @property
    def log(self) -> Path:
        """What the server has written."""
        return self.home / "server.log"

    def install(self, extension: Path) -> None:
        """Install a packaged extension."""
        self._run("--install-extension", str(extension))

    def set(self, user: Mapping[str, Any], machine: Mapping[str, Any]) -> None:
        """Write the settings of the user, and those of the machine, such as names of programs."""
        for name, settings in {"User": user, "Machine": machine}.items():
            path = self.home / "data" / name / "settings.json"
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(json.dumps(settings), encoding="utf-8")

    @contextlib.contextmanager
    def served(self) -> Iterator[str]:
        """Serve VS Code; yield its address. No process is left behind."""
        alone = [sys.executable, str(ROOT / "tools/supervise.py"), *self.command]
        with self.log.open("w", encoding="utf-8") as log:
            process = subprocess.Popen(
                [*alone, *self._options, "--auth=none", "--bind-addr=127.0.0.1:0", *_QUIET],
                env=self._environment,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=log,
                text=True,
            )
            try:
                assert process.stdout is not None
                yield _address(process.stdout)
            finally:
                process.terminate()
                process.communicate(timeout=_STOP_LIMIT)

    @property
    def _options(self) -> list[str]:
        return [
            f"--config={self.home / 'config.yaml'}",
            f"--user-data-dir={self.home / 'data'}",
            f"--extensions-dir={self.home / 'extensions'}",
        ]

    @property
    def _environment(self) -> dict[str, str]:
        return {**os.environ, "HOME": str(self.home), "XDG_CACHE_HOME": str(self.home / "cache")}

    def _run(self, *options: str) -> None:
        done = subprocess.run(
            [*self.command, *self._options, *options],
            env=self._environment,
            capture_output=True,
            text=True,
            timeout=_INSTALL_LIMIT,
            check=False,
        )
        assert done.returncode == 0, done.stdout + done.stderr


_QUIET = (
    "--disable-telemetry",
    "--disable-update-check",
    "--disable-workspace-trust",
    "--disable-getting-started-override",
)


def code_server(home: Path) -> CodeServer:
    """Return code-server for a user whose folder is ``home``; install it where it is missing.

    A test that uses it needs ``npm``.
    """
    home.mkdir(parents=True, exist_ok=True)
    (home / "config.yaml").touch()  # else it takes that of the person who runs the tests
    folder = CACHE / VERSION
    if not folder.is_dir():
        _install(folder)
    modules = folder / "node_modules"
    entry = modules / "code-server/out/node/entry.js"
    return CodeServer((str(modules / _node_package() / "bin/node"), str(entry)), home)


def _install(folder: Path) -> None:
    """Install code-server; what was begun and not ended does not count as installed."""
    begun = folder.with_name(f"{folder.name}.{os.getpid()}")
    begun.mkdir(parents=True)
    try:
        wanted = {"code-server": VERSION, _node_package(): NODE}
        (begun / "package.json").write_text(
            json.dumps({"private": True, "dependencies": wanted}), encoding="utf-8"
        )
        vscode = begun / "node_modules/code-server/lib/vscode"
        for place, options in ((begun, ()), (vscode, ("--omit=dev",))):
            subprocess.run(
                [NPM, *_INSTALL, *options], cwd=place, check=True, timeout=_INSTALL_LIMIT
            )
        if not folder.is_dir():  # as another process may have been faster
            begun.rename(folder)
    finally:
        shutil.rmtree(begun, ignore_errors=True)


def _node_package() -> str:
    """Return the package of npm that has the program ``node`` for this machine."""
    machine = {"x86_64": "x64", "aarch64": "arm64"}[platform.machine()]
    return f"node-linux-{machine}"


def _address(lines: Iterator[str]) -> str:
    """Return the address at which a server says that it is."""
    said = []
    for line in lines:
        said.append(line)
        if found := _SERVED.search(line):
            return found[1]
    raise AssertionError("code-server has ended: " + "".join(said))
