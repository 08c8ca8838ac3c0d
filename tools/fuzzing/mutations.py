"""Ways to damage a text or a run of bytes: blind ones, and ones that know tokens and extremes.

Every function takes its chance from a :class:`random.Random`, so that a mutant can be drawn again
from the seed of the run and its number.
"""

from __future__ import annotations

import random
import re
from collections.abc import Callable, Sequence

LONGEST = 1 << 16
"""No mutant is longer than this, in bytes: mutants are of the size of the examples."""

_LONGEST_RUN = 8000
"""Characters of what is repeated: a program may well have written such a line."""

_TOKEN = re.compile(r'"(?:\\.|[^"\\\n])*"|[A-Za-z_]\w*|\d[\w.]*|[~/][\w~/-]*|\s+|.', re.DOTALL)
_NUMBER = re.compile(r"[\d.]")

NUMBERS = (
    *("0", "-0", "1", "-1", "1.", ".5", "007", "1e5", "1e-9", "1e308", "1e309", "-1e309"),
    *("1e-400", "1e999999999", "1e-999999999", "9" * 400, "9" * 5000, f"0.{'0' * 500}1"),
    *("127", "128", "255", "256", "32768", "65536", "2147483648", "4294967296"),
    *("9223372036854775807", "9223372036854775808", "18446744073709551616"),
    *("nan", "inf", "NaN", "Infinity", "0x10", "1e", "1_000", "١٢", "1²", "3.4028236e38"),
)
"""Numbers at and beyond the ends of every type, and texts that only look like numbers."""

NAMES = (
    *("a", "_", "__", "a__b", "A", "x" * 120, "x" * 256, "x" * 5000, "é", "ﬁ", "ª", "名"),
    *("None", "self", "class", "int", "new", "main", "rclpy", "std", "data", "Monitor"),
    *("init", "setup", "launch", "log_state", "math", "NULL", "true", "node", "topic", "for"),
)
"""Names that a target reserves, that collide, or that no file system takes."""

TEXTS = (
    *(r'"\u0000"', r'"\ud800"', r'"\u001b[2J"', r'"\u2028\u0085"', r'"\\"', r'"\""', '""'),
    *('"*/ /* // #"', "\"'''\"", r'"\"\"\""', '"<!-- ]]> & -->"', '"%s %n {} ${x} $(y) `z`"'),
    *(r'"\n---\n"', r'"\x"', '"\u202e\ufeff"', f'"{"a" * 5000}"', '"../../x"', '"/dev/null"'),
    *('"*"', '"**/*.rnd"', '"."', '"??/"', '"[a-"', '"/* @begin */"', '"TODO: */ exit(1);"'),
)
"""Quoted texts that would break out of a comment, a string or a format of some target."""

TOPICS = (
    *("~", "/", "//", "~/", "~/x", "~x", "/1a", "/a-b", "a/", "/a//b", "/a~b", "__x", "/__/a"),
    *(f"/{'t' * 300}", "/" + "a/" * 130 + "b", "/clock", "/rosout", "/é", "topic"),
)
"""Graph names that ROS 2 refuses, and some that it takes for its own."""

WORDS = (
    *("node", "parameters", "name", "publishes", "subscribes", "topic", "services", "service"),
    *("clients", "client", "actions", "action", "timers", "timer", "every", "qos", "depth", "via"),
    *("system", "imports", "import", "topics", "subsystem", "namespace", "connect", "to", "param"),
    *("external", "respawn", "delay", "max", "use", "unit", "const", "input", "entity", "if"),
    *("then", "optional", "behaviour", "gate", "rate", "limit", "zero", "lost", "heartbeat"),
    *("and", "or", "not", "in", "for", "timeout", "latched", "reset_by", "on", "missing", "age"),
    *("calls", "std_srvs.SetBool"),
    *("string", "double", "bool[]", "byte[]", "size", "one_of", "read_only", "lifecycle"),
    *("(", ")", "[", "]", "{", "}", ";", ":", ",", ".", "->", "=", "-", "+", '"', "//", "/*"),
    *("sec", "ms", "m/s", "rad", "deg", "degC", "m^2", "min", "h", "%", "°", "m**99", "kg*m/s^2"),
    *("float64", "string<=10", "[<=3]", "[]", "[4294967296]", "---", "#", "geometry_msgs/Point"),
    *("NaN", "null", "Infinity", "true", "false", "\0", "\x1b", "\x0c", "\u2028", "\ud7ff"),
)
"""Words and signs of all languages that are read."""


def mutate_text(text: str, others: Sequence[str], chance: random.Random) -> str:
    """Return the text after a few mutations of its tokens; parts of ``others`` may come into it."""
    tokens = _TOKEN.findall(text)
    for _ in range(_few(chance)):
        if not tokens:
            tokens = [chance.choice(WORDS)]
        mutation = chance.choices(_MUTATIONS, _WEIGHTS)[0]
        mutation(tokens, others, chance)
    return "".join(tokens)[:LONGEST]


def mutate_bytes(data: bytes, chance: random.Random) -> bytes:
    """Return the data after a few mutations that know nothing of what it means."""
    changed = bytearray(data)
    for _ in range(_few(chance)):
        place = chance.randrange(len(changed) + 1)
        way = chance.randrange(6)
        if way == 0 and changed:
            changed[place % len(changed)] ^= 1 << chance.randrange(8)
        elif way == 1:
            changed[place:place] = chance.randbytes(chance.randint(1, 8))
        elif way == 2:
            del changed[place : place + chance.randint(1, 16)]
        elif way == 3:
            del changed[place:]
        elif way == 4:
            changed[place : place + 4] = chance.choice(_LENGTHS)
        else:
            changed[place:place] = changed[place : place + chance.randint(1, 64)]
    return bytes(changed[:LONGEST])


_LENGTHS = tuple(
    value.to_bytes(4, order)
    for value in (0, 1, 2, 255, 65535, 2**31 - 1, 2**31, 2**32 - 4, 2**32 - 1)
    for order in ("little", "big")
)


def _few(chance: random.Random) -> int:
    """Return how many mutations to make: mostly one or two, seldom many."""
    return chance.choices((1, 2, 3, 5, 12), (50, 25, 15, 8, 2))[0]


# Mutations of tokens ------------------------------------------------------------------------------

_Mutation = Callable[[list[str], Sequence[str], random.Random], None]


def _extreme(tokens: list[str], _others: Sequence[str], chance: random.Random) -> None:
    """Replace a token by an extreme one of its own kind."""
    candidates = [index for index, token in enumerate(tokens) if not token.isspace()]
    if not candidates:
        return
    index = chance.choice(candidates)
    token = tokens[index]
    if token[0] == '"':
        tokens[index] = chance.choice(TEXTS)
    elif _NUMBER.match(token):
        tokens[index] = chance.choice(NUMBERS)
    elif token[0] in "~/":
        tokens[index] = chance.choice(TOPICS)
    elif token[0].isalpha() or token[0] == "_":
        tokens[index] = chance.choice((*NAMES, *WORDS))
    else:
        tokens[index] = chance.choice(WORDS)


def _swap_in(tokens: list[str], _others: Sequence[str], chance: random.Random) -> None:
    tokens[chance.randrange(len(tokens))] = chance.choice(tokens)


def _insert(tokens: list[str], _others: Sequence[str], chance: random.Random) -> None:
    pool = chance.choice((WORDS, NUMBERS, NAMES, TEXTS, TOPICS))
    place = chance.randrange(len(tokens) + 1)
    tokens[place:place] = [" ", chance.choice(pool), " "]


def _delete(tokens: list[str], _others: Sequence[str], chance: random.Random) -> None:
    place = chance.randrange(len(tokens))
    del tokens[place : place + chance.choice((1, 1, 2, 5, 20))]


def _repeat(tokens: list[str], _others: Sequence[str], chance: random.Random) -> None:
    """Repeat some tokens next to themselves, up to a few thousand times if they are short."""
    place = chance.randrange(len(tokens))
    run = tokens[place : place + chance.choice((1, 1, 3, 8))]
    most = 1 + _LONGEST_RUN // max(1, len("".join(run)))
    tokens[place:place] = run * min(most, chance.choice((1, 1, 2, 10, 100, 3000)))


def _nest(tokens: list[str], _others: Sequence[str], chance: random.Random) -> None:
    """Put brackets, as deep as chance has it, around some tokens."""
    place = chance.randrange(len(tokens))
    end = min(len(tokens), place + chance.randint(1, 12))
    opening, closing = chance.choice(
        (
            *(("(", ")"), ("not (", ")"), ("{", "}"), ("[", "]"), ("-", ""), ("not ", "")),
            *(("(", " for 1 sec)"), ("if true then ", " else 1"), ("if true then 1 else ", "")),
        )
    )
    depth = chance.choice((1, 1, 2, 5, 30, 99, 120, 3000))
    tokens[end:end] = [closing] * depth if closing else []
    tokens[place:place] = [opening] * depth


def _move_line(tokens: list[str], _others: Sequence[str], chance: random.Random) -> None:
    """Copy or move one line to another place."""
    lines = "".join(tokens).split("\n")
    source = chance.randrange(len(lines))
    line = lines[source]
    if chance.random() < 0.5:
        del lines[source]
    lines.insert(chance.randrange(len(lines) + 1), line)
    tokens[:] = _TOKEN.findall("\n".join(lines))


def _splice(tokens: list[str], others: Sequence[str], chance: random.Random) -> None:
    """Bring some lines of another text in."""
    if not others:
        return
    lines = chance.choice(others).split("\n")
    start = chance.randrange(len(lines))
    taken = "\n".join(lines[start : start + chance.randint(1, 6)])
    place = chance.randrange(len(tokens) + 1)
    tokens[place:place] = ["\n", *_TOKEN.findall(taken), "\n"]


def _rename(tokens: list[str], _others: Sequence[str], chance: random.Random) -> None:
    """Rename one thing wherever the text names it, so that the text stays sound."""
    names = [token for token in tokens if token[0].isalpha() and token not in WORDS]
    if not names:
        return
    old, new = chance.choice(names), chance.choice((*NAMES, *names))
    tokens[:] = [new if token == old else token for token in tokens]


_MUTATIONS: tuple[_Mutation, ...] = (
    *(_extreme, _swap_in, _insert, _delete, _repeat, _nest, _move_line, _splice, _rename),
)
_WEIGHTS = (30, 10, 12, 10, 8, 6, 8, 8, 8)
