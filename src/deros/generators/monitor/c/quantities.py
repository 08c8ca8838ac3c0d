"""How the values that rules read are computed, in ACSL: by relations between double numbers.

In ACSL an equation of doubles is one of real numbers, which says nothing of NaN. So what a function
gives is stated by a predicate, ``is_roll(r, x, y, z, w)``, and that two numbers are the same by
``same()``: equal under any function of them whatever.
"""

from __future__ import annotations

from collections.abc import Mapping

from deros.generators.monitor.c.contracts import wrapped
from deros.monitor import walk
from deros.monitor.functions import FUNCTIONS, Argument
from deros.monitor.ir import Apply, Const, Program, Read, Scale, ValueExpression


def constant(value: float | str) -> str:
    """Return a constant as a double."""
    return f"(double){value!r}" if isinstance(value, float) else f"(double){value}"


def of(operation: str, first: str, second: str) -> str:
    """Return an operation on two doubles, rounded as C rounds it."""
    return f"\\{operation}_double({first}, {second})"


def change_per_second(previous: str, elapsed: str) -> str:
    """Return the change of ``value`` since another one, divided by a time in nanoseconds."""
    seconds = of("div", f"(double)({elapsed})", constant(1e9))
    change = of("div", of("sub", "value", previous), seconds)
    return change.replace(", \\div", ",\n      \\div")


def _sum(*parts: str) -> str:
    total = parts[0]
    for part in parts[1:]:
        total = of("add", total, part)
    return total


def _product(first: str, second: str) -> str:
    return of("mul", first, second)


ONE, TWO, ZERO = constant(1.0), constant(2.0), constant(0.0)
INFINITY, NAN = of("div", ONE, ZERO), of("div", ZERO, ZERO)


def _angle(above: tuple[str, str, str, str], first: str, second: str) -> str:
    """Return roll or yaw: atan2(2 (a b + c d), 1 - 2 (e e + f f))."""
    a, b, c, d = above
    sine = _product(TWO, _sum(_product(a, b), _product(c, d)))
    squares = _sum(_product(first, first), _product(second, second))
    return f"is_atan2(r, {sine}, {of('sub', ONE, _product(TWO, squares))})"


def _usable(length: str) -> str:
    return f"\\gt_double({length}, {ZERO}) && \\lt_double({length}, {INFINITY})"


_SQUARES = _sum(*(_product(each, each) for each in "xyzw"))
_SINE = _product(TWO, of("sub", _product("uw", "uy"), _product("uz", "ux")))
_PARTS = "double r, double ux, double uy, double uz, double uw"

PREDICATES = {
    "clamped": (
        "double r, double sine",
        f"(\\gt_double(sine, {ONE}) ==> same(r, {ONE})) && "
        f"(\\lt_double(sine, {constant(-1.0)}) ==> same(r, {constant(-1.0)})) && "
        f"(!\\gt_double(sine, {ONE}) && !\\lt_double(sine, {constant(-1.0)}) ==> same(r, sine))",
    ),
    "length_of": (
        "double r, double x, double y, double z, double w",
        f"\\exists double l; is_sqrt(l, {_SQUARES}) && ({_usable('l')} ==> same(r, l)) && "
        f"(!({_usable('l')}) ==> same(r, {NAN}))",
    ),
    "roll": (_PARTS, _angle(("uw", "ux", "uy", "uz"), "ux", "uy")),
    "yaw": (_PARTS, _angle(("uw", "uz", "ux", "uy"), "uy", "uz")),
    "pitch": (_PARTS, f"\\exists double c; is_clamped(c, {_SINE}) && is_asin(r, c)"),
}
"""Of each function, the parameters of the predicate ``is_...`` and what it says."""

_NEEDS = {"pitch": ("clamped",)}


def declarations(program: Program) -> str:
    """Return the predicates of the functions that a program calls."""
    used: list[str] = []
    for value in walk.values(walk.conditions(program)):
        if isinstance(value, Apply):
            name = FUNCTIONS[value.function].c_call
            quaternion = FUNCTIONS[value.function].argument is Argument.QUATERNION
            for each in (*_NEEDS.get(name, ()), *(("length_of",) if quaternion else ()), name):
                if each in PREDICATES and each not in used:
                    used.append(each)
    if not used:
        return ""
    lines = ["/* is_f(r, ...) holds if r is what the function f gives; formula_of_f() says how. */"]
    named = " ".join(f"predicate is_{name}({PREDICATES[name][0]});" for name in used)
    lines += wrapped(f"/*@ axiomatic Functions {{ {named} }} */")
    for name in used:
        parameters, body = PREDICATES[name]
        lines += wrapped(f"/*@ predicate formula_of_{name}({parameters}) = {body}; */")
    return "\n".join([*lines, ""])


def contract(name: str, parameters: str) -> str:
    """Return the contract of the function that computes a value, by the names of its parameters.

    The formula is proved, but not handed on: the proofs of callers would be about its rounding.
    They get the value by its name, which is defined as what the function gives.
    """
    if name not in PREDICATES:
        return "/*@ assigns \\nothing; */\n"
    return (
        "/*@ assigns \\nothing;\n"
        f"    check ensures formula_of_{name}(\\result, {parameters});\n"
        f"    admit ensures is_{name}(\\result, {parameters}); */\n"
    )


def is_value(
    name: str, value: ValueExpression, leaves: Mapping[int, str], lengths: Mapping[object, str]
) -> str:
    """Return that the double called ``name`` is a value; nothing if there is no predicate for it.

    Args:
        name: the double.
        value: what it is computed as.
        leaves: the doubles that hold the leaves.
        lengths: those that hold the lengths of quaternions, by their parts.
    """
    if isinstance(value, Apply) and FUNCTIONS[value.function].argument is Argument.SCAN:
        return _of_scan(name, value, leaves)
    if isinstance(value, Apply):
        call = FUNCTIONS[value.function].c_call
        if call not in PREDICATES or value.arguments not in lengths:
            return ""
        parts = [_term(each, leaves) for each in value.arguments]
        shares = [of("div", each, lengths[value.arguments]) for each in parts]
        return f"is_{call}({name}, {', '.join(shares)})" if all(parts) else ""
    term = _term(value, leaves)
    return f"same({name}, {term})" if term else ""


def _of_scan(name: str, value: Apply, leaves: Mapping[int, str]) -> str:
    """Return that a double is what a function of a scan gives."""
    ranges, *rest = value.arguments
    assert isinstance(ranges, Read)
    array = leaves[ranges.leaf]
    terms = [array, f"{array}_count", *(_term(each, leaves) for each in rest)]
    return f"is_{FUNCTIONS[value.function].c_call}({', '.join([name, *terms])})"


def _term(value: ValueExpression, leaves: Mapping[int, str]) -> str:
    """Return a value as a term; nothing if it has a function in it."""
    match value:
        case Const(value=float() | int() as number):
            return constant(float(number))
        case Read():
            return leaves.get(value.leaf, "")
        case Scale():
            operand = _term(value.operand, leaves)
            if not operand:
                return ""
            scaled = _product(operand, constant(value.factor))
            return _sum(scaled, constant(value.offset)) if value.offset else scaled
    return ""
