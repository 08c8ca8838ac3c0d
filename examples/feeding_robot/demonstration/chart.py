"""Charts as SVG text: one time axis, and rows of curves and bars above it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from html import escape

LEFT, RIGHT = 92.0, 18.0
"""Room, in px, for the labels beside the plots."""

Sample = tuple[float, float]


@dataclass(frozen=True)
class Scale:
    """Maps values from ``lower`` to ``upper`` onto pixels from ``start`` to ``end``."""

    lower: float
    upper: float
    start: float
    end: float

    def __call__(self, value: float) -> float:
        """Return the pixel of a value; values outside stop at the edge."""
        share = (value - self.lower) / (self.upper - self.lower)
        return self.start + max(0.0, min(1.0, share)) * (self.end - self.start)


@dataclass
class Chart:
    """Collects the SVG of a figure whose time axis is ``time``."""

    time: Scale
    height: float = 0.0
    parts: list[str] = field(default_factory=list)

    def band(self, start: float, end: float, label: str, hint: str, css: str) -> None:
        """Shade a stretch of time from top to bottom and head it with a label."""
        left, right = self.time(start), self.time(end)
        middle = (left + right) / 2
        self.parts.append(
            f'<g class="band {css}"><title>{escape(hint)}</title>'
            f'<rect x="{left:.1f}" y="22" width="{right - left:.1f}" height="{{height}}"/>'
            f'<text class="number" x="{middle:.1f}" y="14">{escape(label)}</text></g>'
        )

    def plot(
        self,
        label: str,
        unit: str,
        height: float,
        bounds: tuple[float, float],
        curves: Sequence[tuple[str, Iterable[Sample]]],
        limits: Sequence[tuple[float, str, str]] = (),
        zones: Sequence[tuple[float, float, str]] = (),
    ) -> None:
        """Add a row with curves.

        Args:
            label: what the row shows.
            unit: the unit written under the label.
            height: of the row, in px.
            bounds: the lowest and the highest value shown.
            curves: pairs of a CSS class and samples in time order.
            limits: dashed lines: value, text and CSS class.
            zones: shaded ranges: lowest value, highest value and CSS class.
        """
        top, bottom = self.height + 8, self.height + 8 + height
        scale = Scale(*bounds, bottom, top)
        for lower, upper, css in zones:
            self._rectangle(scale(upper), scale(lower) - scale(upper), css)
        self._rectangle(top, height, "frame")
        for value, text, css in limits:
            y = scale(value)
            self.parts.append(
                f'<line class="limit {css}" x1="{self.time.start}" x2="{self.time.end}" '
                f'y1="{y:.1f}" y2="{y:.1f}"/>'
                f'<text class="tick" x="{LEFT - 6}" y="{y + 3.5:.1f}">{escape(text)}</text>'
            )
        for css, samples in curves:
            points = " ".join(f"{self.time(t):.1f},{scale(v):.1f}" for t, v in samples)
            self.parts.append(f'<polyline class="curve {css}" points="{points}"/>')
        self._label(label, unit, top + 13)
        self.height = bottom

    def lane(self, label: str, spans: Iterable[tuple[float, float]], css: str) -> None:
        """Add a row of bars: the stretches of time in which something was the case."""
        top = self.height + 6
        self._rectangle(top, 14, "lane")
        for start, end in spans:
            left = self.time(start)
            width = max(3.0, self.time(end) - left)
            self.parts.append(
                f'<rect class="bar {css}" x="{left:.1f}" y="{top:.1f}" width="{width:.1f}" '
                f'height="14" rx="2"><title>{escape(label)}: {start:.2f} to {end:.2f}</title>'
                "</rect>"
            )
        self._label(label, "", top + 11)
        self.height = top + 14

    def axis(self, ticks: Iterable[float], unit: str) -> None:
        """Close the figure with the time axis."""
        y = self.height + 20
        for tick in ticks:
            x = self.time(tick)
            self.parts.append(
                f'<line class="grid" x1="{x:.1f}" x2="{x:.1f}" y1="22" y2="{self.height:.1f}"/>'
                f'<text class="time" x="{x:.1f}" y="{y:.1f}">{tick:g}</text>'
            )
        self.parts.append(
            f'<text class="time" x="{self.time.end:.1f}" y="{y + 15:.1f}">{escape(unit)}</text>'
        )
        self.height += 40

    def svg(self, title: str) -> str:
        """Return the whole figure."""
        width = self.time.end + RIGHT
        body = "".join(self.parts).replace("{height}", f"{self.height - 62:.1f}")
        return (
            f'<svg viewBox="0 0 {width:.0f} {self.height:.0f}" width="{width:.0f}" '
            f'height="{self.height:.0f}" role="img" aria-label="{escape(title)}">{body}</svg>'
        )

    def _rectangle(self, top: float, height: float, css: str) -> None:
        self.parts.append(
            f'<rect class="{css}" x="{self.time.start}" y="{top:.1f}" '
            f'width="{self.time.end - self.time.start:.1f}" height="{height:.1f}"/>'
        )

    def _label(self, label: str, unit: str, y: float) -> None:
        self.parts.append(f'<text class="label" x="4" y="{y:.1f}">{escape(label)}</text>')
        if unit:
            self.parts.append(f'<text class="unit" x="4" y="{y + 14:.1f}">{escape(unit)}</text>')


def stretches(
    samples: Sequence[Sample], end: float, active: float = 1.0
) -> list[tuple[float, float]]:
    """Return the stretches of time in which a recorded state had the value ``active``."""
    found: list[tuple[float, float]] = []
    since: float | None = None
    for time, value in samples:
        if value == active and since is None:
            since = time
        elif value != active and since is not None:
            found.append((since, time))
            since = None
    if since is not None:
        found.append((since, end))
    return found
