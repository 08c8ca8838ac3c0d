"""The part of the standalone modules that loads nodes into containers."""
