"""The page in a browser, used as a person does."""

from __future__ import annotations

from pathlib import Path

import pytest
from playwright.sync_api import Browser

from benchmarks.big_system import write
from deros.diagnostics import Diagnostic
from deros.models.system import System
from tests.support.browser import opened, text_of
from tests.support.needs import needs
from tests.support.systems import load, load_text

pytestmark = needs("chromium", "elkjs")

Courier = tuple[System, list[Diagnostic]]


def _page(courier: Courier) -> str:
    system, findings = courier
    return text_of(system, tuple(findings))


def test_page_shows_the_system_with_its_findings_in_red(
    courier: Courier, chromium: Browser, tmp_path: Path
) -> None:
    """Boxes for all that is there, arrows the way of the data, marks at what findings are about."""
    with opened(chromium, _page(courier), tmp_path) as page:
        page.picture("courier")
        assert page.names == [
            "node /courier/drive",
            "node /courier/lidar",
            "node /courier/slam",
            "service /slam/save",
            "subsystem Drive",
            "subsystem Drive/Mapping",
            "subsystem Sensors",
            "topic /courier/cmd_vel",
            "topic /courier/map",
            "topic /courier/odom",
            "topic /courier/scan",
        ]
        assert ("topic /courier/scan", "node /courier/slam") in page.edges
        assert ("node /courier/drive", "service /slam/save") in page.edges
        assert page.marked("node /courier/slam")
        assert not page.marked("topic /courier/scan")
        assert page.page.locator(".edge.faulty").count() == 1  # to the undeclared topic
        assert page.page.locator(".edge.elsewhere").count() == 1  # of a service of a variant
        listed = page.page.locator("#found li .link").all_inner_texts()
        assert listed == [f"{each.code.name} {each.code.slug}" for each in courier[1]]


def test_hover_and_click_tell_type_qos_units_and_place(
    courier: Courier, chromium: Browser, tmp_path: Path
) -> None:
    """The tip is short, and gone when the pointer leaves; the panel has all of it."""
    with opened(chromium, _page(courier), tmp_path) as page:
        topic = page.page.locator("#picture [data-key='topic /courier/scan']")
        topic.hover()
        tip = page.text("#tip")
        assert "sensor_msgs.LaserScan" in tip
        assert "best_effort, volatile, depth 5; ranges [m]" in tip
        assert "reliable, volatile, depth 10" in tip
        page.page.mouse.move(5, 5)
        assert page.page.locator("#tip").is_hidden()
        topic.click()
        details = page.text("#details")
        assert "Publishers" in details
        assert "Subscriptions" in details
        assert "courier.system:28" in details
        page.click("#details button.link")
        assert "node /courier/lidar" in page.text("#details h2")
        assert "courier_laser" in page.text("#details")
        assert "[courier, here]" in page.text("#details")
        assert "null" not in page.text("#details")


def test_texts_of_the_system_are_never_markup(
    courier: Courier, chromium: Browser, tmp_path: Path
) -> None:
    """A hostile description is shown as it is written, and runs nothing."""
    with opened(chromium, _page(courier), tmp_path) as page:
        page.page.on("dialog", lambda dialog: pytest.fail(dialog.message))
        page.find("lidar")
        assert "Reads the laser </script><img src=x onerror=alert(1)>" in page.text("#details")
        assert page.page.locator("img, #title b").count() == 0


def test_policy_stops_a_script_that_is_not_of_the_page(
    courier: Courier, chromium: Browser, tmp_path: Path
) -> None:
    """Even if a text came into the page as markup, the browser would refuse to run it."""
    hostile = _page(courier).replace("</main>", "<script>document.title = 'taken'</script></main>")
    with opened(chromium, hostile, tmp_path) as page:
        assert page.page.title() == "Courier"
        refused = page.complaints.copy()
        assert refused
        assert all("Content Security Policy" in each for each in refused)
        page.complaints.clear()


def test_switches_show_the_variant(courier: Courier, chromium: Browser, tmp_path: Path) -> None:
    """Parts come and go, names and parameters change, and a value out of bounds is refused."""
    with opened(chromium, _page(courier), tmp_path) as page:
        page.switch("robot", "titan")
        assert "topic /titan/scan" in page.names
        assert not any("courier" in each for each in page.names)
        page.switch("mode", "hand")
        assert "process Sensors/recorder" in page.names
        assert "node /titan/slam" not in page.names
        assert "topic /unused" in page.names
        page.switch("speed", 1.5)
        page.find("drive")
        assert "3.0" in page.text("#details")
        page.switch("speed", 2)
        assert "'2' is not a double in [0.1, 2.0)" in page.text("#status")
        assert page.page.locator("[name=speed]").get_attribute("aria-invalid") == "true"
        assert "3.0" in page.text("#details")
        page.picture("courier-by-hand")
        page.click("#arguments button")
        assert "node /courier/slam" in page.names
        page.switch("slam", False)
        assert "node /courier/slam" not in page.names


def test_findings_lead_to_what_they_are_about(
    courier: Courier, chromium: Browser, tmp_path: Path
) -> None:
    """Also into a folded subsystem; of a part that this variant lacks, the page says so."""
    with opened(chromium, _page(courier), tmp_path) as page:
        page.click("#fold-all")
        assert "node /courier/slam" not in page.names
        assert page.marked("subsystem Drive")
        page.click("#found li:has-text('DRS245') .link")
        assert "node /courier/slam" in page.text("#details h2")
        assert "never-activated" not in page.text("#details")
        assert "nothing activates the managed node" in page.text("#details")
        page.click("#found li:has-text('DRS212') .link")
        assert page.text("#status") == "not in this variant: courier.system:11"


def test_finding_of_another_variant_is_shown_there(
    courier: Courier, chromium: Browser, tmp_path: Path
) -> None:
    """Until then it is neither hidden nor in red; a click sets the values that it names."""
    with opened(chromium, _page(courier), tmp_path) as page:
        found = "#found li:has-text('DRS225')"
        assert "elsewhere" in (page.page.locator(found).get_attribute("class") or "")
        page.click(f"{found} .link")
        assert not page.page.locator("[name=slam]").is_checked()
        assert "elsewhere" not in (page.page.locator(found).get_attribute("class") or "")
        assert page.page.locator(".edge.faulty").count() == 1
        assert page.page.locator(".edge.elsewhere").count() == 0
        page.picture("courier-without-slam")


def test_wiring_of_a_parameter_has_no_direction(chromium: Browser, tmp_path: Path) -> None:
    """No port says whether the node reads or writes there, so the line has no arrow."""
    talker = 'node talker : p parameters name legacy : string = "x"'
    text = """
        system S imports import "talker.rnd" topics external topic /old : std_msgs.Bool
        node one : talker wirings connect legacy to /old
    """
    system = load_text(tmp_path, text, talker=talker)
    with opened(chromium, text_of(system), tmp_path) as page:
        assert page.edges == [("node /one", "topic /old")]
        assert page.page.locator(".edge path[marker-end]").count() == 0
        page.find("old")
        assert "parameter legacy" in page.text("#details")
        assert "Publishers" not in page.text("#details")


def test_keyboard_reaches_everything(courier: Courier, chromium: Browser, tmp_path: Path) -> None:
    """Enter opens what has the focus, and keeps it there; keys move the picture."""
    with opened(chromium, _page(courier), tmp_path) as page:
        page.press("[aria-label='Fold Drive']", "Enter")
        assert "node /courier/drive" not in page.names
        page.press("[aria-label='Unfold Drive']", "Enter")
        assert "node /courier/drive" in page.names
        page.press("#picture [aria-label^='node /courier/drive,']", "Enter")
        assert "node /courier/drive" in page.text("#details h2")
        focused = page.page.evaluate("document.activeElement.getAttribute('aria-label')")
        assert focused.startswith("node /courier/drive")
        seen = page.page.locator("#picture").get_attribute("viewBox")
        page.press("#picture", "+")
        assert page.page.locator("#picture").get_attribute("viewBox") != seen
        page.press("#picture", "0")
        assert page.page.locator("#picture").get_attribute("viewBox") == seen


def test_drag_moves_the_picture_and_selects_nothing(
    courier: Courier, chromium: Browser, tmp_path: Path
) -> None:
    """A click selects; a drag that begins on a box does not."""
    with opened(chromium, _page(courier), tmp_path) as page:
        seen = page.page.locator("#picture").get_attribute("viewBox")
        frame = page.page.locator("[data-key='topic /courier/scan']").bounding_box()
        assert frame is not None
        page.page.mouse.move(frame["x"] + 20, frame["y"] + 10)
        page.page.mouse.down()
        page.page.mouse.move(frame["x"] + 90, frame["y"] + 60, steps=4)
        page.page.mouse.up()
        assert page.page.locator("#picture").get_attribute("viewBox") != seen
        assert page.page.locator("#details").is_hidden()
        page.click("[data-key='topic /courier/scan']")
        assert "topic /courier/scan" in page.text("#details h2")


def test_folded_subsystem_stands_for_what_is_in_it(
    courier: Courier, chromium: Browser, tmp_path: Path
) -> None:
    """Its arrows go to the topics outside, those inside are gone, and a double click opens it."""
    with opened(chromium, _page(courier), tmp_path) as page:
        page.click("#fold-all")
        assert page.names == ["subsystem Drive", "subsystem Sensors", "topic /courier/scan"]
        assert page.edges == [
            ("subsystem Sensors", "topic /courier/scan"),
            ("topic /courier/scan", "subsystem Drive"),
        ]
        page.page.locator("[data-key='group Drive']").dblclick()
        page.settle()
        assert "node /courier/drive" in page.names
        assert "node /courier/slam" not in page.names


def test_arrows_of_a_folded_subsystem_to_one_topic_are_one(
    chromium: Browser, tmp_path: Path
) -> None:
    """However many of its nodes publish there; what also subscribes has an arrow for each way."""
    talker = "node talker : p publishes topic out : std_msgs.Bool"
    relay = "node relay : p publishes topic out : std_msgs.Bool subscribes topic in : std_msgs.Bool"
    text = """
        system S imports import "talker.rnd" import "relay.rnd" topics topic /x
        subsystem group {
          node one : talker wirings connect out to /x
          node two : talker wirings connect out to /x
        }
        node relay : relay wirings connect out to /x connect in to /x
    """
    system = load_text(tmp_path, text, talker=talker, relay=relay)
    with opened(chromium, text_of(system), tmp_path) as page:
        assert len(page.edges) == 4
        page.click("#fold-all")
        assert page.edges == [
            ("node /relay", "topic /x"),
            ("subsystem group", "topic /x"),
            ("topic /x", "node /relay"),
        ]


def test_neighbours_alone(courier: Courier, chromium: Browser, tmp_path: Path) -> None:
    """What is not connected to the selected box is left out, until everything is asked for."""
    with opened(chromium, _page(courier), tmp_path) as page:
        page.find("lidar")
        page.click("#details button:has-text('neighbours')")
        assert page.names == [
            "node /courier/lidar",
            "node /courier/slam",
            "subsystem Drive",
            "subsystem Drive/Mapping",
            "subsystem Sensors",
            "topic /courier/scan",
        ]
        page.click("#details button:has-text('everything')")
        assert "node /courier/drive" in page.names


def test_only_what_is_there_makes_a_system_large(chromium: Browser, tmp_path: Path) -> None:
    """A program that is started in one of two ways is one program."""
    nodes = " ".join(f"node n{number} : part respawn if again" for number in range(40))
    text = (
        f'system S argument again : bool = false imports import "*.rnd" subsystem s {{ {nodes} }}'
    )
    system = load_text(tmp_path, text, part="node part : parts")
    with opened(chromium, text_of(system), tmp_path) as page:
        assert {f"node /n{number}" for number in range(40)} <= set(page.names)


def test_large_system_begins_folded_and_is_searched(chromium: Browser, tmp_path: Path) -> None:
    """500 nodes in 50 subsystems: what is searched for is unfolded, and nothing else."""
    system = load(write(tmp_path, 500))
    with opened(chromium, text_of(system), tmp_path) as page:
        assert page.names == sorted(f"subsystem cart_{number}" for number in range(50))
        page.picture("fleet")
        page.find("smoother_7_3")
        page.picture("fleet-found")
        assert "node /smoother_7_3" in page.text("#details h2")
        assert page.page.locator("#tip").is_hidden()
        assert len(page.names) == 50 + 10 + 10
        page.click("#fit")
        page.click("[aria-label='Unfold cart_9']")
        assert "node /driver_9" in page.names
        page.click("[aria-label='Fold cart_7']")
        assert "node /smoother_7_3" not in page.names


def test_large_system_without_subsystems_begins_with_the_search(
    chromium: Browser, tmp_path: Path
) -> None:
    """A picture of all of it would be a ribbon; it is there for those who ask."""
    talker = "node talker : p publishes topic out : std_msgs.Bool"
    nodes = "".join(f"node n{n} : talker wirings connect out to /t{n} " for n in range(150))
    topics = "".join(f"topic /t{n} " for n in range(150))
    text = f'system Flat imports import "talker.rnd" topics {topics} {nodes}'
    system = load_text(tmp_path, text, talker=talker)
    with opened(chromium, text_of(system), tmp_path) as page:
        assert page.names == []
        assert "All 300 boxes" in page.text("#note")
        page.find("n77")
        assert page.names == ["node /n77", "topic /t77"]

        page.click("#details button:has-text('everything')")
        assert len(page.names) == 300


@pytest.mark.parametrize("scheme", ["dark", "light"])
def test_colours_follow_the_wish_of_the_reader(
    courier: Courier, chromium: Browser, tmp_path: Path, scheme: str
) -> None:
    """Text stands out from the paper in both."""
    with opened(chromium, _page(courier), tmp_path, color_scheme=scheme) as page:
        page.picture(f"courier-{scheme}")
        paper, ink = page.page.evaluate(
            "['backgroundColor', 'color'].map(each => getComputedStyle(document.body)[each])"
        )
        assert (_lightness(paper) < _lightness(ink)) == (scheme == "dark")
        assert abs(_lightness(paper) - _lightness(ink)) > 500


def _lightness(colour: str) -> int:
    return sum(map(int, colour.removeprefix("rgb(").removesuffix(")").split(",")))


def test_print_has_picture_and_findings_alone(
    courier: Courier, chromium: Browser, tmp_path: Path
) -> None:
    """What only a screen has is left out on paper."""
    with opened(chromium, _page(courier), tmp_path) as page:
        page.page.emulate_media(media="print")
        assert page.page.locator("#search").is_hidden()
        assert page.page.locator("#tools").is_hidden()
        assert page.page.locator("#picture").is_visible()
        assert page.page.locator("#found").is_visible()


@pytest.mark.essential  # examples change more often than the page does
def test_examples_have_pages(chromium: Browser, tmp_path: Path) -> None:
    """Safety nodes and gates are in the picture as what they are."""
    folder = Path(__file__).resolve().parents[3] / "examples"
    with opened(
        chromium, text_of(load(folder / "feeding_robot/feeding_robot.system")), tmp_path
    ) as page:
        page.picture("feeding-robot")
        assert "safety node /safety" in page.names
        assert ("safety node /safety", "topic /safety/stop") in page.edges
        assert "node /robot_simulator" in page.names
        page.switch("simulated", False)
        assert "node /robot_simulator" not in page.names


def test_system_without_arguments_has_no_switches(chromium: Browser, tmp_path: Path) -> None:
    """Nor the heading above them."""
    text = 'system S imports import "*.rnd" subsystem s { node n : part }'
    system = load_text(tmp_path, text, part="node part : parts")
    with opened(chromium, text_of(system), tmp_path) as page:
        assert page.page.locator("#switches").is_hidden()
