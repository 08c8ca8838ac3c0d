"""Packages of nodes: which cannot be generated, and which nodes belong to them."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.generators.api.protocol import GenerateFunction, GenerationError, Owner
from tests.support.generating import output_of
from tests.support.node_targets import files_of, in_each_language, refusal


@in_each_language
def test_existing_program_needs_no_skeleton(generate: GenerateFunction) -> None:
    """A node with its own executable is rejected with a hint."""
    code, message, line = refusal(generate, 'node odometry : wheels\nexecutable "odom"')
    assert (code, line) == ("DRS402", 1)
    assert "'odom'" in message


@in_each_language
@pytest.mark.parametrize(
    ("beside", "refused"),
    [
        ("node listener : chat subscribes topic", True),
        ("node listener : other subscribes topic", False),
        ("\0 : no text", False),
        ('node listener : chat executable "there_already"', False),
    ],
)
def test_broken_node_of_the_package_is_not_dropped(
    beside: str, refused: bool, generate: GenerateFunction, tmp_path: Path
) -> None:
    """An unreadable description next to the model stops the run if it is of the same package."""
    (tmp_path / "talker.rnd").write_text("node talker : chat")
    (tmp_path / "listener.rnd").write_text(beside)
    if refused:
        with pytest.raises(GenerationError) as raised:
            output_of(generate, tmp_path / "talker.rnd")
        assert [d.code.name for d in raised.value.diagnostics] == ["DRS003"]
    else:
        files = output_of(generate, tmp_path / "talker.rnd")
        users = {Path(path).stem for path, file in files.items() if file.owner is Owner.USER}
        assert users == {"package", "talker"}
        assert not [path for path in files if "listener" in path]


@in_each_language
@pytest.mark.parametrize("name", ["use_sim_time", "start_type_description_service"])
def test_parameters_of_every_node_are_rejected(name: str, generate: GenerateFunction) -> None:
    """Declaring them again would make the node fail at the start."""
    text = f"node a : b parameters\nname {name} : bool = true"
    assert refusal(generate, text)[::2] == ("DRS402", 2)


@in_each_language
def test_qos_of_an_action_is_rejected(generate: GenerateFunction) -> None:
    """Client libraries have no single profile for the five ends of an action."""
    text = "node a : b actions\naction dock : test_msgs.Fibonacci qos reliable"
    assert refusal(generate, text)[::2] == ("DRS402", 2)


@in_each_language
def test_maintainer_must_have_an_address(generate: GenerateFunction) -> None:
    """package.xml requires an address, so the option is checked."""
    with pytest.raises(ValueError, match="'Jane' does not read 'Name <address>'"):
        files_of(generate, "node a : b", {"maintainer": "Jane"})
