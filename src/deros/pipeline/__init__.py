"""Load, check, build, generate and write, for commands and build systems alike."""
