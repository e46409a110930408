"""Runs of the program, with the memory that they took."""

import json
import os
import resource
import subprocess
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

TIMEOUT = 900
"""Seconds after which a run counts as hung."""

CUBE = {"planecut": 1, "model": {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}}


class Refused(Exception):
    """The arguments or the input are none that planecut takes (exit status 2), or it cannot do the job (1)."""

    def __init__(self, status: int, message: str) -> None:
        super().__init__(f"exit status {status}: {message}")
        self.status = status


@dataclass(frozen=True)
class Run:
    """What a run says and took; `memory` is the most that it held at once, in bytes."""

    said: str
    seconds: float
    memory: int


@dataclass(frozen=True)
class Planecut:
    """The program."""

    binary: Path

    def run(self, *words: str | Path) -> Run:
        """Raises `Refused` where the exit status is 1 or 2, `RuntimeError` where it is none that planecut promises."""
        begin = time.perf_counter()
        with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as err:
            process = subprocess.Popen([str(word) for word in (self.binary, *words)], stdout=out, stderr=err)
            status, usage = _wait(process)
            seconds = time.perf_counter() - begin
            out.seek(0)
            err.seek(0)
            said, complaint = out.read(), _error_line(err.read())
        if status in (1, 2):
            raise Refused(status, complaint)
        # 3: written, with something left out
        if status not in (0, 3):
            raise RuntimeError(f"planecut ended with exit status {status}: {complaint}")
        return Run(said, seconds, usage.ru_maxrss * 1024)

    def build(self, source: Path, outputs: list[Path], *options: str | Path) -> tuple[dict, Run]:
        """The report of a build, and the run."""
        report = outputs[0].with_name(outputs[0].name + ".report.json")
        named = [word for output in outputs for word in ("-o", output)]
        run = self.run("build", source, *named, "--report", report, "--quiet", *options)
        return json.loads(report.read_text(encoding="utf-8")), run

    def render(self, source: Path, picture: Path, size: tuple[int, int]) -> None:
        """A picture as previews are."""
        self.run("render", source, "-o", picture, "--size", "{}x{}".format(*size), "--quiet")

    def info(self, source: Path) -> dict:
        """The report of `info`."""
        return json.loads(self.run("info", source, "--quiet").said)

    def accepts(self, ending: str, *options: str) -> bool:
        """Whether a cube can be written under such a name with these options."""
        with tempfile.TemporaryDirectory() as folder:
            source = Path(folder, "cube.json")
            source.write_text(json.dumps(CUBE), encoding="utf-8")
            try:
                self.build(source, [Path(folder, f"cube.{ending}")], *options)
            except Refused as refused:
                if refused.status == 2:
                    return False
                raise
        return True


def _wait(process: subprocess.Popen) -> tuple[int, resource.struct_rusage]:
    """The exit status and what the process took; ends it where it hangs."""
    deadline = time.monotonic() + TIMEOUT
    pause = 0.001
    while True:
        pid, status, usage = os.wait4(process.pid, os.WNOHANG)
        if pid:
            process.returncode = os.waitstatus_to_exitcode(status)
            return process.returncode, usage
        if time.monotonic() > deadline:
            process.kill()
        time.sleep(pause)
        pause = min(2.0 * pause, 0.05)


def _error_line(said: str) -> str:
    lines = said.strip().splitlines()
    return next((line for line in lines if line.startswith("error:")), lines[-1] if lines else "")
