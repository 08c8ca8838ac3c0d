"""Shared support code of the tests, which the programs in ``tools`` import as well."""
