"""Parameter files of ROS 2, read as its own library reads them."""
