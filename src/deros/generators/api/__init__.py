"""The interface of generators, and their registry, for built-in and third-party ones."""
