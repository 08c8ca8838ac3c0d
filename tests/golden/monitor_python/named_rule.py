# action stop; input v = topic /odom.twist.twist.linear.x entity e { q: v > 1; r: v < 2 and not q for 1 sec; } if e.r then { stop; };

    def __init__(
    # 11 lines
        self._e_q = None
    # 3 lines

    def _judge_odom(self, t: int) -> bool:
    # 7 lines
            verdict = True
        elif v <= 1.0:
            verdict = False
        else:
            verdict = None
        if verdict is not self._e_q:
            if verdict or self._e_q:
                self._e_q_since = t
            self._e_q = verdict
            changed = True
    # 23 lines

    def _why_not_e_q(self) -> tuple[str, ...]:
        """Return why e.q is false."""
        return (f'v {shown(self._v)} <= 1',)

    def _why_e_r(self) -> tuple[str, ...]:
        """Return why e.r is true."""
        return (
            f'v {shown(self._v)} < 2 for 1 sec',
            because('not e.q for 1 sec: ', self._why_not_e_q()),
        )
