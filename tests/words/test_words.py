"""What the words of a file are, and that none is missed."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.metamodels.languages import language_of
from deros.models.rules import Rules
from deros.pipeline.workspace import load
from deros.words.index import index_of
from deros.words.sentences import sentence
from deros.words.words import Index, Word, WordKind

EXAMPLES = sorted(
    str(path) for path in Path("examples").rglob("*") if language_of(path) is not None
)

SYSTEM = """\
system Robot

arguments
  argument fast : bool = false

topics
  external topic /odom : nav_msgs.Odometry
  external topic /battery : sensor_msgs.BatteryState
"""


def index(path: str) -> Index:
    """Return the words of a file."""
    workspace = load([path])
    return index_of(workspace.files[0].model, workspace.builds, workspace.store)


def rules(folder: Path, text: str) -> Index:
    """Return the words of rules of a robot with odometry."""
    (folder / "robot.system").write_text(SYSTEM, encoding="utf-8")
    path = folder / "rules.deros"
    path.write_text(f'use "robot.system" import Robot\n{text}', encoding="utf-8")
    return index(str(path))


def said(words: Index, kind: WordKind) -> list[tuple[str, str]]:
    """Return text and full name of the words of one kind."""
    return [(each.span.text, each.name) for each in words if each.kind is kind]


@pytest.mark.parametrize("path", EXAMPLES)
def test_words_stand_where_they_say(path: str) -> None:
    """A word is a piece of its own file, in one line, and what it declares has its name."""
    words = index(path)
    assert len(words) > 0
    for each in words:
        assert each.span.source.path == path
        assert "\n" not in each.span.text
        found = words.at(each.span.start)
        assert found is not None
        assert found.span.start <= each.span.start < found.span.end
        if each.declared is not None and each.kind is not WordKind.FILE:
            assert last(each.declared.text) == last(each.name)


def last(name: str) -> str:
    """Return the last part of a name."""
    return name.rpartition(".")[2].removeprefix("/")


def test_one_name_is_told_by_its_place(tmp_path: Path) -> None:
    """An entity, its rule, an input and a field may have the same name."""
    words = rules(
        tmp_path,
        """\
        input twist = topic /odom.twist.twist.linear.x timeout 1 s;
        action stop;
        entity speed { twist: twist > 1 m/s; calm: not stop.active; }
        if speed.twist or speed.calm then { stop; }
        """,
    )
    line = next(each for each in words if each.kind is WordKind.RULE).span.line
    kinds = [each.kind for each in words if each.span.line == line]
    assert kinds == [
        WordKind.ENTITY,
        WordKind.RULE,
        WordKind.INPUT,
        WordKind.UNIT,
        WordKind.RULE,
        WordKind.ACTION,
    ]


def test_fields_have_type_and_unit_at_each_step(tmp_path: Path) -> None:
    """Also those of an input's message, and elements of arrays."""
    words = rules(
        tmp_path,
        """\
        input odom = topic /odom timeout 1 s;
        action stop;
        entity e { r: odom.twist.twist.linear.x > 1 m/s or odom.pose.covariance[3] > 2; }
        if e.r then { stop; }
        """,
    )
    fields = [
        (each.span.text, each.type, each.unit) for each in words if each.kind is WordKind.FIELD
    ]
    assert ("x", "float64", "m/s") in fields
    assert ("linear", "geometry_msgs/msg/Vector3", "m/s") in fields
    assert ("[3]", "float64", "") in fields


def test_constants_of_a_message_are_known(tmp_path: Path) -> None:
    """They are declared in no model."""
    words = rules(
        tmp_path,
        """\
        input state = topic /battery.power_supply_status timeout 1 s;
        action stop;
        entity e { r: state = POWER_SUPPLY_STATUS_FULL; }
        if e.r then { stop; }
        """,
    )
    (found,) = [each for each in words if each.kind is WordKind.MESSAGE_CONSTANT]
    assert found.name == "POWER_SUPPLY_STATUS_FULL"
    assert found.declared is None


def test_a_unit_of_ones_own_leads_to_its_definition(tmp_path: Path) -> None:
    """Others are declared nowhere."""
    words = rules(
        tmp_path,
        """\
        unit knot = 0.514444 m/s;
        input speed = topic /odom.twist.twist.linear.x timeout 1 s;
        action stop;
        entity e { r: speed > 2 knot; }
        if e.r then { stop; }
        """,
    )
    knots = [each for each in words if each.span.text == "knot"]
    assert [each.declares for each in knots] == [True, False]
    assert len({each.key for each in knots}) == 1
    assert all(each.declared is None for each in words if each.span.text == "s")


def test_zones_have_their_unit_and_their_uses(tmp_path: Path) -> None:
    """A zone and an input are told apart where a rule names them."""
    words = rules(
        tmp_path,
        "input place = topic /odom.pose.pose.position timeout 1 s;\n"
        'zone yard = circle (0, 0) 4 m "where it drives"\n'
        "entity e { r: place.inside(yard) or place.unknown(); }\n",
    )
    assert said(words, WordKind.ZONE) == [("yard", "yard"), ("yard", "yard")]
    declared, used = (each for each in words if each.kind is WordKind.ZONE)
    assert (declared.declares, used.declares, used.key) == (True, False, declared.key)
    assert used.description == "where it drives"
    assert ("m", "m") in said(words, WordKind.UNIT)
    assert said(words, WordKind.FUNCTION) == [("inside", "inside"), ("unknown", "unknown")]


def test_what_does_not_compile_has_the_words_that_do(tmp_path: Path) -> None:
    """An unknown name is no word, and those around it are."""
    words = rules(
        tmp_path,
        """\
        input speed = topic /odom.twist.twist.linear.z.w timeout 1 s;
        input other = topic /odom.twist.twist.linear.z timeout 1 s;
        action stop;
        entity e { r: sped > 1 m/s and other > 1 m/s; }
        if e.r then { stop; }
        """,
    )
    assert said(words, WordKind.INPUT) == [
        ("speed", "speed"),
        ("other", "other"),
        ("other", "other"),
    ]


def test_words_of_a_thing_have_one_key_in_all_files() -> None:
    """Wherever it is named, and however the path of its file is written."""
    system, node = "examples/intelligent_one/intelligent_one.system", "marking_robot.rnd"
    named = next(each for each in index(system) if each.kind is WordKind.NODE_TYPE)
    declared = next(
        each
        for each in index(f"examples/intelligent_one/{node}")
        if each.kind is WordKind.NODE_TYPE
    )
    assert named.key == declared.key


def test_no_word_is_where_none_is() -> None:
    """Between words, and behind the last one, there is none."""
    words = index("examples/intelligent_one/intelligent_one.deros")
    text = next(iter(words)).span.source.text
    assert words.at(len(text)) is None
    assert words.at(text.index("{")) is None or isinstance(words.at(text.index("{")), Word)


@pytest.mark.parametrize(
    ("condition", "said_so"),
    [
        ("speed >= 1 m/s", "`speed` is at least `1 m/s`"),
        ("speed in [0 m/s, 1 m/s)", "`speed` is between `0 m/s` and `1 m/s` (`1 m/s` excluded)"),
        ("not speed.missing()", "`speed.missing()` does not hold"),
        (
            "(speed > 1 m/s or speed < 0 m/s) for 2 s",
            "(`speed` is above `1 m/s` or `speed` is below `0 m/s`), without a break for `2 s`",
        ),
        ("speed > 1 m/s within 3 s", "`speed` is above `1 m/s`, now or less than `3 s` ago"),
        (
            "speed > 1 m/s 3 times within 9 s",
            "`speed` is above `1 m/s`: it has turned so 3 times in `9 s`",
        ),
        (
            "speed > 1 m/s since speed < 0 m/s",
            "`speed` is above `1 m/s`, without a break since `speed` is below `0 m/s`",
        ),
        ("place.inside(yard)", "`place` is in the zone `yard`"),
        ("not place.inside(yard)", "`place` is not in the zone `yard`"),
        (
            "(speed > 1 m/s) begins",
            "`speed` is above `1 m/s`, at the moment when it turns so",
        ),
    ],
)
def test_conditions_are_sentences(tmp_path: Path, condition: str, said_so: str) -> None:
    """Each operator has its words."""
    text = "input speed = topic /odom.twist.twist.linear.x timeout 1 s;\n"
    text += "input place = topic /odom.pose.pose.position timeout 1 s;\n"
    text += "zone yard = circle (0, 0) 1 m;\n"
    (tmp_path / "robot.system").write_text(SYSTEM, encoding="utf-8")
    path = tmp_path / "rules.deros"
    head = f'use "robot.system" import Robot\n{text}'
    path.write_text(f"{head}entity e {{ r: {condition}; }}\n", encoding="utf-8")
    model = load([str(path)]).files[0].model
    assert isinstance(model, Rules)
    assert sentence(model.entities[0].rules[0].condition) == said_so
