"""``deros diff``: exit codes, both formats, folders, and revisions of a git repository."""

from __future__ import annotations

import json
import os
import signal
from pathlib import Path

import pytest

from deros.cli.interrupts import removed_at_interrupt
from tests.support.cli import Outcome, deros
from tests.support.git import git
from tests.support.needs import needs

DOCUMENTED = (Path(__file__).resolve().parents[3] / "docs" / "diff.md").read_text(encoding="utf-8")

LIDAR = """\
node lidar : drivers
parameters
  name rate : double = 10.0 [1/s]
publishes
  topic scan : sensor_msgs.LaserScan qos reliable
"""
WEAKER = LIDAR.replace("reliable", "best_effort")
FASTER = LIDAR.replace("10.0", "20.0")


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Work in a folder with two versions of a node."""
    monkeypatch.chdir(tmp_path)
    Path("old.rnd").write_text(LIDAR)
    Path("new.rnd").write_text(LIDAR)
    return tmp_path


def diff(*arguments: str) -> Outcome:
    """Run the command."""
    return deros("diff", *arguments)


@pytest.mark.usefixtures("here")
def test_text_shows_places_values_and_whom_a_change_breaks() -> None:
    """Each change is a line, and what it breaks is the next one, as docs/diff.md shows."""
    Path("new.rnd").write_text("// newer\n" + WEAKER.replace("10.0", "20.0"))
    outcome = diff("old.rnd", "new.rnd")
    assert outcome.code == 1
    assert outcome.out.splitlines() == [
        "old.rnd -> new.rnd",
        "  ~ parameter rate, default: 10.0 -> 20.0  (old.rnd:3 -> new.rnd:4)",
        "  ~ publisher scan, QoS reliability: reliable -> best_effort  (old.rnd:5 -> new.rnd:6)",
        "      breaking: subscribers that request reliable are not connected any more",
        "2 changes, 1 breaking",
    ]
    assert f"$ deros diff old.rnd new.rnd\n{outcome.out}```" in DOCUMENTED
    assert diff("old.rnd", "new.rnd", "--breaking").out.splitlines()[1:] == [
        "  ~ publisher scan, QoS reliability: reliable -> best_effort  (old.rnd:5 -> new.rnd:6)",
        "      breaking: subscribers that request reliable are not connected any more",
        "1 change, 1 breaking",
    ]


@pytest.mark.usefixtures("here")
@pytest.mark.parametrize(
    ("text", "code", "telling"), [(LIDAR, 0, 0), (FASTER, 0, 3), (WEAKER, 1, 1)]
)
def test_exit_code_tells_breaking_from_compatible(text: str, code: int, telling: int) -> None:
    """Compatible changes have a code of their own on request."""
    Path("new.rnd").write_text(text)
    assert diff("old.rnd", "new.rnd").code == code
    assert diff("old.rnd", "new.rnd", "--exit-code").code == telling
    assert diff("old.rnd", "new.rnd", "--exit-code", "--breaking").code == telling


@pytest.mark.usefixtures("here")
def test_json_has_the_documented_form() -> None:
    """Scripts rely on its keys."""
    Path("new.rnd").write_text(WEAKER)
    assert json.loads(diff("old.rnd", "new.rnd", "--format", "json").out) == {
        "changes": 1,
        "breaking": 1,
        "files": [
            {
                "old": "old.rnd",
                "new": "new.rnd",
                "changes": [
                    {
                        "kind": "changed",
                        "part": "publisher",
                        "name": "scan",
                        "aspect": "QoS reliability",
                        "old": "reliable",
                        "new": "best_effort",
                        "breaking": True,
                        "why": "subscribers that request reliable are not connected any more",
                        "old_place": {"file": "old.rnd", "line": 5, "column": 9},
                        "new_place": {"file": "new.rnd", "line": 5, "column": 9},
                    }
                ],
            }
        ],
    }


@pytest.mark.usefixtures("here")
def test_folders_are_compared_model_by_model() -> None:
    """Models correspond by their paths; those without another are new or gone."""
    extra = "node x : extras"
    for name, text in (("a/lidar.rnd", LIDAR), ("b/lidar.rnd", WEAKER), ("b/x.rnd", extra)):
        Path(name).parent.mkdir(exist_ok=True)
        Path(name).write_text(text)
    report = json.loads(diff("a", "b", "--format", "json").out)
    assert [(each["old"], each["new"]) for each in report["files"]] == [
        ("lidar.rnd", "lidar.rnd"),
        (None, "x.rnd"),
    ]
    assert (report["changes"], report["breaking"]) == (2, 1)
    assert diff("a", "a").out == "no change\n"


@pytest.mark.usefixtures("here")
@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["old.rnd"], "it takes OLD and NEW"),
        (["old.rnd", "new.rnd", "old.rnd"], "it takes OLD and NEW"),
        (["--since", "main", "old.rnd", "new.rnd"], "one path"),
        (["old.rnd", "robot.system"], "models of two languages"),
        (["old.rnd", "."], "not a file with a folder"),
    ],
)
def test_mistakes_on_the_command_line(arguments: list[str], words: str) -> None:
    """They are said, and have the code of wrong usage."""
    outcome = diff(*arguments)
    assert outcome.code == 2
    assert words in outcome.err


@pytest.mark.usefixtures("here")
def test_errors_are_reported_as_by_check_and_nothing_is_compared() -> None:
    """A model that does not check has no meaning that could be compared."""
    Path("new.rnd").write_text(LIDAR.replace("LaserScan", "LaserScam"))
    outcome = diff("old.rnd", "new.rnd")
    assert outcome.code == 1
    assert outcome.out == ""
    assert "new.rnd:5:16: error[DRS" in outcome.err
    assert "nothing is compared" in outcome.err
    assert diff("old.rnd", "missing.rnd").code == 2


@pytest.fixture
def repository(here: Path) -> Path:
    """Work in a folder of a git repository whose first revision is ``first``."""
    folder = here / "robot"
    folder.mkdir()
    os.chdir(folder)
    Path("lidar.rnd").write_text(LIDAR)
    Path("link.rnd").symlink_to("/etc/hostname")
    git(Path(), "init", "-q", "..")
    git(Path(), "add", "lidar.rnd", "link.rnd")
    git(Path(), "commit", "-q", "-m", "Lidar")
    git(Path(), "tag", "first")
    Path("link.rnd").unlink()
    return folder


@needs("git")
@pytest.mark.usefixtures("repository")
def test_revision_is_compared_with_the_working_tree() -> None:
    """Its files are read from git, and the user's tree stays as it is."""
    Path("lidar.rnd").write_text(WEAKER)
    before = git(Path(), "status", "--porcelain")
    outcome = diff("--since", "first", "lidar.rnd")
    assert outcome.code == 1
    assert outcome.out.splitlines()[:2] == [
        "first:robot/lidar.rnd -> lidar.rnd",
        "  ~ publisher scan, QoS reliability: reliable -> best_effort"
        "  (first:robot/lidar.rnd:5 -> lidar.rnd:5)",
    ]
    assert git(Path(), "status", "--porcelain") == before


@needs("git")
@pytest.mark.usefixtures("repository")
def test_folder_of_a_revision_is_compared() -> None:
    """What the working tree has besides is new; a link out of the repository is not followed."""
    Path("x.rnd").write_text("node x : extras")
    report = json.loads(diff("--since", "first", ".", "--format", "json").out)
    assert [(each["old"], each["new"]) for each in report["files"]] == [(None, "x.rnd")]


@needs("git")
@pytest.mark.usefixtures("repository")
def test_errors_in_a_revision_name_it() -> None:
    """A temporary folder is nowhere to be seen."""
    Path("bad.rnd").write_text("node")
    git(Path(), "add", "bad.rnd")
    git(Path(), "commit", "-q", "-m", "Bad")
    Path("bad.rnd").write_text("node x : extras")
    outcome = diff("--since", "HEAD", "bad.rnd")
    assert outcome.code == 1
    assert outcome.err.startswith("HEAD:robot/bad.rnd:1:")


@needs("git")
@pytest.mark.usefixtures("repository")
@pytest.mark.parametrize("revision", ["second", "--help", "-h", "first:robot/lidar.rnd"])
def test_unknown_revision_is_wrong_usage(revision: str) -> None:
    """Whatever its name looks like."""
    outcome = diff(f"--since={revision}", "lidar.rnd")
    assert outcome.code == 2
    assert "git: " in outcome.err


@needs("git")
@pytest.mark.usefixtures("repository")
def test_path_that_a_revision_lacks_is_wrong_usage() -> None:
    """It is new as a whole."""
    Path("x.rnd").write_text("node x : extras")
    outcome = diff("--since", "first", "x.rnd")
    assert outcome.code == 2
    assert "'x.rnd' is not in revision 'first'" in outcome.err


@needs("git")
@pytest.mark.usefixtures("here")
def test_folder_without_repository_is_wrong_usage(monkeypatch: pytest.MonkeyPatch) -> None:
    """Git says so."""
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", str(Path.cwd().parent))
    outcome = diff("--since", "main", "new.rnd")
    assert outcome.code == 2
    assert "git: not a git repository" in outcome.err


def test_interrupt_leaves_no_temporary_folder(tmp_path: Path) -> None:
    """The folder of a revision is gone before the handler ends the process; none stays after."""
    folder = tmp_path / "revision"
    folder.mkdir()
    seen: list[bool] = []
    before = signal.signal(signal.SIGINT, lambda *_: seen.append(folder.exists()))
    try:
        with removed_at_interrupt(folder):
            signal.raise_signal(signal.SIGINT)
        folder.mkdir()
        signal.raise_signal(signal.SIGINT)
    finally:
        signal.signal(signal.SIGINT, before)
    assert seen == [False, True]


@needs("git")
@pytest.mark.usefixtures("here")
def test_machine_without_git_is_wrong_usage(monkeypatch: pytest.MonkeyPatch) -> None:
    """Only revisions need it."""
    monkeypatch.setenv("PATH", "")
    outcome = diff("--since", "main", "new.rnd")
    assert outcome.code == 2
    assert "git is not installed" in outcome.err
    assert diff("old.rnd", "new.rnd").code == 0
