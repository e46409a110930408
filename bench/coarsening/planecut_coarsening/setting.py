"""What all parts of the benchmark are given, and the row that two of them give back."""

from dataclasses import dataclass, field
from pathlib import Path

from .bodies import Body
from .entrant import Failed, Run, planecut
from .measure import Measure, Reference, measure, union


@dataclass
class Setting:
    """The program, the example `fewer_faces`, the data, a folder for what is written on the way, and what has gone wrong so far."""

    binary: Path
    lower: Path
    data: Path
    quick: bool
    scratch: Path
    failures: list[str] = field(default_factory=list)

    def fail(self, message: str) -> None:
        """Something that makes the exit status 1."""
        print(f"FAIL {message}", flush=True)
        self.failures.append(message)


@dataclass(frozen=True)
class Row:
    """One result: of which input, by whom, with how many cells asked for.

    `difference`: relative, from the volume that planecut reports to the one that manifold3d finds in the triangles as
    they are written.
    """

    input: str
    entrant: str
    settings: str
    asked: int
    measure: Measure
    seconds: float | None = None
    difference: float | None = None

    def told(self) -> str:
        """The row in a line."""
        found = self.measure
        seconds = "" if self.seconds is None else f" {self.seconds:.2f} s"
        return (
            f"{self.input:<20} {self.entrant:<9} {self.asked:>3} {found.cells:>3} cells "
            f"{100 * found.union_excess:8.2f} % {100 * found.sum_excess:8.2f} % missing {found.missing:.1e} "
            f"outside {found.outside:>4} {found.farthest:.1e}{seconds} {self.settings}"
        )


def row_of(name: str, entrant: str, settings: str, asked: int, run: Run, reference: Reference) -> Row:
    """A run, measured."""
    difference = None
    if run.report:
        written = union([body.solid() for body in run.bodies]).volume()
        difference = written / run.report["volume_out"] - 1.0
    found = measure(run.bodies, reference)
    return _told(Row(name, entrant, settings, asked, found, run.seconds, difference))


def planecut_rows(setting: Setting, name: str, path: Path, cap: int, reference: Reference) -> list[Row]:
    """planecut's run on a file with a maximum number of cells, measured and checked; nothing where it failed."""
    try:
        run = planecut(setting.binary, path, setting.scratch, "--max-cells", str(cap))
        row = row_of(name, "planecut", "", cap, run, reference)
    except (Failed, ValueError) as error:
        setting.fail(f"{name} at {cap}: {error}")
        return []
    if row.measure.cells > row.asked or row.measure.cells < 1:
        setting.fail(f"{row.input}: {row.measure.cells} cells where {row.asked} were asked for")
    return [row]


def row_of_bodies(name: str, entrant: str, bodies: list[Body], reference: Reference) -> Row:
    """Bodies that were made without a clock, measured."""
    return _told(Row(name, entrant, "", len(bodies), measure(bodies, reference)))


def _told(row: Row) -> Row:
    print(row.told(), flush=True)
    return row
