"""Codes of generation and of traces."""

from __future__ import annotations

from deros.diagnostics import Severity, declare

_W = Severity.WARNING
_I = Severity.INFO

# Generation
NAME_COLLISION = declare(401, "name-collision", "two generated names collide")
UNSUPPORTED_BY_TARGET = declare(
    402, "unsupported-by-target", "construct that the target does not support"
)
HAND_EDITED = declare(403, "hand-edited", "hand-edited file kept", _W)
UNKNOWN_TARGET = declare(404, "unknown-target", "unknown generator")
SHADOWED_MODULE = declare(
    405, "shadowed-module", "name that hides a module or package that the output needs"
)
OVERWRITES_OTHER = declare(406, "overwrites-other", "file written by another target or model")
MISSING_METHOD = declare(407, "missing-method", "method missing in hand-written code", _W)
UNKNOWN_METHOD = declare(
    408, "unknown-method", "name in hand-written code that is no longer in the model", _W
)
INCOMPLETE_MANIFEST = declare(
    409, "incomplete-manifest", "package.xml without a dependency of the generated code", _W
)

# Traces
BAD_TRACE_LINE = declare(501, "bad-trace-line", "line of a trace that cannot be interpreted")
BAD_TRACE_TIME = declare(502, "bad-trace-time", "invalid time in a trace")
UNKNOWN_TRACE_FIELD = declare(503, "unknown-trace-field", "unknown field in a trace's message")
WRONG_TRACE_VALUE = declare(
    504, "wrong-trace-value", "value that does not fit its field in a trace"
)
UNREAD_TRACE_TOPIC = declare(
    505, "unread-trace-topic", "topic of a trace that the rules do not read", _W
)
BAD_TIMELINE = declare(506, "bad-timeline", "timeline that cannot be read")
