"""The textX plug-ins, in an environment with only the wheel and its requirements."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.codes import ALL_CODES
from tests.support.wheel import Environment, build_wheel

pytestmark = pytest.mark.slow

CASES = Path(__file__).resolve().parents[1] / "cases"
LANGUAGES = {"node": ".rnd", "system": ".system", "rules": ".deros"}


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Environment:
    """Create an environment with only the wheel installed."""
    directory = tmp_path_factory.mktemp("wheel")
    environment = Environment(directory / "environment")
    environment.install(build_wheel(directory))
    return environment


@pytest.fixture
def models(installed: Environment, tmp_path: Path) -> Path:
    """Create one new model of each kind, ``courier``, each in its own folder."""
    for kind in LANGUAGES:
        done = installed.run("deros", "new", kind, "courier", "-o", kind, cwd=tmp_path)
        assert done.returncode == 0, done.stderr
    return tmp_path


def test_textx_lists_languages_and_generators(installed: Environment, tmp_path: Path) -> None:
    """``textx`` lists the three languages and the five generators with their descriptions."""
    languages = installed.run("textx", "list-languages", cwd=tmp_path).stderr
    for name in ("rosnode (*.rnd)", "rossystem (*.system)", "deros (*.deros)"):
        assert name in languages
    generators = installed.run("textx", "list-generators", cwd=tmp_path).stderr
    for name in (
        "rosnode -> python",
        "rossystem -> launch",
        "rossystem -> script",
        "rossystem -> params",
        "deros -> python",
    ):
        assert name in generators


@pytest.mark.parametrize(("kind", "suffix"), LANGUAGES.items())
def test_textx_check_accepts_sound_models(
    installed: Environment, models: Path, kind: str, suffix: str
) -> None:
    """``textx check`` prints OK, after checking all imports too."""
    done = installed.run("textx", "check", f"{kind}/courier{suffix}", cwd=models)
    assert done.returncode == 0, done.stderr
    assert done.stderr.endswith(f"courier{suffix}: OK.\n")


@pytest.mark.parametrize(
    ("case", "code"),
    [
        ("DRS102_unknown_type.rnd", "DRS102"),
        ("DRS208_type_mismatch.system", "DRS208"),
        ("DRS306_incompatible_units.deros", "DRS306"),
        ("DRS003_syntax_error.rnd", "DRS003"),
        ("DRS002_not_utf8.rnd", "DRS002"),
        ("nowhere.rnd", "DRS001"),
    ],
)
def test_textx_check_runs_all_checks(
    installed: Environment, tmp_path: Path, case: str, code: str
) -> None:
    """``textx check`` has the findings of ``deros check``, and never prints a traceback."""
    done = installed.run("textx", "check", CASES / case, cwd=tmp_path)
    assert done.returncode == 1
    assert f"error[{ALL_CODES[code]}]" in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize(
    ("kind", "suffix", "target", "expected"),
    [
        ("node", ".rnd", "python", "package.xml"),
        ("system", ".system", "launch", "*.launch.py"),
        ("system", ".system", "script", "*.py"),
        ("system", ".system", "params", "*.yaml"),
        ("rules", ".deros", "python", "package.xml"),
    ],
)
def test_textx_and_deros_generate_the_same_files(
    installed: Environment, models: Path, kind: str, suffix: str, target: str, expected: str
) -> None:
    """``textx generate`` and ``deros generate`` give the same files, byte for byte."""
    trees = []
    for program in ("textx", "deros"):
        out = models / program
        command = ("generate", f"courier{suffix}", "--target", target, "-o", out)
        done = installed.run(program, *command, cwd=models / kind)
        assert done.returncode == 0, done.stderr
        trees.append({str(p.relative_to(out)): p.read_bytes() for p in out.rglob("*.*")})
    assert trees[0] == trees[1]
    assert any(Path(path).match(expected) for path in trees[0])


def test_textx_generate_accepts_generator_options(installed: Environment, models: Path) -> None:
    """Options reach the generator; unknown options are rejected."""
    command = ("generate", "courier.rnd", "--target", "python", "-o", "out")
    where = models / "node"
    done = installed.run("textx", *command, "--maintainer", "Jo <jo@example.com>", cwd=where)
    assert done.returncode == 0, done.stderr
    (package,) = (where / "out").rglob("package.xml")
    assert "jo@example.com" in package.read_text()
    assert installed.run("textx", *command, "--colour", "red", cwd=where).returncode == 1


def test_textx_generate_writes_nothing_from_a_bad_model(
    installed: Environment, tmp_path: Path
) -> None:
    """Errors are reported, and the output directory is not created."""
    bad = CASES / "DRS208_type_mismatch.system"
    done = installed.run("textx", "generate", bad, "--target", "launch", "-o", "out", cwd=tmp_path)
    assert done.returncode == 1
    assert "error[DRS208 type-mismatch]" in done.stderr
    assert not (tmp_path / "out").exists()


def test_textx_generates_a_gate_missing_from_the_system(
    installed: Environment, tmp_path: Path
) -> None:
    """The missing gate is an error for ``check`` and does not block ``generate``."""
    rules = CASES / "DRS340_gate_not_in_system.deros"
    done = installed.run("textx", "check", rules, cwd=tmp_path)
    assert (done.returncode, "error[DRS340 gate-not-in-system]" in done.stderr) == (1, True)
    for program in ("textx", "deros"):
        command = ("generate", rules, "--target", "python", "-o", program)
        done = installed.run(program, *command, cwd=tmp_path)
        assert done.returncode == 0, done.stderr
        assert "error[DRS340 gate-not-in-system]" in done.stderr
        assert list((tmp_path / program).rglob("cmd_vel_gate.rnd"))


def test_deros_commands_are_textx_commands(installed: Environment, models: Path) -> None:
    """``textx deros check`` is ``deros check``."""
    done = installed.run("textx", "deros", "check", "rules/courier.deros", cwd=models)
    assert (done.returncode, done.stdout) == (0, "3 files checked, no findings\n")
