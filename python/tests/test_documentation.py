"""Docstrings are complete and right, and the types that are declared are those that there are."""

from __future__ import annotations

import ast
import doctest
import importlib.util
import inspect
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import planecut as pc
import pytest
from planecut import _planecut

PACKAGE = Path(pc.__file__).parent
STUB = PACKAGE / "_planecut.pyi"
ARRAYS_IN = {"ArrayLike", "_Outline", "_Hull", "_MeshObject"}
MODULES = [pc, pc.batch, pc.blocks, pc.compat, _planecut]

REFERS = "as by `Solid.render`"
"""Says where the rest of a docstring is."""

needs_mypy = pytest.mark.skipif(importlib.util.find_spec("mypy") is None, reason="mypy is absent")


def public_members(cls: type) -> Iterator[tuple[str, object]]:
    """What a class itself defines under a public name."""
    yield from ((f"{cls.__name__}.{name}", value) for name, value in vars(cls).items() if not name.startswith("_"))


def documented() -> dict[str, object]:
    """All public names with what they stand for, members of classes too."""
    found: dict[str, object] = {}
    for module in MODULES:
        for name in module.__all__:
            value = getattr(module, name)
            if isinstance(value, str) or inspect.ismodule(value):
                continue
            found[name] = value
            if isinstance(value, type):
                found.update(public_members(value))
    for name in ("PlanecutError.path", "PlanecutError.line", "PlanecutError.json_path"):
        found.pop(name)  # attributes, told by the class
    return found


def stub_functions() -> Iterator[tuple[str, ast.FunctionDef]]:
    """The functions and methods of the stub; a class that is called counts as its own name."""
    for node in ast.parse(STUB.read_text()).body:
        if isinstance(node, ast.FunctionDef):
            yield node.name, node
        if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
            for member in node.body:
                if isinstance(member, ast.FunctionDef) and (member.name == "__new__" or not member.name.startswith("_")):
                    yield node.name if member.name == "__new__" else f"{node.name}.{member.name}", member


def names_in(node: ast.AST | None) -> set[str]:
    return {part.id for part in ast.walk(node) if isinstance(part, ast.Name)} if node is not None else set()


def test_every_public_name_has_a_docstring():
    missing = [name for name, value in documented().items() if not (value.__doc__ or "").strip()]
    assert missing == []
    assert all((module.__doc__ or "").strip() for module in MODULES)


def test_docstrings_of_classes_are_their_own():
    for name in pc.__all__:
        value = getattr(pc, name)
        if isinstance(value, type):
            assert value.__doc__ not in {base.__doc__ for base in value.__mro__[1:]}, name


def test_docstrings_tell_the_shapes_of_arrays_that_come_in():
    docs, missing = documented(), []
    for name, function in stub_functions():
        arguments = [*function.args.posonlyargs, *function.args.args, *function.args.kwonlyargs]
        taken = [argument.arg for argument in arguments if names_in(argument.annotation) & ARRAYS_IN]
        doc = docs[name].__doc__ or ""
        # a number for each axis, and an outline as it is told for another function
        if taken and "shape" not in doc.lower() and "for each axis" not in doc and "As for `extrude`" not in doc:
            missing.append((name, taken))
    assert missing == []


def test_docstrings_tell_the_shapes_of_arrays_that_leave():
    docs, missing = documented(), []
    for name, function in stub_functions():
        if "NDArray" in names_in(function.returns) and not any(word in (docs[name].__doc__ or "") for word in ("shape", "Shape", REFERS)):
            missing.append(name)
    assert missing == []


def test_docstrings_tell_of_each_argument_of_functions():
    docs, missing = documented(), []
    for name, function in stub_functions():
        doc = docs[name].__doc__ or ""
        if "Args:" not in doc or REFERS in doc:
            continue
        arguments = [argument.arg for argument in [*function.args.args, *function.args.kwonlyargs] if argument.arg not in ("self", "cls")]
        missing += [f"{name}({argument})" for argument in arguments if f"{argument}:" not in doc and argument != "threads" and argument != "progress"]
    assert missing == []


def examples() -> list[doctest.DocTest]:
    parser, found = doctest.DocTestParser(), []
    texts = {name: value.__doc__ for name, value in documented().items()} | {module.__name__: module.__doc__ for module in MODULES}
    for name, text in texts.items():
        test = parser.get_doctest(inspect.cleandoc(text or ""), {}, name, None, None)
        if test.examples:
            found.append(test)
    return found


@pytest.mark.parametrize("test", examples(), ids=lambda test: test.name)
def test_examples_in_docstrings_give_what_they_say(test):
    output: list[str] = []
    result = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS).run(test, out=output.append)
    assert result.attempted > 0 and result.failed == 0, "".join(output)


def test_there_are_examples():
    assert {"box", "planecut", "coarsen", "from_mesh", "Live"} <= {test.name for test in examples()}


def test_signatures_can_be_asked_for():
    for name, value in documented().items():
        if callable(value) and not isinstance(value, type):
            assert inspect.signature(value) is not None, name


def test_classes_say_that_they_are_of_the_package():
    for name in pc.__all__:
        value = getattr(pc, name)
        if isinstance(value, type) and name != "View":
            assert value.__module__ == "planecut" and getattr(sys.modules["planecut"], value.__qualname__) is value


def test_all_that_is_of_rust_is_public_or_used():
    assert set(_planecut.__all__) - set(pc.__all__) - set(pc.blocks.__all__) == {"run_command"}
    assert set(dir(pc)) >= set(pc.__all__)


def test_the_errors_are_those_that_are_promised():
    assert issubclass(pc.PlanecutError, ValueError) and issubclass(pc.InternalError, RuntimeError)
    error = pc.PlanecutError("x")
    assert (error.path, error.line, error.json_path) == (None, None, None)
    for attribute in ("path", "line", "json_path"):
        assert attribute in (pc.PlanecutError.__doc__ or "")


# ---- types


def mypy(*arguments: str, folder: Path) -> str:
    """What mypy says; it must accept all."""
    done = subprocess.run([sys.executable, "-m", *arguments], capture_output=True, text=True, cwd=folder, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def cache(tmp_path_factory):
    """The option of mypy for what its runs share."""
    return f"--cache-dir={tmp_path_factory.mktemp('mypy')}"


def test_types_are_declared():
    assert (PACKAGE / "py.typed").exists() and STUB.exists()


@needs_mypy
def test_mypy_accepts_the_package(tmp_path, cache):
    # beside other installed packages mypy would look at those as well
    copy = shutil.copytree(PACKAGE, tmp_path / "planecut", ignore=shutil.ignore_patterns("*.so", "__pycache__"))
    assert "no issues" in mypy("mypy", "--strict", cache, str(copy), folder=tmp_path)


@needs_mypy
def test_the_stub_says_what_the_module_has(tmp_path):
    assert "no issues" in mypy("mypy.stubtest", "planecut", folder=tmp_path)


USE = '''
from collections.abc import Callable
from pathlib import Path
from typing import assert_type
import numpy as np
from numpy.typing import NDArray
import planecut as pc

a = pc.box([0, 0, 0], (40, 20, 10), material="steel")
b = pc.cylinder(height=20, radius=2.5, top_radius=None, segments=48)
h = pc.halfspaces([[1, 0, 0, 5.0]])
k = pc.hull(np.zeros((4, 3), dtype=np.float32))
e = pc.extrude([np.zeros((3, 2))], 3, twist=0, scale=(1, 2))
r = pc.revolve([[1, 0], [2, 0], [2, 1]], segments=64)
s = ((a | b) - k & h ^ e) | ~r
s = pc.union([s]) | pc.difference(a, (b,)) | pc.intersection(x for x in (a, b))
s = s.translate([1, 2, 3]).rotate("x", 90).rotate([0, 0, 1], 45.0).scale(2).scale([1, 2, 3]).transform(np.eye(4)).mirror([1, 0, 0])
assert_type(s, pc.Solid)
assert_type(s.volume, float)
assert_type(s.bounds, NDArray[np.float64])
assert_type(s.contains([[0, 0, 0]]), NDArray[np.bool_])
assert_type(s.ray_cast(np.zeros((3, 3)), [[1, 0, 0]]), NDArray[np.float64])
mesh = s.mesh(threads=2, progress=lambda done, total: print(done / total))
assert_type(mesh.triangles, NDArray[np.uint32])
assert_type(mesh.materials, list[str])
assert_type(pc.load(Path("model.json"), width=60), pc.Solid)
s.save("x.glb", scale=2.0)
mesh.save(Path("x.obj"))
assert_type(s.render(size=(640, 480), style="shaded"), NDArray[np.uint8])
for cell in s.cells():
    assert_type(cell.planes, NDArray[np.float64])
hulls = pc.coarsen(s, max_cells=16, max_excess=None, keep_clear=a, engine="mujoco")
hulls = pc.coarsen([(cell.vertices, cell.triangles) for cell in hulls.cells], 2)
hulls = pc.coarsen([cell.vertices for cell in hulls.cells], 2)
hulls = pc.coarsen(list(hulls.cells), 2)
assert_type(hulls.encloses, bool)
p = pc.Polytope()
p.remove_plane(p.add_plane([1, 0, 0, 1]))
live = pc.Live(s)
with live.edit() as edit:
    edit.move_plane(live.brushes[0], 0, 2.0)
    number = edit.add_brush(a, role="subtract")
    edit.transform_brush(number, np.eye(4))
    assert_type(edit.copy_brushes([number], np.eye(4)), list[int])
    node = edit.wrap([0, number], "xor")
    assert_type(node, pc.Node)
    edit.set_role(node, "add")
    edit.move_operand(live.brushes[0], to=node, before=number)
for part in live.tree:
    if "node" in part:
        assert_type(part["node"], pc.Node)
        edit.dissolve(part["node"])
    else:
        assert_type(part["brush"], int)
preview = live.preview.wrap([0, node], "difference")
assert_type(preview.volume_change, float)
assert_type([face.material for face in preview.added], list[str])
piece = live.preview_remove_plane(0, 0)
if piece is not None and piece != "unbounded":
    assert_type(piece, pc.Cell)
assert_type(live.change.removed, list[int])
assert_type(live.pick([0, 0, 0], [1, 0, 0]), tuple[int, float] | None)
plan = pc.blocks.plan((s for _ in range(3)), Path("blocks"), brushes=100)
plan = pc.blocks.plan("model.json", "blocks", allow_loss=True, width=60)
assert_type(plan.blocks[0].place, tuple[int, int, int])
pieces = plan.evaluate("ray", workers=4, address="auto", progress=lambda done, total: None)
assert_type(pieces, pc.blocks.Pieces)
assert_type(list(pieces), list[pc.Mesh])
pieces.save("x.glb", scale=2.0)
assert_type(pc.blocks.evaluate_block(plan.blocks[0].path.read_bytes()), bytes)
try:
    pc.from_mesh([[0, 0, 0]], [[0, 0, 0]])
except pc.PlanecutError as error:
    assert_type(error.line, int | None)
'''
MISUSE = ["a | 3", "s.mesh(2)", "s.volume()", "pc.coarsen(3)", "edit.add_brush(a, role='paint')", "edit.dissolve(0)", "edit.wrap([0], 'glue')", "edit.remove_brush(node)", "live.tree[0]['name']", "s.render(style='pretty')", "hulls.excess = 1.0", "pc.Solid(1)", "plan.evaluate('spark')", "pc.blocks.plan([3], 'blocks')"]


@needs_mypy
def test_programs_that_use_the_package_are_checked(tmp_path, cache):
    good, bad = tmp_path / "good.py", tmp_path / "bad.py"
    good.write_text(USE.replace("from typing import assert_type", "from typing_extensions import assert_type"))
    assert "no issues" in mypy("mypy", "--strict", cache, str(good), folder=tmp_path)
    bad.write_text(good.read_text() + "\n".join(MISUSE))
    done = subprocess.run([sys.executable, "-m", "mypy", "--strict", cache, str(bad)], capture_output=True, text=True, cwd=tmp_path)
    first = len(good.read_text().splitlines())
    wrong = {int(line.split(":")[1]) - first for line in done.stdout.splitlines() if ": error:" in line}
    assert wrong == set(range(1, len(MISUSE) + 1)), done.stdout
