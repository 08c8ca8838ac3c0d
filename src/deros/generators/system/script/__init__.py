"""System descriptions to one Python file that runs the system without ROS 2's launch."""
