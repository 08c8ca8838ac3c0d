"""The target ``cpp`` of safety rules: an ament_cmake package."""
