"""An action that only resets others: running it without user code is not an error."""

from __future__ import annotations

import sys
import types
from typing import Any

from deros.generators.api.protocol import Context
from deros.generators.safety_package.python.generate import generate
from deros.metamodels.load import Repository
from tests.support.rules import embedded_store, load

RULES = """action crawl publishes 0.2 on /limit : std_msgs.Float64 reset_by release;
action release;
{more}input v = topic /scan.range_max timeout 1 sec
entity e {{ far: v > 1.0 or v.missing(); }}
if e.far then {{ crawl; {call}}};
if not e.far then {{ release; }};
"""


class _Node:
    """A stand-in for the safety node that records its log."""

    def __init__(self) -> None:
        self.errors: list[str] = []

    def get_logger(self) -> Any:
        return types.SimpleNamespace(error=self.errors.append)


def _actions(node: _Node, more: str = "", call: str = "") -> Any:
    """Return the generated user class, attached to a node."""
    context = Context(embedded_store(), Repository())
    model = load(RULES.format(more=more, call=call))
    files = generate(model, context, {"package": "r_safety"})
    package = types.ModuleType("r_safety")
    modules = {"r_safety": package}
    for suffix in ("actions_base", "actions"):
        name = f"r_safety.r_safety_node_{suffix}"
        module = types.ModuleType(name)
        modules[name] = module
        sys.modules.update(modules)
        try:
            path = f"r_safety/{name.replace('.', '/')}.py"
            exec(compile(files[path].text, path, "exec"), module.__dict__)
        finally:
            for each in modules:
                sys.modules.pop(each, None)
    return module.RSafetyNodeActions(node)


def test_resetting_action_needs_no_code() -> None:
    """There is no error at the start, nor when it is run."""
    node = _Node()
    actions = _actions(node)
    assert actions.unfilled() == []
    actions.release()
    assert node.errors == []


def test_other_action_without_code_is_an_error() -> None:
    """An action that resets nothing is reported until it is written."""
    node = _Node()
    actions = _actions(node, "action horn;\n", "horn; ")
    assert actions.unfilled() == ["horn"]
    actions.horn()
    assert len(node.errors) == 1
    actions.release()
    assert len(node.errors) == 1
