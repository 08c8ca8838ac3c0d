"""Tunable constants of the monitor in C: its owner hands them in, and the monitor checks them."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from deros.generators.monitor.c.interface import render_monitor
from tests.support.needs import needs
from tests.support.rules import program

RULES = """
action stop;
input v = topic /odom.twist.twist.linear.x
const limit = 0.5 m/s tunable in [0.1, 1] m/s "Greatest */ speed"
const other = 1 tunable in [0, 2]
entity e { fast: v > limit; more: v > other * limit; }
if e.fast or e.more then { stop; };
"""
MAIN = """
#include <math.h>
#include <stdio.h>
#include "rules_monitor.h"

void rules_emit(void *owner, int64_t t, rules_kind kind, uint32_t site)
{
  (void)owner; (void)t; (void)kind; (void)site;
}

int main(void)
{
  rules_monitor m;
  rules_constants constants = rules_default_constants;
  constants.limit = VALUE;
  const bool valid = rules_start(&m, 0, 0, 0, &constants);
  constants.limit = 9.0;
  rules_on_v(&m, 1, 0.45);
  printf("%d %g %d", valid, m.limit, m.e_fast == RULES_TRUE);
  return 0;
}
"""


def compiled(folder: Path) -> None:
    """Compile a monitor with its main program, warnings as errors."""
    strict = ("-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror")
    command = ["gcc", *strict, "main.c", "rules_monitor.c", "-lm", "-o", "main"]
    subprocess.run(command, cwd=folder, check=True, timeout=60)


@needs("gcc")
@pytest.mark.parametrize(
    ("value", "printed"),
    [
        ("0.4", "1 0.4 1"),
        ("rules_default_constants.limit", "1 0.5 0"),
        ("0.1", "1 0.1 1"),
        ("1.0", "1 1 0"),
        ("1.5", "0 0.5 0"),
        ("0.0", "0 0.5 0"),
        ("NAN", "0 0.5 0"),
        ("INFINITY", "0 0.5 0"),
    ],
)
def test_refused_constants_start_the_monitor_with_its_defaults(
    value: str, printed: str, tmp_path: Path
) -> None:
    """It tells so, and keeps no pointer to what it was given."""
    for name, text in render_monitor(program(RULES)).items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    (tmp_path / "main.c").write_text(MAIN.replace("VALUE", value), encoding="utf-8")
    compiled(tmp_path)
    done = subprocess.run([tmp_path / "main"], capture_output=True, text=True, check=True)
    assert done.stdout == printed


@needs("gcc")
def test_constant_that_no_rule_reads_is_checked_all_the_same(tmp_path: Path) -> None:
    """The monitor compiles, and refuses a wrong value."""
    unused = RULES.replace("v > limit", "v > 0.5 m/s").replace("v > other * limit", "v > 1 m/s")
    for name, text in render_monitor(program(unused)).items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    main = MAIN.replace("VALUE", "2.0").replace("m.limit", "0.0")
    (tmp_path / "main.c").write_text(main, encoding="utf-8")
    compiled(tmp_path)
    done = subprocess.run([tmp_path / "main"], capture_output=True, text=True, check=True)
    assert done.stdout == "0 0 0"
