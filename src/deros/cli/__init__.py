"""The command line. One file per command; each prints the results of the rooms below."""
