"""The command that runs a node: its names, parameters and remappings as ROS 2 reads them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
import re
import shlex

from .node import Inside, Node, Program, Row, Value


def yaml(value: Value) -> str:
    """Return a value as ROS 2 reads it from YAML: doubles as doubles, every string quoted."""
    if isinstance(value, bool):
        return 'true' if value else 'false'
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return _yaml_float(value)
    if isinstance(value, str):
        return _yaml_string(value)
    return f'[{", ".join(yaml(element) for element in value)}]'


def _yaml_float(value: float) -> str:
    if value != value:
        return '.nan'
    if value in (float('inf'), float('-inf')):
        return '.inf' if value > 0 else '-.inf'
    mantissa, exponent, power = repr(value).partition('e')
    return f'{mantissa if "." in mantissa else mantissa + ".0"}{exponent}{power}'


# YAML allows no control characters, and would fold the line ends of Unicode.
_TO_ESCAPE = re.compile('["\\\\\x00-\x1f\x7f-\x9f\u2028\u2029\ufeff]')


def _yaml_string(value: str) -> str:
    def escape(match: re.Match[str]) -> str:
        return '\\' + match[0] if match[0] in '"\\' else f'\\u{ord(match[0]):04x}'

    return '"' + _TO_ESCAPE.sub(escape, value) + '"'


# What the command line of rcl reads as a parameter's name; a file may hold any other name, too.
_WORD = r'(?!__)[A-Za-z_]\w*'
_NAME_FOR_COMMAND_LINE = re.compile(rf'/?{_WORD}(?:(?:/|\./?){_WORD})*', re.ASCII)


# Linux takes no word of more than 128 KiB; from here on, a list of processes is hard to read.
LONGEST = 1024  # characters of a text


def fits_command_line(name: str) -> bool:
    """Tell whether a command line can name a parameter."""
    return _NAME_FOR_COMMAND_LINE.fullmatch(name) is not None


def parameter_file(node: Row) -> str | None:
    """
    Return the file with the parameters that no command line can hold; None without any.

    Those of a node with parameter files are all in it, under the full name: the name wins over the
    pattern of all nodes, which is what a command line sets. So are those of several nodes in one
    process. Of a process that is not a node, it may be the file that is its last argument.
    """
    sections = {each.full_name: each.parameters for each in node.inside}
    if isinstance(node, Node):
        left = {n: v for n, v in node.parameters.items() if not _on_command_line(node, n)}
        sections = {node.key: left, **sections}
    elif node.file_text:
        return node.file_text
    written = [
        f'{key}: {{ros__parameters: {{{", ".join(_entries(values))}}}}}'
        for key, values in sections.items()
        if values
    ]
    return f'{{{", ".join(written)}}}' if written else None


def _entries(values: Mapping[str, Value]) -> Iterator[str]:
    return (f'{_yaml_string(name)}: {yaml(value)}' for name, value in values.items())


def _on_command_line(node: Node, name: str) -> bool:
    value = node.parameters[name]
    is_long = isinstance(value, str) and len(value) > LONGEST
    return node.key == '/**' and not is_long and fits_command_line(name)


def command_line(
    row: Row, program: Sequence[str], file: str | None = None, files: Sequence[str] = ()
) -> list[str]:
    """
    Return the command that runs a node or another process, as a shell would take it apart.

    The file holds what parameter_file() returns; the others are those of the node, which come
    first.
    """
    line = [*shlex.split(row.prefix), *program, *row.arguments]
    if isinstance(row, Node):
        return [*line, *_for_ros(row, file, files)]
    if row.inside:
        return [*line, *_for_inside(row, file)]
    return [*line, *([] if file is None else [file])]


def load_command(node: Node) -> list[str]:
    """Return the command that loads a node into its container by hand."""
    line = ['ros2', 'component', 'load', node.container, node.package, node.plugin]
    line += ['--node-name', node.name, '--node-namespace', node.namespace]
    for port, target in node.remappings.items():
        line += ['--remap-rule', f'{port}:={target}']
    for name, value in node.parameters.items():
        line += ['--parameter', f'{name}:={yaml(value)}']
    if node.intra_process:
        line += ['--extra-argument', 'use_intra_process_comms:=true']
    return line


def _for_ros(node: Node, file: str | None, files: Sequence[str]) -> list[str]:
    rules = names_inside(node.inside, node.namespace, renamed=not node.own_name)
    rules += [] if node.own_name else [f'__node:={node.name}']
    line = ['--ros-args', *_flagged('-r', [*rules, f'__ns:={node.namespace}'])]
    for name, value in node.parameters.items():
        if _on_command_line(node, name):
            line += ['-p', f'{name}:={yaml(value)}']
    for each in [*files, *([] if file is None else [file])]:
        line += ['--params-file', each]
    only = f'{node.name}:' if node.inside else ''
    line += _flagged('-r', [f'{only}{port}:={to}' for port, to in node.remappings.items()])
    line += _flagged('-r', remappings_inside(node.inside))
    if node.log_level is not None:
        # The node's own logger: a level for the whole process would let the middleware talk too.
        logger = node.full_name.strip('/').replace('/', '.')
        line += ['--log-level', f'{logger}:={node.log_level}']
    return line


def _for_inside(process: Program, file: str | None) -> list[str]:
    """Return what a process that is not a node is given for the nodes in it, if anything."""
    rules = [*names_inside(process.inside, '/', renamed=False), *remappings_inside(process.inside)]
    if not rules and parameter_file(process) is None and not process.files:
        return []
    files = [*process.files, *([] if file is None else [file])]
    return ['--ros-args', *_flagged('-r', rules), *_flagged('--params-file', files)]


def names_inside(nodes: Sequence[Inside], namespace: str, *, renamed: bool) -> list[str]:
    """
    Return the rules that keep the names of nodes in the process of another one.

    They stand before those for all nodes of the process: of several rules, the first one counts.
    """
    rules = [f'{node.name}:__node:={node.name}' for node in nodes if renamed]
    elsewhere = [node for node in nodes if node.namespace != namespace]
    return rules + [f'{node.name}:__ns:={node.namespace}' for node in elsewhere]


def remappings_inside(nodes: Sequence[Inside]) -> list[str]:
    """Return the remappings of nodes in the process of another one, each for its node alone."""
    return [f'{node.name}:{port}:={to}' for node in nodes for port, to in node.remappings.items()]


def _flagged(flag: str, words: Sequence[str]) -> list[str]:
    return [each for word in words for each in (flag, word)]
