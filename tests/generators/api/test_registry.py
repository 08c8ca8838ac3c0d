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
from deros.models.node import NodeType

METAMODEL = rosnode.metamodel()
"""The metamodel of our language, which textX passes to a generator along with the model."""

NODE = "node talker : chat\npublishes\n  topic chatter : std_msgs.String\n"


@generator("rosnode", "text", (Option("to-whom", "whom it greets"),))
def greeting(model: NodeType, context: Context, options: Options) -> Files:  # noqa: ARG001
    """Greet somebody.

    Not part of the description.
    """
    return {"greeting.py": File(f"print('{model.name} greets {options.get('to-whom', 'all')}')\n")}


@pytest.fixture
def context() -> Context:
    """Return a context with its own interfaces and repository."""
    return Context(InterfaceStore(), Repository())


@pytest.fixture
def textx_model(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return the model that textX passes to a generator; only its file name matters."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "talker.rnd").write_text(NODE)
    return SimpleNamespace(_tx_filename=str(tmp_path / "talker.rnd"))


# The decorated object -----------------------------------------------------------------------------


def test_generator_is_a_textx_generator() -> None:
    """The class of the object is the one of textX, and has all attributes that it lists."""
    assert isinstance(greeting, GeneratorDesc)
    assert (greeting.language, greeting.target) == ("rosnode", "text")
    assert greeting.description == "Greet somebody."
    assert [arg.name for arg in greeting.custom_args] == ["to_whom", "interfaces"]
    assert not any(arg.mandatory for arg in greeting.custom_args)


def test_generator_is_callable(context: Context) -> None:
    """A call with a typed model returns files; options have their declared names."""
    model = context.repository.load_text("talker.rnd", NODE).model
    files = greeting(model, context, {"to-whom": "you"})
    assert files["greeting.py"].text == "print('talker greets you')\n"


def test_unknown_options_are_rejected(context: Context) -> None:
    """A misspelt option is an error, and is not ignored."""
    with pytest.raises(ValueError, match="no option 'to-who'"):
        greeting(None, context, {"to-who": "you"})


# Called by textX ----------------------------------------------------------------------------------


def test_textx_runs_a_generator(textx_model: Any, tmp_path: Path) -> None:
    """The callable loads the typed model, generates, and writes to the output path."""
    greeting.generator(METAMODEL, textx_model, str(tmp_path / "out"), False, False, to_whom="you")
    assert "greets you" in (tmp_path / "out/greeting.py").read_text()


def test_textx_output_defaults_to_the_model_folder(textx_model: Any, tmp_path: Path) -> None:
    """Without an output path the files are written as textX documents."""
    greeting.generator(METAMODEL, textx_model, None, False, False)
    assert (tmp_path / "greeting.py").exists()


def test_textx_keeps_edited_files_without_overwrite(
    textx_model: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The warning goes to the terminal, and ``--overwrite`` reaches the writer."""
    greeting.generator(METAMODEL, textx_model, None, False, False)
    (tmp_path / "greeting.py").write_text("mine\n")
    greeting.generator(METAMODEL, textx_model, None, False, False)
    assert "warning[DRS403 hand-edited]" in capsys.readouterr().err
    greeting.generator(METAMODEL, textx_model, None, True, False)
    assert (tmp_path / "greeting.py").read_text() != "mine\n"


def test_model_with_errors_is_rejected(textx_model: Any, tmp_path: Path) -> None:
    """All findings of the checks are reported, and nothing is written."""
    (tmp_path / "talker.rnd").write_text(NODE.replace("String", "Strong"))
    with pytest.raises(TextXError, match="Strong"):
        greeting.generator(METAMODEL, textx_model, str(tmp_path / "out"), False, False)
    assert not (tmp_path / "out").exists()


def test_file_with_syntax_errors_is_rejected(textx_model: Any, tmp_path: Path) -> None:
    """The findings of the loader end the run, with file and line."""
    (tmp_path / "talker.rnd").write_text("node talker\n")
    with pytest.raises(TextXError, match=r"^talker\.rnd:1:12: error\[DRS003 syntax-error\]"):
        greeting.generator(METAMODEL, textx_model, None, False, False)


def test_generation_error_reaches_textx(textx_model: Any) -> None:
    """The user of textX gets the diagnostics of a GenerationError."""

    @generator("rosnode", "nothing")
    def refusing(model: NodeType, context: Context, options: Options) -> Files:  # noqa: ARG001
        raise GenerationError([report(codes.UNSUPPORTED_BY_TARGET, "cannot", model.name_span)])

    with pytest.raises(
        TextXError, match=r"talker\.rnd:1:6: error\[DRS402 unsupported-by-target\]: cannot"
    ):
        refusing.generator(METAMODEL, textx_model, None, False, False)


def test_textx_rejects_unknown_options(textx_model: Any) -> None:
    """Unknown options are passed on by textX, and the generator rejects them."""
    with pytest.raises(TextXError, match="No such option: --speed"):
        greeting.generator(METAMODEL, textx_model, None, False, False, speed="1")


def test_model_from_a_string_is_rejected() -> None:
    """A textX model without a file cannot be loaded again, and the message says so."""
    with pytest.raises(TextXError, match="needs a model from a file"):
        greeting.generator(METAMODEL, SimpleNamespace(), None, False, False)


# Discovery ----------------------------------------------------------------------------------------


class FakeEntryPoint:
    """An entry point as importlib.metadata would return it."""

    def __init__(self, name: str, distribution: str, loaded: Any) -> None:
        """Store the object that :meth:`load` returns, or raises."""
        self.name = name
        self.dist = SimpleNamespace(name=distribution, version="1.0")
        self.loaded = loaded

    def load(self) -> Any:
        """Return the object, or fail as a broken plug-in does."""
        if isinstance(self.loaded, Exception):
            raise self.loaded
        return self.loaded


def found_with(monkeypatch: pytest.MonkeyPatch, *points: FakeEntryPoint) -> registry.Registry:
    """Return the registry for these entry points."""
    monkeypatch.setattr(registry, "entry_points", lambda group: points)  # noqa: ARG005
    return discover.__wrapped__()


def twin() -> Generator:
    """Return another generator for the same language and target."""
    return Generator("rosnode", "text", greeting.function, ())


def test_built_in_generators_are_found() -> None:
    """The installed distribution registers its targets."""
    assert discover().broken == ()
    of_systems = (
        "compose",
        "launch",
        "launch-xml",
        "launch-yaml",
        "params",
        "script",
        "sros2",
        "systemd",
    )
    assert discover().targets("rossystem") == of_systems
    assert discover().targets("rosnode") == ("cpp", "python")
    assert discover().targets("deros") == ("c", "cpp", "python")
    python = discover().find("rosnode", "python")
    assert python is not None
    assert python.project_name == "deros"
    assert discover().find("rosnode", "cobol") is None


def test_broken_plugin_does_not_affect_others(monkeypatch: pytest.MonkeyPatch) -> None:
    """A plug-in that fails to load is listed with the reason; the others are available."""
    broken = FakeEntryPoint("bad", "bad-plugin", ImportError("no module named x"))
    discovered = found_with(monkeypatch, broken, FakeEntryPoint("good", "good-plugin", twin()))
    assert [g.target for g in discovered.generators] == ["text"]
    (bad,) = discovered.broken
    assert (bad.distribution, bad.reason) == ("bad-plugin", "ImportError: no module named x")


def test_plugin_cannot_replace_a_deros_target(monkeypatch: pytest.MonkeyPatch) -> None:
    """If two generators claim one target, deros has priority, and the other is listed."""
    own, other = twin(), twin()
    discovered = found_with(
        monkeypatch, FakeEntryPoint("a", "another", other), FakeEntryPoint("z", "deros", own)
    )
    assert discovered.find("rosnode", "text") is own
    assert [b.reason for b in discovered.broken] == ["rosnode -> text is taken by deros"]


def test_generators_of_other_languages_are_skipped(monkeypatch: pytest.MonkeyPatch) -> None:
    """A plain textX generator in the group is neither a deros generator nor an error."""
    plain = GeneratorDesc("entity", "java", generator=print)
    discovered = found_with(monkeypatch, FakeEntryPoint("java", "entities", plain))
    assert discovered == registry.Registry(())


def test_listing_generators_does_not_load_them() -> None:
    """Discovery imports neither templates nor targets, so that lists are fast."""
    script = (
        "import sys; from deros.generators.api.registry import discover; discover();"
        "print('jinja2' in sys.modules, *{name.split('.')[2] for name in sys.modules"
        " if name.startswith('deros.generators.')} - {'api', 'builtin', 'output', 'text'})"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "False"


def test_entry_points_match_their_generators() -> None:
    """Each entry point of the distribution has the name of its generator."""
    points = Distribution.from_name("deros").entry_points.select(group=registry.GROUP)
    for point in points:
        loaded = point.load()
        assert point.name == f"{loaded.language}_{loaded.target}"
