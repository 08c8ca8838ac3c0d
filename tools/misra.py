"""Hold the emitted C against MISRA C:2012, as far as cppcheck's addon checks it.

The monitors are those of the examples, one of rules with every construct, and random ones. Exit
code 1 says that a rule is violated which the text does not say it deviates from, 2 that cppcheck is
missing.
"""

from __future__ import annotations

import sys
import tempfile
from collections import Counter
from pathlib import Path

from deros.generators.monitor.c.interface import render_monitor
from tests.support import c_pairs, misra
from tests.support.c_everything import everything, examples

RANDOM = 10
"""Random programs for each choice of inputs."""


def main() -> int:
    """Print what is found; return the exit code."""
    if not misra.has_cppcheck():
        print("make misra needs cppcheck with its addon misra (Debian: cppcheck)", file=sys.stderr)
        return 2
    texts = [render_monitor(each) for each in (everything(), *examples())]
    for kinds in c_pairs.FOCUSES.values():
        chosen = c_pairs.cases(kinds, RANDOM, 1, traces=1, first=len(texts))
        texts += [each.unit.texts for each in chosen]
    with tempfile.TemporaryDirectory(prefix="deros-misra-") as folder:
        found = misra.violations(texts, Path(folder))
    wrong = [each for each in found if not each.is_allowed]
    for each in wrong:
        print(each)
    allowed = Counter(each.rule for each in found if each.is_allowed)
    reported = ", ".join(f"rule {rule} {count} times" for rule, count in sorted(allowed.items()))
    print(
        f"{len(texts)} monitors, {len(wrong)} violations; declared deviations: {reported or 'none'}"
    )
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
