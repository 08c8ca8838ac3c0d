"""Compose files: for each host, a service for each node and process."""
