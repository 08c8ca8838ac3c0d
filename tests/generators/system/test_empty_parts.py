"""A namespace that is empty by default: the names of all that is in it are right without it."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.generators.builtin import rossystem_launch, rossystem_script
from deros.generators.output.writer import write
from tests.generators.system.test_arguments import (
    EYE,
    as_modelled,
    from_launch,
    from_script,
    launch_file,
    script_of,
)
from tests.support.cli import deros
from tests.support.lint import assert_lint_clean
from tests.support.systems import CONTEXT, load_text

OPEN = """system Open
argument robot : string = DEFAULT "Of all nodes"
imports import "*.rnd"
topics
  external topic /brim/scan
subsystem whole namespace $robot {
  topics
    external topic scan
    external topic near/scan
  remappings
    remap /tf to tf
  node eye : eye
  wirings
    connect scan to near/scan
  subsystem arm namespace arm {
    topics
      external topic hand/scan
    node hand : eye namespace hand
    node elbow : eye
    wirings
      connect scan to hand/scan
  }
  node outside : eye namespace /brim
  parameters
    param frame = "${robot}/eye"
  remappings
    remap "/${robot}/x/y" to "${robot}/z" when robot != ""
}
"""
TWICE = """system Twice
argument robot : string = "" "Of all nodes"
argument side : string = "" "Of the inner ones"
imports import "*.rnd"
subsystem whole namespace $robot {
  subsystem inner namespace $side {
    container box namespace $robot { node eye : eye }
  }
}
"""
DEFAULTS = ('""', 'env("ROBOT", "")')


@pytest.mark.parametrize("default", DEFAULTS)
def test_all_ways_start_the_same(
    default: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With and without the namespace, at the root and where the launch file is included."""
    monkeypatch.delenv("ROBOT", raising=False)
    system = load_text(tmp_path, OPEN.replace("DEFAULT", default), eye=EYE)
    script, text = script_of(system), launch_file(system)
    for robot in ("", "r2", "hall/r2"):
        expected = as_modelled(system, {"robot": robot})
        assert from_launch(text, {"robot": robot}) == expected
        included = from_launch(text, {"robot": robot}, root="/fleet")
        assert included == as_modelled(system, {"robot": robot}, "/fleet")
        if default == DEFAULTS[0]:  # the other one is started with what it looks up
            assert from_script(script, [f"robot:={robot}"]) == expected
    assert from_launch(text, {}) == as_modelled(system, {"robot": ""})


@pytest.mark.parametrize("default", DEFAULTS)
def test_it_checks_clean_and_up_starts_it(
    default: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What the check accepts by default, no way to start a system refuses."""
    monkeypatch.delenv("ROBOT", raising=False)
    path = tmp_path / "test.system"
    load_text(tmp_path, OPEN.replace("DEFAULT", default), eye=EYE)
    assert "error" not in deros("check", path).out
    started = deros("up", path, "--dry-run").out
    assert "//" not in started
    assert "__ns:=/arm/hand" in started
    assert "__ns:=/r2/arm/hand" in deros("up", path, "--dry-run", "--", "robot:=r2").out


@pytest.mark.parametrize("word", ["/", "/a", "a b", "a/", "a//b"])
def test_what_is_no_namespace_is_still_refused(word: str, tmp_path: Path) -> None:
    """Only the empty text is accepted in addition."""
    system = load_text(tmp_path, OPEN.replace("DEFAULT", '""'), eye=EYE)
    with pytest.raises(ValueError, match="relative namespace"):
        from_script(script_of(system), [f"robot:={word}"])
    with pytest.raises(ValueError, match="or empty"):
        from_launch(launch_file(system), {"robot": word})


def test_another_default_means_that_it_is_not_empty(tmp_path: Path) -> None:
    """Names without it have not been checked then."""
    system = load_text(tmp_path, OPEN.replace("DEFAULT", '"r1"'), eye=EYE)
    with pytest.raises(ValueError, match="relative namespace"):
        from_script(script_of(system), ["robot:="])
    with pytest.raises(ValueError, match="relative namespace"):
        from_launch(launch_file(system), {"robot": ""})


def test_generated_code_is_lint_clean(tmp_path: Path) -> None:
    """The linters of ament find nothing in either file."""
    system = load_text(tmp_path, OPEN.replace("DEFAULT", '""'), eye=EYE)
    write(
        {**rossystem_launch(system, CONTEXT), **rossystem_script(system, CONTEXT)}, tmp_path / "o"
    )
    assert_lint_clean(tmp_path / "o")


@pytest.mark.parametrize(
    ("given", "name"),
    [
        ([], "/box"),
        (["robot:=r"], "/r/r/box"),
        (["side:=left"], "/left/box"),
        (["robot:=r", "side:=left"], "/r/left/r/box"),
    ],
)
def test_several_empty_parts_in_a_row(given: list[str], name: str, tmp_path: Path) -> None:
    """A node is loaded into the container of the system, under whatever name it has."""
    part = EYE.replace("eyes", 'eyes plugin "eyes::Eye"', 1)
    script = script_of(load_text(tmp_path, TWICE, eye=part))
    box, eye = script.nodes(script.given(script.ARGUMENTS, given))
    assert (box.full_name, eye.container) == (name, name)
