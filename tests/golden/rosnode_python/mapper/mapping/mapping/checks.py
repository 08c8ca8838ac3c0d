… 9 lines of custom.py.j2: """
def small(parameter: Parameter) -> str:
    """
    Return why the value of a parameter is rejected, or an empty text.

    It checks teeth of mapper.
    """
    return 'must pass checks.small, which is not written yet'
