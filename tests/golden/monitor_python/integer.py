# action stop; input v = topic /mode.data entity e { r: v = 0 or v >= 3; } if e.r then { stop; };

    def on_mode(self, t: int, data: int) -> None:
    # 11 lines

    def _judge_mode(self, t: int) -> bool:
    # 6 lines
        if v == 0 or v >= 3:
… 12 lines as in angle.py: if not self._e_r:
        if self._v == 0:
            found.append('v = 0')
        if self._v >= 3:
            found.append(f'v {shown(self._v)} >= 3')
        return tuple(found)
