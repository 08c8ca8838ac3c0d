"""Parameters whose values xacro makes: what their text becomes."""

from __future__ import annotations

from pathlib import Path

from deros.metamodels.load import Repository
from deros.models.arguments import Argument, Chosen, Interpolation, Literally, Lookup
from deros.models.system import NodeInstance, ParameterSetting, Subsystem, System
from deros.systems.arguments.resolve import resolve
from deros.systems.flatten import flatten

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


def _system(folder: Path, body: str, imports: str = "") -> System:
    (folder / "x.rnd").write_text(NODE)
    text = f'system S imports import "x.rnd" {imports} argument sim : bool = true {body}'
    loaded = Repository().load_text(folder / "s.system", text)
    assert loaded.diagnostics == ()
    assert isinstance(loaded.model, System)
    return loaded.model


def test_path_of_a_made_file_is_known_in_the_whole_system(tmp_path: Path) -> None:
    """Before and behind its statement; with a condition, it is a choice."""
    system = _system(
        tmp_path,
        'process p : "p" arguments [$plain, "x${chosen}"]'
        ' subsystem inside { file plain from xacro "a.xacro" (sim = $sim) }'
        ' file chosen from xacro "b.xacro" when sim',
    )
    plain, inside = (each.text_from for each in system.processes[0].arguments)
    assert isinstance(plain, Lookup)
    assert (plain.function, plain.name, plain.key) == ("made", "plain", "made plain")
    assert isinstance(inside, Interpolation)
    _, chosen, _ = inside.pieces
    assert isinstance(chosen, Chosen)
    assert chosen.otherwise == Literally("", chosen.span)
    (group,) = (each for each in system.members if isinstance(each, Subsystem))
    assert plain.made == group.made[0].xacro


def test_resolved_system_has_the_files_that_are_there(tmp_path: Path) -> None:
    """With the values of their arguments."""
    system = _system(
        tmp_path,
        'file a from xacro "${other}.xacro" (sim = $sim) file b from xacro "b.xacro" when not sim'
        ' argument other : string = "x" process p : "p" arguments [$a, $b]',
    )
    (made,) = flatten(system).made
    given = [(each.name, each.value) for each in made.xacro.arguments]
    assert (made.name, made.xacro.path, given) == ("a", "x.xacro", [("sim", "true")])
    both = flatten(resolve(system, {"sim": False})).made
    assert [each.name for each in both] == ["a", "b"]


def test_file_may_be_a_name(tmp_path: Path) -> None:
    """Of nodes, topics, parameters and arguments, and that of a made file may be a keyword."""
    system = _system(
        tmp_path,
        "argument file : int = 1 topics topic file node file : xacro parameters param n = $file"
        " param name = $from wirings connect file to file"
        ' file from from xacro "a.xacro" file xacro from xacro "a.xacro"'
        ' process q : "q" arguments [$xacro]',
    )
    assert [each.name for each in system.made] == ["from", "xacro"]


def test_file_whose_path_is_passed_on_is_not_looked_for(tmp_path: Path) -> None:
    """A used system may read it as a parameter file: what it says is known at the start."""
    (tmp_path / "inner.system").write_text(
        'system Inner imports import "x.rnd" argument path : string node a : xacro'
        " parameters from $path"
    )
    system = _system(
        tmp_path,
        'file f from xacro "a.xacro" subsystem i : Inner(path = $f)',
        'import "inner.system"',
    )
    (node,) = flatten(system).nodes
    assert node.files[0].is_assumed
    assert node.files[0].load() is None
