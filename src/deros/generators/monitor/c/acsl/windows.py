"""The contracts of functions that remember several messages, in ACSL.

They are unwrapped angles and rates over a span of time; their memory has a fixed size.
"""

from __future__ import annotations

from deros.generators.monitor.c.acsl.contracts import wrapped
from deros.generators.monitor.c.acsl.quantities import change_per_second
from deros.generators.monitor.c.acsl.terms import constant, of
from deros.rules.functions.functions import FUNCTIONS
from deros.rules.program import walk
from deros.rules.program.ir import Apply, Program

_FILLED = "w->count <= $_SAMPLES"
_ALL = "w->stamps[0 .. $_SAMPLES - 1], w->values[0 .. $_SAMPLES - 1], w->count"
_BEFORE = "\\at(w->stamps[k], Pre)"
_CHANGE = change_per_second("\\at(w->values[k], Pre)", f"time_between({_BEFORE}, stamp)")

UNWRAPPED = f"""\
/* An unwrapped angle: the total changes by the shortest way. */
/*@ requires \\valid(last) && \\valid(total) && \\separated(last, total);
    assigns *last, *total;
    ensures same(*last, value);
    ensures same(\\result, *total);
    check ensures \\exists double way;
      is_remainder(way, {of("sub", "value", chr(92) + "old(*last)")}, turn) &&
      (!\\is_NaN(way) ==> same(\\result, {of("add", chr(92) + "old(*total)", "way")})) &&
      (\\is_NaN(way) ==> same(\\result, value)); */
"""

BETWEEN = """\
/* The time between two stamps; none if the second is not the later one. */
/*@ assigns \\nothing;
    ensures \\result == time_between(earlier, later); */
"""

STAMP_OF = """\
/* The time of a header; negative if it is zero, which means that it has no stamp. */
/*@ assigns \\nothing;
    ensures 0 <= sec <= INT32_MAX && 0 <= nanosec < 1000000000 && sec + nanosec > 0
      ==> \\result == (sec * 1000000000) + nanosec;
    ensures !(0 <= sec <= INT32_MAX && 0 <= nanosec < 1000000000 && sec + nanosec > 0)
      ==> \\result == -1; */
"""

_STAMPED = "0 <= sec <= INT32_MAX && 0 <= nanosec < 1000000000 && sec + nanosec > 0"
_DELAY = of("div", "(double)(received - (sec * 1000000000 + nanosec))", constant(1e9))

LATENCY = """\
/* The seconds from the stamp of a header to the receipt of its message; NaN without a stamp. */
/*@ assigns \\nothing;
    check ensures formula_of_latency(\\result, received, sec, nanosec);
    admit ensures is_latency(\\result, received, sec, nanosec); */
"""

BASE_OF = f"""\
/* The newest sample that is at least the span old; else the oldest one. */
/*@ requires \\valid_read(w) && {_FILLED};
    assigns \\nothing;
    ensures \\result == 0 || \\result < w->count;
    ensures \\result == 0 || time_between(w->stamps[\\result], stamp) >= span;
    ensures \\forall integer k; \\result < k < w->count
      ==> time_between(w->stamps[k], stamp) < span; */
"""

_BASE_OF_LOOP = """\
  /*@ loop invariant 1 <= i && (w->count >= 1 ==> i <= w->count);
      loop invariant base == 0 || base < i;
      loop invariant base == 0 || (base < w->count && time_between(w->stamps[base], stamp) >= span);
      loop invariant \\forall integer k; base < k < i && k < w->count
        ==> time_between(w->stamps[k], stamp) < span;
      loop assigns i, base;
      loop variant w->count - i; */
"""

DROP = f"""\
/* Drops the samples before one. */
/*@ requires \\valid(w) && {_FILLED} && first <= w->count;
    assigns {_ALL};
    ensures w->count == \\old(w->count) - first;
    ensures \\forall integer k; 0 <= k < w->count
      ==> w->stamps[k] == \\at(w->stamps[k + first], Pre)
      && same(w->values[k], \\at(w->values[k + first], Pre)); */
"""

_DROP_LOOP = """\
  /*@ loop invariant first <= i <= w->count;
      loop invariant \\forall integer k; first <= k < i
        ==> w->stamps[k - first] == \\at(w->stamps[k], Pre);
      loop invariant \\forall integer k; 0 <= k < i - first
        ==> same(w->values[k], \\at(w->values[k + first], Pre));
      loop invariant \\forall integer k; i - first <= k < $_SAMPLES
        ==> w->stamps[k] == \\at(w->stamps[k], Pre);
      loop invariant \\forall integer k; i - first <= k < $_SAMPLES
        ==> same(w->values[k], \\at(w->values[k], Pre));
      loop assigns i, w->stamps[0 .. $_SAMPLES - 1], w->values[0 .. $_SAMPLES - 1];
      loop variant w->count - i; */
"""

_APART = (
    "(\\old(w->count) == 0 || (\\old(w->count) < $_SAMPLES &&\n      "
    "time_between(\\at(w->stamps[w->count - 1], Pre), stamp) >= (span + 7) / 8))"
)

KEEP = f"""\
/* Keeps a message as a sample if it lies an eighth of the span after the newest one. */
/*@ requires \\valid(w) && {_FILLED} && 0 < span <= $_LATEST;
    assigns {_ALL}, w->latest;
    ensures {_FILLED};
    ensures w->latest == stamp;
    ensures {_APART}
      ==> w->count == \\old(w->count) + 1 && w->stamps[\\old(w->count)] == stamp
      && same(w->values[\\old(w->count)], value);
    ensures !{_APART}
      ==> w->count == \\old(w->count);
    ensures \\forall integer k; 0 <= k < \\old(w->count)
      ==> w->stamps[k] == \\at(w->stamps[k], Pre)
      && same(w->values[k], \\at(w->values[k], Pre)); */
"""

RATE_OVER = f"""\
/* The change per second since the newest sample at least the span old; NaN without one. */
/*@ requires \\valid(w) && {_FILLED} && 0 < span <= $_LATEST;
    assigns {_ALL}, w->latest;
    ensures {_FILLED};
    check ensures \\is_NaN(value) ==> w->count == 0 && \\is_NaN(\\result);
    check ensures stamp < 0 ==> \\is_NaN(\\result);
    check ensures \\is_NaN(\\result) || (\\exists integer k; 0 <= k < \\old(w->count) &&
      time_between({_BEFORE}, stamp) >= span &&
      (\\forall integer j; k < j < \\old(w->count) ==>
      time_between(\\at(w->stamps[j], Pre), stamp) < span) &&
      same(\\result, {_CHANGE})); */
"""


def with_loop(name: str, text: str) -> str:
    """Return the text of a function that goes through the samples, its loop annotated."""
    annotation = {"base_of": _BASE_OF_LOOP, "drop": _DROP_LOOP}[name]
    start = text.index("  for (")
    return text[:start] + annotation + text[start:]


def declarations(program: Program) -> str:
    """Return the names that the contracts use; nothing where no rule asks for stamps."""
    functions = {
        value.function
        for value in walk.values(walk.conditions(program))
        if isinstance(value, Apply)
    }
    lines: list[str] = []
    if any(FUNCTIONS[each].over_span for each in functions):
        lines.append("/* The time from one stamp to a later one. */")
        lines += wrapped(
            "/*@ logic integer time_between(integer earlier, integer later) = "
            "0 <= earlier < later ? later - earlier : 0; */"
        )
    if "latency" in functions:
        parameters = "double r, integer received, integer sec, integer nanosec"
        known = f"0 <= received && {_STAMPED}"
        lines.append("/* is_latency(r, ...) holds if r is what latency() gives, by its formula. */")
        lines += wrapped(f"/*@ axiomatic Latencies {{ predicate is_latency({parameters}); }} */")
        lines += wrapped(
            f"/*@ predicate formula_of_latency({parameters}) = ({known} ==> same(r, {_DELAY})) &&"
            f" (!({known}) ==> \\is_NaN(r)); */"
        )
    return "\n".join([*lines, ""]) if lines else ""
