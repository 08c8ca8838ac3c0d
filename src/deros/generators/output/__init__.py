"""The way of generated files to the disk."""
