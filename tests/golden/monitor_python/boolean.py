# action stop; input v = topic /flag.data entity e { r: not v; } if e.r then { stop; };

    def _judge_flag(self, t: int) -> bool:
    # 6 lines
        if v is False:
… 8 lines as in smallest.py: if not self._e_r:
        return changed
