"""The picture of a run: one HTML page that needs nothing but itself."""

from __future__ import annotations

import math
from collections.abc import Sequence
from html import escape
from pathlib import Path

from demonstration.chart import LEFT, Chart, Sample, Scale, stretches
from demonstration.recording import Recording, Result
from demonstration.referee import describe

FAR = 6.0
"""Clearance, in m, at which the picture ends; a free way is drawn there."""

PIXELS_PER_SECOND = 15.0
NARROWEST = 960.0

_STYLE = (Path(__file__).parent / "picture.css").read_text(encoding="utf-8")


def page(recordings: Sequence[Recording], summary: str) -> str:
    """Return the page for the recordings of one run, one figure each.

    Args:
        recordings: what was recorded, the figure of each under the other.
        summary: one sentence on reaction times.
    """
    results = [result for recording in recordings for result in recording.results]
    passed = sum(result.passed for result in results)
    state = "good" if passed == len(results) else "bad"
    figures = "".join(_figure(recording) for recording in recordings if recording.tracks)
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>Feeding robot: {passed} of {len(results)} cases passed</title>"
        f"<style>\n{_STYLE}</style></head>\n<body><main>"
        f'<header><h1>Feeding robot</h1><p class="verdict {state}">'
        f"{passed} of {len(results)} cases passed</p><p>{escape(summary)}</p></header>\n"
        f"{figures}{_table(results)}</main></body></html>\n"
    )


def _figure(recording: Recording) -> str:
    # Ten minutes of standing still are told in minutes.
    unit = 60.0 if recording.simulated else 1.0
    end = recording.end / unit
    pixels = NARROWEST if recording.simulated else max(NARROWEST, end * PIXELS_PER_SECOND)
    chart = Chart(Scale(0.0, max(end, 1e-3), LEFT, LEFT + pixels), height=22.0)
    for each in recording.results:
        hint = f"{each.number}. {each.title}: {describe(each.observed)}"
        css = "good" if each.passed else "bad"
        chart.band(each.start / unit, each.end / unit, str(each.number), hint, css)

    def track(name: str, factor: float = 1.0) -> list[Sample]:
        return [(time / unit, value * factor) for time, value in recording.tracks.get(name, [])]

    chart.plot(
        "speed",
        "m/s",
        170,
        (-0.8, 1.4),
        [("speed", track("speed"))],
        limits=[
            (1.0, "1.0", "hard"),
            (0.5, "0.5", "soft"),
            (0.0, "0", "zero"),
            (-0.25, "-0.25", "soft"),
            (-0.4, "-0.4", "hard"),
        ],
    )
    chart.plot(
        "tilt",
        "degrees",
        84,
        (-12.0, 12.0),
        [
            ("roll", track("roll", math.degrees(1.0))),
            ("pitch", track("pitch", math.degrees(1.0))),
        ],
        limits=[(10, "10", "hard"), (8, "", "soft"), (-8, "", "soft"), (-10, "-10", "hard")],
    )
    chart.plot(
        "way ahead",
        "m",
        100,
        (0.0, FAR),
        [("way", [(time, min(value, FAR)) for time, value in track("nearest")])],
        limits=[(4.0, "4", "none"), (2.0, "2", "none"), (0.8, "0.8", "none")],
        zones=[(2.0, 4.0, "warning"), (0.8, 2.0, "stop"), (0.0, 0.8, "collision")],
    )
    for label, name in (("low speed", "low_speed"), ("stop", "stop"), ("motor stop", "motor_stop")):
        chart.lane(label, stretches(track(name), end), name)
    chart.lane("engine", stretches(track("engine_running"), end), "engine")
    step = _tick(end)
    ticks = [index * step for index in range(math.floor(end / step) + 1)]
    chart.axis(ticks, "minutes, simulated" if recording.simulated else "seconds")
    title = "On simulated time" if recording.simulated else "In real time"
    return (
        f"<figure><figcaption>{title}</figcaption>"
        f'<div class="scroll">{chart.svg(title)}</div></figure>\n'
    )


def _tick(length: float) -> float:
    """Return a round distance of ticks, so that some ten to twenty of them fit."""
    return next((step for step in (0.5, 1.0, 2.0, 5.0, 10.0, 20.0) if length / step <= 20), 60.0)


def _table(results: Sequence[Result]) -> str:
    head = "".join(
        f"<th>{text}</th>" for text in ("", "case", "expected", "observed", "reaction time", "")
    )
    return (
        f"<table><thead><tr>{head}</tr></thead><tbody>{''.join(map(_row, results))}</tbody></table>"
    )


def _row(result: Result) -> str:
    css, mark = ("good", "passed") if result.passed else ("bad", result.failure)
    cells = (
        str(result.number),
        result.title,
        describe(result.expected),
        describe(result.observed),
        reaction_text(result),
        mark,
    )
    return f'<tr class="{css}">' + "".join(f"<td>{escape(cell)}</td>" for cell in cells) + "</tr>"


def reaction_text(result: Result) -> str:
    """Return a reaction time as a reader expects it; a dash where no reaction was due."""
    if result.reaction_time is None:
        return "-"
    if result.simulated:
        return f"{result.reaction_time:.1f} s sim"
    return f"{result.reaction_time * 1e3:.1f} ms"
