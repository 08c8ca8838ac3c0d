"""A robot with two driven wheels in MuJoCo: its motors and sensors, and their faults."""

from __future__ import annotations

from collections import deque
import math
import random
from typing import Any

import mujoco
import numpy as np
from wheeled_physics.lidar import LIDAR_FAULTS, LidarRays
from wheeled_physics.measures import BLOCKED, Measures, STEP, world

SIDES = ('left', 'right')

PULSE = 0.01
"""Time, in s, for which the motors' voltages stay, and from one count to the next: 5 steps."""

ENDURANCE = 7200.0
"""Time, in s, for which the battery lasts with both motors at full thrust."""

SAG = 0.35
"""Share of the nominal voltage that a battery which sags loses at full thrust of both motors."""

DRIFT = 0.5
"""By how much, in rad/s, a gyroscope that drifts is more off with each second."""

FAULTS = (
    *(f'{side}_{line}' for side in SIDES for line in ('encoder', 'motor', 'throttle', 'runaway')),
    'runaway',
    'caster',
    'battery',
    'gyro',
    'line',
)
"""
Lines of encoders and motors that are cut; drivers that stick at the thrust that they have, or that
run away, one or both, as their output has a short circuit to the battery; casters that are
blocked; a battery that sags; a gyroscope that drifts; the line to the computer that is cut.
"""


Quaternion = tuple[float, float, float, float]
"""How something stands, as ROS has it: ``x, y, z, w``."""


class Robot:
    """
    Physics in steps of 2 ms; the same seed and the same calls give the same states, bit for bit.

    Faults are those of the hardware: the sensors show what they would then show. A cut line to the
    computer is one of them (``heard``), which the board obeys: it has no commands any more.
    """

    def __init__(self, measures: Measures, seed: int = 0) -> None:
        """Stand where the floor is level, with all whole and a full battery."""
        self._measures = measures
        self._model: Any = mujoco.MjModel.from_xml_string(world(measures))
        self._data: Any = mujoco.MjData(self._model)
        self._noise = random.Random(seed)
        self._thrusts = dict.fromkeys(SIDES, 0.0)
        self._stuck: dict[str, float] = {}
        self._faults: set[str] = set()
        self._drifting_since: float | None = None
        self._relay_open = False
        joints = [self._model.joint(side) for side in SIDES]
        self._angles = [int(each.qposadr[0]) for each in joints]
        self._speeds = [int(each.dofadr[0]) for each in joints]
        late = round(measures.encoder_delay / PULSE)
        self._counts = {side: deque([0], maxlen=late + 1) for side in SIDES}
        late = round(measures.attitude_delay / PULSE)
        self._attitudes: deque[Any] = deque([self._attitude()], maxlen=late + 1)
        self._load = 0.0
        self._charge = 1.0
        lidar = measures.lidar
        self._lidar = lidar and LidarRays(lidar, self._model, self._data, self._noise)
        self.faults = (*FAULTS, *(LIDAR_FAULTS if lidar else ()), *measures.things)

    @property
    def time(self) -> float:
        """Return the simulated time in s."""
        return float(self._data.time)

    @property
    def charge(self) -> float:
        """Return how full the battery is, from 0 to 1."""
        return self._charge

    @property
    def voltage(self) -> float:
        """Return the voltage of the battery, in V, under the load that it has."""
        full, empty = self._measures.nominal_voltage, self._measures.empty_voltage
        sag = SAG * full * self._load if 'battery' in self._faults else 0.0
        return empty + (full - empty) * self._charge - sag

    @property
    def heard(self) -> bool:
        """Return whether the line between the board and the computer is whole."""
        return 'line' not in self._faults

    def thrust(self, left: float, right: float) -> None:
        """Set the thrusts, from -1 to 1; what is no number is none."""
        for side, value in zip(SIDES, (left, right), strict=True):
            known = value if math.isfinite(value) else 0.0
            self._thrusts[side] = max(-1.0, min(1.0, known))

    def relay(self, is_open: bool) -> None:
        """Open or close the relay in the motors' supply: open, no driver has a voltage."""
        self._relay_open = is_open
        self._connect()

    def fail(self, fault: str) -> None:
        """Let something fail for good, or get in the way; another name is a ``ValueError``."""
        if fault not in self.faults:
            raise ValueError(f"no fault '{fault}'; there are {', '.join(self.faults)}")
        self._faults.add(fault)
        if fault in self._measures.things:
            self._put(fault)
        if self._lidar and fault in LIDAR_FAULTS:
            self._lidar.fail(fault)
        side, _, line = fault.rpartition('_')
        if line == 'throttle':
            self._stuck.setdefault(side, self._thrusts[side])
        if line == 'runaway':
            self._stuck.update(dict.fromkeys([side] if side else SIDES, 1.0))
        if fault == 'gyro' and self._drifting_since is None:
            self._drifting_since = self.time
        if fault == 'caster':
            for number in range(len(self._measures.casters)):
                self._model.geom(f'caster{number}').friction[0] = BLOCKED
        self._connect()

    def step(self, duration: float = PULSE) -> None:
        """Let ``duration`` seconds pass, in whole pulses of 10 ms."""
        for _ in range(max(1, round(duration / PULSE))):
            self._drive()
            mujoco.mj_step(self._model, self._data, round(PULSE / STEP))
            for side in SIDES:
                self._count(side)
            self._attitudes.append(self._attitude())

    def encoder(self, side: str) -> int:
        """Return the ticks of a wheel, as they were before the delay of the line."""
        return self._counts[side][0]

    def counted(self, side: str) -> int:
        """Return the ticks of a wheel, as the board has counted them."""
        return self._counts[side][-1]

    def gyro(self) -> float:
        """Return the turn rate in rad/s, with the sensor's noise."""
        noise = self._noise.gauss(0.0, self._measures.gyro_noise)
        return self.turn_rate() + DRIFT * self._drifting() + noise

    def imu(self) -> Quaternion:
        """
        Return how the robot stands as an IMU shows it: late, and with noise.

        It sums up what its gyroscopes show, so one that drifts makes a roll that there is not.
        """
        roll, pitch = (self._noise.gauss(0.0, self._measures.attitude_noise) for _ in range(2))
        shown = self._attitudes[0].copy()
        drifted = DRIFT * self._drifting() ** 2 / 2
        mujoco.mju_quatIntegrate(shown, [roll + drifted, pitch, 0.0], 1.0)
        return _quaternion(shown)

    def scan(self) -> list[float] | None:
        """
        Return what each beam of the laser scanner measures, in m and from right to left.

        Infinity is nothing within its range, 0 what is too near; without a line it is ``None``.
        """
        return self._lidar.scan() if self._lidar else None

    def touched(self) -> list[float]:
        """Return the bearing (rad, from straight ahead to the left) of what its shell meets."""
        yaw = self.yaw()
        shell = self._model.geom('shell').id
        pairs, frames = self._data.contact.geom, self._data.contact.frame
        met: dict[int, float] = {}
        for number in np.flatnonzero((pairs == shell).any(axis=1)):
            first, second = map(int, pairs[number])
            # The normal points from the first of the two to the second.
            sign, other = (1.0, second) if first == shell else (-1.0, first)
            dx, dy = (sign * float(each) for each in frames[number][:2])
            met[other] = math.remainder(math.atan2(dy, dx) - yaw, math.tau)
        return [met[other] for other in sorted(met)]

    def wheel_speed(self, side: str) -> float:
        """Return the true speed of a wheel, in rad/s."""
        return float(self._data.qvel[self._speeds[SIDES.index(side)]])

    def position(self) -> tuple[float, float]:
        """Return where the robot truly is, in m from where it started."""
        return float(self._data.qpos[0]), float(self._data.qpos[1])

    def height(self) -> float:
        """Return how high, in m, the robot truly is above where it started."""
        return float(self._data.qpos[2]) - self._measures.wheel_radius

    def orientation(self) -> Quaternion:
        """Return how the robot truly stands."""
        return _quaternion(self._attitude())

    def yaw(self) -> float:
        """Return the angle, in rad, to which the robot truly is turned to the left."""
        x, y, z, w = self.orientation()
        return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))

    def turn_rate(self) -> float:
        """Return how fast, in rad/s, the robot truly turns to the left."""
        return float(self._data.qvel[5])

    def speed(self) -> float:
        """Return how fast the robot truly is, in m/s over the ground."""
        return math.hypot(float(self._data.qvel[0]), float(self._data.qvel[1]))

    def state(self) -> bytes:
        """Return all positions and speeds, to the bit."""
        whole: bytes = self._data.qpos.tobytes() + self._data.qvel.tobytes()
        return whole

    def _attitude(self) -> Any:
        """Return a copy of the quaternion of the body, as MuJoCo has it: ``w`` comes first."""
        return self._data.qpos[3:7].copy()

    def _put(self, name: str) -> None:
        """Put a thing in the way, as the robot stands now."""
        thing, yaw = self._measures.things[name], self.yaw()
        ahead, aside, height = thing.place
        x, y = self.position()
        number = int(self._model.body(name).mocapid[0])
        self._data.mocap_pos[number] = (
            x + ahead * math.cos(yaw) - aside * math.sin(yaw),
            y + ahead * math.sin(yaw) + aside * math.cos(yaw),
            height,
        )
        self._data.mocap_quat[number] = (math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2))

    def _drifting(self) -> float:
        """Return for how many seconds the gyroscope has drifted."""
        return 0.0 if self._drifting_since is None else self.time - self._drifting_since

    def _connect(self) -> None:
        """Give each motor its torque, or none where its line or the relay is open; brake then."""
        for side in SIDES:
            dead = self._relay_open or f'{side}_motor' in self._faults
            torque = 0.0 if dead else self._measures.stall_torque
            motor = self._model.actuator(side)
            motor.gainprm[0] = torque
            motor.biasprm[2] = -torque / self._measures.top_speed
            held = self._measures.brake if self._relay_open else 0.0
            joint = self._model.joint(side)
            joint.frictionloss[0] = self._measures.gear_friction + held

    def _drive(self) -> None:
        given = [self._stuck.get(side, self._thrusts[side]) for side in SIDES]
        self._load = 0.0 if self._relay_open else sum(abs(each) for each in given) / 2
        self._charge = max(0.0, self._charge - self._load * PULSE / ENDURANCE)
        share = self.voltage / self._measures.nominal_voltage
        for number, thrust in enumerate(given):
            self._data.ctrl[number] = thrust * share

    def _count(self, side: str) -> None:
        counts = self._counts[side]
        if f'{side}_encoder' in self._faults:
            counts.append(counts[-1])
            return
        turns = float(self._data.qpos[self._angles[SIDES.index(side)]]) / math.tau
        counts.append(math.floor(turns * self._measures.ticks_per_turn))


def _quaternion(numbers: Any) -> Quaternion:
    w, x, y, z = map(float, numbers)
    return x, y, z, w
