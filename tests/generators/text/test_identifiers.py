"""ROS 2 names become identifiers, and collisions are reported."""

from __future__ import annotations

import keyword

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deros.diagnostics import SourceFile, Span
from deros.generators.api.protocol import GenerationError
from deros.generators.text.identifiers import (
    Emitted,
    camel_case,
    check_collisions,
    file_label,
    python_identifier,
)

SPAN = Span(SourceFile("a.rnd", "first second"), 0, 5)
OTHER = Span(SPAN.source, 6, 12)


@pytest.mark.parametrize(
    ("name", "identifier"),
    [
        ("imu", "imu"),
        ("/fmInformation/imu", "fmInformation_imu"),
        ("~/status", "status"),
        ("pid.gain", "pid_gain"),
        ("lambda", "lambda_"),
        ("2d_scan", "_2d_scan"),
    ],
)
def test_identifiers_resemble_the_names(name: str, identifier: str) -> None:
    """Separators become underscores; keywords and digits are made valid."""
    assert python_identifier(name) == identifier


@given(st.text(max_size=20))
def test_every_name_gives_an_identifier(name: str) -> None:
    """The result is valid in Python for any name."""
    for result in (python_identifier(name), camel_case(name)):
        assert result.isidentifier()
        assert not keyword.iskeyword(result)


@pytest.mark.parametrize(
    ("name", "class_name"),
    [
        ("vectornav_vn100_node", "VectornavVn100Node"),
        ("fmSensors", "FmSensors"),
        ("none", "None_"),
        ("2d", "_2d"),
    ],
)
def test_class_names_are_camel_case(name: str, class_name: str) -> None:
    """Words start with a capital and keep those they have."""
    assert camel_case(name) == class_name


def test_collision_has_both_places() -> None:
    """The second of two equal names is reported, with the first as the related place."""
    emitted = [Emitted("on_imu", "port 'imu'", SPAN), Emitted("on_imu", "port '/imu'", OTHER)]
    with pytest.raises(GenerationError) as raised:
        check_collisions(emitted, "class A")
    (finding,) = raised.value.diagnostics
    assert finding.code.name == "DRS401"
    assert (finding.span, finding.related[0].span) == (OTHER, SPAN)
    assert "'on_imu'" in finding.message


def test_different_names_do_not_collide() -> None:
    """Names that differ only in case are different."""
    check_collisions([Emitted("a", "port a", SPAN), Emitted("A", "port A", OTHER)], "class A")


def test_files_that_differ_only_in_case_collide() -> None:
    """They are one file on some systems; identifiers in code are case-sensitive."""
    emitted = [Emitted("Ab", "node 'Ab'", SPAN), Emitted("ab", "node 'ab'", OTHER)]
    check_collisions(emitted, "the code")
    with pytest.raises(GenerationError) as raised:
        check_collisions(emitted, "the package", files=True)
    (diagnostic,) = raised.value.diagnostics
    assert "which differ only in case" in diagnostic.message


@pytest.mark.parametrize(
    ("path", "label"),
    [
        ("models/robot-2.0 (old).rnd", "robot-2.0 %28old%29.rnd"),
        ("männchen.rnd", "männchen.rnd"),
        ('a"""\nimport os\n"""b.rnd', "a%22%22%22%0Aimport os%0A%22%22%22b.rnd"),
        ("a*\\.rnd", "a%2A%5C.rnd"),
        ("a\u202eb\udcff.rnd", "a%E2%80%AEb%FF.rnd"),
    ],
)
def test_file_label_contains_no_code(path: str, label: str) -> None:
    """Quotes, line breaks, comment markers and invisible characters are escaped as numbers."""
    assert file_label(path) == label
