"""What runs in the process that reads a launch file in Python: the only user of launch itself.

It makes of each action the element that it would be in XML. It imports nothing of deros but itself.
"""
