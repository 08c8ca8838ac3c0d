"""Existing launch files, which ros2 launch starts as they are."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from .command_line import yaml
from .node import Program, Value

# launch itself gives its processes 5 seconds to end after SIGINT, and as many after SIGTERM.
TIME_OF_LAUNCH = 10.0


@dataclass(frozen=True)
class Launch(Program):
    """
    One launch file, with the arguments that it gets, and what counts for all of its nodes.

    A command line has no words for a namespace, parameters and remappings, nor for an argument
    that is empty: they stand in a launch file of our own, which includes the other one.
    """

    program: str = 'ros2'
    file: str = ''  # beside this file, or share:PACKAGE/PATH
    launch_arguments: Mapping[str, str] = field(default_factory=dict)
    namespace: str = '/'
    parameters: Mapping[str, Value] = field(default_factory=dict)
    parameter_files: Sequence[str] = ()
    remappings: Mapping[str, str] = field(default_factory=dict)

    def located(self, locate: Callable[[str], str]) -> Program:
        """Return the process of ros2 launch, given where a file is."""
        path, *files = map(locate, (self.file, *self.parameter_files))
        settings = list(self._settings(files))
        plain = not settings and all(self.launch_arguments.values())
        given = [f'{name}:={value}' for name, value in self.launch_arguments.items()]
        return Program(
            name=self.name,
            program=self.program,
            arguments=('launch', path, *given) if plain else ('launch',),
            subsystem=self.subsystem,
            environment=self.environment,
            files=(path, *files),
            needs=('ros2launch',),
            file_text='' if plain else self._including(path, settings),
            time_to_stop=TIME_OF_LAUNCH,
        )

    def _settings(self, files: Sequence[str]) -> list[str]:
        """Return the actions that set what counts for all nodes."""
        return [
            *([f'PushRosNamespace({self.namespace!r})'] if self.namespace != '/' else []),
            *(f'SetParametersFromFile({each!r})' for each in files),
            *(
                # As text for the command line of a node, which shows the type of each value.
                f'SetParameter({name!r}, ParameterValue({yaml(value)!r}, value_type=str))'
                for name, value in self.parameters.items()
            ),
            *(f'SetRemap({name!r}, {target!r})' for name, target in self.remappings.items()),
        ]

    def _including(self, path: str, settings: Sequence[str]) -> str:
        """Return a launch file that includes the other one."""
        source = f'AnyLaunchDescriptionSource({path!r})'
        given = f'launch_arguments={list(self.launch_arguments.items())!r}'
        actions = [*settings, f'IncludeLaunchDescription({source}, {given})']
        listed = ''.join(f'        {each},\n' for each in actions)
        return (
            'from launch import LaunchDescription\n'
            'from launch.actions import IncludeLaunchDescription\n'
            'from launch.launch_description_sources import AnyLaunchDescriptionSource\n'
            'from launch_ros.actions import (\n'
            '    PushRosNamespace, SetParameter, SetParametersFromFile, SetRemap)\n'
            'from launch_ros.parameter_descriptions import ParameterValue\n\n\n'
            'def generate_launch_description():\n'
            f'    return LaunchDescription([\n{listed}    ])\n'
        )
