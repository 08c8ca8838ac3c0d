"""Whatever is in a launch file, its import ends in models, in a list, or in a refusal."""

from __future__ import annotations

import contextlib
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from deros.importers.kinds import KINDS
from deros.importers.readers import UnreadableError
from tests.support.imported_launch import model_of
from tests.support.systems import MODELS

GOLDEN = MODELS.parents[2] / "golden" / "rossystem_frontends_constructs"
TEXTS = {
    language: (GOLDEN / f"constructs.launch.{language}").read_text(encoding="utf-8")
    for language in ("xml", "yaml")
}
PIECES = st.sampled_from(
    [
        *(
            "$(",
            ")",
            "'",
            '"',
            "\\",
            "<",
            ">",
            "{",
            "}",
            "[",
            "]",
            ":",
            "\n",
            "- ",
            "&a ",
            "*a",
            "\x00",
        ),
        *("$(var x)", "$(var)", "$(eval 1/0)", "$(eval [].x)", "$(eval ')", "$(find-pkg-share)"),
        *(
            "$(if a b c)",
            "$(not)",
            "$(and)",
            "$(equals 1)",
            "$(env)",
            "$(command 'xacro')",
            "/",
            "~",
        ),
        *("true", "-1", "1e999", "99999999999999999999", "None", "\u2603", "node", "group", "if"),
    ]
)


@st.composite
def mutated(draw: st.DrawFn) -> tuple[str, str]:
    """Return a language, and a launch file in it some places of which have something else."""
    language = draw(st.sampled_from(list(TEXTS)))
    text = TEXTS[language]
    for _ in range(draw(st.integers(1, 6))):
        start = draw(st.integers(0, len(text) - 1))
        end = start + draw(st.integers(0, 12))
        text = text[:start] + draw(PIECES) + text[end:]
    return language, text


@settings(
    max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(found=mutated())
def test_mutated_files_become_models_or_are_refused(
    tmp_path_factory: pytest.TempPathFactory, found: tuple[str, str]
) -> None:
    """A model that is written loads without a fault of syntax or reference."""
    language, text = found
    file = tmp_path_factory.mktemp("mutated") / f"robot.launch.{language}"
    file.write_text(text, encoding="utf-8")
    with contextlib.suppress(UnreadableError):
        model_of(file)


@pytest.mark.parametrize(
    ("name", "text", "kind"),
    [
        ("a.launch.xml", "", "launch-xml"),
        ("a.launch", "", "launch-xml"),
        ("bringup.xml", "<launch></launch>", "launch-xml"),
        ("package.xml", "<package/>", None),
        ("a_launch.yml", "", "launch-yaml"),
        ("bringup.yaml", "# x\nlaunch:\n- node: {}\n", "launch-yaml"),
        ("params.yaml", "/**:\n  ros__parameters: {}\n", "parameters"),
        ("a.launch.py", "", "launch-python"),
        ("start.py", "def generate_launch_description():\n", "launch-python"),
        ("setup.py", "from setuptools import setup\n", None),
    ],
)
def test_kind_is_known_by_name_or_text(
    name: str, text: str, kind: str | None, tmp_path: Path
) -> None:
    """The text is looked at where the name says too little."""
    (tmp_path / name).write_text(text)
    found = [each.word for each in KINDS if each.is_one(tmp_path / name)]
    assert found == ([] if kind is None else [kind])


def test_file_that_is_not_there_has_the_kind_of_its_name(tmp_path: Path) -> None:
    """And is refused when it is read."""
    assert not any(each.is_one(tmp_path / "a.xml") for each in KINDS)
    with pytest.raises(UnreadableError, match="cannot read"):
        model_of(tmp_path / "a.launch.xml")
