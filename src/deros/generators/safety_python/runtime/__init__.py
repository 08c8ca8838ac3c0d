"""
Modules of generated packages that are the same for every program.

The generator copies their texts. They need ROS 2 and the standard library, nothing of deros.
"""
