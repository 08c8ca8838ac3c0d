"""The gates of safety rules as ROS 2 nodes, each beside the safety node in the same package."""
