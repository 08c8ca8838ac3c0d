# action stop; input v = topic /odom.twist.twist.linear.x entity e { r: v in [-1, 1) and not v = 0 or v != 2; } if e.r then { stop; };

    def _judge_odom(self, t: int) -> bool:
    # 6 lines
        if -1.0 <= v < 1.0 and (v < 0.0 or v > 0.0) or v < 2.0 or v > 2.0:
… 10 lines as in boolean.py: if not self._e_r:
… 4 lines of explanation.py.j2: def given(condition: bool, *causes: str) -> tuple[str, ...]:
… 4 lines of explanation.py.j2: def any_of(*parts: tuple[str, ...]) -> tuple[str, ...]:
… 4 lines of explanation.py.j2: def all_of(*parts: tuple[str, ...]) -> tuple[str, ...]:
    def _why_e_r(self) -> tuple[str, ...]:
        """Return why e.r is true."""
        found = []
        found += all_of(
            given(-1.0 <= self._v < 1.0, f'v {shown(self._v)} in [-1, 1)'),
            given(self._v < 0.0 or self._v > 0.0, f'v {shown(self._v)} != 0'),
        )
        if self._v < 2.0 or self._v > 2.0:
            found.append(f'v {shown(self._v)} != 2')
        return tuple(found)
