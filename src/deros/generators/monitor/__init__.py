"""Monitors: rules as code without ROS."""
