"""The results of a run of timelines."""

from __future__ import annotations

from dataclasses import dataclass

from deros.diagnostics import Diagnostic
from deros.simulation.timelines.outcomes import Outcome, Player


@dataclass(frozen=True)
class RuleTests:
    """The result of a run.

    Attributes:
        outcomes: of each timeline, in the order of the files.
        players: the rules that were played, each with what the timelines reach of it.
        unplayed: files of rules that no timeline is about.
        diagnostics: what is wrong with timelines, traces and rules; what has an error is not
            played.
    """

    outcomes: tuple[Outcome, ...]
    players: tuple[Player, ...]
    unplayed: tuple[str, ...]
    diagnostics: tuple[Diagnostic, ...]
