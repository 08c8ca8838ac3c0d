"""The texts of a launch file, and what they become in a system."""
