"""A process that serves /arm and /brake, prints each request, and answers all of them alike.

    python switch.py [REFUSAL]

It answers success, or no success with the text REFUSAL. It ends when its input does. Tests kill or
freeze this process.
"""

from __future__ import annotations

import contextlib
import sys
import threading
from typing import Any

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.signals import SignalHandlerOptions
from std_srvs.srv import SetBool, Trigger


def main(refusal: str = "") -> None:
    """Serve until the input ends."""

    def answer(request: Any, response: Any) -> Any:
        print(type(request).__name__, getattr(request, "data", ""), flush=True)
        response.success, response.message = not refusal, refusal
        return response

    def end_with_input() -> None:
        sys.stdin.read()
        rclpy.shutdown()

    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = rclpy.create_node("switch")
    node.create_service(SetBool, "/arm", answer)
    node.create_service(Trigger, "/brake", answer)
    threading.Thread(target=end_with_input, daemon=True).start()
    print("ready", flush=True)
    with contextlib.suppress(ExternalShutdownException):
        rclpy.spin(node)


if __name__ == "__main__":
    main(*sys.argv[1:])
