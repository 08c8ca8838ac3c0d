# input v = topic /odom.twist.twist.linear.x entity e { r: v > 1; s: v > 2; } action stop; action beep(times, text, loud, pitch, slow); behaviour near: if e.r then { stop; if e.s then { beep(-3, "a", true, 0.5, false); }; stop; };

    def _act(self, t: int) -> None:
    # 6 lines
        near_rises = False
    # 2 lines
                near_rises = self._near = True
    # 9 lines
                self._trigger(t, 'beep', 'behaviour_2', 2, -3, 'a', True, 0.5, False)
    # 2 lines
        if near_rises:
            self._trigger(t, 'stop', 'near', 2)
