"""Parts that the targets of system descriptions share."""
