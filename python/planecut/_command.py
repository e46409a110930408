"""The command `planecut`."""

import signal
import sys
from typing import NoReturn

from ._planecut import run_command


def main() -> NoReturn:
    """Runs the program on the arguments of the process, and ends the process with its exit status."""
    # without Python between, Ctrl-C ends the program at once
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(run_command(["planecut", *sys.argv[1:]]))
