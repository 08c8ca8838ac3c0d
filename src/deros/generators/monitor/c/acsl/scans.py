"""The contracts of the functions that read laser scans, in ACSL.

What a beam shows, the usability of a scan and each function of a sector have a predicate that
callers rely on (see :mod:`quantities <deros.generators.monitor.c.acsl.quantities>`); its formula
is proved of the function itself. How many beams are blind is proved no further than that there are
some or none: a count is a recursion, which the provers follow without end. The property tests
compare it with the reference.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from deros.generators.monitor.c.acsl.contracts import wrapped
from deros.generators.monitor.c.acsl.formulas import Relations
from deros.generators.monitor.c.acsl.terms import INFINITY, ZERO, constant, of
from deros.generators.monitor.c.code.computed import points_functions
from deros.generators.monitor.computed import PointsFunction
from deros.rules.functions.function_values import BEARING_TOLERANCE, FULL_TURN
from deros.rules.functions.functions import FUNCTIONS, Argument
from deros.rules.program import walk
from deros.rules.program.ir import Apply, Program

_LIMITS = "double range_min, double range_max, integer zero_is_free"
_SECTOR = "double start, double end"
_LOOK = f"double angle_min, double angle_increment, {_SECTOR}"
_SCAN = (
    "float *ranges, integer count, double angle_min, double angle_increment, "
    f"double range_min, double range_max, {_SECTOR}, integer zero_is_free"
)
_SCAN_OF = "ranges, {}, angle_min, angle_increment, range_min, range_max, start, end, zero_is_free"
_LOOK_OF = "{}, angle_min, angle_increment, start, end"
_ALL = _SCAN_OF.format("count")
_TURN, _MARGIN = constant(FULL_TURN), constant(BEARING_TOLERANCE)
_BEARING = of("add", "angle_min", of("mul", "(double)k", "angle_increment"))
_INSIDE = f"is_in_sector({_BEARING}, start, end)"
_SHOWN = "beam_of((double)ranges[k], range_min, range_max, zero_is_free)"
_IS_ZERO = f"\\eq_double(measured, {ZERO})"
_TOO_NEAR = f"\\eq_double(measured, \\neg_double({INFINITY}))"
_IS_RANGE = f"\\gt_double(measured, {ZERO})"
_BEYOND = "\\gt_double(measured, range_max) && \\ge_double(measured, range_min)"
_IS_TURN = f"\\gt_double(turned, \\neg_double({_TURN})) && \\lt_double(turned, {_TURN})"
_IS_BACK = f"\\lt_double(angle_increment, {ZERO})"

_PREDICATES = (
    (
        f"predicate is_by_offset(double offset, double width) = "
        f"\\le_double(offset, {of('add', 'width', _MARGIN)}) || "
        f"\\ge_double(offset, {of('sub', _TURN, _MARGIN)})"
    ),
    (
        f"predicate is_within(double past, double width) = (\\lt_double(past, {ZERO}) ==> "
        f"is_by_offset({of('add', 'past', _TURN)}, width)) && "
        f"(!\\lt_double(past, {ZERO}) ==> is_by_offset(past, width))"
    ),
    (
        f"predicate is_inside(double past, {_SECTOR}) = (\\lt_double(end, start) ==> "
        f"is_within(past, {of('add', of('sub', 'end', 'start'), _TURN)})) && "
        f"(!\\lt_double(end, start) ==> is_within(past, {of('sub', 'end', 'start')}))"
    ),
    (
        f"predicate is_rest(double past, double turned) = ({_IS_TURN} ==> same(past, turned)) && "
        f"(!({_IS_TURN}) ==> is_fmod(past, turned, {_TURN}))"
    ),
    (
        f"predicate formula_of_in_sector(integer r, double bearing, {_SECTOR}) = "
        f"\\exists double past; is_rest(past, {of('sub', 'bearing', 'start')}) && "
        "(r != 0 <==> is_inside(past, start, end))"
    ),
    (
        f"predicate formula_of_beam(double r, double measured, {_LIMITS}) = "
        f"({_IS_ZERO} && zero_is_free != 0 ==> same(r, {INFINITY})) && "
        f"({_IS_ZERO} && zero_is_free == 0 ==> (\\le_double(range_min, {ZERO}) ==> "
        f"same(r, {ZERO})) && (!\\le_double(range_min, {ZERO}) ==> \\is_NaN(r))) && "
        f"(!{_IS_ZERO} && {_TOO_NEAR} ==> same(r, {ZERO})) && "
        f"({_IS_RANGE} && {_BEYOND} ==> same(r, {INFINITY})) && "
        f"({_IS_RANGE} && !({_BEYOND}) ==> same(r, measured)) && "
        f"(!{_IS_ZERO} && !{_TOO_NEAR} && !{_IS_RANGE} ==> \\is_NaN(r))"
    ),
    (
        f"predicate is_step(double step, double angle_increment) = "
        f"({_IS_BACK} ==> same(step, \\neg_double(angle_increment))) && "
        f"(!{_IS_BACK} ==> same(step, {of('add', 'angle_increment', ZERO)}))"
    ),
    (
        f"predicate has_beam(integer count, {_LOOK}) = "
        f"\\exists integer k; 0 <= k < count && {_INSIDE}"
    ),
    (
        f"predicate has_blind{{L}}({_SCAN}) = "
        f"\\exists integer k; 0 <= k < count && {_INSIDE} && \\is_NaN({_SHOWN})"
    ),
    (
        f"predicate formula_of_blind{{L}}(double r, {_SCAN}) = "
        "\\exists integer unseen, beams; 0 <= unseen <= beams <= count && 0 < beams && "
        f"(0 < unseen <==> has_blind({_ALL})) && "
        f"same(r, {of('div', '(double)unseen', '(double)beams')})"
    ),
    (
        f"predicate formula_of_blind_gap{{L}}(double r, {_SCAN}) = "
        "\\exists double step; \\exists integer gap; is_step(step, angle_increment) && "
        f"0 <= gap <= count && (0 < gap <==> has_blind({_ALL})) && "
        f"same(r, {of('mul', '(double)gap', 'step')})"
    ),
    (
        f"predicate is_one_of{{L}}(double r, {_SCAN}) = \\is_NaN(r) || "
        f"(\\exists integer k; 0 <= k < count && {_INSIDE} && same(r, {_SHOWN}))"
    ),
    (
        f"predicate is_least_of{{L}}(double r, {_SCAN}) = (\\forall integer k; 0 <= k < count ==> "
        f"{_INSIDE} ==> \\is_NaN({_SHOWN}) || \\le_double(r, {_SHOWN}))"
    ),
    (
        "predicate formula_of_scan_usable{L}"
        f"(float *ranges, integer count, {_LIMITS}) = "
        f"(\\exists integer k; 0 <= k < count && !\\is_NaN({_SHOWN}))"
    ),
)

_POINT_PREDICATES = (
    (
        f"predicate has_point{{L}}({_SCAN}) = \\exists integer k; 0 <= k < count && {_INSIDE} && "
        f"\\lt_double({_SHOWN}, {INFINITY})"
    ),
    (
        f"predicate formula_of_points{{L}}(double r, {_SCAN}) = \\exists integer n; "
        f"0 <= n <= count && (0 < n <==> has_point({_ALL})) && same(r, (double)n)"
    ),
)
"""What programs need that count points in zones."""

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
    counted = points_functions(program)
    named = [row.c_name for row in FUNCTIONS.values() if row.argument is Argument.SCAN and row.c]
    predicates = [*_PREDICATES]
    if counted:
        named += [each.name for each in counted]
        predicates += [*_POINT_PREDICATES, *(text for each in counted for text in _of_zone(each))]
    else:
        named.remove("points")
    reads = "reads ranges[0 .. count - 1];"
    lines = ["/* What a beam shows, and what a scan does: see the formulas below. */"]
    lines += wrapped(
        f"/*@ axiomatic Scans {{ logic double beam_of(double measured, {_LIMITS}); "
        f"predicate is_in_sector(double bearing, {_SECTOR}); "
        f"predicate is_scan_usable{{L}}(float *ranges, integer count, {_LIMITS}) {reads} "
        + " ".join(f"predicate is_{name}{{L}}(double r, {_SCAN}) {reads}" for name in named)
        + "".join(f" predicate {each.test}(double distance, double bearing);" for each in counted)
        + " } */"
    )
    for predicate in predicates:
        lines += wrapped(f"/*@ {predicate}; */")
    for lemma in _ORDER:
        lines += wrapped(f"/*@ lemma {lemma}; */")
    return "\n".join([*lines, ""])


def _of_zone(function: PointsFunction) -> Iterator[str]:
    """Yield the predicates of a function that counts points: one there, and the formula."""
    is_near = f"\\le_double({_SHOWN}, {constant(function.reach)})"
    there = f"{is_near} && {function.test}({_SHOWN}, {_BEARING})"
    has_point = f"has_{function.name}"
    yield (
        f"predicate {has_point}{{L}}({_SCAN}) = "
        f"\\exists integer k; 0 <= k < count && {_INSIDE} && {there}"
    )
    yield (
        f"predicate formula_of_{function.name}{{L}}(double r, {_SCAN}) = \\exists integer n; "
        f"0 <= n <= count && (0 < n <==> {has_point}({_ALL})) && same(r, (double)n)"
    )


def point_test_contract(function: PointsFunction) -> str:
    """Return the contract of the function that tells whether the point of a beam is in a zone."""
    x = of("mul", "distance", "cosine")
    y = of("mul", "distance", "sine")
    taken = frozenset({"distance", "bearing", "cosine", "sine", "x", "y"})
    holds = Relations({}, taken).names_and_holds(function.inside)
    claim = (
        "\\exists double cosine, sine; is_cos(cosine, bearing) && is_sin(sine, bearing) && "
        f"(\\let x = {x}; \\let y = {y}; (\\result != 0 <==> {holds}))"
    )
    return "\n".join(
        [
            "/*@ assigns \\nothing;",
            *wrapped(f"check ensures {claim};", 4),
            f"    admit ensures \\result != 0 <==> {function.test}(distance, bearing); */",
            "",
        ]
    )


_SO_FAR, _LOOK_SO_FAR = _SCAN_OF.format("i"), _LOOK_OF.format("i")
_HAS_BEAM = f"has_beam({_LOOK_OF.format('count')})"
_HAS_BLIND = f"has_blind({_ALL})"
_BEAMS_KEPT = (
    "0 <= beams <= i",
    f"0 < beams ==> has_beam({_LOOK_SO_FAR})",
    f"has_beam({_LOOK_SO_FAR}) ==> 0 < beams",
)


def _blind_kept(counter: str) -> tuple[str, ...]:
    """Return that a loop has counted blind beams if there are some: each way is a goal."""
    has_blind = f"has_blind({_SO_FAR})"
    return (
        f"0 <= {counter} <= i",
        f"0 < {counter} ==> {has_blind}",
        f"{has_blind} ==> 0 < {counter}",
    )


IN_SECTOR = """\
/*@ assigns \\nothing;
    check ensures formula_of_in_sector(\\result, bearing, start, end);
    admit ensures \\result != 0 <==> is_in_sector(bearing, start, end); */
"""
"""The contract of the function that tells whether a beam looks into the sector."""

BEAM = """\
/*@ assigns \\nothing;
    check ensures formula_of_beam(\\result, measured, range_min, range_max, zero_is_free);
    admit ensures same(\\result, beam_of(measured, range_min, range_max, zero_is_free)); */
"""
"""The contract of the function that gives what one beam shows."""


@dataclass(frozen=True, slots=True)
class ScanLoop:
    """A function with a loop over the beams: its contract, what the loop assigns, what it keeps."""

    name: str
    contract: str
    assigned: str
    kept: tuple[str, ...]


def _contract(checked: Iterable[str], admitted: str) -> str:
    claims = [*(f"check ensures {each};" for each in checked), f"admit ensures {admitted}; */"]
    ensures = [line for each in claims for line in wrapped(each, 4)]
    head = "/*@ requires \\valid_read(ranges + (0 .. count - 1));"
    return "\n".join([head, "    assigns \\nothing;", *ensures, ""])


def _of_scan(name: str, checked: Iterable[str]) -> str:
    return _contract(checked, f"is_{name}(\\result, {_ALL})")


_LIMITS_OF = "range_min, range_max, zero_is_free"


def points_loop(function: PointsFunction) -> ScanLoop:
    """Return the loop of a function that counts the beams which show a point in a zone."""
    has_point = f"has_{function.name}({_SO_FAR})"
    return ScanLoop(
        function.name,
        _of_scan(
            function.name,
            (
                f"!{_HAS_BEAM} ==> \\is_NaN(\\result)",
                f"!\\is_NaN(\\result) ==> formula_of_{function.name}(\\result, {_ALL})",
                f"{_HAS_BEAM} && !{_HAS_BLIND} ==> !\\is_NaN(\\result)",
            ),
        ),
        "i, beams, unseen, found",
        (
            *_BEAMS_KEPT,
            *_blind_kept("unseen"),
            "unseen <= beams",
            "0 <= found <= i",
            f"0 < found ==> {has_point}",
            f"{has_point} ==> 0 < found",
        ),
    )


LOOPS = (
    ScanLoop(
        "nearest",
        _of_scan(
            "nearest",
            (
                f"is_one_of(\\result, {_ALL})",
                f"!\\is_NaN(\\result) ==> is_least_of(\\result, {_ALL})",
                f"{_HAS_BEAM} && !{_HAS_BLIND} ==> !\\is_NaN(\\result)",
            ),
        ),
        "i, beams, unseen, shortest",
        (
            *_BEAMS_KEPT,
            *_blind_kept("unseen"),
            "unseen <= beams",
            f"is_one_of(shortest, {_SO_FAR})",
            f"is_least_of(shortest, {_SO_FAR})",
        ),
    ),
    ScanLoop(
        "points",
        _of_scan(
            "points",
            (
                f"!{_HAS_BEAM} ==> \\is_NaN(\\result)",
                f"{_HAS_BEAM} ==> formula_of_points(\\result, {_ALL})",
            ),
        ),
        "i, beams, found",
        (
            *_BEAMS_KEPT,
            "0 <= found <= i",
            f"0 < found ==> has_point({_SO_FAR})",
            f"has_point({_SO_FAR}) ==> 0 < found",
        ),
    ),
    ScanLoop(
        "blind",
        _of_scan(
            "blind",
            (
                f"!{_HAS_BEAM} ==> \\is_NaN(\\result)",
                f"{_HAS_BEAM} ==> formula_of_blind(\\result, {_ALL})",
            ),
        ),
        "i, beams, unseen",
        (*_BEAMS_KEPT, *_blind_kept("unseen"), "unseen <= beams"),
    ),
    ScanLoop(
        "blind_gap",
        _of_scan(
            "blind_gap",
            (
                f"!{_HAS_BEAM} ==> \\is_NaN(\\result)",
                f"!\\is_NaN(\\result) ==> formula_of_blind_gap(\\result, {_ALL})",
            ),
        ),
        "i, beams, head, run, widest",
        (
            *_BEAMS_KEPT[:2],
            *_blind_kept("widest"),
            "run <= widest && head <= widest",
        ),
    ),
    ScanLoop(
        "scan_usable",
        _contract(
            (f"\\result != 0 <==> formula_of_scan_usable(ranges, count, {_LIMITS_OF})",),
            f"\\result != 0 <==> is_scan_usable(ranges, count, {_LIMITS_OF})",
        ),
        "i, usable",
        (f"usable != 0 <==> formula_of_scan_usable(ranges, i, {_LIMITS_OF})",),
    ),
)
"""The functions with a loop over the beams; none calls a later one."""
