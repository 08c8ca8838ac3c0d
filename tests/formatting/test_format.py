"""Formatting changes blanks and line breaks, and nothing that a text says."""

from __future__ import annotations

import itertools
from collections import Counter
from textwrap import dedent

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from deros.diagnostics import SourceFile
from deros.formatting.format import formatted
from deros.interfaces.store import InterfaceStore
from deros.metamodels.languages import Language
from deros.metamodels.load import LoadedFile, Repository
from deros.metamodels.matching import DoesNotParse
from deros.metamodels.parsers import parse_tree
from deros.metamodels.reading import Unreadable, comments, prepare
from deros.metamodels.tokens import HasSyntaxErrors, SyntaxToken, syntax_tokens
from deros.validators.check import check_all
from tests.support.meaning import meaning
from tests.support.parts_of_models import laid_out
from tests.support.written_models import ROOT, Written, cases, examples, scaffolds, snippets


def _tokens(text: str, language: Language) -> list[SyntaxToken]:
    return syntax_tokens(SourceFile("", text), language)


def _comments(text: str) -> list[list[str]]:
    found = comments(SourceFile("", text))
    return [[line.strip() for line in each.text.split("\n")] for each in found]


def _parses(written: Written) -> bool:
    try:
        parse_tree(written.language, prepare(SourceFile("", written.text)))
    except (DoesNotParse, Unreadable):
        return False
    return True


def _formatted(text: str, language: Language) -> str:
    result = formatted(text, language)
    assert isinstance(result, str), [each.message for each in result.diagnostics]
    return result


WHOLE = [each for each in (*examples(), *cases(), *snippets(), *scaffolds()) if _parses(each)]
UNREMARKED = [each for each in WHOLE if not _comments(each.text)]


def test_most_models_are_read() -> None:
    """The texts below are all that the repository has, of each language."""
    counts = Counter(each.language.name for each in WHOLE)
    assert {"rosnode", "rossystem", "deros"} == counts.keys()
    assert min(counts.values()) > 100
    assert all(map(_parses, (*examples(), *scaffolds())))


@pytest.mark.parametrize("written", WHOLE, ids=str)
def test_formatted_text_says_the_same_and_stays(written: Written) -> None:
    """A second pass changes nothing; model, faults of references and comments are as before."""
    text = _formatted(written.text, written.language)
    assert formatted(text, written.language) == text
    assert _comments(text) == _comments(written.text)
    assert not any(line != line.rstrip() for line in text.split("\n"))
    assert "\n\n\n" not in text
    assert text.endswith("\n")
    _, before = _loaded(written, written.text)
    _, after = _loaded(written, text)
    assert meaning(before.model) == meaning(after.model)
    found = [(each.code.name, each.message) for each in after.diagnostics]
    assert found == [(each.code.name, each.message) for each in before.diagnostics]


def _loaded(written: Written, text: str) -> tuple[Repository, LoadedFile]:
    repository = Repository()
    loaded = repository.load_text(written.file.with_suffix(written.language.suffix), text)
    assert loaded.model is not None
    return repository, loaded


@pytest.mark.parametrize("written", [each for each in WHOLE if "deros:" in each.text], ids=str)
def test_what_is_allowed_stays_so(written: Written) -> None:
    """Comments that allow findings are still about them."""
    texts = (written.text, _formatted(written.text, written.language))
    before, after = (_findings(*_loaded(written, text)) for text in texts)
    assert before == after


def _findings(repository: Repository, loaded: LoadedFile) -> tuple[Counter[str], Counter[str]]:
    checked = check_all([loaded], repository, InterfaceStore())
    allowed = Counter(each.finding.code.name for each in checked.allowed)
    return Counter(each.code.name for each in checked.findings), allowed


@pytest.mark.parametrize("written", [*examples(), *scaffolds()], ids=str)
def test_our_models_are_formatted(written: Written) -> None:
    """What users see first is laid out as they will have it."""
    assert formatted(written.text, written.language) == written.text


@pytest.mark.parametrize("written", snippets(), ids=str)
def test_our_documents_are_formatted(written: Written) -> None:
    """Documents show models, and parts of models, as the formatter leaves them."""
    page = written.file.relative_to(ROOT).as_posix()
    shown = laid_out(written)
    assert shown == (None if shown is None and page in BROKEN else dedent(written.text))


BROKEN = {
    "docs/diagnostics/DRS003.md": "a syntax error",
    "docs/diagnostics/DRS007.md": "a name too long to be shown",
}
"""Pages with an example that cannot be parsed, and why it cannot."""


# Whatever is between tokens --------------------------------------------------------------------

_BLANKS = st.sampled_from(
    [" ", "\t", "   ", "\n", "\r\n", "\n\n\n", " \n \t", " // why\n", " /* so */ "]
)


@given(st.data())
def test_blanks_between_tokens_mean_nothing(data: st.DataObject) -> None:
    """With any blanks, line breaks and comments between them, the same tokens come out."""
    written = data.draw(st.sampled_from(WHOLE))
    text = _mangled(data, written, _BLANKS)
    tokens = _read(text, written.language)
    result = _formatted(text, written.language)
    assert [_key(each) for each in _tokens(result, written.language)] == tokens
    assert _comments(result) == _comments(text)
    assert formatted(result, written.language) == result


@given(st.data())
def test_blanks_within_lines_are_put_right(data: st.DataObject) -> None:
    """How a line is indented, and what is between its tokens, does not show in the result."""
    written = data.draw(st.sampled_from(UNREMARKED))
    text = _mangled(data, written, st.sampled_from([" ", "\t", "    "]))
    _read(text, written.language)
    assert formatted(text, written.language) == formatted(written.text, written.language)


def _key(token: SyntaxToken) -> tuple[str, str, str]:
    return (token.text, token.rule, token.within)


def _read(text: str, language: Language) -> list[tuple[str, str, str]]:
    """Return the tokens of a mangled text; a grammar that is not indifferent is passed over."""
    try:
        return [_key(each) for each in _tokens(text, language)]
    except (HasSyntaxErrors, Unreadable):
        assume(False)
        raise


def _mangled(data: st.DataObject, written: Written, blanks: st.SearchStrategy[str]) -> str:
    """Return a text with other blanks in some of the places where it has blanks."""
    tokens = _tokens(written.text, written.language)
    pieces = [written.text[: tokens[0].start]]
    at_most = st.integers(0, 9)
    for token, after in itertools.zip_longest(tokens, tokens[1:]):
        pieces.append(token.text)
        end = len(written.text) if after is None else after.start
        gap = written.text[token.end : end]
        changes = gap.isspace() and not (after is not None and after.goes_on)
        if changes and data.draw(at_most) < 4:
            new = data.draw(blanks)
            keeps_lines = "\n" in gap and "\n" not in new and "/" not in new
            gap = gap[: gap.rindex("\n") + 1] + new if keeps_lines else new
        pieces.append(gap)
    return "".join(pieces)
