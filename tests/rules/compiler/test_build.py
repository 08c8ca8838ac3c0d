"""Whole programs: the listings of the paper build, with the right spans and order."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.diagnostics import has_errors
from deros.interfaces.types import InterfaceType
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.rules.compiler.build import build
from deros.rules.program import ir
from deros.validators.check import check
from tests.support import paper
from tests.support.rules import build_rules, embedded_store, program


@pytest.mark.parametrize("listing", paper.RULES)
def test_listing_of_the_paper_has_no_errors(listing: str, tmp_path: Path) -> None:
    """Every DeRoS listing of the paper checks without errors against the system of figure 12."""
    paper.write_system(tmp_path)
    repository = Repository()
    loaded = repository.load_text(tmp_path / "safety.deros", paper.RULES[listing])
    findings = check([loaded], repository, embedded_store())
    assert not has_errors(findings), [each.message for each in findings]
    assert isinstance(loaded.model, Rules)
    assert build(loaded.model, embedded_store()).program is not None


def test_figure_2_builds_the_described_program(tmp_path: Path) -> None:
    """Rules, durations and bounds are those that the paper describes."""
    paper.write_system(tmp_path)
    loaded = Repository().load_text(tmp_path / "safety.deros", paper.FIGURE_2)
    assert isinstance(loaded.model, Rules)
    built = build(loaded.model, embedded_store()).program
    assert built is not None
    tilt, speed = built.rules
    limit = 0.17453292519943295
    roll = ir.Apply("roll", tuple(ir.Read(leaf) for leaf in range(4)), 0)
    pitch = ir.Apply("pitch", tuple(ir.Read(leaf) for leaf in range(4)), 0)
    ends = ir.Const(-limit), ir.Const(limit), True, True
    assert tilt.full_name == "imu_sensor_system.tilt_not_ok"
    assert tilt.condition == ir.Or(
        (ir.Not(ir.Within(roll, *ends)), ir.Not(ir.Within(pitch, *ends)))
    )
    above = ir.Compare(ir.Read(4), ">", ir.Const(0.5))
    assert speed.condition == ir.For(0, above, 2_000_000_000, speed.span)
    assert built.topics == {
        "/fmInformation/imu": InterfaceType("sensor_msgs", "msg", "Imu"),
        "/fmKnowledge/encoder_odom": InterfaceType("nav_msgs", "msg", "Odometry"),
    }
    assert [leaf.path for leaf in built.leaves] == [
        *(("orientation", name) for name in "xyzw"),
        ("twist", "twist", "linear", "x"),
    ]
    first, second = built.behaviours
    assert (first.name, first.condition) == ("behaviour_1", ir.RuleRef(0))
    assert second.condition == ir.For(1, ir.RuleRef(1), 400_000_000, second.span)
    assert built.actions[0].triggered_by == (0, 1)


def test_only_read_inputs_are_in_the_program() -> None:
    """An input that no rule reads is omitted; equal topic terms are one input."""
    built = program(
        """
        input unused = topic /flag.data
        input v = topic /speed.data timeout 1 sec
        entity e { a: topic /mode.data = 1 or v > 1; b: topic /mode.data = 2 or v > 2; }
        """
    )
    assert [(each.name, each.timeout_ns) for each in built.inputs] == [
        ("/mode.data", None),
        ("v", 1_000_000_000),
    ]
    assert [each.leaves for each in built.inputs] == [(0,), (1,)]


def test_inputs_with_different_timeouts_are_separate() -> None:
    """A topic term does not share the timeout of an input for the same field."""
    built = program(
        """
        input v = topic /speed.data timeout 1 sec
        entity e { r: v > 1 and topic /speed.data > 1; }
        """
    )
    assert [each.timeout_ns for each in built.inputs] == [1_000_000_000, None]


def test_missing_reads_the_field_of_its_input() -> None:
    """A NaN makes a sensor missing, so the field is read even if no rule compares it."""
    built = program(
        "input v = topic /speed.data timeout 1 sec entity e { r: v.missing(); }",
    )
    assert [(leaf.path, leaf.nan_is_unknown) for leaf in built.leaves] == [(("data",), True)]
    assert built.rules[0].condition == ir.Missing(0)


def test_missing_reads_the_numbers_of_a_part_only() -> None:
    """A NaN orientation is missing; a whole message may have unused numbers."""
    part = program(
        "input q = topic /imu.orientation timeout 1 sec entity e { r: q.missing(); }",
    )
    assert [leaf.path for leaf in part.leaves] == [("orientation", axis) for axis in "xyzw"]
    array = program(
        "input d = topic /scan.ranges timeout 1 sec entity e { r: d.missing(); }",
    )
    assert [(leaf.path, leaf.nan_is_unknown) for leaf in array.leaves] == [(("ranges",), True)]
    whole = program("input m = topic /imu timeout 1 sec entity e { r: m.missing(); }")
    assert whole.leaves == ()


def test_path_may_continue_an_input() -> None:
    """The fields are leaves of that one input."""
    built = program(
        """
        input imu = topic /imu timeout 1 sec
        entity e { r: imu.angular_velocity.z > 1 and imu.orientation_covariance[4] > 1; }
        """
    )
    assert [leaf.path for leaf in built.leaves] == [
        ("angular_velocity", "z"),
        ("orientation_covariance", 4),
    ]
    assert built.inputs[0].leaves == (0, 1)


def test_behaviours_are_numbered_outer_before_inner() -> None:
    """Index, default name and parent follow the source; a body keeps its order."""
    built = program(
        """
        action stop; action slow;
        entity e { r: topic /speed.data > 1; s: topic /flag.data; }
        if e.r then { slow; if e.s then { stop; }; log_state("slow"); };
        behaviour last: if not e.s then { stop; };
        """
    )
    outer, last = built.behaviours
    slow, inner, log = outer.body
    assert isinstance(inner, ir.Behaviour)
    assert [(each.index, each.name, each.parent) for each in (outer, inner, last)] == [
        (0, "behaviour_1", None),
        (1, "behaviour_2", 0),
        (2, "last", None),
    ]
    assert isinstance(slow, ir.Trigger)
    assert isinstance(log, ir.Trigger)
    assert (slow.action, log.action, log.arguments) == (1, 2, ("slow",))
    assert [action.name for action in built.actions] == ["stop", "slow", "log_state"]
    assert [action.triggered_by for action in built.actions] == [(1, 2), (0,), (0,)]


def test_intervals_are_numbered_in_evaluation_order() -> None:
    """The inner `for` comes before the outer one, that of a rule before those of behaviours."""
    built = program(
        """
        action stop;
        input v = topic /speed.data
        entity e { r: (v > 1 for 1 sec) and v < 9 for 2 sec; }
        if e.r for 3 sec then { stop; };
        """
    )
    outer = built.rules[0].condition
    assert isinstance(outer, ir.For)
    assert isinstance(outer.operand, ir.And)
    inner = outer.operand.operands[0]
    behaviour = built.behaviours[0].condition
    assert isinstance(inner, ir.For)
    assert isinstance(behaviour, ir.For)
    assert [each.index for each in (inner, outer, behaviour)] == [0, 1, 2]


def test_constants_may_refer_to_constants() -> None:
    """A constant may be another one, with a sign, in any order of declaration."""
    built = program(
        """
        const low = -high
        const high = other
        const other = 2 m/s
        entity e { r: topic /odom.twist.twist.linear.x in [low, high]; }
        """
    )
    within = built.rules[0].condition
    assert isinstance(within, ir.Within)
    assert (within.lower, within.upper) == (ir.Const(-2.0), ir.Const(2.0))


def test_rules_may_use_several_systems(tmp_path: Path) -> None:
    """The topics of all used systems are known."""
    for name, topic in (("A", "/a"), ("B", "/b")):
        text = f"system {name} topics external topic {topic} : std_msgs.Bool"
        (tmp_path / f"{name}.system").write_text(text)
    text = 'use "A.system" import A use "B.system" import B entity e { r: /a.data or /b.data; }'
    model = Repository().load_text(tmp_path / "x.deros", text).model
    assert isinstance(model, Rules)
    assert build(model, embedded_store()).program is not None


def test_rules_without_their_system_have_no_program() -> None:
    """A system that cannot be loaded is a finding of the loader, and has no further findings."""
    text = 'use "nowhere.system" import Nowhere entity e { r: topic /speed.data > 1; }'
    loaded = Repository().load_text("x.deros", text)
    assert isinstance(loaded.model, Rules)
    result = build(loaded.model, embedded_store())
    assert (result.program, result.diagnostics) == (None, ())
    assert [diagnostic.code.name for diagnostic in loaded.diagnostics] == ["DRS201"]


def test_every_fault_is_reported() -> None:
    """Faults of all parts are reported together, and none hides another."""
    result = build_rules(
        """
        action stop publishes 3 on /stop : std_msgs.Bool reset_by sto;
        input a = topic /sped.data
        input b = topic /imu.orientation timeout 1 metre
        entity e { r: a > 1 and b > 1; s: topic /speed.data > 3 m and topic /flag.data; }
        if e.t then { halt; };
        """
    )
    assert result.program is None
    codes = [diagnostic.code.name for diagnostic in result.diagnostics]
    assert codes == ["DRS301", "DRS306", "DRS329", "DRS312", "DRS310", "DRS310"]
