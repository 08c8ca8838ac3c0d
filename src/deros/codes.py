"""The diagnostic codes, each declared once.

The hundreds name the family: 0 reading and syntax, 1 node descriptions, 2 system descriptions,
3 safety rules, 4 generation, 5 traces. Every code has a page of its name under
``docs/diagnostics/`` and a case under ``tests/cases/`` (generation and traces: a test); a code is
never given a second meaning.
"""

from __future__ import annotations

from deros.diagnostics import Code, Severity

ALL_CODES: dict[str, Code] = {}


def _declare(
    number: int, title: str, severity: Severity = Severity.ERROR, *, absence: bool = False
) -> Code:
    """Declare a code; ``absence`` says that its findings tell that something is missing."""
    code = Code(f"DRS{number:03d}", title, severity, absence)
    assert code.name not in ALL_CODES, f"{code.name} is declared twice"
    ALL_CODES[code.name] = code
    return code


_W = Severity.WARNING
_I = Severity.INFO

# Reading and syntax
UNREADABLE_FILE = _declare(1, "file cannot be read")
NOT_UTF8 = _declare(2, "file is not UTF-8 text")
SYNTAX_ERROR = _declare(3, "syntax error")
NESTED_TOO_DEEPLY = _declare(4, "nested too deeply")
UNKNOWN_LANGUAGE = _declare(5, "unknown kind of file")
UNKNOWN_UNIT = _declare(6, "unknown unit")
NAME_TOO_LONG = _declare(7, "name too long")
FILE_TOO_LARGE = _declare(8, "file too large")
FORBIDDEN_CHARACTER = _declare(9, "character that no text may hold")
MORE_SYNTAX_ERRORS = _declare(10, "more syntax errors than are shown", _I)

# Allowances and baselines
BAD_ALLOWANCE = _declare(20, "allowance that cannot be read", _W)
NOT_ALLOWABLE = _declare(21, "allowance of a finding that cannot be allowed", _W)
UNUSED_ALLOWANCE = _declare(22, "allowance that is not needed", _W)
ABSENT_FINDING = _declare(23, "finding of the baseline that does not occur any more", _I)
UNUSABLE_BASELINE = _declare(24, "baseline that cannot be used")

# Project files
UNREADABLE_PROJECT = _declare(25, "project file that cannot be read")
UNKNOWN_PROJECT_KEY = _declare(26, "unknown key in a project file", _W)
BAD_PROJECT_VALUE = _declare(27, "value in a project file that does not fit")

# Files that models name
NO_SUCH_FILE = _declare(28, "file named by a parameter that is not there", _W)

# Node descriptions
UNKNOWN_PACKAGE = _declare(101, "unknown interface package")
UNKNOWN_TYPE = _declare(102, "unknown message, service or action type")
WRONG_DEFAULT = _declare(103, "default does not fit the parameter's type")
DUPLICATE_NAME = _declare(104, "name declared twice in a node description")
INVALID_ROS_NAME = _declare(105, "name that ROS 2 refuses")
DEFAULT_OUT_OF_RANGE = _declare(106, "default outside the parameter's own bounds")
UNKNOWN_FIELD_OF_PORT = _declare(107, "unknown field in a port's units")
UNKNOWN_VIA_PARAMETER = _declare(108, "port takes its name from an unknown parameter", absence=True)
DUPLICATE_SECTION = _declare(109, "section given twice")
BAD_CONSTRAINT = _declare(110, "constraint that does not fit the parameter's type")
UNIT_CONFLICTS_WITH_REP103 = _declare(111, "unit of another dimension than REP 103 gives", _W)
UNUSABLE_DEFINITION = _declare(112, "definition of an interface that cannot be used")
IMPOSSIBLE_NUMBER = _declare(113, "number that the middleware cannot take")
UNKNOWN_KEY_PARAMETER = _declare(114, "parameter for each entry of an unknown parameter")
BAD_CUSTOM_FUNCTION = _declare(115, "custom constraint that names no function")
NOT_A_PROGRAM_NAME = _declare(119, "executable that is not a plain file name")
WIRED_APART = _declare(120, "ports of one name wired to different names")
UNKNOWN_ENTRY = _declare(121, "parameter of an entry that its list lacks")

# System descriptions
UNKNOWN_IMPORT = _declare(201, "imported file not found")
CYCLIC_IMPORT = _declare(202, "cyclic import")
UNKNOWN_NODE_TYPE = _declare(203, "unknown node type", absence=True)
UNKNOWN_PORT = _declare(204, "unknown port", absence=True)
UNKNOWN_TOPIC = _declare(205, "unknown topic", absence=True)
UNKNOWN_PARAMETER = _declare(206, "unknown parameter", absence=True)
WRONG_PARAMETER_VALUE = _declare(207, "parameter value of the wrong type")
TYPE_MISMATCH = _declare(208, "two ends of a topic with different types")
PINNED_TYPE_VIOLATED = _declare(209, "pinned topic type violated")
NO_PUBLISHER = _declare(210, "topic without publisher", _W, absence=True)
NO_SUBSCRIBER = _declare(211, "topic without subscriber", _W, absence=True)
UNUSED_TOPIC = _declare(212, "declared topic that nobody uses", _W, absence=True)
UNWIRED_PORT = _declare(213, "port left unwired", _W, absence=True)
LIKELY_MISSPELLING = _declare(
    214, "topic names that probably mean the same topic", _W, absence=True
)
DUPLICATE_NODE_NAME = _declare(215, "two nodes with one full name")
TOPIC_PARAMETER_CONFLICT = _declare(216, "parameter contradicts the wiring made through it")
UNTYPED_WIRING = _declare(217, "wiring through a parameter that no port claims", _I, absence=True)
DUPLICATE_TOPIC = _declare(218, "topic declared twice")
DUPLICATE_SETTING = _declare(219, "parameter set or port connected twice")
UNKNOWN_SYSTEM = _declare(220, "unknown system", absence=True)
PARAMETER_OUT_OF_RANGE = _declare(221, "parameter value outside the declared bounds")
UNUSED_IMPORT = _declare(222, "import that nothing uses", _W, absence=True)
INVALID_SYSTEM_NAME = _declare(223, "name in a system that ROS 2 refuses")
AMBIGUOUS_NODE_TYPE = _declare(224, "node type name that two imported files define")
SERVICE_WITHOUT_SERVER = _declare(225, "service or action without a server", _W, absence=True)
DUPLICATE_SUBSYSTEM = _declare(226, "two subsystems with one name in one place")
PARAMETER_WITHOUT_VALUE = _declare(227, "parameter without default and without value", absence=True)
INCOMPATIBLE_QOS = _declare(228, "two ends whose QoS does not match")
UNCERTAIN_QOS = _declare(229, "two ends whose QoS may not match", _W)
PINNED_QOS_VIOLATED = _declare(230, "pinned QoS violated")
EMPTY_PIN = _declare(231, "QoS of a topic that pins nothing")
STANDARD_TOPIC_TYPE = _declare(232, "standard topic with another type than everywhere else")
QOS_OVERRIDE_UNREAD = _declare(233, "override of a QoS that the node does not read", _W)
RULES_DO_NOT_USE_SYSTEM = _declare(236, "safety statement for rules that use another system")
CONNECTED_BY_RULES = _declare(237, "connection that the rules of a safety statement make")
RULES_RUN_TWICE = _declare(238, "rules whose nodes are started twice")
RULES_NOT_LOADED = _declare(
    239, "safety node wired by hand, and checked without its rules", _W, absence=True
)
LIKELY_CROSSED = _declare(240, "two connections that have probably been exchanged", _W)

# Safety rules
RULE_TOPIC_NOT_IN_SYSTEM = _declare(301, "topic of the rules that the system lacks", absence=True)
UNKNOWN_FIELD = _declare(302, "unknown message field")
NOT_A_NUMBER_FIELD = _declare(303, "field that is no number where one is needed")
WRONG_FUNCTION_ARGUMENT = _declare(304, "function on the wrong type")
UNKNOWN_FUNCTION = _declare(305, "unknown function", absence=True)
INCOMPATIBLE_UNITS = _declare(306, "incompatible units")
EMPTY_INTERVAL = _declare(307, "empty or reversed interval")
NEVER_TRUE = _declare(308, "comparison that can never be true", _W)
ALWAYS_TRUE = _declare(309, "comparison that is always true", _W)
UNKNOWN_NAME = _declare(310, "unknown name", absence=True)
DUPLICATE_RULE_NAME = _declare(311, "name declared twice in the rules")
UNKNOWN_RESET = _declare(312, "reset_by names no action", absence=True)
UNUSED_CONSTANT = _declare(313, "unused constant", _W, absence=True)
UNUSED_INPUT = _declare(314, "unused input", _W, absence=True)
UNUSED_RULE = _declare(315, "unused rule", _W, absence=True)
UNUSED_ACTION = _declare(316, "unused action", _W, absence=True)
NO_TIMEOUT = _declare(317, "rule on an input without a timeout", _W, absence=True)
RULE_TOPIC_NOT_PUBLISHED = _declare(318, "topic of the rules that nobody publishes", absence=True)
MISSING_NEEDS_TIMEOUT = _declare(319, "silence of an input without a timeout", absence=True)
AGE_NOT_CONSTANT = _declare(320, "age() compared with something that is no constant")
UNKNOWN_USED_SYSTEM = _declare(321, "use of a system that is not there", absence=True)
LATCHED_AND_RESET_BY = _declare(322, "action both latched and reset_by")
BAD_DURATION = _declare(323, "duration that is negative or finer than a nanosecond")
WRONG_OPERAND = _declare(324, "operands that cannot be compared")
RESET_WITHOUT_TRIGGER = _declare(325, "action that a reset can never follow", _W, absence=True)
WRONG_ACTION_ARGUMENTS = _declare(326, "wrong number of arguments for an action")
ACTION_TYPE_MISMATCH = _declare(327, "action publishes another type than its topic has")
RULE_TYPE_UNKNOWN = _declare(328, "topic whose type the system does not tell", absence=True)
ACTION_VALUE = _declare(329, "value that the action's message cannot carry")
EXACT_FLOAT_COMPARISON = _declare(330, "exact comparison of a floating-point value", _W)
ACTION_TOPIC_NOT_IN_SYSTEM = _declare(
    331, "topic of an action that nobody in the system reads", _W, absence=True
)
INVALID_RULES_NAME = _declare(332, "name in the rules that a target refuses")
ACTIVE_EQUALS_INACTIVE = _declare(333, "action whose active and inactive messages are equal", _W)
GATE_WITHOUT_NUMBERS = _declare(334, "gate for messages without a number")
GATE_LOOP = _declare(335, "gate that publishes what it reads")
GATE_RATE = _declare(336, "rate that a gate does not have")
GATE_LIMIT = _declare(337, "limit that a gate cannot keep")
GATE_ACTION = _declare(338, "gate on an action that publishes no state")
GATE_BYPASSED = _declare(339, "publisher wired past a gate")
GATE_NOT_IN_SYSTEM = _declare(340, "gate that the system lacks", absence=True)
GATE_UNREAD = _declare(341, "gate whose commands nobody in the system reads", _W, absence=True)
GATE_LIMIT_OVERRIDES_ZERO = _declare(342, "limit that goes before the zero of an action", _W)
GATE_WITHOUT_HEARTBEAT = _declare(343, "gate that does not watch the heartbeat", _W, absence=True)
GATE_WITHOUT_INPUT = _declare(344, "gate that does not watch its input", _W, absence=True)
GATE_HEARTBEAT_TOO_SHORT = _declare(345, "heartbeat given up sooner than it can be trusted", _W)
STATE_PUBLISHED_TWICE = _declare(346, "state of an action that two nodes publish")
HEARTBEAT_PUBLISHED_TWICE = _declare(347, "heartbeat that two nodes publish")
UNNOTICED_UNKNOWN = _declare(348, "rule on a value whose loss nothing notices", _W, absence=True)
UNASKED_TIMEOUT = _declare(349, "timeout that no rule asks for", _W, absence=True)
FAILSAFE_NEGATED = _declare(350, "failsafe rule under not", _W)
FAILSAFE_WITHOUT_EFFECT = _declare(351, "failsafe rule that is never unknown", _W)
SAFETY_DESCRIPTION_DIFFERS = _declare(353, "description of a safety node that is not of its rules")
SAFETY_CONNECTED_ELSEWHERE = _declare(354, "safety node connected otherwise than its rules say")
SAFETY_NOT_GENERATED = _declare(355, "safety node that has not been generated yet")
GATE_RESUMES_BY_ITSELF = _declare(357, "gate that lets the robot go on by itself", _I)
GATE_LIMIT_UNTIL_RESET = _declare(358, "limit that is to last until a reset")
GATE_LIMIT_TO_ZERO = _declare(359, "limit that leaves a gate nothing but zero", _I)
TIMEOUT_TOO_SHORT = _declare(363, "timeout shorter than a safety node's periods", _W)
SUSPECT_BEARING = _declare(364, "bearing that is probably not what is meant", _W)
SUSPECT_SECTOR = _declare(365, "sector that is probably not what is meant", _W)
WRAPPING_NOT_AN_ANGLE = _declare(366, "field annotated as wrapping that is not an angle")
RATE_OF_ARRIVALS = _declare(367, "rate that divides by the time between two arrivals", _W)

# Generation
NAME_COLLISION = _declare(401, "two generated names collide")
UNSUPPORTED_BY_TARGET = _declare(402, "construct that the target does not support")
HAND_EDITED = _declare(403, "hand-edited file kept", _W)
UNKNOWN_TARGET = _declare(404, "unknown generator")
SHADOWED_MODULE = _declare(405, "name that hides a module or package that the output needs")
OVERWRITES_OTHER = _declare(406, "file that another target or model has written")
MISSING_METHOD = _declare(407, "method that code written by hand lacks", _W)
UNKNOWN_METHOD = _declare(408, "name in code written by hand that the model no longer has", _W)
MANIFEST_LACKS = _declare(409, "package.xml that lacks what the generated code needs", _W)

# Traces
BAD_TRACE_LINE = _declare(501, "line of a trace that means nothing")
BAD_TRACE_TIME = _declare(502, "time that a trace cannot have")
UNKNOWN_TRACE_FIELD = _declare(503, "unknown field in a trace's message")
WRONG_TRACE_VALUE = _declare(504, "value that the field of a trace's message cannot hold")
UNREAD_TRACE_TOPIC = _declare(505, "topic of a trace that the rules do not read", _W)

MENDED_AFTER_GENERATION = frozenset(
    {GATE_BYPASSED, GATE_NOT_IN_SYSTEM, SAFETY_DESCRIPTION_DIFFERS, SAFETY_NOT_GENERATED}
)
"""Errors of a system whose safety nodes have to be generated, or generated again, before."""

OF_MODELS = frozenset(
    code
    for code in ALL_CODES.values()
    if not code.name.startswith(("DRS4", "DRS5")) and not "DRS020" <= code.name <= "DRS027"
)
"""Findings about what a model says, not about generated files, traces or how deros is used."""

SLUGS: dict[str, Code] = {
    name.lower().replace("_", "-"): code
    for name, code in list(globals().items())
    if isinstance(code, Code)
}
"""The codes by a name that says what they are about: ``no-timeout`` is DRS317."""
