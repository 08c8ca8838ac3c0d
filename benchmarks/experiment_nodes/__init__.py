"""The processes of the repeated experiments: the safety node under test, and the recorder."""
