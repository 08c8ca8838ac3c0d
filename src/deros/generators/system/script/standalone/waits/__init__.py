"""The part of the standalone modules that waits for what is in the ROS graph."""
