"""The target ``python`` of node descriptions: an ament_python package."""
