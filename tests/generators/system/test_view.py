"""The view of a system for its targets."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros import codes
from deros.generators.api.protocol import GenerationError
from deros.generators.system.descriptions import collapse_whitespace
from deros.generators.system.literals import python_literal
from deros.generators.system.view import SystemView, snake_case, system_view
from deros.generators.text.python import LINE_LENGTH
from deros.models.arguments import arguments_in
from tests.support.systems import EVERYTHING, load, load_text

NODE = """
    node worker : tools
      executable "old_worker"
    parameters
      name gain : double = 1.0
      name gains : double[] = [1.0]
      name count : int = 1
      name blob : byte[] = [1, 2]
      name list : string[] = []
    subscribes
      topic in : std_msgs.Bool
"""


def view(folder: Path, members: str) -> SystemView:
    """Return the view of a system that may use ``worker``."""
    return system_view(
        load_text(folder, f'system Test imports import "*.rnd" {members}', worker=NODE)
    )


def refused(folder: Path, members: str) -> list[str]:
    """Return the codes with which a system is rejected."""
    with pytest.raises(GenerationError) as caught:
        view(folder, members)
    return [diagnostic.code.name for diagnostic in caught.value.diagnostics]


def test_program_is_package_and_executable(tmp_path: Path) -> None:
    """The executable of a legacy node counts, not the name of its type."""
    (node,) = view(tmp_path, "node a : worker").nodes
    assert (node.package, node.executable, node.full_name) == ("tools", "old_worker", "/a")


def test_whole_numbers_for_doubles_become_doubles(tmp_path: Path) -> None:
    """ROS 2 rejects the integer 3 for a double; integers are unchanged."""
    (node,) = view(
        tmp_path,
        "node a : worker parameters param gain = 3 param gains = [1, 2.5] param count = 3",
    ).nodes
    assert repr(node.parameters) == "(('gain', 3.0), ('gains', (1.0, 2.5)), ('count', 3))"


def test_only_different_names_are_remapped(tmp_path: Path) -> None:
    """A port connected to its own name needs no remapping."""
    (node,) = view(tmp_path, "node a : worker namespace /x wirings connect in to /x/in").nodes
    assert node.remappings == ()


def test_actions_are_remapped_with_all_their_parts() -> None:
    """In Jazzy, rcl remaps only the parts of an action, later versions its name."""
    eye = next(system_view(load(EVERYTHING)).nodes)
    assert [pair for pair in eye.remappings if str(pair[0]).startswith("look")] == [
        ("look", "/look_around"),
        ("look/_action/send_goal", "/look_around/_action/send_goal"),
        ("look/_action/cancel_goal", "/look_around/_action/cancel_goal"),
        ("look/_action/get_result", "/look_around/_action/get_result"),
        ("look/_action/feedback", "/look_around/_action/feedback"),
        ("look/_action/status", "/look_around/_action/status"),
    ]


def test_nodes_are_grouped_by_subsystem_with_description() -> None:
    """The description of an imported system is used if its subsystem has none."""
    groups = system_view(load(EVERYTHING)).groups
    assert [(group.path, group.description, len(group.nodes)) for group in groups] == [
        (("front",), "What looks ahead", 1),
        (("front", "deeper"), "", 1),
        (("left",), "A whole arm, used twice", 1),
        (("right",), "A whole arm, used twice", 1),
        ((), "", 1),
    ]


def test_respawn_delay_is_in_seconds() -> None:
    """1500 ms is 1.5 s; without respawn there is no delay."""
    eye, relay, *_, alone = system_view(load(EVERYTHING)).nodes
    assert (eye.respawn_delay, eye.respawn_max) == (1.5, 3)
    assert (relay.respawn_delay, relay.respawn_max) == (0.0, None)
    assert (alone.respawn_delay, alone.respawn_max) == (None, None)


@pytest.mark.parametrize("setting", ["gains = []", "blob = [3]"])
def test_unsupported_parameter_values_are_rejected(tmp_path: Path, setting: str) -> None:
    """There are no empty arrays and bytes in rcl, and they must not be dropped silently."""
    members = f"node a : worker parameters param {setting}"
    assert refused(tmp_path, members) == [codes.UNSUPPORTED_BY_TARGET.name]


@pytest.mark.parametrize("setting", ["list = []", "blob = [1, 2]"])
def test_unsupported_value_may_be_the_default(tmp_path: Path, setting: str) -> None:
    """The node has it anyway, so it is omitted."""
    (node,) = view(tmp_path, f"node a : worker parameters param {setting}").nodes
    assert node.parameters == ()


def test_two_nodes_of_one_full_name_are_rejected(tmp_path: Path) -> None:
    """Their parameters could not be distinguished."""
    assert refused(tmp_path, "node a : worker node a : worker") == [codes.NAME_COLLISION.name]


@pytest.mark.parametrize(
    ("name", "parted"),
    [
        ("RobotSafety", "robot_safety"),
        ("robot", "robot"),
        ("HTTPServer2Go", "http_server2_go"),
        ("a__B", "a_b"),
    ],
)
def test_file_names_are_snake_case(name: str, parted: str) -> None:
    """The words of a system's name are separated by single underscores."""
    assert snake_case(name) == parted


def test_descriptions_are_one_line() -> None:
    """No description can break out of a comment."""
    assert collapse_whitespace(" a\n  b\r\n\tc\u2028d ") == "a b c d"


@pytest.mark.parametrize(
    "value",
    [
        True,
        -3,
        1e300,
        "",
        "plain",
        'it\'s "both" \\ \n\x00☃',
        "word " * 60,
        "x" * 300,
        "'" * 150,
        ("a", "b" * 200, "c"),
        tuple(range(100)),
        {"key": "value " * 30, "k" * 120: (1.0, 2.0)},
    ],
)
@pytest.mark.parametrize("column", [0, 30, 60])
def test_literals_keep_the_value_and_fit_the_line(value: object, column: int) -> None:
    """A literal on several lines evaluates to the value, within the width."""
    text = python_literal(value, column, 12)  # type: ignore[arg-type]
    assert _as_lists(eval(text)) == _as_lists(value)
    first, *others = f"{text},".split("\n")
    assert column + len(first) <= LINE_LENGTH
    assert all(len(line) <= LINE_LENGTH for line in others)


@pytest.mark.parametrize("value", [float("inf"), float("-inf")])
def test_infinities_have_a_literal(value: float) -> None:
    """``inf`` alone is not defined in Python."""
    assert eval(python_literal(value)) == value


def _as_lists(value: object) -> object:
    if isinstance(value, (tuple, list)):
        return [_as_lists(item) for item in value]
    if isinstance(value, dict):
        return {key: _as_lists(item) for key, item in value.items()}
    return value


def test_node_that_many_arguments_decide_is_there(tmp_path: Path) -> None:
    """However many of them have to differ from their defaults for it."""
    names = [f"a{number}" for number in range(20)]
    declared = "".join(f"argument {name} : bool = false " for name in names)
    (group,) = view(tmp_path, f"{declared} node one : worker when {' and '.join(names)}").groups
    (node,) = group.nodes
    assert node.when is not None
    assert [each.name for each in arguments_in(node.when)] == names


def test_node_that_is_there_in_too_many_ways_is_refused(tmp_path: Path) -> None:
    """Each way would be a line of what is generated."""
    names = [f"a{number}" for number in range(15)]
    members = "".join(f"argument {name} : bool = false " for name in names)
    members += "node one : worker parameters "
    members += "".join(f"param count = {place} when {name} " for place, name in enumerate(names))
    with pytest.raises(GenerationError) as caught:
        view(tmp_path, members)
    (finding,) = caught.value.diagnostics
    assert finding.code is codes.UNSUPPORTED_BY_TARGET
    assert finding.span.text == "one"
