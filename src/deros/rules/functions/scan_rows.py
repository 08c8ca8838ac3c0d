"""The rows of the function table that read laser scans; see :mod:`.functions`."""

from __future__ import annotations

import math
from collections.abc import Callable

from deros.rules.functions import function_texts as texts
from deros.rules.functions import function_values as values
from deros.rules.functions.function_rows import Argument, Function, Guard, Result, UnitRule

_SCAN_LEAVES = ("ranges", "angle_min", "angle_increment", "range_min", "range_max")


_SCAN_USABLE = Guard(
    (0, 3, 4, 7),
    values.scan_usable,
    "scan_usable",
    texts.PYTHON["scan_usable"],
    "scan_usable",
    texts.C["scan_usable"],
)


def _of_scan(name: str, evaluate: Callable[..., float | None], unit: str, gives: str) -> Function:
    """Return a function of a sector; whether 0 means that nothing is there follows the sector."""
    return Function(
        name,
        Argument.SCAN,
        Result.FLOAT,
        UnitRule.FIXED,
        unit=unit,
        usage=f"scan.{name}(-30 deg, 30 deg)",
        gives=gives,
        leaves=_SCAN_LEAVES,
        parameters=(("start", "rad"), ("end", "rad")),
        evaluate=evaluate,
        nan_is_unknown=False,
        is_single=name == "nearest",
        bounds=(0.0, 1.0 if name == "blind" else math.inf),
        bearings=True,
        guard=_SCAN_USABLE,
        told=("blind",) if name == "nearest" else (),
        python_call=f"scan_{name}",
        python=texts.PYTHON[name],
        may_be_none=True,
        python_needs=("scan_beams",),
        c_call=name,
        c=texts.C[name],
    )


SCAN_ROWS = (
    _of_scan("nearest", values.nearest, "m", "the least range between two bearings, in m"),
    _of_scan(
        "blind",
        values.blind,
        "1",
        "the share of the beams between two bearings that are blind, from 0 to 1",
    ),
    _of_scan("blind_gap", values.blind_gap, "rad", "the widest gap of blind beams, in rad"),
    Function(
        "points_in",
        Argument.SCAN,
        Result.FLOAT,
        UnitRule.NONE,
        usage="scan.points_in(front)",
        gives="how many beams show a point in that zone, or on its edge",
        leaves=_SCAN_LEAVES,
        of_zone=True,
        nan_is_unknown=False,
        is_whole=True,
        bounds=(0.0, math.inf),
        guard=_SCAN_USABLE,
        told=("blind", "points"),
        python_call="scan_points_in",
        python=texts.PYTHON["points_in"],
        may_be_none=True,
        python_needs=("scan_beams", "scan_directions"),
    ),
    Function(
        "points",
        Argument.SCAN,
        Result.FLOAT,
        UnitRule.NONE,
        is_written=False,
        evaluate=values.points,
        nan_is_unknown=False,
        is_whole=True,
        bounds=(0.0, math.inf),
        python_call="scan_points",
        python=texts.PYTHON["points"],
        may_be_none=True,
        python_needs=("scan_beams",),
        c_call="points",
        c=texts.C["points"],
    ),
)
