"""Code that generated packages carry as it is; kept as files that are checked and tested."""
