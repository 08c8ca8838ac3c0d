# action stop; input v = topic /flag.data entity e { r: not v; } if e.r then { stop; };

    def _judge_flag(self, t: int) -> bool:
    # 6 lines
        if v is False:
            if not self._e_r:
                self._e_r = True
                self._e_r_since = t
                changed = True
        elif self._e_r:
            self._e_r = False
            self._e_r_since = t
            changed = True
        return changed
