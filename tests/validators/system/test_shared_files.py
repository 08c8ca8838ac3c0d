"""Files and containers that stand for more than one system."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.support.cli import deros

NODE = 'node part : parts plugin "parts::Part" parameters open'
SECTION = "{}:\n  ros__parameters: {{gain: 2.5}}\n"


@pytest.mark.parametrize(
    ("key", "path", "is_reported"),
    [
        ("simulator", "share:parts/all.yaml", False),
        ("simulator", "all.yaml", True),
        ("other/a", "share:parts/all.yaml", True),
        ("/**/nobody", "share:parts/all.yaml", False),
    ],
)
def test_sections_of_a_package_may_be_for_others(
    key: str, path: str, is_reported: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One that ends like a node of the system is meant for that."""
    share = tmp_path / "prefix" / "share"
    index = share / "ament_index" / "resource_index" / "packages"
    for folder in (share / "parts", index):
        folder.mkdir(parents=True)
    (index / "parts").touch()
    for folder in (share / "parts", tmp_path):
        (folder / "all.yaml").write_text(SECTION.format("a") + SECTION.format(key))
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "prefix"))
    (tmp_path / "part.rnd").write_text(NODE)
    system = tmp_path / "s.system"
    system.write_text(f'system S imports import "part.rnd" node a : part parameters from "{path}"')
    outcome = deros("check", system)
    assert ("DRS260" in outcome.out + outcome.err) == is_reported
    assert "DRS262" not in outcome.out + outcome.err


def test_container_has_no_time(tmp_path: Path) -> None:
    """Its nodes may have simulated time; another node that has not is reported."""
    (tmp_path / "part.rnd").write_text(NODE)
    body = """system S imports import "part.rnd" topics external topic /clock
    container main { node a : part parameters param use_sim_time = true }
    """
    system = tmp_path / "s.system"
    system.write_text(body)
    outcome = deros("check", "--strict", system)
    assert "DRS247" not in outcome.out + outcome.err
    system.write_text(f"{body} node b : part")
    outcome = deros("check", "--strict", system)
    assert "DRS247" in outcome.out + outcome.err


@pytest.mark.parametrize(
    ("path", "is_installed", "is_reported"),
    [
        ('"share:parts/all.yaml"', False, False),
        ('"share:parts/all.yaml"', True, True),
        ("$path", False, False),
        ('"all.yaml"', False, True),
    ],
)
def test_value_may_stand_in_a_file_that_is_not_here(
    path: str,
    is_installed: bool,
    is_reported: bool,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Neither is it missing for a node in the process of the one that reads the file."""
    share = tmp_path / "prefix" / "share"
    index = share / "ament_index" / "resource_index" / "packages"
    for folder in (share / "parts", index):
        folder.mkdir(parents=True)
    if is_installed:
        (index / "parts").touch()
    for folder in (share / "parts", tmp_path):
        (folder / "all.yaml").write_text(SECTION.format("a"))
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "prefix"))
    (tmp_path / "part.rnd").write_text(NODE)
    (tmp_path / "needy.rnd").write_text(
        'node needy : parts executable "needy" parameters name joint : string'
    )
    system = tmp_path / "s.system"
    system.write_text(
        f"""system S imports import "*.rnd" argument path : string
        node a : part parameters from {path}
        node b : needy parameters from {path}
        inside a {{ node c : needy }}
        """
    )
    outcome = deros("check", system)
    lines = (outcome.out + outcome.err).splitlines()
    found = [each.split("parameter-without-value]: ")[1] for each in lines if "DRS227" in each]
    rest = "has neither a default nor a value"
    wanted = [f"parameter 'joint' of '{name}' {rest}" for name in "bc"]
    assert found == (wanted if is_reported else [])
