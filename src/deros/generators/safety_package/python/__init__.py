"""The target ``python`` of safety rules: an ament_python package."""
