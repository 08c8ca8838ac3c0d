"""An SSH server of our own on the loopback interface, with keys and a configuration of its own."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
from pathlib import Path

ATTEMPTS = 5
"""How often a port is chosen: another process may take the free one before the server does."""


class SshServer:
    """A running ``sshd``, and the configuration of a client for which any address is this one."""

    def __init__(self, folder: Path) -> None:
        """Make keys, start the server, and return when it listens."""
        for name in ("host", "user", "stranger"):
            make = ["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", str(folder / name)]
            subprocess.run(make, check=True)
        shutil.copy(folder / "user.pub", folder / "authorized")
        (folder / "authorized").chmod(0o600)
        if os.geteuid() == 0:
            # The service of Debian makes it, which does not run in a container.
            Path("/run/sshd").mkdir(exist_ok=True)
        self._folder = folder
        for _ in range(ATTEMPTS):
            self.port = _free_port()
            if self._listens():
                break
            self.close()
        else:
            raise AssertionError(f"sshd does not start: {self._said}")

    def _listens(self) -> bool:
        (self._folder / "sshd_config").write_text(
            f"Port {self.port}\nListenAddress 127.0.0.1\nHostKey {self._folder}/host\n"
            f"AuthorizedKeysFile {self._folder}/authorized\nPidFile none\nStrictModes no\n"
            "UsePAM no\nPasswordAuthentication no\nKbdInteractiveAuthentication no\n"
            "MaxStartups 100\n"
        )
        program = shutil.which("sshd", path=f"{os.environ['PATH']}:/usr/sbin")
        assert program is not None
        command = [program, "-D", "-e", "-f", str(self._folder / "sshd_config")]
        self._process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
        assert self._process.stderr is not None
        self._said = ""
        for line in self._process.stderr:
            self._said += line
            if "Server listening" in line:
                return True
        return False

    def command(self, key: str = "user", *, is_known: bool = True, port: int | None = None) -> str:
        """Return the words of a client that has a key, and knows the key of the server or not."""
        config = self._folder / f"ssh_config_{key}_{is_known}_{port}"
        known = self._folder / f"known_{is_known}"
        public = (self._folder / "host.pub").read_text() if is_known else ""
        known.write_text(f"* {public}" if public else "")
        config.write_text(
            f"Host *\n  HostName 127.0.0.1\n  Port {port or self.port}\n  LogLevel ERROR\n"
            f"  IdentityFile {self._folder}/{key}\n  IdentitiesOnly yes\n"
            f"  UserKnownHostsFile {known}\n  GlobalKnownHostsFile none\n"
            "  StrictHostKeyChecking yes\n"
        )
        return f"ssh -F {config}"

    def close(self) -> None:
        """End the server; connections are processes of their own, which end with their clients."""
        self._process.terminate()
        self._process.wait()
        assert self._process.stderr is not None
        self._process.stderr.close()


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
        return port
