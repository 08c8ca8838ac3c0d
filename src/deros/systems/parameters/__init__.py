"""The parameters that nodes get from files."""
