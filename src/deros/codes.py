"""The diagnostic codes, each declared once.

The hundreds name the family: 0 reading and syntax, 1 node descriptions, 2 system descriptions,
3 safety rules, 4 generation, 5 traces. Every code has a page of its name under
``docs/diagnostics/`` and a case under ``tests/cases/`` (generation and traces: a test). The meaning
of a code never changes.
"""

from __future__ import annotations

from deros.diagnostics import ALL_CODES as ALL_CODES
from deros.diagnostics import SLUGS as SLUGS
from deros.diagnostics import Severity
from deros.diagnostics import declare as _declare
from deros.diagnostics import find as find

_W = Severity.WARNING
_I = Severity.INFO

# Reading and syntax
UNREADABLE_FILE = _declare(1, "unreadable-file", "file cannot be read")
NOT_UTF8 = _declare(2, "not-utf8", "file is not UTF-8 text")
SYNTAX_ERROR = _declare(3, "syntax-error", "syntax error")
NESTED_TOO_DEEPLY = _declare(4, "nested-too-deeply", "nested too deeply")
UNKNOWN_LANGUAGE = _declare(5, "unknown-language", "unknown kind of file")
UNKNOWN_UNIT = _declare(6, "unknown-unit", "unknown unit")
NAME_TOO_LONG = _declare(7, "name-too-long", "name too long")
FILE_TOO_LARGE = _declare(8, "file-too-large", "file too large")
FORBIDDEN_CHARACTER = _declare(9, "forbidden-character", "forbidden character")
MORE_SYNTAX_ERRORS = _declare(10, "more-syntax-errors", "more syntax errors than are shown", _I)

# Allowances and baselines
BAD_ALLOWANCE = _declare(20, "bad-allowance", "allowance that cannot be read", _W)
NOT_ALLOWABLE = _declare(21, "not-allowable", "allowance of a finding that cannot be allowed", _W)
UNUSED_ALLOWANCE = _declare(22, "unused-allowance", "allowance that is not needed", _W)
ABSENT_FINDING = _declare(23, "absent-finding", "baseline finding that no longer occurs", _I)
UNUSABLE_BASELINE = _declare(24, "unusable-baseline", "baseline that cannot be used")

# Project files, and files that models name
UNREADABLE_PROJECT = _declare(25, "unreadable-project", "project file that cannot be read")
UNKNOWN_PROJECT_KEY = _declare(26, "unknown-project-key", "unknown key in a project file", _W)
BAD_PROJECT_VALUE = _declare(27, "bad-project-value", "invalid value in a project file")
NO_SUCH_FILE = _declare(28, "no-such-file", "parameter that names a file that does not exist", _W)

# Node descriptions
UNKNOWN_PACKAGE = _declare(101, "unknown-package", "unknown interface package")
UNKNOWN_TYPE = _declare(102, "unknown-type", "unknown message, service or action type")
WRONG_DEFAULT = _declare(103, "wrong-default", "default does not fit the parameter's type")
DUPLICATE_NAME = _declare(104, "duplicate-name", "name declared twice in a node description")
INVALID_ROS_NAME = _declare(105, "invalid-ros-name", "name that ROS 2 rejects")
DEFAULT_OUT_OF_RANGE = _declare(
    106, "default-out-of-range", "default outside the parameter's own bounds"
)
UNKNOWN_FIELD_OF_PORT = _declare(107, "unknown-field-of-port", "unknown field in a port's units")
UNKNOWN_VIA_PARAMETER = _declare(
    108, "unknown-via-parameter", "port takes its name from an unknown parameter", absence=True
)
DUPLICATE_SECTION = _declare(109, "duplicate-section", "section given twice")
BAD_CONSTRAINT = _declare(
    110, "bad-constraint", "constraint that does not fit the parameter's type"
)
UNIT_CONFLICTS_WITH_REP103 = _declare(
    111, "unit-conflicts-with-rep103", "unit of another dimension than in REP 103", _W
)
UNUSABLE_DEFINITION = _declare(
    112, "unusable-definition", "definition of an interface that cannot be used"
)
IMPOSSIBLE_NUMBER = _declare(
    113, "impossible-number", "number that the middleware cannot represent"
)
UNKNOWN_KEY_PARAMETER = _declare(
    114, "unknown-key-parameter", "parameter for each entry of an unknown parameter"
)
BAD_CUSTOM_FUNCTION = _declare(
    115, "bad-custom-function", "custom constraint that does not name a function"
)
NOT_A_PROGRAM_NAME = _declare(119, "not-a-program-name", "executable that is not a plain file name")
WIRED_APART = _declare(120, "wired-apart", "ports of one name wired to different names")
UNKNOWN_ENTRY = _declare(121, "unknown-entry", "parameter for an entry that is not in its list")
BAD_FRAME = _declare(122, "bad-frame", "frame of a node that cannot be as described", absence=True)

# System descriptions
UNKNOWN_IMPORT = _declare(201, "unknown-import", "imported file not found")
CYCLIC_IMPORT = _declare(202, "cyclic-import", "cyclic import")
UNKNOWN_NODE_TYPE = _declare(203, "unknown-node-type", "unknown node type", absence=True)
UNKNOWN_PORT = _declare(204, "unknown-port", "unknown port", absence=True)
UNKNOWN_TOPIC = _declare(205, "unknown-topic", "unknown topic", absence=True)
UNKNOWN_PARAMETER = _declare(206, "unknown-parameter", "unknown parameter", absence=True)
WRONG_PARAMETER_VALUE = _declare(207, "wrong-parameter-value", "parameter value of the wrong type")
TYPE_MISMATCH = _declare(208, "type-mismatch", "two ends of a topic with different types")
PINNED_TYPE_VIOLATED = _declare(209, "pinned-type-violated", "pinned topic type violated")
NO_PUBLISHER = _declare(210, "no-publisher", "topic without a publisher", _W, absence=True)
NO_SUBSCRIBER = _declare(211, "no-subscriber", "topic without a subscriber", _W, absence=True)
UNUSED_TOPIC = _declare(212, "unused-topic", "declared topic that is not used", _W, absence=True)
UNWIRED_PORT = _declare(213, "unwired-port", "port left unwired", _W, absence=True)
LIKELY_MISSPELLING = _declare(
    214, "likely-misspelling", "topic names that probably mean the same topic", _W, absence=True
)
DUPLICATE_NODE_NAME = _declare(215, "duplicate-node-name", "two nodes with one full name")
TOPIC_PARAMETER_CONFLICT = _declare(
    216, "topic-parameter-conflict", "parameter contradicts the wiring made through it"
)
UNTYPED_WIRING = _declare(
    217, "untyped-wiring", "wiring through a parameter that belongs to no port", _I, absence=True
)
DUPLICATE_TOPIC = _declare(218, "duplicate-topic", "topic declared twice")
DUPLICATE_SETTING = _declare(219, "duplicate-setting", "parameter set or port connected twice")
UNKNOWN_SYSTEM = _declare(220, "unknown-system", "unknown system", absence=True)
PARAMETER_OUT_OF_RANGE = _declare(
    221, "parameter-out-of-range", "parameter value outside the declared bounds"
)
UNUSED_IMPORT = _declare(222, "unused-import", "unused import", _W, absence=True)
INVALID_SYSTEM_NAME = _declare(223, "invalid-system-name", "name in a system that ROS 2 rejects")
AMBIGUOUS_NODE_TYPE = _declare(
    224, "ambiguous-node-type", "node type name that two imported files define"
)
SERVICE_WITHOUT_SERVER = _declare(
    225, "service-without-server", "service or action without a server", _W, absence=True
)
DUPLICATE_SUBSYSTEM = _declare(
    226, "duplicate-subsystem", "two subsystems with one name in one place"
)
PARAMETER_WITHOUT_VALUE = _declare(
    227, "parameter-without-value", "parameter without default and without value", absence=True
)
INCOMPATIBLE_QOS = _declare(228, "incompatible-qos", "two ends whose QoS does not match")
UNCERTAIN_QOS = _declare(229, "uncertain-qos", "two ends whose QoS may not match", _W)
PINNED_QOS_VIOLATED = _declare(230, "pinned-qos-violated", "pinned QoS violated")
EMPTY_QOS_PIN = _declare(231, "empty-qos-pin", "QoS of a topic that pins nothing")
STANDARD_TOPIC_TYPE = _declare(232, "standard-topic-type", "standard topic with an unusual type")
QOS_OVERRIDE_UNREAD = _declare(
    233, "qos-override-unread", "QoS override that the node does not read", _W
)
RULES_DO_NOT_USE_SYSTEM = _declare(
    236, "rules-do-not-use-system", "safety statement for rules that use another system"
)
CONNECTED_BY_RULES = _declare(
    237, "connected-by-rules", "connection that a safety statement already makes"
)
RULES_RUN_TWICE = _declare(238, "rules-run-twice", "rules whose nodes are started twice")
RULES_NOT_LOADED = _declare(
    239, "rules-not-loaded", "hand-wired safety node checked without its rules", _W, absence=True
)
LIKELY_SWAPPED = _declare(240, "likely-swapped", "two connections that are probably swapped", _W)
UNITS_DIFFER = _declare(241, "units-differ", "field to which two ends of a topic give two units")
SEVERAL_COMMANDERS = _declare(
    242, "several-commanders", "topic that moves something, with several publishers", _W
)
SHARED_BY_INSTANCES = _declare(
    243, "shared-by-instances", "topic that the instances of one system share", _W
)
LATE_SUBSCRIPTION = _declare(
    244, "late-subscription", "volatile subscription to a latched topic", _W
)
NEVER_ACTIVATED = _declare(
    245, "never-activated", "managed node that nothing activates", absence=True
)
UNKNOWN_MANAGER = _declare(
    246, "unknown-manager", "'activated by' that does not fit the system", absence=True
)
SIMULATED_TIME = _declare(
    247, "simulated-time", "simulated time of some nodes only, or without a clock", _W
)
FRAME_BROADCAST_TWICE = _declare(248, "frame-broadcast-twice", "frame that two nodes broadcast")
SHARE_IN_ANOTHER_UNIT = _declare(
    249, "share-in-another-unit", "field that its message defines from 0 to 1, in another unit", _W
)
GATE_READER_KEEPS_GOING = _declare(
    250,
    "gate-reader-keeps-going",
    "reader of a gate that may not stop in silence",
    _W,
    absence=True,
)

UNKNOWN_ARGUMENT = _declare(251, "unknown-argument", "unknown argument of a system", absence=True)
UNFIT_ARGUMENT = _declare(252, "unfit-argument", "argument or expression that has no fitting value")
MISSING_ARGUMENT = _declare(
    253, "missing-argument", "system used without a value for an argument", absence=True
)
UNUSED_ARGUMENT = _declare(254, "unused-argument", "unused argument", _W, absence=True)
DUPLICATE_ARGUMENT = _declare(255, "duplicate-argument", "argument declared or given twice")
IDLE_CONDITION = _declare(256, "idle-condition", "condition that decides nothing", _W)
UNCHECKED_COMBINATIONS = _declare(
    257, "unchecked-combinations", "arguments with too many combinations to check all", _I
)
BAD_VARIABLE = _declare(265, "bad-variable", "environment variable that cannot be set")
APART = _declare(266, "apart", "nodes that cannot hear each other", _W)
NO_NODE_BELOW = _declare(267, "no-node-below", "setting of a group that no node has", absence=True)
UNFIT_COMMAND = _declare(268, "unfit-command", "text that a program cannot be started with")
DUPLICATE_PROCESS = _declare(269, "duplicate-process", "process called like another member")

# Safety rules
RULE_TOPIC_NOT_IN_SYSTEM = _declare(
    301, "rule-topic-not-in-system", "topic of the rules that is not in the system", absence=True
)
UNKNOWN_FIELD = _declare(302, "unknown-field", "unknown message field")
FIELD_NOT_NUMERIC = _declare(
    303, "field-not-numeric", "field that is not a number where one is needed"
)
WRONG_FUNCTION_ARGUMENT = _declare(
    304, "wrong-function-argument", "function applied to the wrong type"
)
UNKNOWN_FUNCTION = _declare(305, "unknown-function", "unknown function", absence=True)
INCOMPATIBLE_UNITS = _declare(306, "incompatible-units", "incompatible units")
EMPTY_INTERVAL = _declare(307, "empty-interval", "empty or reversed interval")
NEVER_TRUE = _declare(308, "never-true", "comparison that can never be true", _W)
ALWAYS_TRUE = _declare(309, "always-true", "comparison that is always true", _W)
UNKNOWN_NAME = _declare(310, "unknown-name", "unknown name", absence=True)
DUPLICATE_RULE_NAME = _declare(311, "duplicate-rule-name", "name declared twice in the rules")
UNKNOWN_RESET = _declare(
    312, "unknown-reset", "reset_by that does not name an action", absence=True
)
UNUSED_CONSTANT = _declare(313, "unused-constant", "unused constant", _W, absence=True)
UNUSED_INPUT = _declare(314, "unused-input", "unused input", _W, absence=True)
UNUSED_RULE = _declare(315, "unused-rule", "unused rule", _W, absence=True)
UNUSED_ACTION = _declare(316, "unused-action", "unused action", _W, absence=True)
INPUT_WITHOUT_TIMEOUT = _declare(
    317, "input-without-timeout", "rule on an input without a timeout", _W, absence=True
)
RULE_TOPIC_NOT_PUBLISHED = _declare(
    318, "rule-topic-not-published", "topic of the rules that no node publishes", absence=True
)
MISSING_NEEDS_TIMEOUT = _declare(
    319,
    "missing-needs-timeout",
    "missing() or age() of an input without a timeout",
    absence=True,
)
AGE_NOT_CONSTANT = _declare(
    320, "age-not-constant", "age() compared with a value that is not constant"
)
UNKNOWN_USED_SYSTEM = _declare(
    321, "unknown-used-system", "use of a system that the file does not define", absence=True
)
LATCHED_AND_RESET_BY = _declare(322, "latched-and-reset-by", "action both latched and reset_by")
BAD_DURATION = _declare(323, "bad-duration", "duration that is negative or finer than a nanosecond")
WRONG_OPERAND = _declare(324, "wrong-operand", "operands that cannot be compared")
RESET_WITHOUT_TRIGGER = _declare(
    325, "reset-without-trigger", "action whose reset is never triggered", _W, absence=True
)
WRONG_ACTION_ARGUMENTS = _declare(
    326, "wrong-action-arguments", "wrong number of arguments for an action"
)
ACTION_TYPE_MISMATCH = _declare(
    327, "action-type-mismatch", "action publishes another type than its topic has"
)
RULE_TYPE_UNKNOWN = _declare(
    328, "rule-type-unknown", "topic of unknown type in the rules", absence=True
)
ACTION_VALUE = _declare(329, "action-value", "value that does not fit the message of an action")
EXACT_FLOAT_COMPARISON = _declare(
    330, "exact-float-comparison", "exact comparison of a floating-point value", _W
)
ACTION_TOPIC_NOT_IN_SYSTEM = _declare(
    331,
    "action-topic-not-in-system",
    "topic of an action that no node in the system reads",
    _W,
    absence=True,
)
INVALID_RULES_NAME = _declare(332, "invalid-rules-name", "name in the rules that a target rejects")
ACTIVE_EQUALS_INACTIVE = _declare(
    333, "active-equals-inactive", "action whose active and inactive messages are equal", _W
)
ZERO_STOPS_NOTHING = _declare(334, "zero-stops-nothing", "zero of a gate that is no stop")
GATE_LOOP = _declare(335, "gate-loop", "gate that publishes the topic that it reads")
GATE_RATE = _declare(336, "gate-rate", "gate rate outside the permitted range")
GATE_LIMIT = _declare(337, "gate-limit", "limit that a gate cannot apply")
GATE_ACTION = _declare(338, "gate-action", "gate on an action that publishes no state")
GATE_BYPASSED = _declare(339, "gate-bypassed", "publisher wired past a gate")
GATE_NOT_IN_SYSTEM = _declare(
    340, "gate-not-in-system", "gate that is not in the system", absence=True
)
GATE_UNREAD = _declare(
    341, "gate-unread", "gate whose commands no node in the system reads", _W, absence=True
)
GATE_LIMIT_OVERRIDES_ZERO = _declare(
    342, "gate-limit-overrides-zero", "limit that takes precedence over the zero of an action", _W
)
GATE_WITHOUT_HEARTBEAT = _declare(
    343, "gate-without-heartbeat", "gate that does not monitor the heartbeat", _W, absence=True
)
GATE_WITHOUT_INPUT = _declare(
    344, "gate-without-input", "gate that does not monitor its input", _W, absence=True
)
HEARTBEAT_TIMEOUT_TOO_SHORT = _declare(
    345, "heartbeat-timeout-too-short", "heartbeat timeout that is too short", _W
)
STATE_PUBLISHED_TWICE = _declare(
    346, "state-published-twice", "state of an action that two nodes publish"
)
HEARTBEAT_PUBLISHED_TWICE = _declare(
    347, "heartbeat-published-twice", "heartbeat that two nodes publish"
)
UNHANDLED_UNKNOWN = _declare(
    348, "unhandled-unknown", "rule that may become unknown without any reaction", _W, absence=True
)
UNUSED_TIMEOUT = _declare(349, "unused-timeout", "timeout that no rule uses", _W, absence=True)
FAILSAFE_NEGATED = _declare(350, "failsafe-negated", "failsafe rule that acts upside down", _W)
FAILSAFE_WITHOUT_EFFECT = _declare(
    351, "failsafe-without-effect", "failsafe rule that is never unknown", _W
)
TIME_OF_LOSS = _declare(352, "time-of-loss", "time of a loss that is missing or said twice")
SAFETY_DESCRIPTION_DIFFERS = _declare(
    353, "safety-description-differs", "safety node description that differs from its rules"
)
SAFETY_CONNECTED_DIFFERENTLY = _declare(
    354, "safety-connected-differently", "safety node connected differently from its rules"
)
SAFETY_NOT_GENERATED = _declare(
    355, "safety-not-generated", "safety node that has not been generated yet"
)
GATE_RESUMES_BY_ITSELF = _declare(
    357, "gate-resumes-by-itself", "gate that lets the robot resume by itself", _I
)
GATE_LIMIT_UNTIL_RESET = _declare(
    358, "gate-limit-until-reset", "limit that would last until a reset"
)
GATE_LIMIT_TO_ZERO = _declare(
    359, "gate-limit-to-zero", "limit that allows a gate nothing but zero", _I
)
GATE_BOUND = _declare(360, "gate-bound", "end of a limit that a gate cannot find out")
BAD_FREQUENCY = _declare(361, "bad-frequency", "frequency that cannot be compared")
HIGH_AT_START = _declare(362, "high-at-start", "high frequency that every start has", _W)
TIMEOUT_TOO_SHORT = _declare(
    363, "timeout-too-short", "timeout shorter than a safety node's periods", _W
)
SUSPECT_BEARING = _declare(364, "suspect-bearing", "bearing that is probably not intended", _W)
SUSPECT_SECTOR = _declare(365, "suspect-sector", "sector that is probably not intended", _W)
WRAPPING_NOT_AN_ANGLE = _declare(
    366, "wrapping-not-an-angle", "field annotated as wrapping that is not an angle"
)
RATE_OF_ARRIVALS = _declare(367, "rate-of-arrivals", "rate computed from arrival times", _W)
RULE_CYCLE = _declare(368, "rule-cycle", "rule that depends on itself")
AMBIGUOUS_NOT = _declare(369, "ambiguous-not", "'not' that can be read in two ways")
UNIT_NOT_DECLARED = _declare(
    370,
    "unit-not-declared",
    "field without a known unit, computed with beside a quantity",
    absence=True,
)
FIELD_IN_TWO_UNITS = _declare(371, "field-in-two-units", "field that is read in two units")
PLAIN_BESIDE_COMPUTED = _declare(
    372, "plain-beside-computed", "plain number in a unit that nobody sees"
)
SINCE_WITHOUT_MEMORY = _declare(373, "since-without-memory", "'since' that remembers nothing", _W)
HIDDEN_BY_UNKNOWN = _declare(
    374,
    "hidden-by-unknown",
    "value that is hidden while another one is unknown",
    _I,
    absence=True,
)
ROUNDED_INTEGER = _declare(375, "rounded-integer", "64-bit integer that arithmetic rounds", _I)
DURATION_TOO_SHORT = _declare(
    376, "duration-too-short", "duration that is probably not intended", _W
)
INTERVAL_STARTS_OVER = _declare(
    377, "interval-starts-over", "interval that a NaN starts over unnoticed", _I, absence=True
)
TWO_EVENTS = _declare(378, "two-events", "two events that have to happen at one instant", _I)
WITHIN_COVERS_ALL = _declare(
    379, "within-covers-all", "'within' that covers more, or less, than it seems to", _I
)
RESET_BY_HELD_BUTTON = _declare(
    380, "reset-by-held-button", "reset by a button that is held or stuck", _I
)
ONE_WAY_ONLY = _declare(
    381, "one-way-only", "speed that is compared one way round only", _I, absence=True
)
SINGLE_BEAM = _declare(382, "single-beam", "single beam of a laser scan", _I)
HELD_TOGETHER = _declare(
    383, "held-together", "buttons that count as pressed together while one is held", _I
)
BAD_COUNT = _declare(384, "bad-count", "number of times that cannot be counted")
BAD_NO_RETURN = _declare(385, "bad-no-return", "value that no laser scanner reports for nothing")
UNASKED_BLINDNESS = _declare(
    386, "unasked-blindness", "sector whose blind beams no rule asks for", _W, absence=True
)
SEVERAL_SOURCES = _declare(387, "several-sources", "topic of the rules with several publishers", _W)
JUDGED_TOO_LATE = _declare(388, "judged-too-late", "rule on the commands that a gate passes", _W)
ACTION_CYCLE = _declare(389, "action-cycle", "action whose state depends on itself")
GATE_RAMP = _declare(390, "gate-ramp", "ramp that a gate cannot follow")
GATE_SEND = _declare(391, "gate-send", "value that a gate cannot send")
UNBOUNDED_RAMP = _declare(
    392, "unbounded-ramp", "ramp without a time to standstill", _W, absence=True
)
TIME_TO_STANDSTILL = _declare(393, "time-to-standstill", "time that a ramp takes", _I)
WEAKER_STOP_FIRST = _declare(
    394, "weaker-stop-first", "stop of a gate that comes after a weaker one", _W
)
UNASKED_FUTURE = _declare(
    395, "unasked-future", "latency of which no rule asks whether it is negative", _W, absence=True
)
NOT_CALLABLE = _declare(396, "not-callable", "service that an action cannot call")
CALL_WITHOUT_SERVER = _declare(
    397,
    "call-without-server",
    "service of an action that no node in the system serves",
    _W,
    absence=True,
)
BAD_TUNABLE = _declare(398, "bad-tunable", "tunable constant that cannot be one")
TUNABLE_NAME_TAKEN = _declare(
    399, "tunable-name-taken", "tunable constant with the name of another parameter"
)

# Generation
NAME_COLLISION = _declare(401, "name-collision", "two generated names collide")
UNSUPPORTED_BY_TARGET = _declare(
    402, "unsupported-by-target", "construct that the target does not support"
)
HAND_EDITED = _declare(403, "hand-edited", "hand-edited file kept", _W)
UNKNOWN_TARGET = _declare(404, "unknown-target", "unknown generator")
SHADOWED_MODULE = _declare(
    405, "shadowed-module", "name that hides a module or package that the output needs"
)
OVERWRITES_OTHER = _declare(406, "overwrites-other", "file written by another target or model")
MISSING_METHOD = _declare(407, "missing-method", "method missing in hand-written code", _W)
UNKNOWN_METHOD = _declare(
    408, "unknown-method", "name in hand-written code that is no longer in the model", _W
)
INCOMPLETE_MANIFEST = _declare(
    409, "incomplete-manifest", "package.xml without a dependency of the generated code", _W
)

# Traces
BAD_TRACE_LINE = _declare(501, "bad-trace-line", "line of a trace that cannot be interpreted")
BAD_TRACE_TIME = _declare(502, "bad-trace-time", "invalid time in a trace")
UNKNOWN_TRACE_FIELD = _declare(503, "unknown-trace-field", "unknown field in a trace's message")
WRONG_TRACE_VALUE = _declare(
    504, "wrong-trace-value", "value that does not fit its field in a trace"
)
UNREAD_TRACE_TOPIC = _declare(
    505, "unread-trace-topic", "topic of a trace that the rules do not read", _W
)
BAD_TIMELINE = _declare(506, "bad-timeline", "timeline that cannot be read")

CORRECTED_BY_GENERATING = frozenset(
    {GATE_BYPASSED, GATE_NOT_IN_SYSTEM, SAFETY_DESCRIPTION_DIFFERS, SAFETY_NOT_GENERATED}
)
"""Errors of a system whose safety nodes have to be generated, or generated again, before."""

OF_MODELS = frozenset(
    code
    for code in ALL_CODES.values()
    if not code.name.startswith(("DRS4", "DRS5")) and not "DRS020" <= code.name <= "DRS027"
)
"""Codes of findings about the content of models, not about generated files or traces."""
