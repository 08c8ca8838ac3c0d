"""System descriptions to a YAML file of parameters."""
