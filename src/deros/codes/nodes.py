"""Codes of node descriptions."""

from __future__ import annotations

from deros.diagnostics import Severity, declare

_W = Severity.WARNING
_I = Severity.INFO

# Node descriptions
UNKNOWN_PACKAGE = declare(101, "unknown-package", "unknown interface package")
UNKNOWN_TYPE = declare(102, "unknown-type", "unknown message, service or action type")
WRONG_DEFAULT = declare(103, "wrong-default", "default does not fit the parameter's type")
DUPLICATE_NAME = declare(104, "duplicate-name", "name declared twice in a node description")
INVALID_ROS_NAME = declare(105, "invalid-ros-name", "name that ROS 2 rejects")
DEFAULT_OUT_OF_RANGE = declare(
    106, "default-out-of-range", "default outside the parameter's own bounds"
)
UNKNOWN_FIELD_OF_PORT = declare(107, "unknown-field-of-port", "unknown field in a port's units")
UNKNOWN_VIA_PARAMETER = declare(
    108, "unknown-via-parameter", "port takes its name from an unknown parameter", absence=True
)
DUPLICATE_SECTION = declare(109, "duplicate-section", "section given twice")
BAD_CONSTRAINT = declare(110, "bad-constraint", "constraint that does not fit the parameter's type")
UNIT_CONFLICTS_WITH_REP103 = declare(
    111, "unit-conflicts-with-rep103", "unit of another dimension than in REP 103", _W
)
UNUSABLE_DEFINITION = declare(
    112, "unusable-definition", "definition of an interface that cannot be used"
)
IMPOSSIBLE_NUMBER = declare(113, "impossible-number", "number that the middleware cannot represent")
UNKNOWN_KEY_PARAMETER = declare(
    114, "unknown-key-parameter", "parameter for each entry of an unknown parameter"
)
BAD_CUSTOM_FUNCTION = declare(
    115, "bad-custom-function", "custom constraint that does not name a function"
)
NOT_A_PROGRAM_NAME = declare(119, "not-a-program-name", "executable that is not a plain file name")
WIRED_APART = declare(120, "wired-apart", "ports of one name wired to different names")
UNKNOWN_ENTRY = declare(121, "unknown-entry", "parameter for an entry that is not in its list")
BAD_FRAME = declare(122, "bad-frame", "frame of a node that cannot be as described", absence=True)
