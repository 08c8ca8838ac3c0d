# action stop; input v = topic /odom.twist.twist.linear.x entity e { r: v > 1.5 3 times within 2 sec; } if e.r then { stop; };

    def _judge_odom(self, t: int) -> bool:
    # 10 lines
                e_r_turns = self._e_r_turns = (*e_r_turns[1:], t + 2_000_000_000)
                if t < e_r_turns[0] < self._due:
                    self._due = e_r_turns[0]
    # 2 lines
        if t < e_r_turns[0]:
… 12 lines as in duration.py: if not self._e_r:
        if now < self._e_r_turns[0] < due:
            due = self._e_r_turns[0]
… 4 lines of monitor.py.j2: return due
        self._e_r_turns = (0,) * 3
        self._e_r_held = False
    # 3 lines
