"""Launch files in Python, run by the real launch and launch_ros."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping
from pathlib import Path

import pytest

from deros.generators.output.writer import write
from deros.importers.kept.files import renewed
from deros.importers.launch.reading import read_python
from deros.importers.readers import Request, UnreadableError
from tests.support.checks import checked
from tests.support.needs import needs

pytestmark = needs("launch_ros")

HEAD = """
import os
from launch import LaunchDescription, Substitution
from launch.actions import *
from launch.conditions import *
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import *
from launch_ros.actions import *
from launch_ros.descriptions import ComposableNode, ParameterFile, ParameterValue
from launch_ros.substitutions import FindPackageShare

def node(**others):
    return Node(package='driver', executable='lidar', name='lidar', **others)

"""
BODY = "def generate_launch_description():\n    return LaunchDescription([{}])\n"
ROBOT = "DeclareLaunchArgument('robot', default_value='r1'), "


def imported(
    folder: Path, actions: str, before: str = "", values: Mapping[str, str] | None = None
) -> tuple[str, list[str]]:
    """Return the system of a launch file with some actions, and what is listed; it checks."""
    path = folder / "robot.launch.py"
    path.write_text(HEAD + textwrap.dedent(before) + BODY.format(actions))
    found = read_python(Request((path,), None, folder, lambda _: True, values=values or {}))
    write(renewed(found.files, folder).files, folder)
    system = folder / "robot.system"
    assert [e for e in checked(system) if e.severity.value == "error"] == [], system.read_text()
    return system.read_text(), [each.removeprefix(f"{path}:") for each in found.missing]


CASES = {
    "an argument": (
        "DeclareLaunchArgument('mode', default_value='a', choices=['a', 'b'], description='M')",
        'argument mode : string = "a" one_of ["a", "b"] "M"',
    ),
    "words": ("node(arguments=['-v', 'two words'])", 'arguments ["-v", "two words"]'),
    "a word of an argument": (
        f"{ROBOT}node(arguments=['--name', [LaunchConfiguration('robot'), ' 1']])",
        'arguments ["--name", "${robot} 1"]',
    ),
    "again": ("node(respawn=True, respawn_delay=1.5)", "respawn delay 1500 ms"),
    "the end": ("node(on_exit=Shutdown())", "on exit stop all"),
    "a variable": ("node(additional_env={'A': 'b'})", 'env A = "b"'),
    "a bool": ("node(parameters=[{'p': True}])", "param p = true"),
    "an integer": ("node(parameters=[{'p': 7}])", "param p = 7"),
    "a small number": ("node(parameters=[{'p': 1e-05}])", "param p = 1e-05"),
    "a text that looks like a number": ("node(parameters=[{'p': '7'}])", 'param p = "7"'),
    "a text with a dollar": ("node(parameters=[{'p': 'a $(b) \\\\'}])", 'param p = "a $(b)'),
    "numbers": ("node(parameters=[{'p': [1, 2.5]}])", "param p = [1.0, 2.5]"),
    "texts": ("node(parameters=[{'p': ['a b', 'c']}])", 'param p = ["a b", "c"]'),
    "a part": ("node(parameters=[{'a': {'b': 1}}])", "param a.b = 1"),
    "a text of an argument": (
        f"{ROBOT}node(parameters=[{{'p': [LaunchConfiguration('robot'), '_x']}}])",
        'param p = "${robot}_x"',
    ),
    "a text of a type": (
        f"{ROBOT}node(parameters=[{{'p': ParameterValue(LaunchConfiguration('robot'), "
        "value_type=str)}])",
        "param p = $robot",
    ),
    "xacro": (
        "node(parameters=[{'p': ParameterValue(Command([FindExecutable(name='xacro'), ' ', "
        "PathJoinSubstitution([FindPackageShare('robot_description'), 'urdf', 'r.xacro']), "
        "' sim:=true']), value_type=str)}])",
        'param p from xacro "share:robot_description/urdf/r.xacro" (sim = "true")',
    ),
    "a remapping": ("node(remappings=[('scan', 'front/scan')])", 'remap "scan" to "front/scan"'),
    "a condition": (
        "DeclareLaunchArgument('slam', default_value='true'), "
        "node(condition=UnlessCondition(LaunchConfiguration('slam')))",
        "when not slam",
    ),
    "a comparison": (
        f"{ROBOT}node(condition=LaunchConfigurationEquals('robot', 'r2'))",
        'when robot = "r2"',
    ),
    "an expression": (
        f"{ROBOT}node(condition=IfCondition(PythonExpression(["
        "'\"', LaunchConfiguration('robot'), '\" == \"r2\"'])))",
        'when robot = "r2"',
    ),
    "a namespace": (
        f"{ROBOT}GroupAction([PushRosNamespace(LaunchConfiguration('robot')), node()])",
        "namespace $robot",
    ),
    "a setting": (
        "GroupAction([SetParameter('use_sim_time', True), SetRemap('a', 'b'), node()])",
        "param use_sim_time = true",
    ),
    "a container": (
        "ComposableNodeContainer(name='main', namespace='', package='rclcpp_components', "
        "executable='component_container_mt', composable_node_descriptions=[ComposableNode("
        "package='driver', plugin='driver::Lidar', name='lidar', "
        "extra_arguments=[{'use_intra_process_comms': True}])])",
        "node lidar : Lidar intra_process",
    ),
    "a loaded node": (
        "DeclareLaunchArgument('space', default_value=''), LoadComposableNodes("
        "target_container=(LaunchConfiguration('space'), '/', 'main'), "
        "composable_node_descriptions=[ComposableNode("
        "package='driver', plugin='driver::Lidar', name='lidar')])",
        'if space = "" then "main" else "${space}/main"',
    ),
    "a process": (
        "ExecuteProcess(cmd=['ls', '-l', 'two words'])",
        'process ls : "ls" arguments ["-l", "two words"]',
    ),
    "a command of a shell": (
        "ExecuteProcess(cmd=['echo', '$HOME', '|', 'cat'], shell=True)",
        'arguments ["-c", "echo $HOME | cat"]',
    ),
    "a delay": ("TimerAction(period=2.0, actions=[node()])", "delay 2 sec"),
    "an included file": (
        f"{ROBOT}IncludeLaunchDescription(PythonLaunchDescriptionSource(["
        "FindPackageShare('maps'), '/launch/map.launch.py']), "
        "launch_arguments={'name': LaunchConfiguration('robot')}.items())",
        'launch "share:maps/launch/map.launch.py" (name = $robot',
    ),
    "an iterator": ("GroupAction(map(lambda each: node(), [1]))", "node lidar : lidar"),
}


@pytest.mark.parametrize("name", CASES)
def test_construct(name: str, tmp_path: Path) -> None:
    """As the same in XML."""
    actions, line = CASES[name]
    system, missing = imported(tmp_path, actions)
    assert line in system, system
    assert missing == []


COUNTED = """
    def count(context):
        number = int(LaunchConfiguration('count').perform(context))
        return [Node(package='driver', executable='lidar', name=f'lidar_{i}')
                for i in range(number)]
"""
COUNT = "DeclareLaunchArgument('count', default_value='1'), "


def test_functions_are_run_with_the_values_that_are_given(tmp_path: Path) -> None:
    """They are the defaults of the model, too."""
    system, missing = imported(tmp_path, f"{COUNT}OpaqueFunction(function=count)", COUNTED)
    assert "lidar_0" in system
    assert "lidar_1" not in system
    why = "is what it makes with the values that it was run with; see NAME:=VALUE"
    assert [each.partition(": ")[2] for each in missing] == [f"'OpaqueFunction' {why}"]
    system, _ = imported(
        tmp_path, f"{COUNT}OpaqueFunction(function=count)", COUNTED, {"count": "3"}
    )
    assert "lidar_2" in system
    assert 'argument count : string = "3"' in system


def test_functions_see_the_values_where_they_stand(tmp_path: Path) -> None:
    """Those of a group end with it; under a condition that does not hold, nothing is set or run."""
    inner = "SetLaunchConfiguration('count', '2'), OpaqueFunction(function=count)"
    grouped = f"GroupAction([PushRosNamespace('front'), {inner}])"
    system, _ = imported(tmp_path, f"{COUNT}{grouped}, OpaqueFunction(function=count)", COUNTED)
    assert system.count("node lidar_0") == 2
    assert system.count("node lidar_1") == 1
    never = "condition=IfCondition('false')"
    set_never = f"SetLaunchConfiguration('count', '2', {never})"
    system, missing = imported(
        tmp_path, f"{COUNT}{set_never}, OpaqueFunction(function=count, {never})", COUNTED
    )
    assert "lidar_0" not in system
    assert "certain values alone, and not for those there are" in missing[-1]
    system, _ = imported(tmp_path, f"{COUNT}{set_never}, OpaqueFunction(function=count)", COUNTED)
    assert "lidar_0" in system
    assert "lidar_1" not in system


def test_what_a_system_cannot_say_is_listed_with_its_line(tmp_path: Path) -> None:
    """Nothing is dropped silently; the rest is there."""
    before = """
        class Own(Substitution):
            def perform(self, context):
                return 'x'

        class Quiet(Action):
            def execute(self, context):
                raise AssertionError('it is not executed')

        def fails(context):
            raise KeyError('no robot')
    """.replace("Action", "__import__('launch').Action")
    actions = """
        RegisterEventHandler(None),
        LogInfo(msg='hello'),
        Quiet(),
        node(namespace=Own()),
        node(condition=IfCondition(Own())),
        OpaqueFunction(function=fails),
        node(env={'PATH': ''}, on_exit=[LogInfo(msg='x')]),
    """
    system, missing = imported(tmp_path, actions, before)
    lines = (tmp_path / "robot.launch.py").read_text().splitlines()
    places = {why: lines[int(line) - 1].strip() for line, _, why in
              (each.partition(": ") for each in missing)}  # fmt: skip
    expected = {
        "'RegisterEventHandler' is left out: a system cannot say it": "RegisterEventHandler(",
        "'LogInfo' is left out: a system cannot say it": "LogInfo(",
        "'Quiet' is left out: a system cannot say it": "Quiet(",
        "'OpaqueFunction' is left out: it fails with the values": "OpaqueFunction(",
        "'node' is left out: it needs $(Own …), which a model": "return Node(",
        "the condition of 'node' is left out, so that it always": "return Node(",
        "'env' is left out: it has no 'name'": "return Node(",
        "'node' is left out: it has on_exit=\"other actions\"": "return Node(",
    }
    assert len(missing) == len(expected)
    for said, place in expected.items():
        (found,) = (each for each in places if each.startswith(said))
        assert places[found].startswith(place)
    assert system.count("node lidar") == 1


def test_files_that_are_made_on_the_way_give_their_parameters(tmp_path: Path) -> None:
    """As in Nav2: those for the node, below any of the names that it may have there."""
    before = """
        class Rewritten(Substitution):
            def perform(self, context):
                path = os.path.join(os.environ['MADE_IN'], 'made.yaml')
                with open(path, 'w') as file:
                    file.write(TEXT)
                return path

        TEXT = '\\n'.join((
            '/**: {ros__parameters: {everywhere: 1, rate: 1.0}}',
            'other: {ros__parameters: {not_for_it: 1}}',
            '/front/lidar: {ros__parameters: {rate: 2.0, deep: {er: [a, b]}}}',
            'lidar: {ros__parameters: {not_in_a_namespace: 1}}'))
    """
    made = "node(parameters=[ParameterFile(Rewritten())])"
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("MADE_IN", str(tmp_path))
        system, missing = imported(
            tmp_path, f"GroupAction([PushRosNamespace('front'), {made}])", before
        )
    for line in ("everywhere = 1", "rate = 2.0", 'deep.er = ["a", "b"]'):
        assert f"param {line}\n" in system
    assert "not_" not in system
    (said,) = missing
    assert said.endswith("the file of 'Rewritten' has the parameters that it was made with; "
                         "see NAME:=VALUE")  # fmt: skip


def test_file_that_fails_is_refused_where_it_does(tmp_path: Path) -> None:
    """In one line, without a traceback."""
    with pytest.raises(UnreadableError) as raised:
        imported(tmp_path, "node(name=os.environ['NO_SUCH_ROBOT'])")
    path = tmp_path / "robot.launch.py"
    line = len(path.read_text().splitlines())
    assert str(raised.value) == (f"{path}:{line}: the launch file fails: KeyError: 'NO_SUCH_ROBOT'")


def test_file_that_python_cannot_read_is_refused_at_the_place(tmp_path: Path) -> None:
    """As any failure is."""
    path = tmp_path / "robot.launch.py"
    path.write_text("import os\n\nx = (\n")
    with pytest.raises(UnreadableError, match=rf"^{path}:3: the launch file fails: SyntaxError"):
        read_python(Request((path,), None, tmp_path, lambda _: True))


def test_value_that_no_argument_takes_is_listed(tmp_path: Path) -> None:
    """It may be a slip."""
    _, missing = imported(tmp_path, ROBOT, values={"robt": "r2"})
    assert missing == [" the value of 'robt' is of no use: no argument has that name"]
