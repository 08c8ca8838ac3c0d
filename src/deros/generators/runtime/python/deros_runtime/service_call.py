"""Calls the service of an action until it has answered success."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rclpy.client import Client
from rclpy.task import Future

LATE = 100_000_000  # ns without an answer after which this is a fault
TIMEOUT = 1_000_000_000  # ns without an answer after which the service is called again
ABSENCE = 5_000_000_000  # ns for which a service that is not needed may be unavailable
KEPT = 10  # requests whose answer still counts; older ones are forgotten
SHOWN = 60  # characters of the message of an answer


class ServiceCall:
    """
    Calls a service from a trigger of an action until it answers success, or the action is reset.

    Only answers to requests since the last trigger count: what was done before it may have been
    undone since.
    """

    def __init__(self, action: str, client: Client, request: Any) -> None:
        """Set up; attach() comes next."""
        self.action = action
        self._client = client
        self._request = request
        self._is_waiting = False  # for success
        self._sent_at: int | None = None  # the last request, if its answer is awaited
        self._pending: list[Future] = []  # the requests since the last trigger
        self._answer = ''  # what the last of them was answered, if not success

    def attach(
        self,
        report_fault: Callable[[str, str], None],
        report_success: Callable[[str, str], None],
        now: Callable[[], int],
    ) -> None:
        """
        Set whom to report to; now returns steady time in nanoseconds.

        report_fault is called with a subject and its fault, empty if it has none; report_success
        with the action and the service.
        """
        self._report_fault = report_fault
        self._report_success = report_success
        self._now = now
        self._available_at = now()

    def set_active(self, active: bool) -> None:
        """Call the service for a trigger of the action, or do not call it any more."""
        self._forget_requests()
        self._is_waiting = active
        if active:
            self._call(self._now())
        else:
            self._report('')

    def check(self) -> None:
        """Call again if need be, and report what is wrong; to be called every 0.1 s."""
        now = self._now()
        if self._is_waiting:
            self._check_call(now)
            return
        if self._client.service_is_ready():
            self._available_at = now
        self._report('is not available' if now - self._available_at >= ABSENCE else '')

    def _check_call(self, now: int) -> None:
        if self._sent_at is None:
            self._call(now)
        elif not self._client.service_is_ready():
            self._lose()
        elif now - self._sent_at >= TIMEOUT:
            self._answer = ''
            self._call(now)
            self._report('has not answered')
        elif now - self._sent_at >= LATE and not self._answer:
            self._report('has not answered')

    def _call(self, now: int) -> None:
        if not self._client.service_is_ready():
            self._lose()
            return
        self._sent_at = now
        if len(self._pending) == KEPT:
            self._client.remove_pending_request(self._pending.pop(0))
        request = self._client.call_async(self._request)
        self._pending.append(request)
        request.add_done_callback(self._take_answer)

    def _lose(self) -> None:
        """Report that nothing can be called; it is called as soon as it is available."""
        self._sent_at = None
        self._answer = ''
        self._report('is not available')

    def _take_answer(self, request: Future) -> None:
        if request not in self._pending:
            return
        self._pending.remove(request)
        response: Any = request.result()
        if response.success:
            self._forget_requests()
            self._is_waiting = False
            self._report('')
            self._report_success(self.action, self._client.service_name)
            return
        self._sent_at = None
        message = _shown(getattr(response, 'message', ''))
        self._answer = f'has answered no success{message}'
        self._report(self._answer)

    def _forget_requests(self) -> None:
        for request in self._pending:
            self._client.remove_pending_request(request)
        self._pending.clear()
        self._sent_at = None
        self._answer = ''

    def _report(self, fault: str) -> None:
        text = f'{self._client.service_name} {fault}' if fault else ''
        self._report_fault(f'call of {self.action}', text)


def _shown(message: object) -> str:
    """Return what a service says besides, on one line."""
    text = ''.join('?' if each < ' ' or each == '\x7f' else each for each in str(message)[:SHOWN])
    return f': {text}' if text else ''
