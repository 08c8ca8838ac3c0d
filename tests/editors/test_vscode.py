"""The packaged extension in a real VS Code: what a person sees who writes models."""

from __future__ import annotations

import json
import sys
import zipfile
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, expect

from deros import __version__
from tests.support.browser import browser
from tests.support.code_server import CodeServer, code_server
from tests.support.needs import needs
from tests.support.vscode import LIMIT_MS, SETTINGS, Window, window
from tools import vscode

pytestmark = pytest.mark.slow(seconds=90)

IMAGES = Path(__file__).resolve().parents[2] / "docs" / "images"
DEROS = Path(sys.executable).with_name("deros")

NODE = """\
node Driver : drive_pkg "Drives the wheels"

publishes
  topic odom : nav_msgs.Odometry
"""
SYSTEM = """\
system Robot

imports
  import "driver.rnd"

topics
  topic /motion "How the robot moves"

node driver : Driver
  wirings
    connect odom to /motion
"""
RULES = """\
use "robot.system" import Robot
action stop;
const fast = 2 km/h;
input speed = topic /motion.twist.twist.linear.x timeout 1 s;
entity motion {
  too_fast "Drives too fast" speed > fast for 1 s;
}
if motion.too_fast then { stop; }
"""
"""Rules with a slip: a colon is missing."""


@pytest.fixture(scope="module")
def extension(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Package the extension."""
    return vscode.package(tmp_path_factory.mktemp("extension"))


@pytest.fixture(scope="module")
def editor(extension: Path, tmp_path_factory: pytest.TempPathFactory) -> CodeServer:
    """Return VS Code with the extension, for a user of its own."""
    server = code_server(tmp_path_factory.mktemp("user"))
    server.install(extension)
    server.set(SETTINGS, {"deros.path": str(DEROS)})
    return server


@pytest.fixture(scope="module")
def opened(editor: CodeServer) -> Iterator[tuple[Browser, str]]:
    """Serve VS Code; yield a browser, and the address."""
    expect.set_options(timeout=LIMIT_MS)
    with editor.served() as address, browser() as program:
        yield program, address


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Make a folder with a node, a system, and rules with a slip."""
    path = tmp_path / "the robot's"
    path.mkdir()
    for name, text in {"driver.rnd": NODE, "robot.system": SYSTEM, "safety.deros": RULES}.items():
        (path / name).write_text(text, encoding="utf-8")
    return path


@pytest.fixture
def shown(opened: tuple[Browser, str], folder: Path) -> Iterator[Window]:
    """Open the folder in a window."""
    found = window(*opened, folder)
    yield found
    found.page.close()


@pytest.fixture
def pictures(pytestconfig: pytest.Config) -> list[Path]:
    """Return where pictures go besides: into the docs, with ``--refresh-golden``."""
    return [IMAGES] if pytestconfig.getoption("--refresh-golden") else []


@needs("npm")
def test_package_has_what_it_runs(extension: Path) -> None:
    """The version is that of deros; sources and tools stay out."""
    with zipfile.ZipFile(extension) as archive:
        names = {name.removeprefix("extension/") for name in archive.namelist()}
        declared = json.loads(archive.read("extension/package.json"))
        manifest = archive.read("extension.vsixmanifest").decode()
    assert {declared["main"].removeprefix("./"), "LICENSE.txt", "readme.md"} <= names
    assert "dist/THIRD-PARTY-LICENSES.txt" in names
    assert f'Version="{__version__}"' in manifest
    assert not [name for name in names if name.startswith(("src/", "node_modules/"))]


@needs("npm", "chromium")
def test_slip_is_underlined_and_mended(shown: Window, folder: Path, pictures: list[Path]) -> None:
    """The finding stands in the list; its quick fix puts the name that was meant."""
    rules = shown.open(folder / "safety.deros")
    expect(rules.shown.locator(".squiggly-error")).to_have_count(1)
    rules.press("Control+Shift+M")
    expect(shown.problems.filter(has_text="where ':' is expected")).to_contain_text("DRS003")
    rules.press("Control+Shift+M")
    rules.select("speed", "too_fast")
    rules.show_fixes()
    expect(shown.actions.first).to_contain_text("':'")
    shown.picture("fix", pictures)
    rules.press("Enter")
    expect(rules.line(": speed > fast for 1 s")).to_be_visible()
    expect(rules.shown.locator(".squiggly-error")).to_have_count(0)


@needs("npm", "chromium")
def test_word_under_the_pointer_is_explained(
    shown: Window, folder: Path, pictures: list[Path]
) -> None:
    """A constant has its value in base units, also beside the text."""
    rules = shown.open(folder / "safety.deros")
    expect(rules.line("const fast = 2 km/h= 0.555556 m/s;")).to_be_visible()
    rules.word("fast", "const").hover()
    expect(shown.hover).to_contain_text("constant fast")
    expect(shown.hover).to_contain_text("= 0.555556 m/s")
    shown.picture("hover", pictures)


@needs("npm", "chromium")
def test_fields_of_a_message_are_completed(
    shown: Window, folder: Path, pictures: list[Path]
) -> None:
    """Behind the dot, those of the message that the topic has; the one that is taken is typed."""
    rules = shown.open(folder / "safety.deros")
    expect(rules.shown.locator(".squiggly-error")).to_have_count(1)
    rules.line("action stop").click()
    rules.press("End", "Enter")
    rules.type("input turn = topic /motion.twist.twist.")
    expect(shown.offers).to_have_count(2)
    expect(shown.offers.last).to_contain_text("linear")
    shown.picture("completion", pictures)
    rules.type("a")
    expect(shown.offers).to_have_count(1)
    rules.press("Tab")
    expect(rules.line("/motion.twist.twist.angular")).to_be_visible()


@needs("npm", "chromium")
def test_name_is_changed_in_all_files(shown: Window, folder: Path) -> None:
    """A port is renamed where it is declared, and in the system that wires it."""
    system = shown.open(folder / "robot.system")
    expect(system.line("connect odom to /motion")).to_be_visible()
    node = shown.open(folder / "driver.rnd")
    node.select("odom", "topic")
    node.press("F2")
    box = shown.page.locator(".rename-box input")
    box.fill("odometry")
    box.press("Enter")
    expect(node.line("topic odometry : nav_msgs.Odometry")).to_be_visible()
    system = shown.open(folder / "robot.system")
    expect(system.line("connect odometry to /motion")).to_be_visible()


@needs("npm", "chromium")
def test_words_have_the_colours_of_their_kind(shown: Window, folder: Path) -> None:
    """Keywords, texts and numbers by the grammar; what a name is, by the server."""
    rules = shown.open(folder / "safety.deros")
    # What stands beside the text comes from the server: then it has also told the colours.
    expect(rules.shown.locator(".squiggly-error")).to_have_count(1)
    keyword = rules.colour("const", "const fast")
    assert rules.colour("entity", "entity motion") == keyword
    text = rules.colour('"robot.system"', "use")
    constant = rules.colour("fast", "const fast")
    action = rules.colour("stop", "action stop")
    assert len({keyword, text, constant, action}) == 4
    assert rules.colour("km/h", "const fast") == rules.colour("1", "for 1 s")


@needs("npm", "chromium")
def test_command_over_a_file_runs_in_the_terminal(shown: Window, folder: Path) -> None:
    """What is not saved yet is saved before; blanks and quotes in a path are part of it."""
    system = shown.open(folder / "robot.system")
    system.line("How the robot").click()
    system.press("End", "ArrowLeft")
    system.type(" on wheels")
    system.command("Draw").click()
    expect(shown.terminal.filter(has_text="moves on wheels")).to_be_visible()
    assert "How the robot moves on wheels" in (folder / "robot.system").read_text(encoding="utf-8")


@needs("npm", "chromium")
def test_program_that_is_missing_or_incomplete_is_named(
    opened: tuple[Browser, str], folder: Path
) -> None:
    """The message says what to install; another setting is taken up at once."""
    bare = folder / "bare deros"
    bare.write_text(
        f"#!{sys.executable}\nimport sys\nsys.modules['pygls'] = None\n"
        "from deros.cli.start import main\nmain()\n",
        encoding="utf-8",
    )
    bare.chmod(0o755)
    settings = folder / ".vscode/settings.json"
    settings.parent.mkdir()
    settings.write_text(json.dumps({"deros.path": "no-such-deros"}), encoding="utf-8")
    shown = window(*opened, folder)
    rules = shown.open(folder / "safety.deros", served=False)
    missing = shown.messages.filter(has_text="The program no-such-deros cannot be started")
    expect(missing).to_contain_text("pip install 'deros[lsp]'")
    settings.write_text(json.dumps({"deros.path": "./bare deros"}), encoding="utf-8")
    expect(shown.messages.filter(has_text="the language server needs pygls")).to_be_visible()
    settings.write_text("{}", encoding="utf-8")
    expect(rules.shown.locator(".squiggly-error")).to_have_count(1)
    shown.page.close()
