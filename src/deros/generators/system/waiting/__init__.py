"""What programs wait for in the ROS graph before they are started."""
