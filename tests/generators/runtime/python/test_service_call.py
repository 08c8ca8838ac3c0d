"""The calls of a service: when they are made again, and what is reported."""

from __future__ import annotations

import pytest

pytest.importorskip("rclpy")

from tests.support.service_calls import Server

MS = 10**6


@pytest.fixture
def server() -> Server:
    """Return a server that is there, and the calls that it gets."""
    server = Server()
    server.is_available = True
    return server


def play(server: Server, *steps: str) -> list[str]:
    """Do steps and return what happened in them."""
    server.done.clear()
    for step in steps:
        server.play(step)
    return server.done


def test_service_is_called_at_the_trigger(server: Server) -> None:
    """Success ends the calls; the check does not call again."""
    assert play(server, "t") == ["call"]
    assert play(server, "y0") == ["/arm done"]
    assert play(server, f"+{10_000 * MS}") == []


def test_missing_answer_is_a_fault_before_the_next_call(server: Server) -> None:
    """A fault after 0.1 s, a call after 1 s."""
    play(server, "t")
    assert play(server, f"+{99 * MS}") == []
    assert play(server, f"+{MS}") == ["fault /arm has not answered"]
    assert play(server, f"+{899 * MS}") == []
    assert play(server, f"+{MS}") == ["call"]
    assert play(server, f"+{999 * MS}") == []
    assert play(server, f"+{MS}") == ["call"]


def test_late_answer_to_an_earlier_request_counts(server: Server) -> None:
    """It was sent after the trigger, so what it asked for is done."""
    play(server, "t", f"+{1000 * MS}", f"+{1000 * MS}")
    assert play(server, "y0") == ["fault ", "/arm done"]
    assert play(server, "y1", "n2", f"+{2000 * MS}") == []


def test_refusal_is_shown_until_the_next_answer(server: Server) -> None:
    """A server that refuses slowly does not alternate between two faults."""
    fault = "fault /arm has answered no success"
    assert play(server, "t", f"+{50 * MS}", "n0") == ["call", fault]
    assert play(server, f"+{50 * MS}", f"+{300 * MS}", "n1") == ["call"]
    assert play(server, f"+{50 * MS}", f"+{1000 * MS}") == [
        *("call", "call"),
        "fault /arm has not answered",
    ]


def test_answer_from_before_a_trigger_does_not_count(server: Server) -> None:
    """What it did may have been undone before the second trigger."""
    assert play(server, "t", "t") == ["call", "call"]
    assert play(server, "y0") == []
    assert play(server, "y1") == ["/arm done"]


def test_answer_after_a_reset_does_not_count(server: Server) -> None:
    """The calls end with the reset, and so does the fault."""
    play(server, "t", f"+{200 * MS}")
    assert play(server, "r") == ["fault "]
    assert play(server, "n0", f"+{2000 * MS}") == []


def test_service_is_called_as_soon_as_it_is_there() -> None:
    """The check finds it; a service that goes while its answer is awaited is called anew."""
    server = Server()
    assert play(server, "t") == ["fault /arm is not available"]
    assert play(server, f"+{2000 * MS}") == []
    assert play(server, "a", f"+{MS}") == ["call"]
    assert play(server, "d", f"+{MS}", "a", f"+{MS}", "y1") == ["call", "fault ", "/arm done"]


def test_absence_is_a_fault_after_five_seconds_without_a_trigger(server: Server) -> None:
    """A start or restart of the server takes a moment."""
    assert play(server, f"+{5000 * MS}", "d", f"+{4999 * MS}") == []
    assert play(server, f"+{MS}") == ["fault /arm is not available"]
    assert play(server, "a", f"+{MS}") == ["fault "]


def test_ten_requests_are_kept(server: Server) -> None:
    """A server that hangs for hours takes no memory; what it answers then is too old."""
    play(server, "t", *[f"+{1000 * MS}"] * 10)
    assert len(server.requests) == 11
    assert play(server, "y0") == []
    assert play(server, "y1") == ["fault ", "/arm done"]
