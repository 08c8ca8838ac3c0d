"""The functions and data of a monitor, in C."""
