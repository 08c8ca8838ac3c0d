"""What the targets of system descriptions share."""
