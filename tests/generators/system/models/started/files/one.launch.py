"""Starts one node, whose side is the argument of this file."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    """Return the node."""
    name = LaunchConfiguration("name")
    return LaunchDescription(
        [
            DeclareLaunchArgument("name"),
            Node(package="parts", executable="any_part", name="one", parameters=[{"side": name}]),
        ]
    )
