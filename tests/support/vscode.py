"""A window of VS Code in a browser, used as a person does: what is waited for is what is seen."""

from __future__ import annotations

import re
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

from playwright.sync_api import Browser, FloatRect, Locator, Page, ViewportSize, expect

from tests.support.browser import PICTURES

SETTINGS = {
    "chat.disableAIFeatures": True,
    "editor.minimap.enabled": False,
    "terminal.integrated.gpuAcceleration": "off",  # so that the page has its text
    "workbench.colorTheme": "Default Light Modern",
    "workbench.editor.enablePreview": False,  # what is opened stays open
    "workbench.reduceMotion": "on",
    "workbench.secondarySideBar.defaultVisibility": "hidden",
    "workbench.startupEditor": "none",
}
"""Settings of a user who wants to see models and nothing else."""

LIMIT_MS = 60_000.0
"""A window starts within 15 s on an idle machine, and the server within 10 s after it."""

COMMANDS = ".codelens-decoration a"
"""The commands over a file."""

_SIZE = ViewportSize(width=1000, height=640)
_PICTURED = 260.0
_FILES = ".explorer-folders-view .monaco-list-row"
_ACTIVE = ".editor-group-container.active"


@dataclass(frozen=True)
class Editor:
    """The editor of one file.

    Attributes:
        window: where it is.
        shown: the part of the page.
    """

    window: Window
    shown: Locator

    def line(self, text: str) -> Locator:
        """Return the one line with a text."""
        return self.shown.locator(".view-line").filter(has_text=text)

    def word(self, word: str, line: str) -> Locator:
        """Return a word in the line with a text; it has a colour of its own."""
        exact = re.compile(rf"^{re.escape(word)}$")
        return self.line(line).locator("span > span").filter(has_text=exact).first

    def select(self, word: str, line: str) -> None:
        """Select a word by a double click."""
        self.word(word, line).dblclick()

    def show_fixes(self) -> None:
        """Open the list of quick fixes, when the bulb says that there are some."""
        bulb = self.window.page.get_by_role("listbox", name="Show Code Actions")
        bulb.wait_for()
        self.press("Control+.")

    def command(self, title: str) -> Locator:
        """Return a command over the file."""
        return self.shown.locator(COMMANDS, has_text=title)

    def press(self, *keys: str) -> None:
        """Press keys, one after the other."""
        for key in keys:
            self.window.page.keyboard.press(key)

    def type(self, text: str) -> None:
        """Type a text where the cursor is."""
        self.window.page.keyboard.type(text)

    def colour(self, word: str, line: str) -> str:
        """Return the colour in which a word is shown."""
        found = self.word(word, line).evaluate("each => getComputedStyle(each).color")
        return str(found)


@dataclass(frozen=True)
class Window:
    """A window with a folder."""

    page: Page

    def open(self, path: Path, *, served: bool = True) -> Editor:
        """Open a file of the folder; ``served``: wait until the server has answered for it."""
        self.page.locator(_FILES, has_text=path.name).dblclick()
        shown = self.page.locator(f'{_ACTIVE} .monaco-editor[data-uri$="{path.name}"]')
        expect(shown).to_be_visible()
        if served:
            shown.locator(COMMANDS, has_text="Generate").wait_for()
        return Editor(self, shown)

    @property
    def hover(self) -> Locator:
        """What is shown of the word under the pointer."""
        return self.page.locator(".monaco-hover:visible .hover-contents").first

    @property
    def offers(self) -> Locator:
        """The rows of the list that completion shows."""
        return self.page.locator(".suggest-widget.visible .monaco-list-row")

    @property
    def actions(self) -> Locator:
        """The rows of the list of quick fixes."""
        return self.page.locator(".action-widget .monaco-list-row.action")

    @property
    def problems(self) -> Locator:
        """The rows of the panel with all findings."""
        return self.page.locator(".markers-panel .monaco-list-row")

    @property
    def messages(self) -> Locator:
        """What the extension says in the corner."""
        return self.page.locator(".notifications-toasts .notification-list-item")

    @property
    def terminal(self) -> Locator:
        """The texts of the terminal, which may have several parts."""
        return self.page.locator(".terminal-wrapper.active .xterm-rows")

    def picture(self, name: str, also: Collection[Path] = ()) -> None:
        """Save the upper part of the editors, into the folder of pictures and into others."""
        box = self.page.locator(".part.editor").bounding_box()
        assert box is not None
        clip = FloatRect(x=box["x"], y=box["y"], width=box["width"], height=_PICTURED)
        for folder in (PICTURES, *also):
            folder.mkdir(parents=True, exist_ok=True)
            self.page.screenshot(path=folder / f"vscode-{name}.png", clip=clip)


def window(browser: Browser, address: str, folder: Path) -> Window:
    """Open a folder in a window of its own."""
    page = browser.new_page(viewport=_SIZE)
    page.set_default_timeout(LIMIT_MS)
    page.goto(f"{address}/?folder={folder}")
    page.locator(_FILES).first.wait_for()
    return Window(page)
