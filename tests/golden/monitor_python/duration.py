# action stop; input v = topic /odom.twist.twist.linear.x entity e { r: v > 1.5 for 2 sec; } if e.r then { stop; };

    def _judge_odom(self, t: int) -> bool:
    # 6 lines
        e_r_due = self._e_r_due
        if v > 1.5:
            if e_r_due is NEVER:
                e_r_due = t + 2_000_000_000
                self._e_r_due = e_r_due
                if e_r_due < self._due:
                    self._due = e_r_due
        elif e_r_due is not NEVER:
            e_r_due = self._e_r_due = NEVER
        if t >= e_r_due:
… 12 lines as in unknown.py: if not self._e_r:
        ends = [self._e_r_due]
        return min([NEVER, *(end for end in ends if end > self._now)])

    def _restart(self, t: int, grace: int) -> None:
        """Forget all inputs and intervals at t; timeouts count from t + grace."""
        self._e_r_due = NEVER
    # 3 lines
