"""The contracts of the functions that read laser scans, in ACSL.

The range of a beam, the usability of a scan and the nearest range each have a predicate that
callers rely on (see :mod:`quantities <deros.generators.monitor.c.acsl.quantities>`); its formula
is proved of the function itself.
"""

from __future__ import annotations

from deros.generators.monitor.c.acsl.contracts import wrapped
from deros.generators.monitor.c.acsl.terms import INFINITY, ZERO, constant, of
from deros.rules.functions.function_values import BEARING_TOLERANCE, FULL_TURN
from deros.rules.functions.functions import FUNCTIONS, Argument
from deros.rules.program import walk
from deros.rules.program.ir import Apply, Program

_BEAM = "double measured, double bearing, double range_min, double range_max"
_SECTOR = "double start, double end"
_SCAN = (
    "float *ranges, integer count, double angle_min, double angle_increment, "
    f"double range_min, double range_max, {_SECTOR}"
)
_SCAN_OF = "ranges, {count}, angle_min, angle_increment, range_min, range_max, start, end"
_TURN, _MARGIN = constant(FULL_TURN), constant(BEARING_TOLERANCE)
_TOO_NEAR = f"\\eq_double(measured, \\neg_double({INFINITY}))"
_INSIDE = "is_inside(past, start, end)"
_VALID = "\\ge_double(measured, range_min)"
_BEYOND = "\\gt_double(measured, range_max)"
_BEARING = of("add", "angle_min", of("mul", "(double)k", "angle_increment"))
_SHOWN = f"beam_of((double)ranges[k], {_BEARING}, range_min, range_max, start, end)"

_PREDICATES = (
    (
        f"is_by_offset(double offset, double width) = "
        f"\\le_double(offset, {of('add', 'width', _MARGIN)}) || "
        f"\\ge_double(offset, {of('sub', _TURN, _MARGIN)})"
    ),
    (
        f"is_within(double past, double width) = (\\lt_double(past, {ZERO}) ==> "
        f"is_by_offset({of('add', 'past', _TURN)}, width)) && "
        f"(!\\lt_double(past, {ZERO}) ==> is_by_offset(past, width))"
    ),
    (
        f"is_inside(double past, {_SECTOR}) = (\\lt_double(end, start) ==> "
        f"is_within(past, {of('add', of('sub', 'end', 'start'), _TURN)})) && "
        f"(!\\lt_double(end, start) ==> is_within(past, {of('sub', 'end', 'start')}))"
    ),
    (
        f"formula_of_beam(double r, {_BEAM}, {_SECTOR}) = \\exists double past; "
        f"is_fmod(past, {of('sub', 'bearing', 'start')}, {_TURN}) && "
        f"({_INSIDE} && {_TOO_NEAR} ==> same(r, {of('add', 'range_min', ZERO)})) && "
        f"({_INSIDE} && !{_TOO_NEAR} && {_VALID} && {_BEYOND} ==> same(r, {INFINITY})) && "
        f"({_INSIDE} && !{_TOO_NEAR} && {_VALID} && !{_BEYOND} ==> "
        f"same(r, {of('add', 'measured', ZERO)})) && "
        f"(!({_INSIDE} && ({_TOO_NEAR} || {_VALID})) ==> \\is_NaN(r))"
    ),
    (
        f"is_one_of{{L}}(double r, {_SCAN}) = \\is_NaN(r) || "
        f"(\\exists integer k; 0 <= k < count && same(r, {_SHOWN}))"
    ),
    (
        f"is_least_of{{L}}(double r, {_SCAN}) = (\\forall integer k; 0 <= k < count ==> "
        f"\\is_NaN({_SHOWN}) || \\le_double(r, {_SHOWN}))"
    ),
    (
        "formula_of_valid_range(double measured, double range_min) = "
        f"\\ge_double(measured, range_min) || {_TOO_NEAR}"
    ),
    (
        "formula_of_usable{L}(float *ranges, integer count, double range_min) = "
        "(\\exists integer k; 0 <= k < count && is_valid_range((double)ranges[k], range_min))"
    ),
)

_ORDER = (
    "le_numbers: \\forall double a, b; \\le_double(a, b) ==> !\\is_NaN(a) && !\\is_NaN(b)",
    "le_same: \\forall double a; !\\is_NaN(a) ==> \\le_double(a, a)",
    (
        "le_after: \\forall double a, b, c; "
        "\\le_double(a, b) && \\le_double(b, c) ==> \\le_double(a, c)"
    ),
    (
        "le_either: \\forall double a, b; "
        "!\\is_NaN(a) && !\\is_NaN(b) && !\\le_double(a, b) ==> \\le_double(b, a)"
    ),
)
"""The order of doubles, which is proved, and by which the least of several is found."""


def declarations(program: Program) -> str:
    """Return the names and predicates that the contracts use; nothing where no scan is read."""
    if not any(
        isinstance(value, Apply) and FUNCTIONS[value.function].argument is Argument.SCAN
        for value in walk.values(walk.conditions(program))
    ):
        return ""
    reads = "reads ranges[0 .. count - 1];"
    lines = ["/* What a beam shows, and what a scan does: see the formulas below. */"]
    lines += wrapped(
        f"/*@ axiomatic Scans {{ logic double beam_of({_BEAM}, {_SECTOR}); "
        "predicate is_valid_range(double measured, double range_min); "
        f"predicate is_usable{{L}}(float *ranges, integer count, double range_min) {reads} "
        f"predicate is_nearest{{L}}(double r, {_SCAN}) {reads} }} */"
    )
    for each in _PREDICATES:
        lines += wrapped(f"/*@ predicate {each}; */")
    for each in _ORDER:
        lines += wrapped(f"/*@ lemma {each}; */")
    return "\n".join([*lines, ""])


_OF_BEAM = "measured, bearing, range_min, range_max, start, end"
_OF_ALL = _SCAN_OF.format(count="count")
_SO_FAR = _SCAN_OF.format(count="i")

BEAM = (
    "/*@ assigns \\nothing;\n"
    f"    check ensures formula_of_beam(\\result, {_OF_BEAM});\n"
    f"    admit ensures same(\\result, beam_of({_OF_BEAM})); */\n"
)
"""The contract of the function that gives what one beam shows."""

NEAREST = f"""\
/*@ requires \\valid_read(ranges + (0 .. count - 1));
    assigns \\nothing;
    check ensures is_one_of(
      \\result, {_OF_ALL});
    check ensures is_least_of(
      \\result, {_OF_ALL});
    admit ensures is_nearest(
      \\result, {_OF_ALL}); */
"""
"""The contract of the function that gives the nearest distance."""

NEAREST_LOOP = (
    f"is_one_of(\n    shortest, {_SO_FAR})",
    f"is_least_of(\n    shortest, {_SO_FAR})",
)
"""What its loop keeps."""

VALID_RANGE = """\
/*@ assigns \\nothing;
    check ensures \\result != 0 <==> formula_of_valid_range(measured, range_min);
    admit ensures \\result != 0 <==> is_valid_range(measured, range_min); */
"""
"""The contract of the function that tells whether one range says anything."""

USABLE = """\
/*@ requires \\valid_read(ranges + (0 .. count - 1));
    assigns \\nothing;
    check ensures \\result != 0 <==> formula_of_usable(ranges, count, range_min);
    admit ensures \\result != 0 <==> is_usable(ranges, count, range_min); */
"""
"""The contract of the function that tells whether a scan is usable."""

USABLE_LOOP = ("usable != 0 <==> formula_of_usable(ranges, i, range_min)",)
"""What its loop keeps."""
