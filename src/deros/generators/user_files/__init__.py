"""Checks whether the files of users fit newly generated code."""
