"""One node of a name on this machine."""

from __future__ import annotations

import fcntl
import os
import stat
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import IO

import pytest

from deros.generators.runtime.python.deros_runtime.instance import Refusal, claim, file_stem

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
        "from deros.generators.runtime.python.deros_runtime.instance import claim;"
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


def put_link(path: Path) -> None:
    """Put a link to another file."""
    path.symlink_to(path.with_name("other"))


def put_pipe(path: Path) -> None:
    """Put a pipe."""
    os.mkfifo(path)


@pytest.mark.parametrize("put", [put_link, put_pipe, Path.mkdir])
def test_a_lock_is_a_regular_file(tmp_path: Path, put: Callable[[Path], object]) -> None:
    """Nothing else is opened, waited for or written to."""
    put(tmp_path / f"{file_stem(NAME, 7)}.lock")
    before = sorted(tmp_path.iterdir())
    with pytest.raises(OSError, match="not a regular file"):
        claim(NAME, 7, tmp_path)
    assert sorted(tmp_path.iterdir()) == before


def test_the_folder_of_the_locks_is_the_users_alone(tmp_path: Path) -> None:
    """Neither a link nor a folder in which others may write will do."""
    link = tmp_path / "link"
    link.symlink_to(tmp_path)
    with pytest.raises(OSError, match="is not a folder"):
        claim(NAME, 7, link)
    tmp_path.chmod(0o777)
    with pytest.raises(OSError, match="others may write"):
        claim(NAME, 7, tmp_path)


def test_a_lock_that_is_removed_is_not_taken_for_the_lock(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two processes that open it around the removal do not both hold one."""
    path = tmp_path / f"{file_stem(NAME, 7)}.lock"
    real, taken = fcntl.flock, 0

    def removing(file: IO[str], how: int) -> None:
        nonlocal taken
        taken += 1
        if taken == 1:
            path.unlink()
        real(file, how)

    monkeypatch.setattr(fcntl, "flock", removing)
    with claim(NAME, 7, tmp_path) as lock:
        assert os.path.samestat(path.stat(), os.fstat(lock.fileno()))
    assert taken == 2


def test_a_long_name_makes_a_file_name_all_the_same() -> None:
    """Names of ROS 2 are longer than those of files, and still tell nodes apart."""
    stems = {file_stem("/" + "a" * 254 + end, 0) for end in "bc"}
    assert len(stems) == 2
    assert all(len(stem) < 200 for stem in stems)
