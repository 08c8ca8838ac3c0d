"""The target ``cpp`` of node descriptions: an ament_cmake package."""
