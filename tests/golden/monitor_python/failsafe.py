# action stop; input v = topic /odom.twist.twist.linear.x timeout 0.5 sec entity e { failsafe r: v > 1; } if e.r then { stop; };

    def _judge_odom(self, t: int) -> bool:
    # 8 lines
        if v > 1.0 or not (v <= 1.0) and (not v_silent or v_missing):
… 10 lines as in boolean.py: if not self._e_r:
… 8 lines of explanation.py.j2: def unknown_of(*reads: tuple, results: tuple = ()) -> str:
    def _why_e_r(self) -> tuple[str, ...]:
    # 4 lines
        if not found:
            found.append(unknown_of(('v', self._v)))
        return tuple(found)
