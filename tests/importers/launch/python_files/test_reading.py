"""What the process hands over becomes models as a launch file in XML does."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from deros.generators.output.writer import write
from deros.importers.kept.files import renewed
from deros.importers.launch.python_files.reading import root_of
from deros.importers.launch.python_files.visit.elements import element
from deros.importers.launch.reading import read_by, read_xml
from deros.importers.readers import Request, source_of
from deros.importers.results import Imported
from tests.support.checks import checked

MADE = {
    "actions": [
        element("arg", 3, {"name": "robot", "default": "courier"}),
        element(
            "group",
            4,
            {"if": "true"},
            [
                element("push_ros_namespace", 4, {"namespace": "front"}),
                element(
                    "node",
                    5,
                    {"pkg": "lidar_driver", "exec": "driver", "name": "lidar"},
                    [element("param", 5, {"name": "rate", "type": "list_of_int"}, [
                        element("value", 5, content="1"), element("value", 5, content="2")])],
                    commands={"args": ["--to", "two words"]},
                ),
            ],
        ),
    ],
    "unsaid": [["'RegisterEventHandler'", "is left out: a system cannot say it", 6]],
}  # fmt: skip
IN_XML = """<launch>
<arg name="robot" default="courier"/>
<group if="true"><push_ros_namespace namespace="front"/>
<node pkg="lidar_driver" exec="driver" name="lidar" args="--to 'two words'">
<param name="rate" type="list_of_int"><value>1</value><value>2</value></param></node></group>
</launch>"""


def request(path: Path) -> Request:
    """Return the request for one file."""
    return Request((path,), None, path.parent, lambda _: True)


def models(path: Path, made: Mapping[str, Any]) -> Imported:
    """Return the models of a launch file that has made this."""
    return read_by(request(path), lambda each: root_of(source_of(each), made))


def test_models_are_those_of_the_same_in_xml(tmp_path: Path) -> None:
    """They check clean, and what has no element is listed with its line."""
    path = tmp_path / "robot.launch.py"
    path.write_text("\n" * 8)
    found = models(path, MADE)
    assert found.missing == (
        f"{path}:6: 'RegisterEventHandler' is left out: a system cannot say it",
    )
    xml = tmp_path / "robot.launch.xml"
    xml.write_text(IN_XML)
    assert found.files == read_xml(request(xml)).files
    write(renewed(found.files, tmp_path).files, tmp_path)
    assert [e for e in checked(tmp_path / "robot.system") if e.severity.value == "error"] == []


def test_lines_are_those_of_the_file_as_far_as_it_goes(tmp_path: Path) -> None:
    """What is made in another file stands at the beginning."""
    path = tmp_path / "robot.launch.py"
    path.write_text("a\nb\nc")
    for said, line in ((0, 1), (2, 2), (3, 3), (99, 3)):
        made = {"actions": [element("log", said)], "unsaid": []}
        (missing,) = models(path, made).missing
        assert missing.startswith(f"{path}:{line}: 'log'")
