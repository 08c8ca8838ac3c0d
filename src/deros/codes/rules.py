"""Codes of safety rules."""

from __future__ import annotations

from deros.diagnostics import Severity, declare

_W = Severity.WARNING
_I = Severity.INFO

# Safety rules
RULE_TOPIC_NOT_IN_SYSTEM = declare(
    301, "rule-topic-not-in-system", "topic of the rules that is not in the system", absence=True
)
UNKNOWN_FIELD = declare(302, "unknown-field", "unknown message field")
FIELD_NOT_NUMERIC = declare(
    303, "field-not-numeric", "field that is not a number where one is needed"
)
WRONG_FUNCTION_ARGUMENT = declare(
    304, "wrong-function-argument", "function applied to the wrong type"
)
UNKNOWN_FUNCTION = declare(305, "unknown-function", "unknown function", absence=True)
INCOMPATIBLE_UNITS = declare(306, "incompatible-units", "incompatible units")
EMPTY_INTERVAL = declare(307, "empty-interval", "empty or reversed interval")
NEVER_TRUE = declare(308, "never-true", "comparison that can never be true", _W)
ALWAYS_TRUE = declare(309, "always-true", "comparison that is always true", _W)
UNKNOWN_NAME = declare(310, "unknown-name", "unknown name", absence=True)
DUPLICATE_RULE_NAME = declare(311, "duplicate-rule-name", "name declared twice in the rules")
UNKNOWN_RESET = declare(312, "unknown-reset", "reset_by that does not name an action", absence=True)
UNUSED_CONSTANT = declare(313, "unused-constant", "unused constant", _W, absence=True)
UNUSED_INPUT = declare(314, "unused-input", "unused input", _W, absence=True)
UNUSED_RULE = declare(315, "unused-rule", "unused rule", _W, absence=True)
UNUSED_ACTION = declare(316, "unused-action", "unused action", _W, absence=True)
INPUT_WITHOUT_TIMEOUT = declare(
    317, "input-without-timeout", "rule on an input without a timeout", _W, absence=True
)
RULE_TOPIC_NOT_PUBLISHED = declare(
    318, "rule-topic-not-published", "topic of the rules that no node publishes", absence=True
)
MISSING_NEEDS_TIMEOUT = declare(
    319,
    "missing-needs-timeout",
    "missing() or age() of an input without a timeout",
    absence=True,
)
AGE_NOT_CONSTANT = declare(
    320, "age-not-constant", "age() compared with a value that is not constant"
)
UNKNOWN_USED_SYSTEM = declare(
    321, "unknown-used-system", "use of a system that the file does not define", absence=True
)
LATCHED_AND_RESET_BY = declare(322, "latched-and-reset-by", "action both latched and reset_by")
BAD_DURATION = declare(323, "bad-duration", "duration that is negative or finer than a nanosecond")
WRONG_OPERAND = declare(324, "wrong-operand", "operands that cannot be compared")
RESET_WITHOUT_TRIGGER = declare(
    325, "reset-without-trigger", "action whose reset is never triggered", _W, absence=True
)
WRONG_ACTION_ARGUMENTS = declare(
    326, "wrong-action-arguments", "wrong number of arguments for an action"
)
ACTION_TYPE_MISMATCH = declare(
    327, "action-type-mismatch", "action publishes another type than its topic has"
)
RULE_TYPE_UNKNOWN = declare(
    328, "rule-type-unknown", "topic of unknown type in the rules", absence=True
)
ACTION_VALUE = declare(329, "action-value", "value that does not fit the message of an action")
EXACT_FLOAT_COMPARISON = declare(
    330, "exact-float-comparison", "exact comparison of a floating-point value", _W
)
ACTION_TOPIC_NOT_IN_SYSTEM = declare(
    331,
    "action-topic-not-in-system",
    "topic of an action that no node in the system reads",
    _W,
    absence=True,
)
INVALID_RULES_NAME = declare(332, "invalid-rules-name", "name in the rules that a target rejects")
ACTIVE_EQUALS_INACTIVE = declare(
    333, "active-equals-inactive", "action whose active and inactive messages are equal", _W
)
ZERO_STOPS_NOTHING = declare(334, "zero-stops-nothing", "zero of a gate that is no stop")
GATE_LOOP = declare(335, "gate-loop", "gate that publishes the topic that it reads")
GATE_RATE = declare(336, "gate-rate", "gate rate outside the permitted range")
GATE_LIMIT = declare(337, "gate-limit", "limit that a gate cannot apply")
GATE_ACTION = declare(338, "gate-action", "gate on an action that publishes no state")
GATE_BYPASSED = declare(339, "gate-bypassed", "publisher wired past a gate")
GATE_NOT_IN_SYSTEM = declare(
    340, "gate-not-in-system", "gate that is not in the system", absence=True
)
GATE_UNREAD = declare(
    341, "gate-unread", "gate whose commands no node in the system reads", _W, absence=True
)
GATE_LIMIT_OVERRIDES_ZERO = declare(
    342, "gate-limit-overrides-zero", "limit that takes precedence over the zero of an action", _W
)
GATE_WITHOUT_HEARTBEAT = declare(
    343, "gate-without-heartbeat", "gate that does not monitor the heartbeat", _W, absence=True
)
GATE_WITHOUT_INPUT = declare(
    344, "gate-without-input", "gate that does not monitor its input", _W, absence=True
)
HEARTBEAT_TIMEOUT_TOO_SHORT = declare(
    345, "heartbeat-timeout-too-short", "heartbeat timeout that is too short", _W
)
STATE_PUBLISHED_TWICE = declare(
    346, "state-published-twice", "state of an action that two nodes publish"
)
HEARTBEAT_PUBLISHED_TWICE = declare(
    347, "heartbeat-published-twice", "heartbeat that two nodes publish"
)
UNHANDLED_UNKNOWN = declare(
    348, "unhandled-unknown", "rule that may become unknown without any reaction", _W, absence=True
)
UNUSED_TIMEOUT = declare(349, "unused-timeout", "timeout that no rule uses", _W, absence=True)
FAILSAFE_NEGATED = declare(350, "failsafe-negated", "failsafe rule that acts upside down", _W)
FAILSAFE_WITHOUT_EFFECT = declare(
    351, "failsafe-without-effect", "failsafe rule that is never unknown", _W
)
TIME_OF_LOSS = declare(352, "time-of-loss", "time of a loss that is missing or said twice")
SAFETY_DESCRIPTION_DIFFERS = declare(
    353, "safety-description-differs", "safety node description that differs from its rules"
)
SAFETY_CONNECTED_DIFFERENTLY = declare(
    354, "safety-connected-differently", "safety node connected differently from its rules"
)
SAFETY_NOT_GENERATED = declare(
    355, "safety-not-generated", "safety node that has not been generated yet"
)
HIDDEN_ACTION = declare(356, "hidden-action", "action whose state another one hides from a gate")
GATE_RESUMES_BY_ITSELF = declare(
    357, "gate-resumes-by-itself", "gate that lets the robot resume by itself", _I
)
GATE_LIMIT_UNTIL_RESET = declare(
    358, "gate-limit-until-reset", "limit that would last until a reset"
)
GATE_LIMIT_TO_ZERO = declare(
    359, "gate-limit-to-zero", "limit that allows a gate nothing but zero", _I
)
GATE_BOUND = declare(360, "gate-bound", "end of a limit that a gate cannot find out")
BAD_FREQUENCY = declare(361, "bad-frequency", "frequency that cannot be compared")
HIGH_AT_START = declare(362, "high-at-start", "high frequency that every start has", _W)
TIMEOUT_TOO_SHORT = declare(
    363, "timeout-too-short", "timeout shorter than a safety node's periods", _W
)
SUSPECT_BEARING = declare(364, "suspect-bearing", "bearing that is probably not intended", _W)
SUSPECT_SECTOR = declare(365, "suspect-sector", "sector that is probably not intended", _W)
WRAPPING_NOT_AN_ANGLE = declare(
    366, "wrapping-not-an-angle", "field annotated as wrapping that is not an angle"
)
RATE_OF_ARRIVALS = declare(367, "rate-of-arrivals", "rate computed from arrival times", _W)
RULE_CYCLE = declare(368, "rule-cycle", "rule that depends on itself")
AMBIGUOUS_NOT = declare(369, "ambiguous-not", "'not' that can be read in two ways")
UNIT_NOT_DECLARED = declare(
    370,
    "unit-not-declared",
    "field without a known unit, computed with beside a quantity",
    absence=True,
)
FIELD_IN_TWO_UNITS = declare(371, "field-in-two-units", "field that is read in two units")
PLAIN_BESIDE_COMPUTED = declare(
    372, "plain-beside-computed", "plain number in a unit that nobody sees"
)
SINCE_WITHOUT_MEMORY = declare(373, "since-without-memory", "'since' that remembers nothing", _W)
HIDDEN_BY_UNKNOWN = declare(
    374,
    "hidden-by-unknown",
    "value that is hidden while another one is unknown",
    _I,
    absence=True,
)
ROUNDED_INTEGER = declare(375, "rounded-integer", "64-bit integer that arithmetic rounds", _I)
DURATION_TOO_SHORT = declare(
    376, "duration-too-short", "duration that is probably not intended", _W
)
INTERVAL_STARTS_OVER = declare(
    377, "interval-starts-over", "interval that a NaN starts over unnoticed", _I, absence=True
)
TWO_EVENTS = declare(378, "two-events", "two events that have to happen at one instant", _I)
WITHIN_COVERS_ALL = declare(
    379, "within-covers-all", "'within' that covers more, or less, than it seems to", _I
)
RESET_BY_HELD_BUTTON = declare(
    380, "reset-by-held-button", "reset by a button that is held or stuck", _I
)
ONE_WAY_ONLY = declare(
    381, "one-way-only", "speed that is compared one way round only", _I, absence=True
)
SINGLE_BEAM = declare(382, "single-beam", "single beam of a laser scan", _I)
HELD_TOGETHER = declare(
    383, "held-together", "buttons that count as pressed together while one is held", _I
)
BAD_COUNT = declare(384, "bad-count", "number of times that cannot be counted")
BAD_NO_RETURN = declare(385, "bad-no-return", "value that no laser scanner reports for nothing")
UNASKED_BLINDNESS = declare(
    386, "unasked-blindness", "sector whose blind beams no rule asks for", _W, absence=True
)
SEVERAL_SOURCES = declare(387, "several-sources", "topic of the rules with several publishers", _W)
JUDGED_TOO_LATE = declare(388, "judged-too-late", "rule on the commands that a gate passes", _W)
ACTION_CYCLE = declare(389, "action-cycle", "action whose state depends on itself")
GATE_RAMP = declare(390, "gate-ramp", "ramp that a gate cannot follow")
GATE_SEND = declare(391, "gate-send", "value that a gate cannot send")
UNBOUNDED_RAMP = declare(
    392, "unbounded-ramp", "ramp without a time to standstill", _W, absence=True
)
TIME_TO_STANDSTILL = declare(393, "time-to-standstill", "time that a ramp takes", _I)
WEAKER_STOP_FIRST = declare(
    394, "weaker-stop-first", "stop of a gate that comes after a weaker one", _W
)
UNASKED_FUTURE = declare(
    395, "unasked-future", "latency of which no rule asks whether it is negative", _W, absence=True
)
NOT_CALLABLE = declare(396, "not-callable", "service that an action cannot call")
CALL_WITHOUT_SERVER = declare(
    397,
    "call-without-server",
    "service of an action that no node in the system serves",
    _W,
    absence=True,
)
BAD_TUNABLE = declare(398, "bad-tunable", "tunable constant that cannot be one")
TUNABLE_NAME_TAKEN = declare(
    399, "tunable-name-taken", "tunable constant with the name of another parameter"
)
