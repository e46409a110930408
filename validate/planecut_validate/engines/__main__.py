"""usage: validate/run --engines [--planecut BIN]

Has `planecut coarsen` write rigid bodies, and sees that MuJoCo, PyBullet and USD's library load them, hold the mass, the colliders and the boxes that the report
tells of, and that the bodies come to rest on the ground. Exit status 1 on any difference.
"""

import argparse
import pathlib
import sys
import tempfile
import time

from . import in_bullet, in_mujoco, in_usd
from .body import check_report, write
from .shapes import ROOT, shapes


def main() -> int:
    parser = argparse.ArgumentParser(prog="validate/run --engines", description=__doc__)
    parser.add_argument("--planecut", default=str(ROOT / "target" / "release" / "planecut"), help="the program")
    arguments = parser.parse_args()
    failed, begin = 0, time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        found, absent = shapes(pathlib.Path(folder))
        for number, shape in enumerate(found):
            own = pathlib.Path(folder) / str(number)
            for threads in ("1", "2"):
                (own / threads).mkdir(parents=True)
            try:
                body = write(arguments.planecut, shape, own)
            except Exception as error:  # the others are checked all the same
                failed += 1
                print(f"{shape.name:16} planecut FAILED: {type(error).__name__} {error}")
                continue
            for name, check in (("report", check_report), ("MuJoCo", in_mujoco.check), ("Bullet", in_bullet.check), ("USD", in_usd.check)):
                try:
                    print(f"{shape.name:16} {name:8} {check(body) or 'as expected'}")
                except Exception as error:  # an engine that refuses a file has exceptions of its own
                    failed += 1
                    print(f"{shape.name:16} {name:8} FAILED: {type(error).__name__} {error}")
    for file in absent:
        print(f"{file} is absent: not checked")
    print(f"engines: {failed} failed" if failed else f"engines: all passed ({time.monotonic() - begin:.0f} s)")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
