"""Habits of launch files and shells in what a system says about programs and groups.

Each row is a pattern, the text to write instead (``None`` if that is unknown), the hint (if empty,
to write that text), and the message (if empty, that of any syntax error).
"""

from __future__ import annotations

PROGRAM_HABITS: tuple[tuple[str, str | None, str, str], ...] = (
    (
        r"\b(?P<head>param\s+[\w./-]+)\s*=\s*(?P<at>)(?:from\s+)?xacro\s+(?=[\"$])",
        r"\g<head> from xacro ",
        "write 'from xacro' without '='",
        "",
    ),
    (
        r"\b(?P<head>param\s+[\w./-]+)\s*=\s*(?P<at>)Command\s*\(",
        None,
        "write 'from xacro \"PATH\" (NAME = VALUE)' instead of '= Command(…)'",
        "",
    ),
    (
        r"\b(?P<head>file\s+\w+)\s*(?P<at>)(?:=|:)\s*(?:from\s+)?xacro\s+(?=[\"$])",
        r"\g<head> from xacro ",
        "write 'from xacro' without '='",
        "",
    ),
    (
        r"(?P<head>\bparameters\s+from\s+(?:\"[^\"\n]*\"|\$\w+))\s+"
        r"(?P<at>)(?:root_key|under)\b\s*(?:=\s*)?",
        r"\g<head> below ",
        "write 'below' before the namespace that the keys are moved to",
        "",
    ),
    (r"args\s*(?=\[)", "arguments ", "", ""),
    (
        r"arguments\s+(?P<at>)(?P<word>\"[^\"\n]*\"|\$\w+)",
        r"arguments [\g<word>]",
        r"write the words in brackets: 'arguments [\g<word>]'",
        "",
    ),
    (
        r"(?P<head>\barguments\s*\[[^\]\n]*?)(?P<at>)(?P<word>--?[A-Za-z][\w-]*)",
        r'\g<head>"\g<word>"',
        r"""write the words in quotes: '"\g<word>"'""",
        "",
    ),
    (r"(?:environment|set_?env|additional_env|SetEnvironmentVariable)\b", "env", "", ""),
    (
        r"\benv\s*(?P<at>)\{\s*(?P<name>[A-Za-z_]\w*)\s*[=:]\s*(?P<value>\"[^\"\n]*\")\s*\}",
        r"env \g<name> = \g<value>",
        "",
        "",
    ),
    (
        r"\benv\s*(?P<at>)\{",
        None,
        "write 'env NAME = \"VALUE\"' for each variable",
        "",
    ),
    (r",\s*(?=[A-Za-z_]\w*\s*=)", " env ", "write 'env' before each variable", ""),
    (r"launch[-_]prefix\b", "prefix", "", ""),
    (r"(?:working_directory|work_?dir|directory)\b", "cwd", "", ""),
    (
        r"\b(?P<head>prefix|cwd|process\s+\w+\s*:)\s*(?P<at>)(?P<word>[~./\w][\w./~-]*)",
        r'\g<head> "\g<word>"',
        r"""write '"\g<word>"': strings are written in quotes""",
        "",
    ),
    (r"executable\s+(?=\w+\s*:)", "process ", "", ""),
    (
        r"\bprocess\s+\w+\s*:[^\n]*?\s(?P<at>)(?P<word>namespace|log_level|wirings|activated)\b",
        None,
        "remove it, or describe the program as a node, in a '.rnd' file",
        "a process is not a node: it has no such thing",
    ),
    (
        r"\bremap\s+(?P<name>[\w/~]+)\s*(?P<at>):=\s*",
        r"remap \g<name> to ",
        "write 'to' instead of ':='",
        "",
    ),
    (r"connect\s+(?=[\w/~]+\s+to\b)", "remap ", "", ""),
    (r"include\s+(?=\"[^\"\n]*\.(?:py|xml|ya?ml)\")", "launch ", "", ""),
    (
        r"\blaunch\s+(?:\"[^\"\n]*\"|\$\w+)\s*(?P<at>)(?:with|args|arguments)\b",
        None,
        "write the arguments in parentheses: '(name = value, …)'",
        "",
    ),
    (
        r"(?P<head>\blaunch\b[^\n]*?\w)\s*(?P<at>):=",
        r"\g<head> =",
        "write '=' instead of ':='",
        "",
    ),
    (
        r"\blaunch\s+(?:\"[^\"\n]*\"|\$\w+)[^{\n]*?\s(?P<at>)"
        r"(?P<word>respawn|autostart|env|prefix|log_level|delay|after|parameters|remappings|wirings)\b",
        None,
        "remove it; 'env', 'parameters' and 'remappings' of a subsystem around it count for all of"
        " its nodes",
        "a launch file is started as it is: it has no such thing",
    ),
    (
        r"(?:after|on)[-_](?:process[-_])?exit\s+(?:of\s+)?(?!(?:[Ss]hutdown|stop)\b)(?=\w)",
        "after exit of ",
        "",
        "",
    ),
    (
        r"\bon\s+exit\s+(?P<at>)of\s+(?=\w)",
        "after exit of ",
        "write 'after exit of'",
        "",
    ),
    (r"start[-_ ](?:after|delay|delayed)\s+(?=[\d.])", "delay ", "", ""),
    (r"\bafter\s+(?P<at>)(?=[\d.]+\s*(?:sec|ms|min|s)\b)", "delay ", "write 'delay'", ""),
    (
        r"\bafter\s+(?P<kind>node|active)\s+(?P<at>)/(?P<name>\w+(?:/\w+)*)",
        r"after \g<kind> \g<name>",
        "write the name that the program has in the system, with its subsystems, and no '/' before",
        "",
    ),
    (
        r"\bafter\s+(?P<at>)(?:start|launch)\s+of\s+(?P<name>[A-Za-z_]\w*)",
        r"after node \g<name>",
        r"write 'after node \g<name>'",
        "",
    ),
    (
        r"\b(?:wait[-_ ]?for|requires|depends[-_ ]?on)\s+(?=(?:node|service|topic|active)\b)",
        "after ",
        "",
        "",
    ),
    (
        r"\bafter\s+(?P<at>)(?P<word>(?:managed|lifecycle|action|services|topics|nodes)\b)",
        None,
        "write 'after node NAME', 'active NAME', 'service NAME', 'topic NAME' or 'exit of NAME'",
        "",
    ),
    (r"\bafter\s+(?P<at>)(?P<word>[A-Za-z_]\w*)", r"after exit of \g<word>", "", ""),
    (
        r"\bon\s+exit\s+(?P<at>)(?:[Ss]hutdown|stop|quit|kill)\b(?:\(\))?",
        "on exit stop all",
        "",
        "",
    ),
    (
        r"on[-_]exit\s*(?:=\s*)?(?:[Ss]hutdown|stop|quit|kill)\b(?:\(\))?",
        "on exit stop all",
        "",
        "",
    ),
    (r"auto[-_]start\b", "autostart", "", ""),
    (r"on[-_]failure\b", "on failure", "", ""),
    (
        r"on\s+failure\s+(?P<at>)(?:abort|exit|halt|kill|shutdown|shut\s+down)\b",
        "on failure stop",
        "",
        "",
    ),
    (
        r"on\s+failure\s+(?P<at>)(?:go\s+on|ignore|keep[-_]going|proceed)\b",
        "on failure continue",
        "",
        "",
    ),
)
