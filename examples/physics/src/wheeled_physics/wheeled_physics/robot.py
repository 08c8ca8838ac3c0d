"""A robot with two driven wheels in MuJoCo: its motors and sensors, and their faults."""

from __future__ import annotations

from collections import deque
import math
import random
from typing import Any

import mujoco
from wheeled_physics.measures import BLOCKED, Measures, STEP, world

SIDES = ('left', 'right')

ENDURANCE = 7200.0
"""Time, in s, for which the battery lasts with both motors at full thrust."""

SAG = 0.35
"""Share of the nominal voltage that a battery which sags loses at full thrust of both motors."""

FAULTS = (
    *(f'{side}_{line}' for side in SIDES for line in ('encoder', 'motor', 'throttle')),
    'caster',
    'battery',
)
"""Lines that are cut, drivers that stick, casters that are blocked, a battery that sags."""


class Robot:
    """
    Physics in steps of 2 ms; the same seed and the same calls give the same states, bit for bit.

    Faults are those of the hardware: the sensors show what they would then show.
    """

    def __init__(self, measures: Measures, seed: int = 0) -> None:
        """Stand on a level floor, with all whole and a full battery."""
        self._measures = measures
        self._model: Any = mujoco.MjModel.from_xml_string(world(measures))
        self._data: Any = mujoco.MjData(self._model)
        self._noise = random.Random(seed)
        self._thrusts = dict.fromkeys(SIDES, 0.0)
        self._stuck: dict[str, float] = {}
        self._faults: set[str] = set()
        late = round(measures.encoder_delay / STEP)
        self._counts = {side: deque([0], maxlen=late + 1) for side in SIDES}
        self._load = 0.0
        self._charge = 1.0

    @property
    def time(self) -> float:
        """Return the simulated time in s."""
        return float(self._data.time)

    @property
    def voltage(self) -> float:
        """Return the voltage of the battery, in V, under the load that it has."""
        full, empty = self._measures.nominal_voltage, self._measures.empty_voltage
        sag = SAG * full * self._load if 'battery' in self._faults else 0.0
        return empty + (full - empty) * self._charge - sag

    def thrust(self, left: float, right: float) -> None:
        """Set the thrusts, from -1 to 1; what is no number is none."""
        for side, value in zip(SIDES, (left, right), strict=True):
            known = value if math.isfinite(value) else 0.0
            self._thrusts[side] = max(-1.0, min(1.0, known))

    def fail(self, fault: str) -> None:
        """Let something fail for good; what is not in ``FAULTS`` is a ``ValueError``."""
        if fault not in FAULTS:
            raise ValueError(f"no fault '{fault}'; there are {', '.join(FAULTS)}")
        self._faults.add(fault)
        if fault.endswith('throttle'):
            side = fault.split('_')[0]
            self._stuck.setdefault(side, self._thrusts[side])
        if fault == 'caster':
            for number in range(len(self._measures.casters)):
                self._model.geom(f'caster{number}').friction[0] = BLOCKED

    def step(self, duration: float = STEP) -> None:
        """Let ``duration`` seconds pass, in whole steps."""
        for _ in range(max(1, round(duration / STEP))):
            self._drive()
            mujoco.mj_step(self._model, self._data)
            for side in SIDES:
                self._count(side)

    def encoder(self, side: str) -> int:
        """Return the ticks of a wheel, as they were before the delay of its line."""
        return self._counts[side][0]

    def gyro(self) -> float:
        """Return the turn rate in rad/s, with the sensor's noise."""
        true = float(self._data.qvel[5])
        return true + self._noise.gauss(0.0, self._measures.gyro_noise)

    def wheel_speed(self, side: str) -> float:
        """Return the true speed of a wheel, in rad/s."""
        return float(self._data.joint(side).qvel[0])

    def position(self) -> tuple[float, float]:
        """Return where the robot truly is, in m from where it started."""
        return float(self._data.qpos[0]), float(self._data.qpos[1])

    def state(self) -> bytes:
        """Return all positions and speeds, to the bit."""
        whole: bytes = self._data.qpos.tobytes() + self._data.qvel.tobytes()
        return whole

    def _drive(self) -> None:
        given = {side: self._stuck.get(side, self._thrusts[side]) for side in SIDES}
        self._load = sum(abs(each) for each in given.values()) / 2
        self._charge = max(0.0, self._charge - self._load * STEP / ENDURANCE)
        share = self.voltage / self._measures.nominal_voltage
        for side, thrust in given.items():
            back = self.wheel_speed(side) / self._measures.top_speed
            acting = 0.0 if f'{side}_motor' in self._faults else thrust * share - back
            limited = max(-1.0, min(1.0, acting))
            self._data.actuator(side).ctrl[0] = self._measures.stall_torque * limited

    def _count(self, side: str) -> None:
        counts = self._counts[side]
        if f'{side}_encoder' in self._faults:
            counts.append(counts[-1])
            return
        turns = float(self._data.joint(side).qpos[0]) / math.tau
        counts.append(math.floor(turns * self._measures.ticks_per_turn))
