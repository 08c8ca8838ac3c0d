# action stop; input v = topic /odom.twist.twist.linear.x entity e { r: v > 1.5 3 times within 2 sec; } if e.r then { stop; };

    def _judge_odom(self, t: int) -> bool:
    # 10 lines
                e_r_turns = self._e_r_turns = (*e_r_turns[1:], t + 2_000_000_000)
                if t < e_r_turns[0] < self._due:
                    self._due = e_r_turns[0]
    # 2 lines
        if t < e_r_turns[0]:
… 12 lines as in unknown.py: if not self._e_r:
        ends = [self._e_r_turns[0]]
        return min([NEVER, *(end for end in ends if end > self._now)])

    def _restart(self, t: int, grace: int) -> None:
        """Forget all inputs and intervals at t; timeouts count from t + grace."""
        self._e_r_turns = (0,) * 3
        self._e_r_held = False
    # 3 lines
