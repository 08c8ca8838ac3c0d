"""The text of a page."""

from __future__ import annotations

import base64
import hashlib
import json
import re
from pathlib import Path

import pytest

from deros.diagnostics import Diagnostic
from deros.models.system import System
from deros.report.page.build import build
from deros.report.page.elkjs import FILE, VERSION, NoElkjs, read_elkjs
from deros.report.page.render import render

ELKJS = "var ELK = class {};\n"


@pytest.fixture
def page(courier: tuple[System, list[Diagnostic]]) -> str:
    """Return a page with a stand-in for elkjs, which is not run."""
    return render(build(*courier), ELKJS)


def test_scripts_and_style_are_those_that_the_policy_names(page: str) -> None:
    """The browser runs nothing else; a digest of another text would leave a dead page."""
    policy = re.findall(r'Content-Security-Policy" content="([^"]*)"', page)
    texts = re.findall(r"<(?:script|style)>(.*?)</(?:script|style)>", page, re.DOTALL)
    digests = [
        "'sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() + "'"
        for text in texts
    ]
    style, elkjs, program = digests
    assert policy == [f"default-src 'none'; script-src {elkjs} {program}; style-src {style}"]


def test_page_refers_to_nothing_outside(page: str) -> None:
    """There is no link, image, font or script of another file."""
    assert not re.search(r"""\b(?:src|href)=["']|url\((?!#)|@import|\bfetch\(|XMLHttp""", page)


def test_no_text_of_the_system_is_markup(page: str) -> None:
    """Texts stand in a block of JSON without any character that markup begins or ends with."""
    assert "<img" not in page
    assert page.count("</script") == 3
    contents = re.findall(r'id="contents">([^<]*)</script>', page)
    assert json.loads(contents[0])["programs"][0]["description"] == (
        "Reads the laser </script><img src=x onerror=alert(1)>"
    )


def test_page_is_ascii(page: str, courier: tuple[System, list[Diagnostic]]) -> None:
    """Any encoding of the output leaves it, and so the digests, as they are."""
    assert any("\N{HORIZONTAL ELLIPSIS}" in each.hint for each in courier[1])
    assert page.isascii()


def test_text_that_looks_like_a_gap_of_the_template_stays(
    courier: tuple[System, list[Diagnostic]],
) -> None:
    """Only the template is filled in, not what it has been filled in with."""
    page = render(build(*courier), "/* ELK {{program}} {{contents}} */")
    assert "/* ELK {{program}} {{contents}} */" in page


def test_missing_elkjs_says_how_to_get_it(tmp_path: Path) -> None:
    """It is a package of npm, and its version is named."""
    with pytest.raises(NoElkjs, match=rf"npm pack elkjs@{re.escape(VERSION)}"):
        read_elkjs(tmp_path / FILE)


@pytest.mark.parametrize("text", ["", "var ELK = '</script>';", "var ELK = 'é';"])
def test_file_that_cannot_be_elkjs_is_refused(tmp_path: Path, text: str) -> None:
    """It would leave a page that is dead, or that ends where it must not."""
    (tmp_path / FILE).write_text(text, encoding="utf-8")
    with pytest.raises(NoElkjs, match=FILE):
        read_elkjs(tmp_path / FILE)
    with pytest.raises(NoElkjs, match="cannot read"):
        read_elkjs(tmp_path)


def test_elkjs_comes_with_its_licence(tmp_path: Path) -> None:
    """Whoever passes the page on passes on the notice."""
    (tmp_path / FILE).write_text(ELKJS)
    text = read_elkjs(tmp_path / FILE)
    assert text.endswith(ELKJS)
    assert "Eclipse Public License 2.0" in text
