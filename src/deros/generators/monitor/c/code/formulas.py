"""Functions of the table as definitions in C, printed from the forms in their rows."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from deros.generators.monitor.c.code.literals import number
from deros.generators.monitor.c.code.value_types import ELEMENTS
from deros.generators.monitor.computed import EntriesFunction, PointsFunction
from deros.generators.text.c import lay_out_list
from deros.rules.functions.function_forms import (
    COUNT,
    ELAPSED,
    ELEMENT,
    FIRST,
    LENGTH_OF,
    Loop,
    Step,
)
from deros.rules.functions.functions import Function, Result
from deros.rules.program.formulas import (
    SHARED,
    Binary,
    Call,
    Choice,
    Expression,
    Formula,
    Logical,
    Name,
    Negation,
    Negative,
    Number,
    Relation,
)
from deros.rules.program.ir import Leaf

INDENT = "  "


class Printer:
    """Prints expressions; ``names`` gives the text of each name that is not its own."""

    def __init__(self, names: Mapping[str, str]) -> None:
        """Print names as ``names`` says."""
        self._names = names

    def number(self, value: Expression) -> str:
        """Return an expression of a number."""
        match value:
            case Number():
                return number(value.value)
            case Name():
                return self._names.get(value.name, value.name)
            case Negative():
                return f"-{self._operand(value.operand)}"
            case Binary():
                return f"{self._operand(value.left)} {value.operator} {self._operand(value.right)}"
            # Checkers of MISRA C take no operand in parentheses before a colon for one.
            case Choice(condition=Relation("!=", left, right), then=Binary() as quotient):
                return self.number(Choice(Relation("==", left, right), value.otherwise, quotient))
            case Choice():
                then, otherwise = self._operand(value.then), self._operand(value.otherwise)
                return f"{self._test(value.condition)} ? {then} : {otherwise}"
            case Call(function="double", arguments=(operand,)):
                return self.number(operand)
            case Call():
                return self._call(value.function, value.arguments)
        raise AssertionError(f"{value} is not a number")

    def condition(self, value: Expression) -> str:
        """Return an expression of a condition."""
        match value:
            case Relation():
                return f"{self._operand(value.left)} {value.operator} {self._operand(value.right)}"
            case Logical():
                word = "&&" if value.operator == "and" else "||"
                return f" {word} ".join(map(self._nested, value.operands))
            case Negation():
                return f"!{self._nested(value.operand)}"
            case Name():
                return self._names.get(value.name, value.name)
            case Call(function="known"):
                return self._call("is_number", value.arguments)
        raise AssertionError(f"{value} is not a condition")

    def _test(self, value: Expression) -> str:
        return self._nested(value) if isinstance(value, Call) else f"({self.condition(value)})"

    def _nested(self, value: Expression) -> str:
        text = self.condition(value)
        return text if isinstance(value, Call | Name) else f"({text})"

    def _operand(self, value: Expression) -> str:
        text = self.number(value)
        return f"({text})" if isinstance(value, Binary | Choice | Negative) else text

    def _call(self, function: str, arguments: tuple[Expression, ...]) -> str:
        return f"{function}({', '.join(map(self.number, arguments))})"

    def assign(self, place: str, value: Expression) -> list[str]:
        """Return the statement that stores a value, which may be what is in the place already."""
        match value:
            case Choice(condition=condition, then=then, otherwise=Name(name=kept)):
                if self._names.get(kept, kept) == place:
                    lines = [f"{INDENT}{place} = {self.number(then)};"]
                    return [f"if ({self.condition(condition)}) {{", *lines, "}"]
        return [f"{place} = {self.number(value)};"]


def formula_text(name: str, parameters: tuple[str, ...], formula: Formula) -> str:
    """Return the function that computes a formula."""
    printer = Printer({})
    lines = [
        *(f"const double {name} = {printer.number(value)};" for name, value in formula.assignments),
        f"return {printer.number(formula.result)};",
    ]
    return _definition("double", name, [f"double {each}" for each in parameters], lines)


def step_text(row: Function, step: Step) -> str:
    """Return the function that takes a message, with pointers to what is remembered."""
    printer = Printer({each.name: f"*{each.name}" for each in step.memory})
    parameters = [f"double {each}" for each in row.variables]
    parameters += ["int64_t t"] if step.is_timed else []
    parameters += [f"double *{each.name}" for each in step.memory]
    lines: list[str] = []
    if step.is_timed:
        parameters.append("int64_t *last_t")
        lines.append("const int64_t passed = t - *last_t;")
        known = "((double)passed / 1e9)"
        lines.append(f"const double {ELAPSED} = (*last_t < 0) ? NAN : {known};")
    remembered = {each.name for each in step.memory}
    for name, value in step.formula.assignments:
        if name in remembered:
            lines += printer.assign(f"*{name}", value)
        else:
            lines.append(f"const double {name} = {printer.number(value)};")
    lines += ["*last_t = t;"] if step.is_timed else []
    lines.append(f"return {printer.number(step.formula.result)};")
    return _definition("double", row.c_name, parameters, lines)


def loop_text(row: Function, loop: Loop) -> str:
    """Return the function that goes through an array; see :data:`PLACEHOLDERS`."""
    of_elements = row.result is Result.ELEMENT
    result = "RESULT" if of_elements else "double"
    names = {ELEMENT: "values[i]" if of_elements else ELEMENT, FIRST: "(i == 0U)"}
    printer = Printer({**names, COUNT: "(double)count"})
    inner = [] if of_elements else [f"const double {ELEMENT} = (double)values[i];"]
    inner += [
        f"const double {name} = {printer.number(value)};" for name, value in loop.each.assignments
    ]
    inner += printer.assign(loop.accumulator, loop.each.result)
    initial = "NONE" if of_elements else printer.number(Number(loop.initial))
    lines = [
        f"{result} {loop.accumulator} = {initial};",
        "for (size_t i = 0U; i < count; ++i) {",
        *(f"{INDENT}{line}" for line in inner),
        "}",
        f"return {printer.number(loop.result.result)};",
    ]
    parameters = ["const ELEMENT *values", "size_t count"]
    parameters += [f"double {each}" for each in row.variables]
    return _definition(result, f"{row.c_name}_BASE", parameters, lines)


PLACEHOLDERS = ("BASE", "ELEMENT", "RESULT", "NONE")
"""In functions of arrays: the ROS 2 name of the element's type, its C type, the type of the result,
and the result for an empty array."""


def entries_text(function: EntriesFunction) -> str:
    """Return the function that counts the entries that satisfy a condition."""
    counts = [count_name(function, name) for _, name in function.arrays]
    parameters = [
        each
        for (leaf, name), count in zip(function.arrays, counts, strict=True)
        for each in (f"const {ELEMENTS[str(leaf.type.base)]} *{name}", f"size_t {count}")
    ]
    printer = Printer({name: entry_text(leaf, name, "i") for leaf, name in function.arrays})
    others = [f"({each} != count)" for each in counts[1:]]
    lines = ["size_t found = 0U;"]
    if others:
        differ = " || ".join(others) if len(others) > 1 else others[0][1:-1]
        lines += [f"size_t count = {counts[0]};", f"if ({differ}) {{", f"{INDENT}count = 0U;", "}"]
    lines += [
        "for (size_t i = 0U; i < count; ++i) {",
        f"{INDENT}if ({printer.condition(function.entry)}) {{",
        f"{INDENT * 2}++found;",
        f"{INDENT}}}",
        "}",
        "return found;",
    ]
    return _definition("size_t", function.name, parameters, lines)


def points_text(function: PointsFunction) -> str:
    """Return the function that counts the beams which show a point in a zone."""
    near = f"(shown <= {number(function.reach)}) && {function.test}(shown, bearing)"
    return _COUNT_POINTS.replace("NAME", function.name).replace("IS_INSIDE", near)


_COUNT_POINTS = """\
static double NAME(
  const float *ranges, size_t count, double angle_min, double angle_increment, double range_min,
  double range_max, double start, double end, bool zero_is_free)
{
  size_t beams = 0U;
  size_t unseen = 0U;
  size_t found = 0U;
  for (size_t i = 0U; i < count; ++i) {
    const double bearing = angle_min + ((double)i * angle_increment);
    if (in_sector(bearing, start, end)) {
      const double shown = beam((double)ranges[i], range_min, range_max, zero_is_free);
      beams += 1U;
      if (!is_number(shown)) {
        unseen += 1U;
      } else if (IS_INSIDE) {
        found += 1U;
      } else {
        /* elsewhere */
      }
    }
  }
  return ((beams == 0U) || (unseen > (beams - unseen))) ? NAN : (double)found;
}
"""


def point_test_text(function: PointsFunction) -> str:
    """Return the function that tells whether the point that a beam shows is in a zone."""
    printer = Printer({})
    lines = [
        "const double x = distance * cos(bearing);",
        "const double y = distance * sin(bearing);",
        *(
            f"const double {name} = {printer.number(value)};"
            for name, value in function.inside.assignments
        ),
        f"return {printer.condition(function.inside.result)};",
    ]
    return _definition("bool", function.test, ["double distance", "double bearing"], lines)


def count_name(function: EntriesFunction, array: str) -> str:
    """Return what the number of an array's entries is called."""
    return "count" if len(function.arrays) == 1 else f"{array}_count"


def entry_text(leaf: Leaf, array: str, index: str) -> str:
    """Return an entry of an array, a number as a double."""
    cast = "" if leaf.type.base in ("bool", "float64") else "(double)"
    return f"{cast}{array}[{index}]"


def printed(row: Function) -> str:
    """Return the definition of a row's function: its text if it has one, else its form, printed."""
    if row.c:
        return row.c
    if row.step is not None:
        return step_text(row, row.step)
    if row.loop is not None:
        return loop_text(row, row.loop)
    formula = row.strict_formula
    return formula_text(row.c_name, row.variables, formula) if formula is not None else ""


def shared_texts() -> Iterator[tuple[str, str]]:
    """Yield the functions that others call, by name."""
    yield "length_of", formula_text("length_of", *LENGTH_OF)
    for name, (parameters, formula) in SHARED.items():
        yield name, formula_text(name, parameters, formula)


def _definition(result: str, name: str, parameters: list[str], lines: list[str]) -> str:
    head = lay_out_list(0, f"static {result} {name}(", parameters, ")")
    return "\n".join([*head, "{", *(f"{INDENT}{line}" for line in lines), "}", ""])
