"""The player of the feeding robot's test cases, without ROS."""

from __future__ import annotations

import math
import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest
from rich.console import Console

from tests.support.cli import deros
from tests.support.examples import EXAMPLES, example_module

build = example_module("feeding_robot", "demonstration.build")
referee_module = example_module("feeding_robot", "demonstration.referee")
pace_module = example_module("feeding_robot", "demonstration.pace")
recording_module = example_module("feeding_robot", "demonstration.recording")
picture = example_module("feeding_robot", "demonstration.picture")
chart = example_module("feeding_robot", "demonstration.chart")
cases = example_module("feeding_robot", "demonstration.cases")
scoreboard = example_module("feeding_robot", "demonstration.scoreboard")
Event, Reaction = referee_module.Event, referee_module.Reaction
STOP = frozenset({Reaction.STOP})
STOP_AND_OFF = frozenset({Reaction.STOP, Reaction.ENGINE_OFF})
MS = 10**6


def event(ms: float, name: str, value: Any, delay_ms: float = 0.5) -> Any:
    """Return an event sent at ``ms`` and received half a millisecond later."""
    return Event(name, value, round(ms * MS), round((ms + delay_ms) * MS))


def referee(expected: frozenset[Any] = STOP, **settings: Any) -> Any:
    """Return a referee of a robot that drives too fast above 0.5 m/s."""
    defaults = {
        "condition": lambda s: s.speed is not None and s.speed > 0.5,
        "hold": 0.0,
        "acts": frozenset({"stop"}) if expected else frozenset(),
        "state": referee_module.RobotState(speed=0.4, stop=False, engine_running=True),
    }
    return referee_module.Referee(expected=expected, **(defaults | settings))


def feed(judge: Any, *events: Any) -> Any:
    """Feed events to a referee and return it."""
    for each in events:
        judge.feed(each)
    return judge


# The referee --------------------------------------------------------------------------------------


def test_reaction_time_is_from_sensor_sent_to_action_received() -> None:
    """The receipt of the sensor message and the sending of the action do not matter."""
    judge = feed(referee(), event(100, "speed", 0.6, 9), event(102, "stop", True, 1))
    assert judge.reaction_time == pytest.approx(0.003)


def test_reaction_time_excludes_the_duration_of_the_rule() -> None:
    """The time for which the rule waits is subtracted."""
    judge = feed(referee(hold=4.0), event(100, "speed", 0.6), event(4101, "stop", True, 1))
    assert judge.reaction_time == pytest.approx(0.002)
    assert judge.verdict == ""


def test_interruption_restarts_the_condition() -> None:
    """Only the last uninterrupted period counts."""
    judge = feed(
        referee(hold=1.0),
        event(100, "speed", 0.6),
        event(600, "speed", 0.4),
        event(700, "speed", 0.6),
        event(900, "speed", 0.7),
        event(1700, "stop", True),
    )
    assert judge.reaction_time == pytest.approx(0.0005)


def test_condition_that_ends_when_due_is_the_cause() -> None:
    """The engine may be off before the player receives the stop."""
    judge = feed(referee(), event(100, "speed", 0.6), event(125, "speed", 0.3))
    assert feed(judge, event(126, "stop", True)).reaction_time == pytest.approx(0.0265)


@pytest.mark.parametrize(("resolution", "passes"), [(0.03, False), (0.2, True)])
def test_early_reaction_is_tolerated_within_the_resolution(resolution: float, passes: bool) -> None:
    """The tolerance is a sensor cycle in real time, and a step in simulated time."""
    judge = referee(hold=1.0, resolution=resolution)
    feed(judge, event(100, "speed", 0.6), event(1000, "stop", True))
    assert (judge.verdict == "") is passes


def test_early_reaction_fails_the_case() -> None:
    """A reaction before its time is as wrong as none."""
    judge = feed(referee(hold=4.0), event(100, "speed", 0.6), event(3000, "stop", True))
    assert "too early" in judge.verdict


def test_late_reaction_fails_the_case() -> None:
    """Half a second after it was due, another rule may have caused it."""
    judge = feed(referee(), event(100, "speed", 0.6), event(601, "stop", True))
    assert judge.verdict == "the reaction took 0.501 s"


def test_action_received_before_its_cause_is_timed() -> None:
    """Messages of two nodes arrive in any order; their stamps decide."""
    judge = feed(referee(), event(102, "stop", True, 0.5), event(100, "speed", 0.6, 9))
    assert judge.reaction_time == pytest.approx(0.0025)


def test_cause_after_the_action_does_not_count() -> None:
    """An action without a cause fails the case, whatever happens later."""
    judge = feed(referee(), event(102, "stop", True), event(200, "speed", 0.6))
    assert judge.reaction_time is None
    assert judge.verdict == "the reaction came without its cause"


def test_reaction_time_ends_with_the_slowest_action() -> None:
    """If stop and motor stop are due, both must have arrived."""
    judge = referee(acts=frozenset({"stop", "motor_stop"}))
    feed(judge, event(100, "speed", 0.6), event(101, "stop", True))
    assert judge.reaction_time is None
    feed(judge, event(104, "motor_stop", True))
    assert judge.reaction_time == pytest.approx(0.0045)


def test_only_the_rising_edge_of_an_action_counts() -> None:
    """A repeated action has reacted once."""
    judge = feed(referee(), event(100, "speed", 0.6), event(101, "stop", True))
    first = judge.reaction_time
    assert feed(judge, event(201, "stop", True)).reaction_time == first


@pytest.mark.parametrize(
    ("name", "value"), [("stop", True), ("low_speed", True), ("engine_running", False)]
)
def test_unexpected_reaction_fails_the_case(name: str, value: bool) -> None:
    """An unnecessary stop is a failure too."""
    judge = feed(referee(frozenset()), event(100, "speed", 0.6))
    assert judge.verdict == ""
    assert feed(judge, event(101, name, value)).verdict.startswith("expected none, observed")


def test_case_without_provocation_fails() -> None:
    """No reaction to no violation proves nothing."""
    judge = feed(referee(frozenset()), event(100, "speed", 0.4))
    assert judge.verdict == "what must bring no reaction has not come about"


def test_case_is_complete_when_the_robot_stands() -> None:
    """A stop command is not yet a stop."""
    judge = feed(referee(), event(100, "speed", 0.6), event(101, "stop", True))
    assert not judge.complete
    assert feed(judge, event(500, "speed", 0.01)).complete


def test_low_speed_is_complete_at_crawling_speed() -> None:
    """The command is obeyed when the speed is below a crawl."""
    judge = referee(frozenset({Reaction.LOW_SPEED}), acts=frozenset({"low_speed"}))
    feed(judge, event(100, "speed", 0.6), event(101, "low_speed", True), event(150, "speed", 0.4))
    assert not judge.complete
    assert feed(judge, event(500, "speed", 0.2)).complete


def test_silence_starts_with_the_last_message() -> None:
    """For a dead node the time is from its last heartbeat to the reaction of the PLC."""
    judge = referee(
        STOP_AND_OFF, hold=0.5, silence_of="heartbeat", acts=frozenset({"engine_enabled"})
    )
    feed(judge, event(0, "engine_enabled", True), event(100, "heartbeat", 1))
    feed(judge, event(200, "heartbeat", 2), event(719, "engine_enabled", False, 1))
    assert judge.reaction_time == pytest.approx(0.02)


def test_robot_at_rest_with_engine_off_has_stopped() -> None:
    """This holds even if the node that commands stops is dead."""
    judge = referee(STOP_AND_OFF, silence_of="heartbeat", acts=frozenset({"engine_running"}))
    feed(judge, event(1, "heartbeat", 1), event(2, "engine_running", False))
    assert judge.observed == {Reaction.ENGINE_OFF}
    assert feed(judge, event(900, "speed", 0.0)).observed == STOP_AND_OFF
    assert judge.complete


def test_nearest_range_is_ahead_and_from_valid_beams() -> None:
    """Objects beside the robot and NaN beams do not count."""
    ranges = [1.0, math.nan, 4.0, 3.0, math.inf, 0.5]
    assert referee_module.nearest_ahead(ranges, -1.0, 0.4, 0.45) == 3.0
    assert referee_module.nearest_ahead([math.inf] * 3, -0.1, 0.1, 0.5) == math.inf


# Simulated time -----------------------------------------------------------------------------------


class Lockstep:
    """A pace that records its requests, with a simulator that has started."""

    def __init__(self) -> None:
        """Record the steps, and count the requests to the safety node."""
        self.steps: list[float] = []
        self.questions = 0
        self.pace = pace_module.Pace(self.steps.append, self._ask)
        self.pace.ticked(0)

    def _ask(self) -> None:
        self.questions += 1

    def step(self) -> None:
        """Complete the current step: the next one has been requested."""
        self.see_all()
        self.pace.answered()

    def see_all(self, but: str = "") -> None:
        """Report all witnesses, except one."""
        for name in sorted(pace_module.WITNESSES - {but}):
            self.pace.seen(name)


def test_time_advances_when_all_witnesses_and_the_safety_node_have_answered() -> None:
    """Neither alone is enough."""
    lockstep = Lockstep()
    lockstep.see_all()
    assert (lockstep.steps, lockstep.pace.now) == ([], 0)
    lockstep.pace.answered()
    assert (lockstep.steps, lockstep.pace.now) == ([pace_module.STEP], 120 * MS)


@pytest.mark.parametrize("late", sorted(pace_module.WITNESSES))
def test_time_waits_for_a_late_witness(late: str) -> None:
    """The safety node is not asked before."""
    lockstep = Lockstep()
    lockstep.see_all(but=late)
    assert lockstep.questions == 0
    lockstep.pace.seen(late)
    assert lockstep.questions == 1


def test_reminder_repeats_the_step_without_advancing_time() -> None:
    """A lost message is requested again; a pending answer is not."""
    lockstep = Lockstep()
    lockstep.pace.remind()
    assert (lockstep.steps, lockstep.pace.now) == ([0.0], 0)
    lockstep.step()
    lockstep.pace.remind()
    assert lockstep.steps == [0.0, pace_module.STEP]


def test_lost_answer_is_requested_again_and_counts_once() -> None:
    """Two answers to one request are one step."""
    lockstep = Lockstep()
    lockstep.see_all()
    lockstep.pace.remind()
    assert lockstep.questions == 2
    lockstep.pace.answered()
    lockstep.pace.answered()
    assert lockstep.steps == [pace_module.STEP]


def test_messages_before_the_clock_tick_belong_to_the_last_step() -> None:
    """A node reminded unnecessarily repeats itself; that does not answer the next step."""
    lockstep = Lockstep()
    lockstep.step()
    lockstep.see_all()
    assert lockstep.questions == 1
    lockstep.pace.ticked(120 * MS)
    assert lockstep.questions == 1
    lockstep.see_all()
    assert lockstep.questions == 2


def test_repeated_clock_tick_starts_no_step() -> None:
    """The simulator repeats the time when it is reminded."""
    lockstep = Lockstep()
    lockstep.step()
    lockstep.pace.ticked(0)
    lockstep.see_all()
    assert lockstep.questions == 1


def test_four_steps_fit_into_the_shortest_timeout() -> None:
    """Clock and message may each be a step late, and one message may be lost."""
    rules = (EXAMPLES / "feeding_robot/feeding_robot.deros").read_text(encoding="utf-8")
    timeouts = re.findall(r"timeout ([\d.]+) sec", rules)
    assert timeouts
    assert min(map(float, timeouts)) > 4 * pace_module.STEP


# Recording and picture ----------------------------------------------------------------------------


def recording() -> Any:
    """Return a recording of two cases, one passed, one failed."""
    recording_ = recording_module.Recording()
    for ms in range(0, 4000, 10):
        recording_.feed(event(ms, "speed", 0.4 if ms < 2000 else 0.0))
        recording_.feed(event(ms, "nearest", math.inf if ms < 1000 else 1.5))
        recording_.feed(event(ms, "roll", 0.01))
        recording_.feed(event(ms, "stop", ms >= 1000))
        recording_.feed(event(ms, "heartbeat", ms))
    result = recording_module.Result
    recording_.results.append(result(2, "Obstacle <b>", STOP, STOP, 0.0012, "", 0.5, 2.0))
    recording_.results.append(
        result(9, "Fast", STOP, frozenset(), None, "no reaction & late", 2.5, 3.9)
    )
    return recording_


def test_recording_thins_curves_and_keeps_edges_of_states() -> None:
    """It keeps a quarter of the samples of a curve, two of a state, none of a counter."""
    tracks = recording().tracks
    assert 75 <= len(tracks["speed"]) <= 100
    assert [value for _, value in tracks["stop"]] == [0.0, 1.0]
    assert "heartbeat" not in tracks


def test_recorded_times_are_relative_to_the_first_event() -> None:
    """The absolute clock does not matter."""
    recording_ = recording_module.Recording()
    recording_.feed(Event("speed", 0.1, 7 * 10**18, 7 * 10**18))
    recording_.feed(Event("speed", 0.2, 7 * 10**18 + 10**9, 7 * 10**18 + 10**9))
    assert recording_.tracks["speed"] == [(0.0, 0.1), (1.0, 0.2)]
    assert recording_.end == 1.0


@pytest.mark.parametrize(
    ("share", "value"), [(0.0, 1.0), (0.5, 2.0), (0.51, 3.0), (0.99, 4.0), (1.0, 4.0)]
)
def test_percentiles_are_measured_values(share: float, value: float) -> None:
    """The nearest rank is used, without interpolation."""
    assert recording_module.percentile([4.0, 1.0, 3.0, 2.0], share) == value


def test_intervals_end_at_edges_or_with_the_recording() -> None:
    """An action active at the end is active until the end."""
    samples = [(0.0, 0.0), (1.0, 1.0), (2.0, 0.0), (3.0, 1.0)]
    assert chart.stretches(samples, 5.0) == [(1.0, 2.0), (3.0, 5.0)]


# The scoreboard -----------------------------------------------------------------------------------


def result(number: int, time: float | None, failure: str = "") -> Any:
    """Return a result of a case that expects a stop and shows one."""
    return recording_module.Result(number, "case", STOP, STOP, time, failure, 0.0, 1.0)


def test_scoreboard_fits_eighty_columns_and_fifteen_lines() -> None:
    """No row wraps, so that the live table does not move on any terminal."""
    board = scoreboard.Scoreboard(Console(width=80), cases.CASES, 1)
    for case in cases.CASES:
        board.report(result(case.number, 0.0123))
    console = Console(width=80)
    with console.capture() as capture:
        console.print(board.table())
    assert len(capture.get().rstrip().splitlines()) == 1 + len(cases.CASES)


def test_scoreboard_is_complete_when_every_round_has_passed() -> None:
    """A round that was not played counts like a failed one."""
    console = Console(quiet=True)
    board = scoreboard.Scoreboard(console, cases.CASES[1:3], 2)
    for number in (2, 2, 3):
        board.report(result(number, 0.001))
    assert not board.complete
    board.report(result(3, 0.001))
    assert board.complete
    board.report(result(3, 0.001, "too late"))
    assert not board.complete


def test_summary_counts_only_reactions_of_the_safety_node() -> None:
    """Median and 99 % are over its own cases, in ms."""
    results = [result(2, 0.001), result(3, 0.002), result(4, 0.009), result(14, 5.0)]
    text = scoreboard.summary([*results, result(8, None)], frozenset({2, 3, 4, 8}))
    assert "over 3 reactions: median 2.0 ms, 99 % 9.0 ms" in text
    assert "No reaction" in scoreboard.summary([], frozenset({2}))


def test_cases_are_those_of_the_safety_test() -> None:
    """Two cause no reaction, one slows the robot down, two stop it, ten shut off its engine."""
    assert [case.number for case in cases.CASES] == list(range(1, 16))
    expected = {case.number: case.expected for case in cases.CASES}
    assert [n for n in expected if not expected[n]] == [8, 11]
    assert [n for n in expected if expected[n] == {Reaction.LOW_SPEED}] == [1]
    assert [n for n in expected if expected[n] == STOP] == [2, 3]
    engine_off = [4, 5, 6, 7, 9, 10, 12, 13, 14, 15]
    assert [n for n in expected if expected[n] == STOP_AND_OFF] == engine_off


class Page(HTMLParser):
    """Count the elements of a page and collect its references."""

    VOID = frozenset({"meta", "link", "br"})

    def __init__(self, text: str) -> None:
        """Read the page."""
        super().__init__()
        self.open: list[str] = []
        self.count: dict[str, int] = {}
        self.loads: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Count an element, and record its references."""
        self.count[tag] = self.count.get(tag, 0) + 1
        self.loads += [value or "" for name, value in attrs if name in {"src", "href"}]
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Count an element without content."""
        self.handle_starttag(tag, attrs)
        if tag not in self.VOID:
            self.open.pop()

    def handle_endtag(self, tag: str) -> None:
        """Close the innermost element, which must be this one."""
        assert self.open.pop() == tag


def test_picture_is_one_well_formed_page_without_references() -> None:
    """Every element is closed, and nothing outside is referenced."""
    text = picture.page([recording(), recording_module.Recording()], "Fast enough.")
    page = Page(text)
    assert page.open == []
    assert page.loads == []
    assert "http" not in text
    assert page.count["svg"] == 1
    assert page.count["tr"] == 3


def test_picture_shows_bands_verdicts_and_both_colour_schemes() -> None:
    """One band per case in the colour of its verdict, escaped text, and a dark mode."""
    text = picture.page([recording()], "Fast enough.")
    assert "1 of 2 cases passed" in text
    assert text.count('<g class="band good">') == text.count('<g class="band bad">') == 1
    assert "Obstacle &lt;b&gt;" in text
    assert "no reaction &amp; late" in text
    assert "prefers-color-scheme: dark" in text
    assert "inf" not in text.split("</style>")[1].lower().replace("info", "")


# The robot in C++ -----------------------------------------------------------------------------


def test_cpp_system_differs_by_two_words(tmp_path: Path) -> None:
    """They select the language of the safety node and the gate; the system checks clean."""
    system = EXAMPLES / "feeding_robot/feeding_robot.system"
    path = build.in_cpp(system, tmp_path)
    before = system.read_text(encoding="utf-8").splitlines()
    after = path.read_text(encoding="utf-8").splitlines()
    changed = [new for old, new in zip(before, after, strict=True) if old != new]
    (line,) = [line for line in changed if "import" not in line]
    assert line.split()[:4] == ["safety", '"feeding_robot.deros"', "target", "cpp"]
    assert deros("check", path, "--strict").code == 0
