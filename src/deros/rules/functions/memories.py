"""The memories of functions between messages: the reference that every target must match.

A memory is fed each message that counts, and gives the function's result until the next one. It is
dropped when the input becomes unknown. A result of ``None`` is *unknown*.
"""

from __future__ import annotations

from typing import Protocol

from deros.rules.functions.function_values import rate, stamp_ns

SAMPLES = 9
"""The most samples that a rate over a span of time keeps."""

SPACINGS = SAMPLES - 1
"""Into so many parts the span is divided; two samples lie at least one of them apart."""


class Memory(Protocol):
    """What one function of the rules remembers.

    Attributes:
        result: of the function, as of the last message.
    """

    result: float | None

    def follow(self, t_ns: int, /, *arguments: float | None) -> None:
        """Take the function's arguments, as a message that came at ``t_ns`` gives them."""


class RateOver:
    """``rate(T)``: the change per second since the newest sample that lies the span back.

    Samples are messages at least an eighth of the span apart, so that no more than nine are ever
    needed, however fast messages come: what the change is divided by is at least the span, and
    longer by no more than an eighth of it and the time between two messages.

    Stamps must go forward. A message without one, or with that of the one before, gives no rate and
    is ignored; where they go backward, the samples begin anew.

    Attributes:
        samples: stamps and values, the oldest first.
    """

    def __init__(self) -> None:
        """Remember no sample."""
        self.result: float | None = None
        self.samples: list[tuple[int, float]] = []
        self._latest_ns = 0

    def follow(self, t_ns: int, *arguments: float | None) -> None:
        """Take the value of a message, the span, and seconds and nanoseconds of its header."""
        value, span, *header = arguments
        assert isinstance(span, int)
        self.result = None
        stamped_ns = stamp_ns(*header) if header else t_ns
        if value is None:
            self.samples.clear()
        elif stamped_ns is not None:
            self._take(value, stamped_ns, span)

    def _take(self, value: float, stamp_ns: int, span_ns: int) -> None:
        if self.samples and stamp_ns < self._latest_ns:
            self.samples.clear()
        if self.samples and stamp_ns == self._latest_ns:
            return
        while len(self.samples) > 1 and stamp_ns - self.samples[1][0] >= span_ns:
            del self.samples[0]
        if self.samples and stamp_ns - self.samples[0][0] >= span_ns:
            base_ns, base = self.samples[0]
            self.result = rate(value, base, stamp_ns - base_ns)
        spacing_ns = -(-span_ns // SPACINGS)
        if not self.samples or stamp_ns - self.samples[-1][0] >= spacing_ns:
            self.samples.append((stamp_ns, value))
        self._latest_ns = stamp_ns
