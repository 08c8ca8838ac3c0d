"""What is kept from one text of a file to the next."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Iterator
from pathlib import Path

import pytest

from deros.diagnostics import Diagnostic
from deros.lsp.analysis import Analyses
from deros.lsp.serving import make_server
from deros.metamodels.load import LoadedFile
from deros.validators import check as checks
from deros.validators.findings.context import CheckContext

_NODE = "node Camera : cameras publishes topic image : {type}"
_SYSTEM = 'system Robot imports import "camera.rnd" node front : Camera\n'


def _robot(folder: Path, type_name: str = "sensor_msgs.Image") -> str:
    (folder / "camera.rnd").write_text(_NODE.format(type=type_name), encoding="utf-8")
    path = folder / "robot.system"
    path.write_text(_SYSTEM, encoding="utf-8")
    return str(path)


def test_answers_of_earlier_texts_are_let_go_of(tmp_path: Path) -> None:
    """Each path that is typed asks the disk anew; what is kept of that stays small."""
    path, analyses = _robot(tmp_path), Analyses()
    asked = []
    for number in range(300):
        text = _SYSTEM.replace("node front", f'import "other_{number}.rnd" node front')
        analyses.of(path, {path: text})
        asked.append(len(analyses._kept[path].answers))
    assert max(asked) > asked[0]
    assert max(asked) < 3 * asked[0] + 150
    assert asked[-1] < max(asked)


def test_unchanged_nodes_are_checked_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A keystroke in a system checks no node description again, unless that has changed."""
    path, analyses = _robot(tmp_path, "sensor_msgs.Imagee"), Analyses()
    checked: list[str] = []
    original = checks._check_model

    def counted(file: LoadedFile, context: CheckContext) -> Iterator[Diagnostic]:
        checked.append(Path(file.path).name)
        return original(file, context)

    monkeypatch.setattr(checks, "_check_model", counted)
    first = analyses.of(path, {path: _SYSTEM})
    second = analyses.of(path, {path: f"{_SYSTEM}// typed\n"})
    assert [each.code for each in second.findings] == [each.code for each in first.findings] != []
    assert checked.count("camera.rnd") == 1
    (tmp_path / "camera.rnd").write_text(_NODE.format(type="sensor_msgs.Image"), encoding="utf-8")
    assert not any(each.is_error for each in analyses.of(path, {path: _SYSTEM}).findings)
    assert checked.count("camera.rnd") == 2


def test_definitions_of_messages_are_read_again_when_they_change(tmp_path: Path) -> None:
    """Findings of nodes are not kept where the messages that they rest on have changed."""
    messages = tmp_path / "own_msgs" / "msg"
    messages.mkdir(parents=True)
    (tmp_path / "own_msgs" / "package.xml").write_text(
        "<package><name>own_msgs</name></package>", encoding="utf-8"
    )
    path, analyses = _robot(tmp_path, "own_msgs.State"), Analyses((tmp_path,))
    assert any(each.is_error for each in analyses.of(path, {path: _SYSTEM}).findings)
    (messages / "State.msg").write_text("bool on\n", encoding="utf-8")
    assert not any(each.is_error for each in analyses.of(path, {path: _SYSTEM}).findings)


def test_an_analysis_that_failed_leaves_nothing_behind(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What a fault of ours left half done is not built upon: all is loaded anew."""
    path, analyses = _robot(tmp_path), Analyses()
    analyses.of(path, {path: _SYSTEM})
    failing = _SYSTEM.replace("front", "rear")
    with monkeypatch.context() as broken:
        broken.setattr(checks, "in_file_order", None)
        with pytest.raises(TypeError):
            analyses.of(path, {path: failing})
    before = analyses.last(path)
    assert before is not None
    after = analyses.of(path, {path: failing})
    assert after.workspace.repository is not before.workspace.repository
    assert "rear" in after.source.text


def test_handled_messages_are_forgotten(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The server keeps nothing of a notification once it has been handled."""
    path = _robot(tmp_path)
    server = make_server()
    document = {"uri": Path(path).as_uri(), "languageId": "rossystem", "version": 1}

    def send(method: str, params: dict[str, object], **more: object) -> None:
        text = json.dumps({"jsonrpc": "2.0", "method": method, "params": params, **more})
        structure = server.protocol.structure_message
        server.protocol.handle_message(json.loads(text, object_hook=structure))

    async def typed() -> None:
        send("initialize", {"capabilities": {}}, id=1)
        send("textDocument/didOpen", {"textDocument": {**document, "text": _SYSTEM}})
        for number in range(100):
            change = {"text": f"{_SYSTEM}// {number}\n"}
            send("textDocument/didChange", {"textDocument": document, "contentChanges": [change]})
        assert server.text_of(path).endswith("// 99\n")
        assert len(server.protocol._request_futures) < 10
        await server.analysis(path)

    monkeypatch.setattr(server.protocol, "_send_data", lambda _: None)
    asyncio.run(typed())
