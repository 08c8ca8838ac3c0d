"""Codes of system descriptions."""

from __future__ import annotations

from deros.diagnostics import Severity, declare

_W = Severity.WARNING
_I = Severity.INFO

# System descriptions
UNKNOWN_IMPORT = declare(201, "unknown-import", "imported file not found")
CYCLIC_IMPORT = declare(202, "cyclic-import", "cyclic import")
UNKNOWN_NODE_TYPE = declare(203, "unknown-node-type", "unknown node type", absence=True)
UNKNOWN_PORT = declare(204, "unknown-port", "unknown port", absence=True)
UNKNOWN_TOPIC = declare(205, "unknown-topic", "unknown topic", absence=True)
UNKNOWN_PARAMETER = declare(206, "unknown-parameter", "unknown parameter", absence=True)
WRONG_PARAMETER_VALUE = declare(207, "wrong-parameter-value", "parameter value of the wrong type")
TYPE_MISMATCH = declare(208, "type-mismatch", "two ends of a topic with different types")
PINNED_TYPE_VIOLATED = declare(209, "pinned-type-violated", "pinned topic type violated")
NO_PUBLISHER = declare(210, "no-publisher", "topic without a publisher", _W, absence=True)
NO_SUBSCRIBER = declare(211, "no-subscriber", "topic without a subscriber", _W, absence=True)
UNUSED_TOPIC = declare(212, "unused-topic", "declared topic that is not used", _W, absence=True)
UNWIRED_PORT = declare(213, "unwired-port", "port left unwired", _W, absence=True)
LIKELY_MISSPELLING = declare(
    214, "likely-misspelling", "topic names that probably mean the same topic", _W, absence=True
)
DUPLICATE_NODE_NAME = declare(215, "duplicate-node-name", "two nodes with one full name")
TOPIC_PARAMETER_CONFLICT = declare(
    216, "topic-parameter-conflict", "parameter contradicts the wiring made through it"
)
UNTYPED_WIRING = declare(
    217, "untyped-wiring", "wiring through a parameter that belongs to no port", _I, absence=True
)
DUPLICATE_TOPIC = declare(218, "duplicate-topic", "topic declared twice")
DUPLICATE_SETTING = declare(219, "duplicate-setting", "parameter set or port connected twice")
UNKNOWN_SYSTEM = declare(220, "unknown-system", "unknown system", absence=True)
PARAMETER_OUT_OF_RANGE = declare(
    221, "parameter-out-of-range", "parameter value outside the declared bounds"
)
UNUSED_IMPORT = declare(222, "unused-import", "unused import", _W, absence=True)
INVALID_SYSTEM_NAME = declare(223, "invalid-system-name", "name in a system that ROS 2 rejects")
AMBIGUOUS_NODE_TYPE = declare(
    224, "ambiguous-node-type", "node type name that two imported files define"
)
SERVICE_WITHOUT_SERVER = declare(
    225, "service-without-server", "service or action without a server", _W, absence=True
)
DUPLICATE_SUBSYSTEM = declare(
    226, "duplicate-subsystem", "two subsystems with one name in one place"
)
PARAMETER_WITHOUT_VALUE = declare(
    227, "parameter-without-value", "parameter without default and without value", absence=True
)
INCOMPATIBLE_QOS = declare(228, "incompatible-qos", "two ends whose QoS does not match")
UNCERTAIN_QOS = declare(229, "uncertain-qos", "two ends whose QoS may not match", _W)
PINNED_QOS_VIOLATED = declare(230, "pinned-qos-violated", "pinned QoS violated")
EMPTY_QOS_PIN = declare(231, "empty-qos-pin", "QoS of a topic that pins nothing")
STANDARD_TOPIC_TYPE = declare(232, "standard-topic-type", "standard topic with an unusual type")
QOS_OVERRIDE_UNREAD = declare(
    233, "qos-override-unread", "QoS override that the node does not read", _W
)
RULES_DO_NOT_USE_SYSTEM = declare(
    236, "rules-do-not-use-system", "safety statement for rules that use another system"
)
CONNECTED_BY_RULES = declare(
    237, "connected-by-rules", "connection that a safety statement already makes"
)
RULES_RUN_TWICE = declare(238, "rules-run-twice", "rules whose nodes are started twice")
RULES_NOT_LOADED = declare(
    239, "rules-not-loaded", "hand-wired safety node checked without its rules", _W, absence=True
)
LIKELY_SWAPPED = declare(240, "likely-swapped", "two connections that are probably swapped", _W)
UNITS_DIFFER = declare(241, "units-differ", "field to which two ends of a topic give two units")
SEVERAL_COMMANDERS = declare(
    242, "several-commanders", "topic that moves something, with several publishers", _W
)
SHARED_BY_INSTANCES = declare(
    243, "shared-by-instances", "topic that the instances of one system share", _W
)
LATE_SUBSCRIPTION = declare(
    244, "late-subscription", "volatile subscription to a latched topic", _W
)
NEVER_ACTIVATED = declare(
    245, "never-activated", "managed node that nothing activates", absence=True
)
UNKNOWN_MANAGER = declare(
    246, "unknown-manager", "'activated by' that does not fit the system", absence=True
)
SIMULATED_TIME = declare(
    247, "simulated-time", "simulated time of some nodes only, or without a clock", _W
)
FRAME_BROADCAST_TWICE = declare(248, "frame-broadcast-twice", "frame that two nodes broadcast")
SHARE_IN_ANOTHER_UNIT = declare(
    249, "share-in-another-unit", "field that its message defines from 0 to 1, in another unit", _W
)
GATE_READER_KEEPS_GOING = declare(
    250,
    "gate-reader-keeps-going",
    "reader of a gate that may not stop in silence",
    _W,
    absence=True,
)

UNKNOWN_ARGUMENT = declare(251, "unknown-argument", "unknown argument of a system", absence=True)
UNFIT_ARGUMENT = declare(252, "unfit-argument", "argument or expression that has no fitting value")
MISSING_ARGUMENT = declare(
    253, "missing-argument", "system used without a value for an argument", absence=True
)
UNUSED_ARGUMENT = declare(254, "unused-argument", "unused argument", _W, absence=True)
DUPLICATE_ARGUMENT = declare(255, "duplicate-argument", "argument declared or given twice")
IDLE_CONDITION = declare(256, "idle-condition", "condition that decides nothing", _W)
UNCHECKED_COMBINATIONS = declare(
    257, "unchecked-combinations", "arguments with too many combinations to check all", _I
)
NO_PARAMETER_FILE = declare(258, "no-parameter-file", "parameter file that cannot be read")
BAD_PARAMETER_FILE = declare(
    259, "bad-parameter-file", "parameter file, or value in one, that ROS 2 does not read"
)
UNREAD_SECTION = declare(
    260, "unread-section", "section of a parameter file that no node reads", absence=True
)
UNREAD_PARAMETER = declare(
    261,
    "unread-parameter",
    "parameter in a file that none of the nodes has that its section is for",
    absence=True,
)
UNCHECKED_PARAMETER_FILE = declare(
    262,
    "unchecked-parameter-file",
    "parameter file of a package that is not installed here",
    _I,
)
BEATEN_BY_FILE = declare(
    263, "beaten-by-file", "parameter of a system that its own parameter file overrides"
)
SUBSTITUTION_IN_FILE = declare(264, "substitution-in-file", "substitution in a parameter file")
BAD_VARIABLE = declare(265, "bad-variable", "environment variable that cannot be set")
NODES_APART = declare(266, "nodes-apart", "nodes that cannot hear each other", _W)
NO_NODE_BELOW = declare(267, "no-node-below", "setting of a group that no node has", absence=True)
UNFIT_COMMAND = declare(268, "unfit-command", "text that a program cannot be started with")
DUPLICATE_PROCESS = declare(269, "duplicate-process", "process called like another member")
UNFIT_AUTOSTART = declare(270, "unfit-autostart", "'autostart' of unmanaged nodes", absence=True)
ACTIVATED_TWICE = declare(271, "activated-twice", "managed node that is activated twice")
UNCOMPOSABLE_NODE = declare(
    272, "uncomposable-node", "node in a container that cannot be loaded into one", absence=True
)
UNKNOWN_CONTAINER = declare(
    273, "unknown-container", "'into' that names no container", absence=True
)
NOT_OF_COMPOSED_NODE = declare(
    274, "not-of-composed-node", "setting of a process for a node that is not one"
)
IDLE_INTRA_PROCESS = declare(
    275, "idle-intra-process", "'intra_process' of a node that is a process of its own", _W
)
BAD_PLUGIN = declare(276, "bad-plugin", "'plugin' that does not name a class")
NO_LAUNCH_FILE = declare(277, "no-launch-file", "launch file that cannot be read")
BAD_LAUNCH_FILE = declare(278, "bad-launch-file", "file that 'ros2 launch' does not read")
UNFIT_LAUNCH_ARGUMENT = declare(
    279, "unfit-launch-argument", "argument that a launch file does not take, or lacks"
)
UNCHECKED_LAUNCH_FILE = declare(
    280,
    "unchecked-launch-file",
    "launch file, or one for xacro, of a package that is not installed here",
    _I,
)
NOT_IN_LAUNCH_FILE = declare(
    281,
    "not-in-launch-file",
    "described node that the launch file does not start",
    _W,
    absence=True,
)
UNKNOWN_AWAITED = declare(282, "unknown-awaited", "'after' what is not there", absence=True)
CIRCULAR_START = declare(283, "circular-start", "programs that wait for each other")
NEVER_EXITS = declare(284, "never-exits", "'after exit of' what has no end of its own")
RESPAWNED_STOPS_ALL = declare(
    285, "respawned-stops-all", "'on exit stop all' of a program that is started again"
)
UNKNOWN_PROCESS = declare(
    286, "unknown-process", "'inside' that names no program here", absence=True
)
NOT_A_PROCESS = declare(287, "not-a-process", "'inside' of a node that has no process of its own")
ALIKE_IN_PROCESS = declare(288, "alike-in-process", "nodes of one name in one process")
NO_XACRO_FILE = declare(289, "no-xacro-file", "file for xacro that cannot be read")
UNFIT_XACRO = declare(290, "unfit-xacro", "parameter that xacro cannot make as it is written")
UNFIT_BELOW = declare(291, "unfit-below", "'below' that names no namespace")
UNMOVABLE_KEY = declare(
    292, "unmovable-key", "key of a parameter file that cannot be moved below another"
)
UNFIT_MADE_FILE = declare(
    293, "unfit-made-file", "made file whose name is taken, or whose path is used elsewhere"
)
UNKNOWN_HOST = declare(294, "unknown-host", "'on' a host that is not declared", absence=True)
UNPLACED_PROGRAM = declare(295, "unplaced-program", "program that is on none of the hosts")
HOSTS_APART = declare(296, "hosts-apart", "programs on two hosts that have to be on one")
UNPROVIDED_NAME = declare(
    297, "unprovided-name", "start after a service or topic that nothing provides", absence=True
)
NEVER_READY = declare(298, "never-ready", "start after a node that is never there, or never active")
UNFIT_ADDRESS = declare(299, "unfit-address", "address of a host that no host can have")
