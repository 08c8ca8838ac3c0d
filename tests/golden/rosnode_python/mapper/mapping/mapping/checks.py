… 9 lines of custom.py.j2: """
def small(parameter: Parameter) -> str:
… 5 lines as in limits.py: """
    return 'must pass checks.small, which is not written yet'
