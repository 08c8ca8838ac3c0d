"""Formulas in ACSL: the contract of each printed function, derived from the form in its row.

A formula becomes a relation between a result and its arguments, because the functions of the
mathematical library are relations in ACSL, and a value that depends on a condition is best stated
by implications. What is not a plain term gets a name, by an existential quantifier.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from deros.generators.monitor.c.acsl.contracts import wrapped
from deros.generators.monitor.c.acsl.terms import INFINITY, NAN, constant, of
from deros.generators.monitor.c.code.formulas import count_name, entry_text
from deros.generators.monitor.computed import EntriesFunction
from deros.generators.text.unique_names import UniqueNames
from deros.rules.functions.function_forms import COUNT, ELAPSED, ELEMENT, FIRST, Loop, Step
from deros.rules.functions.functions import Function
from deros.rules.program.formulas import (
    SHARED,
    Arithmetic,
    Binary,
    Call,
    Choice,
    Comparison,
    Expression,
    Formula,
    Logical,
    Name,
    Negation,
    Negative,
    Number,
    Relation,
    calls,
    choices,
)

_OPERATIONS: Mapping[Arithmetic, str] = {"+": "add", "-": "sub", "*": "mul", "/": "div"}
_RELATIONS: Mapping[Comparison, str] = {
    "<": "\\lt_double",
    "<=": "\\le_double",
    ">": "\\gt_double",
    ">=": "\\ge_double",
    "==": "\\eq_double",
    "!=": "!\\eq_double",
}


class Relations:
    """Writes expressions as relations; ``names`` gives the term of each name that is not its own.

    Attributes:
        names: as given; a caller may add to them.
    """

    def __init__(self, names: Mapping[str, str], taken: frozenset[str]) -> None:
        """Write names as ``names`` says; ``taken`` are those that new variables must not have."""
        self.names = dict(names)
        self._unique = UniqueNames(taken | {"r", "n", "values", "before"})

    def variable(self, name: str) -> str:
        """Return a name for a quantified variable, like ``name``."""
        return self._unique.new(name)

    def is_result(self, result: str, value: Expression) -> str:
        """Return that ``result`` is the value of an expression."""
        match value:
            case Choice():
                named: list[tuple[str, str]] = []
                condition = self._condition(value.condition, named)
                then, otherwise = (
                    self.is_result(result, each) for each in (value.then, value.otherwise)
                )
                text = f"({condition} ==> {then}) && (!({condition}) ==> {otherwise})"
                return quantified(named, text)
            case Call(function="double", arguments=(operand,)):
                return self.is_result(result, operand)
            case Call():
                named = []
                arguments = [self._term(each, named) for each in value.arguments]
                text = f"is_{value.function}({', '.join([result, *arguments])})"
                return quantified(named, text)
        named = []
        term = self._term(value, named)
        return quantified(named, f"same({result}, {term})")

    def _term(self, value: Expression, named: list[tuple[str, str]]) -> str:
        match value:
            case Number():
                return _constant(value.value)
            case Name():
                return self.names.get(value.name, value.name)
            case Negative():
                return f"\\neg_double({self._term(value.operand, named)})"
            case Binary():
                left, right = self._term(value.left, named), self._term(value.right, named)
                return of(_OPERATIONS[value.operator], left, right)
            case Call(function="double", arguments=(operand,)):
                return self._term(operand, named)
        name = self.variable("v")
        named.append((name, self.is_result(name, value)))
        return name

    def _condition(self, value: Expression, named: list[tuple[str, str]]) -> str:
        match value:
            case Relation():
                left, right = self._term(value.left, named), self._term(value.right, named)
                return f"{_RELATIONS[value.operator]}({left}, {right})"
            case Logical():
                word = " && " if value.operator == "and" else " || "
                operands = (self._condition(each, named) for each in value.operands)
                text = word.join(operands)
                return text if value.operator == "and" else f"({text})"
            case Negation():
                return f"!({self._condition(value.operand, named)})"
            case Name():
                return self.names.get(value.name, value.name)
            case Call(arguments=(operand,)):
                return f"!\\is_NaN({self._term(operand, named)})"
        raise AssertionError(f"{value} is not a condition")

    def holds(self, condition: Expression) -> str:
        """Return that a condition on numbers and flags holds."""
        named: list[tuple[str, str]] = []
        return quantified(named, self._condition(condition, named))

    def names_and_holds(self, condition: Formula) -> str:
        """Return that a condition holds, its terms named before."""
        if not condition.assignments:
            return self.holds(condition.result)
        (name, value), *rest = condition.assignments
        fresh = self.names[name] = self.variable(name)
        term = self._term(value, [])
        others = self.names_and_holds(Formula(tuple(rest), condition.result))
        return f"(\\let {fresh} = {term}; {others})"

    def is_arithmetic(self, result: str, formula: Formula) -> str:
        """Return the same as :meth:`is_formula`, by cases where a value depends on a condition.

        What exists, a prover has to find; what is named, it has. The text doubles with each choice.
        """
        if not formula.assignments:
            return self.is_result(result, formula.result)
        (name, value), *rest = formula.assignments
        fresh = self.names[name] = self.variable(name)
        return self._bound(fresh, value, result, Formula(tuple(rest), formula.result))

    def _bound(self, name: str, value: Expression, result: str, rest: Formula) -> str:
        """Return the rest of a formula with a name for a value."""
        match value:
            case Choice():
                condition = self._condition(value.condition, [])
                then, otherwise = (
                    self._bound(name, each, result, rest) for each in (value.then, value.otherwise)
                )
                return f"({condition} ==> {then}) && (!({condition}) ==> {otherwise})"
            case Call():
                found = f"{self.is_result(name, value)} && {self.is_arithmetic(result, rest)}"
                return f"(\\exists double {name}; {found})"
        return f"(\\let {name} = {self._term(value, [])}; {self.is_arithmetic(result, rest)})"

    def is_formula(self, result: str, formula: Formula) -> str:
        """Return that ``result`` is the value of a formula, its assignments named before."""
        named = []
        for name, value in formula.assignments:
            fresh = self.variable(name)
            named.append((fresh, self.is_result(fresh, value)))
            self.names[name] = fresh
        return quantified(named, self.is_result(result, formula.result))


def quantified(named: list[tuple[str, str]], text: str) -> str:
    """Return a statement on variables, each with what it is; nested, as later ones need earlier."""
    if not named:
        return text
    names = ", ".join(name for name, _ in named)
    return f"(\\exists double {names}; {' && '.join([*(what for _, what in named), text])})"


def _constant(value: float) -> str:
    if math.isnan(value):
        return NAN
    if math.isinf(value):
        return INFINITY if value > 0 else f"\\neg_double({INFINITY})"
    return constant(value)


# Functions of one message -----------------------------------------------------------------------


_MOST_CHOICES = 4
"""How many choices a formula may have for its cases to be written out."""


def arithmetic_predicate(parameters: tuple[str, ...], formula: Formula) -> tuple[str, str]:
    """Return the parameters of the predicate that states arithmetic of rules, and its body."""
    relations = Relations({}, frozenset({*parameters, *formula.names}) - _assigned(formula))
    declared = ", ".join(f"double {each}" for each in ("r", *parameters))
    if choices(formula) > _MOST_CHOICES:
        return formula_predicate(parameters, formula)
    return declared, relations.is_arithmetic("r", formula)


def formula_predicate(parameters: tuple[str, ...], formula: Formula) -> tuple[str, str]:
    """Return the parameters of the predicate that states a formula, and its body."""
    relations = Relations({}, frozenset({*parameters, *formula.names}) - _assigned(formula))
    declared = ", ".join(f"double {each}" for each in ("r", *parameters))
    body = relations.is_formula("r", formula)
    return declared, body[1:-1] if body.startswith("(\\exists") else body


def _assigned(formula: Formula) -> set[str]:
    return {name for name, _ in formula.assignments}


def called_by(formula: Formula) -> Iterator[str]:
    """Yield the shared functions that a formula calls."""
    for name in calls(formula):
        if name in SHARED:
            yield name


# Functions with a memory ------------------------------------------------------------------------


def step_contract(row: Function, step: Step) -> str:
    """Return the contract of the function that takes a message."""
    fields = [each.name for each in step.memory]
    pointers = [*fields, *(["last_t"] if step.is_timed else [])]
    names = {name: f"\\old(*{name})" for name in fields}
    relations = Relations(names, frozenset({*row.variables, *step.formula.names, *pointers, "t"}))
    named: list[tuple[str, str]] = []
    if step.is_timed:
        name = relations.variable(ELAPSED)
        seconds = of("div", "(double)(t - \\old(*last_t))", constant(1e9))
        unknown = "\\old(*last_t) < 0"
        is_elapsed = f"({unknown} ==> same({name}, {NAN})) && (!({unknown}) ==> "
        named.append((name, f"{is_elapsed}same({name}, {seconds}))"))
        relations.names[ELAPSED] = name
    said = []
    for name, value in step.formula.assignments:
        if name in fields:
            said.append(relations.is_result(f"*{name}", value))
            relations.names[name] = f"*{name}"
        else:
            fresh = relations.variable(name)
            named.append((fresh, relations.is_result(fresh, value)))
            relations.names[name] = fresh
    said.append(relations.is_result("\\result", step.formula.result))
    clauses = []
    if pointers:
        valid = [f"\\valid({each})" for each in pointers]
        apart = [f"\\separated({', '.join(pointers)})"] if len(pointers) > 1 else []
        clauses.append(f"requires {' && '.join([*valid, *apart])}")
    if step.is_timed:
        clauses.append("requires 0 <= t <= $_LATEST && -1 <= *last_t <= $_LATEST")
    clauses.append(f"assigns {', '.join(f'*{each}' for each in pointers) or chr(92) + 'nothing'}")
    clauses += ["ensures *last_t == t"] if step.is_timed else []
    clauses.append(f"check ensures {quantified(named, ' && '.join(said))}")
    return _contract(f"{row.name}(): {row.gives}." if row.gives else "", clauses)


def _contract(comment: str, clauses: list[str]) -> str:
    lines = wrapped(f"/* {comment} */") if comment else []
    for number, clause in enumerate(clauses):
        lead = "/*@ " if number == 0 else "    "
        end = "; */" if number == len(clauses) - 1 else ";"
        lines += wrapped(f"{lead}{clause}{end}".strip(), 0 if number == 0 else 4)
    return "\n".join([*lines, ""])


# Functions of arrays ----------------------------------------------------------------------------


def loop_declarations(row: Function, loop: Loop, base: str, element: str) -> list[str]:
    """Return the predicates of a function of arrays of doubles.

    ``carried_f`` holds of what the loop carries after some elements, by induction; ``formula_of_f``
    of the result. Callers do not rely on it: no prover finds that what is stored in the monitor
    leaves an array of doubles as it is.
    """
    name = f"{row.c_name}_{base}"
    constants = "".join(f", double {each}" for each in row.variables)
    given = "".join(f", {each}" for each in row.variables)
    array = f"{element} *values"
    taken = frozenset({*row.variables, *loop.each.names, *loop.result.names})
    carried = "before"
    here = {loop.accumulator: carried, ELEMENT: "(double)values[n]", FIRST: "n == 0"}
    goes_on = Relations(here, taken).is_formula("r", loop.each)
    begins = f"same(r, {_constant(loop.initial)})"
    ends = Relations({COUNT: "(double)count"}, taken - {loop.accumulator})
    total = ends.variable(loop.accumulator)
    ends.names[loop.accumulator] = total
    result = ends.is_formula("r", loop.result)
    texts = [
        f"/*@ inductive carried_{name}{{L}}(double r, {array}, integer n{constants}) {{ "
        f"case begins{{L}}: \\forall double r{constants}, {array}; {begins} ==> "
        f"carried_{name}(r, values, 0{given}); "
        f"case goes_on{{L}}: \\forall double r, before{constants}, {array}, integer n; 0 <= n && "
        f"carried_{name}(before, values, n{given}) && {goes_on} ==> "
        f"carried_{name}(r, values, n + 1{given}); }} */",
        f"/*@ predicate formula_of_{name}{{L}}(double r, {array}, integer count{constants}) = "
        f"\\exists double {total}; carried_{name}({total}, values, count{given}) && {result}; */",
    ]
    return [line for text in texts for line in wrapped(text)]


def loop_contract(row: Function, base: str, is_proved: bool) -> str:
    """Return the contract of a function of arrays; without its result if they are not doubles."""
    clauses = ["requires \\valid_read(values + (0 .. count - 1))", "assigns \\nothing"]
    if is_proved:
        arguments = ", ".join(["\\result", "values", "count", *row.variables])
        clauses.append(f"check ensures formula_of_{row.c_name}_{base}({arguments})")
    return _contract("", clauses)


def loop_invariants(row: Function, loop: Loop, base: str, is_proved: bool) -> tuple[str, ...]:
    """Return what the loop of a function of arrays keeps."""
    arguments = ", ".join([loop.accumulator, "values", "i", *row.variables])
    return (f"carried_{row.c_name}_{base}({arguments})",) if is_proved else ()


# Conditions on entries --------------------------------------------------------------------------


def _satisfied(function: EntriesFunction, end: str) -> str:
    """Return that an entry before an index satisfies the condition."""
    names = {
        name: f"{entry_text(leaf, name, 'k')}{' != 0' if leaf.type.base == 'bool' else ''}"
        for leaf, name in function.arrays
    }
    taken = frozenset({*names, "count", "found", "i", "k"})
    condition = Relations(names, taken).holds(function.entry)
    return f"(\\exists integer k; 0 <= k < {end} && {condition})"


def entries_contract(function: EntriesFunction) -> str:
    """Return the contract of a function that counts entries: whether it finds one is proved."""
    counts = [count_name(function, name) for _, name in function.arrays]
    valid = [
        f"requires \\valid_read({name} + (0 .. {count} - 1))"
        for (_, name), count in zip(function.arrays, counts, strict=True)
    ]
    same = "".join(f"{counts[0]} == {other} && " for other in counts[1:])
    satisfied = f"{same}{_satisfied(function, counts[0])}"
    clauses = [
        *valid,
        "assigns \\nothing",
        f"ensures \\result <= {counts[0]}",
        f"check ensures 0 < \\result <==> {satisfied}",
    ]
    return _contract("", clauses)


def entries_invariants(function: EntriesFunction) -> tuple[str, ...]:
    """Return what the loop of a function that counts entries keeps: each way is a goal."""
    satisfied = _satisfied(function, "i")
    return "found <= i", f"0 < found ==> {satisfied}", f"{satisfied} ==> 0 < found"
