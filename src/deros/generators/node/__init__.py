"""Nodes: node descriptions to packages in Python and in C++."""
