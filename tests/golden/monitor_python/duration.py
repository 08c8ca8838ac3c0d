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
… 10 lines as in boolean.py: if not self._e_r:
    def _earliest(self) -> int:
    # 2 lines
        if now < self._e_r_due < due:
            due = self._e_r_due
… 4 lines of monitor.py.j2: return due
        self._e_r_due = NEVER
    # 3 lines
