"""The golden files themselves: a fault in what they leave out is found, and none is stale."""

from __future__ import annotations

import ast
import itertools
import re
import runpy
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deros.generators.api.protocol import Context, File, Files, Owner
from deros.generators.builtin import rosnode_cpp, rosnode_python, rossystem_script
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.node import NodeType
from tests.support.golden import GOLDEN, RUNTIME_FILES, Golden
from tests.support.golden_alike import Part, difference, unlike_those_before
from tests.support.golden_runtime import is_copy, without_modules
from tests.support.golden_templates import shortened, unrepeated
from tests.support.systems import CONTEXT, EVERYTHING, load

TESTS = GOLDEN.parent
VALVE = TESTS / "generators/node/python/models/valve.rnd"
HEADER = "process/include/process/runtime/managed_node.hpp"
SOURCE = "process/src/runtime/qos_report.cpp"
MODULE = "process/process/qos_report.py"


def packages() -> Files:
    """Return the packages of a node in both languages, with their copies of the runtime."""
    context = Context(InterfaceStore(), Repository())
    model = context.repository.load(VALVE).model
    assert isinstance(model, NodeType)
    return {**rosnode_cpp(model, context), **rosnode_python(model, context)}


FAULTS: dict[str, tuple[str, str, str]] = {
    "a line": (SOURCE, "return", "return  "),
    "the end": (MODULE, "\n", ""),
    "the guard": (HEADER, "PROCESS__RUNTIME__MANAGED", "DEROS_RUNTIME_CPP__MANAGED"),
    "the namespace": (SOURCE, "namespace process::runtime", "namespace deros_runtime_cpp"),
    "an include": (SOURCE, '"process/runtime/qos', '"deros_runtime_cpp/qos'),
    "another part": (MODULE, "qos", "managed"),
}
"""A file, and what its text has in place of which part of it."""


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Golden:
    """Keep the packages without a fault."""
    root = tmp_path_factory.mktemp("golden")
    Golden(refresh=True, root=root).check("valve", packages())
    return Golden(refresh=False, root=root)


def test_copies_are_listed_and_not_kept(kept: Golden) -> None:
    """The folder has the list of the copies, and none of them."""
    kept.check("valve", packages())
    folder = kept.root / "valve"
    listed = (folder / RUNTIME_FILES).read_text(encoding="utf-8").split()
    assert {HEADER, SOURCE, MODULE} <= set(listed)
    assert not [path for path in listed if (folder / path).exists()]


@pytest.mark.parametrize("refresh", [False, True])
@pytest.mark.parametrize("fault", FAULTS)
def test_copy_with_a_fault_is_found(
    fault: str, refresh: bool, kept: Golden, tmp_path: Path
) -> None:
    """Nor can a refresh accept it."""
    path, old, new = FAULTS[fault]
    files = packages()
    text = files[path].text
    faulty = replace(files[path], text=new.join(text.rsplit(old, 1)))
    assert faulty.text != text
    golden = Golden(True, tmp_path) if refresh else kept
    with pytest.raises(AssertionError, match=Path(path).name):
        golden.check("valve", {**files, path: faulty})


@pytest.mark.parametrize("changed", [{"owner": Owner.USER}, {"executable": True}])
def test_copy_that_is_written_in_another_way_is_found(
    changed: dict[str, Any], kept: Golden
) -> None:
    """It belongs to the generator, and is not a program."""
    files = packages()
    with pytest.raises(AssertionError, match=Path(MODULE).name):
        kept.check("valve", {**files, MODULE: replace(files[MODULE], **changed)})


@pytest.mark.parametrize("path", [HEADER, SOURCE, MODULE])
def test_missing_copy_is_found(path: str, kept: Golden) -> None:
    """The package would lack a part that its node needs."""
    files = packages()
    del files[path]  # type: ignore[attr-defined]
    with pytest.raises(AssertionError, match=RUNTIME_FILES):
        kept.check("valve", files)


@pytest.mark.parametrize(
    ("path", "source"),
    [
        ("process/src/runtime/text.cpp", "cpp/src/text.cpp"),
        ("process/process/waker.py", "python/deros_runtime/waker.py"),
    ],
)
def test_additional_copy_is_found(path: str, source: str, kept: Golden) -> None:
    """Whether it is a true copy or not."""
    text = Path("src/deros/generators/runtime", source).read_text(encoding="utf-8")
    text = text.replace('"deros_runtime_cpp/', '"process/runtime/')
    text = text.replace("namespace deros_runtime_cpp", "namespace process::runtime")
    with pytest.raises(AssertionError, match=RUNTIME_FILES):
        kept.check("valve", {**packages(), path: File(text)})
    with pytest.raises(AssertionError, match=Path(path).name):
        kept.check("valve", {**packages(), path: File(text + "\n")})


def test_file_beside_the_copies_is_no_copy(kept: Golden) -> None:
    """What the runtime does not have is compared with a golden file, which there is not."""
    path = "process/src/runtime/another.cpp"
    assert not is_copy(path)
    with pytest.raises(AssertionError, match="another"):
        kept.check("valve", {**packages(), path: File("")})


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("def main(", "def run("),
        ("signal.SIGKILL", "signal.SIGTERM"),
        ("\n# Finds the programs of packages", "\nimport os\n# Finds the programs of packages"),
    ],
)
def test_other_code_in_a_script_is_found(old: str, new: str) -> None:
    """Whatever differs from the modules stays in the text that is compared."""
    (file,) = rossystem_script(load(EVERYTHING), CONTEXT).values()
    changed = file.text.replace(old, new)
    assert changed != file.text
    assert without_modules(changed) != without_modules(file.text)


def test_difference_from_another_file_shows_every_change() -> None:
    """Names that differ do not; a file that is unlike the other ones stays as it is."""
    lines = "\n".join(f"line {number} of a_node" for number in range(20))
    others = Part("some/a", "apples", "a_node", {"apples/a_node.cpp": File(f"{lines}\n")})
    renamed = lines.replace("a_node", "b_node")

    def kept(text: str, owner: Owner = Owner.GENERATOR, path: str = "b_node.cpp") -> dict[str, str]:
        part = Part("some/b", "bananas", "b_node", {f"bananas/{path}": File(text, owner)})
        made = unlike_those_before("some/b", [others, part])
        return {path: "".join(file.text.splitlines(True)[1:]) for path, file in made.items()}

    like = "bananas/b_node.cpp.diff"
    assert kept(f"{renamed}\n") == {like: ""}
    changed = renamed.replace("line 7 of b_node", "line 7 of a_node")
    shown = " 7 lines\n-1 lines\n+line 7 of a_node\n 13 lines\n"
    assert kept(f"{changed}\n") == {like: shown}
    assert kept(renamed) != kept(f"{renamed}\n")
    assert list(kept("another\n")) == ["bananas/b_node.cpp"]
    assert list(kept(f"{renamed}\n", Owner.USER)) == ["bananas/b_node.cpp"]
    assert list(kept(f"{renamed}\n", path="c_node.cpp")) == ["bananas/c_node.cpp"]


@pytest.mark.parametrize("path", ["process/process/valve_base.py", "process/src/valve_base.cpp"])
def test_every_change_shows_beside_the_lines_of_templates(path: str) -> None:
    """Whether a line is from a template or not, the text without it is kept as another one."""
    text = packages()[path].text
    short = shortened(text)
    named = [
        line for line in short.splitlines() if re.match(r"… \d+ lines of base\.\w+\.j2: ", line)
    ]
    assert len(named) > 3
    assert short.count("\n") < text.count("\n")
    lines = text.splitlines(keepends=True)
    for number, line in enumerate(lines):
        rest = [*lines[:number], *lines[number + 1 :]]
        assert shortened("".join(rest)) != short, line
        rest.insert(number, f" {line}")
        assert shortened("".join(rest)) != short, line


def test_lines_of_another_golden_file_are_named() -> None:
    """Which file has them, or that they stand above; whatever differs is shown."""
    lines = [f"line {number}" for number in range(19)]
    one = "\n".join([*lines, ""])
    other = "\n".join([*lines[3:13], "own", *lines[3:11], "mine", *lines[3:10], "end", ""])
    shown = unrepeated({"some/one.py": one, "other.py": other, "third.py": f"{one}{one}"})
    assert shown["some/one.py"] == one
    assert shown["other.py"].split("\n") == [
        *("… 10 lines as in one.py: line 3", "own", "… 8 lines as in one.py: line 3", "mine"),
        *(*lines[3:10], "end", ""),
    ]
    assert shown["third.py"] == "… 19 lines as in one.py: line 0\n" * 2
    assert unrepeated({"one.py": f"{one}{one}"})["one.py"] == f"{one}… 19 lines as above: line 0\n"


_LETTERS = st.lists(st.sampled_from(["a" * 8, "bc" * 5, "abcabcdef", "d"]), max_size=6).map(
    lambda blocks: [*"".join(blocks)]
)


@given(_LETTERS, _LETTERS)
def test_repeated_lines_are_told(one: list[str], other: list[str]) -> None:
    """A text follows from those before it and from what is shown of it."""
    for path, shown in unrepeated({"one": "\n".join(one), "other": "\n".join(other)}).items():
        whole = {"one": one, "other": other}[path] or [""]
        made: list[str] = []
        for line in shown.split("\n"):
            if found := re.fullmatch(r"… (\d+) lines (?:as in one|as (above)): (.*)", line):
                before, count = made if found[2] else one, int(found[1])
                run = whole[len(made) :][:count]
                assert run[0] == found[3]
                assert run in [before[at:][:count] for at in range(len(before))]
                made += run
            else:
                made.append(line)
        assert made == whole


_SOME_LINES = st.lists(st.sampled_from(["", "a", "b", " 1 lines", "-1 lines"])).map("\n".join)


@given(_SOME_LINES, _SOME_LINES)
def test_difference_tells_all_of_a_file(text: str, other: str) -> None:
    """A file follows from the other one and the difference, so that no fault is left out."""
    rest, found = other.split("\n"), []
    for line in difference(text, other):
        if line.startswith("+"):
            found.append(line[1:])
        else:
            number = int(line.split()[0].lstrip("-"))
            found += rest[:number] if line.startswith(" ") else []
            del rest[:number]
    assert ("\n".join(found), rest) == (text, [])


# Stale files --------------------------------------------------------------------------------------


def test_each_golden_file_matches_golden_tests() -> None:
    """Some test compares each file; those of a test that is gone would never change again."""
    compared = set(itertools.chain.from_iterable(map(_compared, sorted(TESTS.rglob("test_*.py")))))
    assert compared
    stale = [
        path.relative_to(GOLDEN).as_posix()
        for path in sorted(GOLDEN.rglob("*"))
        if path.is_file()
        and not compared & {p.as_posix() for p in path.relative_to(GOLDEN).parents}
    ]
    assert stale == [], "delete these golden files"


def _compared(path: Path) -> Iterator[str]:
    """Yield the names that the tests of a module call ``golden.check`` with."""
    text = path.read_text(encoding="utf-8")
    if path == Path(__file__) or "golden.check(" not in text:
        return
    module = runpy.run_path(str(path), run_name=path.stem)
    for function in (item for item in ast.parse(text).body if isinstance(item, ast.FunctionDef)):
        marks = getattr(module[function.name], "pytestmark", ())
        given = {mark.args[0]: mark.args[1] for mark in marks if mark.name == "parametrize"}
        for call in ast.walk(function):
            if isinstance(call, ast.Call) and ast.unparse(call.func) == "golden.check":
                code = compile(ast.Expression(call.args[0]), str(path), "eval")
                for values in itertools.product(*given.values()):
                    yield eval(code, module, dict(zip(given, values, strict=True)))
