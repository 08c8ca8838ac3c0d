"""The command line. One file per command; each renders what the rooms below return."""
