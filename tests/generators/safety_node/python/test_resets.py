"""An action that only resets others: running it without code of one's own is no error."""

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
    """Stands for the safety node: it keeps what is logged."""

    def __init__(self) -> None:
        self.errors: list[str] = []

    def get_logger(self) -> Any:
        return types.SimpleNamespace(error=self.errors.append)


def _actions(node: _Node, more: str = "", call: str = "") -> Any:
    """Return the user's class as generated, belonging to a node."""
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


def test_a_reset_is_no_missing_code() -> None:
    """Neither at the start nor when it is run."""
    node = _Node()
    actions = _actions(node)
    assert actions.unfilled() == []
    actions.release()
    assert node.errors == []


def test_other_actions_still_are() -> None:
    """An action that resets nothing is missing until it is written."""
    node = _Node()
    actions = _actions(node, "action horn;\n", "horn; ")
    assert actions.unfilled() == ["horn"]
    actions.horn()
    assert len(node.errors) == 1
    actions.release()
    assert len(node.errors) == 1
