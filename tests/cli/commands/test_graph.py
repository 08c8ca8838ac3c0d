"""``deros graph``: the wiring as text, for Mermaid and for Graphviz."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from deros.cli.commands.graph import graph

TALKER = """
    node talker : chat
    parameters name legacy : string = "old"
    publishes topic words : std_msgs.String topic /log : std_msgs.String
"""
LISTENER = """
    node listener : chat
    subscribes topic words : std_msgs.String
    services service reset : std_srvs.Trigger
"""
SYSTEM = """
    system Chat
    imports import "*.rnd"
    topics
      topic /room
      external topic /old : std_msgs.Bool
    subsystem hall {
      node ann : talker wirings connect words to /room connect legacy to /old
      subsystem corner {
        node bob : listener wirings connect words to /room connect reset to /again
      }
    }
    node mute : silent
"""


@pytest.fixture
def models(tmp_path: Path) -> Path:
    """Create a folder with a system and its node descriptions."""
    (tmp_path / "talker.rnd").write_text(TALKER)
    (tmp_path / "listener.rnd").write_text(LISTENER)
    (tmp_path / "silent.rnd").write_text("node silent : chat")
    (tmp_path / "chat.system").write_text(SYSTEM)
    return tmp_path


def run(path: Path, *arguments: str) -> Result:
    """Run the command."""
    return CliRunner().invoke(graph, [str(path), *arguments])


def test_text_lists_the_ends_of_each_channel(models: Path) -> None:
    """Types, unconnected ports, untyped and external ends, and nodes without ports are listed."""
    result = run(models / "chat.system")
    assert result.exit_code == 0
    assert result.stdout.splitlines() == [
        "service /again : std_srvs.Trigger",
        "  to   /bob (reset)",
        "topic /log : std_msgs.String",
        "  from /ann (/log), not connected",
        "topic /old : std_msgs.Bool, external",
        "  with /ann (legacy), type unknown",
        "topic /room : std_msgs.String",
        "  from /ann (words)",
        "  to   /bob (words)",
        "node /mute, without ports",
    ]


def test_mermaid_has_nested_frames_and_dashed_edges(models: Path) -> None:
    """Subsystems are nested frames, unconnected ports dashed edges."""
    result = run(models / "chat.system", "--format", "mermaid")
    assert result.stdout.splitlines() == [
        "flowchart LR",
        '  subgraph s0_n0["hall"]',
        '    n0["/ann"]',
        '    subgraph s1_n1["corner"]',
        '      n1["/bob"]',
        "    end",
        "  end",
        '  n2["/mute"]',
        '  s3(["/again"])',
        '  t4(["/log"])',
        '  t5(["/old"])',
        '  t6(["/room"])',
        "  s3 --> n1",
        "  n0 -.-> t4",
        "  n0 --> t6",
        "  t6 --> n1",
    ]


def test_dot_has_the_same_vertices_and_edges(models: Path) -> None:
    """Graphviz gets clusters, the types of the channels, and dashed edges."""
    result = run(models / "chat.system", "--format", "dot")
    lines = [line.strip() for line in result.stdout.splitlines()]
    assert lines[0] == 'digraph "Chat" {'
    assert 'subgraph cluster_s1_n1 { label="corner";' in lines
    assert r't6 [shape=ellipse, label="/room\nstd_msgs.String"];' in lines
    assert {"n0 -> t6;", "t6 -> n1;", "n0 -> t4 [style=dashed];"} <= set(lines)
    assert result.stdout.count("{") == result.stdout.count("}")


def test_findings_go_to_stderr_and_errors_fail(models: Path) -> None:
    """A system with errors is shown as far as possible; the exit code is that of the check."""
    path = models / "chat.system"
    path.write_text(
        SYSTEM.replace(
            "connect words to /room connect reset", "connect wrds to /room connect reset"
        )
    )
    result = run(path)
    assert result.exit_code == 1
    assert "error[DRS204 unknown-port]" in result.stderr
    assert "topic /room" in result.stdout


def test_only_systems_have_a_graph(models: Path) -> None:
    """A node description is a usage error, a missing file a finding."""
    assert run(models / "talker.rnd").exit_code == 2
    missing = run(models / "none.system")
    assert missing.exit_code == 2
    assert "DRS001" in missing.stderr


def test_page_has_the_system_and_findings_go_to_the_error_output(models: Path) -> None:
    """It is all of the output, so that it can go to a file; errors still fail the command."""
    (models / "elk.js").write_text("var ELK = class {};")
    arguments = ("--format", "html", "--elkjs", str(models / "elk.js"))
    result = run(models / "chat.system", *arguments)
    assert result.exit_code == 0
    assert result.stdout.startswith("<!DOCTYPE html>")
    assert result.stdout.endswith("</html>\n")
    assert '"full_name":"/ann"' in result.stdout
    (models / "chat.system").write_text(SYSTEM + "node ghost : nobody")
    result = run(models / "chat.system", *arguments)
    assert result.exit_code == 1
    assert "ghost : nobody" in result.stderr
    assert "no import defines" in result.stdout


def test_page_without_elkjs_says_how_to_get_it(models: Path) -> None:
    """Nothing is written then, not even findings."""
    result = run(models / "chat.system", "--format", "html", "--elkjs", str(models / "none.js"))
    assert result.exit_code == 2
    assert result.stdout == ""
    assert "npm pack elkjs@" in result.stderr
