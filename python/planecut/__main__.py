"""`python -m planecut` is the command `planecut`."""

from ._command import main

if __name__ == "__main__":
    main()
