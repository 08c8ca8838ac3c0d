"""Fuzz the monitors in C of the examples: any bytes as calls, with invariants checked after each.

Exit code 1 says that an invariant was broken, or that a sanitizer found something; the bytes that
do it are kept under ``.tmp/fuzz``. Exit code 2 says that there is no libFuzzer.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path

from tests.support.c_everything import everything, examples
from tests.support.c_fuzz import fuzz_text
from tests.support.c_harness import DRIVER, Unit, unit
from tests.support.capabilities import FUZZED, has_fuzzer

ROOT = Path(__file__).resolve().parents[1]
COMPILER = "clang"
FLAGS = (*FUZZED, "-fno-sanitize-recover=all")


def main() -> int:
    """Fuzz one program after another; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=int, default=30, help="for each program")
    arguments = parser.parse_args()
    folder = ROOT / ".tmp" / "fuzz"
    folder.mkdir(parents=True, exist_ok=True)
    if not has_fuzzer():
        needed = "clang with libFuzzer (Debian: clang, libclang-rt-14-dev)"
        print(f"make fuzz needs {needed}", file=sys.stderr)
        return 2
    for program in (*examples(), everything()):
        made = unit(program)
        if not fuzz(made, folder / made.prefix, arguments.seconds):
            return 1
    return 0


def fuzz(made: Unit, folder: Path, seconds: int) -> bool:
    """Fuzz one monitor for a while; tell whether all went well."""
    corpus = folder / "corpus"
    corpus.mkdir(parents=True, exist_ok=True)
    for name, text in made.texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    (folder / "fuzz.c").write_text(fuzz_text(made), encoding="utf-8")
    command = [
        COMPILER,
        *FLAGS,
        "-I",
        str(DRIVER),
        "-I",
        str(folder),
        "fuzz.c",
        "-o",
        "fuzz",
        "-lm",
    ]
    subprocess.run(command, cwd=folder, check=True)
    options = [f"-max_total_time={seconds}", "-max_len=2048", "-len_control=0", "-timeout=10"]
    shown = ["-print_final_stats=1", f"-artifact_prefix={folder}/"]
    done = subprocess.run(
        ["./fuzz", *options, *shown, "corpus"],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=seconds + 120,
        check=False,
    )
    if done.returncode != 0:
        print(done.stderr)
        print(f"{made.prefix}: a crash; its bytes are kept in {folder}")
        return False
    runs = [line.split()[-1] for line in done.stderr.splitlines() if "executed_units" in line]
    print(f"{made.prefix}: {' '.join(runs)} inputs in {seconds} s, no crash", flush=True)
    return True


if __name__ == "__main__":
    sys.exit(main())
