# action stop; input v = topic /odom.twist.twist.linear.x timeout 0.5 sec entity e { r: v.unknown(); } if e.r then { stop; };

    def copy(self, keeps: bool) -> 'Monitor':
    # 7 lines
… 6 lines of monitor.py.j2: if keeps:
        self._v_heard = NEVER

    def on_odom(self, t: int, twist_twist_linear_x: float) -> None:
    # 12 lines
            if self._v_known:
                return
            self._v_known = True
    # 4 lines

    def _judge_odom(self, t: int) -> bool:
        """Evaluate the rules on /odom; return whether a verdict changed."""
        v_silent = self._v_silent
        v_missing = self._v_missing
        v_known = self._v_known
    # 4 lines
        if v_missing or not v_silent and not v_known:
… 10 lines as in boolean.py: if not self._e_r:
    def _earliest(self) -> int:
        """Return the earliest deadline ahead."""
        return min(NEVER, self._v_heard + 500_000_000)

    def _forget_v(self) -> None:
        """Make the values of input v unknown."""
        self._v_known = False

… 3 lines of explanation.py.j2: def explain(self) -> Explanation:
            explained(
                'e.r', 2, 'r: v.unknown();', self._e_r, self._e_r_since, self._why_e_r,
                ('v.unknown()', self._v_missing or not (self._v_silent or self._v_known)),
            ),
        )
    # 4 lines
