"""The command that runs a node: its names, parameters and remappings as ROS 2 reads them."""

from __future__ import annotations

from collections.abc import Sequence
import re
import shlex

from .node import Node, Program, Row, Value


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
    pattern of all nodes, which is what a command line sets. Of a process that is not a node, it is
    the file that is its last argument.
    """
    if isinstance(node, Program):
        return node.file_text or None
    values = [
        f'{_yaml_string(name)}: {yaml(value)}'
        for name, value in node.parameters.items()
        if not _on_command_line(node, name)
    ]
    key = node.full_name if node.files else '/**'
    return f'{{{key}: {{ros__parameters: {{{", ".join(values)}}}}}}}' if values else None


def _on_command_line(node: Node, name: str) -> bool:
    value = node.parameters[name]
    is_long = isinstance(value, str) and len(value) > LONGEST
    return not node.files and not is_long and fits_command_line(name)


def command_line(
    row: Row, program: Sequence[str], file: str | None = None, files: Sequence[str] = ()
) -> list[str]:
    """
    Return the command that runs a node or another process, as a shell would take it apart.

    The file holds what parameter_file() returns; the others are those of the node, which come
    first.
    """
    line = [*shlex.split(row.prefix), *program, *row.arguments]
    if isinstance(row, Program):
        return [*line, *([] if file is None else [file])]
    return [*line, *_for_ros(row, file, files)]


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
    line = ['--ros-args', '-r', f'__node:={node.name}', '-r', f'__ns:={node.namespace}']
    for name, value in node.parameters.items():
        if _on_command_line(node, name):
            line += ['-p', f'{name}:={yaml(value)}']
    for each in [*files, *([] if file is None else [file])]:
        line += ['--params-file', each]
    for port, target in node.remappings.items():
        line += ['-r', f'{port}:={target}']
    if node.log_level is not None:
        # The node's own logger: a level for the whole process would let the middleware talk too.
        logger = node.full_name.strip('/').replace('/', '.')
        line += ['--log-level', f'{logger}:={node.log_level}']
    return line
