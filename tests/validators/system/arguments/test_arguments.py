"""Arguments of systems: their declarations, what they are passed to, and every combination."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros import codes
from deros.diagnostics import Diagnostic
from deros.metamodels.load import Repository
from deros.models.system import System
from deros.validators.system.arguments.declared import check_arguments
from tests.support.checks import checked

CAMERA = """\
node camera : cameras
parameters
  name rate : double = 5.0 [Hz] in [1, 30]
  name side : string = "left" one_of ["left", "right"]
  name step : int = 1 one_of [1, 2]
  name gains : double[] = [0.5] in [0, 1]
  name free : double = 5.0
  name count : integer = 1
  name label : string = "a"
publishes
  topic image : sensor_msgs.Image
"""
VIEWER = "node viewer : views subscribes topic image : sensor_msgs.Image\n"
ARM = """\
system Arm
imports import "camera.rnd"
argument rate : double = 5.0 in [1, 30] [Hz]
argument side : string = "left" one_of ["left", "right"]
argument parts : int = 1
topics external topic image
node camera : camera
parameters
  param rate = $rate
  param free = 4 / $parts
  param label = $side
wirings connect image to image
"""
FIST = """\
system Fist
imports import "arm.system"
argument rate : double = 5.0
argument deep : int = 1
subsystem arm : Arm(rate = $rate + 0, parts = $deep)
"""
WIRED = "topics external topic /i node c : camera wirings connect image to /i "


def _check(folder: Path, body: str) -> list[Diagnostic]:
    (folder / "camera.rnd").write_text(CAMERA)
    (folder / "viewer.rnd").write_text(VIEWER)
    (folder / "arm.system").write_text(ARM)
    (folder / "fist.system").write_text(FIST)
    names = (each for each in ("camera", "viewer", "Arm", "Fist") if f": {each}" in body)
    files = [f"{each.lower()}.{'system' if each[0].isupper() else 'rnd'}" for each in names]
    imports = "".join(f' import "{each}"' for each in files)
    path = folder / "robot.system"
    path.write_text(f"system Robot imports{imports} {body}" if imports else f"system Robot {body}")
    return checked(path)


def _shown(findings: list[Diagnostic]) -> list[tuple[str, str, str]]:
    return [(each.code.name, each.span.text, each.message) for each in findings]


# Declarations and uses ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("declared", "code", "place", "message"),
    [
        ("argument a : double = 3 in [0, 2]", "DRS252", "3", "3.0 is outside [0.0, 2.0]"),
        ('argument a : string = "x" one_of ["y"]', "DRS252", '"x"', 'is not one of "y"'),
        ('argument a : integer = "x"', "DRS252", '"x"', "is not of type integer"),
        ("argument a : integer = 2.5", "DRS252", "2.5", "is not of type integer"),
        ("argument a : double = 3 in [5, 1]", "DRS110", "[5, 1]", "from 5.0 down to 1.0"),
        ("argument a : double[] = [1.0]", "DRS252", "argument", "an argument has one value"),
        ("argument a : double = 1 read_only", "DRS252", "argument", "an argument is given once"),
        ('argument a : double = 1 custom "a::b"', "DRS252", "argument", "cannot call the function"),
        ("argument a : int = 1 argument a : int = 2", "DRS255", "a", "declared twice"),
        ("argument aé : double = 1", "DRS223", "aé", "cannot be the name of an argument"),
        ("argument b : int = 1", "DRS251", "$a", "no argument 'a'"),
        ("argument b : int = 1", "DRS254", "b", "argument 'b' is not used"),
    ],
)
def test_declarations(tmp_path: Path, declared: str, code: str, place: str, message: str) -> None:
    """What does not fit is reported where it is declared, an unknown one where it is used."""
    findings = _check(tmp_path, f"{declared} {WIRED} parameters param free = $a")
    assert any(
        each.code.name == code and each.span.text.startswith(place) and message in each.message
        for each in findings
    ), _shown(findings)


@pytest.mark.parametrize(
    "use",
    [
        'topics external topic "/${a}"',
        'topics external topic /x when a = "q"',
        "subsystem s namespace $a { }",
        'subsystem s when a != "q" { }',
        "topics external topic /i node c : camera namespace $a wirings connect image to /i",
        'topics external topic /a node c : camera wirings connect image to "/${a}"',
        'topics external topic /i node c : camera when a = "q" wirings connect image to /i',
        "topics external topic /i node c : camera parameters param label = $a "
        "wirings connect image to /i",
        'subsystem s { subsystem t : Arm(side = "left", parts = 2) when a in ["q"] }',
        "topics external topic /i node c : camera wirings connect image to /i "
        'parameters param free = 3 when a = "q"',
    ],
)
def test_every_use_counts(tmp_path: Path, use: str) -> None:
    """An argument that is used anywhere is not reported as unused."""
    findings = _check(tmp_path, f'argument a : string = "a" {use}')
    assert "DRS254" not in {each.code.name for each in findings}, _shown(findings)
    assert "DRS251" not in {each.code.name for each in findings}, _shown(findings)


def test_fault_of_an_argument_hides_what_would_follow_from_it(tmp_path: Path) -> None:
    """A misspelt argument is one finding, whatever depends on it."""
    wired = WIRED.replace("wirings", "when slm or slam wirings")
    body = f"argument slam : bool = true {wired}"
    assert [each.code.name for each in _check(tmp_path, body)] == ["DRS251"]


# Passed values -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("body", "code", "place", "message"),
    [
        ("subsystem l : Arm(rate = 50)", "DRS252", "50", "50.0 is outside [1.0, 30.0]"),
        ('subsystem l : Arm(side = "up")', "DRS252", '"up"', 'is not one of "left", "right"'),
        ("subsystem l : Arm(side = 3)", "DRS252", "3", "3 is not of type string"),
        ('subsystem l : Arm(parts = "x")', "DRS252", '"x"', '"x" is not of type integer'),
        ("subsystem l : Arm(sid = 3)", "DRS251", "sid", "has no argument 'sid'"),
        ("subsystem l : Arm(rate = 3, rate = 4)", "DRS255", "rate", "is given twice"),
        (
            "argument v : double = 5 in [0, 30] subsystem l : Arm(rate = $v)",
            "DRS252",
            "$v",
            "argument 'v' may be in [0.0, 30.0], argument 'rate' of 'Arm' in [1.0, 30.0]",
        ),
        (
            "argument v : double = 5 in [1, 30] [m] subsystem l : Arm(rate = $v)",
            "DRS306",
            "$v",
            "argument 'v' is in m, argument 'rate' of 'Arm' in Hz",
        ),
        (
            "argument n : int = 1 one_of [0, 1] subsystem l : Arm(rate = 5 * $n)",
            "DRS252",
            "5 * $n",
            "0.0 is outside [1.0, 30.0], where n = 0",
        ),
        ("subsystem l : Fist(rate = 50)", "DRS252", "$rate + 0", "argument 'rate' of 'Arm': 50.0"),
        ("subsystem l : Fist(deep = 0)", "DRS252", "$parts", "this divides by zero"),
        (
            "argument n : int = 1 one_of [0, 1] subsystem l : Fist(deep = $n)",
            "DRS252",
            "$parts",
            "this divides by zero, where n = 0",
        ),
    ],
)
def test_passed_values(tmp_path: Path, body: str, code: str, place: str, message: str) -> None:
    """A value has to fit the argument that it is passed to, however many systems lie between."""
    findings = [each for each in _check(tmp_path, body) if each.is_error]
    ((found, span, said),) = _shown(findings)
    assert (found, span) == (code, place)
    assert message in said


def test_place_that_passes_the_value_is_named(tmp_path: Path) -> None:
    """A fault in a used system names the subsystem whose values make it one."""
    (finding,) = [
        each for each in _check(tmp_path, "subsystem l : Fist(deep = 0)") if each.is_error
    ]
    assert finding.span.file.endswith("arm.system")
    places = {(Path(each.span.file).name, each.span.text) for each in finding.related}
    assert places == {("robot.system", "Fist"), ("fist.system", "Arm")}


@pytest.mark.parametrize(
    "body",
    [
        "argument v : double = 5 in [1, 30] [Hz] subsystem l : Arm(rate = $v)",
        "argument v : double = 5 subsystem l : Arm(rate = if v in [4, 5] then $v else 5)",
        "argument v : double = 5 in [0, 60] subsystem l : Arm(rate = $v) when v >= 1 and v <= 30",
        "argument v : double = 5 in [0, 60] subsystem l : Arm(rate = $v / 2 + 1)",
        'argument v : double = 5 in [0, 60] argument m : string = "a" one_of ["a", "b"] '
        'subsystem s when m = "a" { subsystem l : Arm(rate = $v) when v in [5, 10] }',
        "argument n : int = 1 one_of [0, 1] subsystem l : Arm(rate = 5 / $n) when n != 0",
        "argument n : int = 1 one_of [0, 1] "
        "subsystem s when n > 0 { subsystem l : Arm(parts = $n) }",
    ],
)
def test_passed_values_that_fit(tmp_path: Path, body: str) -> None:
    """Conditions of the subsystem, and of what holds it, see to it that a value fits."""
    assert _shown(_check(tmp_path, body)) == []


# Parameters --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("declared", "setting", "codes"),
    [
        ("double = 5 in [1, 30] [Hz]", "param rate = $a", []),
        ("double = 5", "param rate = $a", ["DRS221"]),
        ("double = 5", "param rate = $a when a >= 1 and a <= 30", []),
        ("double = 5", "param rate = $a when a >= 1", ["DRS221"]),
        ("double = 5", "param rate = if a in [4, 5] then $a else 5", []),
        ("double = 5", "param rate = if a < 1 or a > 30 then 5 else $a", []),
        ("double = 5", "param rate = if a < 2 then 5 else $a", ["DRS221"]),
        ("double = 5", "param rate = $a / 5 + 4", []),
        ("double = 5 in [1, 90] one_of [5, 7]", "param rate = $a", []),
        ("int = 5 in [1, 30]", "param count = $a", []),
        ('string = "x"', "param side = $a", ["DRS221"]),
        ('string = "left"', "param side = $a", ["DRS221"]),
        ('string = "left"', 'param side = $a when a != "x"', ["DRS221"]),
        ('string = "left"', 'param side = $a when a in ["left", "right"]', []),
        ('string = "left" one_of ["left"]', "param side = $a", []),
        ('string = "left" one_of ["left", "up"]', "param side = $a", ["DRS221"]),
        ("int = 1", "param step = $a", ["DRS221"]),
        ("int = 1 in [1, 3]", "param step = $a", ["DRS221"]),
        ("int = 1 in [1, 2]", "param step = $a", []),
        ("int = 1", "param gains = [$a, 0.5]", ["DRS221"]),
        ("int = 1", "param gains = [0.5, $a when a = 1]", []),
        ("int = 1 in [0, 1]", "param gains = [0.5, $a]", []),
        ("double = 5 in [1, 31]", "param rate = $a", ["DRS221"]),
        ("double = 5 in [1, 30]", "param rate = $a", []),
        ("double = 5 in (0.5, 30]", "param rate = $a", ["DRS221"]),
        ("double = 5 > 1", "param rate = $a", ["DRS221"]),
        ("double = 5 in [1, 31]", "param rate = $a when a <= 30", []),
        ("double = 5 in [0, 31]", "param rate = $a when a <= 30", ["DRS221"]),
        ("double = 5 in [0, 31]", "param rate = $a when not (a > 30 or a < 1)", []),
        ("double = 5 in [1, 30] [m]", "param rate = $a", ["DRS306"]),
        ("double = 5 [m]", "param rate = $a * 2", []),
        ("double = 50", "param rate = $a", ["DRS221"]),
        ("int = 5", "param rate = $a", ["DRS221"]),
        ("int = 5", "param count = $a / 5", ["DRS207"]),
        ("int = 5", "param count = $a * 2", []),
        ("double = 5", "param count = $a", ["DRS207"]),
        ('string = "x"', "param rate = $a", ["DRS207"]),
        ("int = 5 one_of [5, 50]", "param rate = $a", ["DRS221"]),
        ("int = 5 one_of [5, 50]", "param rate = $a * 3 when a < 9", []),
    ],
)
def test_parameters(tmp_path: Path, declared: str, setting: str, codes: list[str]) -> None:
    """All values that an argument may have must fit the parameter, where the condition holds."""
    body = f"argument a : {declared} {WIRED} parameters {setting}"
    findings = _check(tmp_path, body)
    assert [each.code.name for each in findings] == codes, _shown(findings)


# Conditions --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("declared", "condition", "said"),
    [
        ("argument n : int = 1 in [0, 5]", "n < 6", "whatever the arguments are"),
        ("argument n : int = 1 in [0, 5]", "n > 5", "for no value of the arguments"),
        ("argument n : int = 1 in [0, 5]", "n >= 5", ""),
        ("argument n : int = 1", "n > 2 and n < 3", "for no value of the arguments"),
        ("argument n : double = 1", "n > 2 and n < 3", ""),
        ('argument n : string = "a" one_of ["a", "b"]', 'n = "c"', "for no value"),
        ('argument n : string = "a"', 'n = "c"', ""),
        ('argument n : string = "a"', 'n = "a"', ""),
        ("argument n : int = 1 argument m : int = 2", "n < m", ""),
        ("argument n : int = 1 in [0, 1] argument m : int = 2 in [2, 3]", "n < m", "whatever"),
        ("argument n : bool = true argument m : bool = true", "n = m", ""),
        ("argument n : bool = true", "n or not n", "whatever"),
        ("argument n : bool = true", "n and true", ""),
    ],
)
def test_idle_conditions(tmp_path: Path, declared: str, condition: str, said: str) -> None:
    """A condition that holds for all allowed values, or for none of them, is a warning."""
    findings = _check(tmp_path, f"{declared} {WIRED} subsystem s when {condition} {{ }}")
    assert [each.code.name for each in findings] == (["DRS256"] if said else []), _shown(findings)
    assert all(said in each.message for each in findings)


# Every combination -------------------------------------------------------------------------------


def _where(folder: Path, body: str) -> dict[str, str]:
    """Return for each code what its finding says about the arguments."""
    findings = _check(folder, body)
    return {each.code.name: each.message.partition(", where ")[2] for each in findings}


ENDS = "topics topic /i node c : camera {c} wirings connect image to /i "
ENDS += "node v : viewer {v} wirings connect image to /i "


def test_finding_names_the_smallest_change_that_shows_it(tmp_path: Path) -> None:
    """Of the arguments that nothing depends on here, it says nothing."""
    declared = "argument slam : bool = true argument other : bool = false "
    body = declared + ENDS.format(c="when slam", v="when other or not other or slam")
    assert _where(tmp_path, body)["DRS210"] == "slam = false"
    both = declared + ENDS.format(c="when slam or other", v="")
    assert _where(tmp_path, both) == {"DRS210": "slam = false"}


def test_finding_that_is_there_by_default(tmp_path: Path) -> None:
    """It names the arguments that make it disappear."""
    body = "argument slam : bool = false " + ENDS.format(c="when slam", v="")
    assert _where(tmp_path, body) == {"DRS210": "slam = false"}


def test_finding_that_no_argument_changes(tmp_path: Path) -> None:
    """It is as without arguments."""
    body = "argument slam : bool = true topics topic /i external topic /j "
    body += "node v : viewer wirings connect image to /i "
    body += "node c : camera when slam wirings connect image to /j"
    assert _where(tmp_path, body) == {"DRS210": ""}


def test_faults_of_a_whole_are_reported_only_if_they_are_everywhere(tmp_path: Path) -> None:
    """What one variant leaves unused or unread is used in another."""
    declared = "argument slam : bool = true "
    assert _where(tmp_path, declared + ENDS.format(c="", v="when slam")) == {}
    unread = declared + "topics topic /i node c : camera when slam wirings connect image to /i"
    assert _where(tmp_path, unread) == {}
    never = (
        declared + "topics topic /i external topic /j node c : camera wirings connect image to /i"
    )
    assert _where(tmp_path, never + " node d : camera when slam wirings connect image to /j") == {
        "DRS211": ""
    }


def test_findings_follow_conditions_in_used_systems(tmp_path: Path) -> None:
    """The argument of the system itself is named, not that of the one it uses."""
    (tmp_path / "part.system").write_text(
        'system Part imports import "camera.rnd" argument has_camera : bool = true\n'
        "topics topic /i node c : camera when has_camera wirings connect image to /i\n"
    )
    body = 'import "part.system" argument eye : bool = true subsystem p : Part(has_camera = $eye) '
    body += "topics topic /i node v : viewer wirings connect image to /i"
    assert _where(tmp_path, body) == {"DRS210": "eye = false"}


def test_combinations_of_a_single_node_have_a_limit(tmp_path: Path) -> None:
    """One finding, at the first of the arguments that vary, which names the node."""
    names = [f"a{number}" for number in range(15)]
    body = "".join(f"argument {name} : bool = false " for name in names)
    body += "topics topic /x node v : viewer wirings "
    body += "".join(f"connect image to /x when {name} " for name in names)
    (finding,) = (each for each in _check(tmp_path, body) if each.code.name == "DRS257")
    assert (finding.span.text, finding.related[0].span.text) == ("a0", "v")
    assert "32,768 combinations" in finding.message
    assert "checked are the 512 in which" in finding.message


def test_number_of_arguments_has_no_limit(tmp_path: Path) -> None:
    """What is wrong only where 40 arguments differ from their defaults is found, and says so."""
    names = [f"a{number}" for number in range(40)]
    body = "".join(f"argument {name} : bool = false " for name in names)
    body += "topics topic /x " + "".join(f"external topic /{name} when {name} " for name in names)
    body += f"node v : viewer when {' and '.join(names)} wirings connect image to /x"
    expected = " and ".join(f"{name} = true" for name in names)
    assert _where(tmp_path, body)["DRS210"] == expected


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("/lit", "'/lit' is not a relative namespace"),
        ("a b", "'a b' is not a relative namespace"),
        ("9", "rejects the name '/9/x': it has a part that starts with a digit"),
        ("lit", ""),
    ],
)
def test_names_made_of_passed_values(tmp_path: Path, name: str, said: str) -> None:
    """What a used system makes names of is seen with the values that it gets."""
    (tmp_path / "used.system").write_text(
        'system Used argument at : string = "d" imports import "viewer.rnd"'
        ' topics external topic "/${at}/x"'
        ' node v : viewer namespace $at wirings connect image to "/${at}/x"'
    )
    (tmp_path / "viewer.rnd").write_text(VIEWER)
    (tmp_path / "s.system").write_text(
        f'system S imports import "used.system" subsystem u : Used(at = "{name}")'
    )
    found = [each.message for each in checked(tmp_path / "s.system") if each.is_error]
    assert (said in found[0]) if said else not found


@pytest.mark.parametrize("name", ["class", "when", "true", "or"])
def test_words_of_conditions_and_scripts_are_no_names(tmp_path: Path, name: str) -> None:
    """A script with an argument of that name would not even be Python."""
    (tmp_path / "s.system").write_text(f"system S argument {name} : bool = true")
    loaded = Repository().load(tmp_path / "s.system")
    assert isinstance(loaded.model, System)
    found = [each.code for each in check_arguments(loaded.model)]
    assert codes.INVALID_SYSTEM_NAME in found


def test_a_variable_that_has_to_be_set_has_all_values_of_one_of(tmp_path: Path) -> None:
    """Its name, which stands for it elsewhere, is none of them; a fault with any value is found."""
    text = (
        ' argument rate : string = env("RATE") one_of ["slow", "fast"]'
        " topics external topic image"
        " node camera : camera"
        ' parameters param rate = if rate = "fast" then 100.0 else 5.0'
        " wirings connect image to image"
    )
    findings = _check(tmp_path, text)
    assert [each.code for each in findings] == [codes.PARAMETER_OUT_OF_RANGE]
    assert 'where rate = "fast"' in findings[0].message
    assert not _check(tmp_path, text.replace("100.0", "10.0"))
