"""Habits of other languages in descriptions of nodes; rows as those of programs."""

from __future__ import annotations

from deros.metamodels.recovery.edits import NUMBER

NODE_HABITS: tuple[tuple[str, str | None, str, str], ...] = (
    (r"subscriptions?\b|subscribers?\b", "subscribes", "", ""),
    (r"publications?\b|publishers?\b", "publishes", "", ""),
    (
        r"(?P<type>double|integer|int|float|bool|string)\s+(?P<name>[a-z_]\w*)(?=\s*(?:=|$))",
        r"name \g<name> : \g<type>",
        "",
        "",
    ),
    (rf"(?P<low>{NUMBER})\s*\.\.\.?\s*(?P<high>{NUMBER})", r"[\g<low>, \g<high>]", "", ""),
    (r"range\s*(?=[\[(])", "in ", "", ""),
    (r"one\s+of\b|oneof\b", "one_of", "", ""),
    (
        rf"=\s*{NUMBER}\s*(?P<at>)[A-Za-z][A-Za-z/^0-9]*(?=\s*\[)",
        None,
        "write the number in the parameter's own unit, which is in brackets",
        "values are written without a unit",
    ),
    (
        rf"(?P<value>=\s*{NUMBER})\s*(?P<at>)(?P<unit>(?!in\b)[A-Za-z][A-Za-z/^0-9]*)",
        r"\g<value> [\g<unit>]",
        r"the unit of a parameter is written in brackets: '[\g<unit>]'",
        "",
    ),
    (r"\{(?P<items>[^{}\n]*)\}", r"[\g<items>]", "lists are written in brackets", ""),
    (
        r"=\s*(?P<value>[^:\s](?:[^:\n]*[^:\s])?)\s*:\s*(?P<type>\w+)",
        r": \g<type> = \g<value>",
        r"write the type before the value: ': \g<type> = \g<value>'",
        "",
    ),
)
