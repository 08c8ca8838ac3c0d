"""The banner distinguishes generated text from edited text."""

from __future__ import annotations

import pytest

from deros.generators.output.banner import is_untouched, with_banner

KINDS = {
    "a.py": "x = 1\n",
    "a.yaml": "a: 1\n",
    "a.rnd": "node a : b\n",
    "a.xml": '<?xml version="1.0"?>\n<a/>\n',
    "a.sh": "#!/bin/sh\ntrue\n",
    "CMakeLists.txt": "project(a)\n",
}


@pytest.mark.parametrize("path", KINDS)
def test_generated_text_is_recognised(path: str) -> None:
    """The result of with_banner is recognised, for every comment syntax."""
    assert is_untouched(with_banner(path, KINDS[path]))


@pytest.mark.parametrize("path", KINDS)
def test_any_change_is_detected(path: str) -> None:
    """Changed, added and removed text changes the digest."""
    text = with_banner(path, KINDS[path])
    assert not is_untouched(text + "\n")
    assert not is_untouched(text[:-2] + text[-1])
    assert not is_untouched("\n" + text)


def test_text_without_a_banner_is_not_generated() -> None:
    """A file of a user is never taken for a generated one."""
    assert not is_untouched("x = 1\n")


@pytest.mark.parametrize("path", ["a.sh", "a.xml"])
def test_first_line_stays_first(path: str) -> None:
    """Nothing may precede a shebang or an XML declaration."""
    first = KINDS[path].splitlines()[0]
    assert with_banner(path, KINDS[path]).splitlines()[0] == first


@pytest.mark.parametrize(("path", "text"), [("a.json", "{}\n"), ("resource/a", "x"), ("a.py", "")])
def test_files_without_comments_get_no_banner(path: str, text: str) -> None:
    """Files that cannot contain a comment, and empty markers, are unchanged."""
    assert with_banner(path, text) == text
