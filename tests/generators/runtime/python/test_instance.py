"""One node of each name on this machine."""

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


def test_second_claim_is_refused_and_names_the_first(tmp_path: Path) -> None:
    """The message has the process id for the operator."""
    with claim(NAME, 7, tmp_path):
        with pytest.raises(
            Refusal, match=f"{NAME} runs already in domain 7, as process"
        ) as refused:
            claim(NAME, 7, tmp_path)
        assert str(os.getpid()) in str(refused.value)


def test_other_names_and_domains_have_separate_locks(tmp_path: Path) -> None:
    """Two robots, or two domains, on one machine do not interfere."""
    with (
        claim(NAME, 7, tmp_path),
        claim(NAME, 8, tmp_path),
        claim("/cell_robot_safety", 7, tmp_path),
    ):
        pass


def test_lock_ends_with_its_process(tmp_path: Path) -> None:
    """A killed node can be restarted at once."""
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


def test_default_folder_is_private(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Other users cannot take the lock, and so prevent a start."""
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    with claim(NAME, 7):
        (folder,) = tmp_path.iterdir()
        assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    monkeypatch.setattr(os, "getuid", lambda: folder.stat().st_uid + 1)
    (tmp_path / f"deros-{os.getuid()}").mkdir()
    with pytest.raises(PermissionError, match="belongs to another user"):
        claim(NAME, 7)


def put_link(path: Path) -> None:
    """Create a link to another file."""
    path.symlink_to(path.with_name("other"))


def put_pipe(path: Path) -> None:
    """Create a pipe."""
    os.mkfifo(path)


@pytest.mark.parametrize("put", [put_link, put_pipe, Path.mkdir])
def test_lock_must_be_a_regular_file(tmp_path: Path, put: Callable[[Path], object]) -> None:
    """Nothing else is opened, waited for or written to."""
    put(tmp_path / f"{file_stem(NAME, 7)}.lock")
    before = sorted(tmp_path.iterdir())
    with pytest.raises(OSError, match="not a regular file"):
        claim(NAME, 7, tmp_path)
    assert sorted(tmp_path.iterdir()) == before


def test_lock_folder_must_be_private(tmp_path: Path) -> None:
    """Neither a link nor a folder writable by others is accepted."""
    link = tmp_path / "link"
    link.symlink_to(tmp_path)
    with pytest.raises(OSError, match="is not a folder"):
        claim(NAME, 7, link)
    tmp_path.chmod(0o777)
    with pytest.raises(OSError, match="others may write"):
        claim(NAME, 7, tmp_path)


def test_removed_lock_file_is_not_the_lock(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Two processes that open it around the removal do not both get the lock."""
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


def test_long_name_gives_a_valid_file_name() -> None:
    """ROS 2 names may be longer than file names, and must remain distinct."""
    stems = {file_stem("/" + "a" * 254 + end, 0) for end in "bc"}
    assert len(stems) == 2
    assert all(len(stem) < 200 for stem in stems)
