"""Pages of systems in headless Chromium, seen and used as a person does."""

from __future__ import annotations

import contextlib
import shutil
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from playwright.sync_api import Browser, Page, sync_playwright

from deros.diagnostics import Diagnostic
from deros.models.system import System
from deros.report.page.build import build
from deros.report.page.elkjs import read_elkjs
from deros.report.page.render import render

PICTURES = Path(__file__).resolve().parents[2] / ".tmp" / "pages"
"""Where pictures of the pages go, for people to look at."""

CHROMIUM = "chromium"
_WITHOUT_SANDBOX = ("--no-sandbox", "--disable-gpu", "--disable-background-networking")
_SETTLED = "#picture[aria-busy=false]"
_LIMIT_MS = 60_000.0


@contextlib.contextmanager
def browser() -> Iterator[Browser]:
    """Run Chromium; a test that uses it needs ``chromium`` and ``elkjs``."""
    with sync_playwright() as playwright:
        program = playwright.chromium.launch(
            executable_path=shutil.which(CHROMIUM), args=_WITHOUT_SANDBOX
        )
        yield program
        program.close()


def text_of(system: System, findings: tuple[Diagnostic, ...] = ()) -> str:
    """Return the page of a system."""
    return render(build(system, findings), read_elkjs())


@dataclass
class Opened:
    """A page that is open.

    Attributes:
        page: playwright's own.
        requests: what the page asked for, itself included.
        complaints: errors of its scripts, and what it wrote to the console.
    """

    page: Page
    requests: list[str] = field(default_factory=list)
    complaints: list[str] = field(default_factory=list)

    def settle(self) -> None:
        """Wait until the picture shows what the page is to show."""
        self.page.wait_for_selector(_SETTLED, timeout=_LIMIT_MS)

    def click(self, selector: str, *, count: int = 1) -> None:
        """Click on something, and wait for the picture."""
        self.page.locator(selector).first.click(click_count=count)
        self.settle()

    def press(self, selector: str, key: str) -> None:
        """Press a key on something that has the focus then, and wait for the picture."""
        self.page.locator(selector).first.press(key)
        self.settle()

    def find(self, text: str) -> None:
        """Search for a text, and go to the first match."""
        self.page.fill("#wanted", text)
        self.press("#wanted", "Enter")

    def switch(self, argument: str, value: bool | int | float | str) -> None:
        """Give an argument a value, as a person does."""
        control = self.page.locator(f"[name={argument!r}]")
        if isinstance(value, bool):
            control.set_checked(value)
        elif control.evaluate("each => each.localName") == "select":
            control.select_option(label=str(value))
        else:
            control.fill(str(value))
            control.press("Tab")
        self.settle()

    def text(self, selector: str) -> str:
        """Return the text of something as it is seen."""
        return self.page.locator(selector).first.inner_text()

    @property
    def boxes(self) -> dict[str, str]:
        """What a screen reader says of each box, by its key."""
        script = "all => all.map(each => [each.dataset.key, each.getAttribute('aria-label')])"
        return dict(self.page.locator("#picture [data-key]").evaluate_all(script))

    @property
    def names(self) -> list[str]:
        """The kinds and names of all boxes, sorted: ``node /a``, ``topic /b``."""
        return sorted(each.partition(",")[0] for each in self.boxes.values())

    @property
    def edges(self) -> list[tuple[str, str]]:
        """The kinds and names at both sides of each arrow, sorted."""
        boxes = {key: label.partition(",")[0] for key, label in self.boxes.items()}
        script = "all => all.map(each => [each.dataset.from, each.dataset.to])"
        found = self.page.locator("#picture .edge").evaluate_all(script)
        return sorted((boxes[start], boxes[end]) for start, end in found)

    def marked(self, name: str) -> bool:
        """Return whether a box, by kind and name, is marked as one with findings."""
        key = next(key for key, label in self.boxes.items() if label.startswith(f"{name},"))
        script = "(all, key) => all.find(each => each.dataset.key === key).classList.value"
        classes = self.page.locator("#picture [data-key]").evaluate_all(script, key)
        return "faulty" in classes.split()

    def picture(self, name: str) -> None:
        """Save what is seen, for people to look at."""
        PICTURES.mkdir(parents=True, exist_ok=True)
        self.page.screenshot(path=PICTURES / f"{name}.png")


@contextlib.contextmanager
def opened(program: Browser, text: str, folder: Path, **options: str) -> Iterator[Opened]:
    """Open a page from a file, and require that it asks for nothing else and has no errors."""
    path = folder / "page.html"
    path.write_text(text, encoding="ascii")
    context = program.new_context(viewport={"width": 1400, "height": 860}, **options)  # type: ignore[arg-type]
    found = Opened(context.new_page())
    found.page.on("request", lambda request: found.requests.append(request.url))
    found.page.on("pageerror", lambda error: found.complaints.append(str(error)))
    found.page.on("console", lambda message: found.complaints.append(message.text))
    found.page.goto(path.as_uri())
    found.settle()
    yield found
    context.close()
    assert found.requests == [path.as_uri()]
    assert found.complaints == []
