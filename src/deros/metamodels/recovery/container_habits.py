"""Habits of launch files in what a system says about containers; rows as those of programs."""

from __future__ import annotations

_HEAD = r"(?P<head>\bcontainer\s+\w+(?:[ \t][^\n{}]*?)?\s+)"

CONTAINER_HABITS: tuple[tuple[str, str | None, str, str], ...] = (
    (
        r"(?:component|composable_?node|ComposableNode|node_component)\s+(?=\w+\s*:)",
        "node ",
        "",
        "",
    ),
    (
        r"(?:component_container|composable_node_container|node_container|ComposableNodeContainer)"
        r"\s+(?=\w+)",
        "container ",
        "",
        "",
    ),
    (
        r"\bplugin\s+(?P<at>)(?P<word>[A-Za-z_][\w:]*)",
        r'plugin "\g<word>"',
        r"""write '"\g<word>"': the class is written in quotes""",
        "",
    ),
    (
        r"(?P<head>\bcontainer\s+\w+\s+)(?P<at>)(?:multi-?threaded|multithreaded|mt)\b",
        r"\g<head>multi_threaded",
        "write 'multi_threaded'",
        "",
    ),
    (
        r"(?P<head>\bcontainer\s+\w+\s+)(?P<at>)(?:single_?threaded)\b",
        r"\g<head>",
        "leave it out: that is what a container is without 'multi_threaded'",
        "",
    ),
    (r"(?:load_into|target_container)\s+(?=[\w/\"$])", "into ", "", ""),
    (
        r"(?P<head>\binside\s+\w+\s+)(?P<at>)(?=node\b)",
        r"\g<head>{ ",
        "write '{': the nodes of a process stand in braces",
        "",
    ),
    (
        r"(?P<head>\binside\s+\w+\s+)(?P<at>)(?=(?:node|inside|subsystem|container|topics|process"
        r"|parameters|wirings|when)\b|\}|\Z)",
        None,
        "write 'inside NAME { node ... }'; a component that is loaded has 'into NAME' behind its"
        " type",
        "'inside' has its nodes in braces",
    ),
    (r"(?:unnamed|no_name|keeps?_name|own-name|original_name)\b", "own_name", "", ""),
    (
        r"(?:use_intra_process_comms|use_intra_process|intraprocess|zero_copy)\b",
        "intra_process",
        "",
        "",
    ),
    (
        _HEAD + r"(?P<at>)(?=node\b)",
        r"\g<head>{ ",
        "write '{': the nodes of a container stand in braces",
        "",
    ),
    (
        _HEAD + r"(?P<at>)(?=(?:node|subsystem|container|topics|process)\b|\Z)",
        None,
        "write the nodes in braces: 'container NAME { node ... }'",
        "a container has its nodes in braces",
    ),
)
