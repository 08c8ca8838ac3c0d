"""C++ sources that are the same in every generated package; they need ROS 2, nothing of deros.

The generator copies their texts, with the package's namespace in the place of ``deros_runtime``.
"""
