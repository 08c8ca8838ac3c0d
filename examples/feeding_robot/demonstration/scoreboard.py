"""The table that is shown while the cases are played."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import Console
from rich.live import Live
from rich.table import Table
from rich.text import Text

from demonstration.cases import Case
from demonstration.picture import reaction_text
from demonstration.recording import Result, percentile
from demonstration.referee import Reaction, describe


class Scoreboard:
    """Shows a row for each case: what is expected, what was observed, and how fast.

    On a terminal the table is redrawn as it grows; elsewhere each result is a line of its own, and
    the table comes at the end.
    """

    def __init__(self, console: Console, cases: Sequence[Case], repeat: int) -> None:
        """Prepare the rows."""
        self._console = console
        self._cases = cases
        self._repeat = repeat
        self._running: Case | None = None
        self._results: dict[int, list[Result]] = {case.number: [] for case in cases}
        self._live = Live(console=console, auto_refresh=False, get_renderable=self.table)

    def __enter__(self) -> Scoreboard:
        """Begin to show."""
        if self._console.is_terminal:
            self._live.start(refresh=True)
        return self

    def __exit__(self, *_: object) -> None:
        """Leave the table standing."""
        if self._console.is_terminal:
            self._live.stop()
        else:
            self._console.print(self.table())

    def begin(self, case: Case) -> None:
        """Mark the case that is being played."""
        self._running = case
        if self._console.is_terminal:
            self._live.refresh()

    def report(self, result: Result) -> None:
        """Enter a result."""
        self._running = None
        self._results[result.number].append(result)
        if self._console.is_terminal:
            self._live.refresh()
        else:
            facts = (describe(result.observed), reaction_text(result), result.failure or "passed")
            line = f"{result.number:>2}  {result.title}: {', '.join(facts)}"
            self._console.print(line, soft_wrap=True, highlight=False)

    @property
    def results(self) -> list[Result]:
        """All results, case by case."""
        return [result for results in self._results.values() for result in results]

    @property
    def complete(self) -> bool:
        """Whether every case has been played as often as it should and has passed."""
        wanted = len(self._cases) * self._repeat
        return len(self.results) == wanted and all(result.passed for result in self.results)

    def table(self) -> Table:
        """Return the table as it stands."""
        table = Table(box=None, padding=(0, 2, 0, 0), pad_edge=False, header_style="dim")
        time = "ms 50/99 %" if self._repeat > 1 else "time"
        for name in ("", "case", "expected", "observed", time, ""):
            table.add_column(name, justify="right" if name in {"", time} else "left")
        for case in self._cases:
            expected = _compact(case.expected)
            table.add_row(str(case.number), case.title, expected, *self._cells(case))
        return table

    def _cells(self, case: Case) -> tuple[Text, Text, Text]:
        results = self._results[case.number]
        if not results:
            state = "now" if case is self._running else ""
            return Text(), Text(), Text(state, style="cyan")
        failed = [result for result in results if not result.passed]
        shown = failed[-1] if failed else results[-1]
        passed = len(results) - len(failed)
        count = f"{passed}/{self._repeat}" if self._repeat > 1 else ""
        verdict = Text(count or ("FAIL" if failed else "ok"))
        verdict.stylize("bold red" if failed else "green")
        return Text(_compact(shown.observed)), Text(_times(results)), verdict


def _compact(reactions: frozenset[Reaction]) -> str:
    """Return reactions as short as it takes for a row to fit into 80 columns."""
    return describe(reactions).replace(" + ", "+")


def _times(results: Sequence[Result]) -> str:
    """Return the reaction time of one case; of several rounds median and 99 %, in ms."""
    times = [1e3 * result.reaction_time for result in results if result.reaction_time is not None]
    if len(times) < 2 or results[0].simulated:
        return reaction_text(results[-1])
    return f"{percentile(times, 0.5):.1f}/{percentile(times, 0.99):.1f}"


def summary(results: Sequence[Result], monitored: frozenset[int]) -> str:
    """Return one sentence on the safety node's reaction times in real time.

    Args:
        results: the results of any cases.
        monitored: the numbers of the cases in which it is the safety node that reacts.
    """
    times = [
        1e3 * result.reaction_time
        for result in results
        if result.reaction_time is not None and result.number in monitored
    ]
    if not times:
        return "No reaction of the safety node was timed."
    return (
        f"Reaction time of the safety node over {len(times)} reactions: "
        f"median {percentile(times, 0.5):.1f} ms, 99 % {percentile(times, 0.99):.1f} ms."
    )
