"""What a generator is, and how generators are found: for those of deros and of others."""
