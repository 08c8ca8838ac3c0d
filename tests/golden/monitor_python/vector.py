# action stop; input v = topic /imu.angular_velocity entity e { r: v.norm() > 1; } if e.r then { stop; };

    def on_imu(
    # 14 lines
            v_norm = vector_norm(angular_velocity_x, angular_velocity_y, angular_velocity_z)
    # 8 lines
