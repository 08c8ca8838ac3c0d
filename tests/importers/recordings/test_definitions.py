"""Definitions out of recordings, against those that ROS 2 itself has in both languages."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from deros.importers.recordings.definitions import definitions_in, differs, message_type
from deros.interfaces.definitions import parse_definition
from deros.interfaces.sources import read_definition
from deros.interfaces.types import InterfaceType
from tests.support.recorded import SEPARATOR

SHARE = Path(sys.prefix) / "share"
PAIRS = [path for path in sorted(SHARE.glob("*/msg/*.idl")) if path.with_suffix(".msg").is_file()]


@pytest.mark.skipif(not PAIRS, reason="ROS 2 is not in this environment")
def test_idl_says_what_the_msg_file_says_that_it_was_made_from() -> None:
    """Fields, bounds and constants of every message that is installed."""
    assert len(PAIRS) > 100
    for path in PAIRS:
        of = InterfaceType(path.parent.parent.name, "msg", path.stem)
        text = f"{SEPARATOR}\nIDL: {of}\n{path.read_text(encoding='utf-8')}"
        converted = definitions_in(of, "idl", text)[of]
        assert isinstance(converted, str), converted
        known = read_definition(path.with_suffix(".msg"), of)
        read = parse_definition(of, converted)
        assert isinstance(known, tuple)
        assert isinstance(read, tuple)
        assert not differs(of, converted, known[0]), of
        assert {each.name: each.value for each in read[0].constants} == {
            each.name: each.value for each in known[0].constants
        }


def test_several_files_of_idl_and_line_ends_of_windows_are_read() -> None:
    """As recorders on Windows write them."""
    of, part = InterfaceType("own_msgs", "msg", "A"), InterfaceType("own_msgs", "msg", "B")
    module = "module own_msgs {{ module msg {{ struct {} {{ {} x; }}; }}; }};\n"
    text = f"{SEPARATOR}\nIDL: {of}\n{module.format('A', 'own_msgs::msg::B')}"
    text += f"{SEPARATOR}\nIDL: {part}\n{module.format('B', 'double')}"
    expected = {of: "own_msgs/B x\n", part: "float64 x\n"}
    assert definitions_in(of, "idl", text) == expected
    assert definitions_in(of, "idl", text.replace("\n", "\r\n")) == expected


@pytest.mark.parametrize(
    "text", ["a/msg", "../msg/X", "own_msgs/msg/../X", "own_msgs/srv/X", "own_msgs/msg/x", "Own/X"]
)
def test_only_names_of_messages_are_types(text: str) -> None:
    """What is taken for one becomes the name of a file."""
    assert message_type(text) is None
    assert message_type("own_msgs/msg/" + "X" * 200) is None
    assert message_type("own_msgs/X") == message_type("own_msgs/msg/X")
