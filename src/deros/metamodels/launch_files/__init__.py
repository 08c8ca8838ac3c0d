"""Existing launch files: what is known of them without running them."""
