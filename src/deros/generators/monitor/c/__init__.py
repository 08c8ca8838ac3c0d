"""Monitors in C99, for machines without ROS and without a heap."""
