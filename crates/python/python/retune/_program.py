"""The command line ``retune``, as the wheel installs it."""

import signal
import sys

from retune._core import program


def main() -> int:
    """Run the program with the words of the command line; its exit code."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C ends the program, as it does without Python
    return program(sys.argv)
