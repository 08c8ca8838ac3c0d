# input v = topic /odom.twist.twist.linear.x entity e { r: v > 1; s: v > 2; } action stop latched; if e.r then { stop; }; if e.s then { stop; };

def refusing(*behaviours: tuple) -> tuple[tuple[str, ...], ...]:
    """
    Return the behaviours that hold, those that are unknown, and those that are on their way.

    Each comes with the verdict of its condition, and with the same as if no 'for' had to last.
    """
    holding = tuple(name for name, held, _ in behaviours if held)
    unknown = tuple(
        name for name, held, early in behaviours if not held and None in (held, early))
    coming = tuple(name for name, held, early in behaviours if held is False and early)
    return holding, unknown, coming

def without_value(*reads: tuple) -> tuple[str, ...]:
    """
    Return the terms that have no value, each once.

    Each comes with the verdict of the rule that reads it, which has to be unknown, and its value.
    """
    names = dict.fromkeys(
        term for verdict, term, value in reads
        if verdict is None and (value is None or value != value))
    return tuple(f'{name} is unknown' for name in names)

    def __init__(
    # 15 lines
        self._stop_active = 'stop' in latched
        self._restart(start, grace)

    @property
    def unknown(self) -> tuple[str, ...]:
        """Return the names of the behaviours whose conditions are unknown, so that they refuse."""
        return self._refusing()[1]

    @property
    def coming(self) -> tuple[str, ...]:
        """Return the names of the behaviours whose conditions are on their way, and so refuse."""
        return self._refusing()[2]

    def _refusing(self) -> tuple[tuple[str, ...], ...]:
        return refusing(
            ('behaviour_1', self._behaviour_1, False),
            ('behaviour_2', self._behaviour_2, False),
        )

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

    def reset(self, t: int) -> bool:
    # 7 lines
        done = True
    # 2 lines
        if self._stop_active:
            if self._behaviour_1 is False and self._behaviour_2 is False:
                self._stop_active = False
                self._emit(Event(t, EventKind.RESET, 'stop', '', (), 2))
            else:
                self._refuse(
                    t, 'stop', 2, ('behaviour_1', self._behaviour_1, False),
                    ('behaviour_2', self._behaviour_2, False),
                )
            done = done and not self._stop_active
        return done

    def _act(self, t: int) -> None:
    # 9 lines
                self._stop_active = True
                self._emit(Event(t, EventKind.TRIGGER, 'stop', 'behaviour_1', (), 2))
        elif e_r is False:
            self._behaviour_1 = False
        else:
            self._behaviour_1 = None
    # 6 lines
                self._stop_active = True
                self._emit(Event(t, EventKind.TRIGGER, 'stop', 'behaviour_2', (), 2))
        elif e_s is False:
            self._behaviour_2 = False
        else:
            self._behaviour_2 = None

    def _refuse(self, t: int, action: str, line: int, *behaviours: tuple) -> None:
        """Emit that an action stays active, and which behaviours refuse its reset."""
        self._emit(Event(t, EventKind.REFUSED, action, '', (), line, *refusing(*behaviours)))
