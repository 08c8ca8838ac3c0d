"""``deros draw``: zones to scale, out of rules without an error."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree as Xml

import pytest
from click.testing import CliRunner, Result

from deros.cli.commands.graphs.draw import draw
from tests.report.areas.test_plans import RULES, SYSTEM


@pytest.fixture
def rules(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Write rules with zones, and go to their folder."""
    (tmp_path / "base.system").write_text(SYSTEM, encoding="utf-8")
    (tmp_path / "base.deros").write_text(RULES, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path / "base.deros"


def run(*arguments: str) -> Result:
    """Run the command."""
    return CliRunner().invoke(draw, arguments)


def test_a_picture_is_written_to_standard_output(rules: Path) -> None:
    """Findings go beside it, and do not spoil it; warnings do not fail the command."""
    found = run(rules.name)
    assert found.exit_code == 0, found.output
    root = Xml.fromstring(found.stdout)
    assert root.tag == "{http://www.w3.org/2000/svg}svg"
    assert "warning[" in found.stderr
    assert "The zones of base" in found.stdout


def test_a_page_has_the_robot_in_it(rules: Path) -> None:
    """One file that needs no other."""
    found = run(rules.name, "--format", "html", "--outline", "circle (0, 0) 20 cm")
    assert found.exit_code == 0, found.output
    assert found.stdout.startswith("<!doctype html>")
    assert "dashed: the robot, circle (0, 0) 20 cm" in found.stdout
    assert "http" not in found.stdout.replace("http://www.w3.org/2000/svg", "")


def test_rules_with_an_error_are_not_drawn(rules: Path) -> None:
    """The exit code is that of a check."""
    rules.write_text(RULES.replace("circle (0, 0) 2 shoe", "circle (0, 0) 0 m"), encoding="utf-8")
    found = run(rules.name)
    assert (found.exit_code, found.stdout) == (1, "")
    assert "DRS601" in found.stderr


@pytest.mark.parametrize(
    ("outline", "said"),
    [
        ("circle", "'circle' is no shape"),
        ("circle (0, 0) 2", "no shape with a unit of length"),
        ("circle (0, 0) 0 m", "no area"),
    ],
)
def test_a_wrong_outline_is_a_wrong_use(rules: Path, outline: str, said: str) -> None:
    """It says how one is written, and nothing is drawn."""
    found = run(rules.name, "--outline", outline)
    assert found.exit_code == 2
    assert said in found.stderr
    assert "rectangle (-0.3, -0.2) (0.3, 0.2) m" in " ".join(found.stderr.split())
    assert found.stdout == ""


def test_rules_without_zones_are_told_how_to_have_one(rules: Path) -> None:
    """There is nothing to see."""
    text = RULES[: RULES.index("zone front")]
    rules.write_text(
        f"{text}entity e {{ r: scan.missing(); }} if e.r then {{ stop; }};", encoding="utf-8"
    )
    found = run(rules.name)
    assert found.exit_code == 2
    assert "ask for no zone" in " ".join(found.stderr.split())


def test_a_system_is_refused(rules: Path) -> None:
    """It has no zones: `deros graph` shows it."""
    found = run("base.system")
    assert found.exit_code == 2
    assert "*.deros" in found.stderr
    assert rules.exists()
