"""Codes of reading: syntax, allowances, baselines and project files."""

from __future__ import annotations

from deros.diagnostics import Severity, declare

_W = Severity.WARNING
_I = Severity.INFO

# Reading and syntax
UNREADABLE_FILE = declare(1, "unreadable-file", "file cannot be read")
NOT_UTF8 = declare(2, "not-utf8", "file is not UTF-8 text")
SYNTAX_ERROR = declare(3, "syntax-error", "syntax error")
NESTED_TOO_DEEPLY = declare(4, "nested-too-deeply", "nested too deeply")
UNKNOWN_LANGUAGE = declare(5, "unknown-language", "unknown kind of file")
UNKNOWN_UNIT = declare(6, "unknown-unit", "unknown unit")
NAME_TOO_LONG = declare(7, "name-too-long", "name too long")
FILE_TOO_LARGE = declare(8, "file-too-large", "file too large")
FORBIDDEN_CHARACTER = declare(9, "forbidden-character", "forbidden character")
MORE_SYNTAX_ERRORS = declare(10, "more-syntax-errors", "more syntax errors than are shown", _I)

# Allowances and baselines
BAD_ALLOWANCE = declare(20, "bad-allowance", "allowance that cannot be read", _W)
NOT_ALLOWABLE = declare(21, "not-allowable", "allowance of a finding that cannot be allowed", _W)
UNUSED_ALLOWANCE = declare(22, "unused-allowance", "allowance that is not needed", _W)
ABSENT_FINDING = declare(23, "absent-finding", "baseline finding that no longer occurs", _I)
UNUSABLE_BASELINE = declare(24, "unusable-baseline", "baseline that cannot be used")

# Project files
UNREADABLE_PROJECT = declare(25, "unreadable-project", "project file that cannot be read")
UNKNOWN_PROJECT_KEY = declare(26, "unknown-project-key", "unknown key in a project file", _W)
BAD_PROJECT_VALUE = declare(27, "bad-project-value", "invalid value in a project file")

# Files that models name
NO_SUCH_FILE = declare(28, "no-such-file", "parameter that names a file that does not exist", _W)
