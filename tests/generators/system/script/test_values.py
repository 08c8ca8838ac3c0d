"""Values of parameter files for nodes in containers are those that a process would read."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from deros.generators.system.script.standalone.containers.values import complete, values_of
from tests.metamodels.parameter_files.test_reading import FILES
from tests.support import rcl_yaml
from tests.support.ros import Peer

NODE = "/ns/a"


def of_process(peer: Peer, files: list[Path]) -> dict[str, Any] | None:
    """Return the parameters of a node that is started with these files; None if it is not."""
    import rclpy

    words = [word for file in files for word in ("--params-file", str(file))]
    namespace, _, name = NODE.rpartition("/")
    context = peer.node.context
    try:
        node = rclpy.create_node(
            name, namespace=namespace, context=context, cli_args=["--ros-args", *words]
        )
    except Exception:
        return None
    try:
        found = node._parameter_overrides.values()
        return {each.name: _as_list(each.value) for each in found}
    finally:
        node.destroy_node()


def _as_list(value: Any) -> Any:
    return value if isinstance(value, str | bool | int | float | None) else list(value)


def written(folder: Path, texts: list[str]) -> list[Path]:
    """Return files with these texts."""
    files = [folder / f"{number}.yaml" for number in range(len(texts))]
    for file, text in zip(files, texts, strict=True):
        file.write_text(text, encoding="utf-8")
    return files


@pytest.mark.ros
def test_values_are_those_of_a_process(
    ros_peer: Peer, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """For files of all shapes: which keys match, the order, types, and what is refused."""

    @settings(max_examples=120, deadline=None, suppress_health_check=list(HealthCheck))
    @given(texts=st.lists(FILES, min_size=1, max_size=3))
    @example(["/**: {ros__parameters: {x: 1}}", "/ns/a: {ros__parameters: {x: 2}}"])
    @example(["/ns/a: {ros__parameters: {x: 1}}", "/**: {ros__parameters: {x: 2}}"])
    @example(["/ns/*: {ros__parameters: {x: 1}}\nns: {a: {ros__parameters: {y: on}}}"])
    @example(["/**/a: {ros__parameters: {x: [1.5, .nan], y: ['7', off], z: [true, no]}}"])
    @example(["a: {ros__parameters: {x: 1}}\n/*/a: {ros__parameters: {q: {r: !!str 7}}}"])
    @example(["/**: {ros__parameters: {x: []}}", "/**: {ros__parameters: {x: 1}}"])
    @example(["/**: {ros__parameters: {x: 1}", "/**: {ros__parameters: {y: 1}}"])
    def compare(texts: list[str]) -> None:
        files = written(tmp_path_factory.mktemp("files"), texts)
        expected = of_process(ros_peer, files)
        try:
            found = values_of([*map(str, files)], NODE)
        except ValueError as fault:
            if "has no value" not in str(fault):
                assert expected is None, texts
                return
            # A process of rclpy has such a parameter; one of rclcpp, as in containers, ends.
            read = rcl_yaml.read(*files)
            assert read is not None
            assert None in [value for _, values in read for _, value in values]
        else:
            assert expected is not None, texts
            assert _alike(found) == _alike(expected), texts

    compare()


def _alike(values: dict[str, Any]) -> dict[str, str]:
    """Return values by their texts: nan equals nan, 1 is not 1.0."""
    return {name: repr(value) for name, value in values.items()}


def test_own_values_are_later_than_those_of_files(tmp_path: Path) -> None:
    """Whatever the keys and the order in the files are."""
    pytest.importorskip("rclpy")
    texts = ["/ns/a: {ros__parameters: {x: 1, y: 1}}", "/**: {ros__parameters: {x: 2, z: .inf}}"]
    component = {
        "name": NODE,
        "files": [*map(str, written(tmp_path, texts))],
        "parameters": {"x": 3},
    }
    assert complete(component)["parameters"] == {"x": 3, "y": 1, "z": math.inf}


def test_refused_file_is_named_with_the_words_of_ros(tmp_path: Path) -> None:
    """Without the line of C that they come from, but with that of the file."""
    pytest.importorskip("rclpy")
    good, bad = written(tmp_path, ["a: {ros__parameters: {x: 1}}\n", "a:\n  - x\n"])
    with pytest.raises(ValueError, match="line 2") as caught:
        values_of([str(good), str(bad)], NODE)
    assert str(caught.value).startswith(f"{bad}: ")
    assert "parse.c" not in str(caught.value)
    absent = tmp_path / "absent.yaml"
    with pytest.raises(ValueError, match=r"absent\.yaml: Error opening"):
        values_of([str(absent)], NODE)
