"""Python text within ament's line length, and strict templates."""

from __future__ import annotations

import ast

import jinja2
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deros.generators.text.prose import printable_line, sentence
from deros.generators.text.python import (
    LINE_LENGTH,
    Call,
    Text,
    call,
    import_lines,
    lay_out_call,
    mark_long_lines,
    wrapped,
)
from deros.generators.text.templates import environment, xml_text

LONG = "n" * 120


def test_imports_are_in_the_order_of_ament() -> None:
    """Modules and names are sorted ignoring case; ``import x`` is sorted among them."""
    imports = {"rclpy.qos": ["QoSProfile", "qos_profile_sensor_data"], "rclpy": [], "b": ["B", "a"]}
    assert import_lines(imports) == [
        "from b import a, B",
        "import rclpy",
        "from rclpy.qos import qos_profile_sensor_data, QoSProfile",
    ]


def test_long_imports_are_broken() -> None:
    """An import that does not fit has one name per line."""
    names = [f"name_{number}_of_many" for number in range(6)]
    lines = import_lines({"module": names})
    assert lines == ["from module import (", *(f"    {name}," for name in names), ")"]


def test_call_that_fits_stays_on_one_line() -> None:
    """None arguments are omitted, and a tail follows the parenthesis."""
    assert call("f", ["1", None, Text("t=", "x"), Call("g", ("2",), ".value")], 4) == (
        "f(1, t='x', g(2).value)"
    )


@given(
    st.lists(st.text("ab '\"\\\t\n", max_size=150), min_size=1, max_size=4),
    st.integers(min_value=0, max_value=5),
)
def test_broken_call_has_the_same_value(texts: list[str], depth: int) -> None:
    """Whatever the arguments, the lines fit and evaluate to the same strings."""
    indent = 4 * depth
    text = call(
        "tuple", [Call("list", (Call("", tuple(Text("", t) for t in [*texts, ""])),))], indent
    )
    assert list(eval(text)) == [*texts, ""]  # the text is generated here
    words = [word for t in texts for word in t.split()]
    if all(len(repr(word)) < 40 for word in words):
        assert all(len(line) <= LINE_LENGTH for line in f"{' ' * indent}{text}".splitlines())


def test_broken_text_keeps_tabs_and_line_breaks() -> None:
    """A text is cut only; none of its white space is replaced."""
    text = "word\tword\n  word " * 10
    broken = call("str", [Text("", text)], 4)
    assert broken.count("\n") > 2
    assert eval(broken) == text  # the text is our own


@given(
    st.lists(st.text("abc", min_size=1, max_size=50), max_size=12),
    st.integers(min_value=0, max_value=5),
)
def test_filled_call_has_the_same_value(names: list[str], depth: int) -> None:
    """For any number of arguments the lines fit and parse as the call with a trailing comma."""
    indent = 4 * depth
    lines = lay_out_call(indent, "value = function(", names)
    assert all(len(line) <= LINE_LENGTH for line in lines)
    assert all(line.startswith(" " * indent) for line in lines)
    parsed = ast.dump(ast.parse("\n".join(line[indent:] for line in lines)))
    assert parsed == ast.dump(ast.parse(f"value = function({', '.join(names)})"))
    assert len(lines) == 1 or lines[-2].endswith(",")


def test_only_long_lines_are_marked() -> None:
    """Code, comments and multi-line strings get the mark where flake8 expects it."""
    text = f'x = 1\n# {LONG}\n{LONG} = 2\ny = """\n{LONG}\n"""\n'
    assert mark_long_lines(text).splitlines() == [
        "x = 1",
        f"# {LONG}  # noqa: E501",
        f"{LONG} = 2  # noqa: E501",
        'y = """',
        LONG,
        '"""  # noqa: E501',
    ]


def test_short_text_is_unchanged() -> None:
    """Text without a long line is returned as it is."""
    assert mark_long_lines("x = 1\n") == "x = 1\n"


@given(st.text(max_size=60))
def test_sentence_fits_into_a_docstring(text: str) -> None:
    """Any description can be placed between three quotes, on one line."""
    line = sentence(text)
    assert "\n" not in line
    assert ast.literal_eval(f'"""{line}"""') == line


@pytest.mark.parametrize(
    ("text", "expected"),
    [("turns ticks", "Turns ticks."), ("Really?", "Really?"), ("", ""), ("a\n  b\x00c", "A b c.")],
)
def test_sentences_have_a_capital_and_punctuation(text: str, expected: str) -> None:
    """Descriptions become sentences; existing punctuation is kept."""
    assert sentence(text) == expected


def test_prose_is_wrapped_between_words() -> None:
    """Lines fit if the words do, and only white space changes."""
    text = " ".join(["word"] * 60)
    lines = wrapped(text, indent=8)
    assert all(len(line) <= LINE_LENGTH - 8 for line in lines)
    assert " ".join(lines) == printable_line(text)
    assert wrapped(LONG, indent=8) == [LONG]


def test_undefined_name_in_a_template_is_an_error() -> None:
    """A name that the view does not define is not an empty string."""
    template = environment("deros.generators.node.python").from_string("{{ nod }}")
    with pytest.raises(jinja2.UndefinedError, match="'nod' is undefined"):
        template.render(node=1)


def test_xml_text_is_escaped() -> None:
    """Markup in a model is text in elements and attributes."""
    assert xml_text('<a & "b">') == "&lt;a &amp; &quot;b&quot;&gt;"
