"""The arguments of the system: what may be given, and what it means."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
import re
import sys
from types import SimpleNamespace

from .command import main
from .node import Inside, Preparation, Row, Scalar
from .supervisor import Supervisor

_NUMBER = {
    int: re.compile(r'[+-]?\d+', re.ASCII),
    float: re.compile(r'[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?|[+-]?inf', re.ASCII),
}
_NAMESPACE = re.compile(r'\w+(?:/\w+)*', re.ASCII)
_NAME = re.compile(r'(?:~?/)?\w+(?:/\w+)*', re.ASCII)
_TRUTH = {'true': True, 'false': False}
_ASSIGNMENT = re.compile(r'[A-Za-z_]\w*:=', re.ASCII)


@dataclass(frozen=True)
class Argument:
    """One argument of the system."""

    name: str
    kind: type[bool] | type[int] | type[float] | type[str]
    # A function gets the arguments before this one, and where the script is started.
    default: Scalar | Callable[..., Scalar] | None = None  # None: it has to be given
    choices: tuple[Scalar, ...] = ()
    interval: str = ''  # such as [0.0, 2.0) or >= 0.1
    least_size: int = 0  # characters of a text
    most_size: int | None = None
    in_names: bool = False  # names of topics and services are made of it
    in_namespaces: bool = False
    may_be_empty: bool = False  # these names are right without it, too
    unit: str = ''
    description: str = ''
    default_text: str = ''  # of a function

    def read(self, text: str) -> Scalar:
        """Return the value that a text stands for; raise ValueError if it is none."""
        value: Scalar = text
        if self.kind is bool:
            if text.lower() not in _TRUTH:
                raise ValueError(f'{text!r} is not true or false')
            value = _TRUTH[text.lower()]
        elif self.kind is not str:
            if not _NUMBER[self.kind].fullmatch(text):
                raise ValueError(f'{text!r} is not {self._called}')
            value = self.kind(text)
        return self._checked(value)

    def computed(self, given: Mapping[str, Scalar], context: Sequence[object]) -> Scalar | None:
        """Return the default, computed from arguments that are known before; None without one."""
        if not callable(self.default):
            return self.default
        return self._checked(self.default(SimpleNamespace(**given), *context))

    def _checked(self, value: Scalar) -> Scalar:
        for fault in self._faults(value):
            raise ValueError(fault)
        return value

    def _faults(self, value: Scalar) -> Iterator[str]:
        if self.choices and value not in self.choices:
            yield f'{shown(value)} is not one of {", ".join(map(shown, self.choices))}'
        if isinstance(value, str):
            if len(value) < self.least_size:
                yield f'{shown(value)} has less than {self.least_size} characters'
            if self.most_size is not None and len(value) > self.most_size:
                yield f'{shown(value)} has more than {self.most_size} characters'
            if self.may_be_empty and not value:
                return
            if self.in_namespaces and not _NAMESPACE.fullmatch(value):
                yield f'{shown(value)} is not a relative namespace such as front or arm/left'
            elif self.in_names and not _NAME.fullmatch(value):
                yield f'{shown(value)} is not a name such as scan, front/scan or /scan'
        elif _is_too_large(value):
            yield f'{value} is no integer of 64 bits'
        elif self.interval and not _is_within(value, self.interval):
            yield f'{shown(value)} is outside {self.interval}'

    @property
    def _called(self) -> str:
        return {bool: 'a bool', int: 'an integer', float: 'a number', str: 'a text'}[self.kind]

    def summary(self) -> str:
        """Return what may be given for it, and what it is for."""
        parts = [{bool: 'bool', int: 'integer', float: 'double', str: 'string'}[self.kind]]
        if self.unit:
            parts[0] += f' in {self.unit}'
        if self.choices:
            parts.append(f'one of {", ".join(map(shown, self.choices))}')
        if self.interval:
            parts.append(f'{"in " * (self.interval[0] in "([")}{self.interval}')
        default = self.default_text if callable(self.default) else shown(self.default)
        has = self.default is not None
        parts.append(f'default {default}' if has else 'has to be given')
        about = f': {self.description}' if self.description else ''
        return f'{", ".join(parts)}{about}'


def _is_within(value: float, interval: str) -> bool:
    """Return whether a number is in an interval, as texts such as [0.0, 2.0) or >= 0.1 say."""
    if interval[0] in '<>':
        operator, bound = interval.split()
        if value == float(bound):
            return operator.endswith('=')
        return (value > float(bound)) == (operator[0] == '>')
    lower, upper = (float(each) for each in interval[1:-1].split(','))
    return (lower < value < upper) or (
        (value == lower and interval[0] == '[') or (value == upper and interval[-1] == ']')
    )


def shown(value: Scalar | None) -> str:
    """Return a value as it is given."""
    if isinstance(value, bool):
        return 'true' if value else 'false'
    return str(value) if value != '' else "''"


def main_with_arguments(
    system: str,
    declared: Sequence[Argument],
    nodes: Callable[..., Sequence[Row]],
    arguments: Sequence[str] | None = None,
    program: str | None = None,
    start: object = None,
    supervisor: type[Supervisor] | None = None,
    preparation: Preparation | None = None,
) -> int:
    """
    Run the nodes that there are for the given arguments, and return the exit code.

    Where something is looked up, start says where that is: nodes and defaults get it, too.
    """
    words = sys.argv[1:] if arguments is None else arguments
    assigned = [word for word in words if _ASSIGNMENT.match(word)]
    others = [word for word in words if not _ASSIGNMENT.match(word)]
    about = about_arguments(declared)
    if {'-h', '--help'} & set(others):
        return main(system, (), ['--help'], program, about)
    try:
        context = () if start is None else (start,)
        started = nodes(given(declared, assigned, context), *context)
        check_rows(started)
    except (ValueError, ArithmeticError) as fault:
        print(f'{program or Path(sys.argv[0]).name}: error: {fault}', file=sys.stderr)
        return 2
    return main(system, started, others, program, about, supervisor, preparation)


def check_rows(rows: Sequence[Row]) -> None:
    """Raise ValueError where ROS 2 rejects a name or an integer that is made of values."""
    for row in rows:
        names = (name for named in (row, *row.inside) for name in _names(named))
        for wrong in (name for name in names if not _is_name(name)):
            raise ValueError(
                f'ROS 2 rejects the name {wrong!r} of {row.full_name}: a part between two / is '
                'empty, starts with a digit, or has more than letters, digits and _'
            )
        for named in (row, *row.inside):
            for name, value in getattr(named, 'parameters', {}).items():
                items = value if isinstance(value, list | tuple) else (value,)
                for wrong in (each for each in items if _is_too_large(each)):
                    raise ValueError(
                        f'parameter {name!r} of {named.full_name}: '
                        f'{wrong} is no integer of 64 bits'
                    )


def _names(named: Row | Inside) -> Iterator[str]:
    yield getattr(named, 'namespace', '/')
    for pair in getattr(named, 'remappings', {}).items():
        yield from pair
    if container := getattr(named, 'container', ''):
        yield container


def _is_too_large(value: Scalar) -> bool:
    return isinstance(value, int) and not -(2**63) <= value < 2**63


def _is_name(name: str) -> bool:
    path = name.rpartition('://')[2]
    parts = path.removeprefix('~').removeprefix('/').split('/')
    return path in ('/', '~') or all(each.isascii() and each.isidentifier() for each in parts)


def when(condition: bool, row: Callable[[], Row]) -> tuple[Row, ...]:
    """Return the row if the condition holds; what it is made of is asked for only then."""
    return (row(),) if condition else ()


def about_arguments(declared: Sequence[Argument]) -> str:
    """Return the part of the help that lists the arguments."""
    if not declared:
        return ''
    width = max(len(each.name) for each in declared)
    lines = [f'  {each.name:{width}}  {each.summary()}' for each in declared]
    return '\n'.join(['arguments of the system, given as NAME:=VALUE:', *lines, '', ''])


def given(
    declared: Sequence[Argument], words: Sequence[str], context: Sequence[object] = ()
) -> SimpleNamespace:
    """Return the values of all arguments, given as NAME:=VALUE; raise ValueError on faults."""
    known = {each.name: each for each in declared}
    values: dict[str, Scalar] = {}
    for word in words:
        name, _, text = word.partition(':=')
        if name not in known:
            listed = ', '.join(known) or 'it has none'
            raise ValueError(f'the system has no argument {name!r}; its arguments: {listed}')
        if name in values:
            raise ValueError(f'argument {name!r} is given twice')
        try:
            values[name] = known[name].read(text)
        except ValueError as fault:
            raise ValueError(f'argument {name!r}: {fault}') from None
    found: dict[str, Scalar] = {}
    for name, argument in known.items():
        try:
            value = values[name] if name in values else argument.computed(found, context)
        except ValueError as fault:
            raise ValueError(f'default of argument {name!r}: {fault}') from None
        if value is None:
            raise ValueError(f'argument {name!r} has to be given ({argument.summary()})')
        found[name] = value
    return SimpleNamespace(**found)
