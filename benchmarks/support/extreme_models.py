"""Models of any length that take as much of a check as models can."""

from __future__ import annotations

from collections.abc import Callable

NODE = "node n : demo\n"
MB = 1 << 20


def _million_parameters() -> str:
    return NODE + "parameters\n" + "".join(f"  name p{i} : double = 1\n" for i in range(1_000_000))


MODELS: dict[str, tuple[str, Callable[[], str], str]] = {
    "a million parameters": (".rnd", _million_parameters, "DRS008"),
    "a text of 20 MB": (".rnd", lambda: f'{NODE[:-1]} "{"a" * 20 * MB}"', "DRS008"),
    "a text of 3 MB": (".rnd", lambda: f'{NODE[:-1]} "{"a" * 3 * MB}"', ""),
    "escapes of 3 MB": (".rnd", lambda: NODE[:-1] + ' "' + r"\n" * (3 * MB // 2) + '"', ""),
    "a comment of 3 MB": (".rnd", lambda: f"/*{'*' * 3 * MB}*/ {NODE}", ""),
    "blanks of 3 MB": (".rnd", lambda: " " * 3 * MB + NODE, ""),
    "a word of 80 KB as a unit": (".deros", lambda: "const a = 1 " + "x" * 80_000, "DRS007"),
    "words of 80 KB as a unit": (".deros", lambda: "const a = 1 " + "x*" * 40_000 + "x", "DRS006"),
    "a unit of 80 KB in brackets": (
        ".rnd",
        lambda: f"{NODE}parameters name p : double = 1 [{'x*' * 40_000}x]",
        "DRS006",
    ),
    "units that explode": (
        ".deros",
        lambda: (
            "unit p = 1e300 m\n"
            + "".join(f"unit p{i} = 1e300 p{i - 1 if i else ''}^99\n" for i in range(6))
            + "const x = 1 p5"
        ),
        "DRS006",
    ),
    "units that name each other": (
        ".deros",
        lambda: "".join(f"unit x{i} = 2 x{i + 1}\n" for i in range(5_000)) + "unit x5000 = 1 m",
        "DRS006",
    ),
    "constants that name each other": (
        ".deros",
        lambda: "".join(f"const u{i} = u{i + 1}\n" for i in range(3_000)) + "const u3000 = 1",
        "DRS004",
    ),
    "unknown names beside unused ones": (
        ".deros",
        lambda: (
            f"entity e {{ {''.join(f'r{i}: speed{i} > 1; ' for i in range(1_000))} }}"
            + "".join(f"const limit{i} = {i}\n" for i in range(1_000))
        ),
        "DRS310",
    ),
    "a name of 300 letters": (".rnd", lambda: f"node {'n' * 300} : demo", "DRS007"),
    "a name of 3 MB": (".rnd", lambda: f"node {'n' * 3 * MB} : demo", "DRS007"),
    "a topic of 1 MB": (".rnd", lambda: f"{NODE}publishes topic {'/a' * MB} : a.B", "DRS105"),
    "an index of 5,000 digits": (
        ".deros",
        lambda: f"input x = topic /a.b[{'9' * 5000}]",
        "DRS003",
    ),
    "an exponent of 5,000 digits": (".deros", lambda: f"const a = 1e{'9' * 5000}", "DRS003"),
    "a power of 5,000 digits": (".deros", lambda: f"const a = 1 m^{'9' * 5000}", "DRS003"),
    "a fraction of 1 MB": (".deros", lambda: f"const a = 0.{'0' * MB}1", "DRS003"),
    "200,000 signs": (".deros", lambda: f"const a = {'-' * 200_000}1", "DRS004"),
    "nested functions": (".deros", lambda: f"const a = {'f(' * 99}1{')' * 98}", "DRS003"),
    "alternating not and for": (
        ".deros",
        lambda: f"entity e {{ r: {'(not ' * 98}x{' or x for 1 sec)' * 98}; }}",
        "DRS310",
    ),
    "20,000 imports": (".system", lambda: "system s imports " + 'import "x" ' * 20_000, "DRS005"),
}
"""By name: the suffix of the file, its text, and the code of the finding; empty if it is sound."""
