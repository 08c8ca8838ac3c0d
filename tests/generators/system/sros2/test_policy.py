"""The policy: its form, what it allows, its enclaves, and what it refuses."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from deros.generators.api.protocol import GenerationError
from deros.generators.builtin import rossystem_sros2
from deros.models.system import System
from tests.support import real_systems
from tests.support.golden import Golden
from tests.support.needs import needs
from tests.support.policies import (
    allowed_by,
    enclaves_of,
    faults_of_form,
    policy_text,
    schema_of,
)
from tests.support.systems import CONTEXT, EVERYTHING, MODELS, load, load_text

NODE = """
    node worker : tools
    parameters
      name topic : string = "picture"
      name sources : string[] = ["a", "b"]
    publishes
      topic out : std_msgs.Bool
    subscribes
      topic in : std_msgs.Bool
      topic each : std_msgs.Bool via sources
      topic picture : std_msgs.Bool via topic
    services
      service reset : std_srvs.Trigger
    clients
      client ask : std_srvs.Trigger
    actions
      action dock : example_interfaces.Fibonacci
    action_clients
      action drive : example_interfaces.Fibonacci
"""
PLAIN = "node worker : tools publishes topic out : std_msgs.Bool"
MANAGED = "node worker : tools lifecycle"
EVENTS = ("subscribe", "/parameter_events")


def system(folder: Path, body: str, node: str = PLAIN) -> System:
    """Load a system of nodes that are called ``worker``."""
    return load_text(folder, f'system T imports import "*.rnd" {body}', worker=node)


def without_untyped(folder: Path) -> System:
    """Load the system with every construct but a topic at a parameter that is no port's."""
    shutil.copytree(MODELS, folder / "models")
    path = folder / "models" / EVERYTHING.name
    text = path.read_text(encoding="utf-8")
    line = "      connect legacy_topic to /pictures\n"
    assert text.count(line) == 1
    path.write_text(text.replace(line, ""), encoding="utf-8")
    return load(path)


def rights(model: System, node: str = "/a", **options: str) -> frozenset[tuple[str, str]]:
    """Return what the policy of a system allows to one node."""
    return allowed_by(policy_text(model, **options))[node]


def refusals(model: System) -> list[tuple[str, str]]:
    """Return the codes and messages with which a policy is refused."""
    with pytest.raises(GenerationError) as error:
        rossystem_sros2(model, CONTEXT)
    return [(each.code.name, each.message) for each in error.value.diagnostics]


# Form ---------------------------------------------------------------------------------------------


def test_policy_matches_golden(golden: Golden, tmp_path: Path) -> None:
    """The text for a system with every construct matches the reviewed one."""
    golden.check("rossystem_sros2", rossystem_sros2(without_untyped(tmp_path), CONTEXT))


@pytest.mark.parametrize("name", real_systems.names())
def test_policy_has_the_form_of_sros2(name: str) -> None:
    """The policies of the public systems are of the elements and attributes that sros2 reads."""
    text = policy_text(load(real_systems.path_of(name)))
    assert list(faults_of_form(text)) == []


@needs("xmllint")
def test_policy_is_valid_against_the_schema_of_sros2(tmp_path: Path) -> None:
    """The schema that ``ros2 security`` checks with accepts the policy."""
    schema = schema_of(tmp_path)
    if schema is None:
        pytest.skip("no sros2")
    policy = tmp_path / "t.policy.xml"
    policy.write_text(policy_text(without_untyped(tmp_path)))
    command = ["xmllint", "--noout", "--nonet", "--schema", str(schema), str(policy)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ('version="0.2.0"', 'version="0.1.0"'),
        ('publish="ALLOW"', 'reply="ALLOW"'),
        ('publish="ALLOW"', 'publish="allow"'),
        ("<topic>/out</topic>", "<topic></topic>"),
        ('node="a"', ""),
        ("<profiles>", "<profiles/><profiles>"),
    ],
)
def test_check_of_form_finds_faults(before: str, after: str, tmp_path: Path) -> None:
    """What sros2 would reject is found without it, too."""
    text = policy_text(system(tmp_path, "node a : worker"))
    assert before in text
    assert list(faults_of_form(text)) == []
    assert list(faults_of_form(text.replace(before, after, 1))) != []


# What is allowed ----------------------------------------------------------------------------------


def test_every_kind_of_port_has_its_right_under_the_name_on_the_wire(tmp_path: Path) -> None:
    """Wired ports have the names of their topics, others their own; lists have all of theirs."""
    body = """
        subsystem front namespace front {
          node a : worker
          parameters param sources = ["x", "/y"]
          wirings
            connect out to /wire
            connect picture to /view
            connect ask to /all/reset
            connect dock to /station
        }
    """
    model = system(tmp_path, body, NODE)
    usual = rights(system(tmp_path, "subsystem front namespace front { node a : worker }"), FRONT)
    found = rights(model, FRONT) - (usual - {("publish", "/front/out")})
    assert found == {
        ("publish", "/wire"),
        *(("subscribe", name) for name in ("/front/in", "/front/x", "/y", "/view")),
        ("reply", "/front/reset"),
        ("request", "/all/reset"),
        *(("reply", f"/station/_action/{each}") for each in SERVICES),
        *(("publish", f"/station/_action/{each}") for each in TOPICS),
        *(("request", f"/front/drive/_action/{each}") for each in SERVICES),
        *(("subscribe", f"/front/drive/_action/{each}") for each in TOPICS),
    }


FRONT = "/front/a"
SERVICES = ("send_goal", "cancel_goal", "get_result")
TOPICS = ("feedback", "status")


def test_time_and_type_descriptions_follow_the_parameters(tmp_path: Path) -> None:
    """``/clock`` is for nodes on simulated time alone; a service that is off needs no right."""
    clock, described = ("subscribe", "/clock"), ("reply", "/a/get_type_description")
    usual = rights(system(tmp_path, "node a : worker"))
    assert clock not in usual
    assert described in usual
    on = rights(system(tmp_path, "node a : worker parameters param use_sim_time = true"))
    assert on - usual == {clock}
    body = "node a : worker parameters param start_type_description_service = false"
    assert usual - rights(system(tmp_path, body)) == {described}


def test_remapping_of_a_group_moves_what_no_port_declares(tmp_path: Path) -> None:
    """ROS 2 applies it to the names that a client library asks for, and so does the policy."""
    found = rights(system(tmp_path, "remappings remap /rosout to /log node a : worker"))
    assert ("publish", "/log") in found
    assert ("publish", "/rosout") not in found


def test_managed_nodes_have_their_services_and_their_manager_its_requests(tmp_path: Path) -> None:
    """Bring-up may change the state of the nodes with ``autostart`` and of no others."""
    model = system(tmp_path, "node a : worker autostart node b : worker", MANAGED)
    policy = allowed_by(policy_text(model))
    for node in ("/a", "/b"):
        assert ("publish", f"{node}/transition_event") in policy[node]
        assert ("reply", f"{node}/change_state") in policy[node]
    requests = {name for right, name in policy["/_bring_up_*"] if right == "request"}
    assert requests == {"/a/change_state", "/a/get_state"}
    assert "/_bring_up_*" not in allowed_by(policy_text(system(tmp_path, "node a : worker")))


# Enclaves -----------------------------------------------------------------------------------------


def test_each_node_has_an_enclave_unless_told_otherwise(tmp_path: Path) -> None:
    """Full names are the default; a variable of the system, or the option, says another."""
    body = """
        node a : worker
        subsystem front namespace /front {
          env ROS_SECURITY_ENCLAVE_OVERRIDE = "/eyes"
          node b : worker
          node c : worker
        }
    """
    model = system(tmp_path, body)
    assert enclaves_of(policy_text(model)) == {"/a": ["a"], "/eyes": ["b", "c"]}
    assert enclaves_of(policy_text(model, enclave="/robot")) == {"/robot": ["a", "b", "c"]}


@pytest.mark.parametrize("name", ["robot", "", "/a b", "/x/"])
def test_enclave_has_to_be_an_absolute_name(name: str, tmp_path: Path) -> None:
    """The option is checked as ROS 2 would check it."""
    with pytest.raises(ValueError, match="enclave"):
        policy_text(system(tmp_path, "node a : worker"), enclave=name)


# Arguments ----------------------------------------------------------------------------------------


def test_policy_allows_for_all_values_of_the_arguments(tmp_path: Path) -> None:
    """Nodes and names that there are for some values are allowed, those of no value are not."""
    body = """
        argument side : string = "left" one_of ["left", "right"]
        argument second : bool = false
        argument simulated : bool = false
        argument level : int = 1
        node a : worker
        parameters param use_sim_time = $simulated
        wirings connect out to "/${side}/out"
        node b : worker when second
        node c : worker namespace $side when level > 3
    """
    policy = allowed_by(policy_text(system(tmp_path, body)))
    assert set(policy) == {"/a", "/b", "/left/c", "/right/c"}
    topics = {name for right, name in policy["/a"] if right == "publish"}
    assert topics == {"/left/out", "/right/out", "/rosout", "/parameter_events"}
    assert ("subscribe", "/clock") in policy["/a"]
    assert ("subscribe", "/clock") not in policy["/b"]


@pytest.mark.parametrize(
    ("body", "what"),
    [
        (
            'argument robot : string = "r" node a : worker namespace $robot',
            "the namespace of 'a' depends on argument 'robot', which may have any value",
        ),
        (
            'argument n : int = 1 node a : worker wirings connect out to "/x${n}"',
            "the name of 'out' of 'a' depends on argument 'n', which may have any value",
        ),
        (
            'node a : worker wirings connect out to "/${env(ROBOT, r)}/out"',
            "the name of 'out' of 'a' is looked up where the system is started",
        ),
    ],
)
def test_what_only_the_start_decides_is_refused(body: str, what: str, tmp_path: Path) -> None:
    """The message names the node and what its name depends on."""
    found = {message for _, message in refusals(system(tmp_path, body))}
    assert any(message.endswith(what) for message in found), found


def test_argument_of_any_value_that_no_name_uses_is_accepted(tmp_path: Path) -> None:
    """It is the names that a policy has to know, not the parameters."""
    node = "node worker : tools parameters name rate : double = 1.0"
    body = "argument rate : double = 1.0 node a : worker parameters param rate = $rate"
    assert EVENTS in rights(system(tmp_path, body, node))


def test_topic_of_unknown_direction_is_refused(tmp_path: Path) -> None:
    """A parameter that is no port's may name a topic to publish, or to subscribe to."""
    node = 'node worker : tools parameters name topic : string = "x"'
    model = system(tmp_path, "topics topic /y node a : worker wirings connect topic to /y", node)
    ((code, message),) = refusals(model)
    assert code == "DRS402"
    assert "'/y' is connected to parameter 'topic' of 'a'" in message


def test_system_without_nodes_is_refused(tmp_path: Path) -> None:
    """The schema wants an enclave."""
    ((code, message),) = refusals(system(tmp_path, "topics topic /y"))
    assert code == "DRS402"
    assert "no node" in message
