"""How soon the page of a system answers: ``deros graph --format html`` in headless Chromium.

The system has as many nodes as asked for, ten in each subsystem. Times are taken by the page's own
clock, from the start of its navigation, or from a click, to the frame that shows the answer; beside
them stands the processor time of the page's thread, which other load changes less. The floors, in
the same browser: a page with nothing but elkjs, and a click that changes one text.

It needs Chromium and what ``make elkjs`` fetches; without, it says so and measures nothing.
"""

from __future__ import annotations

import argparse
import shutil
import statistics
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

from big_system import write
from playwright.sync_api import Browser, Page, sync_playwright

from deros.metamodels.load import Repository
from deros.models.system import System
from deros.report.page.build import build
from deros.report.page.elkjs import NoElkjs, read_elkjs
from deros.report.page.render import render

LIMIT_MS = 1000.0
"""For opening the page, and for an answer to a click on one subsystem, or to a search."""

_DRAWN = "#picture[aria-busy=false]"
_OPENED = "performance.now()"
_FLOOR = "<!DOCTYPE html><title>x</title><button id=b>x</button><script>{}</script>"
_OPTIONS = ("--no-sandbox", "--disable-gpu", "--disable-background-networking")

_CLICK = """
async (selector) => {
  const picture = document.getElementById("picture");
  const began = performance.now();
  const shown = new Promise((resolve) => {
    const seen = () => {
      if (picture.getAttribute("aria-busy") !== "false") return;
      watcher.disconnect();
      requestAnimationFrame(() => setTimeout(resolve));
    };
    const watcher = new MutationObserver(seen);
    watcher.observe(picture, { attributes: true });
  });
  const options = { bubbles: true, key: "Enter" };
  const element = document.querySelector(selector);
  const event = element.localName === "input" ? new KeyboardEvent("keydown", options)
    : new MouseEvent("click", options);
  element.dispatchEvent(event);
  await shown;
  return performance.now() - began;
}
"""
_FLOOR_CLICK = """
async () => {
  const began = performance.now();
  document.getElementById("b").textContent = "y";
  await new Promise((resolve) => requestAnimationFrame(() => setTimeout(resolve)));
  return performance.now() - began;
}
"""


def _click(page: Page, selector: str) -> float:
    return float(page.evaluate(_CLICK, selector))


def _search(page: Page, text: str) -> float:
    page.fill("#wanted", text)
    return _click(page, "#wanted")


_ANSWERS: dict[str, Callable[[Page], float]] = {
    "unfold a subsystem": lambda page: _click(page, ".sign"),
    "search for a node": lambda page: _search(page, "smoother_7_3"),
    "unfold everything": lambda page: _click(page, "#unfold-all"),
    "fold everything": lambda page: _click(page, "#fold-all"),
}
_UNLIMITED = ("unfold everything", "fold everything")


class _Thread:
    """The processor time of a page's main thread."""

    def __init__(self, page: Page) -> None:
        self._session = page.context.new_cdp_session(page)
        self._session.send("Performance.enable", {"timeDomain": "threadTicks"})
        self._before = self._now_ms()

    def lap_ms(self) -> float:
        """Return the time since the last lap."""
        before, self._before = self._before, self._now_ms()
        return self._before - before

    def _now_ms(self) -> float:
        metrics = self._session.send("Performance.getMetrics")["metrics"]
        return 1000 * next(float(m["value"]) for m in metrics if m["name"] == "TaskDuration")


def _measure(browser: Browser, path: Path, floor: Path) -> dict[str, tuple[float, float, float]]:
    """Return milliseconds of each answer in a fresh page: all, its thread, and its floor."""
    plain = browser.new_page()
    plain.goto(floor.as_uri())
    opened = float(plain.evaluate(_OPENED))
    clicked = float(plain.evaluate(_FLOOR_CLICK))
    plain.close()
    page = browser.new_page(viewport={"width": 1400, "height": 860})
    thread = _Thread(page)
    page.goto(path.as_uri())
    page.wait_for_selector(_DRAWN)
    found = {"open the page": (float(page.evaluate(_OPENED)), thread.lap_ms(), opened)}
    for name, answer in _ANSWERS.items():
        found[name] = answer(page), thread.lap_ms(), clicked
    page.close()
    return found


def main() -> int:
    """Print the table; return 1 when a limit is passed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--nodes", type=int, default=500)
    parser.add_argument("--repeat", type=int, default=5, help="the median of so many runs counts")
    arguments = parser.parse_args()
    chromium = shutil.which("chromium")
    try:
        elkjs = read_elkjs()
    except NoElkjs as fault:
        print(f"not measured: {fault}")
        return 0
    if chromium is None:
        print("not measured: there is no chromium")
        return 0
    with tempfile.TemporaryDirectory(prefix="deros-benchmark-") as name:
        folder = Path(name)
        system = Repository().load(write(folder, arguments.nodes)).model
        assert isinstance(system, System)
        page, floor = folder / "page.html", folder / "floor.html"
        page.write_text(render(build(system, []), elkjs), encoding="ascii")
        floor.write_text(_FLOOR.format(elkjs), encoding="ascii")
        with sync_playwright() as playwright:
            browser = playwright.chromium.launch(executable_path=chromium, args=_OPTIONS)
            runs = [_measure(browser, page, floor) for _ in range(arguments.repeat)]
            browser.close()
    print(f"{arguments.nodes} nodes, the median of {arguments.repeat} runs in fresh pages")
    print(f"{'answer':<22} {'ms':>8} {'thread ms':>10} {'floor ms':>9} {'ratio':>7}")
    slow = []
    for name in runs[0]:
        columns = zip(*(run[name] for run in runs), strict=True)
        taken, thread, least = map(statistics.median, columns)
        print(f"{name:<22} {taken:>8.0f} {thread:>10.0f} {least:>9.0f} {taken / least:>7.1f}")
        if taken > LIMIT_MS and name not in _UNLIMITED:
            slow.append(name)
    print(f"limit for all but those of everything: {LIMIT_MS:.0f} ms")
    return 1 if slow else 0


if __name__ == "__main__":
    sys.exit(main())
