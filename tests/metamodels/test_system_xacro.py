"""Parameters whose values xacro makes: what their text becomes."""

from __future__ import annotations

from pathlib import Path

from deros.metamodels.load import Repository
from deros.models.arguments import Argument
from deros.models.system import NodeInstance, ParameterSetting, System
from deros.systems.arguments.resolve import resolve

NODE = "node xacro : robots parameters name xacro : string name from : string name n : int = 1"


def _settings(folder: Path, body: str) -> tuple[ParameterSetting, ...]:
    (folder / "x.rnd").write_text(NODE)
    text = (
        f'system S imports import "x.rnd" argument sim : bool = true argument side : string {body}'
    )
    loaded = Repository().load_text(folder / "s.system", text)
    assert loaded.diagnostics == ()
    assert isinstance(loaded.model, System)
    (member,) = resolve(loaded.model, {"side": "left"}).members
    assert isinstance(member, NodeInstance)
    return member.parameters


def test_arguments_are_texts_as_xacro_reads_them(tmp_path: Path) -> None:
    """Bools in lower case; values are computed, and a path may be."""
    (found,) = _settings(
        tmp_path,
        'node a : xacro parameters param xacro from xacro "share:arm/urdf/${side}.xacro" (use_sim ='
        ' $sim, prefix = "${side}_", mass = 2.0, count = 1 + 1) when sim',
    )
    assert found.xacro is not None
    assert found.xacro.in_package == ("arm", "urdf/left.xacro")
    assert not found.xacro.is_assumed
    assert [(each.name, each.value) for each in found.xacro.arguments] == [
        ("use_sim", "true"),
        ("prefix", "left_"),
        ("mass", "2.0"),
        ("count", "2"),
    ]
    assert isinstance(found.value, str)
    assert found.value.startswith('from xacro "share:arm/urdf/${side}.xacro" (use_sim = $sim,')


def test_condition_leaves_the_value_out(tmp_path: Path) -> None:
    """As that of any other setting."""
    body = 'node a : xacro parameters param xacro from xacro "a.xacro" when not sim'
    assert _settings(tmp_path, body) == ()


def test_words_of_the_statement_may_be_names(tmp_path: Path) -> None:
    """A node type, a node and a parameter may be called ``xacro``, and a parameter ``from``."""
    first, second, third = _settings(
        tmp_path,
        'node xacro : xacro parameters param xacro = "x" param from from xacro $side param n = 2',
    )
    assert (first.name, first.value, first.xacro) == ("xacro", "x", None)
    assert second.name == "from"
    assert second.xacro is not None
    assert isinstance(second.xacro.path, str)
    assert second.computed == ()  # resolved
    assert (third.name, third.value) == ("n", 2)


def test_setting_as_written_names_what_it_is_computed_from(tmp_path: Path) -> None:
    """By this, unknown arguments are found, and variants told apart."""
    (tmp_path / "x.rnd").write_text(NODE)
    loaded = Repository().load_text(
        tmp_path / "s.system",
        'system S imports import "x.rnd" argument a : string argument b : int = 1'
        " node n : xacro parameters param xacro from xacro $a (count = $b)",
    )
    assert isinstance(loaded.model, System)
    assert loaded.model.is_computed
    (member,) = loaded.model.members
    assert isinstance(member, NodeInstance)
    (setting,) = member.parameters
    assert [each.name for each in setting.computed if isinstance(each, Argument)] == ["a", "b"]
