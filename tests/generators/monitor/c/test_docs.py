"""Documentation of the C monitor: its example compiles, and its claims hold."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from deros.generators.monitor.c.deviations import DEVIATIONS, Deviation
from deros.generators.monitor.c.interface import render_monitor
from tests.support.c_everything import examples
from tests.support.needs import needs

DOCS = Path(__file__).resolve().parents[4] / "docs"
WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror"]

MACHINE = """\
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
static int64_t now = -10000000;
int64_t clock_ns(void);
int64_t clock_ns(void) { now += 10000000; return (now < 4000000000) ? now : (exit(1), 0); }
bool radio_speed(double *speed);
bool radio_speed(double *speed) { *speed = (now < 1000000000) ? 0.4 : 0.6; return true; }
bool radio_attitude(double q[4]);
bool radio_attitude(double q[4]) { (void)q; return true; }
void brake(void);
void brake(void) { exit((now >= 3000000000) ? 0 : 2); }
"""
"""A machine that drives too fast from the first second on; braking is correct from the third."""


@needs("gcc")
def test_documented_example_brakes(tmp_path: Path) -> None:
    """The main loop compiles without warnings, and brakes two seconds after the speed rose."""
    (example,) = (each for each in examples() if each.name == "intelligent_one")
    page = (DOCS / "c-monitor.md").read_text(encoding="utf-8")
    (loop,) = re.findall(r"^```c\n(.*?)^```", page, flags=re.DOTALL | re.MULTILINE)
    files = {**render_monitor(example), "main.c": loop, "machine.c": MACHINE}
    for name, text in files.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    sources = [name for name in files if name.endswith(".c")]
    command = ["gcc", "-std=c99", *WARNINGS, *sources, "-o", "loop", "-lm"]
    subprocess.run(command, cwd=tmp_path, check=True, timeout=60)
    assert subprocess.run([tmp_path / "loop"], check=False, timeout=60).returncode == 0


@pytest.mark.parametrize("each", DEVIATIONS, ids=lambda each: each.guideline)
def test_deviations_are_documented(each: Deviation) -> None:
    """The evidence page lists each guideline that the text deviates from, and the reason."""
    page = (DOCS / "evidence.md").read_text(encoding="utf-8")
    assert f"| {each.guideline} (advisory) | {each.reason} |" in page
