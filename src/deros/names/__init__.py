"""Names: the naming rules of ROS 2 and of languages, and names that are nearly alike."""
