"""Claims of the README and the documentation about the command line, run and compared."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from deros.cli.main import COMMANDS
from deros.metamodels.load import LoadedFile, Repository
from deros.models.rules import Rules
from deros.models.system import System
from deros.systems.flatten import flatten
from tests.support.cli import deros

ROOT = Path(__file__).resolve().parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")


def _console(text: str) -> list[tuple[str, str]]:
    """Return the commands of all ``console`` blocks, each with its shown output."""
    runs: list[tuple[str, str]] = []
    for block in re.findall(r"```console\n(.*?)```", text, re.DOTALL):
        for part in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
            command, _, output = part.partition("\n")
            runs.append((command, output))
    return runs


def test_readme_shows_a_finding_as_printed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A typo in a field of the smallest example gives exactly that text."""
    ((command, shown),) = _console(README)
    example = tmp_path / "example"
    shutil.copytree(ROOT / "examples" / "intelligent_one", example)
    rules = example / "intelligent_one.deros"
    rules.write_text(rules.read_text().replace("linear.x", "lineer.x", 1))
    monkeypatch.chdir(example)
    outcome = deros(*command.split()[1:])
    assert (outcome.code, outcome.out) == (1, shown)


def test_readme_commands_can_be_pasted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The files that its shell lines name exist, or the line before creates them."""
    for name in ("examples/intelligent_one",):
        shutil.copytree(ROOT / name, tmp_path / name)
    monkeypatch.chdir(tmp_path)
    lines = [
        line
        for block in re.findall(r"```sh\n(.*?)```", README, re.DOTALL)
        for line in block.splitlines()
    ]
    values = {"$here": "examples/intelligent_one", "$build": ".demo/intelligent_one"}
    Path(".demo").mkdir()
    ran = []
    for line in lines:
        for name, value in values.items():
            line = line.replace(name, value)
        if found := re.fullmatch(r"echo '(.*)' > (\S+)", line):
            Path(found[2]).write_text(found[1] + "\n")
        if line.startswith("deros "):
            arguments = line.split("#")[0].split()[1:]
            ran.append(arguments[0])
            outcome = deros(*arguments, *(["--dry-run"] if arguments[0] == "up" else []))
            assert outcome.code == 0, (line, outcome)
            if arguments[0] == "simulate":
                assert '"action": "stop"' in outcome.out
    assert {"generate", "up", "simulate", "new", "check"} <= {*ran}


@pytest.mark.parametrize("page", ["README.md", "docs/command-line.md"])
def test_documented_commands_exist(page: str) -> None:
    """No table names an unknown command, and the documentation names all of them."""
    text = (ROOT / page).read_text(encoding="utf-8")
    named = set(re.findall(r"^\| `deros ([a-z-]+)", text, re.MULTILINE))
    assert named <= {*COMMANDS}
    if page.startswith("docs"):
        assert named == {*COMMANDS}


# Claims about the languages --------------------------------------------------------------------

STATEMENTS = {
    "n.rnd": """node n : pkg "text";
lifecycle;
parameters
  name a : double = 1.0 [m] in [0.0, 2.0] "text";
publishes
  topic out : std_msgs.Bool qos reliable depth 5;
services
  service s : std_srvs.Trigger;
clients
  client c : std_srvs.Trigger;
timers
  timer t every 20 ms "text";
""",
    "s.system": """system S "text";
imports
  import "n.rnd";
topics
  topic /x : std_msgs.Bool qos reliable;
  external topic /y;
subsystem A namespace /a "text" {
  node n : n respawn;
    parameters
      param a = 1.5;
    wirings
      connect out to /x;
};
""",
    "r.deros": """use "s.system" import S;
unit foot = 0.3048 m;
const limit = 1 m;
action stop publishes true on /stop : std_msgs.Bool latched;
action horn;
input x = topic /x.data timeout 1 sec;
entity e { r: x = true; gone: x.missing(); };
if e.r or e.gone then { stop; horn; if e.gone then { log_state("gone"); }; };
""",
}


@pytest.mark.parametrize("name", STATEMENTS)
def test_semicolons_are_optional(tmp_path: Path, name: str) -> None:
    """A ``;`` may end any statement, and is never required."""

    def load(texts: dict[str, str]) -> LoadedFile:
        for file, text in texts.items():
            (tmp_path / file).write_text(text)
        return Repository().load(tmp_path / name)

    with_them = load(STATEMENTS)
    without = load({n: text.replace(";", "") for n, text in STATEMENTS.items()})
    assert with_them.diagnostics == ()
    assert without.diagnostics == ()
    if isinstance(with_them.model, Rules):
        assert isinstance(without.model, Rules)
        assert len(with_them.model.actions) == len(without.model.actions) == 2
        assert len(with_them.model.inputs) == len(without.model.inputs) == 1
    else:
        assert with_them.model == without.model


@pytest.mark.parametrize(
    ("written", "meant"),
    [("/x", "/x"), ("x", "/robot/front/x"), ("deep/x", "/robot/front/deep/x")],
)
def test_relative_topic_is_resolved_in_its_namespace(
    tmp_path: Path, written: str, meant: str
) -> None:
    """As in ROS 2; ``~/x`` is under the name of the node."""
    (tmp_path / "n.rnd").write_text("node n : pkg\npublishes\n  topic out : std_msgs.Bool\n")
    (tmp_path / "s.system").write_text(
        'system S\nimports import "n.rnd"\nsubsystem A namespace /robot {\n'
        f"  topics topic front/x topic front/deep/x topic /x\n"
        f"  node n : n namespace front wirings connect out to {written}\n}}\n"
    )
    loaded = Repository().load(tmp_path / "s.system")
    assert isinstance(loaded.model, System), loaded.diagnostics
    outcome = deros("graph", tmp_path / "s.system")
    assert f"{meant} " in outcome.out or f"{meant}\n" in outcome.out, outcome.out
    assert meant in {topic.name for topic in flatten(loaded.model).topics}
