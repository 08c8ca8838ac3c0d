"""Faults of ours, planted into a running server: it says so, goes on, and changes nothing."""

# ruff: noqa: D103 - the names of tests say it, also of asynchronous ones

from __future__ import annotations

import sys
from collections.abc import AsyncIterator
from pathlib import Path

import pytest
import pytest_lsp
from lsprotocol import types
from pytest_lsp import ClientServerConfig, LanguageClient

from tests.support.editor import Document, Editor

PLANTED = """\
import sys

from deros.cli.main import main
from deros.lsp.features import values
from deros.pipeline.workspace import Workspace

checked = Workspace.check


def check(workspace):
    text = workspace.files[0].source.text
    if "one" in text:
        raise ZeroDivisionError("planted one")
    if "two" in text:
        raise KeyError("planted two")
    return checked(workspace)


def hints(*given):
    raise ValueError("planted in an answer")


Workspace.check = check
values.hints = hints
sys.exit(main(["lsp"]))
"""
RULES = """\
action stop;
input speed = topic /speed.data timeout 1 sec;
"""


@pytest_lsp.fixture(config=ClientServerConfig(server_command=[sys.executable, "-c", PLANTED]))
async def client(lsp_client: LanguageClient) -> AsyncIterator[None]:
    capabilities = pytest_lsp.client_capabilities("visual-studio-code")
    await lsp_client.initialize_session(types.InitializeParams(capabilities=capabilities))
    yield
    await lsp_client.shutdown_session()


@pytest.fixture
def rules(client: LanguageClient, tmp_path: Path) -> Document:
    return Editor(client, tmp_path).open("rules.deros", RULES)


def shown(rules: Document) -> list[str]:
    return [each.message for each in rules.client.messages]


async def test_a_failed_analysis_is_told_once_for_each_kind(rules: Document) -> None:
    before = await rules.messages()
    assert before
    rules.change(f"{RULES}// one")
    assert await rules.messages() == before
    rules.change(f"{RULES}// one more letter")
    assert await rules.messages() == before
    (message,) = shown(rules)
    assert "a bug in deros, not in 'rules.deros': ZeroDivisionError in <string>" in message
    assert "Please report it" in message
    rules.change(f"{RULES}// two")
    await rules.messages()
    assert ["KeyError" in each for each in shown(rules)] == [False, True]


async def test_the_log_has_each_traceback(rules: Document) -> None:
    for comment in ("one", "one more letter"):
        rules.change(f"{RULES}// {comment}")
        await rules.messages()
    logged = [each.message for each in rules.client.log_messages]
    assert len(logged) == 2
    assert all("Traceback" in each and "planted one" in each for each in logged)
    assert all(str(rules.path) in each for each in logged)


async def test_the_server_goes_on_with_the_next_text(rules: Document) -> None:
    rules.change(f"{RULES}// one")
    await rules.messages()
    rules.change(RULES.replace("action stop;", "action halt;"))
    assert any("'halt'" in each for each in await rules.messages())


async def test_a_text_that_was_not_analysed_is_not_laid_out(rules: Document) -> None:
    """The layout of the text before would take its place."""
    rules.change(f"{RULES}// one\n\n\n\n   action   later;")
    text = rules.text
    await rules.format()
    assert rules.text == text


async def test_an_answer_that_fails_is_told_too(rules: Document) -> None:
    assert await rules.hints() == []
    (message,) = shown(rules)
    assert "ValueError" in message
    assert await rules.outline() == ["stop", "speed"]
