"""The safety node as an rclcpp node around the monitor in C."""
