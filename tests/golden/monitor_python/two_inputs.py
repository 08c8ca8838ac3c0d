# action stop; input v = topic /odom.twist.twist.linear.x timeout 1 sec input w = topic /odom.twist.twist.linear.y entity e { r: v > w; } if e.r then { stop; };

    def on_odom(self, t: int, twist_twist_linear_x: float, twist_twist_linear_y: float) -> None:
    # 4 lines
        fresh = False
    # 8 lines
            if twist_twist_linear_x != self._v:
                self._v = twist_twist_linear_x
                fresh = True
    # 2 lines
            fresh = True
    # 3 lines
            if twist_twist_linear_y != self._w:
                self._w = twist_twist_linear_y
                fresh = True
    # 2 lines
            fresh = True
    # 4 lines

    def _judge_odom(self, t: int) -> bool:
    # 7 lines
        if v > w:
… 9 lines as in boolean.py: if not self._e_r:
