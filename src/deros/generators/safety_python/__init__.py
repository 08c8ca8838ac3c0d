"""The target ``python`` of safety rules: a ROS 2 node around the generated monitor."""
