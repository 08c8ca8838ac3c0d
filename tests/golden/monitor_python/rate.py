# action stop; input v = topic /odom.twist.twist.linear.x entity e { r: v.rate() > 2 or v.abs() > 2; } if e.r then { stop; };

    def __init__(
    # 13 lines
        self._v_rate_last_t = start
        self._restart(start, grace)

    def on_odom(self, t: int, twist_twist_linear_x: float) -> None:
    # 7 lines
            v_rate = rate_per_second(
                twist_twist_linear_x, self._v_rate_last, t - self._v_rate_last_t,
            )
            self._v_rate_last = twist_twist_linear_x
            self._v_rate_last_t = t
    # 16 lines

    def _forget_v(self) -> None:
    # 7 lines
        self._v_rate_last = NAN
