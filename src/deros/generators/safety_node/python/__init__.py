"""The safety node as an rclpy node around the generated monitor."""
