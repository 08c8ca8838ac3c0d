# action stop; input v = topic /imu.orientation entity e { r: v.roll() in [0, 1] or v.pitch() > 1 or v.yaw() > 1 or v.tilt() > 1; } if e.r then { stop; };

    def on_imu(
    # 15 lines
            length = math.sqrt(
                orientation_x * orientation_x
                + orientation_y * orientation_y
                + orientation_z * orientation_z
                + orientation_w * orientation_w
            )
            if 0.0 < length < math.inf:
                ux = orientation_x / length
                uy = orientation_y / length
                uz = orientation_z / length
                uw = orientation_w / length
                sine = 2.0 * (uw * ux + uy * uz)
                cosine = 1.0 - 2.0 * (ux * ux + uy * uy)
                v_roll = math.atan2(sine, cosine)
                sine = 2.0 * (uw * uy - uz * ux)
                if not -1.0 <= sine <= 1.0:
                    sine = math.copysign(1.0, sine)
                v_pitch = math.asin(sine)
                sine = 2.0 * (uw * uz + ux * uy)
                cosine = 1.0 - 2.0 * (uy * uy + uz * uz)
                v_yaw = math.atan2(sine, cosine)
                v_tilt = 2.0 * math.atan2(math.sqrt(ux * ux + uy * uy), math.sqrt(uz * uz + uw * uw))  # noqa: E501
            else:
                v_roll = v_pitch = v_yaw = v_tilt = NAN
    # 19 lines

    def _judge_imu(self, t: int) -> bool:
    # 9 lines
        if 0.0 <= v_roll <= 1.0 or v_pitch > 1.0 or v_yaw > 1.0 or v_tilt > 1.0:
… 10 lines as in boolean.py: if not self._e_r:
    def _why_e_r(self) -> tuple[str, ...]:
    # 2 lines
        if 0.0 <= self._v_roll <= 1.0:
            found.append(f'v.roll() {shown(self._v_roll)} in [0, 1]')
    # 7 lines
