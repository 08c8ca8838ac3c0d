"""The monitor as C99: what a program means, for machines that have neither ROS nor a heap."""
