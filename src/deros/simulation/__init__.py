"""Rules over a trace, without ROS."""
