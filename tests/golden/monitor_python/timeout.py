# action stop; input v = topic /odom.twist.twist.linear.x timeout 0.5 sec entity e { r: v > 1 or v.missing() or v.age() > 0.2 sec; } if e.r then { stop; };

… 3 lines of monitor.py.j2: @property
        return self._v_silent and not self._v_missing

… 3 lines of monitor.py.j2: def verdicts(self) -> tuple[bool | None, ...]:
            verdict_on(self._e_r, self._v, self._v_counted),
        )

    def on_odom(self, t: int, twist_twist_linear_x: float) -> None:
    # 7 lines
            self._v_counted = t
            if t + 200_000_001 < self._due:
                self._due = t + 200_000_001
            self._v_heard = t
            if self._v_silent:
                self._v_silent = self._v_missing = False
                if t + 500_000_000 < self._due:
                    self._due = t + 500_000_000
    # 5 lines

    def _judge_odom(self, t: int) -> bool:
    # 2 lines
        v_missing = self._v_missing
        v_counted = self._v_counted
    # 4 lines
        if v > 1.0 or v_missing or t - v_counted > 200_000_000:
… 10 lines as in boolean.py: if not self._e_r:
    def _catch_up(self, t: int) -> None:
    # 9 lines
            if self._v_heard + 500_000_000 <= due:
                self._v_heard = NEVER
                self._v_silent = self._v_missing = True
                self._forget_v()
    # 3 lines

    def _earliest(self) -> int:
        """Return the earliest deadline ahead."""
        ends = [self._v_counted + 200_000_001]
        return min([NEVER, self._v_heard + 500_000_000, *(end for end in ends if end > self._now)])

    def _restart(self, t: int, grace: int) -> None:
        """Forget all inputs and intervals at t; timeouts count from t + grace."""
        self._v_heard = t + grace
        self._v_silent = True
        self._v_missing = False
        self._v_counted = NAN
    # 3 lines

… 3 lines of explanation.py.j2: def explain(self) -> Explanation:
            explained(
                'e.r', 2, 'r: v > 1 or v.missing() or v.age() > 0.2 sec;', self._e_r,
                self._e_r_since, self._why_e_r, ('v', self._v), ('v.missing()', self._v_missing),
                ('v.age()', (self._now - self._v_counted) / 1e9),
            ),
        )
    # 4 lines

    def _why_e_r(self) -> tuple[str, ...]:
    # 4 lines
        if self._v_missing:
            found.append('v.missing()')
        if self._now - self._v_counted > 200_000_000:
            found.append(f'v.age() {shown((self._now - self._v_counted) / 1e9)} > 0.2 sec')
        return tuple(found)
