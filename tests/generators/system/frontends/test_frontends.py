"""Launch files in XML and YAML start what the model says, as the one in Python does."""

from __future__ import annotations

import random
from collections.abc import Mapping
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from deros import codes
from deros.generators.api.protocol import GenerationError
from deros.generators.builtin import rossystem_launch
from deros.models.system import System
from tests.generators.system import test_containers, test_lookups, test_programs
from tests.generators.system.test_arguments import (
    CHOICES,
    EYE,
    WHOLE,
    as_modelled,
    plain,
    targets,
)
from tests.support import argument_systems
from tests.support.arguments import text_of
from tests.support.frontend_files import TARGETS, Started, both, started, tree
from tests.support.golden import Golden
from tests.support.systems import CONTEXT, EVERYTHING, load, load_text

CONSTRUCTS = EVERYTHING.parent / "constructs.system"
"""A system that uses all that these formats can say."""


def texts(system: System) -> dict[str, str]:
    """Return the texts of both launch files."""
    files = both(system)
    return {
        language: next(f.text for path, f in files.items() if path.endswith(f"launch.{language}"))
        for language in TARGETS
    }


def test_launch_files_match_golden(golden: Golden) -> None:
    """The texts for a system without arguments match the reviewed ones."""
    golden.check("rossystem_frontends", both(load(EVERYTHING)))


def test_launch_files_with_every_construct_match_golden(golden: Golden) -> None:
    """The texts for a system with every construct match the reviewed ones."""
    golden.check("rossystem_frontends_constructs", both(load(CONSTRUCTS)))


@pytest.mark.parametrize("system", [EVERYTHING, CONSTRUCTS], ids=lambda path: path.stem)
def test_both_languages_have_one_tree(system: Path) -> None:
    """Readers of XML and of YAML find the same actions with the same values."""
    found = texts(load(system))
    assert repr(tree(found["xml"], "xml")) == repr(tree(found["yaml"], "yaml"))


def as_started(found: Started) -> tuple[Any, ...]:
    """Return a node as the model has it."""
    node = SimpleNamespace(
        namespace=found.attributes["namespace"],
        name=found.attributes["name"],
        remappings=found.remappings,
    )
    return (found.full_name, found.attributes["exec"], plain(found.parameters), targets(node))


def test_nodes_are_those_of_the_model(tmp_path: Path) -> None:
    """Values, types and names are, for any values of the arguments and below any namespace."""
    system = load_text(tmp_path, WHOLE, eye=EYE)
    trees = [tree(text, language) for language, text in texts(system).items()]
    chosen = random.Random(7)
    for _ in range(100):
        values = {name: chosen.choice(found) for name, found in CHOICES.items()}
        words = {name: text_of(value) for name, value in values.items()}
        for found in trees:
            for root in ("/", "/fleet"):
                nodes = [as_started(each) for each in started(found, words, root=root)]
                assert nodes == as_modelled(system, values, root), values


@settings(
    max_examples=30, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(text=argument_systems.systems(), data=st.data())
@pytest.mark.essential
def test_nodes_of_random_systems_are_those_of_the_model(
    tmp_path_factory: pytest.TempPathFactory, text: str, data: st.DataObject
) -> None:
    """Conditions on nodes, settings and connections are those of the model."""
    system = argument_systems.load(tmp_path_factory.mktemp("started"), text)
    values = {
        name: data.draw(st.sampled_from(found)) for name, found in argument_systems.VALUES.items()
    }
    try:
        found = texts(system)
        expected = as_modelled(system, values)
    except GenerationError:  # two nodes of one name, or one that is activated
        assume(False)
    words = {name: text_of(value) for name, value in values.items()}
    for language, each in found.items():
        programs = started(tree(each, language), words)
        assert [as_started(one) for one in programs if one.tag == "node"] == expected, text


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        ({"speed": "2"}, r"argument speed is '2': it has to be a number in \[0\.0, 2\.0\)"),
        ({"speed": "5'"}, 'argument speed is "5\'": it has to be a number'),
        ({"speed": "' + '1"}, "argument speed is .*it has to be a number"),
        ({"count": "1.0"}, "argument count is '1.0': it has to be an integer in"),
        ({"robot": "a'b\"\\"}, "argument robot is .*it has to be a relative namespace"),
        ({"topic": "a//b"}, "argument topic is 'a//b': it has to be a name"),
        ({"mode": "other"}, "'mode' provided value 'other' is not valid"),
        ({"slam": "True"}, "'slam' provided value 'True' is not valid"),
    ],
)
def test_wrong_values_are_refused_before_anything_starts(
    tmp_path: Path, words: Mapping[str, str], reason: str
) -> None:
    """The file, or launch, says of which argument, and what is meant."""
    system = load_text(tmp_path, WHOLE, eye=EYE)
    for language, text in texts(system).items():
        with pytest.raises(ValueError, match=reason):
            next(started(tree(text, language), words))


def test_missing_files_are_refused_before_anything_starts(tmp_path: Path) -> None:
    """A node is not started without its parameter file, which launch itself would pass over."""
    for name in ("a.yaml", "b.yaml"):
        (tmp_path / name).write_text("/**: {ros__parameters: {n: 1}}\n")
    system = load_text(
        tmp_path,
        'system S argument more : bool = false imports import "eye.rnd"'
        ' node one : eye parameters from "a.yaml" node two : eye when more'
        ' parameters from "b.yaml"',
        eye=EYE,
    )
    generated = texts(system)
    (tmp_path / "b.yaml").unlink()
    for language, text in generated.items():
        found = tree(text, language)
        folder = str(tmp_path)
        assert [each.full_name for each in started(found, {}, folder)] == ["/one"]
        with pytest.raises(FileNotFoundError, match=r"b\.yaml"):
            next(started(found, {"more": "true"}, folder))


REFUSED = {
    "activated": ("node a : managed autostart", "do not bring 'a' to active"),
    "after another": ("node a : p node b : p after exit of a", "cannot start 'b' after the"),
    "later": ("node a : p delay 2 sec", "cannot start 'a' after a delay"),
    "a container": ("container a delay 2 sec { }", "cannot start 'a' after a delay"),
    "ready": ("node a : p node b : p after node a", "cannot start 'b' when something is in the"),
    "a process": ('process a : "a" delay 2 sec', "cannot start 'a' after a delay"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_they_cannot_say_is_refused_by_name(tmp_path: Path, case: str) -> None:
    """The finding has a position and names the targets that can."""
    body, message = REFUSED[case]
    system = load_text(
        tmp_path,
        f'system S imports import "*.rnd" {body}',
        p="node p : pkg",
        managed="node managed : pkg lifecycle",
    )
    for target in TARGETS.values():
        with pytest.raises(GenerationError) as fault:
            target(system, CONTEXT)
        (finding,) = fault.value.diagnostics
        assert finding.code is codes.UNSUPPORTED_BY_TARGET
        assert message in finding.message
        assert "'--target launch'" in (finding.hint or "")
        assert finding.span.text in ("a", "b")


def test_containers_that_are_started_again_are_refused(tmp_path: Path) -> None:
    """Launch would start them without their nodes."""
    system = test_containers.load(tmp_path, "container main respawn { node a : part }")
    for target in TARGETS.values():
        with pytest.raises(GenerationError, match="container 'main' again without its nodes"):
            target(system, CONTEXT)


def test_environment_and_words_are_those_of_the_system(tmp_path: Path) -> None:
    """A shell that takes the command line apart finds the words."""
    (tmp_path / "arm.system").write_text(test_programs.ARM)
    system = load_text(tmp_path, test_programs.WHOLE, eye=test_programs.EYE)
    for language, text in texts(system).items():
        found = {
            each.attributes["name"]: each
            for each in started(tree(text, language), {"robot": "r3", "level": "9"})
        }
        recorder = found["recorder"]
        assert recorder.attributes["cmd"] == (
            "record all -o /tmp/r3' ${x}' 9 '' 'it'\"'\"'s \"so\"'"
        )
        assert recorder.attributes["cwd"] == "/tmp/r3"
        assert repr(recorder.attributes["respawn_delay"]) == "2.0"
        assert recorder.attributes["launch-prefix"] == "nice"
        assert recorder.variables == {"ROS_DOMAIN_ID": "9", "KIND": "r3"}
        assert found["hand"].variables["NAME"] == "r3_arm_10"


def test_paths_start_where_the_file_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What is looked up is looked up at the start."""
    (tmp_path / "arm").mkdir()
    (tmp_path / "arm" / "arm.system").write_text(test_lookups.ARM)
    monkeypatch.setenv("ROBOT", "r7")
    monkeypatch.setenv("AMENT_PREFIX_PATH", "")
    system = load_text(tmp_path, test_lookups.LOOKS, eye=EYE)
    for language, text in texts(system).items():
        given = {"count": "3", "charted": "false", "sunk": "false"}
        eye, hand = started(tree(text, language), given, "/here")
        assert eye.full_name == "/r7/eye"
        assert eye.parameters["frame"] == '/here/it\'s a "frame".urdf'
        assert eye.parameters["names"] == ["/share/robot_maps/r7.yaml", "/share/robot_maps/b", "r7"]
        assert eye.parameters["n"] == 6
        assert hand.parameters["frame"] == "/here/arm"


def test_included_launch_files_see_no_argument_of_the_system() -> None:
    """Where arguments have other names, nothing reads the old ones, and none of these is kept."""
    names = ("robot", "speed", "count", "slam", "mode", "tuning")
    groups = [
        each
        for each in tree(texts(load(CONSTRUCTS))["xml"], "xml").children
        if each.tag == "group" and any(inner.tag == "include" for inner in each.children)
    ]
    assert len(groups) == 2
    for group in groups:
        reset, *inside = group.children
        assert reset.tag == "reset"
        kept = {each.attributes["name"] for each in reset.children}
        assert kept.isdisjoint(names)
        written = repr(inside)
        assert not any(f"$(var {name})" in written for name in names)
        assert all(f"$(var {name})" in written for name in kept - {"ros_namespace"})


def test_system_that_passes_all_arguments_on_hides_nothing(tmp_path: Path) -> None:
    """Its file can be included below settings of a group."""
    (tmp_path / "a.launch.xml").write_text('<launch><arg name="n"/></launch>')
    system = load_text(tmp_path, 'system S argument n : int = 1 launch "a.launch.xml" (n = $n)')
    for text in texts(system).values():
        assert "reset" not in text
        assert "ros_remaps" not in text


def test_level_of_a_logger_follows_a_namespace_that_is_computed(tmp_path: Path) -> None:
    """The logger of a node has dots where its full name has slashes."""
    system = load_text(
        tmp_path,
        'system S argument robot : string = "r1" imports import "eye.rnd"'
        ' subsystem a namespace "/${robot}/arm" { node eye : eye log_level debug }',
        eye=EYE,
    )
    for language, text in texts(system).items():
        (node,) = started(tree(text, language), {"robot": "a/b"})
        assert node.attributes["ros_args"] == "--log-level a.b.arm.eye:=debug"
    (file,) = rossystem_launch(system, CONTEXT).values()
    assert "'--log-level'" in file.text
    assert "'.arm.eye:=debug'" in file.text
