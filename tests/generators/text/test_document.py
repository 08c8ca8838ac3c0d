"""The document printer: text that fits on one line stays there."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deros.generators.text.document import (
    HARDLINE,
    LINE,
    SOFTLINE,
    Document,
    Line,
    align,
    breakable,
    comma_separated,
    concat,
    fill,
    flatten,
    group,
    if_broken,
    join,
    nest,
    render,
    render_lines,
)


def call(head: str, *arguments: Document) -> Document:
    """Return a call as Python lays it out."""
    inner = comma_separated(arguments)
    return group(head, "(", nest(4, SOFTLINE, inner, if_broken(",")), SOFTLINE, ")")


# Combinators --------------------------------------------------------------------------------------


def test_group_stays_on_one_line_if_it_fits_exactly() -> None:
    """The width may be used up, but not exceeded."""
    document = call("f", "one", "two")
    assert render(document, 11) == "f(one, two)"
    assert render(document, 10) == "f(\n    one,\n    two,\n)"


def test_text_after_a_group_counts_for_its_width() -> None:
    """A group that fits except for the bracket after it is broken."""
    document = concat(call("f", "one"), ")", ":")
    assert render(document, 8) == "f(one)):"
    assert render(document, 7) == "f(\n    one,\n)):"


def test_text_after_the_next_possible_break_does_not_count() -> None:
    """Text that may move to its own line does not break the group before it."""
    document = concat(group("a", LINE, "b"), group(LINE, "long text"))
    assert render(document, 5) == "a b\nlong text"


def test_outer_groups_are_broken_first() -> None:
    """Only groups that do not fit are broken."""
    document = call("f", call("g", "a", "b"), call("h", "c" * 13))
    assert render(document, 20) == ("f(\n    g(a, b),\n    h(\n        ccccccccccccc,\n    ),\n)")


def test_hard_line_break_breaks_enclosing_groups() -> None:
    """A hard line break never becomes a space, however wide the line."""
    document = group("a", LINE, group("b", HARDLINE, "c"))
    assert render(document, 80) == "a\nb\nc"
    with pytest.raises(ValueError, match="no form on one line"):
        flatten(document)


def test_fill_puts_as_many_items_on_a_line_as_fit() -> None:
    """Text after the last item counts."""
    words = fill(["aa", "bb", "cc", "dd"])
    assert render(words, 5) == "aa bb\ncc dd"
    assert render(concat(words, ";"), 5) == "aa bb\ncc\ndd;"
    assert fill([]) == ""


def test_fill_breaks_an_item_that_is_too_long() -> None:
    """A long item starts a new line and is broken, and the others fill the lines after it."""
    items = fill(["a", group("bbb", LINE, "ccc"), "d", "e"])
    assert render(items, 4) == "a\nbbb\nccc\nd e"


def test_line_break_may_add_text_before_and_after() -> None:
    """Both count for the width of their lines."""
    pieces = fill(["aaa", "bbb", "cccc"], Line("", before=" \\", after="+"))
    assert render(pieces, 8) == "aaabbb \\\n+cccc"
    assert render(pieces, 7) == "aaa \\\n+bbb \\\n+cccc"


def test_nest_may_indent_by_text() -> None:
    """Further lines of a comment start with the comment marker."""
    assert render(nest("# ", "# ", fill(["one", "two", "three"])), 9) == "# one two\n# three"


def test_align_indents_to_the_current_column() -> None:
    """Lines within an alignment start below its beginning."""
    operands = align(join(concat(" +", LINE), ["aaa", "bbb"]))
    assert render(group("x = ", operands), 10) == "x = aaa +\n    bbb"
    assert render(group(operands), 8, indent=2, column=5) == "aaa +\n     bbb"


def test_long_breakable_text_is_replaced() -> None:
    """The replacement gets the indentation, and is a document itself."""

    def halves(indent: int) -> Document:
        return concat(f"'{indent}", HARDLINE, "two'")

    document = concat("f(", nest(2, HARDLINE, breakable("'one two'", halves)), ")")
    assert render(document, 12) == "f(\n  'one two')"
    assert render(document, 11) == "f(\n  '2\n  two')"


def test_lines_have_no_trailing_spaces() -> None:
    """A space before a line break, and the indentation of an empty line, are dropped."""
    assert render(nest(4, "a ", HARDLINE, HARDLINE, "b"), 80) == "a\n\n    b"


def test_text_with_a_line_break_is_rejected() -> None:
    """Its width would be wrong."""
    with pytest.raises(ValueError, match="line break"):
        group("a\nb")


def test_text_of_an_unbroken_group_is_printed() -> None:
    """A document that is empty only when broken is not lost."""
    assert render(group(if_broken("", "flat")), 10) == "flat"
    assert render(concat("a", if_broken("", "flat")), 10) == "a"


def test_deep_and_long_documents_need_no_recursion() -> None:
    """Documents may be nested deeper than Python's recursion limit."""
    depth, flat = 50_000, 20
    deep: Document = "x"
    for _ in range(depth):
        deep = group("(", SOFTLINE, deep, SOFTLINE, ")")
    assert flatten(deep) == "(" * depth + "x" + ")" * depth
    lines = render(deep, 2 * flat + 1).split("\n")
    assert len(lines) == 2 * (depth - flat) + 1
    assert lines[depth - flat] == "(" * flat + "x" + ")" * flat
    assert render(fill(["word"] * 50_000), 9).count("\n") == 24_999


# Properties ---------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Sample:
    """A document, and all its possible layouts.

    Attributes:
        document: the document.
        layouts: the first is on one line, the last is broken wherever possible.
    """

    document: Document
    layouts: tuple[tuple[str, ...], ...]


def _joined(texts: Sequence[tuple[str, ...]]) -> tuple[str, ...]:
    """Join texts given as lines: the last line of each continues with the first of the next."""
    lines = [""]
    for first, *others in texts:
        lines[-1] += first
        lines += others
    return tuple(lines)


def _texts() -> st.SearchStrategy[Sample]:
    words = st.text("abc", min_size=1, max_size=4)
    return words.map(lambda word: Sample(word, ((word,),)))


@st.composite
def _groups(draw: st.DrawFn, inner: st.SearchStrategy[Sample]) -> Sample:
    samples = draw(st.lists(inner, min_size=1, max_size=3))
    indent = draw(st.sampled_from([0, 0, 2]))
    lines = [draw(st.sampled_from([LINE, SOFTLINE])) for _ in samples]
    parts = [part for pair in zip(lines, samples, strict=True) for part in (pair[0], pair[1])]
    documents = [part if isinstance(part, Line) else part.document for part in parts]
    document = group("[", nest(indent, *documents), SOFTLINE, "]")
    layouts = []
    for is_broken in (False, True):
        choices = [sample.layouts if is_broken else sample.layouts[:1] for sample in samples]
        for chosen in itertools.product(*choices):
            texts: list[tuple[str, ...]] = []
            for line, text in zip(lines, chosen, strict=True):
                texts += [("", "") if is_broken else (line.text or "",), text]
            first, *others = _joined(texts)
            inside = (first, *(" " * indent + other for other in others))
            end = ("", "]") if is_broken else ("]",)
            layouts.append(_joined([("[",), inside, end]))
    return Sample(document, tuple(layouts))


@st.composite
def _fills(draw: st.DrawFn) -> Sample:
    words = draw(st.lists(st.text("xyz", min_size=1, max_size=4), min_size=1, max_size=4))
    layouts = [
        _joined([(words[0],), *itertools.chain.from_iterable(zip(gaps, rest, strict=True))])
        for gaps in itertools.product([(" ",), ("", "")], repeat=len(words) - 1)
        for rest in [[(word,) for word in words[1:]]]
    ]
    return Sample(fill(words), tuple(layouts))


samples = st.recursive(_texts() | _fills(), _groups, max_leaves=6)


def _widest(lines: Sequence[str]) -> int:
    return max(map(len, lines))


def _without_blanks(text: str) -> str:
    return "".join(text.split())


@given(samples, st.integers(1, 40))
def test_rendered_text_is_a_possible_layout(sample: Sample, width: int) -> None:
    """Groups are broken completely or not at all, and nothing is lost, added or moved."""
    assert tuple(render(sample.document, width).split("\n")) in sample.layouts


@given(samples, st.integers(1, 40))
def test_rendered_text_fits_if_possible(sample: Sample, width: int) -> None:
    """No unbroken group makes a line too long if breaking it would help."""
    if _widest(sample.layouts[-1]) <= width:
        assert _widest(render(sample.document, width).split("\n")) <= width


@given(samples, st.integers(1, 40))
def test_rendered_text_has_few_lines(sample: Sample, width: int) -> None:
    """A document that fits on one line is on one line."""
    flat = flatten(sample.document)
    assert (flat,) == sample.layouts[0]
    assert (render(sample.document, width) == flat) or len(flat) > width
    assert render(sample.document, len(flat)) == flat


@given(samples, st.integers(1, 40), st.integers(0, 12))
def test_indentation_moves_the_text(sample: Sample, width: int, indent: int) -> None:
    """Indented text is the text for the remaining width, moved to the right."""
    moved = render_lines(sample.document, width + indent, indent)
    assert moved == [" " * indent + line for line in render(sample.document, width).split("\n")]


@given(samples, st.integers(1, 40))
def test_line_breaks_change_only_white_space(sample: Sample, width: int) -> None:
    """Without white space the text is that of one line."""
    rendered = render(sample.document, width)
    assert _without_blanks(rendered) == _without_blanks(flatten(sample.document))
