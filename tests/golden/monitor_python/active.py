# input v = topic /odom.twist.twist.linear.x entity e { r: v > 1; s: stop.active and v > 2; t: not stop.active; } action stop latched; action cut; if e.r then { stop; }; if e.s or e.t and stop.active for 1 sec then { cut; };

    def reset(self, t: int) -> bool:
    # 16 lines
        if before != (self._stop_active,):
            self._evaluate(t)
    # 2 lines

    def on_odom(self, t: int, twist_twist_linear_x: float) -> None:
    # 13 lines
        if not self._started:
            self._evaluate(t)
            return
    # 2 lines

    def _judge_round_2(self, t: int) -> bool:
    # 6 lines
        if self._stop_active and v > 2.0:
            if not self._e_s:
                self._e_s = True
                self._e_s_since = t
                changed = True
        elif self._e_s:
            self._e_s = False
            self._e_s_since = t
            changed = True
    # 3 lines
        if not self._stop_active:
            if not self._e_t:
                self._e_t = True
                self._e_t_since = t
                changed = True
        elif self._e_t:
            self._e_t = False
            self._e_t_since = t
            changed = True
        return changed

    def _act(self, t: int) -> None:
    # 10 lines
        self._judge_round_2(t)
    # 20 lines

… 3 lines of monitor.py.j2: def _evaluate(self, t: int) -> None:
    # 2 lines

… 3 lines of explanation.py.j2: def explain(self) -> Explanation:
            explained(
                'e.r', 2, 'r: v > 1;', self._e_r, self._e_r_since, self._why_e_r, ('v', self._v),
            ),
            explained(
                'e.s', 2, 's: stop.active and v > 2;', self._e_s, self._e_s_since, self._why_e_s,
                ('stop.active', self._stop_active), ('v', self._v),
            ),
            explained(
                'e.t', 2, 't: not stop.active;', self._e_t, self._e_t_since, self._why_e_t,
                ('stop.active', self._stop_active),
            ),
        )
    # 8 lines

    def _why_behaviour_2(self) -> tuple[str, ...]:
    # 4 lines
        found += all_of(
            given(self._e_t, because('e.t for 1 sec: ', self._why_e_t())),
            given(self._stop_active, 'stop is active for 1 sec'),
        )
        return tuple(found)
