"""What is seen of a running system: its output, log files, and a table."""
