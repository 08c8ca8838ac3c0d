"""Safety controller of the machine: contacts, mode switch, engine, stack light, two watchdogs."""

from __future__ import annotations

from feeding_robot_plc.logic import Contact, Mode, PlcLogic, Watchdog
from feeding_robot_plc.plc_base import PlcBase, run
from std_msgs.msg import Bool, ColorRGBA, Float64, UInt64, UInt8

STALLED = 10.0
"""Crankshaft speed, in rad/s, below which the engine does not run."""


class Plc(PlcBase):
    """Joins the decisions of :class:`PlcLogic` to its terminals, which are topics here."""

    def __init__(self) -> None:
        """Start in manual mode with the engine off, both watchdogs fresh."""
        super().__init__()
        timeout = self.parameters.keep_alive_timeout
        now = self._now()
        self._logic = PlcLogic(Watchdog(timeout, now), Watchdog(timeout, now))
        self._engine_running = False
        self._reports = 0
        self._valve_open = False
        self.publish_engine_enable(Bool(data=False))

    def on_engine_speed(self, msg: Float64) -> None:
        """Read the engine, and report all that is known to the main controller."""
        self._engine_running = msg.data > STALLED
        self._report()

    def on_panel_mode(self, msg: UInt8) -> None:
        """Follow the mode switch."""
        now = self._now()
        if self._logic.mode is Mode.MANUAL:
            # Supervision starts here: what happened in manual mode is nobody's fault.
            self._logic.controller.last = self._logic.safety_node.last = now
        self._logic.mode = Mode(msg.data)
        self._act()

    def on_panel_ignition(self, msg: Bool) -> None:
        """Read the ignition key."""
        self._logic.key_turned = msg.data
        self._act()

    def on_panel_stop_button(self, msg: Bool) -> None:
        """Read the stop button."""
        self._on_contact(Contact.STOP_BUTTON, msg)

    def on_contact_front_bumper(self, msg: Bool) -> None:
        """Read the front bumper."""
        self._on_contact(Contact.FRONT_BUMPER, msg)

    def on_contact_rear_bumper(self, msg: Bool) -> None:
        """Read the rear bumper."""
        self._on_contact(Contact.REAR_BUMPER, msg)

    def on_contact_feeding_arm(self, msg: Bool) -> None:
        """Read the collision sensor of the feeding arm."""
        self._on_contact(Contact.FEEDING_ARM, msg)

    def on_controller_keep_alive(self, _msg: UInt64) -> None:
        """Note that the main controller lives."""
        self._logic.controller.last = self._now()

    def on_safety_heartbeat(self, _msg: UInt64) -> None:
        """Note that the safety node lives."""
        self._logic.safety_node.last = self._now()

    def on_low_speed(self, msg: Bool) -> None:
        """Show that the robot is held to a crawl."""
        self._logic.slow = msg.data

    def on_stop(self, msg: Bool) -> None:
        """Show that the robot is stopped."""
        self._logic.stopped = msg.data

    def on_motor_stop(self, msg: Bool) -> None:
        """Obey the safety node."""
        self._logic.motor_stop = msg.data
        self._act()

    def on_watchdog(self) -> None:
        """Look after the two keep-alives."""
        self._act()

    def _on_contact(self, contact: Contact, msg: Bool) -> None:
        if msg.data:
            self._logic.pressed.add(contact)
        else:
            self._logic.pressed.discard(contact)
        self._act()
        self._report()

    def _act(self) -> None:
        for reason in self._logic.supervise(self._now()):
            self.get_logger().warning(f'engine off: {reason}')
        if self._logic.engine_enabled != self._valve_open:
            self._valve_open = self._logic.engine_enabled
            self.publish_engine_enable(Bool(data=self._valve_open))

    def _report(self) -> None:
        pressed = self._logic.pressed
        self.publish_mode(UInt8(data=int(self._logic.mode)))
        self.publish_stop_button(Bool(data=Contact.STOP_BUTTON in pressed))
        self.publish_front_bumper(Bool(data=Contact.FRONT_BUMPER in pressed))
        self.publish_rear_bumper(Bool(data=Contact.REAR_BUMPER in pressed))
        self.publish_feeding_arm(Bool(data=Contact.FEEDING_ARM in pressed))
        self.publish_engine_running(Bool(data=self._engine_running))
        red, green, blue = self._logic.light.value
        self.publish_stack_light(ColorRGBA(r=red, g=green, b=blue, a=1.0))
        self._reports += 1
        self.publish_keep_alive(UInt64(data=self._reports))

    def _now(self) -> float:
        return float(self.clock_of_timers.now().nanoseconds) / 1e9


def main(args: list[str] | None = None) -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(Plc, args)


if __name__ == '__main__':
    main()
