# action stop latched; input v = topic /odom.twist.twist.linear.x timeout 1 sec input w = topic /imu.orientation timeout 1 sec entity e { r: v > 1; s: v.rate() > 1 or v.unknown() or w.tilt().unknown() or v.age() > 1 sec; failsafe u: (r for 1 sec) and not s; failsafe y: (u for 1 sec) and not s; } if e.y then { stop; }; if e.u or e.s then { stop; }; if not e.r for 1 sec then { stop; };

    def on_odom(self, t: int, twist_twist_linear_x: float) -> None:
    # 27 lines
        if self._judge_odom(t) | self._judge_odom_and_imu(t):
            self._act(t)

    def _judge_odom_and_imu(self, t: int) -> bool:
    # 13 lines
        if (
            v_rate > 1.0
            or v_missing
            or not v_silent and not v_known
            or w_missing
            or not w_silent and w_tilt != w_tilt
            or t - v_counted > 1_000_000_000
        ):
            verdict = True
        elif (
            v_rate <= 1.0
            and not v_missing
            and (v_silent or v_known)
            and not w_missing
            and (w_silent or w_tilt == w_tilt)
            and t - v_counted <= 1_000_000_000
        ):
            verdict = False
        else:
            verdict = None
    # 19 lines
        if (
            t >= e_u_due and e_s is False
            or not (t < e_u_due < NEVER or e_r is False or e_s) and (not v_silent or v_missing)
        ):
            verdict = True
        elif t < e_u_due < NEVER or e_r is False or e_s:
            verdict = False
        else:
            verdict = None
    # 18 lines
        if (
            t >= e_y_due and e_s is False
            or not (t < e_y_due < NEVER or e_u is False or e_s) and (not v_silent or v_missing)
        ):
            verdict = True
        elif t < e_y_due < NEVER or e_u is False or e_s:
            verdict = False
        else:
            verdict = None
    # 35 lines

    def _act(self, t: int) -> None:
    # 22 lines
        elif e_u is False and e_s is False:
            self._behaviour_2 = False
        else:
            self._behaviour_2 = None
    # 3 lines
        behaviour_3_due = self._behaviour_3_due
        if e_r is False:
            if behaviour_3_due is NEVER:
                behaviour_3_due = t + 1_000_000_000
                self._behaviour_3_due = behaviour_3_due
                if behaviour_3_due < self._due:
                    self._due = behaviour_3_due
        elif behaviour_3_due is not NEVER:
            behaviour_3_due = self._behaviour_3_due = NEVER
        if t >= behaviour_3_due:
            if not self._behaviour_3:
                self._behaviour_3 = True
                self._stop_active = True
                self._trigger(t, 'stop', 'behaviour_3', 2)
        elif t < behaviour_3_due < NEVER or e_r:
            self._behaviour_3 = False
        else:
            self._behaviour_3 = None
    # 7 lines
        elif e_u_early is False and e_s is False:
            self._behaviour_2_early = False
        else:
            self._behaviour_2_early = None
    # 2 lines
        if behaviour_3_due is not NEVER:
            self._behaviour_3_early = True
        elif e_r:
            self._behaviour_3_early = False
        else:
            self._behaviour_3_early = None

    def _earliest(self) -> int:
        """Return the earliest deadline ahead."""
        ends = [
            self._e_u_due, self._e_y_due, self._behaviour_3_due, self._v_counted + 1_000_000_001,
        ]
    # 4 lines

from .monitor import Monitor, NEVER, verdict_on

… 3 lines of explanation.py.j2: def explain(self) -> Explanation:
            explained(
                'e.r', 2, 'r: v > 1;', self._e_r, self._e_r_since, self._why_e_r, ('v', self._v),
            ),
            explained(
                'e.s', 2,
                's: v.rate() > 1 or v.unknown() or w.tilt().unknown() or v.age() > 1 sec;',
                self._e_s, self._e_s_since, self._why_e_s, ('v.rate()', self._v_rate),
                ('v.unknown()', self._v_missing or not (self._v_silent or self._v_known)),
                ('w.tilt().unknown()', self._w_missing or not (self._w_silent or self._w_tilt == self._w_tilt)),  # noqa: E501
                ('v.age()', (self._now - self._v_counted) / 1e9),
            ),
            explained(
                'e.u', 2, 'failsafe u: (r for 1 sec) and not s;', self._e_u, self._e_u_since,
                self._why_e_u, ('v', self._v), ('v.rate()', self._v_rate),
                ('v.unknown()', self._v_missing or not (self._v_silent or self._v_known)),
                ('w.tilt().unknown()', self._w_missing or not (self._w_silent or self._w_tilt == self._w_tilt)),  # noqa: E501
                ('v.age()', (self._now - self._v_counted) / 1e9),
            ),
            explained(
                'e.y', 2, 'failsafe y: (u for 1 sec) and not s;', self._e_y, self._e_y_since,
                self._why_e_y, ('v', self._v), ('v.rate()', self._v_rate),
                ('v.unknown()', self._v_missing or not (self._v_silent or self._v_known)),
                ('w.tilt().unknown()', self._w_missing or not (self._w_silent or self._w_tilt == self._w_tilt)),  # noqa: E501
                ('v.age()', (self._now - self._v_counted) / 1e9),
            ),
        )
    # 3 lines
        elif self._behaviour_1 is None:
            causes['behaviour_1'] = self._why_unknown_behaviour_1()
        elif self._behaviour_1_early:
            causes['behaviour_1'] = self._why_behaviour_1_early()
        elif self._behaviour_1_early is None:
            causes['behaviour_1'] = self._why_unknown_behaviour_1_early()
    # 2 lines
        elif self._behaviour_2 is None:
            causes['behaviour_2'] = self._why_unknown_behaviour_2()
        elif self._behaviour_2_early:
            causes['behaviour_2'] = self._why_behaviour_2_early()
        elif self._behaviour_2_early is None:
            causes['behaviour_2'] = self._why_unknown_behaviour_2_early()
    # 2 lines
        elif self._behaviour_3 is None:
            causes['behaviour_3'] = self._why_unknown_behaviour_3()
        elif self._behaviour_3_early:
            causes['behaviour_3'] = self._why_behaviour_3_early()
        elif self._behaviour_3_early is None:
            causes['behaviour_3'] = self._why_unknown_behaviour_3_early()
        return Explanation(rules, causes)

    def _why_e_s(self) -> tuple[str, ...]:
    # 4 lines
        if self._v_missing or not self._v_silent and not self._v_known:
            found.append('v.unknown()')
        if self._w_missing or not self._w_silent and self._w_tilt != self._w_tilt:
            found.append('w.tilt().unknown()')
    # 3 lines

    def _why_not_e_s(self) -> tuple[str, ...]:
        """Return why e.s is false."""
        return (
            f'v.rate() {shown(self._v_rate)} <= 1', 'not v.unknown()', 'not w.tilt().unknown()',
            f'v.age() {shown((self._now - self._v_counted) / 1e9)} <= 1 sec',
        )

    def _why_e_u(self) -> tuple[str, ...]:
    # 2 lines
        found += all_of(
            given(self._now >= self._e_u_due, because('e.r for 1 sec: ', self._why_e_r())),
            given(self._e_s is False, because('not e.s: ', self._why_not_e_s())),
        )
        if not found:
            found.append(
                unknown_of(('v', self._v), ('v.rate()', self._v_rate), ('v.unknown()', self._v_missing or not (self._v_silent or self._v_known)), ('w.tilt().unknown()', self._w_missing or not (self._w_silent or self._w_tilt == self._w_tilt)), ('v.age()', (self._now - self._v_counted) / 1e9)),  # noqa: E501
            )
        return tuple(found)

    def _why_e_u_early(self) -> tuple[str, ...]:
    # 2 lines
        part_1 = any_of(
            given(self._now >= self._e_u_due, because('e.r for 1 sec: ', self._why_e_r())),
            given(self._now < self._e_u_due < NEVER, because(f'e.r for {shown((self._now - self._e_u_due + 1_000_000_000) / 1e9)} s, long enough in {shown((self._e_u_due - self._now) / 1e9)} s: ', self._why_e_r())),  # noqa: E501
        )
    # 8 lines

    def _why_e_y_early(self) -> tuple[str, ...]:
    # 2 lines
        found += all_of(
            given(self._e_u_early, because('e.u, then for 1 sec: ', self._why_e_u_early())),
            given(self._e_s is False, because('not e.s: ', self._why_not_e_s())),
        )
    # 5 lines

    def _why_behaviour_2(self) -> tuple[str, ...]:
    # 2 lines
        if self._e_u:
            found.append(because('e.u: ', self._why_e_u()))
        if self._e_s:
            found.append(because('e.s: ', self._why_e_s()))
        return tuple(found)
