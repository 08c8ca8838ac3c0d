"""Whatever the arguments are, every starter waits for what the model says."""

from __future__ import annotations

import runpy
from types import SimpleNamespace

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from deros.generators.api.protocol import GenerationError
from deros.generators.builtin import rossystem_launch, rossystem_script
from deros.generators.system.script.generate import table
from deros.generators.system.view import system_view
from deros.systems.arguments.resolve import resolve
from deros.systems.flatten import flatten
from deros.validators.system.running.starting import check_starting
from tests.support.argument_systems import VALUES, load, waiting_systems
from tests.support.launch_events import launched
from tests.support.systems import CONTEXT


@settings(
    max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(text=waiting_systems(), data=st.data())
def test_random_systems_wait_for_what_is_modelled(
    tmp_path_factory: pytest.TempPathFactory, text: str, data: st.DataObject
) -> None:
    """By the names that nodes and ends have for these values, in the script and by launch."""
    folder = tmp_path_factory.mktemp("waits")
    system = load(folder, text)
    values = {name: data.draw(st.sampled_from(found)) for name, found in VALUES.items()}
    resolved = resolve(system, values)
    assume(not any(check_starting(flatten(resolved))))  # what is awaited is there, and a node
    try:
        (script,) = rossystem_script(system, CONTEXT).values()
        (launch,) = rossystem_launch(system, CONTEXT).values()
        rows = table(system_view(resolved))
    except GenerationError:  # two nodes of one name, say
        assume(False)
    expected = {each.full_name: each.ready.name for each in rows if each.ready is not None}

    (folder / "s.py").write_text(script.text)
    made = runpy.run_path(str(folder / "s.py"))
    found = made["nodes"](SimpleNamespace(**values))
    assert {e.full_name: e.ready.name for e in found if e.ready is not None} == expected, text

    words = {
        name: str(value).lower() if isinstance(value, bool) else str(value)
        for name, value in values.items()
    }
    assert launched(launch.text, **words).awaited == expected, text
