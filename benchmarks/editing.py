"""How long an editor waits for the language server, in a file of 1,000 lines with 50 imports.

The server runs as an editor runs it, and is asked through the protocol. Each keystroke changes the
text; findings are timed from there to their arrival. Completion is asked together with a keystroke,
which is when editors ask: the server has not even seen the text before. What is to hold: findings
in less than 150 ms and completion in less than 50 ms, in 99 of 100 cases, and a memory that stays
the same over 10,000 keystrokes.

The floors are of the same run: to split all the text into words with one regular expression, and a
question that the server answers with nothing.
"""

from __future__ import annotations

import argparse
import asyncio
import re
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from lsprotocol import types
from pygls.lsp.client import LanguageClient

FINDINGS_MS = 150.0
COMPLETION_MS = 50.0
MOST_GROWTH = 1.05
IMPORTS = 50
LINES = 1000
_WORDS = re.compile(r'"[^"\n]*"|[\w/.]+|\S')


def write_models(folder: Path) -> Path:
    """Write a system of 1,000 lines, and the 50 node descriptions that it imports; return it."""
    for number in range(IMPORTS):
        (folder / f"node_{number}.rnd").write_text(
            f"node Node{number} : robot_nodes\n\n"
            "parameters\n"
            "  name rate : double = 10.0 [Hz] in [1, 100]\n"
            '  name frame : string = "base"\n\n'
            "subscribes\n"
            f"  topic command : geometry_msgs.Twist\n\n"
            "publishes\n"
            "  topic odometry : nav_msgs.Odometry\n"
            "  topic scan : sensor_msgs.LaserScan qos sensor_data\n",
            encoding="utf-8",
        )
    lines = ["system Fleet", "", "imports"]
    lines += [f'  import "node_{number}.rnd"' for number in range(IMPORTS)]
    number = 1
    while len(lines) < LINES - 12:
        lines += [
            "",
            f"subsystem Robot{number} namespace /robot_{number} {{",
            f"  node driver : Node{number % IMPORTS}",
            "  parameters",
            "    param rate = 20.0",
            "  wirings",
            f"    connect command to /fleet/command_{number - 1}",
            f"    connect odometry to /fleet/odometry_{number}",
            "}",
            "",
            "// the commands come from whoever drives the robots",
            f"subsystem Source{number} {{",
            "  topics",
            f"    external topic /fleet/command_{number - 1} : geometry_msgs.Twist",
            f"    external topic /fleet/odometry_{number} : nav_msgs.Odometry",
            f"    external topic /robot_{number}/scan : sensor_msgs.LaserScan",
            "}",
        ]
        number += 1
    path = folder / "fleet.system"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


class Session:
    """An editor with one open file, and the server that answers it."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.text = path.read_text(encoding="utf-8")
        self.client = LanguageClient("benchmark", "1")
        self.version = 1
        self._published = asyncio.Event()

        def take(params: types.PublishDiagnosticsParams) -> None:
            if params.uri == self.path.as_uri():
                self._published.set()

        self.client.feature(types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)(take)

    async def start(self) -> None:
        """Start the server, and open the file."""
        await self.client.start_io(sys.executable, "-m", "deros", "lsp")
        await self.client.initialize_async(types.InitializeParams(types.ClientCapabilities()))
        self.client.initialized(types.InitializedParams())
        self.client.text_document_did_open(
            types.DidOpenTextDocumentParams(
                types.TextDocumentItem(self.path.as_uri(), "rossystem", 1, self.text)
            )
        )
        await self.findings()

    async def stop(self) -> None:
        """End the server."""
        await self.client.shutdown_async(None)
        self.client.exit(None)
        await self.client.stop()  # type: ignore[no-untyped-call]

    def change(self, text: str) -> None:
        """Replace the text, as editors do after each keystroke."""
        self.version += 1
        self._published.clear()
        self.client.text_document_did_change(
            types.DidChangeTextDocumentParams(
                types.VersionedTextDocumentIdentifier(version=self.version, uri=self.path.as_uri()),
                [types.TextDocumentContentChangeWholeDocument(text)],
            )
        )

    async def findings(self) -> None:
        """Wait for the findings of the last text."""
        await asyncio.wait_for(self._published.wait(), 60)

    async def complete(self, position: types.Position) -> int:
        """Ask what fits at a place; return how much is offered."""
        found = await self.client.text_document_completion_async(
            types.CompletionParams(types.TextDocumentIdentifier(self.path.as_uri()), position)
        )
        return len(found) if isinstance(found, list | tuple) else 0

    async def nothing(self) -> None:
        """Ask what is answered at once."""
        await self.client.text_document_completion_async(
            types.CompletionParams(
                types.TextDocumentIdentifier("file:///none.txt"), types.Position(0, 0)
            )
        )

    @property
    def memory_mb(self) -> float:
        """The resident memory of the server."""
        server: Any = self.client._server
        status = Path(f"/proc/{server.pid}/status").read_text(encoding="ascii")
        found = re.search(r"VmRSS:\s*(\d+)", status)
        assert found is not None
        return int(found[1]) / 1024


def typed(text: str, line: int, written: str) -> tuple[str, types.Position]:
    """Return a text with a new line, and the position behind what is written in it."""
    lines = text.split("\n")
    lines.insert(line, written)
    return "\n".join(lines), types.Position(line, len(written))


async def measure(session: Session, keystrokes: int) -> dict[str, list[float]]:
    """Return milliseconds to the findings, to the completion and of the floors."""
    times: dict[str, list[float]] = {"findings": [], "completion": [], "nothing": [], "words": []}
    middle = next(
        number
        for number, line in enumerate(session.text.split("\n"))
        if number > LINES // 2 and line.startswith("    connect odometry")
    )
    word = "    connect scan to /fleet/scan_of_this_robot"
    for number in range(keystrokes):
        length = 4 + number % (len(word) - 3)
        text, at = typed(session.text, middle, word[:length])
        began = time.perf_counter()
        session.change(text)
        await session.complete(at)
        times["completion"].append(1000 * (time.perf_counter() - began))
        await session.findings()
        times["findings"].append(1000 * (time.perf_counter() - began))
        times["nothing"].append(await _timed(session.nothing))
        began = time.perf_counter()
        _WORDS.findall(text)
        times["words"].append(1000 * (time.perf_counter() - began))
    return times


async def _timed(ask: Callable[[], Any]) -> float:
    began = time.perf_counter()
    await ask()
    return 1000 * (time.perf_counter() - began)


async def grow(session: Session, edits: int) -> tuple[float, float]:
    """Return the memory of the server after a tenth of the edits, and after all of them."""
    first = 0.0
    for number in range(1, edits + 1):
        # A path that is typed has the server look for another file with each letter.
        written = f'  import "other_{number}.rnd"' if number % 100 < 10 else f"// {number}"
        text, _ = typed(session.text, IMPORTS, written)
        session.change(text)
        if number % 10 == 0:
            await session.findings()
        if number == edits // 10:
            first = session.memory_mb
    await session.findings()
    return first, session.memory_mb


async def run(keystrokes: int, edits: int) -> int:
    """Print the table; return 1 when a limit is passed."""
    with tempfile.TemporaryDirectory(prefix="deros-benchmark-") as place:
        session = Session(write_models(Path(place)))
        lines = session.text.count("\n")
        await session.start()
        try:
            times = await measure(session, keystrokes)
            print(f"{lines} lines, {IMPORTS} imports, {keystrokes} keystrokes")
            print(f"{'ms':>12} {'median':>8} {'99 %':>8} {'limit':>8} {'floor':>8} {'ratio':>8}")
            held = True
            for name, floor, limit in (
                ("findings", "words", FINDINGS_MS),
                ("completion", "nothing", COMPLETION_MS),
            ):
                median, last = statistics.median(times[name]), _of_hundred(times[name])
                lowest = statistics.median(times[floor])
                held = held and last < limit
                print(
                    f"{name:>12} {median:>8.1f} {last:>8.1f} {limit:>8.0f} {lowest:>8.2f}"
                    f" {median / lowest:>8.1f}"
                )
            first, last = await grow(session, edits)
            print(f"memory after {edits // 10} edits: {first:.0f} MB, after {edits}: {last:.0f} MB")
            held = held and last < first * MOST_GROWTH
        finally:
            await session.stop()
    return 0 if held else 1


def _of_hundred(times: list[float]) -> float:
    """Return the time that 99 of 100 are below."""
    return sorted(times)[max(0, round(0.99 * len(times)) - 1)]


def main() -> int:
    """Measure, and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--keystrokes", type=int, default=200)
    parser.add_argument("--edits", type=int, default=10_000)
    arguments = parser.parse_args()
    return asyncio.run(run(arguments.keystrokes, arguments.edits))


if __name__ == "__main__":
    sys.exit(main())
