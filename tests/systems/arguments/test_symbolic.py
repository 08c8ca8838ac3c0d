"""A system in terms of its arguments: what is there under which condition, and under which name."""

from __future__ import annotations

from pathlib import Path

from deros.models.arguments import Argument, Compared, Holds, Not
from deros.systems.arguments.symbolic import SymbolicSystem, as_written, joined
from tests.support.systems import load_text

TALKER = "node talker : p publishes topic out : std_msgs.Bool"
SYSTEM = """
    system S
    argument mode : string = "auto" argument on : bool = true argument to : string = "words"
    imports import "talker.rnd"
    topics external topic /always external topic "/${to}" when mode = "hand"
    subsystem inner namespace /inner when not on {
      node talker : talker wirings connect out to $to
    }
"""


def test_declared_topics_have_conditions_and_names(tmp_path: Path) -> None:
    """A topic without a condition is always there; of another, it is given back as written."""
    symbolic = SymbolicSystem(load_text(tmp_path, SYSTEM, talker=TALKER))
    always, other = symbolic.topics
    assert (always.topic.name, always.when) == ("/always", None)
    assert isinstance(other.when, Compared)
    slash, to = symbolic.pieces(other.topic.name)
    assert slash == "/"
    assert isinstance(to, Argument)
    assert to.name == "to"


def test_condition_of_a_group_is_that_of_its_nodes(tmp_path: Path) -> None:
    """A node is there where all around it is."""
    (node,) = SymbolicSystem(load_text(tmp_path, SYSTEM, talker=TALKER)).nodes
    assert isinstance(node.when, Not)
    assert isinstance(node.when.operand, Holds)


def test_name_that_may_be_absolute_is_known_in_two_ways(tmp_path: Path) -> None:
    """As written, for what resolves it itself; and joined with what it would be relative to."""
    symbolic = SymbolicSystem(load_text(tmp_path, SYSTEM, talker=TALKER))
    (node,) = (each.node for each in symbolic.nodes)
    topic = node.ports[0].topic  # type: ignore[union-attr]
    assert [str(each) for each in symbolic.pieces(joined(topic))][:1] == ["/inner/"]
    (piece,) = symbolic.pieces(as_written(topic))
    assert isinstance(piece, Argument)
