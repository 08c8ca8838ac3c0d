"""Files named by parameters: missing files are reported where the path can be resolved."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.interfaces.store import InterfaceStore
from tests.support.checks import checked


@pytest.fixture
def prefix(tmp_path: Path) -> Path:
    """Return an install prefix with a package that has one file, next to a system with maps."""
    prefix = tmp_path / "install"
    for name in ("share/ament_index/resource_index/packages/arm", "share/arm/urdf/arm.urdf"):
        path = prefix / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("")
    (tmp_path / "maps").mkdir()
    (tmp_path / "maps/office.yaml").write_text("")
    (tmp_path / "maps/area.world").mkdir()
    return prefix


def _findings(folder: Path, prefix: Path, value: str, name: str = "file") -> list[tuple[str, str]]:
    kind = "string[]" if value.startswith("[") else "string"
    default = '[""]' if kind == "string[]" else '""'
    (folder / "n.rnd").write_text(f"node n : pkg\nparameters\n  name {name} : {kind} = {default}\n")
    (folder / "s.system").write_text(
        f'system S\nimports import "n.rnd"\nnode n : n\nparameters\n  param {name} = {value}\n'
    )
    findings = checked(folder / "s.system", store=InterfaceStore((), prefixes=[prefix]))
    assert {each.code.name for each in findings} <= {"DRS028"}, findings
    return [(each.span.text, each.hint) for each in findings]


@pytest.mark.parametrize(
    ("value", "hint"),
    [
        ('"maps/ofice.yaml"', "did you mean 'office.yaml'?"),
        ('"./maps/ofice.yaml"', "did you mean 'office.yaml'?"),
        ('"maps/deep/office.YAML"', "its folder does not exist either"),
        ('"package://arm/urdf/amr.urdf"', "did you mean 'arm.urdf'?"),
        ('"share:arm/urdf/amr.urdf"', "did you mean 'arm.urdf'?"),
        ('["maps/office.yaml", "maps/x/y.pgm"]', "its folder does not exist either"),
    ],
)
def test_missing_file_is_reported(tmp_path: Path, prefix: Path, value: str, hint: str) -> None:
    """Paths relative to the system and in the share folder of an installed package are checked."""
    assert _findings(tmp_path, prefix, value) == [(value, hint)]


@pytest.mark.parametrize(
    "value",
    [
        '"maps/office.yaml"',
        '"maps/area.world"',
        '"maps/../maps/office.yaml"',
        '"package://arm/urdf/arm.urdf"',
        '"share:arm/urdf"',
        '"package://unknown/urdf/arm.urdf"',
        '"package://arm"',
        '"/opt/robot/maps/ofice.yaml"',
        '"file:///maps/ofice.yaml"',
        '"https://example.com/maps/a.yaml"',
        '"elsewhere/a.yaml"',
        '"ofice.yaml"',
        '"maps/odom"',
        '"maps/odom.twist"',
        '"maps/*.yaml"',
        '"~/maps/a.yaml"',
        '"$HOME/maps/a.yaml"',
        '"nav2_msgs/action/Dock"',
        '""',
    ],
)
def test_existing_or_unresolvable_paths_are_not_reported(
    tmp_path: Path, prefix: Path, value: str
) -> None:
    """Existing files, absolute paths on the robot and values that are not paths give no finding."""
    assert _findings(tmp_path, prefix, value) == []


@pytest.mark.parametrize("name", ["log_file", "output", "save_to", "recording"])
def test_output_files_need_not_exist(tmp_path: Path, prefix: Path, name: str) -> None:
    """Parameters whose names suggest an output are not checked."""
    assert _findings(tmp_path, prefix, '"maps/new.yaml"', name) == []


def test_only_package_paths_of_defaults_are_checked(tmp_path: Path, prefix: Path) -> None:
    """The relative path in a default has no known base folder."""
    path = tmp_path / "n.rnd"
    path.write_text(
        'node n : pkg\nparameters\n  name a : string = "package://arm/urdf/amr.urdf"\n'
        '  name b : string = "maps/ofice.yaml"\n'
    )
    findings = checked(path, store=InterfaceStore((), prefixes=[prefix]))
    assert [(each.code.name, each.span.line) for each in findings] == [("DRS028", 3)]
