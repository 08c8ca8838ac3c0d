"""The runtime packages that generated packages depend on, and where deros puts or finds them."""

from __future__ import annotations

import json
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

from deros import __version__
from deros.generators.output.banner import with_banner
from deros.pipeline.runtime import workspace_of
from tests.support.cli import Outcome, deros

MANIFEST = "deros_runtime/package.xml"


@pytest.fixture
def rules(tmp_path: Path) -> Path:
    """Create rules without findings."""
    assert deros("new", "rules", "robot", "-o", tmp_path / "models").code == 0
    return tmp_path / "models/robot.deros"


def generate(rules: Path, output: Path, *more: str, target: str = "python") -> Outcome:
    """Generate a package, which depends on the runtime unless the options say otherwise."""
    command = ("generate", rules, "--target", target, "-o", output)
    return deros(*command, *more)


def set_version(manifest: Path, version: str) -> None:
    """Give a runtime package another version, as that version of deros would have written it."""
    lines = manifest.read_text().splitlines(keepends=True)
    plain = "".join([lines[0], *lines[3:]]).replace(f">{__version__}<", f">{version}<", 1)
    manifest.write_text(with_banner("package.xml", plain))


def version_of(manifest: Path) -> str:
    """Return the version of a package."""
    return ElementTree.parse(manifest).findtext("version", "")


@pytest.mark.parametrize(
    ("target", "package"), [("python", "deros_runtime"), ("cpp", "deros_runtime_cpp")]
)
def test_runtime_is_put_beside_the_package(
    rules: Path, tmp_path: Path, target: str, package: str
) -> None:
    """One line says so; only the runtime of the language is written, and not twice."""
    output = tmp_path / "out"
    outcome = generate(rules, output, target=target)
    assert outcome.code == 0, outcome.err
    folders = {path.name for path in output.iterdir() if path.is_dir()}
    assert {each for each in folders if each.startswith("deros")} == {package}
    note = f"wrote {output / package}, version {__version__} of the runtime"
    assert [line for line in outcome.out.splitlines() if package in line] == [note]
    again = generate(rules, output, target=target)
    assert again.out.splitlines()[-1] == f"found {package} {__version__} in {output / package}"
    assert "wrote" not in again.out


def test_package_with_a_copy_has_no_runtime_beside_it(rules: Path, tmp_path: Path) -> None:
    """It is complete in itself."""
    assert generate(rules, tmp_path / "out", "--runtime", "copy").code == 0
    assert not (tmp_path / "out/deros_runtime").exists()


def test_packages_of_several_rules_share_one_runtime(rules: Path, tmp_path: Path) -> None:
    """The origins of its files are neither of the two models."""
    output = tmp_path / "out"
    assert generate(rules, output).code == 0
    assert deros("new", "rules", "other", "-o", tmp_path / "others").code == 0
    outcome = generate(tmp_path / "others/other.deros", output)
    assert outcome.code == 0, outcome.err
    record = json.loads((output / ".deros-origins.json").read_text())
    (origin,) = [each for each in record["made by"] if MANIFEST in each["files"]]
    assert (origin["target"], origin["model"]) == ("runtime", "deros")


def test_runtime_elsewhere_in_the_workspace_is_used(rules: Path, tmp_path: Path) -> None:
    """Colcon does not accept two packages of one name."""
    source = tmp_path / "ws/src"
    assert deros("runtime", source / "common/deros").code == 0
    outcome = generate(rules, source / "robot")
    assert outcome.code == 0, outcome.err
    place = source / "common/deros/deros_runtime"
    assert outcome.out.splitlines()[-1] == f"found deros_runtime {__version__} in {place}"
    assert not (source / "robot/deros_runtime").exists()


def test_other_version_elsewhere_in_the_workspace_is_refused(rules: Path, tmp_path: Path) -> None:
    """The message names both versions and what to do; nothing is written."""
    source = tmp_path / "ws/src"
    assert deros("runtime", source / "common").code == 0
    set_version(source / "common" / MANIFEST, "0.0.9")
    outcome = generate(rules, source / "robot")
    assert outcome.code == 2
    assert f"the workspace has deros_runtime 0.0.9 in {source}/common/deros_runtime" in outcome.err
    assert f"for version {__version__}" in outcome.err
    assert f"'deros runtime {source}/common'" in outcome.err
    assert "--runtime copy" in outcome.err
    assert not (source / "robot").exists()
    assert deros("runtime", source / "common").code == 0
    assert generate(rules, source / "robot").code == 0


def test_older_runtime_beside_the_package_is_refreshed(rules: Path, tmp_path: Path) -> None:
    """So are all generated files; the line names both versions."""
    assert generate(rules, tmp_path / "out").code == 0
    manifest = tmp_path / "out" / MANIFEST
    set_version(manifest, "0.0.9")
    outcome = generate(rules, tmp_path / "out")
    assert f"from version 0.0.9 of the runtime to {__version__}: generate" in outcome.out
    assert version_of(manifest) == __version__


def test_edited_file_of_the_runtime_is_kept(rules: Path, tmp_path: Path) -> None:
    """A warning says so, as for every generated file; --overwrite replaces it."""
    assert generate(rules, tmp_path / "out").code == 0
    module = tmp_path / "out/deros_runtime/deros_runtime/process.py"
    module.write_text(f"{module.read_text()}# mine\n")
    outcome = generate(rules, tmp_path / "out")
    assert outcome.code == 0
    assert f"{module}:1:1: warning[DRS403" in outcome.err
    assert module.read_text().endswith("# mine\n")
    assert generate(rules, tmp_path / "out", "--overwrite").code == 0
    assert not module.read_text().endswith("# mine\n")


def test_versions_are_not_mixed_by_an_edited_file(rules: Path, tmp_path: Path) -> None:
    """An edited runtime of another version is refused as a whole."""
    output = tmp_path / "out"
    assert generate(rules, output).code == 0
    set_version(output / MANIFEST, "0.0.9")
    module = output / "deros_runtime/deros_runtime/process.py"
    module.write_text(f"{module.read_text()}# mine\n")
    outcome = generate(rules, output)
    assert outcome.code == 2
    assert "has version 0.0.9 of the runtime" in outcome.err
    assert "deros_runtime/deros_runtime/process.py was edited by hand" in outcome.err
    assert version_of(output / MANIFEST) == "0.0.9"
    assert generate(rules, output, "--overwrite").code == 0
    assert version_of(output / MANIFEST) == __version__


def _install(prefix: Path, version: str) -> None:
    marker = prefix / "share/ament_index/resource_index/packages/deros_runtime"
    marker.parent.mkdir(parents=True)
    marker.touch()
    share = prefix / "share/deros_runtime"
    share.mkdir(parents=True)
    name = "<name>deros_runtime</name>"
    (share / "package.xml").write_text(f"<package>{name}<version>{version}</version></package>")


def test_installed_runtime_is_used(
    rules: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The ament index has it in this version."""
    _install(tmp_path / "ros", __version__)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "ros"))
    outcome = generate(rules, tmp_path / "ws/src")
    assert outcome.code == 0, outcome.err
    last = outcome.out.splitlines()[-1]
    assert last == f"found deros_runtime {__version__} in {tmp_path / 'ros'}"
    assert not (tmp_path / "ws/src/deros_runtime").exists()


def test_other_installed_version_is_hidden(
    rules: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A workspace may have a package of its own in place of an installed one; the line says so."""
    _install(tmp_path / "ros", "0.0.9")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "ros"))
    outcome = generate(rules, tmp_path / "ws/src")
    assert outcome.code == 0, outcome.err
    remark = f"it hides version 0.0.9 in {tmp_path / 'ros'}"
    assert outcome.out.splitlines()[-1].endswith(remark)
    assert (tmp_path / "ws/src" / MANIFEST).is_file()


def test_what_the_workspace_has_built_does_not_count(
    rules: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its install folder is made from the sources that are written now."""
    _install(tmp_path / "ws/install/deros_runtime", __version__)
    prefix = str(tmp_path / "ws/install/deros_runtime")
    monkeypatch.setenv("AMENT_PREFIX_PATH", prefix)
    assert generate(rules, tmp_path / "ws/src").code == 0
    assert (tmp_path / "ws/src" / MANIFEST).is_file()


@pytest.mark.parametrize("marker", ["package.xml", "COLCON_IGNORE"])
def test_workspace_is_where_colcon_searches(tmp_path: Path, marker: str) -> None:
    """Folders in a package, or that colcon ignores, belong to none."""
    source = tmp_path / "ws/src"
    (source / "group/robot").mkdir(parents=True)
    assert workspace_of(source / "group/robot") == source
    (source / "group" / marker).touch()
    assert workspace_of(source / "group/robot") is None
    assert workspace_of(source) == source
    built = tmp_path / "built"
    (built / "install").mkdir(parents=True)
    assert workspace_of(built / "packages") is None
    (built / "install/.colcon_install_layout").touch()
    assert workspace_of(built / "packages") == built


def test_source_tree_gets_the_runtime_beside_it_in_a_workspace(rules: Path, tmp_path: Path) -> None:
    """Elsewhere the folder above is not deros' to write to, and the line says what is needed."""
    command = ("generate", rules, "--target", "python", "--scaffold")
    outcome = deros(*command, tmp_path / "ws/src/robot")
    assert outcome.code == 0, outcome.err
    assert f"wrote {tmp_path}/ws/src/deros_runtime" in outcome.out
    assert (tmp_path / "ws/src" / MANIFEST).is_file()
    outcome = deros(*command, tmp_path / "robot")
    assert outcome.code == 0, outcome.err
    assert "depends on deros_runtime: 'deros runtime' writes it" in outcome.out
    assert not (tmp_path / "deros_runtime").exists()
