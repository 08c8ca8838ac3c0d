… 9 lines of custom.py.j2: """
def is_even(parameter: Parameter) -> str:
    """
    Return why the value of a parameter is rejected, or an empty text.

    It checks teeth of mapper.
    """
    return 'must pass limits.is_even, which is not written yet'
