"""The calls of a service in Python, played from a script without middleware."""

from __future__ import annotations

import random
from collections.abc import Iterable
from types import SimpleNamespace
from typing import Any

from rclpy.task import Future

from deros.generators.runtime.python.deros_runtime.service_call import ServiceCall

MESSAGES = {"y": "", "n": "", "m": "busy\né"}


class Server:
    """A client of a service, and the server behind it, as a test plays them."""

    service_name = "/arm"

    def __init__(self) -> None:
        """Start without a server."""
        self.is_available = False
        self.done: list[str] = []
        self.requests: list[Future] = []
        self.now = 0
        self._fault = ""
        client: Any = self
        self.call = ServiceCall("disarm", client, "request")
        self.call.attach(self._take_fault, self._take_success, lambda: self.now)

    def service_is_ready(self) -> bool:
        """Return whether there is a server."""
        return self.is_available

    def call_async(self, request: Any) -> Future:
        """Take a request."""
        assert request == "request"
        self.done.append("call")
        self.requests.append(Future())
        return self.requests[-1]

    def remove_pending_request(self, request: Future) -> None:
        """Take that an answer is not awaited any more; it may come all the same."""

    def answer(self, number: int, success: bool, message: str = "") -> None:
        """Answer a request."""
        response = SimpleNamespace(success=success, message=message)
        self.requests[number].set_result(response)

    def play(self, step: str) -> None:
        """Do one step of a script, as ``harness.cpp`` describes them."""
        kind, number = step[0], int(step[1:] or 0)
        if kind == "+":
            self.now += number
            self.call.check()
        elif kind in "tr":
            self.call.set_active(kind == "t")
        elif kind in "ad":
            self.is_available = kind == "a"
        else:
            self.answer(number, kind == "y", MESSAGES[kind])

    def _take_fault(self, subject: str, text: str) -> None:
        assert subject == "call of disarm"
        if text != self._fault:
            self.done.append(f"fault {text}")
        self._fault = text

    def _take_success(self, action: str, service: str) -> None:
        assert action == "disarm"
        self.done.append(f"{service} done")


def called(script: Iterable[str]) -> str:
    """Return what the calls do in a script."""
    server = Server()
    for step in script:
        server.play(step)
    return "".join(f"{each}|" for each in server.done)


def drawn_script(drawn: random.Random) -> list[str]:
    """Return a random script, in which each request is answered once at most."""
    script: list[str] = []
    server = Server()
    waiting: list[int] = []
    for _ in range(60):
        count = len(server.requests)
        step = drawn.choice(["+", "+", "+", "+", "t", "r", "a", "a", "d", "answer", "answer"])
        if step == "+":
            step += str(drawn.choice([10**8, 10**8, 5 * 10**7, 10**9, 3 * 10**9]))
        elif step == "answer":
            if not waiting:
                continue
            number = drawn.choice(waiting[-5:])
            waiting.remove(number)
            step = f"{drawn.choice('yynm')}{number}"
        script.append(step)
        server.play(step)
        waiting += range(count, len(server.requests))
    return script
