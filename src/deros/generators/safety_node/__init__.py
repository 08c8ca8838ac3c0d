"""The safety node: the node around a monitor."""
