"""What is to be proved of a monitor, in ACSL."""
