# input v = topic /odom.twist.twist.linear.x entity e { r: v > 1; s: v > 2; } action stop reset_by ok; action ok; if e.r then { stop; }; if e.s then { ok; };

    def __init__(
    # 15 lines
        self._stop_active = False
        self._restart(start, grace)

    def _act(self, t: int) -> None:
    # 3 lines
        ok_ran = False
    # 13 lines
                ok_ran = True
    # 5 lines
        if ok_ran and self._stop_active:
            self._stop_active = not self._is_reset(
                t, 'stop', 2, ('behaviour_1', self._behaviour_1, False),
            )
