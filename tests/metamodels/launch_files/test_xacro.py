"""What a file for xacro says of its arguments, with the files that it includes."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.diagnostics import SourceFile, Span
from deros.metamodels.launch_files.library import LaunchFiles
from deros.models.launch_files import LoadedXacroFile, XacroDocument, XacroFile
from deros.models.parameter_files import Fault, Missing

HEAD = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro">'
ROBOT = f"""{HEAD}
  <!-- $(arg of_a_comment) -->
  <xacro:arg name="prefix" default=""/>
  <xacro:include filename="parts/arm.xacro"/>
  <xacro:if value="$(arg simulated)"><link name="$(arg only_simulated)"/></xacro:if>
  <xacro:macro name="wheel" params="side"><link name="$(arg wheel)"/></xacro:macro>
  <link name="$(arg prefix)base">$(arg text) $$(arg escaped)</link>
  <link name="${{xacro.arg('quoted')}}"/>
</robot>
"""
ARM = f"""{HEAD}<xacro:arg name="reach" default="1"/><xacro:include filename="../robot.xacro"/>
<link name="$(arg side)"/></robot>
"""


def _statement(folder: Path, path: str, files: LaunchFiles) -> XacroFile:
    span = Span(SourceFile(str(folder / "s.system"), ""), 0, 0)
    return XacroFile(path, span, files.load_xacro)


def _loaded(folder: Path, text: str) -> LoadedXacroFile | None:
    (folder / "robot.xacro").write_text(text, encoding="utf-8")
    return _statement(folder, "robot.xacro", LaunchFiles()).load()


def test_arguments_are_those_of_the_file_and_of_what_it_includes(tmp_path: Path) -> None:
    """What a condition or a macro holds may not be looked at; a cycle of files ends."""
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "arm.xacro").write_text(ARM)
    found = _loaded(tmp_path, ROBOT)
    assert isinstance(found, XacroDocument)
    assert found.is_complete
    assert set(found.arguments) == {"prefix", "reach"}
    assert set(found.needed) == {"prefix", "simulated", "text", "side"}
    assert found.used - set(found.needed) == {"only_simulated", "wheel", "quoted"}
    assert [Path(each.path).name for each in found.whole] == ["robot.xacro", "arm.xacro"]


@pytest.mark.parametrize(
    "inside",
    [
        '<xacro:include filename="$(find arm)/arm.xacro"/>',
        '<xacro:include filename="missing.xacro"/>',
        '<xacro:include filename="*.xacro"/>',
        '<xacro:include filename="broken.xacro"/>',
        '<link name="${xacro.arg(name)}"/>',
        '<xacro:arg name="${prefix}_x" default=""/>',
    ],
)
def test_file_that_is_not_known_whole_says_so(tmp_path: Path, inside: str) -> None:
    """Then nothing is claimed about arguments."""
    (tmp_path / "broken.xacro").write_text("<robot>")
    found = _loaded(tmp_path, f"{HEAD}{inside}</robot>")
    assert isinstance(found, XacroDocument)
    assert not found.is_complete


def test_entities_are_never_expanded(tmp_path: Path) -> None:
    """Of a file with one, nothing is known."""
    found = _loaded(tmp_path, '<!DOCTYPE r [<!ENTITY a "b">]><robot name="&a;$(arg x)"/>')
    assert isinstance(found, XacroDocument)
    assert not found.is_complete
    assert not found.used


def test_file_that_cannot_be_read_has_its_reason(tmp_path: Path) -> None:
    """It is not XML, or not there."""
    fault = _loaded(tmp_path, "<robot>")
    assert isinstance(fault, Fault)
    assert fault.message.startswith("this is not XML")
    assert isinstance(_statement(tmp_path, "no.xacro", LaunchFiles()).load(), Missing)


def test_library_knows_all_files_that_a_result_depends_on(tmp_path: Path) -> None:
    """Those that are included, too: a build system reads this list."""
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "arm.xacro").write_text(ARM)
    (tmp_path / "robot.xacro").write_text(ROBOT)
    files = LaunchFiles()
    _statement(tmp_path, "robot.xacro", files).load()
    assert {path.name for path in files.paths} == {"robot.xacro", "arm.xacro"}
