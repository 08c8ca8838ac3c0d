"""What is known of a launch file without running it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deros.diagnostics import SourceFile, Span
from deros.metamodels.launch_files.elements import Element, NotALaunchFile, NotRead
from deros.metamodels.launch_files.library import LaunchFiles
from deros.metamodels.launch_files.xml_elements import xml_elements
from deros.metamodels.launch_files.yaml_elements import yaml_elements
from deros.models.launch_files import LaunchDocument, LaunchFile
from deros.models.parameter_files import Fault

XML = """<?xml version="1.0" encoding="UTF-8"?>
<!-- The robot of Zoë -->
<launch>
  <arg name="robot" description="Zoë's"/>
  <arg name="mode" default="a"><choice value="a"/><choice value="b"/></arg>
  <arg name="maybe" if="$(var mode)"/>
  <group>
    <push-ros-namespace namespace="$(var space)"/>
    <node pkg="p" exec="e" name="one"/>
    <node_container pkg="p" exec="e" name="box" namespace="">
      <composable_node pkg="p" plugin="p::C" name="two"/>
    </node_container>
  </group>
</launch>
"""
YAML = """# The robot of Zoë
launch:
- arg: {name: robot, description: "Zoë's"}
- arg:
    name: mode
    default: a
    choice: [{value: a}, {value: b}]
- arg: {name: maybe, if: $(var mode)}
- group:
  - push-ros-namespace: {namespace: $(var space)}
  - node: {pkg: p, exec: e, name: one}
  - node_container:
      pkg: p
      exec: e
      name: box
      namespace: ''
      composable_node:
      - {pkg: p, plugin: 'p::C', name: two}
"""


def _loaded(folder: Path, name: str, text: str) -> LaunchDocument | Fault:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    files = LaunchFiles()
    span = Span(SourceFile(str(folder / "s.system"), ""), 0, 0)
    found = files.load(LaunchFile(name, span, span, files.load))
    assert isinstance(found, LaunchDocument | Fault)
    return found


@pytest.mark.parametrize(("name", "text"), [("a.xml", XML), ("a.yaml", YAML), ("a.yml", YAML)])
def test_xml_and_yaml_say_the_same(tmp_path: Path, name: str, text: str) -> None:
    """Arguments with choices and defaults, those that are used, and the names of nodes."""
    found = _loaded(tmp_path, name, text)
    assert isinstance(found, LaunchDocument)
    arguments = {key: (each.choices, each.is_required) for key, each in found.arguments.items()}
    assert arguments == {
        "robot": ((), True),
        "mode": (("a", "b"), False),
        "maybe": ((), False),
    }
    assert {each.span.text for each in found.arguments.values()} == {"arg"}
    assert found.used == {"mode", "space"}
    assert found.nodes == {"one", "box", "two"}
    assert found.is_complete


@pytest.mark.parametrize(
    "inside",
    [
        '<include file="b.xml"/>',
        '<node pkg="p" exec="e"/>',
        '<node pkg="p" exec="e" name="$(var robot)"/>',
        "<something_of_an_extension/>",
    ],
)
def test_file_that_may_start_others_is_not_all(tmp_path: Path, inside: str) -> None:
    """Included files, names that are computed or missing, and elements of extensions."""
    found = _loaded(tmp_path, "a.xml", f"<launch><group>{inside}</group></launch>")
    assert isinstance(found, LaunchDocument)
    assert not found.is_complete


def test_arguments_of_an_included_file_are_not_declared(tmp_path: Path) -> None:
    """They are values for it; what these use counts as used."""
    text = '<launch><include file="b"><arg name="x" value="$(var y)"/></include></launch>'
    found = _loaded(tmp_path, "a.xml", text)
    assert isinstance(found, LaunchDocument)
    assert not found.arguments
    assert found.used == {"y"}


def test_python_is_not_run(tmp_path: Path) -> None:
    """Of a launch file in Python it is known that it is there."""
    mark = tmp_path / "mark"
    found = _loaded(tmp_path, "a.launch.py", f"open({str(mark)!r}, 'w')")
    assert isinstance(found, LaunchDocument)
    assert not found.is_complete
    assert not mark.exists()


LAUGHS = "".join(f'<!ENTITY l{i} "{f"&l{i - 1};" * 10}">' for i in range(1, 12))
HOSTILE = {
    "laughs.xml": f'<!DOCTYPE a [<!ENTITY l0 "ha">{LAUGHS}]><launch><arg name="&l11;"/></launch>',
    "outside.xml": '<!DOCTYPE launch [<!ENTITY f SYSTEM "file:///etc/passwd">]><launch>&f;</launch>',
    "deep.xml": "<launch>" * 5000 + "</launch>" * 5000,
    "deep.yaml": "launch: " + "[" * 300 + "]" * 300,
    "many.xml": "<launch>" + "<arg/>" * 250_000 + "</launch>",
    "aliases.yaml": "launch:\n- &a [x, x]\n"
    + "".join(f"- &{chr(98 + i)} [{', '.join(['*' + chr(97 + i)] * 10)}]\n" for i in range(20)),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_of_hostile_files_nothing_is_known(tmp_path: Path, name: str) -> None:
    """Nothing is expanded and nothing followed; no file is a fault because it is not read."""
    found = _loaded(tmp_path, name, HOSTILE[name])
    assert isinstance(found, LaunchDocument)
    assert not found.is_complete
    assert found.arguments == {}


def _end(read: Callable[[SourceFile], Element], source: SourceFile) -> int:
    """Return where in a file its root, or what is wrong with it, ends."""
    try:
        return read(source).span.end
    except NotALaunchFile as refused:
        return refused.fault.span.end
    except NotRead:
        return 0


@given(st.text("<>/launchrg=\"' &;![]\n", max_size=60), st.booleans())
def test_no_text_is_a_crash(text: str, is_xml: bool) -> None:
    """Whatever stands in a file: it has elements, a fault in it, or is not read."""
    source = SourceFile("a", f"<launch>{text}" if is_xml else f"launch:{text}")
    for read in (xml_elements, yaml_elements):
        assert _end(read, source) <= len(source.text)
