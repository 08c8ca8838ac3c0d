"""Units of systemd: a service for each node and process, and a target that wants them all."""
