"""The gates of safety rules as rclcpp nodes, each beside the safety node in the same package."""
