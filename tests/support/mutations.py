"""Texts of the three languages, and ways to spoil them."""

from __future__ import annotations

from hypothesis import strategies as st

from tests.support import paper

_EXTENSIONS = """\
node a : p "d" executable "x" lifecycle
parameters name x : double[] = [1.0, 2e3] [m/s] in [0.1, 2) one_of [1] size 3 read_only "d"
publishes topic /o : a.B { t.x[2] [m/s], y [rad] } qos best_effort depth 5 deadline 1 ms via x
topic /tf : tf2_msgs.TFMessage { frame <f>/odom -> base-link if b, frame c -> d }
timers timer t every 20 ms
"""
_RULES = """\
unit pace = 0.5 m/s
action stop publishes true on /stop : std_msgs.Bool reset_by ok latched "d";
action brake calls false on /brake : a.B latched; action horn calls horn : a.B;
input s = topic /scan.ranges[2] timeout 0.5 sec
entity e { r: (not /a.b.c(1, -2 deg).d() >= -x.y for 2 sec) or s in (0, 1 m] and t; }
behaviour b: if e.r then { stop; if e.r then { log_state("a\\"b"); }; };
optional behaviour c: if e.r for 2 sec then { stop };
gate /nav -> /cmd : a.B rate 20 Hz "d" {
  stop: limit x.y[2] to [-s, 1 m/s] m/s, z to [0, 1]; low: zero
  lost heartbeat for 0.3 sec: zero; lost input for 0.5 sec: zero;
}
"""
_SYSTEM = """\
system S imports import "n/*.rnd" topics external topic /t : a.B qos reliable "d"
subsystem l : Arm namespace /l node n : a namespace x respawn delay 1 sec max 3 log_level warn
activated by l/m node o : a autostart timeout 1 sec on failure stop
delay 1 sec after exit of l/x on exit stop all
parameters param p = [true, "x", -1.5e3] wirings connect a to ~/b;
process q : "q" after service /x timeout 2 sec process r : "r" after active o delay 1 sec
"""
TEXTS = {
    "rnd": [paper.FIGURE_11, _EXTENSIONS],
    "system": [paper.FIGURE_12, _SYSTEM],
    "deros": [*paper.RULES.values(), _RULES],
}
"""Sound models by the suffix of their files."""

_WORDS = "not for in if topic node subsystem connect qos gate lost limit optional"
_OTHERS = "0 1e9 é \u00a0 \x0c \U0001f916"
_SIGNS = '" \\ /* */ // ( ) [ ] { } ; : . , - -> ~ / ='
PIECES = st.sampled_from(["", " ", "\n", *f"{_WORDS} {_OTHERS} {_SIGNS}".split(" ")])
"""Words and signs of the languages, and what is none of them."""


@st.composite
def mutated(draw: st.DrawFn) -> tuple[str, str]:
    """Draw a suffix and one of its texts, cut short or with pieces replaced."""
    suffix = draw(st.sampled_from(sorted(TEXTS)))
    text = draw(st.sampled_from(TEXTS[suffix]))
    if draw(st.booleans()):
        return suffix, text[: draw(st.integers(0, len(text)))]
    for _ in range(draw(st.integers(1, 5))):
        start = draw(st.integers(0, len(text)))
        end = min(len(text), start + draw(st.integers(0, 8)))
        text = text[:start] + draw(PIECES) + text[end:]
    return suffix, text
