"""What ``docs/reports.md`` and ``docs/comparison.md`` claim is checked and played."""

from __future__ import annotations

import re
from itertools import groupby
from pathlib import Path

import pytest

from tests.support import cases, pages, timelines
from tests.support.cli import deros
from tests.support.timelines import Timeline

DOCS = Path(__file__).resolve().parents[2] / "docs"
REPORTS = DOCS / "reports.md"
PAGES = [REPORTS, DOCS / "comparison.md"]
PROGRAMS = [
    pytest.param(page, timeline, id=f"{page.stem}: {timeline.name}")
    for page in PAGES
    for _, same in groupby(timelines.read(page), lambda each: each.rules)
    for timeline in [next(same)]
]
CAUGHT = {
    "mowglinext/mowglinext#652": ["blade_flag"],
    "ROBOTIS-GIT/turtlebot3#1154": ["gate_across_wifi"],
    "Karsten1987/confbot_robot#46": ["two_commanders"],
    "ros-teleop/twist_mux#42": ["joystick_before_planner"],
    "UoY-RoboStar/AURO#5": ["two_robots_one_command"],
    "husarion/rosbot_xl_ros": ["controllers_in_one_process"],
    "ICube-Robotics/ethercat_driver_ros2#125": ["zero_is_a_place"],
    "kvynlim/industry-research": ["warn_before_moving"],
    "OpenRAL/openral#290": ["never_activated", "source_not_started"],
    "zauberzeug/feldfreund_devkit_ros#23": ["stop_before_the_respawn"],
    "linorobot/linorobot2#123": ["topics_in_a_list"],
    "Ekumen-OS/andino": ["topic_for_each_entry"],
    "UniflexAI/tinynav#235": ["sim_time_on_the_robot"],
    "ros-controls/ros_controllers#499": ["transform_twice"],
    "septentrio-gnss/septentrio_gnss_driver#104": ["degrees_meet_radians"],
    "UbiquityRobotics/ubiquity_motor#29": ["battery_in_percent", "battery_said_in_percent"],
    "ROBOTIS-GIT/turtlebot3_simulations#96": ["nearer_than_range_min"],
    "ros-navigation/navigation2#4863": ["old_messages"],
    "manankharwar/fusioncore#134": ["file_for_another_node"],
}
"""The folders of ``tests/cases/robots`` by the first report of a row."""

ELSEWHERE = {"DRS207", "DRS214", "DRS402"}
"""Codes that the page mentions beside what a report is about: their own pages have examples."""


def _rows() -> list[list[str]]:
    text = REPORTS.read_text(encoding="utf-8")
    rows = [line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("| ")]
    return [each for each in rows if len(each) == 4 and "/" in each[0]]


def _found(folder: str) -> set[str]:
    findings, _ = cases.run(f"robots/{folder}")
    return {each.code.name for each in findings}


@pytest.mark.parametrize("page", PAGES, ids=lambda each: each.stem)
def test_timelines_of_the_page_pass(page: Path) -> None:
    """`deros test` plays the page without a difference."""
    outcome = deros("test", page)
    assert (outcome.code, outcome.err) == (0, ""), outcome
    assert "no differences" in outcome.out


@pytest.mark.parametrize(("page", "timeline"), PROGRAMS)
def test_program_passes_the_strict_check(
    page: Path, timeline: Timeline, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No finding is left in a system that runs the program with its gates."""
    monkeypatch.chdir(tmp_path)
    system = timelines.system(page)
    Path("robot.system").write_text(f'{system}safety "rules.deros"\n', encoding="utf-8")
    Path("rules.deros").write_text(timeline.rules, encoding="utf-8")
    outcome = deros("check", "--strict", "robot.system", "rules.deros")
    assert outcome.code == 0, outcome
    assert outcome.out.startswith("2 files checked, no findings"), outcome


def test_each_row_says_what_becomes_of_the_report() -> None:
    """The verdict is one of four, and all but "not" lead to what shows it."""
    rows = _rows()
    assert len(rows) == 25
    for report, told, verdict, where in rows:
        assert verdict in ("caught", "prevented", "expressed", "not"), report
        assert told, report
        assert verdict == "not" or "](" in where, report


def test_codes_of_the_page_are_found() -> None:
    """The model of a report has the findings that its row names."""
    named: dict[str, set[str]] = {}
    for report, _, _, where in _rows():
        codes = set(re.findall(r"diagnostics/(DRS\d{3})", where)) - ELSEWHERE
        named.setdefault(report.split(",")[0], set()).update(codes)
    named = {report: codes for report, codes in named.items() if codes}
    assert named.keys() == CAUGHT.keys()
    for report, codes in named.items():
        assert codes <= {code for folder in CAUGHT[report] for code in _found(folder)}, report


def test_corrected_models_have_no_findings() -> None:
    """The advice of the findings leads to a model that is clean."""
    corrected = [each for each in cases.robots() if each.endswith("_corrected")]
    assert len(corrected) >= len(CAUGHT)
    assert {each: cases.run(each)[0] for each in corrected} == {each: [] for each in corrected}


def _compared() -> list[list[str]]:
    text = PAGES[1].read_text(encoding="utf-8")
    rows = [
        [cell.strip() for cell in line.strip("|").split("|")]
        for line in text.splitlines()
        if line.startswith("| ")
    ]
    is_time = re.compile(r"\d|time|back to")
    return [each for each in rows if len(each) == 3 and not is_time.match(each[0])]


def test_comparison_has_no_empty_row() -> None:
    """A row says what to write, or where deros differs, or both."""
    rows = [each for each in _compared() if each[0] != "there"]
    assert len(rows) > 50
    assert [each for each in rows if not (each[1] or each[2])] == []


def test_lines_of_the_comparison_are_those_of_its_programs() -> None:
    """What the middle column shows is in a program that is checked and played."""
    programs = "\n".join(
        block.text
        for block in pages.blocks()
        if block.page == "docs/comparison.md" and block.language == "deros"
    )
    unlinked = (re.sub(r"\[[^]]*\]\([^)]*\)", "", here) for _, here, _ in _compared())
    shown = [text for here in unlinked for text in re.findall(r"`([^`]+)`", here)]
    parts = [part.strip() for text in shown for part in text.split("…") if part.strip()]
    assert len(parts) > 30
    assert [each for each in parts if each not in programs] == []
