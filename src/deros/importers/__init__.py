"""Models of what exists already: a running graph becomes node descriptions and a system."""
