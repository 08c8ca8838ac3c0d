"""The version check of ``deros_runtime``."""

from __future__ import annotations

import pytest

from deros.generators.runtime.python.deros_runtime import (
    RuntimeVersionError,
    __version__,
    require,
)


def test_same_version_is_accepted() -> None:
    """The check does not raise."""
    require(__version__, "robot_safety")


@pytest.mark.parametrize("version", ["0.0.9", f"{__version__}.1", ""])
def test_other_version_is_rejected(version: str) -> None:
    """The error names the package and both versions."""
    with pytest.raises(RuntimeVersionError) as raised:
        require(version, "robot_safety")
    assert str(raised.value).startswith(
        f"robot_safety was generated for deros_runtime {version}, but {__version__} is installed"
    )
