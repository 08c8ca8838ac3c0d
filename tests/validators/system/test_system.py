"""Findings of systems of several files and of very large systems; single findings are in cases."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.diagnostics import Diagnostic
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.validators.check import check
from tests.support.checks import checked
from tests.support.work import calls

NODES = {
    "source.rnd": "node source : demo publishes topic out : std_msgs.Float64\n",
    "sink.rnd": "node sink : demo subscribes topic in : std_msgs.Float64\n",
}
ARM = """\
system Arm
imports import "*.rnd"
topics
  topic state
  topic /estop
subsystem Joints {
  node elbow : source wirings connect out to state
  node brake : sink wirings connect in to /estop
}
"""


def _check(directory: Path, *names: str, **files: str) -> list[Diagnostic]:
    for name, text in {**NODES, **files}.items():
        (directory / name).write_text(text)
    return checked(*(directory / name for name in names))


def _files_and_codes(findings: list[Diagnostic]) -> list[tuple[str, str]]:
    return [(Path(d.span.file).name, d.code.name) for d in findings]


def test_importing_system_may_complete_a_part(tmp_path: Path) -> None:
    """Missing ends of a part are reported only if the whole system lacks them."""
    robot = """\
system Robot
imports import "arm.system" import "*.rnd"
topics topic /estop
subsystem left : Arm namespace /left
node guard : source wirings connect out to /estop
"""
    alone = _check(tmp_path, "arm.system", **{"arm.system": ARM})
    assert _files_and_codes(alone) == [("arm.system", "DRS211"), ("arm.system", "DRS210")]
    whole = _check(tmp_path, "robot.system", **{"robot.system": robot})
    assert _files_and_codes(whole) == [("arm.system", "DRS211")]
    assert "/left/state" in whole[0].message


def test_rules_count_as_ends_of_their_topics(tmp_path: Path) -> None:
    """A topic that only the safety node reads or feeds is complete."""
    rules = """\
use "arm.system" import Arm
action halt publishes 1.0 on /estop : std_msgs.Float64 latched;
input state = topic /state.data timeout 1 sec
entity arm { failsafe far: state > 1.0; }
if arm.far then { halt; };
"""
    findings = _check(tmp_path, "arm.deros", **{"arm.system": ARM, "arm.deros": rules})
    assert _files_and_codes(findings) == []


def test_findings_of_imports_are_reported_once(tmp_path: Path) -> None:
    """A node description used by two systems is checked once."""
    bad = "node sink : demo subscribes topic in : std_msgs.Flot64\n"
    robot = 'system Robot\nimports import "arm.system"\nsubsystem left : Arm namespace /left\n'
    findings = _check(
        tmp_path,
        "robot.system",
        "arm.system",
        **{"sink.rnd": bad, "arm.system": ARM, "robot.system": robot},
    )
    assert [d.code.name for d in findings].count("DRS102") == 1


def test_namespaces_separate_two_uses_of_a_system(tmp_path: Path) -> None:
    """A system used twice needs only a namespace for each use."""
    template = """\
system Robot
imports import "arm.system"
topics external topic /estop
{topics}
subsystem left : Arm{left}
subsystem right : Arm{right}
"""
    external = "external topic /left/state external topic /right/state"
    apart = template.format(left=" namespace /left", right=" namespace /right", topics=external)
    files = {"arm.system": ARM, "robot.system": apart}
    assert _files_and_codes(_check(tmp_path, "robot.system", **files)) == []
    files["robot.system"] = template.format(left="", right="", topics="external topic /state")
    codes = [code for _, code in _files_and_codes(_check(tmp_path, "robot.system", **files))]
    assert codes == ["DRS215", "DRS215"]


def _fleet(nodes: int, wrong: int) -> str:
    """Return a chain of nodes; the first ``wrong`` are connected to misspelt topics."""
    lines = ["system Fleet", 'imports import "*.rnd"', "topics"]
    lines += [f"  topic /stage/number_{i}" for i in range(nodes)]
    for i in range(nodes):
        topic = f"/stage/nmber_{i}" if i < wrong else f"/stage/number_{i}"
        lines += [f"node source_{i} : source wirings connect out to {topic}"]
        lines += [f"node sink_{i} : sink wirings connect in to /stage/number_{i}"]
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize("wrong", [0, 400])
def test_work_of_a_check_is_linear(tmp_path: Path, wrong: int) -> None:
    """Four times the nodes, sound or misspelt, are about four times the work."""

    def work(nodes: int) -> int:
        path = tmp_path / "fleet.system"
        path.write_text(_fleet(nodes, wrong * nodes // 400))
        for name, text in NODES.items():
            (tmp_path / name).write_text(text)
        repository = Repository()
        named = [repository.load(path)]
        return calls(lambda: check(named, repository, InterfaceStore((), prefixes=())))

    work(100)  # what is done once
    assert work(1200) < 5 * work(300)


def test_misspelt_topics_get_a_hint_among_hundreds(tmp_path: Path) -> None:
    """The hint names the right topic out of hundreds."""
    findings = _check(tmp_path, "fleet.system", **{"fleet.system": _fleet(400, 3)})
    unknown = [d for d in findings if d.code.name == "DRS205"]
    assert [d.hint for d in unknown] == [f"did you mean '/stage/number_{i}'?" for i in range(3)]
