"""The banner tells a generator's text from one that a hand has changed."""

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
def test_generated_text_is_untouched(path: str) -> None:
    """What with_banner returns is recognised, for every kind of comment."""
    assert is_untouched(with_banner(path, KINDS[path]))


@pytest.mark.parametrize("path", KINDS)
def test_any_change_is_seen(path: str) -> None:
    """Changed, added and removed text each break the digest."""
    text = with_banner(path, KINDS[path])
    assert not is_untouched(text + "\n")
    assert not is_untouched(text[:-2] + text[-1])
    assert not is_untouched("\n" + text)


def test_text_without_a_banner_is_a_hands() -> None:
    """A file that no generator wrote is never taken for one."""
    assert not is_untouched("x = 1\n")


@pytest.mark.parametrize("path", ["a.sh", "a.xml"])
def test_the_first_line_stays_first(path: str) -> None:
    """Nothing may stand before a hash-bang or an XML declaration."""
    first = KINDS[path].splitlines()[0]
    assert with_banner(path, KINDS[path]).splitlines()[0] == first


@pytest.mark.parametrize(("path", "text"), [("a.json", "{}\n"), ("resource/a", "x"), ("a.py", "")])
def test_kinds_without_comments_stay_as_they_are(path: str, text: str) -> None:
    """Files that cannot hold a comment, and empty markers, get no banner."""
    assert with_banner(path, text) == text
