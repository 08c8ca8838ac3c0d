"""elkjs is fetched from npm, and held against the digest of the one that was tested."""

from __future__ import annotations

import io
import tarfile
from pathlib import Path

import pytest

from deros.report.page import elkjs
from tests.support.needs import may_run
from tools import fetch_elkjs

SCRIPT = b"var ELK;"


def _archive(**members: bytes) -> bytes:
    found = io.BytesIO()
    with tarfile.open(fileobj=found, mode="w:gz") as archive:
        for name, content in members.items():
            member = tarfile.TarInfo(f"package/{name}")
            member.size = len(content)
            archive.addfile(member, io.BytesIO(content))
    return found.getvalue()


def _package(script: bytes = SCRIPT) -> bytes:
    return _archive(**{f"lib/{elkjs.FILE}": script, "LICENSE.md": b"EPL"})


@pytest.fixture
def tested(monkeypatch: pytest.MonkeyPatch) -> None:
    """Take a short script for the elkjs that was tested."""
    monkeypatch.setattr(fetch_elkjs, "DIGEST", fetch_elkjs._digest(SCRIPT))


@pytest.mark.usefixtures("tested")
def test_script_is_put_beside_its_licence(tmp_path: Path) -> None:
    """Then it is there, and another text in its place is not it."""
    folder = tmp_path / "elkjs"
    assert not fetch_elkjs.is_there(folder)
    fetch_elkjs.unpack(_package(), folder)
    assert (folder / "LICENSE.md").read_bytes() == b"EPL"
    assert fetch_elkjs.is_there(folder)
    (folder / elkjs.FILE).write_bytes(b"var ELK = 1;")
    assert not fetch_elkjs.is_there(folder)


@pytest.mark.usefixtures("tested")
@pytest.mark.parametrize(
    "archive",
    [_package(b"var ELK = evil;"), _archive(**{"LICENSE.md": b"EPL"}), _archive(lib=b"")],
    ids=["another script", "no script", "nothing"],
)
def test_other_archive_is_refused_and_leaves_nothing(tmp_path: Path, archive: bytes) -> None:
    """What was not tested does not come into a release."""
    with pytest.raises(fetch_elkjs.Failure):
        fetch_elkjs.unpack(archive, tmp_path / "elkjs")
    assert not (tmp_path / "elkjs").exists()


@may_run("npm")
def test_without_npm_the_rest_goes_on(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Setting up says what will be missing; the target of its own fails."""
    monkeypatch.setenv("PATH", "")
    monkeypatch.setattr(fetch_elkjs, "is_there", lambda: False)
    assert fetch_elkjs.main(["--if-possible"]) == 0
    assert fetch_elkjs.main([]) == 1
    assert capsys.readouterr().err.count("there is no npm") == 2
