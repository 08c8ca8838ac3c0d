"""Elements of C++ text: names, literals and comments that no input can break."""

from __future__ import annotations

import random
import subprocess
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deros.generators.text.cpp import (
    LINE_LENGTH,
    Call,
    Chain,
    Expression,
    Items,
    Table,
    Text,
    call,
    comment,
    cpp_double,
    cpp_identifier,
    cpp_int64,
    cpp_string,
    expression,
    standard_headers,
    statement,
    tidied,
)
from tests.support.cpp import compile_cpp
from tests.support.needs import needs


@pytest.mark.parametrize(
    ("name", "identifier"),
    [
        ("/fmInformation/imu", "fmInformation_imu"),
        ("~/state", "state"),
        ("pid.p", "pid_p"),
        ("class", "class_"),
        ("errno", "errno_"),
        ("_hidden__twice_", "hidden_twice"),
        ("3d", "x3d"),
        ("lambda", "lambda"),
        ("_", "x"),
    ],
)
def test_identifiers_are_valid(name: str, identifier: str) -> None:
    """ROS 2 names become names that C++ neither reserves nor rejects."""
    assert cpp_identifier(name) == identifier


@needs("c++")
def test_literals_keep_their_value(tmp_path: Path) -> None:
    """The compiler reads the same bytes, doubles and integers."""
    chosen = random.Random(1)
    alphabet = '?"\\\n\t\0ü€ %{}/=<>()a1\x7f\U0001f916'
    texts = ["".join(chosen.choices(alphabet, k=chosen.randint(0, 60))) for _ in range(200)]
    doubles = [0.1, -0.0, 1e300, 5e-324, 1e22, -2.5, float("inf"), float("-inf")]
    integers = [0, -1, 2**31, -(2**31), 2**63 - 1, -(2**63)]
    # Literals on several lines cannot contain NUL, which no description does.
    broken = ["word " * 40 + text.replace("\0", "") for text in texts[:50]]
    lines = [
        "#include <cinttypes>",
        "#include <cstdint>",
        "#include <cstdio>",
        "#include <limits>",
        "#include <string>",
        "void put(const std::string & text) {",
        '  for (const char c : text) {std::printf("%02x", static_cast<unsigned char>(c));}',
        '  std::puts("");',
        "}",
        "int main() {",
        *(f"  put({cpp_string(text)});" for text in texts),
        *("  put(\n    " + expression(Text(text), 4) + ");" for text in broken),
        *(f'  std::printf("%a\\n", {cpp_double(value)});' for value in doubles),
        *(f'  std::printf("%" PRId64 "\\n", int64_t{{{cpp_int64(v)}}});' for v in integers),
        "}",
    ]
    source = tmp_path / "literals.cpp"
    source.write_text("\n".join(lines) + "\n", encoding="utf-8")
    program = compile_cpp([source], tmp_path / "literals")
    output = subprocess.run([program], capture_output=True, text=True, check=True).stdout
    printed = output.splitlines()
    count = len(texts) + len(broken)
    assert [bytes.fromhex(line).decode() for line in printed[:count]] == [*texts, *broken]
    printed_doubles = printed[count : count + len(doubles)]
    assert [line if "inf" in line else float.fromhex(line) for line in printed_doubles] == [
        str(value) if "inf" in str(value) else value for value in doubles
    ]
    assert [int(line) for line in printed[count + len(doubles) :]] == integers


@given(st.text(max_size=300))
def test_text_cannot_leave_its_comment(text: str) -> None:
    """Every line is a comment line, and none continues into the next."""
    written = comment(text, 4)
    for line in written.splitlines() if written else ():
        assert line.lstrip().startswith("///")
        assert not line.endswith("\\")
        assert "??/" not in line
    assert len(written.split("\n")) == len(written.splitlines()) or not written


def test_long_calls_are_broken_at_their_arguments() -> None:
    """Arguments are on one line below the head if they fit, else one per line."""
    short, long = "a" * 30, "b" * 60
    assert call("f", [short, None, short], 2) == f"f({short}, {short});"
    assert call("f", [long, short], 2) == f"f({long}, {short});"
    assert call(f"f{long}", [long, short], 2) == f"f{long}(\n    {long}, {short});"
    nested = Call("g", (long, long))
    assert call("f", [nested, short], 2).splitlines() == [
        "f(",
        "    g(",
        f"      {long},",
        f"      {long}),",
        f"    {short});",
    ]


def test_long_type_is_on_its_own_line() -> None:
    """The function name follows on the next line."""
    kind = f"std::vector<{'T' * 80}>"
    assert call(f"{kind} name", ["int a"], 2, ";").splitlines() == [kind, "  name(", "    int a);"]


def test_chains_and_items_are_broken_at_their_parts() -> None:
    """Long chains and long lists have one part per line."""
    part = f".with({'x' * 40})"
    assert expression(Chain("QoS(1)", (part,)), 4) == f"QoS(1){part}"
    assert expression(Chain("QoS(1)", (part, part)), 4, ",").splitlines() == [
        "QoS(1)",
        f"    {part}",
        f"    {part},",
    ]
    item = '"' + "x" * 60 + '"'
    assert statement("const auto list =", Items((item, item)), 2).splitlines() == [
        "const auto list = {",
        f"    {item},",
        f"    {item}}};",
    ]


_words = st.text("ab", min_size=1, max_size=50)
_expressions: st.SearchStrategy[Expression] = st.recursive(
    st.one_of(
        _words,
        st.lists(_words, min_size=1, max_size=4).map(lambda parts: Chain("", tuple(parts), " &&")),
        st.lists(_words, min_size=1, max_size=4).map(lambda items: Items(tuple(items))),
        st.lists(_words, max_size=4).map(lambda rows: Table(tuple(rows))),
    ),
    lambda inner: st.builds(Call, _words, st.lists(inner, max_size=4).map(tuple)),
    max_leaves=8,
)


@given(_expressions, st.integers(0, 30))
def test_layout_changes_white_space_only(value: Expression, indent: int) -> None:
    """However an expression is broken, its lines fit and hold the same tokens."""
    text = expression(value, indent, ";")
    assert all(len(line) <= LINE_LENGTH for line in (" " * indent + text).splitlines())
    one_line = expression(value, -10_000, ";")  # so far to the left that everything fits
    assert "\n" not in one_line
    # Only a table has a comma behind its last row where it is broken.
    assert "".join(text.split()).replace(",}", "}") == "".join(one_line.split())


@given(st.lists(st.text("ab ", min_size=1), min_size=1, max_size=20))
def test_broken_strings_fit_the_line(words: list[str]) -> None:
    """No piece of a broken string is longer than a line, unless a word is."""
    text = " ".join(words)
    lines = expression(Text(text), 6, ";").splitlines()
    longest = max(map(len, text.split()), default=0)
    assert longest > 60 or all(len(line.strip()) + 6 <= LINE_LENGTH for line in lines)


def test_headers_match_the_used_names() -> None:
    """A name of the standard library adds its header, once and in order."""
    text = "std::vector<std::string> x; std::unique_ptr<int> y = std::move(z); int64_t n;"
    assert standard_headers(text) == ["cstdint", "memory", "string", "utility", "vector"]
    assert standard_headers("int main() {}") == []


def test_empty_sections_and_lines_are_removed() -> None:
    """An empty section is dropped, and no two empty lines are adjacent."""
    text = "class A\n{\npublic:\n  A();\n\nprotected:\n\nprivate:\n  int a_;\n\n\n  int b_;\n\n};\n"
    assert tidied(text) == "class A\n{\npublic:\n  A();\n\nprivate:\n  int a_;\n\n  int b_;\n};\n"
