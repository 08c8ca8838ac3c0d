"""Names: near matches for hints, and the naming rules of ROS 2.

The checks return ``None`` for a name that ROS 2 accepts, else the reason for rejecting it, a phrase
that completes "the name … ". Sources: ``rcl_validate_topic_name``, ``rmw_validate_node_name``,
``rmw_validate_namespace``, the ROS 2 design article "Topic and Service name mapping", REP 144, and
the command line grammar of rcl for parameters.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from deros.diagnostics import NearMiss

_NODE_LIMIT = 255
_TOPIC_LIMIT = 245  # 255 of a full name, less the prefix that DDS adds
_FORBIDDEN = re.compile(r"[^A-Za-z0-9_]")
_FORBIDDEN_IN_PATH = re.compile(r"[^A-Za-z0-9_/]")
_FORBIDDEN_IN_PARAMETER = re.compile(r"[^A-Za-z0-9_./-]")
_PARAMETER_LIMIT = 1024
_CLOSE = 60  # of 100
_FORBIDDEN_IN_PROGRAM = re.compile(r"[^A-Za-z0-9_.+-]")

# Control characters but tab and line ends, separators that some readers take for line ends, halves
# of characters, and what turns the direction of writing, so that text reads as it does not run.
_NOT_TEXT = re.compile(
    "[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff\u202a-\u202e\u2066-\u2069\ufeff]"
)


def near(name: str, candidates: Iterable[str], n: int = 3) -> list[str]:
    """Return up to ``n`` of the candidates that ``name`` was probably meant to be, best first.

    A difference of case alone is the closest; the name itself is never among them.
    """
    from rapidfuzz import fuzz, process

    distinct = [candidate for candidate in dict.fromkeys(candidates) if candidate != name]
    lowered = name.lower()
    same = [candidate for candidate in distinct if candidate.lower() == lowered]
    close = process.extract(name, sorted(distinct), scorer=fuzz.ratio, limit=n, score_cutoff=_CLOSE)
    return list(dict.fromkeys([*same, *(candidate for candidate, _, _ in close)]))[:n]


def near_any(names: Iterable[str], candidates: Iterable[str]) -> set[str]:
    """Return those of the candidates that one of many names was probably meant to be."""
    from rapidfuzz import fuzz, process

    distinct = sorted(set(candidates))
    by_letters: dict[str, list[str]] = {}
    for each in distinct:
        by_letters.setdefault(each.lower(), []).append(each)
    found: set[str] = set()
    for name in set(names):
        close = process.extract(name, distinct, scorer=fuzz.ratio, limit=4, score_cutoff=_CLOSE)
        same = by_letters.get(name.lower(), ())
        found |= {each for each in (*same, *(each for each, _, _ in close)) if each != name}
    return found


def did_you_mean(matches: Iterable[str], written: str = "", resolved: str = "") -> str:
    """Return near matches as a hint, a :class:`NearMiss`, or an empty text when there are none.

    Args:
        matches: what may have been meant, the likeliest first.
        written: what they are for, as it stands in the text; the place of the finding if empty.
        resolved: the full name of what is written. The edits are relative names, too, if that is.
    """
    meant = tuple(matches)
    if not meant:
        return ""
    *first, last = (f"'{match}'" for match in meant)
    text = f"did you mean {', '.join(first)}{' or ' if first else ''}{last}?"
    if resolved and not written.startswith("/") and resolved.endswith(f"/{written}"):
        meant = tuple(match.removeprefix(resolved.removesuffix(written)) for match in meant)
    return NearMiss(text, meant, written)


def not_text(text: str) -> re.Match[str] | None:
    """Return the match of the first character that is forbidden in any text, or ``None``."""
    return _NOT_TEXT.search(text)


def check_identifier(name: str) -> str | None:
    """Return why a name cannot be used in generated code, or ``None``."""
    if found := _FORBIDDEN.search(name):
        return f"contains '{found[0]}'; a name may contain only A to Z, a to z, digits and '_'"
    if len(name) > _NODE_LIMIT:
        return f"is longer than {_NODE_LIMIT} characters"
    return None


def check_node_name(name: str) -> str | None:
    """Return why ROS 2 rejects a node's name (without namespace), or ``None``."""
    if not name:
        return "is empty"
    if found := _FORBIDDEN.search(name):
        return f"contains '{found[0]}'; a node name may contain only letters, digits and '_'"
    if name[0].isdigit():
        return "starts with a digit"
    if len(name) > _NODE_LIMIT:
        return f"is longer than {_NODE_LIMIT} characters"
    return None


def check_topic_name(name: str) -> str | None:
    """Return why ROS 2 rejects a topic or service name, absolute, relative or private (``~/x``)."""
    if not name:
        return "is empty"
    path = name
    if name.startswith("~"):
        path = name[1:]
        if path and not path.startswith("/"):
            return "has '~' without '/' behind it"
    return _check_path(path, name)


def is_too_long(name: str) -> bool:
    """Return whether a full name, of a topic or a node, is longer than ROS 2 allows."""
    return len(name) > _TOPIC_LIMIT


def check_namespace(name: str) -> str | None:
    """Return why ROS 2 rejects a namespace, absolute or relative, or ``None``."""
    if not name:
        return "is empty"
    return None if name == "/" else _check_path(name, name)


def _check_path(path: str, whole: str) -> str | None:
    if "~" in path:
        return "has '~' after its start"
    if found := _FORBIDDEN_IN_PATH.search(path):
        return f"contains '{found[0]}'; a graph name may contain only letters, digits, '_' and '/'"
    if path.endswith("/"):
        return "ends with '/'"
    if "//" in path:
        return "has an empty part ('//')"
    for part in path.split("/"):
        if part[:1].isdigit():
            return f"has a part that starts with a digit ('{part}')"
    if len(whole) > _TOPIC_LIMIT:
        return f"is longer than {_TOPIC_LIMIT} characters"
    return None


def check_package_name(name: str) -> str | None:
    """Return why a package's name is rejected (REP 144 and rosidl), or ``None``."""
    if len(name) < 2:
        return "is shorter than two characters"
    if found := re.search(r"[^a-z0-9_]", name):
        allowed = "lower-case letters, digits and '_'"
        return f"contains '{found[0]}'; a package name may contain only {allowed}"
    if not name[0].isalpha():
        return "does not start with a letter"
    if "__" in name:
        return "contains '__'"
    if name.endswith("_"):
        return "ends with '_'"
    return None


def check_parameter_name(name: str) -> str | None:
    """Return why a parameter's name (parts joined by ``.``) is rejected, or ``None``.

    ROS 2 gives nodes any name from a parameter file; these are the characters that all its tools
    take.
    """
    if not name:
        return "is empty"
    if found := _FORBIDDEN_IN_PARAMETER.search(name):
        allowed = "letters, digits, '_', '.', '/', '-'"
        return f"contains '{found[0]}'; a parameter name may contain only {allowed}"
    if not all(name.split(".")):
        return "has an empty part"
    if len(name) > _PARAMETER_LIMIT:
        return f"is longer than {_PARAMETER_LIMIT} characters"
    return None


def check_timer_name(name: str) -> str | None:
    """Return why a timer's name, which becomes part of a method's, is rejected, or ``None``."""
    return "starts with a digit" if name[:1].isdigit() else check_identifier(name)


def check_program_name(name: str) -> str | None:
    """Return why a name is not the plain file name of a package's program, or ``None``.

    What ``ros2 run`` takes is a file in the package's own folder. A path, a pattern or an option
    would let a description start any program of the machine.
    """
    if not name:
        return "is empty"
    if found := _FORBIDDEN_IN_PROGRAM.search(name):
        allowed = "letters, digits, '_', '.', '+', '-'"
        return f"contains {found[0]!r}; a program's name may contain only {allowed}"
    if name[0] in ".-":
        return f"starts with '{name[0]}'"
    if len(name) > _NODE_LIMIT:
        return f"is longer than {_NODE_LIMIT} characters"
    return None
