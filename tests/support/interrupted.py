"""A program that gets a SIGINT where Python forgets the exception that its handler raises."""

from __future__ import annotations

LOST = """\
import os, signal
from deros.cli.start import main
from deros.validators import check
class Interrupted:
    def __del__(self):  # where Python prints an exception, and goes on
        os.kill(os.getpid(), signal.SIGINT)
real = check.check_all
def interrupted(*arguments):
    Interrupted()
    return real(*arguments)
check.check_all = interrupted
main()
"""
"""It calls ``deros`` with its arguments; the signal comes as the checks begin, in a destructor."""
