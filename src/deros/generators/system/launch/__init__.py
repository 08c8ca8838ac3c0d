"""System descriptions to a launch file for ros2 launch."""
