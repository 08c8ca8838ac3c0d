"""The processes that the safety node's cost is compared with: they receive, and do nothing."""
