"""Values of parameters in a launch file, which launch reads as YAML."""

from __future__ import annotations

_LONGEST = 50_000
"""Characters of a value."""


def yaml_value(text: str) -> object:
    """Return what YAML makes of a text; the text itself if it makes nothing of it.

    An alias is not followed: it may make much of little.

    Raises:
        ValueError: the text is too long.
    """
    import yaml

    if len(text) > _LONGEST:
        raise ValueError
    if "&" in text and "*" in text:
        return text
    try:
        found: object = yaml.safe_load(text)
    except (yaml.YAMLError, ValueError, RecursionError):
        return text
    return text if found is None else found
