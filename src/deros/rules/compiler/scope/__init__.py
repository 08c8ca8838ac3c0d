"""What the names in rules refer to."""
