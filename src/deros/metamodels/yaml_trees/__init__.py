"""YAML of other tools, with the place of each value."""
