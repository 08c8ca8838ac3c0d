"""What stands for ``$(…)`` in a parameter file is the same in a check and at the start."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import HealthCheck, assume, example, given, settings
from hypothesis import strategies as st

from deros.diagnostics import SourceFile, Span
from deros.generators.system.script.standalone.made import substituting
from deros.metamodels.parameter_files import substituting as checked
from deros.metamodels.parameter_files.library import ParameterFiles
from deros.models.arguments import LaunchArgument
from deros.models.parameter_files import Document, Fault, ParameterFile, Plain
from tests.support import rcl_yaml

pytest.importorskip("rclpy")

SPAN = Span(SourceFile("x.system", "x"), 0, 0)
LAYOUTS = (
    "a: {}\n",
    "a: x{}\n",
    "a: {}x\n",
    'a: "{}"\n',
    "a: '{}'\n",
    "a: [{}, {}]\n",
    "a: {{b: {}, c: 1}}\n",
    "a: |\n  {}\n  x\n",
    "a: >-\n  x {}\n  y\n",
    "{}: 1\n",
    "a: !!str {}\n",
    "a:\n  - {}\n  - x{}\n",
    "# {}\na: 1  # {}\n",
)
VALUES = st.one_of(
    st.sampled_from(["7", "1.5", "on", "~", "", "-", "-x", "- x", ": x", "a:", "a: b", "a:b", "é"]),
    st.sampled_from(["a b", " a", "a ", "#", "a #b", "'", '"', "\\", "tcp://h:1", "---", "..."]),
    st.text(max_size=6),
)


def _statement(folder: Path, values: dict[str, str]) -> ParameterFile:
    passed = tuple(LaunchArgument(n, v, SPAN, SPAN, SPAN) for n, v in values.items())
    load = ParameterFiles().load
    plain = Plain("", SPAN)
    return ParameterFile(str(folder / "x.yaml"), SPAN, SPAN, load, plain=plain, given=passed)


def _loaded(folder: Path, text: str, values: dict[str, str]) -> Document:
    (folder / "x.yaml").write_bytes(text.encode())
    found = _statement(folder, values).load()
    assert isinstance(found, Document)
    return found


def test_both_read_the_same_uses() -> None:
    """One meaning, in two programs that do not know each other."""
    assert checked._USE.pattern == substituting._USE.pattern
    assert checked._MEANT_BY_YAML.pattern == substituting._MEANT_BY_YAML.pattern


@settings(max_examples=600, deadline=None, suppress_health_check=list(HealthCheck))
@given(layout=st.sampled_from(LAYOUTS), value=VALUES, use=st.sampled_from(["$(var v)", "<v>"]))
@example("a: {}\n", "-1.5", "$(var v)")
@example("a: {}x\n", "a:", "<v>")
def test_what_is_checked_is_what_a_node_gets(
    tmp_path_factory: pytest.TempPathFactory, layout: str, value: str, use: str
) -> None:
    """Whatever the value and its place: what YAML would take for something else is refused."""
    folder = tmp_path_factory.mktemp("put")
    text = layout.replace("{}", use).replace("{{", "{").replace("}}", "}")
    (folder / "x.yaml").write_bytes(text.encode())
    given = {"v" if "var" in use else use: value}
    found = _statement(folder, given).load()
    try:
        made = substituting.substituted(text, given, {}, str)
    except ValueError:
        made = None
    is_refused = isinstance(found, Document) and any(
        "one value of YAML" in each.message for each in _faults(found)
    )
    if made is None:
        assert is_refused or not isinstance(found, Document)
        return
    assert not is_refused
    keys = Plain("", SPAN).keys
    (folder / "made.yaml").write_text(
        f"{keys[0]}:\n  {keys[1]}:\n" + "".join(f"    {line}\n" for line in made.splitlines())
    )
    read = rcl_yaml.read(folder / "made.yaml")
    if not isinstance(found, Document):
        assert read is None, (text, value)
        return
    sections = [(e.key, [(v.name, v.value) for v in e.values]) for e in found.sections]
    assume(not any(v.value is None for e in found.sections for v in e.values))
    assert repr(read) == repr(sections), (text, value)


def _faults(document: Document) -> tuple[Fault, ...]:
    assert document.substituted is not None
    return document.substituted.faults


@pytest.mark.parametrize(
    "written",
    ["$(eval 1 + 1)", "$(var $(var a))", "$(var 'a')", "$(command 'ls')", "$(var)", "$(", "$()"],
)
def test_what_is_no_value_is_refused_by_both(tmp_path: Path, written: str) -> None:
    """But what looks like a comment may speak of it."""
    text = f"# {written}\na: x{written}  # {written}\n"
    (fault, *_) = _faults(_loaded(tmp_path, text, {"a": "1"}))
    assert "cannot be substituted" in fault.message
    assert fault.span.start == text.index("$", text.index("\n"))
    with pytest.raises(ValueError, match="cannot be substituted"):
        substituting.substituted(text, {"a": "1"}, {}, str)


def test_values_are_looked_up_where_the_system_is_started() -> None:
    """A variable that is set, else its default; the folder of a package."""
    text = "a: $(env A x) $(env B y) $(find-pkg-share p)/m"
    found = substituting.substituted(text, {}, {"A": "1"}, lambda package: f"/opt/{package}")
    assert found == "a: 1 y /opt/p/m"
    with pytest.raises(ValueError, match="'C' is not set"):
        substituting.substituted("$(env C)", {}, {"A": "1"}, str)


def test_unknown_names_and_bare_texts_are_found(tmp_path: Path) -> None:
    """A misspelt name; a text that becomes a number when it is ``7``."""
    text = "a: $(var prefx)\nb: $(var prefix)\nc: '$(var prefix)'\nd: $(var prefix)x\ne: $(var n)\n"
    found = _faults(_loaded(tmp_path, text, {"prefix": "left", "n": "7"}))
    assert [(each.message.partition(" is")[0], each.hint) for each in found] == [
        ("the system gives no value for 'prefx'", "did you mean 'prefix'?"),
        ("'$(var prefx)'", 'put it in quotes: "$(var prefx)"'),
        ("'$(var prefix)'", 'put it in quotes: "$(var prefix)"'),
    ]
