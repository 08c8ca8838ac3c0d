"""Files of another target or model are not replaced, and then nothing is written."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests.support.cli import deros

pytestmark = pytest.mark.usefixtures("own_folder")

NODE = "node base : drive publishes topic odom : std_msgs.String"
SYSTEM = 'system Robot imports import "base.rnd" node BASE : base'


def generate(model: str, target: str, *more: str) -> tuple[int, str]:
    """Generate into ``out``; return the exit code and the messages."""
    done = deros("generate", model, "--target", target, "-o", "out", *more)
    return done.code, done.err


def tree() -> dict[str, bytes]:
    """Return everything in ``out``."""
    return {str(p): p.read_bytes() for p in Path("out").rglob("*") if p.is_file()}


@pytest.mark.parametrize(("first", "second"), [("python", "cpp"), ("cpp", "python")])
@pytest.mark.parametrize("recorded", [True, False])
def test_package_has_one_language(first: str, second: str, recorded: bool) -> None:
    """The second language is rejected, even if the package has no record."""
    Path("base.rnd").write_text(NODE)
    assert generate("base.rnd", first)[0] == 0
    if not recorded:
        Path("out/.deros-origins.json").unlink()
    before = tree()
    code, errors = generate("base.rnd", second)
    assert code == 1
    assert "DRS406" in errors
    assert "--overwrite" not in errors
    assert tree() == before
    assert generate("base.rnd", first) == (0, "")
    shutil.rmtree("out/drive")
    assert generate("base.rnd", second)[0] == 0


def test_nodes_of_one_package_in_two_folders_are_rejected() -> None:
    """The second run would omit the first node from the package's setup.py."""
    for folder, node in (("a", "one"), ("b", "two")):
        Path(folder).mkdir()
        Path(folder, f"{node}.rnd").write_text(NODE.replace("base", node))
    assert generate("a/one.rnd", "python")[0] == 0
    before = tree()
    code, errors = generate("b/two.rnd", "python")
    assert (code, tree()) == (1, before)
    assert errors.count("DRS406") == 1
    assert "'python' from '../a'" in errors
    Path("a/three.rnd").write_text(NODE.replace("base", "three"))
    assert generate("a/three.rnd", "python")[0] == 0  # the same package, from the other file


def test_two_systems_of_one_name_are_rejected() -> None:
    """A launch file of the same name would start another robot."""
    Path("base.rnd").write_text(NODE)
    for name in ("left", "right"):
        Path(f"{name}.system").write_text(SYSTEM.replace("BASE", name))
    for target in ("launch", "script"):
        assert generate("left.system", target)[0] == 0
        code, errors = generate("right.system", target)
        assert code == 1
        assert f"'{target}' from '../left.system'" in errors


def test_identical_output_is_accepted() -> None:
    """Two models may generate the same file."""
    Path("base.rnd").write_text(NODE)
    for name in ("left", "right"):
        Path(f"{name}.system").write_text(SYSTEM.replace("BASE", "base"))
        assert generate(f"{name}.system", "launch")[0] == 0


def test_moved_model_takes_over_its_files() -> None:
    """Its old path no longer exists, so no other model generates the files."""
    Path("base.rnd").write_text(NODE)
    Path("left.system").write_text(SYSTEM)
    assert generate("left.system", "launch")[0] == 0
    Path("left.system").unlink()
    Path("right.system").write_text(SYSTEM.replace("BASE", "other"))
    assert generate("right.system", "launch")[0] == 0
    assert "other" in Path("out/robot.launch.py").read_text()


@pytest.mark.parametrize("text", ["", "[]", "{", '{"made by": [{"files": 1}]}', "\udcff"])
def test_unreadable_record_is_replaced(text: str) -> None:
    """Only the information about earlier runs is lost."""
    Path("base.rnd").write_text(NODE)
    Path("out").mkdir()
    Path("out/.deros-origins.json").write_bytes(text.encode(errors="surrogateescape"))
    assert generate("base.rnd", "python")[0] == 0
    assert '"python"' in Path("out/.deros-origins.json").read_text()
