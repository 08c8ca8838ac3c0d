"""Generators are found by entry point, and one object serves textX and deros alike."""

from __future__ import annotations

import subprocess
import sys
from importlib.metadata import Distribution
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from textx.exceptions import TextXError
from textx.registration import GeneratorDesc

from deros import codes
from deros.cli.textx_plugin import rosnode
from deros.diagnostics import report
from deros.generators.api import registry
from deros.generators.api.protocol import Context, File, Files, GenerationError, Option, Options
from deros.generators.api.registry import Generator, discover, generator
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.metamodels.node import NodeType

METAMODEL = rosnode.metamodel()
"""What textX hands to a generator beside the model: the metamodel of our language."""

NODE = "node talker : chat\npublishes\n  topic chatter : std_msgs.String\n"


@generator("rosnode", "text", (Option("to-whom", "whom it greets"),))
def greeting(model: NodeType, context: Context, options: Options) -> Files:  # noqa: ARG001
    """Greet somebody.

    Not part of the description.
    """
    return {"greeting.py": File(f"print('{model.name} greets {options.get('to-whom', 'all')}')\n")}


@pytest.fixture
def context() -> Context:
    """Give a context of its own."""
    return Context(InterfaceStore(), Repository())


@pytest.fixture
def textx_model(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """Give what textX hands to a generator, of which only the file's name counts."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "talker.rnd").write_text(NODE)
    return SimpleNamespace(_tx_filename=str(tmp_path / "talker.rnd"))


# The decorated object -----------------------------------------------------------------------------


def test_a_generator_is_a_textx_generator() -> None:
    """TextX accepts the object by its class and finds all that it lists."""
    assert isinstance(greeting, GeneratorDesc)
    assert (greeting.language, greeting.target) == ("rosnode", "text")
    assert greeting.description == "Greet somebody."
    assert [arg.name for arg in greeting.custom_args] == ["to_whom", "interfaces"]
    assert not any(arg.mandatory for arg in greeting.custom_args)


def test_a_generator_can_be_called(context: Context) -> None:
    """A call with a typed model returns files, options under their declared names."""
    model = context.repository.load_text("talker.rnd", NODE).model
    files = greeting(model, context, {"to-whom": "you"})
    assert files["greeting.py"].text == "print('talker greets you')\n"


def test_unknown_options_are_refused(context: Context) -> None:
    """A misspelt option is an error, not ignored."""
    with pytest.raises(ValueError, match="no option 'to-who'"):
        greeting(None, context, {"to-who": "you"})


# Run by textX -------------------------------------------------------------------------------------


def test_textx_runs_a_generator(textx_model: Any, tmp_path: Path) -> None:
    """The callable loads the typed model, generates, and writes to the output path."""
    greeting.generator(METAMODEL, textx_model, str(tmp_path / "out"), False, False, to_whom="you")
    assert "greets you" in (tmp_path / "out/greeting.py").read_text()


def test_textx_output_goes_beside_the_model(textx_model: Any, tmp_path: Path) -> None:
    """Without an output path the files land in the model's folder, as textX documents."""
    greeting.generator(METAMODEL, textx_model, None, False, False)
    assert (tmp_path / "greeting.py").exists()


def test_textx_keeps_hand_edited_files_unless_told(
    textx_model: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The warning goes to the terminal, ``--overwrite`` reaches the writer."""
    greeting.generator(METAMODEL, textx_model, None, False, False)
    (tmp_path / "greeting.py").write_text("mine\n")
    greeting.generator(METAMODEL, textx_model, None, False, False)
    assert "warning[DRS403 hand-edited]" in capsys.readouterr().err
    greeting.generator(METAMODEL, textx_model, None, True, False)
    assert (tmp_path / "greeting.py").read_text() != "mine\n"


def test_a_model_with_errors_is_refused(textx_model: Any, tmp_path: Path) -> None:
    """What the checks find ends the run with all of it, and nothing is written."""
    (tmp_path / "talker.rnd").write_text(NODE.replace("String", "Strong"))
    with pytest.raises(TextXError, match="Strong"):
        greeting.generator(METAMODEL, textx_model, str(tmp_path / "out"), False, False)
    assert not (tmp_path / "out").exists()


def test_a_file_with_syntax_errors_is_refused(textx_model: Any, tmp_path: Path) -> None:
    """The loader's findings end the run, with file and line."""
    (tmp_path / "talker.rnd").write_text("node talker\n")
    with pytest.raises(TextXError, match=r"^talker\.rnd:1:12: error\[DRS003 syntax-error\]"):
        greeting.generator(METAMODEL, textx_model, None, False, False)


def test_a_target_that_refuses_ends_the_run(textx_model: Any) -> None:
    """The diagnostics of a GenerationError reach the user of textX."""

    @generator("rosnode", "nothing")
    def refusing(model: NodeType, context: Context, options: Options) -> Files:  # noqa: ARG001
        raise GenerationError([report(codes.UNSUPPORTED_BY_TARGET, "cannot", model.name_span)])

    with pytest.raises(
        TextXError, match=r"talker\.rnd:1:6: error\[DRS402 unsupported-by-target\]: cannot"
    ):
        refusing.generator(METAMODEL, textx_model, None, False, False)


def test_textx_refuses_unknown_options(textx_model: Any) -> None:
    """TextX hands on what it does not know; it is refused here."""
    with pytest.raises(TextXError, match="No such option: --speed"):
        greeting.generator(METAMODEL, textx_model, None, False, False, speed="1")


def test_a_model_from_a_string_is_refused() -> None:
    """A textX model without a file cannot be loaded again, which is said."""
    with pytest.raises(TextXError, match="needs a model from a file"):
        greeting.generator(METAMODEL, SimpleNamespace(), None, False, False)


# Discovery ----------------------------------------------------------------------------------------


class FakeEntryPoint:
    """An entry point as importlib.metadata would give it."""

    def __init__(self, name: str, distribution: str, loaded: Any) -> None:
        """Hold what :meth:`load` returns, or raises."""
        self.name = name
        self.dist = SimpleNamespace(name=distribution, version="1.0")
        self.loaded = loaded

    def load(self) -> Any:
        """Return the object, or fail as a broken plug-in does."""
        if isinstance(self.loaded, Exception):
            raise self.loaded
        return self.loaded


def found_with(monkeypatch: pytest.MonkeyPatch, *points: FakeEntryPoint) -> registry.Registry:
    """Return what is discovered when these are the entry points of the environment."""
    monkeypatch.setattr(registry, "entry_points", lambda group: points)  # noqa: ARG005
    return discover.__wrapped__()


def twin() -> Generator:
    """Return one more generator of the same language and target."""
    return Generator("rosnode", "text", greeting.function, ())


def test_the_built_in_generators_are_found() -> None:
    """The installed distribution names its targets."""
    assert discover().broken == ()
    assert discover().targets("rossystem") == ("launch", "params", "script")
    assert discover().targets("rosnode") == ("cpp", "python")
    assert discover().targets("deros") == ("c", "cpp", "python")
    python = discover().find("rosnode", "python")
    assert python is not None
    assert python.project_name == "deros"
    assert discover().find("rosnode", "cobol") is None


def test_a_broken_plugin_takes_nothing_down(monkeypatch: pytest.MonkeyPatch) -> None:
    """One that fails to load is named with the reason; the others are there."""
    broken = FakeEntryPoint("bad", "bad-plugin", ImportError("no module named x"))
    found = found_with(monkeypatch, broken, FakeEntryPoint("good", "good-plugin", twin()))
    assert [g.target for g in found.generators] == ["text"]
    (bad,) = found.broken
    assert (bad.distribution, bad.reason) == ("bad-plugin", "ImportError: no module named x")


def test_our_own_target_is_not_taken_over(monkeypatch: pytest.MonkeyPatch) -> None:
    """When two claim one target, deros wins over others, and the loser is named."""
    own, other = twin(), twin()
    found = found_with(
        monkeypatch, FakeEntryPoint("a", "another", other), FakeEntryPoint("z", "deros", own)
    )
    assert found.find("rosnode", "text") is own
    assert [b.reason for b in found.broken] == ["rosnode -> text is taken by deros"]


def test_generators_of_other_languages_are_passed_over(monkeypatch: pytest.MonkeyPatch) -> None:
    """A plain textX generator in the group is none of ours, and no fault."""
    plain = GeneratorDesc("entity", "java", generator=print)
    found = found_with(monkeypatch, FakeEntryPoint("java", "entities", plain))
    assert found == registry.Registry(())


def test_listing_generators_loads_none_of_them() -> None:
    """Discovery imports neither templates nor targets, so that lists stay quick."""
    script = (
        "import sys; from deros.generators.api.registry import discover; discover();"
        "print('jinja2' in sys.modules, *{name.split('.')[2] for name in sys.modules"
        " if name.startswith('deros.generators.')} - {'api', 'builtin', 'output', 'text'})"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "False"


def test_the_entry_points_are_those_of_the_package() -> None:
    """Each entry point of the distribution names a generator of its own name."""
    points = Distribution.from_name("deros").entry_points.select(group=registry.GROUP)
    for point in points:
        loaded = point.load()
        assert point.name == f"{loaded.language}_{loaded.target}"
