"""`python -m planecut` is the command `planecut`."""

from ._command import main

main()
