"""The topics that rules see of a system that is computed from arguments."""

from __future__ import annotations

from pathlib import Path

from deros.models.system import System
from deros.rules.compiler.scope.topics import SystemTopics
from tests.support.checks import checked_rules
from tests.support.systems import load_text

DRIVER = "node driver : drivers publishes topic out : std_msgs.Float64\n"
OTHER = "node other : drivers publishes topic out : std_msgs.Float32\n"
SYSTEM = """\
system Robot
imports import "driver.rnd" import "other.rnd"
argument kind : string = "none" one_of ["none", "gauge", "scale"]
argument extra : bool = false
topics
  topic /always
  topic /load when kind != "none"
  topic "/${kind}/raw"
node base : driver
wirings connect out to /always
node gauge : driver when kind = "gauge"
wirings connect out to /load
node scale : other when kind = "scale"
wirings connect out to /load
node again : driver when extra
wirings connect out to /always
"""


def _system(folder: Path) -> System:
    return load_text(folder, SYSTEM, driver=DRIVER, other=OTHER)


def test_topic_of_another_variant_is_known(tmp_path: Path) -> None:
    """It is as in the first variant that has it: with that one's publisher and type."""
    topics = SystemTopics([_system(tmp_path)])
    load = topics.get("/load")
    assert load is not None
    assert [port.port.type.name for port in load.publishers] == ["Float64"]
    assert [kind.name for kind in load.types] == ["Float64"]
    assert len(load.declarations) == 1
    assert {"/none/raw", "/gauge/raw", "/scale/raw"} <= set(topics.names)
    assert topics.get("/lost") is None


def test_topic_of_the_usual_variant_stays_as_it_is_there(tmp_path: Path) -> None:
    """A second publisher that some arguments add is none by default."""
    topics = SystemTopics([_system(tmp_path)])
    always = topics.get("/always")
    assert always is not None
    assert len(always.publishers) == 1
    assert [system.system.name for system in topics.systems] == ["Robot"]
    assert [node.full_name for node in topics.systems[0].nodes] == ["/base"]


def test_rules_may_name_a_topic_of_another_variant(tmp_path: Path) -> None:
    """One that no variant has is still an error, with those of all variants to choose from."""
    (tmp_path / "driver.rnd").write_text(DRIVER)
    (tmp_path / "other.rnd").write_text(OTHER)
    rules = """\
use "robot.system" import Robot
action stop latched
input load = topic TOPIC.data timeout 1 sec
entity fork { heavy: load > 5 or load.missing(); }
if fork.heavy then { stop; };
"""
    found = checked_rules(rules.replace("TOPIC", "/load"), SYSTEM, tmp_path)
    assert [each for each in found if each.span.file.endswith(".deros") and each.is_error] == []
    wrong = checked_rules(rules.replace("TOPIC", "/loat"), SYSTEM, tmp_path)
    (finding,) = (each for each in wrong if each.code.name == "DRS301")
    assert "/load" in finding.hint
