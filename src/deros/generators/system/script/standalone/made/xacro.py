"""Values of parameters that xacro makes of files, before anything is started."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
import shlex
import subprocess
import sys

from ..node import Node

# By hand, the text gets to a node through a file, too: no command line holds a long one.
_TO_FILE = (
    'import json, sys; print(json.dumps('
    '{sys.argv[1]: {"ros__parameters": {sys.argv[2]: sys.stdin.read()}}}, ensure_ascii=False))'
)


@dataclass(frozen=True)
class Xacro:
    """A text that xacro makes of a file: beside this file, or share:PACKAGE/PATH."""

    file: str
    arguments: Mapping[str, str] = field(default_factory=dict)

    @property
    def command(self) -> list[str]:
        """Return the command that prints the text."""
        given = [f'{name}:={value}' for name, value in self.arguments.items()]
        return ['xacro', self.file, *given]

    def text(self, environment: dict[str, str]) -> str:
        """Return the text; raise ValueError, with the words of xacro, if there is none."""
        try:
            found = subprocess.run(self.command, capture_output=True, env=environment)
            said = found.stderr.decode(errors='replace')
            if found.returncode == 0:
                sys.stderr.write(said)  # warnings
                return found.stdout.decode()
            why = f'{said.rstrip()}\nit has ended with {found.returncode}'
        except OSError as fault:
            why = str(fault)
        except UnicodeDecodeError:
            why = 'what it prints is not UTF-8'
        raise ValueError(f'{shlex.join(self.command)}\n{why}'.replace('\n', '\n  '))


@dataclass(frozen=True)
class DescribedNode(Node):
    """A node with parameters whose values xacro makes."""

    xacro: Mapping[str, Xacro] = field(default_factory=dict)
    tools: Sequence[str] = ('xacro',)

    def located(self, locate: Callable[[str], str]) -> DescribedNode:
        """Return it as it is run, given where a file is."""
        xacro = {name: replace(each, file=locate(each.file)) for name, each in self.xacro.items()}
        return replace(self, files=tuple(map(locate, self.files)), xacro=xacro)

    @property
    def sources(self) -> Sequence[str]:
        """Return the files that have to be there."""
        return (*self.files, *(each.file for each in self.xacro.values()))

    def complete(self, environment: dict[str, str]) -> Node:
        """Return it with all values; raise ValueError if xacro cannot make one."""
        made = {name: each.text(environment) for name, each in self.xacro.items()}
        return replace(self, parameters={**self.parameters, **made}, xacro={})

    def by_hand(self) -> str:
        """Return what bash needs behind the command of the node to make the values."""
        words = []
        for name, each in self.xacro.items():
            command = shlex.join(each.command)
            if self.container:
                words.append(f' --parameter {name}:="$({command})"')
            else:
                code = shlex.join(['python3', '-c', _TO_FILE, self.key, name])
                words.append(f' --params-file <({command} | {code})')
        return ''.join(words)
