"""One node of a name on this machine."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from deros.generators.safety_python.runtime.instance import Refusal, claim, file_stem

NAME = "/cell/robot_safety"


def test_a_second_claim_is_refused_and_names_the_first(tmp_path: Path) -> None:
    """The message tells the operator which process to look at."""
    with claim(NAME, 7, tmp_path):
        with pytest.raises(
            Refusal, match=f"{NAME} runs already in domain 7, as process"
        ) as refused:
            claim(NAME, 7, tmp_path)
        assert str(os.getpid()) in str(refused.value)


def test_other_names_and_domains_have_locks_of_their_own(tmp_path: Path) -> None:
    """Two robots, or two domains, on one machine do not hinder each other."""
    with (
        claim(NAME, 7, tmp_path),
        claim(NAME, 8, tmp_path),
        claim("/cell_robot_safety", 7, tmp_path),
    ):
        pass


def test_the_lock_ends_with_its_process(tmp_path: Path) -> None:
    """However it ends: a killed node can be started again at once."""
    code = (
        "import os, signal, sys; from pathlib import Path;"
        "from deros.generators.safety_python.runtime.instance import claim;"
        f"lock = claim({NAME!r}, 7, Path(sys.argv[1]));"
        "os.kill(os.getpid(), signal.SIGKILL)"
    )
    ended = subprocess.run([sys.executable, "-c", code, tmp_path], check=False)
    assert ended.returncode == -9
    with claim(NAME, 7, tmp_path) as lock:
        lock.seek(0)
        assert lock.read() == f"{os.getpid()}\n"


def test_the_usual_folder_is_the_users_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nobody else can hold the lock, and so keep the node from running."""
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    with claim(NAME, 7):
        (folder,) = tmp_path.iterdir()
        assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    monkeypatch.setattr(os, "getuid", lambda: folder.stat().st_uid + 1)
    (tmp_path / f"deros-{os.getuid()}").mkdir()
    with pytest.raises(PermissionError, match="belongs to another user"):
        claim(NAME, 7)


def test_a_long_name_makes_a_file_name_all_the_same() -> None:
    """Names of ROS 2 are longer than those of files, and still tell nodes apart."""
    stems = {file_stem("/" + "a" * 254 + end, 0) for end in "bc"}
    assert len(stems) == 2
    assert all(len(stem) < 200 for stem in stems)
