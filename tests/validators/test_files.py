"""Files that parameters name: found missing where that can be known, silence elsewhere."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.validators.check import check


@pytest.fixture
def prefix(tmp_path: Path) -> Path:
    """Return an install space with a package that has one file, beside a system with maps."""
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
    repository = Repository()
    named = [repository.load(folder / "s.system")]
    found = check(named, repository, InterfaceStore((), prefixes=[prefix]))
    assert {each.code.name for each in found} <= {"DRS028"}, found
    return [(each.span.text, each.hint) for each in found]


@pytest.mark.parametrize(
    ("value", "hint"),
    [
        ('"maps/ofice.yaml"', "did you mean 'office.yaml'?"),
        ('"./maps/ofice.yaml"', "did you mean 'office.yaml'?"),
        ('"maps/deep/office.YAML"', "there is no such folder either"),
        ('"package://arm/urdf/amr.urdf"', "did you mean 'arm.urdf'?"),
        ('"share:arm/urdf/amr.urdf"', "did you mean 'arm.urdf'?"),
        ('["maps/office.yaml", "maps/x/y.pgm"]', "there is no such folder either"),
    ],
)
def test_missing_files_are_found(tmp_path: Path, prefix: Path, value: str, hint: str) -> None:
    """Beside the system, and in the share folder of a package that is installed."""
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
def test_nothing_is_said_where_nothing_can_be_known(
    tmp_path: Path, prefix: Path, value: str
) -> None:
    """Files that are there, paths of the robot, names that are no paths."""
    assert _findings(tmp_path, prefix, value) == []


@pytest.mark.parametrize("name", ["log_file", "output", "save_to", "recording"])
def test_files_that_a_node_writes_need_not_be_there(
    tmp_path: Path, prefix: Path, name: str
) -> None:
    """The parameter's name tells."""
    assert _findings(tmp_path, prefix, '"maps/new.yaml"', name) == []


def test_defaults_name_files_of_packages(tmp_path: Path, prefix: Path) -> None:
    """A default's relative path is relative to nothing known."""
    path = tmp_path / "n.rnd"
    path.write_text(
        'node n : pkg\nparameters\n  name a : string = "package://arm/urdf/amr.urdf"\n'
        '  name b : string = "maps/ofice.yaml"\n'
    )
    repository = Repository()
    found = check([repository.load(path)], repository, InterfaceStore((), prefixes=[prefix]))
    assert [(each.code.name, each.span.line) for each in found] == [("DRS028", 3)]
