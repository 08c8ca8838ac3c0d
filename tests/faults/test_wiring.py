"""Hand-wired safety nodes and gates with errors: the robot is not started."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.codes import ALL_CODES
from tests.support.cli import deros
from tests.support.hand_wired import DIFFERENCES, write_hand_wired


@pytest.mark.parametrize("name", DIFFERENCES)
def test_wrongly_wired_robot_is_not_started(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    """Starting from the system alone gives the error: 1 for the model, not 2 for the start.

    Neither launch file nor script is generated from such a system.
    """
    monkeypatch.chdir(tmp_path)
    write_hand_wired()
    sound = deros("up", "robot.system", "--dry-run")
    assert "robot_safety robot_safety_node" in sound.out
    old, new, code, words = DIFFERENCES[name]
    system = Path("robot.system")
    text = system.read_text(encoding="utf-8")
    assert old in text
    system.write_text(text.replace(old, new, 1), encoding="utf-8")
    started = deros("up", "robot.system")
    assert (started.code, started.out) == (1, "")
    assert f"error[{ALL_CODES[code]}]" in started.err
    assert words in started.err
    for target in ("launch", "script"):
        assert deros("generate", "robot.system", "--target", target, "-o", "out").code == 1
    assert not Path("out").exists()
