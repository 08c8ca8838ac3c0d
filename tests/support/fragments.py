"""Completes the fragments of models that the documentation shows.

A fragment leaves out what the reader of its page knows from elsewhere. The completion declares the
names that it uses (``tests/data/docs/surrounding.deros``), and meets the demands of ``deros check``
that concern the rest of a program: that some behaviour uses each rule and each action, and that
some rule notices the silence of each input, and asks for each zone. All else must be right as the
page shows it.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable
from pathlib import Path

from deros.diagnostics import Diagnostic
from tests.support.checks import checked
from tests.support.cli import deros

DATA = Path(__file__).resolve().parents[1] / "data" / "docs"
_COMMENT = re.compile(r"//[^\n]*")
_STATEMENT = re.compile(
    r"^(?:action|const|input|zone|entity) (\w+)(?:[^\n{]*\{\n.*?^\}|[^\n]*)\n", re.M | re.S
)
_OPENING = re.compile(
    r"\b(?:gate\s+/|entity\s|input\s|zone\s|action\s|const\s|if\s|use\s|unit\s|behaviour\s)"
)
_GATE_LINE = re.compile(r"^\s*(?:lost\s+\w+\s+for|\w+\s*:\s*(?:zero|limit)\b)", re.M)
_GATE_HEAD = "gate /cmd_vel_nav -> /cmd_vel : geometry_msgs.Twist rate 20 Hz {\n"
_NODE_SECTIONS = {"name": "parameters", "topic": "publishes", "service": "services"}


def _quoted(finding: Diagnostic) -> list[str]:
    return re.findall(r"'([^']+)'", finding.message)


def _declaration(finding: Diagnostic, text: str) -> str:
    """Return the declaration of an unknown name, if the surroundings have one."""
    surrounding = (DATA / "surrounding.deros").read_text(encoding="utf-8")
    for name in _quoted(finding):
        for found in _STATEMENT.finditer(surrounding):
            if found[1] == name.split(".")[0] and found[0] not in text:
                return found[0]
    return ""


def _behaviour(finding: Diagnostic, _: str) -> str:
    return f'if {_quoted(finding)[0]} then {{ log_state("shown"); }};\n'


def _call(finding: Diagnostic, text: str) -> str:
    name = _quoted(finding)[0]
    number = len(text.splitlines())
    button = (
        "" if "input pressed" in text else "input pressed = topic /release.data timeout 1 sec\n"
    )
    return (
        f"{button}entity calls_{number} {{\n"
        "  up: (not pressed) for 0.1 sec;\n"
        "  now: pressed begins and (up within 1 ms);\n}\n"
        f"if calls_{number}.now then {{ {name}; }};\n"
    )


def _noticing(term: str, text: str) -> str:
    number = len(text.splitlines())
    action = "" if "action react;" in text else "action react;\n"
    return (
        f"{action}entity silence_{number} {{ noticed: {term}; }}\n"
        f"if silence_{number}.noticed then {{ react; }};\n"
    )


def _lost(finding: Diagnostic, text: str) -> str:
    return _noticing(f"{_quoted(finding)[0]}.unknown()", text)


def _unknown(finding: Diagnostic, text: str) -> str:
    found = re.search(r"use '(.*\.unknown\(\))'", finding.hint)
    return _noticing(found[1], text) if found else ""


def _asked(finding: Diagnostic, text: str) -> str:
    return _noticing(f"position.inside({_quoted(finding)[0]})", text)


_DEMANDS: dict[str, Callable[[Diagnostic, str], str]] = {
    "DRS310": _declaration,
    "DRS312": _declaration,
    "DRS314": _lost,
    "DRS315": _behaviour,
    "DRS316": _call,
    "DRS325": _call,
    "DRS348": _unknown,
    "DRS349": _lost,
    "DRS604": _asked,
}
"""What to add where a fragment leaves out a part of its program, by the code that asks for it."""

_MOST = 12


def check_rules(fragment: str, folder: Path, code: str = "", system: str = "") -> list[Diagnostic]:
    """Return the findings of a fragment of rules, completed.

    Args:
        fragment: statements, rules of an entity, or lines of a gate.
        folder: where to write the models.
        code: that of the finding which the fragment is to have: it is not met.
        system: what the system that it uses has in place of the topics of the usual one, and
            what else, in a file among the frames; the usual one if empty.
    """
    text = _whole(fragment, code)
    if 'use "' not in text:
        text = f'use "Courier.system" import Courier\n{text}'
    file = folder / "shown.deros"
    watched = (DATA / "Courier.system").read_text(encoding="utf-8")
    if system:
        for line in (DATA / "frames" / system).read_text(encoding="utf-8").splitlines():
            topic = re.match(r"  (?:external )?topic (\S+)", line)
            usual = rf"^  external topic {topic[1]}(?: .*)?\n" if topic else r"\Z"
            watched = re.sub(usual, f"{line}\n", watched, count=1, flags=re.MULTILINE)
    if "gate /" in text:
        watched += 'safety "shown.deros"\n'
    if 'import "' in watched:
        shutil.copytree(DATA / "models", folder, dirs_exist_ok=True)
    (folder / "Courier.system").write_text(watched, encoding="utf-8")
    _with_rules(watched, "", folder)
    for _ in range(_MOST):
        file.write_text(text, encoding="utf-8")
        findings = checked(file)
        more = ""
        for finding in findings:
            demand = _DEMANDS.get(finding.code.name)
            if demand is not None and (finding.code.name != code or demand is _declaration):
                more = demand(finding, text)
                if more:
                    break
        if not more:
            return findings
        text += more
    raise AssertionError(f"the fragment cannot be completed:\n{text}")


def _whole(fragment: str, code: str) -> str:
    """Return statements: rules in an entity, the lines of a gate in a gate."""
    bare = _COMMENT.sub("", fragment)
    if _OPENING.search(bare):
        return fragment
    if not _GATE_LINE.search(bare):
        return f"entity shown {{\n{fragment}}}\n"
    lines = fragment
    if "lost heartbeat" not in bare:
        lines += "  lost heartbeat for 0.3 sec: zero until reset;\n"
    if "lost input" not in bare:
        lines += "  lost input for 0.5 sec: zero;\n"
    if code != "DRS342":  # no limit overrides the zeros of a gate that waits
        lines += "  resume on zero command;\n"
    return f"{_GATE_HEAD}{lines}}}\n"


def whole_node(fragment: str) -> str:
    """Return a node description that holds a part of one."""
    word = _COMMENT.sub("", fragment).split()[0]
    if word == "node":
        return fragment
    section = f"{_NODE_SECTIONS[word]}\n" if word in _NODE_SECTIONS else ""
    return f"node shown : shown_driver\n{section}{fragment}"


def check_node(fragment: str, folder: Path, frame: str = "") -> list[Diagnostic]:
    """Return the findings of a node description, or of a part of one.

    Args:
        fragment: the description, or the part.
        folder: where to write the models.
        frame: the name of a system that imports it as ``shown.rnd``, if one is needed.
    """
    file = folder / "shown.rnd"
    file.write_text(whole_node(fragment), encoding="utf-8")
    if not frame:
        return checked(file)
    shutil.copytree(DATA / "models", folder, dirs_exist_ok=True)
    system = folder / "courier.system"
    shutil.copy(DATA / "frames" / frame, system)
    return checked(system)


def check_system(fragment: str, frame: str, folder: Path) -> list[Diagnostic]:
    """Return the findings of a system, or of a part of one in the frame of its page.

    A frame is the text of a system with a line ``// shown`` in the place of the part. The node
    descriptions that it needs are among the models beside it, and are imported where the page does
    not import any.

    Args:
        fragment: the part, or a whole system.
        frame: the name of the frame; empty for a whole system.
        folder: where to write the models.
    """
    imports = re.findall(r"^\s*(import .*)\n", fragment, re.M)
    text = fragment
    if frame:
        part = re.sub(r"^(?:imports\n|\s*import .*\n)", "", fragment, flags=re.M)
        surrounding = (DATA / "frames" / frame).read_text(encoding="utf-8")
        has_part = bool(_COMMENT.sub("", part).strip())
        assert ("// shown\n" in surrounding) == has_part, f"{frame}: no place for it"
        text = surrounding.replace("// shown\n", part)
    shutil.copytree(DATA / "models", folder, dirs_exist_ok=True)
    used = _with_rules(text, frame.removesuffix(".system"), folder)
    if frame:
        for name in dict.fromkeys(re.findall(r"\bnode\s+\w+\s*:\s*(\w+)", _COMMENT.sub("", text))):
            line = f'import "{name}.rnd"'
            if (folder / f"{name}.rnd").exists() and not any(
                each.startswith(line) for each in imports
            ):
                imports.append(line)
        head, _, rest = text.partition("\n")
        section = "imports\n" if imports else ""
        text = "\n".join((head, section + "\n".join(f"  {each}" for each in imports), rest))
    file = folder / "courier.system"
    file.write_text(text, encoding="utf-8")
    return checked(file, *used)


def _with_rules(text: str, frame: str, folder: Path) -> list[Path]:
    """Write the rules that a system names, and the descriptions that are generated from them.

    Of rules and of their older state, from which descriptions were generated, a frame may have its
    own: ``FRAME.NAME.deros``, ``FRAME.old.NAME.deros``.
    """
    used: list[Path] = []
    for common in sorted((DATA / "rules").glob("*.deros")):
        name = common.name
        by_hand = f": {common.stem}_safety_node" in text
        named = re.search(rf'"(rules/)?{name}"', text)
        if not by_hand and named is None:
            continue
        below = named is not None and bool(named[1])
        file = folder / "rules" / name if below else folder / name
        file.parent.mkdir(exist_ok=True)
        if by_hand and "// not generated" not in text:
            _generate(_first(f"{frame}.old.{name}", f"{frame}.{name}", name), file)
        rules = _first(f"{frame}.{name}", name).read_text(encoding="utf-8")
        file.write_text(rules.replace('use "', 'use "../') if below else rules, encoding="utf-8")
        used.append(file)
    return used


def _first(*names: str) -> Path:
    """Return the first of some files of rules that exists."""
    return next(path for path in (DATA / "rules" / name for name in names) if path.exists())


def _generate(rules: Path, file: Path) -> None:
    """Generate the safety node of rules, and leave its descriptions beside the system."""
    shutil.copy(rules, file)
    shutil.copy(DATA / "Courier.system", file.parent / "courier.system")
    outcome = deros("generate", file, "--target", "python", "-o", file.parent / "install")
    assert outcome.code == 0, outcome
    for description in (file.parent / "install").glob("*/*.rnd"):
        shutil.copy(description, file.parent)
