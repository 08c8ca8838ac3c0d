"""Systems with arguments at random, of nodes whose ends disagree in type, QoS and life."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from hypothesis import strategies as st

from deros.metamodels.load import Repository
from deros.models.common import Scalar
from deros.models.system import System

TYPES = {
    "source": 'node source : p parameters name frame : string = "map" name sim : bool = false'
    " publishes topic out : std_msgs.Int32",
    "other": 'node other : p parameters name many : string[] = ["q"]'
    " publishes topic out : std_msgs.Bool",
    "sink": "node sink : p parameters name rate : double = 1.0 in [0, 6]"
    " subscribes topic in : std_msgs.Int32",
    "late": "node late : p publishes topic out : std_msgs.Int32 qos best_effort"
    " subscribes topic in : std_msgs.Int32 qos reliable",
    "managed": "node managed : p lifecycle publishes topic out : std_msgs.Int32",
}
"""Node types whose ends disagree with each other in type, QoS and life."""

VALUES: Mapping[str, tuple[Scalar, ...]] = {
    "a": (False, True),
    "b": (True, False),
    "c": (False, True),
    "mode": ("auto", "hand", "off"),
    "n": (1, 2, 3),
}
"""All values that the arguments may have, the default first."""

DECLARATIONS = """
argument a : bool = false
argument b : bool = true
argument c : bool
argument mode : string = "auto" one_of ["auto", "hand", "off"]
argument n : int = 1 in [1, 3]
"""


def load(folder: Path, text: str) -> System:
    """Load a system whose imports are :data:`TYPES`."""
    for name, description in TYPES.items():
        (folder / f"{name}.rnd").write_text(description)
    (folder / "s.system").write_text(text)
    loaded = Repository().load(folder / "s.system")
    assert isinstance(loaded.model, System)
    assert loaded.diagnostics == (), text
    return loaded.model


atoms = st.sampled_from(
    ["a", "b", "c", "not a", 'mode = "off"', 'mode in ["auto", "hand"]', "n > 1", "n = 3", "a = b"]
)
conditions = st.one_of(
    atoms,
    st.tuples(atoms, st.sampled_from(["and", "or"]), atoms).map(" ".join),
    atoms.map(lambda atom: f"not ({atom})"),
)
optional_conditions = st.one_of(st.just(""), conditions.map(lambda found: f" when {found}"))
CHOICES = ("if a then 2 else 9", 'if n > 2 and mode = "off" then $n * 3 else 1')
topics = st.sampled_from(["/x", "/y", "/z", '"/${mode}/x"'])


@st.composite
def nodes(draw: st.DrawFn) -> str:
    """Return a node of some type, some parts of which have conditions."""
    kind = draw(st.sampled_from(list(TYPES)))
    name = draw(st.sampled_from(["one", "two", "three"]))
    words = f' arguments ["-x"{draw(optional_conditions)}, $n{draw(optional_conditions)}]'
    again = draw(st.sampled_from(["", "", " respawn", f" respawn if {draw(conditions)} max 2"]))
    again += draw(st.sampled_from(["", "", words]))
    text = f"node {name} : {kind}{again}{draw(optional_conditions)}"
    if kind == "sink":
        value = draw(st.sampled_from(["2", "$n * 2", "9", *CHOICES]))
        text += f" parameters param rate = {value}{draw(optional_conditions)}"
    port = "in" if kind == "sink" else "out"
    wirings = draw(st.lists(st.tuples(topics, optional_conditions), max_size=2))
    if wirings:
        text += " wirings"
        for topic, condition in wirings:
            text += f" connect {port} to {topic}{condition}"
    own = draw(
        st.lists(st.sampled_from([f"/{port}", "lib", '"/${mode}"']), max_size=2, unique=True)
    )
    if own:
        text += " remappings "
        text += " ".join(
            f"remap {name} to {draw(topics)}{draw(optional_conditions)}" for name in own
        )
    return text


@st.composite
def group_settings(draw: st.DrawFn) -> str:
    """Return settings for all that is below, some of which have conditions; often none."""
    text = ""
    for setting in draw(
        st.lists(
            st.sampled_from(["env ROS_DOMAIN_ID = $n", 'env ROS_DOMAIN_ID = "2"', "env A = 1"]),
            max_size=2,
            unique=True,
        )
    ):
        text += f"{setting}{draw(optional_conditions)} "
    settings = st.sampled_from(
        [
            'param frame = "x"',
            "param use_sim_time = true",
            'param many = ["x" when a, "y"]',
            "param rate = 9",
            "param rate = $n",
        ]
    )
    parameters = draw(st.lists(settings, max_size=2, unique=True))
    if parameters:
        text += "parameters "
        text += " ".join(f"{each}{draw(optional_conditions)}" for each in parameters)
    possible = ["out", "/in", "lib", '"${mode}"']
    names = draw(st.lists(st.sampled_from(possible), max_size=2, unique=True))
    if names:
        text += " remappings "
        text += " ".join(
            f"remap {name} to {draw(topics)}{draw(optional_conditions)}" for name in names
        )
    return text


@st.composite
def processes(draw: st.DrawFn) -> str:
    """Return a process, or nothing."""
    if draw(st.integers(0, 3)):
        return ""
    name = draw(st.sampled_from(["one", "two", "tool"]))
    words = draw(st.sampled_from(["", ' arguments ["-x", $n]', ' env A = "${mode}"']))
    return f' process {name} : "tool"{words}{draw(optional_conditions)}'


@st.composite
def systems(draw: st.DrawFn) -> str:
    """Return a system of nodes in subsystems, with conditions here and there."""
    parts = draw(st.lists(nodes(), min_size=1, max_size=5))
    text = f'system S {DECLARATIONS} imports import "*.rnd"\n'
    text += f"{draw(group_settings())}\ntopics\n"
    for topic in ("/x", "/y", '"/${mode}/x"'):
        text += f"topic {topic}{draw(optional_conditions)}\n"
    for number, part in enumerate(parts):
        if draw(st.booleans()):
            space = draw(st.sampled_from(["", " namespace /inner", " namespace $mode"]))
            inside = f"{draw(group_settings())} {part}{draw(processes())}"
            text += f"subsystem part{number}{space}{draw(optional_conditions)} {{ {inside} }}\n"
        else:
            text += f"{part}{draw(processes())}\n"
    return text


@st.composite
def waiting_systems(draw: st.DrawFn) -> str:
    """Return such a system in which processes wait for nodes and ends, some of them in vain."""
    text = draw(systems())
    for number in range(draw(st.integers(1, 3))):
        program = draw(st.sampled_from(["one", "two", "part0/one", "part1/two"]))
        end = draw(st.sampled_from(["/x", "y", '"/${mode}/x"', '"${mode}"', "one/get_parameters"]))
        wait = draw(
            st.sampled_from(
                [f"node {program}", f"active {program}", f"service {end}", f"topic {end}"]
            )
        )
        waiting = f'process wait{number} : "tool" after {wait}{draw(optional_conditions)}'
        space = draw(st.sampled_from(["", "namespace /inner", "namespace $mode"]))
        text += f"subsystem waits{number} {space} {{ {waiting} }}\n"
    return text
