"""manifold3d's side of `bench/csg`: reads a scene, says so, and answers each line of standard input with one run.

What the clock sees are the Booleans and what forces their evaluation; convex bodies are manifolds before it starts. Bodies without
half-spaces are meshes: of these manifolds are made of arrays, and moved, on the clock.
"""

import json
import os
import sys
import time

# Before the import: the thread pool is made for the cores that the process may use then.
if "RAYON_NUM_THREADS" in os.environ:
    os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[: int(os.environ["RAYON_NUM_THREADS"])])

import manifold3d
import numpy as np
from manifold3d import Manifold, Mesh64, OpType

_OPERATIONS = {"union": OpType.Add, "difference": OpType.Subtract, "intersection": OpType.Intersect}


def main() -> None:
    # as for everybody: the allocator keeps what is freed, where a block as large as this was (`keep_freed_memory` of planecut)
    block = np.empty((32 << 20) - (1 << 16), dtype=np.uint8)
    del block
    try:
        bodies, plan = _begun(*_read(sys.argv[1]))
    except (RuntimeError, ValueError) as error:
        print(json.dumps({"Err": str(error)}), flush=True)
        return
    print('"Ready"', flush=True)
    for _ in sys.stdin:
        try:
            answer = {"Ok": _run(bodies, plan)}
        except (RuntimeError, ValueError, IndexError) as error:
            answer = {"Err": str(error)}
        print(json.dumps(answer), flush=True)


class _Mesh:
    """Arrays that become a manifold on the clock."""

    def __init__(self, positions: np.ndarray, triangles: np.ndarray, matrix: list | None) -> None:
        self._arrays = positions, triangles
        self._matrix = None if matrix is None else np.array(matrix)

    def manifold(self) -> Manifold:
        body = _sound(Manifold(Mesh64(*self._arrays)))
        return body if self._matrix is None else body.transform(self._matrix)


def _sound(body: Manifold) -> Manifold:
    if body.status() != manifold3d.Error.NoError:
        raise RuntimeError(f"a body is refused: {body.status()}")
    return body


def _read(path: str) -> tuple[list[Manifold | _Mesh], dict]:
    with open(path, "rb") as file:
        header = json.loads(file.readline())
        sizes = np.array(header["bodies"]).reshape(-1, 3)
        np.fromfile(file, "<f8", 4 * int(sizes[:, 0].sum()))
        positions = np.fromfile(file, "<f8", 3 * int(sizes[:, 1].sum())).reshape(-1, 3)
        triangles = np.fromfile(file, "<u4", 3 * int(sizes[:, 2].sum())).reshape(-1, 3)
    bodies = []
    at, first = 0, 0
    for (planes, corners, count), matrix in zip(sizes, header["matrices"]):
        arrays = positions[at : at + corners], triangles[first : first + count].astype(np.uint64)
        if planes:
            body = _sound(Manifold(Mesh64(*arrays)))
            body.num_tri()
            bodies.append(body)
        else:
            bodies.append(_Mesh(*arrays, matrix))
        at, first = at + corners, first + count
    return bodies, header["plan"]


def _begun(bodies: list[Manifold | _Mesh], plan: dict) -> tuple[list[Manifold | _Mesh], dict]:
    """With all that is there before the clock starts: where the first bodies are united, their union takes their place."""
    if "cuts" not in plan:
        return bodies, plan
    model = Manifold.batch_boolean(bodies[: plan["cuts"]], OpType.Add)
    model.num_tri()
    bodies = [_sound(model), *bodies[plan["cuts"] :]]
    return bodies, {"steps": [["add", 0], *(["subtract", tool] for tool in range(1, len(bodies)))]}


def _run(bodies: list[Manifold | _Mesh], plan: dict) -> dict:
    begin = time.perf_counter()
    bodies = [body.manifold() if isinstance(body, _Mesh) else body for body in bodies]
    if "tree" in plan:
        result = _tree(bodies, plan["tree"])
    elif "moves" in plan:
        result = _moves(bodies, plan["moves"])
    else:
        result = _steps(bodies, plan["steps"])
    triangles = result.num_tri()
    seconds = time.perf_counter() - begin
    if result.status() != manifold3d.Error.NoError:
        raise RuntimeError(str(result.status()))
    return {"seconds": seconds, "volume": result.volume(), "area": result.surface_area(), "triangles": triangles}


def _steps(bodies: list[Manifold], steps: list) -> Manifold:
    result = Manifold()
    for action, body in steps:
        result = result + bodies[body] if action == "add" else result - bodies[body]
        # forces the evaluation
        result.num_tri()
    return result


def _moves(bodies: list[Manifold], count: int) -> Manifold:
    result = Manifold()
    for form in bodies[count:]:
        result = Manifold.batch_boolean([form, *bodies[1:count]], manifold3d.OpType.Add)
        # forces the evaluation
        result.num_tri()
    return result


def _tree(bodies: list[Manifold], entries: list) -> Manifold:
    leaves = iter(bodies)
    stack: list[Manifold] = []
    for entry in entries:
        if entry == "leaf":
            stack.append(next(leaves))
            continue
        ((operation, count),) = entry.items()
        operands = stack[len(stack) - count :]
        del stack[len(stack) - count :]
        stack.append(Manifold.batch_boolean(operands, _OPERATIONS[operation]))
    return stack.pop()


if __name__ == "__main__":
    main()
