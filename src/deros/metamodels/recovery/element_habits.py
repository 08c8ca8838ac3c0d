"""Habits at elements of arrays: a pattern, what to write instead, a hint and a message."""

from __future__ import annotations

ELEMENT_HABITS: tuple[tuple[str, str | None, str, str], ...] = (
    (
        r"\[\s*(?P<name>[^\W\d]\w*)\s*[=:]=?\s*"
        r"(?P<mark>['\"]?)(?P<said>[A-Za-z_][\w/ .-]*)(?P=mark)\s*\]",
        r'[\g<name> = "\g<said>"]',
        r"""write '[\g<name> = "\g<said>"]'""",
        "what an element is called is a text in double quotes",
    ),
    (
        r"\[\s*(?P<mark>['\"])(?P<said>[^'\"\n]*)(?P=mark)\s*\]",
        r'[name = "\g<said>"]',
        r"""write '[name = "\g<said>"]' for the element whose 'name' it is""",
        "an element is found by one of its fields",
    ),
    (
        r"\[\s*[^\W\d]\w*(?:\.\w+)+\s*=[^\]\n]*\]",
        None,
        """write '[name = "lidar"]', with a field that the element itself has""",
        "an element is not found by a field of one of its parts",
    ),
    (
        r"\[\s*-\s*\d+\s*\]",
        None,
        "0 is the first element",
        "elements are not counted from the end",
    ),
)
