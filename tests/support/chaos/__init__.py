"""The campaign of faults: what is broken, the robot that is broken, and the referee.

A round is drawn from a seed (:mod:`.schedule`) and played (:mod:`.round`): the robot is brought to
drive (:mod:`.driving`) and broken (:mod:`.breaking`). Its plant, safety node and gate live in ROS
domains of their own (:mod:`.robot`), joined by a proxy that can lose, double, delay and repeat
messages (:mod:`.proxy`). It is judged by its messages alone (:mod:`.rules`, :mod:`.referee`).
"""
