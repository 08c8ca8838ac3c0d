"""Defaults and lists of words are declared in one place."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

import pytest

SOURCE = Path(__file__).resolve().parent.parent / "src" / "deros"
RUNTIME = SOURCE / "generators" / "runtime"
GENERATED = (RUNTIME, SOURCE / "generators" / "system" / "script" / "standalone")
"""Folders whose files go out as text: they import nothing of deros."""

ALLOWED = {"LARGEST", "LINE_LENGTH", "COMPARED"}
"""Names of limits that only happen to be equal: of different files, languages and lists."""

FEWEST_WORDS = 5
"""Shorter lists of words may be equal by accident."""

Declarations = Mapping[str, Mapping[str, Any]]
"""The constants of each module, by name."""


def constants(text: str) -> Iterator[tuple[str, Any]]:
    """Yield the constants of a module: names, and values if they follow from its text."""
    for statement in ast.parse(text).body:
        if isinstance(statement, ast.Assign) and len(statement.targets) == 1:
            target: ast.expr = statement.targets[0]
        elif isinstance(statement, ast.AnnAssign):
            target = statement.target
        else:
            continue
        if isinstance(target, ast.Name) and statement.value is not None:
            value = computed(statement.value)
            if value is not None:
                yield target.id.lstrip("_"), value


def computed(expression: ast.expr) -> Any:
    """Return the value of an expression of literals and a few builtins, else ``None``."""
    known = {"frozenset": frozenset, "set": set, "Fraction": Fraction}
    if any(isinstance(n, ast.Name) and n.id not in known for n in ast.walk(expression)):
        return None
    try:
        code = compile(ast.Expression(expression), "constant", "eval")
        return eval(code, {"__builtins__": {}, **known})
    except Exception:
        return None


@cache
def declared() -> Declarations:
    """Return the constants of all imported modules."""
    return {
        str(path.relative_to(SOURCE)): dict(constants(path.read_text(encoding="utf-8")))
        for path in sorted(SOURCE.rglob("*.py"))
        if not any(folder in path.parents for folder in GENERATED)
    }


def repeated_numbers(modules: Declarations) -> dict[str, list[str]]:
    """Return the modules that declare a number under the same name, by name and number."""
    places: dict[str, list[str]] = {}
    for module, values in modules.items():
        for name, value in values.items():
            is_number = isinstance(value, int | float | Fraction) and not isinstance(value, bool)
            if is_number and name.isupper() and name not in ALLOWED:
                places.setdefault(f"{name} = {value}", []).append(module)
    return {number: found for number, found in places.items() if len(found) > 1}


def repeated_words(modules: Declarations) -> dict[str, list[str]]:
    """Return declarations of the same words, in any order and under any name."""
    places: dict[str, list[str]] = {}
    for module, values in modules.items():
        for name, value in values.items():
            words = words_of(value)
            if len(words) >= FEWEST_WORDS:
                places.setdefault(" ".join(sorted(words)), []).append(f"{module}: {name}")
    return {words: found for words, found in places.items() if len(found) > 1}


def words_of(value: Any) -> frozenset[str]:
    """Return the words of a collection; of a mapping, its items."""
    if isinstance(value, dict):
        return frozenset(f"{key}:{item}" for key, item in value.items())
    if isinstance(value, str):
        words = value.split()
        return frozenset(words if all(word.isidentifier() for word in words) else ())
    if isinstance(value, tuple | list | set | frozenset):
        return frozenset(value) if all(isinstance(word, str) for word in value) else frozenset()
    return frozenset()


@pytest.mark.essential
def test_no_two_modules_declare_the_same_default() -> None:
    """A default or limit used by two modules is imported by one of them."""
    assert repeated_numbers(declared()) == {}


@pytest.mark.essential
def test_no_two_modules_declare_the_same_words() -> None:
    """This covers keywords, operators and names of hooks."""
    assert repeated_words(declared()) == {}


def test_repeats_are_found() -> None:
    """Other names of the words and other spellings of the number do not hide them."""
    one = dict(constants('MAX_GOALS = 8\n_WORDS = frozenset("a b c d e".split())\n'))
    other = dict(constants('_MAX_GOALS: int = 2**3\nLIST = ("e", "d", "c", "b", "a")\n'))
    modules = {"one.py": one, "other.py": other}
    assert repeated_numbers(modules) == {"MAX_GOALS = 8": ["one.py", "other.py"]}
    assert repeated_words(modules) == {"a b c d e": ["one.py: WORDS", "other.py: LIST"]}


@pytest.mark.parametrize(
    ("pattern", "homes"),
    [
        pytest.param(
            r"def \w*duration_text\b|def whole_nanoseconds\b",
            {"interfaces/durations.py"},
            id="durations",
        ),
        pytest.param(r'10\*\*\d, "[mu]s"', {"interfaces/durations.py"}, id="units of time"),
        pytest.param(
            r"\bPUBLISH_HZ\b.* = ", {"systems/safety_nodes.py"}, id="rate of the heartbeat"
        ),
        pytest.param(r"depth: float \| None = ", {"models/qos.py"}, id="depth of QoS"),
    ],
)
def test_each_default_has_one_home(pattern: str, homes: set[str]) -> None:
    """One module reads and shows durations; the default rate and depth have one home each."""
    occurrences = {
        str(path.relative_to(SOURCE))
        for path in sorted(SOURCE.rglob("*.py"))
        if re.search(pattern, path.read_text(encoding="utf-8"))
        and not any(folder in path.parents for folder in GENERATED)
    }
    assert occurrences == homes


def test_templates_set_no_default_depth() -> None:
    """The depth of a topic without QoS comes from the default profile."""
    templates = SOURCE.joinpath("generators", "node").rglob("*.j2")
    assert [path.name for path in templates if re.search(r"or '\d+'", path.read_text())] == []


# Constants of both runtimes -----------------------------------------------------------------------

_PYTHON = re.compile(r"^([A-Z][A-Z_]+) = ([\d_]+|'[^']*')(?=\s|$)", re.MULTILINE)
_CPP = re.compile(r"constexpr (?:const )?[\w:]+(?: \*)? ([A-Z][A-Z_]+) = ([\d']+|\"[^\"]*\");")


def shared_constants() -> dict[str, tuple[set[str], set[str]]]:
    """Return the constants of each module that exists in both runtimes, in Python and in C++."""
    values: dict[str, tuple[set[str], set[str]]] = {}
    for path in sorted((RUNTIME / "python").rglob("*.py")):
        sources = [
            source
            for suffix in ("cpp", "hpp")
            for source in (RUNTIME / "cpp").rglob(f"{path.stem}.{suffix}")
        ]
        in_python = dict(_PYTHON.findall(path.read_text(encoding="utf-8")))
        text = "\n".join(source.read_text(encoding="utf-8") for source in sources)
        in_cpp = dict(_CPP.findall(text))
        for name in in_python.keys() & in_cpp.keys():
            key = f"{path.stem}.{name}"
            values[key] = ({plain(in_python[name])}, {plain(in_cpp[name])})
    return values


def plain(literal: str) -> str:
    """Return a literal without the separators and quotes of its language."""
    return re.sub(r"[_']", "", literal) if literal[0].isdigit() else literal.strip("'\"")


def test_both_runtimes_have_the_same_constants() -> None:
    """The packages share no code, so constants declared in both must be equal."""
    shared = shared_constants()
    assert shared.pop("latches.UNIQUE") == ({"8"}, {"2"})  # bytes, and words of four bytes
    assert {name for name, (python, cpp) in shared.items() if python != cpp} == set()
    assert shared.keys() >= {"gate_report.PERIOD", "latches.HEAD", "start_order.YOUNG"}
