"""The text of the emitted C: warning-free, bounded, deterministic, self-contained."""

from __future__ import annotations

import functools
import re
import subprocess
from collections.abc import Mapping
from pathlib import Path
from typing import get_args

import pytest
from _pytest.mark import ParameterSet

from deros.generators.api.protocol import GenerationError
from deros.generators.monitor.c.deviations import DEVIATIONS
from deros.generators.monitor.c.interface import render_monitor
from deros.rules.functions.functions import FUNCTIONS
from deros.rules.program import walk
from deros.rules.program.ir import Apply, Condition, Program
from tests.support import c_pairs, misra
from tests.support.c_everything import NAMES, RULES, built, everything, named, texts_of
from tests.support.needs import needs

WARNINGS = ("-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Wcast-qual", "-Werror")

COMPILERS = {
    "gcc": ("gcc", "-std=c99"),
    "gcc, optimising": ("gcc", "-std=c99", "-O2"),
    "gcc, C++": ("gcc", "-x", "c++", "-std=c++17"),
    "clang": ("clang", "-std=c99"),
    "clang, C++": ("clang", "-x", "c++", "-std=c++17"),
    "Cortex-M4": ("arm-none-eabi-gcc", "-std=c99", "-ffreestanding", "-mcpu=cortex-m4"),
}

LIBM = {"fabs", "sqrt", "sin", "cos", "sincos", "tan", "atan2", "asin", "fmod", "remainder"}
"""Functions of the mathematical library that rules may use; compilers make ``sincos`` of two."""


def _compiler(name: str) -> ParameterSet:
    """Return a parameter of tests: a compiler, of which one alone is quick."""
    marks = [needs(COMPILERS[name][0]), *([] if name == "gcc" else [pytest.mark.slow])]
    return pytest.param(name, marks=marks)


@functools.cache
def random_texts() -> tuple[Mapping[str, str], ...]:
    """Return the texts of some random programs of all kinds."""
    return tuple(
        each.unit.texts
        for number, kinds in enumerate(c_pairs.FOCUSES.values())
        for each in c_pairs.cases(kinds, 4, 2, traces=1, first=100 * number)
    )


def compiled(texts: Mapping[str, str], folder: Path, command: tuple[str, ...], *flags: str) -> None:
    """Compile monitors to objects in a folder, with warnings as errors."""
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    done = subprocess.run(
        [*command, *WARNINGS, *flags, "-c", *(name for name in texts if name.endswith(".c"))],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("compiler", [_compiler(name) for name in COMPILERS])
def test_all_compilers_accept_the_code_without_warnings(compiler: str, tmp_path: Path) -> None:
    """This holds for every compiler and any rules."""
    drawn = {name: text for each in random_texts() for name, text in each.items()}
    compiled(_texts_of_programs() | drawn, tmp_path, COMPILERS[compiler])


@pytest.fixture(scope="module")
def built_for_debugging(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of the objects that are not optimised, and of their stack use."""
    folder = tmp_path_factory.mktemp("debugging")
    flags = ("-O0", "-fstack-usage", "-fcallgraph-info")
    compiled(_texts_of_programs(), folder, ("gcc", "-std=c99"), *flags)
    return folder


@pytest.fixture(scope="module")
def built_for_use(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of the optimised objects."""
    folder = tmp_path_factory.mktemp("use")
    compiled(_texts_of_programs(), folder, ("gcc", "-std=c99", "-O1"))
    return folder


def _texts_of_programs() -> dict[str, str]:
    return {file: text for name in NAMES for file, text in texts_of(name).items()}


@needs("gcc", "nm")
@pytest.mark.parametrize("name", NAMES)
def test_monitor_needs_only_its_callback_and_libm(name: str, built_for_use: Path) -> None:
    """It links with the callback of its user and functions of the mathematical library."""
    command = ["nm", "-u", str(built_for_use / f"{name}_monitor.o")]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    needed = set(re.findall(r"\bU (\w+)", done.stdout))
    assert needed - LIBM == {f"{name}_emit"}


@needs("gcc", "nm")
@pytest.mark.parametrize("name", NAMES)
def test_other_symbols_are_not_exported(name: str, built_for_debugging: Path) -> None:
    """All exported names have the prefix, so that several monitors link together."""
    command = ["nm", "-g", "--defined-only", str(built_for_debugging / f"{name}_monitor.o")]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    defined = re.findall(r"\b[A-Z] (\w+)", done.stdout)
    assert defined
    assert all(each.startswith(f"{name}_") for each in defined)


@needs("gcc")
@pytest.mark.parametrize("name", NAMES)
def test_stack_is_bounded(name: str, built_for_debugging: Path) -> None:
    """No function has dynamic or large stack use, and none is recursive."""
    usage = (built_for_debugging / f"{name}_monitor.su").read_text().splitlines()
    sizes = [line.split("\t")[1:] for line in usage]
    assert sizes
    assert {kind for _, kind in sizes} == {"static"}
    assert max(int(size) for size, _ in sizes) <= 512
    graph = (built_for_debugging / f"{name}_monitor.ci").read_text()
    edges = re.findall(r'edge: \{ sourcename: "([^"]*)" targetname: "([^"]*)"', graph)
    assert edges
    assert _is_acyclic(edges)


def _is_acyclic(edges: list[tuple[str, str]]) -> bool:
    """Return whether each function calls only later ones in some order."""
    left = set(edges)
    while left:
        callers = {caller for caller, _ in left}
        settled = {edge for edge in left if edge[1] not in callers}
        if not settled:
            return False
        left -= settled
    return True


def test_recursion_is_detected() -> None:
    """Direct and indirect recursion are distinguished from ordinary calls."""
    assert _is_acyclic([("a", "b"), ("b", "c"), ("a", "c")])
    assert not _is_acyclic([("a", "b"), ("b", "a"), ("b", "c")])


@pytest.mark.parametrize("name", NAMES)
def test_lines_are_at_most_99_characters(name: str) -> None:
    """Only contracts may have longer lines."""
    for text in texts_of(name).values():
        plain = re.sub(r"/\*@.*?\*/", "", text, flags=re.DOTALL)
        assert max(map(len, plain.splitlines())) <= 99


def test_rendering_is_deterministic() -> None:
    """Two renderings of one program are equal, and contain no path of this machine."""
    texts = [texts_of("everything"), render_monitor(everything())]
    assert texts[0] == texts[1]
    assert "/tmp" not in "".join(texts[0].values())


@needs("cppcheck")
@pytest.mark.slow
def test_code_follows_misra(tmp_path: Path) -> None:
    """The only violations of MISRA C:2012 are the advisory ones that the text lists."""
    texts = [texts_of(name) for name in NAMES]
    violations = misra.violations(texts, tmp_path)
    assert [str(each) for each in violations if not each.is_allowed] == []
    assert any(each.is_allowed for each in violations)


@needs("cppcheck")
def test_misra_check_is_effective(tmp_path: Path) -> None:
    """A violated required rule is detected and distinguished from an advisory one."""
    text = "#define UNUSED 1\nint f(int a);\nint f(int a)\n{\n  return a + 017;\n}\n"
    violations = misra.violations([{"wrong.c": text}], tmp_path)
    assert {"required", "advisory"} == {each.category for each in violations}
    assert not any(each.is_allowed for each in violations)


def test_deviations_are_listed_in_the_source() -> None:
    """The header of every source lists each guideline that it deviates from, all advisory."""
    for program in map(named, NAMES):
        source = texts_of(program.name)[f"{program.name}_monitor.c"]
        head = " ".join(source[: source.index("*/")].replace(" * ", " ").split())
        for each in DEVIATIONS:
            is_one = bool(program.tunables) or not each.of_constants
            assert (f"{each.guideline}: {each.reason}" in head) == is_one
    assert misra.ALLOWED <= misra.ADVISORY


REFUSED = {
    "two strings read from messages": ("both: state = names_of;", "two texts"),
    "a rate of 64 bits": ("quick: ticks.rate() > 1;", "rate() of a 64-bit"),
    "a rate over a span of 64 bits": ("quick: ticks.rate(1 sec) > 1;", "rate() of a 64-bit"),
    "a previous value of 64 bits": ("quick: ticks.previous() > 1;", "previous() of a 64-bit"),
    "a 64-bit integer and another": ("like: ticks > beats;", "of another type"),
    "a long duration": ("long: enabled for 60000 d;", "146 years"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_unsupported_construct_is_an_error(case: str) -> None:
    """The diagnostic points at rules that C or a monitor of fixed size does not support."""
    rule, why = REFUSED[case]
    named = "input names_of = topic /joints.header.frame_id\n"
    rules = RULES.replace("entity drive {", f"{named}entity drive {{\n  {rule}", 1)
    with pytest.raises(GenerationError) as raised:
        render_monitor(_program(rules))
    (diagnostic,) = raised.value.diagnostics
    assert (diagnostic.code.name, why in diagnostic.message) == ("DRS402", True)
    assert diagnostic.span.text.startswith(rule[:4])


def _program(rules: str) -> Program:
    return built(rules, "refused")


def test_test_program_has_every_construct() -> None:
    """New constructs of the language must be compiled, linted and compared as well."""
    conditions = list(walk.conditions(everything()))
    called = {
        term.function
        for value in walk.values(conditions)
        for term in walk.terms(value)
        if isinstance(term, Apply)
    }
    computed = {
        row.name
        for row in FUNCTIONS.values()
        if row.evaluate or row.is_stateful or row.formula or row.python
    }
    assert called == computed - {"points"}  # which only causes tell
    assert {type(each) for each in conditions} == set(get_args(Condition))
