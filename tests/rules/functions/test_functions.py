"""The function table: results of the functions, and agreement of the target languages."""

from __future__ import annotations

import ctypes
import functools
import math
import re
import struct
import subprocess
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from deros.generators.monitor.c.code.formulas import printed as printed_in_c
from deros.generators.monitor.c.code.formulas import shared_texts
from deros.generators.monitor.python.formulas import printed as printed_in_python
from deros.rules.functions import function_values as values
from deros.rules.functions.function_texts import PYTHON, C
from deros.rules.functions.functions import FUNCTIONS
from deros.rules.functions.memories import SAMPLES
from tests.support.needs import needs

NUMBERS = st.floats(allow_nan=False)
TIMES = st.integers(-1, 2**63 - 1) | st.integers(0, 3 * 10**9)
SECONDS = st.integers(-2, 3) | st.integers(-(2**31), 2**31 - 1)
NANOSECONDS = st.integers(0, 2**32 - 1) | st.integers(0, 10**9)
MODERATE = st.floats(-1e3, 1e3, allow_subnormal=False)
ANGLES = st.floats(-7.0, 7.0)
SINGLES = st.floats(width=32)
BEAMS = st.lists(
    SINGLES | st.sampled_from([math.nan, 0.0, -0.0, -1.0, math.inf, -math.inf]) | SINGLES,
    max_size=20,
)


def _namespace() -> dict[str, Any]:
    """Execute all Python texts as in a generated module."""
    namespace: dict[str, Any] = {
        "functools": functools,
        "math": math,
        "np": np,
        "Sequence": Sequence,
    }
    for row in FUNCTIONS.values():
        for text in (*(PYTHON[each] for each in row.python_needs), *printed_in_python(row)):
            exec(text, namespace)
        if row.guard is not None:
            exec(row.guard.python, namespace)
    return namespace


NAMESPACE = _namespace()


def text_of(name: str) -> Callable[..., float | None]:
    """Return the function that a Python text calls; for quaternions, a wrapper around the text."""
    row = FUNCTIONS[name]
    if row.python_of_unit:
        return of_quaternion(row.python_of_unit)
    found: Callable[..., float | None] = eval(row.python_call, NAMESPACE)
    return found


def of_quaternion(lines: Sequence[str]) -> Callable[..., float | None]:
    """Return the function that a handler computes inline, with the same normalisation."""
    body = [*lines[:-1], f"return {lines[-1]}"]
    text = "\n    ".join(["def of_unit(ux: float, uy: float, uz: float, uw: float):", *body])
    namespace: dict[str, Any] = {"math": math}
    exec(text, namespace)

    def evaluate(x: float, y: float, z: float, w: float) -> float | None:
        length = math.sqrt(x * x + y * y + z * z + w * w)
        if not 0.0 < length < math.inf:
            return None
        result: float = namespace["of_unit"](x / length, y / length, z / length, w / length)
        return result

    return evaluate


def same(a: float | None, b: float | None) -> bool:
    """Return whether two results are equal to the last bit, including unknown and signed zero."""
    if a is None or b is None:
        return a is b
    return struct.pack("d", a) == struct.pack("d", b)


def about(axis: tuple[float, float, float], angle: float) -> tuple[float, float, float, float]:
    """Return the quaternion of a rotation."""
    x, y, z = (each * math.sin(angle / 2.0) for each in axis)
    return x, y, z, math.cos(angle / 2.0)


# Results of the functions ---------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "axis"), [("roll", (1, 0, 0)), ("pitch", (0, 1, 0)), ("yaw", (0, 0, 1))]
)
@given(angle=st.floats(-1.5, 1.5), scale=st.floats(1e-3, 1e3))
def test_rotation_about_one_axis_has_that_angle(
    name: str, axis: tuple[float, float, float], angle: float, scale: float
) -> None:
    """The result does not depend on the length of the quaternion."""
    evaluate = FUNCTIONS[name].evaluate
    assert evaluate is not None
    quaternion = (scale * each for each in about(axis, angle))
    assert evaluate(*quaternion) == pytest.approx(angle, abs=1e-12)


@given(direction=ANGLES, angle=st.floats(0.0, math.pi), turn=ANGLES)
def test_tilt_is_the_angle_to_the_vertical(direction: float, angle: float, turn: float) -> None:
    """It is the angle about any level axis, whatever the yaw: acos(1 - 2(x² + y²))."""
    x, y, _, w = about((math.cos(direction), math.sin(direction), 0.0), angle)
    s, c = math.sin(turn / 2.0), math.cos(turn / 2.0)
    turned = (c * x - s * y, c * y + s * x, s * w, c * w)
    assert values.tilt(*turned) == pytest.approx(angle, abs=1e-12)
    by_cosine = math.acos(max(-1.0, min(1.0, 1.0 - 2.0 * (turned[0] ** 2 + turned[1] ** 2))))
    assert values.tilt(*turned) == pytest.approx(by_cosine, abs=1e-7)


@pytest.mark.parametrize("name", ["roll", "pitch", "yaw", "tilt"])
@pytest.mark.parametrize("quaternion", [(0.0, 0.0, 0.0, 0.0), (math.inf, 0.0, 0.0, 1.0)])
def test_invalid_quaternion_gives_no_angle(name: str, quaternion: tuple[float, ...]) -> None:
    """The length must be finite and above 0."""
    evaluate = FUNCTIONS[name].evaluate
    assert evaluate is not None
    assert evaluate(*quaternion) is None


def test_pitch_at_the_pole_is_a_quarter_turn() -> None:
    """A sine rounded to more than 1 still gives a quarter turn."""
    half = math.sqrt(0.5)
    assert values.pitch(0.0, half + 1e-16, 0.0, half) == pytest.approx(math.pi / 2.0)


def test_rate_is_change_over_time() -> None:
    """A change of 3 in half a second is 6 per second; equal times and inf to inf give None."""
    assert values.rate(5.0, 2.0, 500_000_000) == 6.0
    assert values.rate(5.0, 2.0, 0) is None
    assert values.rate(math.inf, math.inf, 1) is None
    assert values.rate(math.inf, 1.0, 1) == math.inf


@pytest.mark.parametrize(
    ("received_ns", "sec", "nanosec", "latency"),
    [
        (10_200_000_000, 9, 0, 1.2),
        (10_200_000_000, 10, 200_000_000, 0.0),
        (10_100_000_000, 9, 900_000_000, 0.2),
        (10_000_000_000, 10, 1, -1e-9),
        (1_800_000_000_000_000_001, 1_800_000_000, 0, 1e-9),
        (10, 0, 0, None),
        (10, -1, 5, None),
        (10, 1, 1_000_000_000, None),
        (-1, 1, 0, None),
        (0, 0, 1, -1e-9),
    ],
)
def test_latency_is_receipt_less_stamp(
    received_ns: int, sec: int, nanosec: int, latency: float | None
) -> None:
    """It is exact to the nanosecond, negative for the future, unknown for no valid stamp."""
    assert values.latency(received_ns, sec, nanosec) == latency


def test_empty_array_has_no_minimum_or_maximum() -> None:
    """An empty array has no minimum and no maximum, and 0 elements."""
    assert (values.least([]), values.greatest([]), values.count([])) == (None, None, 0)


# The target languages agree -------------------------------------------------------------------


@pytest.mark.parametrize("name", ["roll", "pitch", "yaw", "tilt"])
@given(x=NUMBERS, y=NUMBERS, z=NUMBERS, w=NUMBERS)
@example(x=0.0, y=0.0, z=0.0, w=0.0)
def test_python_angles_agree_with_the_reference(
    name: str, x: float, y: float, z: float, w: float
) -> None:
    """The Python text gives the result of the reference to the last bit."""
    evaluate = FUNCTIONS[name].evaluate
    assert evaluate is not None
    result = evaluate(x, y, z, w)
    assert same(text_of(name)(x, y, z, w), result)
    least, greatest = FUNCTIONS[name].bounds
    assert result is None or least <= result <= greatest


@given(value=NUMBERS, previous=NUMBERS, elapsed_ns=st.integers(0, 10**15))
def test_python_scalar_functions_agree_with_the_reference(
    value: float, previous: float, elapsed_ns: int
) -> None:
    """Rate, abs and norm agree on all numbers."""
    arguments = (value, previous, elapsed_ns)
    assert same(text_of("rate")(*arguments), values.rate(*arguments))
    assert same(text_of("abs")(value), values.absolute(value))
    assert same(text_of("norm")(value, previous, 1.0), values.norm(value, previous, 1.0))


@given(received_ns=TIMES, sec=SECONDS, nanosec=NANOSECONDS)
def test_python_latency_agrees_with_the_reference(received_ns: int, sec: int, nanosec: int) -> None:
    """The Python text gives the results of the reference to the last bit."""
    arguments = (received_ns, sec, nanosec)
    assert same(text_of("latency")(*arguments), values.latency(*arguments))


@given(array=st.lists(NUMBERS, max_size=8))
def test_python_array_functions_agree_with_the_reference(array: list[float]) -> None:
    """Min, max and count agree, also on empty arrays."""
    for name in ("min", "max", "count"):
        evaluate = FUNCTIONS[name].evaluate
        assert evaluate is not None
        for given_as in (array, np.array(array)):
            assert text_of(name)(given_as) == evaluate(array)


ZEROS = st.lists(st.sampled_from([0.0, -0.0]), min_size=1, max_size=40)


@given(zeros=ZEROS)
def test_python_returns_the_zero_of_the_reference(zeros: list[float]) -> None:
    """Of positive and negative zeros, which are equal, both return the first."""
    for name in ("min", "max"):
        evaluate = FUNCTIONS[name].evaluate
        assert evaluate is not None
        assert str(text_of(name)(np.array(zeros))) == str(evaluate(zeros))
    for ranges in (zeros, [-2.0, *zeros]):
        arguments = (0.0, 0.01, -1.0, 50.0, 0.0, 6.0, False)
        assert str(text_of("nearest")(np.array(ranges), *arguments)) == str(
            values.nearest(ranges, *arguments)
        )


SCANS = st.tuples(
    BEAMS,
    ANGLES,
    st.floats(-0.5, 0.5) | st.sampled_from([math.pi / 2, -math.pi / 3, 1.0]),
    st.floats(-1.0, 1.0),
    st.floats(-1.0, 50.0),
    ANGLES,
    ANGLES,
    st.booleans(),
)
OF_SCANS = ("nearest", "blind", "blind_gap")


@given(arguments=SCANS)
def test_python_of_scans_agrees_with_the_reference(arguments: tuple[Any, ...]) -> None:
    """The functions of sectors and the test for usable scans agree on all scans."""
    ranges, angle_min, increment, *rest = arguments
    limits = [float(np.float32(limit)) for limit in rest[:2]]  # rounded as in a message
    others = (angle_min, increment, *limits, *rest[2:])
    usable = values.scan_usable(ranges, limits[0], limits[1], rest[-1])
    assert usable or values.nearest(ranges, *others) is None
    for given_as in (ranges, np.array(ranges, "<f4"), np.array(ranges, ">f4")):
        for name in OF_SCANS:
            assert text_of(name)(given_as, *others) == FUNCTIONS[name].value(ranges, *others)
        assert NAMESPACE["scan_usable"](given_as, *limits, rest[-1]) is usable


def test_every_value_function_has_a_text_in_each_language() -> None:
    """Each target can call every function that the engine evaluates."""
    for row in FUNCTIONS.values():
        if row.evaluate is not None:
            built_in = ("abs", "len")
            assert row.python_of_unit or row.python_call in (*NAMESPACE, *built_in)
            assert printed_in_c(row) or row.c_call in ("fabs", "")
            assert row.c_call in printed_in_c(row) or row.c_call == "fabs"


# C --------------------------------------------------------------------------------------------


IS_NUMBER = "static bool is_number(double value)\n{\n  return value == value;\n}\n"

WINDOW = f"""typedef struct
{{
  int64_t stamps[{SAMPLES}];
  double values[{SAMPLES}];
  int64_t latest;
  uint32_t count;
}} window;
"""

OF_ELEMENTS = (("BASE", "float64"), ("ELEMENT", "double"), ("RESULT", "double"), ("NONE", "NAN"))
"""Element types used here for the texts of arrays: placeholders and their replacements."""


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> ctypes.CDLL:
    """Compile all C texts with strict warnings and export their functions."""
    directory: Path = tmp_path_factory.mktemp("functions")
    texts = [*C.values(), *(text for _, text in shared_texts())]
    texts += [printed_in_c(row) for row in FUNCTIONS.values() if not row.c]
    exported = "\n".join([IS_NUMBER, *texts]).replace("static ", "")
    exported = exported.replace("@_", "").replace("$_SAMPLES", f"{SAMPLES}U")
    for placeholder, meant in OF_ELEMENTS:
        exported = re.sub(rf"(?<![A-Z]){placeholder}(?![A-Z])", meant, exported)
    includes = ["#include <math.h>", "#include <stdbool.h>", "#include <stdint.h>"]
    source = "\n".join([*includes, "#include <stddef.h>", WINDOW, *_signatures(exported), exported])
    (directory / "functions.c").write_text(source)
    strict = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror", "-O1"]
    subprocess.run(
        ["cc", *strict, "-shared", "-fPIC", "functions.c", "-o", "functions.so", "-lm"],
        cwd=directory,
        check=True,
    )
    return ctypes.CDLL(str(directory / "functions.so"))


def _signatures(source: str) -> list[str]:
    """Return the prototypes of all functions; none begins with a space."""
    heads = re.findall(r"^(\w[^;{}]*\))\n\{", source, flags=re.MULTILINE)
    return [f"{head};" for head in heads]


def call_c(library: ctypes.CDLL, name: str, *arguments: Any) -> float | None:
    """Call a C function of doubles; an array is passed as pointer and count, NaN is unknown."""
    function = getattr(library, name)
    function.restype = ctypes.c_double
    passed: list[Any] = []
    for argument in arguments:
        if isinstance(argument, ctypes.Array):
            passed += [argument, ctypes.c_size_t(len(argument))]
        elif isinstance(argument, bool):
            passed.append(ctypes.c_bool(argument))
        else:
            passed.append(ctypes.c_double(argument))
    result: float = function(*passed)
    return None if math.isnan(result) else result


def rate_in_c(library: ctypes.CDLL, value: float, previous: float, ns: int) -> float | None:
    """Call rate(), which stores the last message behind pointers."""
    last, last_t = ctypes.c_double(previous), ctypes.c_int64(7)
    library.rate.restype = ctypes.c_double
    arguments = (ctypes.c_double(value), ctypes.c_int64(7 + ns))
    result: float = library.rate(*arguments, ctypes.byref(last), ctypes.byref(last_t))
    assert same(last.value, value)
    assert last_t.value == 7 + ns
    return None if math.isnan(result) else result


@needs("cc")
@pytest.mark.parametrize("name", ["roll", "pitch", "yaw", "tilt"])
@given(x=MODERATE, y=MODERATE, z=MODERATE, w=MODERATE)
@example(x=0.0, y=0.0, z=0.0, w=0.0)
def test_c_angles_agree_with_the_reference(
    library: ctypes.CDLL, name: str, x: float, y: float, z: float, w: float
) -> None:
    """The C texts give the angles of the reference to the last bit."""
    length = call_c(library, "length_of", x, y, z, w)
    unit = [math.nan if length is None else part / length for part in (x, y, z, w)]
    assert same(call_c(library, name, *unit), getattr(values, name)(x, y, z, w))


@needs("cc")
@given(x=NUMBERS, y=NUMBERS, elapsed_ns=st.integers(0, 10**15))
def test_c_rate_agrees_with_the_reference(
    library: ctypes.CDLL, x: float, y: float, elapsed_ns: int
) -> None:
    """The C text gives the results of the reference to the last bit."""
    assert same(rate_in_c(library, x, y, elapsed_ns), values.rate(x, y, elapsed_ns))


@needs("cc")
@given(x=MODERATE, y=MODERATE, z=MODERATE)
def test_c_norm_agrees_with_the_reference(
    library: ctypes.CDLL, x: float, y: float, z: float
) -> None:
    """The C text gives the results of the reference to the last bit."""
    assert same(call_c(library, "norm", x, y, z), values.norm(x, y, z))


@needs("cc")
@given(received_ns=TIMES, sec=SECONDS, nanosec=NANOSECONDS)
def test_c_latency_agrees_with_the_reference(
    library: ctypes.CDLL, received_ns: int, sec: int, nanosec: int
) -> None:
    """The C text gives the results of the reference to the last bit."""
    library.latency.restype = ctypes.c_double
    result: float = library.latency(*map(ctypes.c_int64, (received_ns, sec, nanosec)))
    expected = values.latency(received_ns, sec, nanosec)
    assert same(None if math.isnan(result) else result, expected)


@needs("cc")
@given(value=st.integers(-(2**63) + 1, 2**63 - 1))
def test_c_magnitude_agrees_with_the_reference(library: ctypes.CDLL, value: int) -> None:
    """The C text gives the results of the reference for integers."""
    library.magnitude.restype = ctypes.c_int64
    assert library.magnitude(ctypes.c_int64(value)) == values.absolute(value)


@needs("cc")
@given(array=st.lists(NUMBERS, max_size=8))
def test_c_array_functions_agree_with_the_reference(
    library: ctypes.CDLL, array: list[float]
) -> None:
    """The C texts give the results of the reference."""
    elements = (ctypes.c_double * len(array))(*array)
    assert call_c(library, "least_float64", elements) == values.least(array)
    assert call_c(library, "greatest_float64", elements) == values.greatest(array)


@needs("cc")
@given(arguments=SCANS)
def test_c_of_scans_agrees_with_the_reference(
    library: ctypes.CDLL, arguments: tuple[Any, ...]
) -> None:
    """The C texts of sectors and of the test for usable scans give the results of the reference."""
    ranges, *rest = arguments
    beams = (ctypes.c_float * len(ranges))(*ranges)
    for name in OF_SCANS:
        assert call_c(library, name, beams, *rest) == FUNCTIONS[name].value(*arguments)
    library.scan_usable.restype = ctypes.c_bool
    limits = (ctypes.c_double(rest[2]), ctypes.c_double(rest[3]), ctypes.c_bool(rest[-1]))
    usable = library.scan_usable(beams, ctypes.c_size_t(len(beams)), *limits)
    assert usable is values.scan_usable(ranges, rest[2], rest[3], rest[-1])
