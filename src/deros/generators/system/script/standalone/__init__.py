"""
The run-time part of generated scripts: what starts, watches and stops the nodes of a system.

The modules here use the standard library alone. The generator puts their texts one after another
into each script; ``deros up`` imports them.
"""
