"""What deros writes as a launch file in XML or YAML comes back as the system that it was."""

from __future__ import annotations

import itertools
import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from deros.generators.api.protocol import GenerationError
from deros.generators.builtin import rossystem_launch_xml, rossystem_launch_yaml
from deros.models.common import Scalar
from deros.models.system import System
from tests.generators.system.test_arguments import CHOICES, EYE, WHOLE
from tests.support import argument_systems
from tests.support.arguments import text_of
from tests.support.checks import checked
from tests.support.imported_launch import imported, rows, typed
from tests.support.systems import CONTEXT, MODELS, load, load_text

TARGETS = {"xml": rossystem_launch_xml, "yaml": rossystem_launch_yaml}
EXAMPLES = Path(__file__).resolve().parents[3] / "examples"


def returned(system: System, nodes: Path, language: str, folder: Path) -> System:
    """Return what the launch file of a system becomes beside the descriptions of its nodes."""
    (folder / "nodes").mkdir(parents=True)
    for path in nodes.glob("*.rnd"):
        shutil.copy(path, folder / "nodes")
    launch = None
    for name, file in TARGETS[language](system, CONTEXT).items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(file.text, encoding="utf-8")
        if name.endswith(f".launch.{language}") and "/" not in name:
            launch = folder / name
    assert launch is not None
    found = imported(launch)
    unsaid = [
        each for each in found.missing if ".checked' is left out, and nothing uses" not in each
    ]
    assert [each for each in unsaid if "'respawn' of" not in each] == []
    return load(folder / next(iter(found.files)))


def assert_same(system: System, back: System, values: Mapping[str, Scalar]) -> None:
    """Compare what two systems start."""
    words = {name: text_of(value) for name, value in values.items()}
    assert rows(back, typed(back, words)) == rows(system, values)


@pytest.mark.parametrize("language", TARGETS)
def test_every_construct_comes_back(language: str, tmp_path: Path) -> None:
    """For all combinations of some values of its arguments."""
    shutil.copytree(MODELS, tmp_path / "original")
    shutil.copytree(MODELS / "files", tmp_path / "back" / "files")
    system = load(tmp_path / "original" / "constructs.system")
    back = returned(system, tmp_path / "original", language, tmp_path / "back")
    choices: Mapping[str, Sequence[Scalar]] = {
        "robot": ("r1", "a/b"),
        "speed": (0.5, 1.5),
        "count": (1, 2, 3),
        "slam": (True, False),
        "mode": ("auto", "by hand", "1"),
    }
    for chosen in itertools.product(*choices.values()):
        assert_same(system, back, dict(zip(choices, chosen, strict=True)))


@pytest.mark.parametrize("language", TARGETS)
def test_all_uses_of_arguments_come_back(language: str, tmp_path: Path) -> None:
    """In names, values, conditions and calculations."""
    (tmp_path / "original").mkdir()
    system = load_text(tmp_path / "original", WHOLE, eye=EYE)
    back = returned(system, tmp_path / "original", language, tmp_path / "back")
    names = [name for name in CHOICES if name != "free"]
    for chosen in itertools.product(*(CHOICES[name][:2] for name in names)):
        assert_same(system, back, dict(zip(names, chosen, strict=True)))


@settings(
    max_examples=20, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(text=argument_systems.systems(), data=st.data())
@pytest.mark.essential
def test_random_systems_come_back(
    tmp_path_factory: pytest.TempPathFactory, text: str, data: st.DataObject
) -> None:
    """With conditions on nodes, settings, connections and words."""
    folder = tmp_path_factory.mktemp("random")
    system = argument_systems.load(folder, text)
    values = {
        name: data.draw(st.sampled_from(found)) for name, found in argument_systems.VALUES.items()
    }
    language = data.draw(st.sampled_from(list(TARGETS)))
    try:
        back = returned(system, folder, language, folder / "back")
        expected = rows(system, values)
    except GenerationError:  # two nodes of one name, or one that is activated
        assume(False)
    words = {name: text_of(value) for name, value in values.items()}
    assert rows(back, typed(back, words)) == expected, text


@pytest.mark.parametrize(
    "example",
    ["feeding_robot/feeding_robot.system", "intelligent_one/intelligent_one.system"],
)
def test_examples_come_back_and_check_clean(example: str, tmp_path: Path) -> None:
    """Their connections are those of the original, with no finding that that has not."""
    path = EXAMPLES / example
    shutil.copytree(path.parent, tmp_path / "original")
    path = tmp_path / "original" / path.name
    system = load(path)
    nodes = path.parent / "nodes" if (path.parent / "nodes").is_dir() else path.parent
    back = returned(system, nodes, "xml", tmp_path / "back")
    assert_same(system, back, {})
    errors = [e for e in checked(back.source.path) if e.severity.value == "error"]
    assert errors == []
