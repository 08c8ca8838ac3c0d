"""Whether the proof of a C monitor finds a slip in it: Frama-C is asked for one function alone."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from tests.support import c_proof
from tests.support.c_eva import TABLES_CHECK
from tests.support.c_mutants import TABLES, Mutant
from tests.support.c_proof_texts import ProofTexts

MARGIN = 3
"""How many times the steps that it took without the slip a goal is given with it."""
LEAST_STEPS = 2_000_000
"""The steps that it is given at least; a goal that needs a prover at all takes about 200,000."""
SECONDS = 300
"""The time that it is given, however many steps: what a busy machine needs for them, and more."""

_GOAL = re.compile(
    r"\[wp\] \[(?P<prover>\w+)[^\]]*\] Goal (?P<name>\w+) : Valid(?:.*\((?P<steps>\d+)\))?"
)
_LEFT = re.compile(r"\[wp\] \[(?P<how>[^\]]+)\] Goal (?P<name>\w+)(?P<after> : \w+)?")


@dataclass(frozen=True)
class Effort:
    """What the proof of a function without slips takes: which provers, and the steps by goal."""

    provers: str = c_proof.PROVERS
    steps: Mapping[str, int] = field(default_factory=dict)

    @property
    def most(self) -> int:
        """The steps of the slowest goal."""
        return max(self.steps.values(), default=0)

    def allowed(self, goal: str) -> int:
        """Return the steps that a goal may take once there is a slip."""
        return max(LEAST_STEPS, MARGIN * self.steps.get(goal, 0))


@dataclass(frozen=True)
class Found:
    """What became of a slip: the first goal that was not proved; none if it survives.

    ``refused`` says that it is not C: no compiler takes it, or Frama-C does not.
    """

    goal: str = ""
    refused: bool = False


class Original(ProofTexts):
    """A monitor without slips: what its functions need to be proved, and what that rests on."""

    def __init__(self, source: Path, environment: dict[str, str]) -> None:
        """Read the texts beside a source; proofs run in ``environment``."""
        super().__init__(source)
        self._environment = environment

    def key(self, mutant: Mutant) -> str:
        """Return the key of a result: all that the proof of a mutation reads."""
        return self.digest(mutant.function, mutant.source, mutant.before + mutant.after)

    def effort_key(self, function: str) -> str:
        """Return the key of an effort: all that the proof reads."""
        return self.digest(function, self.text, "")

    def effort(self, function: str) -> Effort:
        """Prove a function as it is, and return the effort.

        Raises:
            ValueError: it is not proved.
        """
        arguments = [*_options(c_proof.PROVERS), "-wp-fct", function]
        log = "".join(_lines(arguments, self.source, self._environment))
        proved = re.search(r"Proved goals: +(\d+) / (\d+)", log)
        if proved is None or proved[1] != proved[2]:
            raise ValueError(f"{function} is not proved without a slip:\n{log}")
        goals = list(_GOAL.finditer(log))
        names = c_proof.PROVERS.split(",")
        used = {each["prover"].lower() for each in goals}
        needed = [names[0], *(each for each in names[1:] if each.split("-")[0] in used)]
        return Effort(",".join(needed), {each["name"]: int(each["steps"] or 0) for each in goals})

    def find(self, mutant: Mutant, folder: Path, effort: Effort) -> Found:
        """Return what becomes of a slip; ``folder`` is where its text is written."""
        source = folder / self.source.name
        for path in [*self.source.parent.glob("*.h"), self.source.parent / "eva.c"]:
            (folder / path.name).write_text(path.read_text(encoding="utf-8"), encoding="utf-8")
        source.write_text(mutant.source, encoding="utf-8")
        if not _compiles(source):
            return Found(refused=True)
        if mutant.function == TABLES:
            analysis = c_proof.analyse(source, TABLES_CHECK)
            return Found("" if analysis.is_clean else TABLES_CHECK)
        few, all_steps = LEAST_STEPS, max(LEAST_STEPS, MARGIN * effort.most)
        # Most are found by what is ensured, and with few steps; the last way is short of none.
        for steps, goals in ((few, ["-wp-prop", "@ensures"]), (few, []), (all_steps, [])):
            options = [*_options(effort.provers, steps), *goals, "-wp-fct", mutant.function]
            found = self._try(options, mutant, source, effort, steps)
            if found is not None and (found.goal or found.refused or not goals):
                return found
        raise AssertionError(f"{mutant.name}: no goal is allowed more than {all_steps} steps")

    def _try(
        self, arguments: Sequence[str], mutant: Mutant, source: Path, effort: Effort, steps: int
    ) -> Found | None:
        """Ask for the proof; return nothing if a goal has had fewer steps than it is allowed."""
        done = ""
        is_short = False
        for line in _lines(arguments, source, self._environment):
            if "guaranteed RTE" in line:  # a certain failure is not a goal
                return Found("a run-time error")
            left = _LEFT.match(line)
            if left and not _GOAL.match(line):
                if effort.allowed(left["name"]) <= steps:
                    return Found(left["name"])
                is_short = True
            done += line
        proved = re.search(r"Proved goals: +(\d+) / (\d+)", done)
        if proved is None and ("User Error" in done or "syntax error" in done):
            return Found(refused=True)
        if "No goal generated" in done or "No proof obligations" in done:
            return Found()
        if is_short:
            return None
        if proved is None or proved[1] != proved[2]:
            raise RuntimeError(f"Frama-C has not come to its end: {mutant.name}\n{done}")
        return Found()


def _options(provers: str, steps: int = 0) -> list[str]:
    """Return how Frama-C is asked; without steps, there is no limit to them."""
    return [
        *("-no-autoload-plugins", "-load-module", "wp,rtegen"),
        *c_proof.OPTIONS,
        *("-wp-prover", provers, "-wp-par", "1", "-wp-timeout", str(SECONDS)),
        *(("-wp-steps", str(steps)) if steps else ()),
    ]


def _lines(arguments: Sequence[str], source: Path, environment: dict[str, str]) -> Iterator[str]:
    """Yield the output of Frama-C; end it and its provers when the generator is closed."""
    command = c_proof.command([*arguments, source.name])
    with subprocess.Popen(
        command,
        cwd=source.parent,
        env={**environment, "PWD": str(source.parent)},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
    ) as process:
        assert process.stdout is not None
        try:
            yield from process.stdout
        finally:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)


def _compiles(source: Path) -> bool:
    command = ["gcc", "-std=c99", "-pedantic-errors", "-fsyntax-only", "-w", source.name]
    return (
        subprocess.run(command, cwd=source.parent, capture_output=True, check=False).returncode == 0
    )


class Results:
    """What became of slips, kept in a file, so that a run can be interrupted and go on."""

    def __init__(self, path: Path) -> None:
        """Read what is known."""
        self._path = path
        self._known: dict[str, Found] = {}
        self._efforts: dict[str, Effort] = {}
        for line in path.read_text(encoding="utf-8").splitlines() if path.exists() else ():
            row = json.loads(line)
            if "steps" in row:
                self._efforts[row["key"]] = Effort(row["provers"], row["steps"])
            else:
                self._known[row["key"]] = Found(row["goal"], row["refused"])

    def get(self, key: str) -> Found | None:
        """Return what is known of a slip."""
        return self._known.get(key)

    def add(self, key: str, name: str, found: Found) -> None:
        """Write what has become of a slip."""
        self._known[key] = found
        self._write({"key": key, "name": name, "goal": found.goal, "refused": found.refused})

    def effort(self, key: str) -> Effort | None:
        """Return what is known of the proof of a function without slips."""
        return self._efforts.get(key)

    def add_effort(self, key: str, name: str, effort: Effort) -> None:
        """Write what the proof of a function takes."""
        self._efforts[key] = effort
        row = {"key": key, "name": name, "provers": effort.provers, "steps": dict(effort.steps)}
        self._write(row)

    def _write(self, row: Mapping[str, object]) -> None:
        with self._path.open("a", encoding="utf-8") as file:
            file.write(json.dumps(row) + "\n")
