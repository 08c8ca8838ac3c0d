"""Plays the feeding robot's test cases against the running system and draws what happened."""
