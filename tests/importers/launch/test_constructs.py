"""What each construct of a launch file in XML or YAML becomes, and what is reported instead."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.importers.readers import UnreadableError
from deros.names.keywords import NO_ARGUMENT
from tests.support.checks import checked
from tests.support.imported_launch import imported, model_of, rows

ENDING = {"xml": "launch.xml", "yaml": "launch.yaml"}


def text_of(folder: Path, body: str, language: str = "xml") -> str:
    """Return the text of the system that a launch file becomes, which checks without errors."""
    file = written(folder, body, language)
    found = imported(file)
    path = folder / next(iter(found.files))
    assert [e for e in checked(path) if e.severity.value == "error"] == [], path.read_text()
    return path.read_text(encoding="utf-8")


def written(folder: Path, body: str, language: str = "xml") -> Path:
    """Write a launch file whose actions these are."""
    file = folder / f"robot.{ENDING[language]}"
    whole = f"<launch>\n{body}\n</launch>\n" if language == "xml" else f"launch:\n{body}\n"
    file.write_text(whole, encoding="utf-8")
    return file


NODE = '<node pkg="driver" exec="lidar" name="lidar" {}>{}</node>'

CASES = {
    "namespace": (NODE.format('namespace="front"', ""), 'node lidar : lidar namespace "front"'),
    "own name": ('<node pkg="driver" exec="lidar"/>', "node lidar : lidar own_name"),
    "words": (
        NODE.format('args="-v \'two words\'" output="screen"', ""),
        'arguments ["-v", "two words"]',
    ),
    "words for ROS": (
        NODE.format('ros_args="--log-level debug"', ""),
        'arguments ["--ros-args", "--log-level", "debug", "--"]',
    ),
    "level": (NODE.format('ros_args="--log-level lidar:=debug"', ""), "log_level debug"),
    "again": (
        NODE.format('respawn="true" respawn_delay="1.5" respawn_max_retries="3"', ""),
        "respawn delay 1500 ms max 3",
    ),
    "again, if": (
        '<arg name="again" default="true"/>' + NODE.format('respawn="$(var again)"', ""),
        "respawn if again",
    ),
    "prefix": (NODE.format('launch-prefix="nice -n 5"', ""), 'prefix "nice -n 5"'),
    "end": (NODE.format('on_exit="shutdown"', ""), "on exit stop all"),
    "variable": (NODE.format("", '<env name="A" value="b"/>'), 'env A = "b"'),
    "integer": (NODE.format("", '<param name="n" value="7"/>'), "param n = 7"),
    "typed text": (NODE.format("", '<param name="n" value="7" type="str"/>'), 'param n = "7"'),
    "double": (NODE.format("", '<param name="n" value="7" type="float"/>'), "param n = 7.0"),
    "list": (NODE.format("", '<param name="n" value="[1, 2.5]"/>'), "param n = [1.0, 2.5]"),
    "list of texts": (NODE.format("", '<param name="n" value="[a, b]"/>'), 'param n = ["a", "b"]'),
    "nested": (
        NODE.format("", '<param name="a"><param name="b" value="true"/></param>'),
        "param a.b = true",
    ),
    "text with a mark": (NODE.format("", '<param name="n" value="${x}"/>'), 'param n = "$${x}"'),
    "remap": (NODE.format("", '<remap from="scan" to="/scan"/>'), 'remap "scan" to "/scan"'),
    "bool": (
        '<arg name="sim" default="false"/>' + NODE.format('if="$(var sim)"', ""),
        "argument sim : bool = false",
    ),
    "condition on a text": (
        '<arg name="sim" default="false"/>'
        + NODE.format('if="$(var sim)" namespace="a_$(var sim)"', ""),
        'when sim in ["true", "True", "TRUE", "1"]',
    ),
    "number": (
        '<arg name="n" default="2"/>' + NODE.format("", '<param name="n" value="$(var n)"/>'),
        "argument n : int = 2",
    ),
    "unless": (
        '<arg name="sim" default="false"/>' + NODE.format('unless="$(var sim)"', ""),
        "when not sim",
    ),
    "eval": (
        '<arg name="mode" default="a"/>'
        + NODE.format("if=\"$(eval &quot;'$(var mode)' == 'a'&quot;)\"", ""),
        'when mode = "a"',
    ),
    "let": (
        '<let name="x" value="front"/>' + NODE.format('namespace="$(var x)"', ""),
        'namespace "front"',
    ),
    "environment": (NODE.format('namespace="$(env ROBOT r1)"', ""), '"${env(ROBOT, r1)}"'),
    "set environment": (
        '<set_env name="A" value="b"/>' + NODE.format('namespace="$(env A)"', ""),
        'namespace "b"',
    ),
    "environment of all": ('<set_env name="A" value="b"/>' + NODE.format("", ""), 'env A = "b"\n'),
    "choice in a text": (
        '<arg name="sim" default="false"/>' + NODE.format('namespace="$(if $(var sim) a b)_x"', ""),
        'argument computed_1 : string = if sim then "a" else "b"',
    ),
    "group": (
        f'<group><push_ros_namespace namespace="a"/>{NODE.format("", "")}</group>',
        'subsystem a namespace "a" {',
    ),
    "timer": (f'<timer period="2.5">{NODE.format("", "")}</timer>', "delay 2500 ms"),
    "clock": (
        '<set_use_sim_time value="true"/>' + NODE.format("", ""),
        "parameters\n  param use_sim_time = true",
    ),
    "remap of all": (
        '<set_remap from="/tf" to="tf"/>' + NODE.format("", ""),
        'remappings\n  remap "/tf" to "tf"',
    ),
    "program": (
        '<executable cmd="ros2 bag record -a" name="bag" cwd="/data"/>',
        'process bag : "ros2" arguments ["bag", "record", "-a"] cwd "/data"',
    ),
    "include": (
        '<include file="$(find-pkg-share nav)/launch/a.launch.py"><arg name="x" value="1"/>'
        "</include>",
        'launch "share:nav/launch/a.launch.py" (x = "1")',
    ),
    "container": (
        '<node_container pkg="rclcpp_components" exec="component_container_mt" name="box"'
        ' namespace=""><composable_node pkg="vision" plugin="vision::Eye" name="eye">'
        '<extra_arg name="use_intra_process_comms" value="true"/></composable_node>'
        "</node_container>",
        "container box multi_threaded {\n  node eye : Eye intra_process\n}",
    ),
    "loaded": (
        '<load_composable_node target="box"><composable_node pkg="vision" plugin="vision::Eye"'
        ' name="eye"/></load_composable_node>',
        'node eye : Eye into "/box"',
    ),
    "description": (
        NODE.format(
            "",
            '<param name="d" type="str"'
            " value=\"$(command 'xacro $(find-pkg-share arm)/arm.xacro side:=left')\"/>",
        ),
        'param d from xacro "share:arm/arm.xacro" (side = "left")',
    ),
    "not set": (NODE.format('namespace="$(var robot)"', ""), "argument robot : string\n"),
}


@pytest.mark.parametrize("case", CASES)
def test_construct_is_said(case: str, tmp_path: Path) -> None:
    """In the words of the system language, without errors in a check."""
    body, expected = CASES[case]
    assert expected in text_of(tmp_path, body)


REFUSED = {
    "unknown action": ("<log_info message='x'/>", "'log_info' is left out"),
    "attribute": (NODE.format('sigterm_timeout="3"', ""), "sigterm_timeout=\"3\" of 'node'"),
    "output": (NODE.format('output="log"', ""), 'output="log" is left out'),
    "computed package": (
        '<arg name="p" default="x"/><node pkg="$(var p)" exec="y"/>',
        "'node' is left out: it has a computed 'pkg'",
    ),
    "no program": ('<node pkg="x"/>', "'node' is left out: it has no 'exec'"),
    "Python": (
        '<arg name="a" default="x"/>'
        + NODE.format("if=\"$(eval &quot;len('$(var a)')&quot;)\"", ""),
        "the condition of 'node' is left out, so that it always holds",
    ),
    "name": (
        '<arg name="a" default="x"/><node pkg="xx" exec="y" name="$(var a)_z"/>',
        "the name of 'node' is computed, which a system cannot say: it is 'z' here",
    ),
    "list without elements": (
        NODE.format("", '<param name="n" value="[]"/>'),
        "'param' is left out: it is an empty list",
    ),
    "file": (
        NODE.format("", '<param from="nowhere.yaml"/>'),
        "names 'nowhere.yaml', and there is no such file",
    ),
    "value that nothing uses": (
        '<let name="x" value="$(anon y)"/>' + NODE.format("", ""),
        "the value of 'x' is left out, and nothing uses it",
    ),
    "value that is used": (
        '<let name="x" value="$(anon y)"/>' + NODE.format('namespace="$(var x)"', ""),
        "'node' is left out: it needs $(var x), which needs $(anon …)",
    ),
    "argument": ('<arg name="a/b" default="x"/>', "the name of argument 'a/b' is 'a_b'"),
    "child": (NODE.format("", "<children/>"), "'children' in 'node' is left out"),
    "never": (NODE.format('if="false"', ""), "'node' is left out: its condition never holds"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_cannot_be_said_is_listed_with_its_line(case: str, tmp_path: Path) -> None:
    """And the rest is a model that checks without errors."""
    body, expected = REFUSED[case]
    file = written(tmp_path, body)
    found = imported(file)
    assert any(expected in each and each.startswith(f"{file}:2: ") for each in found.missing), found
    errors = [e for e in checked(tmp_path / "robot.system") if e.severity.value == "error"]
    assert errors == []


YAML = """\
- arg: {name: robot, default: r1}
- arg: {name: sim, default: 'false'}
- group:
    - push_ros_namespace: {namespace: $(var robot)}
    - node:
        pkg: driver
        exec: lidar
        name: lidar
        if: $(var sim)
        param:
          - {name: rate, value: 5}
          - {name: names, value: [a, $(var robot)]}
          - name: deep
            param: [{name: er, value: 1.5}]
        remap: [{from: scan, to: /scan}]
        env: [{name: A, value: '1'}]
"""
XML = """
<arg name="robot" default="r1"/><arg name="sim" default="false"/>
<group><push_ros_namespace namespace="$(var robot)"/>
<node pkg="driver" exec="lidar" name="lidar" if="$(var sim)">
<param name="rate" value="5"/><param name="names" value="[a, $(var robot)]"/>
<param name="deep"><param name="er" value="1.5"/></param>
<remap from="scan" to="/scan"/><env name="A" value="1"/></node></group>
"""


def test_arguments_have_names_that_the_check_takes(tmp_path: Path) -> None:
    """Words that conditions or Python use get an underscore, and each new name is listed."""
    names = sorted(NO_ARGUMENT | {"host", "then", "with-dash"})
    declared = (f'<arg name="{name}" default="x"/>' for name in names)
    used = (f"$(var {name})" for name in (*names, "lambda"))
    body = "".join(declared) + NODE.format(f'args="{" ".join(used)}"', "")
    text = text_of(tmp_path, body)
    assert "argument class_ : string" in text
    said = "\n".join(imported(tmp_path / "robot.launch.xml").missing)
    assert [name for name in names if f"the name of argument '{name}'" not in said] == []
    (tmp_path / "other").mkdir()
    assert "argument class_ : string" in text_of(
        tmp_path / "other", NODE.format('args="$(var class x)"', "")
    )


def test_arguments_whose_names_become_alike_stay_apart(tmp_path: Path) -> None:
    """One that a model may have is kept, wherever it is declared; the other one is listed."""
    names = ("class", "class_", "in/scan", "in_scan", "in-scan")
    body = "".join(f'<arg name="{name}" default="{name}.x"/>' for name in names)
    body += NODE.format(f'args="{" ".join(f"$(var {name})" for name in names)} $(var in+scan)"', "")
    text = text_of(tmp_path, body)
    for name, said in zip(
        ("class__", "class_", "in_scan_", "in_scan", "in_scan__"), names, strict=True
    ):
        assert f'argument {name} : string = "{said}.x"' in text
    assert "arguments [$class__, $class_, $in_scan_, $in_scan, $in_scan__, $in_scan___]" in text
    said = "\n".join(imported(tmp_path / "robot.launch.xml").missing)
    assert "the name of argument 'in-scan' is 'in_scan__' in the model" in said
    assert "'class_' is" not in said


def test_both_formats_start_the_same(tmp_path: Path) -> None:
    """For both values of a condition."""
    models = []
    for language, body in (("xml", XML), ("yaml", YAML)):
        (tmp_path / language).mkdir()
        models.append(model_of(written(tmp_path / language, body, language)))
    for sim in (True, False):
        first, second = (rows(each, {"sim": sim, "robot": "r2"}) for each in models)
        assert first == second
        assert len(first) == sim
    (row,) = rows(models[0], {"sim": True})
    assert "namespace='/r1'" in row
    assert "{'rate': 5, 'names': ('a', 'r1'), 'deep.er': 1.5}" in row
    assert "remappings={'/r1/scan': '/scan'}" in row
    assert "environment={'A': '1'}" in row


def test_settings_count_for_what_follows_alone(tmp_path: Path) -> None:
    """As launch executes its actions one after the other."""
    one, two, three = (f'<node pkg="pp" exec="n" name="{name}"/>' for name in ("a", "b", "c"))
    body = (
        f'{one}<group><push_ros_namespace namespace="x"/><set_env name="E" value="1"/>{two}'
        f'</group><push_ros_namespace namespace="y"/>{three}'
    )
    found = rows(model_of(written(tmp_path, body)), {})
    spaces = ("namespace='/'", "namespace='/x'", "namespace='/y'")
    assert [space in row for space, row in zip(spaces, found, strict=True)] == [True] * 3
    assert ["'E': '1'" in row for row in found] == [False, True, False]


def test_descriptions_that_are_there_are_used(tmp_path: Path) -> None:
    """Their ports are connected, and what they do not declare is listed."""
    (tmp_path / "nodes").mkdir()
    (tmp_path / "nodes" / "ranger.rnd").write_text(
        'node ranger : driver executable "lidar"\nparameters name rate : double = 1.0\n'
        "publishes topic scan : sensor_msgs.LaserScan\nsubscribes topic stop : std_msgs.Bool\n"
    )
    body = NODE.format(
        'namespace="front"',
        '<param name="rate" value="2.0"/><param name="speed" value="1"/>'
        '<remap from="scan" to="/scan"/><remap from="/tf" to="tf"/>',
    )
    file = written(tmp_path, body)
    found = imported(file)
    text = (tmp_path / "robot.system").read_text()
    assert "node lidar : ranger" in text
    assert 'connect scan to "/scan"' in text
    assert 'connect stop to "stop"' in text
    assert 'remap "/tf" to "tf"' in text
    assert "external topic /front/stop" in text
    assert list(found.files) == ["robot.system"]
    (missing,) = found.missing
    assert "'speed' is left out: node type 'ranger' does not declare it" in missing
    assert checked(tmp_path / "robot.system") == []


def test_paths_lead_from_the_models_to_the_files(tmp_path: Path) -> None:
    """The folder of the launch file is not that of the system."""
    launch = tmp_path / "launch"
    launch.mkdir()
    (tmp_path / "config.yaml").write_text("/**:\n  ros__parameters:\n    rate: 1.0\n")
    body = NODE.format("", '<param from="$(dirname)/../config.yaml"/>')
    model_of(written(launch, body), tmp_path / "models")
    text = (tmp_path / "models" / "robot.system").read_text()
    assert 'parameters from "../config.yaml"' in text
    assert [
        e for e in checked(tmp_path / "models/robot.system") if e.severity.value == "error"
    ] == []


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("a.launch.xml", b"<launch>"),
        ("a.launch.xml", b"\xff\xfe<launch/>"),
        ("a.launch.xml", b"<robot/>"),
        ("a.launch.xml", b'<!DOCTYPE a [<!ENTITY b "c">]><launch>&b;</launch>'),
        ("a.launch.xml", b"<launch>" + b"<group>" * 3000 + b"</group>" * 3000 + b"</launch>"),
        ("a.launch.yaml", b"launch: [unclosed"),
        ("a.launch.yaml", b"- node"),
        ("a.launch.yaml", b"launch: " + b"[" * 5000),
        ("a.launch.yaml", b"\0"),
    ],
)
def test_what_is_no_launch_file_is_refused(name: str, data: bytes, tmp_path: Path) -> None:
    """By name, with what is wrong."""
    (tmp_path / name).write_bytes(data)
    with pytest.raises(UnreadableError, match=r"a\.launch\."):
        imported(tmp_path / name)


def test_arguments_that_are_compared_have_one_type(tmp_path: Path) -> None:
    """Though one of them alone is a condition, too."""
    body = (
        '<arg name="a" default="false"/><arg name="b" default="false"/>'
        '<node pkg="pp" exec="n" name="x" if="$(equals $(var a) $(var b))"/>'
        '<node pkg="pp" exec="n" name="y" if="$(var a)"/>'
    )
    system = model_of(written(tmp_path, body))
    counts = {
        (a, b): len(rows(system, {"a": a, "b": b})) for a in (True, False) for b in (True, False)
    }
    expected = {(True, True): 2, (True, False): 1, (False, True): 0, (False, False): 1}
    assert counts == expected
