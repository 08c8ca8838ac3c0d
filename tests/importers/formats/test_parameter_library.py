"""Parameters of generate_parameter_library as node descriptions."""

from __future__ import annotations

import math
import tempfile
from pathlib import Path

import pytest
from hypothesis import event, given, settings
from hypothesis import strategies as st

from deros.importers.formats.parameter_library import is_library
from deros.importers.readers import UnreadableError
from deros.models.common import Interval, Value
from deros.models.node import Parameter, ParameterType
from tests.support.foreign import Become, become, damaged, survived

WORD = "parameter-library"

LIBRARY = """\
arm_controller:
  joints:
    type: string_array
    default_value: ["lift", "turn"]
    read_only: true
    description: "Names of
      the joints"
    validation:
      unique<>: null
      not_empty<>: []
      size_lt<>: [5]
      subset_of<>: [["lift", "turn", "grip"]]
  mode: {type: string, default_value: fast, validation: {one_of<>: [[fast, slow]], size_gt<>: [2]}}
  code: {type: string_fixed_8}
  weights:
    type: double_array_fixed_3
    default_value: [1, 0.5]
    validation:
      element_bounds<>: [0, 1]
      "checks::sums_to_one": null
  pid:
    rate: {type: double, default_value: 0.01, validation: {gt<>: [0.0], lt_eq<>: 1.0}}
    __map_joints:
      p: {type: double, default_value: .nan}
      steps: {type: int_array, validation: {fixed_size<>: 3, lower_element_bounds<>: [-4]}}
  zones:
    names: {type: string_array, default_value: []}
    __map_names:
      on: {type: bool, default_value: true}
  force: {type: int, default_value: -3, validation: {bounds<>: [-5, 5], gt_eq: [-4], lt<>: [5]}}
"""


def library(folder: Path, text: str) -> Become:
    """Return what a file becomes."""
    path = folder / "parameters.yaml"
    path.write_text(text, encoding="utf-8")
    return become(path, word=WORD)


def declared(made: Become) -> dict[str, Parameter]:
    """Return the parameters of the node, without their places."""
    return {each.name: each for each in made.node.parameters}


def parameter(folder: Path, lines: str) -> tuple[Parameter | None, tuple[str, ...]]:
    """Return what a parameter ``x`` becomes, and what is missing of it."""
    made = library(folder, f"n:\n  x: {{{lines}}}\n")
    assert made.findings == []
    return declared(made).get("x"), made.missing


def test_a_library_becomes_a_node_that_checks_clean(tmp_path: Path) -> None:
    """Types, defaults, constraints, descriptions, structures and maps are those of the file."""
    made = library(tmp_path, LIBRARY)
    assert (made.findings, made.missing) == ([], ())
    assert made.paths == (tmp_path / "models/nodes/arm_controller.rnd",)
    found = declared(made)
    assert [
        (name, each.type.value, each.default)
        for name, each in found.items()
        if name != "pid.<joints>.p"
    ] == [
        ("joints", "string[]", ("lift", "turn")),
        ("mode", "string", "fast"),
        ("code", "string", None),
        ("weights", "double[]", (1.0, 0.5)),
        ("pid.rate", "double", 0.01),
        ("pid.<joints>.steps", "integer[]", None),
        ("zones.names", "string[]", ()),
        ("zones.<zones.names>.on", "bool", True),
        ("force", "integer", -3),
    ]
    default = found["pid.<joints>.p"].default
    assert isinstance(default, float)
    assert math.isnan(default)
    joints = found["joints"]
    assert (joints.unique, joints.not_empty, joints.max_size) == (True, True, 4)
    assert joints.choices == ("lift", "turn", "grip")
    assert (joints.read_only, joints.description) == (True, "Names of the joints")
    assert found["mode"].choices == ("fast", "slow")
    assert (found["mode"].min_size, found["code"].max_size) == (3, 8)
    assert found["weights"].interval == Interval(0, 1)
    assert found["weights"].max_size == 3
    assert [each.text for each in found["weights"].custom] == ["checks::sums_to_one"]
    assert found["pid.rate"].interval == Interval(0, 1, lower_closed=False)
    assert found["pid.<joints>.steps"].size == 3
    assert found["pid.<joints>.steps"].interval == Interval(-4, math.inf)
    assert found["force"].interval == Interval(-4, 5, upper_closed=False)


def test_what_is_yours_says_that_program_and_ports_are_unknown(tmp_path: Path) -> None:
    """The file has none; the upper part of the description is the place for them."""
    made = library(tmp_path, "n:\n  x: {type: int}\n")
    text = made.paths[0].read_text(encoding="utf-8")
    assert text.startswith("// This is from a file of parameters: write the right package,")
    assert (made.node.package, made.node.executable) == ("unknown_package", "n")


@pytest.mark.parametrize(
    ("lines", "default", "said"),
    [
        ("type: int, default_value: 1.5", None, "has no default here: default of 'x' (integer)"),
        ("type: int, default_value: 9223372036854775808", None, "has no default here"),
        (f"type: double, default_value: {'9' * 400}", None, "is an integer of more than 64 bits"),
        (f"type: double_array, default_value: [{'9' * 400}]", None, "of more than 64 bits"),
        ("type: int, default_value: {a: 1}", None, "has no default here: it has keys"),
        ("type: int_array, default_value: [1, [2]]", None, "is a list with more than values in it"),
        ("type: int_array, default_value: [1, ~]", None, "is a list with a missing value"),
        ("type: int, default_value: 7, validation: {lt<>: [5]}", None, "default of 'x': 7 is not"),
        ('type: string, default_value: "\\x07"', None, "has a default here that is not a text"),
        ("type: int, default_value: 1, unit: m", 1, "has 'unit', which says nothing"),
        ("type: int, default_value: 1, additional_constraints: even", 1, "in words: even"),
        ("type: int, default_value: 1, validation: [a]", 1, "has a 'validation' without functions"),
        (
            "type: int, default_value: 1, validation: {even<>: []}",
            1,
            "'even<>', which is not known",
        ),
        ("type: int, default_value: 1, validation: {'m::e': [2]}", 1, "which is given values"),
        ("type: int, default_value: 1, validation: {'a b::c': ~}", 1, "has no function here"),
        ("type: int, default_value: 1, validation: {lt<>: []}", 1, "takes 1 values, and has 0"),
        ("type: int, default_value: 1, validation: {lt<>: [a]}", 1, "which is not a number"),
        ("type: int, default_value: 1, validation: {lt<>: [.nan]}", 1, "which is not a number"),
        ("type: int, default_value: 1, validation: {lt<>: [~]}", 1, "which has a missing value"),
        ("type: int, default_value: 1, validation: {lt<>: {a: 1}}", 1, "has keys in place of"),
        ("type: int, default_value: 1, validation: {bounds<>: [3, 0]}", 1, "has no constraints"),
        ("type: int, default_value: 1, validation: {size_gt<>: [1]}", 1, "has no constraints"),
        ("type: string, validation: {size_lt<>: [0]}", None, "which allows no size"),
        ("type: string, validation: {fixed_size<>: [-1]}", None, "which is not a size"),
        ("type: string, validation: {one_of<>: [a]}", None, "which is not a list in a list"),
    ],
)
def test_what_does_not_fit_is_listed_and_the_rest_stays(
    lines: str, default: Value | None, said: str, tmp_path: Path
) -> None:
    """With file and line; the description says it in a comment, too."""
    found, missing = parameter(tmp_path, lines)
    assert found is not None
    assert found.default == default
    assert [each.startswith("parameters.yaml:2: parameter 'x' ") for each in missing] == [True]
    assert said in missing[0]
    text = (tmp_path / "models/nodes/n.rnd").read_text(encoding="utf-8")
    assert f"// {missing[0].removeprefix('parameters.yaml:2: ')}\n" in text


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ("type: none", "type 'none' is for documents only"),
        ("type: float", "no type 'float'"),
        ("type: [int]", "'x' is left out: it has no type"),
        ("default_value: 1", "'x' is left out: it has no type"),
    ],
)
def test_a_parameter_without_a_type_is_left_out(lines: str, said: str, tmp_path: Path) -> None:
    """There is nothing that a model could say of it."""
    found, missing = parameter(tmp_path, lines)
    assert found is None
    assert said in missing[0]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("n:\n  a b: {type: int}\n", ":2: parameter 'a b' is left out: ROS 2 rejects the name"),
        (f"n:\n  {'x' * 300}: {{type: int}}\n", "is left out: its name is too long"),
        ("n:\n  a<b>: {type: int}\n", ":2: 'a<b>' is left out: a name has no '<' or '>'"),
        ("n:\n  a.b: {type: int}\n  a:\n    b: {type: int}\n", ":4: parameter 'a.b' is left out"),
        ("n:\n  a: {type: int}\n  a: {type: bool}\n", ":2: a key comes again below"),
        ("n:\n  __map_x:\n    a: {type: int}\n", ":3: parameter '<x>.a' is left out"),
        (
            "n:\n  x: {type: string_array}\n  __map_x:\n    __map_x:\n      a: {type: int}\n",
            ":5: parameter '<x>.<x>.a' is left out: '<x>.<x>.a' has more than one '<…>'",
        ),
    ],
)
def test_a_name_that_a_model_cannot_have_is_left_out(text: str, said: str, tmp_path: Path) -> None:
    """In the words of the checks, or because the key does not count."""
    made = library(tmp_path, text)
    assert made.findings == []
    assert any(said in each for each in made.missing), made.missing


def test_one_fault_behind_an_alias_is_said_of_each_parameter(tmp_path: Path) -> None:
    """They share their place in the file, and each has its own default and name."""
    made = library(
        tmp_path, "n:\n  l: &l\n    x: {type: int, default_value: a}\n    y: {type: int}\n  r: *l\n"
    )
    assert made.findings == []
    assert list(declared(made)) == ["l.x", "l.y", "r.x", "r.y"]
    assert [each.split(" has ")[0] for each in made.missing] == [
        "parameters.yaml:3: parameter 'l.x'",
        "parameters.yaml:3: parameter 'r.x'",
    ]


def test_several_files_become_nodes_of_different_names(tmp_path: Path) -> None:
    """Names that differ in case alone would be one file on some machines."""
    paths = []
    for number, root in enumerate(("arm", "Arm", "my arm::left", "1")):
        paths.append(tmp_path / f"{number}.yaml")
        paths[-1].write_text(f'"{root}":\n  x: {{type: int}}\n', encoding="utf-8")
    made = become(*paths)
    assert [path.name for path in made.paths] == [
        "arm.rnd",
        "Arm_2.rnd",
        "my_arm_left.rnd",
        "_1.rnd",
    ]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "has no keys at its top"),
        ("[1]", "has no keys at its top"),
        ("a: [", "parameters.yaml:1: this is not YAML"),
        ("a: {x: {type: int}}\nb: {}\n", "has 2 keys at its top"),
        ("\n\na: 1\n", "parameters.yaml:3: 'a' has no parameters"),
        ("a: \udcff", "is not UTF-8 text"),
    ],
)
def test_what_is_no_library_cannot_be_read(text: str, said: str, tmp_path: Path) -> None:
    """The error names the file, and the line where there is one."""
    path = tmp_path / "parameters.yaml"
    path.write_bytes(text.encode(errors="surrogateescape"))
    assert not is_library(path) or "b:" in text
    with pytest.raises(UnreadableError, match=said.replace("[", r"\[")):
        become(path, word=WORD)


@pytest.mark.parametrize(
    ("name", "text", "is_one"),
    [
        ("x.yaml", "a:\n  b:\n    c: {type: double_array_fixed_3}\n", True),
        ("x.yml", "a: {b: {type: none}}\n", True),
        ("x.json", '{"a": {"b": {"type": "int"}}}', False),
        ("x.yaml", "a: {b: {type: float}}\n", False),
        ("x.yaml", "a: {ros__parameters: {b: {type: int}}}\n", False),
        ("x.yaml", "a: {b: {type: int}}\nc: {}\n", False),
        ("x.yaml", "a: [", False),
    ],
)
def test_a_library_is_known_by_its_types(
    name: str, text: str, is_one: bool, tmp_path: Path
) -> None:
    """Names of files say nothing: other YAML, and values of parameters, are none."""
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    assert is_library(path) is is_one


def test_a_folder_is_no_library(tmp_path: Path) -> None:
    """It cannot be read, which is no reason to fail while kinds are told apart."""
    (tmp_path / "x.yaml").mkdir()
    assert not is_library(tmp_path / "x.yaml")
    assert not is_library(tmp_path / "none.yaml")


@settings(deadline=None, max_examples=60)
@given(data=damaged(LIBRARY))
def test_a_damaged_file_ends_in_a_clean_model_or_an_error(data: bytes) -> None:
    """Whatever stands in it: there is no traceback, and no model with findings."""
    event("models" if survived(data, "parameters.yaml", WORD) else "error")


@settings(deadline=None, max_examples=60)
@given(
    kind=st.sampled_from([each for each in ParameterType if each.value != "byte[]"]),
    data=st.data(),
)
def test_every_default_comes_back(kind: ParameterType, data: st.DataObject) -> None:
    """As YAML writes it, and as the description says it."""
    scalar: st.SearchStrategy[object] = {
        "bool": st.booleans(),
        "integer": st.integers(-(2**63), 2**63 - 1),
        "double": st.floats(allow_nan=False),
        "string": st.text(st.characters(codec="ascii", exclude_categories=["Cc"]), max_size=20),
    }[kind.value.removesuffix("[]")]
    value = data.draw(st.lists(scalar, max_size=4) if kind.is_array else scalar)
    import yaml

    word = kind.value.replace("integer", "int").replace("[]", "_array")
    text = yaml.safe_dump({"n": {"x": {"type": word, "default_value": value}}})
    with tempfile.TemporaryDirectory() as folder:
        made = library(Path(folder), text)
        assert (made.missing, made.findings) == ((), [])
        found = declared(made)["x"]
        assert found.default == (tuple(value) if isinstance(value, list) else value)
