"""Functions of the table as definitions in Python, printed from the forms in their rows."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from itertools import takewhile

from deros.generators.monitor.computed import ComputedFunction, EntriesFunction, PointsFunction
from deros.generators.text.document import (
    LINE,
    SOFTLINE,
    Document,
    concat,
    group,
    join,
    nest,
    render_lines,
)
from deros.generators.text.logic import Atom, Logic, NoneOf, all_of, any_of, lay_out
from deros.generators.text.python import LINE_LENGTH, lay_out_call, tuple_entries
from deros.generators.text.unique_names import UniqueNames
from deros.rules.functions.function_forms import COUNT, ELAPSED, ELEMENT, FIRST, Loop, Step
from deros.rules.functions.functions import FUNCTIONS, Function, Result
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
    calls,
)
from deros.rules.program.ir import Apply

_INDENT = "    "
_CHOICE, _OR, _AND, _NOT, _RELATION, _SUM, _PRODUCT, _SIGN, _ATOM = range(9)
_PRECEDENCE: Mapping[str, int] = {"+": _SUM, "-": _SUM, "*": _PRODUCT, "/": _PRODUCT}


class Printer:
    """Prints expressions; ``names`` gives the text of each name that is not its own."""

    def __init__(self, names: Mapping[str, str]) -> None:
        """Print names as ``names`` says."""
        self._names = names

    def text(self, value: Expression, least: int = _CHOICE) -> str:
        """Return an expression, in parentheses if it binds less tightly than ``least``."""
        text, precedence = self._text(value)
        return text if precedence >= least else f"({text})"

    def _text(self, value: Expression) -> tuple[str, int]:
        match value:
            case Number():
                return _literal(value.value), _ATOM if value.value >= 0.0 else _SIGN
            case Name():
                text = self._names.get(value.name, value.name)
                return text, _RELATION if " " in text else _ATOM
            case Negative():
                return f"-{self.text(value.operand, _SIGN)}", _SIGN
            case Binary():
                own = _PRECEDENCE[value.operator]
                left, right = self.text(value.left, own), self.text(value.right, own + 1)
                return f"{left} {value.operator} {right}", own
            case Relation():
                left, right = self.text(value.left, _SUM), self.text(value.right, _SUM)
                return f"{left} {value.operator} {right}", _RELATION
            case Logical():
                own = _OR if value.operator == "or" else _AND
                operands = (self.text(each, own + 1) for each in value.operands)
                return f" {value.operator} ".join(operands), own
            case Negation(operand=Call(function="known", arguments=(operand,))):
                return f"math.isnan({self.text(operand)})", _ATOM
            case Negation():
                return f"not {self.text(value.operand, _NOT)}", _NOT
            case Choice():
                then, test = self.text(value.then, _OR), self.text(value.condition, _OR)
                return f"{then} if {test} else {self.text(value.otherwise)}", _CHOICE
            case Call():
                return self._call(value), _NOT if value.function == "known" else _ATOM
        raise AssertionError(f"{value} is not an expression")

    def _call(self, value: Call) -> str:
        arguments = ", ".join(map(self.text, value.arguments))
        if value.function == "known":
            return f"not math.isnan({arguments})"
        if value.function == "double":
            return f"float({arguments})"
        module = "" if value.function in SHARED else "math."
        return f"{module}{value.function}({arguments})"

    def assign(self, place: str, value: Expression) -> list[str]:
        """Return the statement that stores a value, which may be what is in the place already."""
        match value:
            case Choice(condition=condition, then=then, otherwise=Name(name=kept)):
                if self._names.get(kept, kept) == place:
                    test = self.text(condition)
                    return [f"if {test}:", f"{_INDENT}{place} = {self.text(then)}"]
        return [f"{place} = {self.text(value)}"]


def _literal(value: float) -> str:
    if math.isnan(value):
        return "math.nan"
    if math.isinf(value):
        return "math.inf" if value > 0 else "-math.inf"
    return repr(value)


def class_name(row: Function) -> str:
    """Return the name of the class that keeps the memory of a function."""
    return row.python_call or "".join(word.capitalize() for word in row.name.split("_"))


def printed(row: Function) -> tuple[str, ...]:
    """Return the definitions of a row's function, those that it needs first.

    It is the row's text if it has one, else its form, printed; nothing for what Python has.
    """
    if row.python or row.python_of_unit:
        return (row.python,) if row.python else ()
    if row.step is not None:
        return (*_shared(row.step.formula), _step_class(row, row.step))
    if row.loop is not None:
        return (*_shared(row.loop.each), *_shared(row.loop.result), _loop_function(row, row.loop))
    formula = row.strict_formula
    if formula is not None:
        return (
            *_shared(formula),
            _function(function_name(row), row.variables, formula, _says(row)),
        )
    return ()


def printed_computed(function: ComputedFunction) -> tuple[str, ...]:
    """Return the definition of a function of arithmetic, those that it needs first."""
    wording = function.wording if function.zone is None else f"{function.wording} as 1 or 0"
    says = f"Return {wording}; NaN is unknown."
    text = _function(function.name, function.parameters, function.formula, says)
    return (*_shared(function.formula), text)


def printed_entries(function: EntriesFunction) -> str:
    """Return the definition of a function that counts entries."""
    names = UniqueNames(frozenset({"found", *(name for _, name in function.arrays)}))
    parameters: list[str] = []
    lengths: list[str] = []
    texts: list[str] = []
    for leaf, name in function.arrays:
        array, is_flag = names.new(name, "entries"), leaf.type.base == "bool"
        parameters.append(f"{array}: Sequence[{'bool' if is_flag else 'float'}]")
        lengths.append(f"len({array})")
        texts.append(array if is_flag else f"map(float, {array})")
    entries = ", ".join(name for _, name in function.arrays)
    alone = len(texts) == 1
    head = [f"for {entries} in {texts[0]}:"]
    if not alone:
        head = lay_out_call(4, f"for {entries} in zip(", [*texts, "strict=True"], "):")
        head = [line.removeprefix(_INDENT) for line in head]
    lines = [
        f"if {lengths[0]} == 0:" if alone else f"if not 0 < {' == '.join(lengths)}:",
        f"{_INDENT}return math.nan",
        "found = 0",
        *head,
        *lay_out(4, "if ", _logic(function.entry), ":"),
        f"{_INDENT * 2}found += 1",
        "return found",
    ]
    says = f"Return how many entries satisfy {function.wording}; NaN is unknown."
    return _definition(0, function.name, parameters, says, lines)


def printed_points(function: PointsFunction) -> str:
    """Return the definition of the function that tells which points are in a zone."""
    printer = Printer({})
    lines = [f"{name} = {printer.text(value)}" for name, value in function.inside.assignments]
    returned = render_lines(concat("return ", _mask(function.inside.result)), LINE_LENGTH, 4)
    lines += [line.removeprefix(_INDENT) for line in returned]
    says = f"Return which points are in {function.zone.name}, as seen by the scanner."
    parameters = ["x: np.ndarray", "y: np.ndarray"]
    return _definition(0, f"_{function.test}", parameters, says, lines, "np.ndarray")


def _mask(condition: Expression) -> Document:
    """Return a condition on arrays: a truth for each element."""
    if isinstance(condition, Logical):
        sign = "| " if condition.operator == "or" else "& "
        parts = join(concat(LINE, sign), map(_mask, condition.operands))
        return group("(", nest(4, SOFTLINE, parts), SOFTLINE, ")")
    return concat(f"({Printer({}).text(condition)})")


def _logic(condition: Expression) -> Logic:
    match condition:
        case Logical(operator="and", operands=operands):
            return all_of(map(_logic, operands))
        case Logical(operands=operands):
            return any_of(map(_logic, operands))
        case Negation(operand=Logical() as operand):
            return NoneOf(_logic(operand))
        case _:
            return Atom(Printer({}).text(condition))


def is_printed(row: Function) -> bool:
    """Return whether a row's function is printed from its form, and so computes with doubles."""
    return bool(printed(row)) and not row.python


def function_name(row: Function) -> str:
    """Return what text calls for a row's function."""
    return row.python_call or f"{row.name}_of"


def _says(row: Function) -> str:
    return f"Return {row.name}(), {row.gives}; NaN is unknown."


def _shared(formula: Formula) -> Iterable[str]:
    for name in calls(formula):
        if name in SHARED:
            parameters, shared = SHARED[name]
            yield _function(name, parameters, shared, f"Return the {name} value; NaN is unknown.")


def _function(name: str, parameters: tuple[str, ...], formula: Formula, says: str) -> str:
    printer = Printer({})
    lines = [
        *(f"{name} = {printer.text(value)}" for name, value in formula.assignments),
        *_returned(printer, formula.result),
    ]
    return _definition(0, name, [f"{each}: float" for each in parameters], says, lines)


def _returned(printer: Printer, value: Expression) -> list[str]:
    """Return the statements that return a value, by cases if it does not fit into a line."""
    line = f"return {printer.text(value)}"
    if not isinstance(value, Choice) or len(_INDENT) + len(line) <= LINE_LENGTH:
        return [line]
    head = [text.removeprefix(_INDENT) for text in lay_out(4, "if ", _logic(value.condition), ":")]
    body = [f"{_INDENT}{text}" for text in _returned(printer, value.then)]
    return [*head, *body, *_returned(printer, value.otherwise)]


def _step_class(row: Function, step: Step) -> str:
    fields = [each.name for each in step.memory]
    printer = Printer({name: f"self.{name}" for name in fields})
    initial = [
        f"self.{each.name} = {_literal(math.nan if each.initial is None else each.initial)}"
        for each in step.memory
    ]
    parameters = ["self", *(f"{each}: float" for each in row.variables)]
    lines: list[str] = []
    if step.is_timed:
        parameters.append("t: int")
        fields.append("last_t")
        initial.append("self.last_t: int | None = None")
        since = "(t - self.last_t) / 1e9"
        lines.append(f"{ELAPSED} = math.nan if self.last_t is None else {since}")
    for name, value in step.formula.assignments:
        place = f"self.{name}" if name in fields else name
        lines += printer.assign(place, value)
    lines += ["self.last_t = t"] if step.is_timed else []
    lines.append(f"return {printer.text(step.formula.result)}")
    slots = ", ".join(tuple_entries(map(repr, sorted(fields))))
    return "\n".join(
        [
            f"class {class_name(row)}:",
            f'{_INDENT}"""What {row.name}() remembers between messages."""',
            "",
            f"{_INDENT}__slots__ = ({slots})",
            "",
            _definition(1, "__init__", ["self"], "Remember no message.", initial, "None"),
            _definition(1, "follow", parameters, _says(row), lines),
        ]
    )


def _loop_function(row: Function, loop: Loop) -> str:
    names = {FIRST: "place == 0", COUNT: "len(values)"}
    printer = Printer(names)
    numbered = FIRST in loop.each.names
    of_elements = row.result is Result.ELEMENT
    array = "np.asarray(values, dtype=object).tolist()" if of_elements else "map(float, values)"
    head = f"place, {ELEMENT} in enumerate({array})" if numbered else f"{ELEMENT} in {array}"
    inner = [f"{name} = {printer.text(value)}" for name, value in loop.each.assignments]
    inner += printer.assign(loop.accumulator, loop.each.result)
    lines = [
        f"{loop.accumulator} = {_literal(loop.initial)}",
        f"for {head}:",
        *(f"{_INDENT}{line}" for line in inner),
        f"return {printer.text(loop.result.result)}",
    ]
    parameters = ["values: Sequence[float]", *(f"{each}: float" for each in row.variables)]
    return _definition(0, function_name(row), parameters, _says(row), lines)


def _definition(
    level: int,
    name: str,
    parameters: list[str],
    says: str,
    lines: Iterable[str],
    result: str = "float",
) -> str:
    blank = _INDENT * level
    body = f"{blank}{_INDENT}"
    head = lay_out_call(len(blank), f"def {name}(", parameters, f") -> {result}:")
    texts = [*head, f'{body}"""{_shortened(says, len(body))}"""']
    texts += [f"{body}{line}" for line in lines]
    return "\n".join([*texts, ""])


def _shortened(says: str, indent: int) -> str:
    """Return a docstring that fits into its line, by the words that do."""
    room = LINE_LENGTH - indent - len('""""""') - len("...")
    if len(says) <= room:
        return says
    lengths = [len(" ".join(says.split()[: n + 1])) for n in range(len(says.split()))]
    words = says.split()[: len(list(takewhile(lambda length: length <= room, lengths)))]
    return f"{' '.join(words)}..."


def needed_texts(function: Apply) -> tuple[str, ...]:
    """Return the names of the texts that the text of a function, or its call, needs."""
    row = FUNCTIONS[function.function]
    is_stamped = row.over_span and len(function.arguments) > 2
    return (*row.python_needs, "stamp_of") if is_stamped else row.python_needs


def length_of_quaternion(indent: int, parts: Sequence[str]) -> list[str]:
    """Return the statement that computes the length of a quaternion, as the reference does."""
    squares = join(concat(LINE, "+ "), (f"{part} * {part}" for part in parts))
    document = group("length = math.sqrt(", nest(4, SOFTLINE, squares), SOFTLINE, ")")
    return render_lines(document, LINE_LENGTH, indent)


def stamp_of_message(header: Sequence[str]) -> str:
    """Return the stamp of a message, or its time of arrival if it has no header."""
    return f"stamp_of({', '.join(header)})" if header else "t"
