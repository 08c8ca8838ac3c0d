# input v = topic /odom.twist.twist.linear.x entity e { r: v > 1; s: v > 2; } action stop latched; if e.r then { stop; }; if e.s then { stop; };

    def __init__(
    # 15 lines
        self._stop_active = 'stop' in latched
        self._restart(start, grace)

    def reset(self, t: int) -> bool:
    # 7 lines
        done = True
    # 2 lines
        if self._stop_active:
            self._stop_active = not self._is_reset(
                t, 'stop', 2, ('behaviour_1', self._behaviour_1, False),
                ('behaviour_2', self._behaviour_2, False),
            )
            done = done and not self._stop_active
        return done

    def _act(self, t: int) -> None:
    # 7 lines
            self._stop_active = True
            self._trigger(t, 'stop', 'behaviour_1', 2)
        self._behaviour_1 = e_r
    # 4 lines
            self._stop_active = True
            self._trigger(t, 'stop', 'behaviour_2', 2)
        self._behaviour_2 = e_s

… 7 lines of monitor.py.j2: def _is_reset(self, t: int, action: str, line: int, *behaviours: tuple) -> bool:
… 11 lines of explanation.py.j2: def without_value(*reads: tuple) -> tuple[str, ...]:
    def explain(self) -> Explanation:
    # 10 lines
        if self._behaviour_1:
            causes['behaviour_1'] = self._why_behaviour_1()
        elif self._behaviour_1 is None:
            causes['behaviour_1'] = self._why_unknown_behaviour_1()
        if self._behaviour_2:
            causes['behaviour_2'] = self._why_behaviour_2()
        elif self._behaviour_2 is None:
            causes['behaviour_2'] = self._why_unknown_behaviour_2()
        return Explanation(rules, causes)
