"""The values that rules read, in ACSL: the predicate of each function, and what it is applied to.

What a function gives is stated by a predicate, ``is_roll(r, x, y, z, w)``, derived from its row.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from deros.generators.monitor.c.acsl.contracts import wrapped
from deros.generators.monitor.c.acsl.formulas import (
    arithmetic_predicate,
    called_by,
    formula_predicate,
    loop_declarations,
)
from deros.generators.monitor.c.acsl.terms import constant, of
from deros.generators.monitor.c.code.computed import computed_functions
from deros.generators.monitor.c.code.value_types import ELEMENTS
from deros.generators.monitor.computed import points_name
from deros.rules.functions.function_forms import LENGTH_OF
from deros.rules.functions.functions import FUNCTIONS, Argument, Function
from deros.rules.program import walk
from deros.rules.program.formulas import SHARED, Formula
from deros.rules.program.ir import Apply, Const, Program, Read, Scale, ValueExpression


def change_per_second(previous: str, elapsed: str) -> str:
    """Return the change of ``value`` since another one, divided by a time in nanoseconds."""
    seconds = of("div", f"(double)({elapsed})", constant(1e9))
    change = of("div", of("sub", "value", previous), seconds)
    return change.replace(", \\div", ",\n      \\div")


PROVED = ("float64",)
"""The types of elements for which the result of a loop over an array is proved."""


def _formula_of(row: Function) -> tuple[tuple[str, ...], Formula] | None:
    """Return the parameters and the formula of a row that is printed from one."""
    formula = row.strict_formula if not row.c else None
    return (row.variables, formula) if formula is not None else None


def _used(program: Program) -> dict[str, tuple[tuple[str, ...], Formula]]:
    """Return the formulas that a program calls, by the names of the functions, callees first."""
    found: dict[str, tuple[tuple[str, ...], Formula]] = {}
    for value in walk.values(walk.conditions(program)):
        row = FUNCTIONS[value.function] if isinstance(value, Apply) else None
        own = _formula_of(row) if row is not None else None
        if row is None or own is None:
            continue
        for name in called_by(own[1]):
            found[name] = SHARED[name]
        if row.argument is Argument.QUATERNION:
            found["length_of"] = LENGTH_OF
        found[row.c_name] = own
    for each in computed_functions(program).values():
        for name in called_by(each.formula):
            found[name] = SHARED[name]
    return found


def _loops(program: Program) -> Iterator[list[str]]:
    """Yield the declarations of functions of arrays, one for each type of elements."""
    for row, base in loops_of(program):
        if row.loop is not None and base in PROVED:
            yield loop_declarations(row, row.loop, base, ELEMENTS[base])


def loops_of(program: Program) -> list[tuple[Function, str]]:
    """Return the functions of arrays that a program calls, each with a type of elements."""
    found: set[tuple[str, str]] = set()
    for value in walk.values(walk.conditions(program)):
        if isinstance(value, Apply) and FUNCTIONS[value.function].argument is Argument.NUMBERS:
            read = value.arguments[0]
            assert isinstance(read, Read)
            found.add((value.function, str(program.leaves[read.leaf].type.base)))
    bases = sorted({base for _, base in found})
    return [
        (row, base) for base in bases for row in FUNCTIONS.values() if (row.name, base) in found
    ]


def declarations(program: Program) -> str:
    """Return the predicates of the functions that a program calls."""
    lines: list[str] = []
    used = {name: formula_predicate(*each) for name, each in _used(program).items()}
    for function in computed_functions(program).values():
        used[function.name] = arithmetic_predicate(function.parameters, function.formula)
    if used:
        said = (
            "/* is_f(r, ...) holds if r is what the function f gives; formula_of_f() says how. */"
        )
        lines.append(said)
        named = " ".join(f"predicate is_{name}({each});" for name, (each, _) in used.items())
        lines += wrapped(f"/*@ axiomatic Functions {{ {named} }} */")
    for name, (parameters, body) in used.items():
        lines += wrapped(f"/*@ predicate formula_of_{name}({parameters}) = {body}; */")
    for each in _loops(program):
        lines += each
    return "\n".join([*lines, ""]) if lines else ""


def contract(name: str, parameters: Sequence[str]) -> str:
    """Return the contract of the function that computes a formula.

    The formula is proved, but not handed on: the proofs of callers would be about its rounding.
    They get the value by its name, which is defined as what the function gives.
    """
    arguments = ", ".join(["\\result", *parameters])
    return (
        "/*@ assigns \\nothing;\n"
        f"    check ensures formula_of_{name}({arguments});\n"
        f"    admit ensures is_{name}({arguments}); */\n"
    )


def is_value(
    name: str,
    value: ValueExpression,
    leaves: Mapping[int, str],
    lengths: Mapping[object, str],
) -> str:
    """Return that the double called ``name`` is a value; nothing if there is no predicate for it.

    Args:
        name: the double.
        value: what it is computed as.
        leaves: the doubles that hold the leaves; of a function of stamps the integers.
        lengths: those that hold the lengths of quaternions, by their parts.
    """
    if isinstance(value, Apply):
        row = FUNCTIONS[value.function]
        match row.argument:
            case Argument.SCAN:
                called = row.c_name if value.zone is None else points_name(value)
                return array_predicate(called, value, leaves, name)
            case Argument.STAMPED:
                return f"is_{row.c_name}({', '.join([name, *_stamps(value, leaves)])})"
            case Argument.QUATERNION if value.arguments not in lengths:
                return ""
        if _formula_of(row) is None or row.argument is Argument.NUMBERS:
            return ""
        terms = [_term(each, leaves) for each in value.arguments]
        if not all(terms):
            return ""
        if row.argument is Argument.QUATERNION:
            terms = [of("div", each, lengths[value.arguments]) for each in terms]
        return f"is_{row.c_name}({', '.join([name, *terms])})"
    term = _term(value, leaves)
    return f"same({name}, {term})" if term else ""


def array_predicate(
    function: str, value: Apply, leaves: Mapping[int, str], result: str = ""
) -> str:
    """Return that a function of an array, and of more, is true, or that a double is its result."""
    ranges, *rest = value.arguments
    assert isinstance(ranges, Read)
    array = leaves[ranges.leaf]
    terms = [array, f"{array}_count", *(_term(each, leaves) for each in rest)]
    given = [result, *terms] if result else terms
    return f"is_{function}({', '.join(given)})" if all(terms) else ""


def _stamps(value: Apply, leaves: Mapping[int, str]) -> Iterator[str]:
    """Yield the integers that a function of stamps reads."""
    for each in value.arguments:
        assert isinstance(each, Read)
        yield leaves[each.leaf]


def _term(value: ValueExpression, leaves: Mapping[int, str]) -> str:
    """Return a value as a term; nothing if it has a function in it."""
    match value:
        case Const(value=bool() as truth):
            return str(int(truth))
        case Const(value=float() | int() as number):
            return constant(float(number))
        case Read():
            return leaves.get(value.leaf, "")
        case Scale():
            operand = _term(value.operand, leaves)
            if not operand:
                return ""
            scaled = of("mul", operand, constant(value.factor))
            return of("add", scaled, constant(value.offset)) if value.offset else scaled
    return ""
