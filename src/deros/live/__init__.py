"""Running robots: what their nodes report, and calls of their services."""
