"""Bearings of a sector: doubtful ones are reported, with a hint that fixes them."""

from __future__ import annotations

import pytest

from deros.diagnostics import Diagnostic
from tests.support.rules import build_rules


def _findings(sector: str, constants: str = "") -> list[Diagnostic]:
    rules = f"{constants} input s = topic /scan timeout 1 sec\n"
    return list(build_rules(f"{rules} entity e {{ r: s.nearest({sector}) < 1; }}").diagnostics)


@pytest.mark.parametrize(
    "sector",
    [
        "-30 deg, 30 deg",
        "-0.5, 0.5",
        "-1.0, 1.0",
        "0, 90 deg",
        "0 deg, 360 deg",
        "-180 deg, 180 deg",
        "-3.1416, 3.1416",
        "150 deg, -150 deg",
        "90 deg, -90 deg",
        "100 deg, -100 deg",
        "270 deg, 360 deg",
        "-4.71, -1.57",
        "1 rad, 2 rad",
        "-view, view",
    ],
)
def test_usual_sectors_have_no_findings(sector: str) -> None:
    """Radians with a point, angles with a unit, the whole scan and the rear are accepted."""
    assert _findings(sector, "const view = toRad(30)\n") == []


@pytest.mark.parametrize(
    ("sector", "place", "hint"),
    [
        ("-30, 30", "-30", "write '-30 deg', or '-30 rad' if radians are meant"),
        ("-30.5, 0.5", "-30.5", "write '-30.5 deg', or '-30.5 rad' if radians are meant"),
        ("0, 3", "3", "write '3 deg', or '3 rad' if radians are meant"),
        ("10 deg, 400 deg", "400 deg", "it is the bearing 40 deg"),
        ("-361 deg, 0", "-361 deg", "it is the bearing -1 deg"),
        ("0, toDeg(30)", "toDeg(30)", "it is the bearing 278.9 deg"),
        ("-view, 1.0", "-view", "write '-45 deg', or '-45 rad' if radians are meant"),
        ("0, wide", "wide", "it is the bearing 140 deg"),
    ],
)
def test_probably_mistyped_bearings_are_reported(sector: str, place: str, hint: str) -> None:
    """Constants count as their values."""
    findings = _findings(sector, "const view = 45\nconst wide = 500 deg\n")
    assert (findings[0].code.name, findings[0].span.text, findings[0].hint) == (
        "DRS364",
        place,
        hint,
    )


def test_finding_names_the_declaration_of_the_constant() -> None:
    """The missing unit belongs there."""
    findings = _findings("-view, view", "const view = 45\n")
    assert [each.related[0].span.text for each in findings] == ["const view = 45"] * 2


@pytest.mark.parametrize(
    ("sector", "wrong"),
    [
        ("30 deg, 30 deg", "is a single bearing"),
        ("0, 0", "is a single bearing"),
        ("180 deg, -180 deg", "is a single bearing"),
        ("3.1416, -3.1416", "is a single bearing"),
        ("360 deg, 0", "is a single bearing"),
        ("-90 deg, 270 deg", "is a full turn"),
        ("-200 deg, 200 deg", "is 400 deg wide, more than a full turn"),
        ("30 deg, -30 deg", "runs through the back, 300 deg wide"),
        ("view, -view", "runs through the back, 270.2 deg wide"),
    ],
)
def test_probably_unintended_sectors_are_reported(sector: str, wrong: str) -> None:
    """Both ends are plausible, but the sector between them is not."""
    (finding,) = _findings(sector, "const view = toRad(44.9)\n")
    assert (finding.code.name, finding.span.text) == ("DRS365", sector)
    assert wrong in finding.message


def test_hint_for_swapped_ends_fixes_the_finding() -> None:
    """It proposes the sector ahead."""
    (finding,) = _findings("30 deg, -30 deg")
    assert finding.hint.endswith("the rest is '-30 deg, 30 deg'")
    assert _findings("-30 deg, 30 deg") == []
