# action stop; input v = topic /odom.twist.twist.linear.x entity e { r: v > 1.5; } if e.r then { stop; };

… 19 lines of slots.py: def cell(value: float, *bounds: float) -> tuple[float, float]:
    def on_odom(self, t: int, twist_twist_linear_x: float) -> None:
    # 6 lines
        if twist_twist_linear_x == twist_twist_linear_x:
            self._v = twist_twist_linear_x
            if self._v_low <= twist_twist_linear_x <= self._v_high:
                return
            self._v_low, self._v_high = cell(twist_twist_linear_x, 1.5)
        else:
            self._forget_v()
    # 2 lines

    def _judge_odom(self, t: int) -> bool:
    # 6 lines
        if v > 1.5:
… 10 lines as in boolean.py: if not self._e_r:
    def _forget_v(self) -> None:
        """Make the values of input v unknown."""
        self._v = NAN
        self._v_low = NAN
        self._v_high = NAN

    def _why_e_r(self) -> tuple[str, ...]:
        """Return why e.r is true."""
        return (f'v {shown(self._v)} > 1.5',)
