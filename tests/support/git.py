"""A git that neither the user's settings nor a surrounding repository change."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path


def git(folder: Path, *arguments: str, **environment: str) -> str:
    """Run git in a folder; return what it prints.

    Args:
        folder: where it runs.
        arguments: its words.
        environment: variables besides those of this process.
    """
    own = {key: value for key, value in os.environ.items() if not key.startswith("GIT_")}
    own |= {"GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_SYSTEM": os.devnull}
    command = ["git", "-c", "user.name=Jane", "-c", "user.email=jane@example.com", *arguments]
    done = subprocess.run(
        command, cwd=folder, env=own | environment, capture_output=True, text=True, check=True
    )
    return done.stdout
