"""The tree of a live model: after each edit it is that of a fresh solid, and previews say what edits do."""

from __future__ import annotations

import pickle
from collections import Counter
from collections.abc import Callable
from copy import deepcopy
from dataclasses import dataclass, field
from functools import reduce

import numpy as np
import planecut as pc
import pytest
from oracles import assert_refused, generator, mesh_volume

ROLES = ["add", "subtract", "intersect"]
OPERATIONS = ["union", "intersection", "difference", "xor", "complement"]

Operand = int | pc.Node


def is_node(operand: Operand) -> bool:
    return isinstance(operand, pc.Node)


def combined(operation: str, solids: list[pc.Solid]) -> pc.Solid:
    match operation:
        case "intersection":
            # of nothing it is all of space
            return pc.intersection(solids) if solids else ~pc.union([])
        case "difference":
            return pc.difference(solids[0], solids[1:]) if solids else pc.union([])
        case "xor":
            return reduce(lambda a, b: a ^ b, solids, pc.union([]))
        case "complement":
            return ~pc.union(solids)
        case _:
            return pc.union(solids)


@dataclass
class Known:
    """What the test itself knows of a model."""

    parts: list[Operand] = field(default_factory=list)
    nodes: dict[pc.Node, tuple[str, list[Operand]]] = field(default_factory=dict)
    roles: dict[Operand, str] = field(default_factory=dict)
    bodies: dict[int, pc.Solid] = field(default_factory=dict)

    def parent(self, operand: Operand) -> pc.Node | None:
        return next((node for node, (_, operands) in self.nodes.items() if operand in operands), None)

    def operands(self, parent: pc.Node | None) -> list[Operand]:
        return self.parts if parent is None else self.nodes[parent][1]

    def siblings(self, operand: Operand) -> list[Operand]:
        return self.operands(self.parent(operand))

    def below(self, operand: Operand) -> list[Operand]:
        inner = self.nodes[operand][1] if is_node(operand) else []
        return [operand, *(other for child in inner for other in self.below(child))]

    def solid_of(self, operand: Operand) -> pc.Solid:
        if not is_node(operand):
            return self.bodies[operand]
        operation, operands = self.nodes[operand]
        return combined(operation, [self.solid_of(inner) for inner in operands])

    def solid(self) -> pc.Solid:
        """A fresh solid of the same operations."""
        solid = pc.union([])
        for part in self.parts:
            other = self.solid_of(part)
            match self.roles[part]:
                case "add":
                    solid = pc.union([solid, other])
                case "subtract":
                    solid = pc.difference(solid, [other])
                case "intersect":
                    solid = pc.intersection([solid, other])
        return solid

    def tree(self) -> list[dict]:
        def entry(operand: Operand) -> dict:
            if not is_node(operand):
                return {"brush": operand}
            operation, operands = self.nodes[operand]
            return {"node": operand, "operation": operation, "operands": [entry(inner) for inner in operands]}

        return [entry(part) | {"role": self.roles[part]} for part in self.parts]

    def forget(self, operand: Operand) -> None:
        for gone in self.below(operand):
            self.roles.pop(gone)
            (self.nodes if is_node(gone) else self.bodies).pop(gone)


def triangles_of(mesh: pc.Mesh) -> Counter:
    """The triangles of a mesh with their materials, in any order."""
    corners = mesh.vertices[mesh.triangles].reshape(-1, 9)
    return Counter((row.tobytes(), mesh.materials[material]) for row, material in zip(corners, mesh.material_ids, strict=True))


def assert_is(live: pc.Live, known: Known) -> None:
    """The tree, the mesh and the volume are those of a fresh solid of the same operations."""
    assert live.tree == known.tree()
    fresh = known.solid()
    found, expected = live.mesh(), fresh.mesh()
    assert found.vertices.tobytes() == expected.vertices.tobytes()
    assert triangles_of(found) == triangles_of(expected)
    assert live.volume == pytest.approx(fresh.volume, rel=1e-9, abs=1e-9)


def seen(live: pc.Live) -> tuple:
    """All that can be seen of a model."""
    faces = [(number, face_of(face := live.face(number)), face.brush, face.plane) for number in live.faces.tolist()]
    brushes = {int(brush): (live.role(brush), tuple(live.planes(brush).items())) for brush in live.brushes}
    change = live.change
    return faces, brushes, live.tree, live.volume, live.mesh().materials, (change.removed, change.added, change.brushes)


def face_of(face: pc.Face) -> tuple:
    return face.material, face.normal.tobytes(), face.vertices.tobytes(), face.triangles.tobytes()


def history(live: pc.Live) -> tuple[list, list]:
    """The meshes of all steps that can be undone, and done again; the model is as before."""
    copies: tuple[list, list] = ([], [])
    back = 0
    for _ in iter(lambda: can(live.redo), False):
        copies[1].append(live.mesh().vertices.tobytes())
        back += 1
    for _ in range(back):
        live.undo()
    back = 0
    for _ in iter(lambda: can(live.undo), False):
        copies[0].append(live.mesh().vertices.tobytes())
        back += 1
    for _ in range(back):
        live.redo()
    return copies


def can(work: Callable[[], None]) -> bool:
    try:
        work()
    except pc.PlanecutError:
        return False
    return True


def some_box(rng: np.random.Generator) -> pc.Solid:
    low = rng.integers(0, 5, 3)
    return pc.box(low, low + rng.integers(1, 4, 3), str(rng.choice(["clay", "steel"])))


Call = Callable[[pc.Edit | pc.Previewer], object]


def random_call(rng: np.random.Generator, live: pc.Live, known: Known) -> tuple[Call, Callable[[object], None]]:
    """A call, and what it does to what is known once its result is."""
    everything = list(known.roles)
    nodes = list(known.nodes)
    what = int(rng.integers(9)) if len(everything) > 2 else 0
    operand = everything[int(rng.integers(len(everything)))] if everything else 0
    operation, role = str(rng.choice(OPERATIONS)), str(rng.choice(ROLES, p=[0.6, 0.3, 0.1]))
    if what == 0 or (what in (1, 2, 3) and not nodes):
        body = some_box(rng)
        role = role if role != "intersect" else "add"

        def added(number: object) -> None:
            known.bodies[number], known.roles[number] = body, role
            known.parts.append(number)

        return lambda e: e.add_brush(body, role), added
    node = nodes[int(rng.integers(len(nodes)))] if nodes else pc.Node(0)
    if what == 1:

        def set_operation(_: object) -> None:
            known.nodes[node] = operation, known.nodes[node][1]

        return lambda e: e.set_operation(node, operation), set_operation
    if what == 2:

        def dissolved(_: object) -> None:
            siblings, (kind, operands), own = known.siblings(node), known.nodes[node], known.roles[node]
            if siblings is known.parts:
                others = {"difference": "subtract", "intersection": "intersect"}.get(kind, own)
                known.roles.update(zip(operands, [own, *[others] * len(operands)]))
            place = siblings.index(node)
            siblings[place : place + 1] = operands
            known.nodes[node] = kind, []
            known.forget(node)

        return lambda e: e.dissolve(node), dissolved
    if what == 3:

        def removed(_: object) -> None:
            parent, siblings = known.parent(node), known.siblings(node)
            place = siblings.index(node)
            del siblings[place]
            known.forget(node)
            kind = known.nodes[parent][0] if parent is not None else "union"
            if kind == "intersection" or (kind == "difference" and place == 0):
                # a union of nothing, the only operation that is not known
                nothing = next(iter(set(nodes_of(live)) - set(known.nodes)))
                siblings.insert(place, nothing)
                known.nodes[nothing], known.roles[nothing] = ("union", []), "add"

        return lambda e: e.remove_node(node), removed
    if what in (4, 5):
        if what == 4:
            target = [None, *(node for node in nodes if node not in known.below(operand))]
            to = target[int(rng.integers(len(target)))]
            others = [other for other in known.operands(to) if other != operand]
            before = [None, *others][int(rng.integers(len(others) + 1))]
        else:
            operand, before = (int(number) for number in rng.permutation(list(known.bodies))[:2])
            to = known.parent(before)
        siblings = known.operands(to)
        at = len(siblings) if before is None else siblings.index(before)
        # to move it to where it is would be a step without a difference
        if siblings is not known.siblings(operand) or at - siblings.index(operand) not in (0, 1):

            def moved(_: object) -> None:
                known.siblings(operand).remove(operand)
                siblings.insert(len(siblings) if before is None else siblings.index(before), operand)

            if what == 5:
                return lambda e: e.move_brush_before(operand, before), moved
            return lambda e: e.move_operand(operand, to, before), moved
    if what == 6:
        part = known.parts[int(rng.integers(len(known.parts)))]

        def set_role(_: object) -> None:
            known.roles[part] = role

        return lambda e: e.set_role(part, role), set_role
    siblings = known.siblings(operand)
    chosen = [other for other in siblings if other == operand or rng.random() < 0.4]

    def wrapped(node: object) -> None:
        place = siblings.index(chosen[0])
        siblings[:] = [other for other in siblings if other not in chosen]
        siblings.insert(place, node)
        known.nodes[node], known.roles[node] = (operation, chosen), known.roles[chosen[0]]

    # in which order they are named does not matter
    return lambda e: e.wrap(chosen[::-1], operation), wrapped


def nodes_of(live: pc.Live) -> list[pc.Node]:
    rest, found = list(live.tree), []
    while rest:
        part = rest.pop()
        if "node" in part:
            found.append(part["node"])
            rest += part["operands"]
    return found


@pytest.mark.parametrize("case", range(12))
def test_random_edits_of_the_tree_give_a_fresh_solid_and_previews_tell_them(case: int) -> None:
    rng = generator(case)
    live, known = pc.Live(pc.union([])), Known()
    states, refused, names = [deepcopy(known)], 0, Counter()
    for _ in range(25):
        call, told = random_call(rng, live, known)
        before, volume = seen(live), live.volume
        try:
            preview = call(live.preview)
        except pc.PlanecutError as error:
            preview = error
        assert seen(live) == before, "a preview changes nothing"
        try:
            with live.edit() as e:
                result = call(e)
        except pc.PlanecutError as error:
            # such as a complement that reaches infinity
            refused += 1
            assert isinstance(preview, pc.PlanecutError) and str(preview) == str(error)
            assert seen(live) == before
            continue
        told(result)
        assert_is(live, known)
        change = live.change
        assert (sorted(preview.removed), preview.brushes) == (sorted(change.removed), change.brushes)
        assert Counter(map(face_of, preview.added)) == Counter(face_of(live.face(number)) for number in change.added)
        assert preview.volume_change == pytest.approx(live.volume - volume, abs=1e-9)
        names[bool(change.removed or change.added)] += 1
        if live.tree != states[-1].tree():
            states.append(deepcopy(known))
    print(f"{len(states) - 1} steps, {refused} refused, {names[True]} of {names.total()} changed faces")
    assert len(states) > 8 and names[True] > 4
    for expected in states[-2::-1]:
        live.undo()
        assert_is(live, expected)
    assert_refused(live.undo, pc.PlanecutError)
    for expected in states[1:]:
        live.redo()
        assert_is(live, expected)


def blocks() -> list[pc.Solid]:
    return [pc.box([k, 0, 0], [k + 2, 1, 1], material) for k, material in enumerate(["clay", "steel", "brass", "clay"])]


def test_the_tree_of_a_solid_is_read() -> None:
    a, b, c, d = blocks()
    live = pc.Live((a - (b ^ c)) | d)
    assert live.tree == [
        {"brush": 0, "role": "add"},
        {"node": pc.Node(0), "operation": "xor", "operands": [{"brush": 1}, {"brush": 2}], "role": "subtract"},
        {"brush": 3, "role": "add"},
    ]
    tree = live.tree
    tree[1]["operands"].clear()
    tree.clear()
    assert len(live.tree) == 3 and len(live.tree[1]["operands"]) == 2, "it is a copy"
    assert pc.Live(pc.union([])).tree == []


def test_a_deep_tree_is_read() -> None:
    depth = 3000
    live, node = pc.Live(pc.box([0, 0, 0], [1, 1, 1])), 0
    with live.edit() as e:
        for _ in range(depth):
            node = e.wrap([node], "union")
    inner, found = live.tree[0], []
    while "node" in inner:
        found.append(inner["node"].number)
        (inner,) = inner["operands"]
    assert inner == {"brush": 0} and found == list(range(depth))[::-1]


@pytest.mark.parametrize("operation", OPERATIONS)
def test_each_operation_is_what_its_operator_is(operation: str) -> None:
    a, b, c, d = blocks()
    frame = pc.box([-1, -1, -1], [9, 2, 2], "clay")
    live = pc.Live(pc.union([frame, a, b, c, d]))
    with live.edit() as e:
        # within a frame, so that a complement is bounded
        e.set_role(1, "intersect")
        node = e.wrap([1, 2, 3], operation)
    wanted = {
        "union": a | b | c,
        "intersection": a & b & c,
        "difference": a - b - c,
        "xor": a ^ b ^ c,
        "complement": ~(a | b | c),
    }[operation]
    expected = (frame & wanted) | d
    assert node == pc.Node(0) and live.volume == expected.volume
    assert triangles_of(live.mesh()) == triangles_of(expected.mesh())


def test_what_is_wrapped_and_dissolved_again_is_as_before() -> None:
    a, b, c, d = blocks()
    live = pc.Live(pc.union([a, b, c, d]))
    mesh = live.mesh().vertices.tobytes()
    with live.edit() as e:
        node = e.wrap([1, 2], "intersection")
    assert live.volume == pc.union([a, b & c, d]).volume == 5.0
    with live.edit() as e:
        e.dissolve(node)
    assert [live.role(brush) for brush in live.brushes] == ["add", "add", "intersect", "add"]
    live.undo()
    live.undo()
    assert live.mesh().vertices.tobytes() == mesh and live.tree == [{"brush": k, "role": "add"} for k in range(4)]


def test_calls_of_one_edit_are_one_step_and_an_exception_takes_all_back() -> None:
    a, b, c, d = blocks()
    live = pc.Live(pc.union([a, b, c, d]))
    before = live.tree, live.volume, triangles_of(live.mesh())
    with live.edit() as e:
        first = e.wrap([0, 1], "xor")
        second = e.wrap([first, 2], "difference")
        e.move_operand(3, to=second, before=2)
        assert live.tree == [
            {
                "node": second,
                "operation": "difference",
                "operands": [
                    {"node": first, "operation": "xor", "operands": [{"brush": 0}, {"brush": 1}]},
                    {"brush": 3},
                    {"brush": 2},
                ],
                "role": "add",
            }
        ]
    assert live.volume == ((a ^ b) - d - c).volume == 1.0
    live.undo()
    assert (live.tree, live.volume, triangles_of(live.mesh())) == before
    with pytest.raises(RuntimeError):
        with live.edit() as e:
            e.remove_node(e.wrap([0, 1, 2], "union"))
            raise RuntimeError
    assert (live.tree, live.volume, triangles_of(live.mesh())) == before
    live.redo()
    assert live.volume == 1.0


def test_nodes_are_names() -> None:
    node = pc.Node(3)
    assert node == pc.Node(3) != pc.Node(4) and node.number == 3 and node != 3
    assert hash(node) == hash(pc.Node(3)) and len({node, pc.Node(3), pc.Node(4)}) == 2
    assert repr(node) == "planecut.Node(3)" and eval(repr(node), {"planecut": pc}) == node
    assert pickle.loads(pickle.dumps(node)) == node and pc.Node(np.int64(3)) == node
    for wrong in (-1, 2**64, "a", 1.5, None):
        assert_refused(lambda: pc.Node(wrong))
    for work in (lambda: setattr(node, "number", 4), lambda: node + 1, lambda: int(node)):
        assert_refused(work, AttributeError, TypeError)


REFUSED: dict[str, tuple[Call, str]] = {
    "wrap nothing": (lambda e: e.wrap([], "union"), "found none, expected at least one brush or operation"),
    "wrap twice": (lambda e: e.wrap([2, 2], "union"), "found brush 2 twice"),
    "wrap apart": (lambda e: e.wrap([0, 2], "union"), "expected operands of one operation"),
    "wrap a brush that is not there": (lambda e: e.wrap([2, 7], "union"), "found brush 7"),
    "wrap a node that is not there": (lambda e: e.wrap([pc.Node(7)], "union"), "found node 7"),
    "wrap a text": (lambda e: e.wrap(["a"], "union"), "operands: found an object of type str, expected the number of a brush or a Node"),
    "wrap half": (lambda e: e.wrap([0.5], "union"), "operands: found an object of type float"),
    "wrap a negative number": (lambda e: e.wrap([2, -1], "union"), "operands: found -1, expected"),
    "an operation that is none": (
        lambda e: e.wrap([2], "glue"),
        'operation: found "glue", expected "union", "intersection", "difference", "xor" or "complement"',
    ),
    "a complement of all": (lambda e: e.wrap([pc.Node(0), 2], "complement"), "infinity"),
    "set an operation that is none": (lambda e: e.set_operation(pc.Node(0), "Union"), 'operation: found "Union"'),
    "set no node": (lambda e: e.set_operation(pc.Node(7), "union"), "found node 7"),
    "dissolve no node": (lambda e: e.dissolve(pc.Node(7)), "found node 7"),
    "remove no node": (lambda e: e.remove_node(pc.Node(7)), "found node 7"),
    "move nothing": (lambda e: e.move_operand(7), "found brush 7"),
    "move to no node": (lambda e: e.move_operand(2, pc.Node(7)), "found node 7"),
    "move below itself": (lambda e: e.move_operand(pc.Node(0), pc.Node(0)), "found node 0 to be put below itself"),
    "move before what is elsewhere": (lambda e: e.move_operand(2, before=1), "found brush 1, expected an operand of the model itself"),
    "move before a text": (lambda e: e.move_operand(2, before="1"), "before: found an object of type str"),
    "move None": (lambda e: e.move_operand(None), "operand: found an object of type NoneType"),
    "order no brush": (lambda e: e.move_brush_before(7), "found brush 7"),
    "order before none": (lambda e: e.move_brush_before(0, 7), "found brush 7"),
    "a role within": (lambda e: e.set_role(1, "add"), "found brush 1 within nested operations"),
    "a role of no node": (lambda e: e.set_role(pc.Node(7), "add"), "found node 7"),
    "a role that is none": (lambda e: e.set_role(pc.Node(0), "paint"), 'role: found "paint"'),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_done_to_the_tree_is_refused(name: str) -> None:
    a, b, c, _ = blocks()
    call, message = REFUSED[name]
    live = pc.Live((a ^ b) | c)
    before = seen(live)

    def edit() -> None:
        with live.edit() as e:
            e.move_plane(2, 0, 9.0)
            call(e)

    for work in (edit, lambda: call(live.preview)):
        with pytest.raises(pc.PlanecutError) as error:
            work()
        assert message in str(error.value) and "\n" not in str(error.value)
        assert seen(live) == before
    assert_refused(live.undo, pc.PlanecutError)
    assert_refused(live.redo, pc.PlanecutError)


@pytest.mark.parametrize(
    "call",
    [
        lambda e: e.dissolve(0),
        lambda e: e.remove_node(0),
        lambda e: e.set_operation(0, "union"),
        lambda e: e.move_operand(2, 0),
        lambda e: e.move_operand(2, to=[pc.Node(0)]),
        lambda e: e.move_brush_before(pc.Node(0)),
        lambda e: e.move_brush_before(0, pc.Node(0)),
        lambda e: e.remove_brush(pc.Node(0)),
        lambda e: e.wrap(2, "union"),
        lambda e: e.wrap("2", "union"),
        lambda e: e.wrap([2], 3),
    ],
)
def test_brushes_and_nodes_are_not_taken_for_each_other(call: Call) -> None:
    a, b, c, _ = blocks()
    live = pc.Live((a ^ b) | c)
    before = seen(live)

    def edit() -> None:
        with live.edit() as e:
            call(e)

    assert_refused(edit, TypeError)
    assert_refused(lambda: call(live.preview), TypeError)
    assert seen(live) == before


# ---- previews

A = pc.box([1, 1, 1], [3, 3, 9], "gold")
CALLS: dict[str, Call] = {
    "move_plane": lambda e: e.move_plane(0, 0, 5.0),
    "turn_plane": lambda e: e.turn_plane(0, 0, [1, 0, 0.5, 4]),
    "set_material": lambda e: e.set_material(0, "gold"),
    "set_material of a plane": lambda e: e.set_material(0, "gold", plane=2),
    "rename_brush": lambda e: e.rename_brush(0, "block"),
    "copy_brushes": lambda e: e.copy_brushes([0], np.eye(4) + np.eye(4, k=3) * 6),
    "mirror_brushes": lambda e: e.mirror_brushes([0, 1], [1, 0, 0, 4]),
    "array_brushes": lambda e: e.array_brushes([1], np.eye(3, 4) + np.eye(3, 4, k=3) * 0.25, 3),
    "add_plane": lambda e: e.add_plane(0, [1, 1, 1, 10], "gold"),
    "remove_plane": lambda e: e.remove_plane(2, 6),
    "add_brush": lambda e: e.add_brush(A),
    "add_brush to subtract": lambda e: e.add_brush(A, role="subtract"),
    "remove_brush": lambda e: e.remove_brush(1),
    "replace_brush": lambda e: e.replace_brush(1, A),
    "transform_brush": lambda e: e.transform_brush(1, np.diag([1.0, 1.5, 2, 1])),
    "set_role": lambda e: e.set_role(2, "subtract"),
    "set_role of a node": lambda e: e.set_role(pc.Node(0), "subtract"),
    "set_operation": lambda e: e.set_operation(pc.Node(0), "intersection"),
    "wrap": lambda e: e.wrap([0, 1], "xor"),
    "dissolve": lambda e: e.dissolve(pc.Node(0)),
    "move_operand": lambda e: e.move_operand(3, before=0),
    "move_brush_before": lambda e: e.move_brush_before(0),
    "remove_node": lambda e: e.remove_node(pc.Node(0)),
}


def sample() -> pc.Live:
    """A block less another one, a body with a corner cut off, and two that exclude each other; one step to be undone, one to be done again."""
    block, hole = pc.box([0, 0, 0], [4, 4, 4], "clay"), pc.box([1, 1, 1], [2, 2, 5], "steel")
    cut = pc.box([3, 3, 3], [6, 6, 6], "brass")
    live = pc.Live(block - hole | cut | (pc.box([8, 0, 0], [10, 2, 2]) ^ pc.box([9, 1, 1], [11, 3, 3])))
    with live.edit() as e:
        e.add_plane(2, [1, 1, 1, 17])
    with live.edit() as e:
        e.move_plane(0, 0, 7.0)
    live.undo()
    return live


def test_there_is_a_preview_of_each_call_of_an_edit() -> None:
    calls = {name for name in dir(pc.Edit) if not name.startswith("_")}
    assert {name for name in dir(pc.Previewer) if not name.startswith("_")} == calls == {name.split()[0] for name in CALLS}


@pytest.mark.parametrize("name", CALLS)
def test_a_preview_tells_what_the_call_does_and_leaves_the_model_as_it_was(name: str) -> None:
    call, live = CALLS[name], sample()
    before, steps, volume = seen(live), history(live), live.volume
    assert (len(steps[0]), len(steps[1])) == (1, 1)
    before = seen(live)
    preview = call(live.preview)
    assert isinstance(preview, pc.Preview)
    assert seen(live) == before and history(live) == steps
    with live.edit() as e:
        call(e)
    change = live.change
    assert (sorted(preview.removed), preview.brushes) == (sorted(change.removed), change.brushes)
    assert Counter(map(face_of, preview.added)) == Counter(face_of(live.face(number)) for number in change.added)
    assert preview.volume_change == pytest.approx(live.volume - volume, abs=1e-9)
    if name != "rename_brush":
        assert change.added or change.removed, "there is something to tell"


def test_faces_of_a_preview_are_faces() -> None:
    live = pc.Live(pc.box([0, 0, 0], [2, 2, 2], "clay"))
    preview = live.preview.add_plane(0, [1, 1, 1, 5], "gold")
    assert preview.volume_change == pytest.approx(-1 / 6) and preview.brushes == [0]
    (face,) = (face for face in preview.added if face.material == "gold")
    np.testing.assert_allclose(face.normal, np.ones(3) / np.sqrt(3), rtol=1e-15)
    assert sorted(map(sorted, face.vertices.tolist())) == [[1, 2, 2]] * 3 and face.triangles.shape == (1, 3)
    assert (face.brush, face.plane) == (None, None) and not face.vertices.flags.writeable
    positions, normal, triangles = face.buffers([2, 2, 2])
    np.testing.assert_array_equal(positions, face.vertices - 2)
    assert live.mesh().materials == ["clay"], "a material that a preview names is not added"
    with pytest.raises(pc.PlanecutError), live.edit() as e:
        e.set_material(0, "gold", plane=77)
    assert live.mesh().materials == ["clay"], "nor one of an edit that is refused"


def test_a_preview_within_an_edit_is_of_the_model_as_it_is_then() -> None:
    live = pc.Live(pc.box([0, 0, 0], [2, 2, 2]))
    with live.edit() as e:
        e.move_plane(0, 0, 3.0)
        assert live.preview.move_plane(0, 0, 4.0).volume_change == pytest.approx(4.0)
        assert live.volume == 12.0
        e.move_plane(0, 0, 5.0)
    assert live.volume == 20.0
    live.undo()
    assert live.volume == 8.0
    assert_refused(live.undo, pc.PlanecutError)


def test_previews_stay_as_they_are_and_pickle() -> None:
    live = sample()
    preview = live.preview.wrap([0, 1], "union")
    parts = preview.volume_change, preview.brushes, preview.removed, [face_of(face) for face in preview.added]
    assert parts[2] and parts[3]
    with live.edit() as e:
        e.remove_brush(0)
    again = pickle.loads(pickle.dumps(preview))
    for other in (preview, again):
        assert (other.volume_change, other.brushes, other.removed, [face_of(face) for face in other.added]) == parts
    assert repr(again) == repr(preview) == f"<planecut.Preview: {len(parts[2])} faces removed, {len(parts[3])} added>"
    preview.removed.clear()
    preview.added.clear()
    assert (preview.removed, len(preview.added)) == (parts[2], len(parts[3]))
    with pytest.raises(TypeError, match="cannot pickle"):
        pickle.dumps(live.preview)
    for wrong in (lambda: pc.Preview(), lambda: pc.Previewer(), lambda: pc.Preview._unpickle(0.0, [], [], [3])):
        assert_refused(wrong)


def test_what_a_brush_gains_without_a_plane() -> None:
    live = pc.Live(pc.box([0, 0, 0], [1, 1, 1], "clay") | pc.box([0.5, 0.5, 0.5], [2, 2, 2]))
    with live.edit() as e:
        cut = e.add_plane(0, [1, 1, 1, 2], "gold")
        loose = e.add_plane(0, [1, 1, 1, 7])
    before = seen(live)
    piece = live.preview_remove_plane(0, cut)
    assert isinstance(piece, pc.Cell) and piece.material == "gold"
    assert piece.volume == pytest.approx(1 / 6, rel=1e-14)
    assert piece.planes.shape == (4, 4) and piece.planes[-1].tolist() == [-1, -1, -1, -2]
    assert sorted(piece.vertices.tolist()) == [[0, 1, 1], [1, 0, 1], [1, 1, 0], [1, 1, 1]]
    assert mesh_volume(piece.vertices, piece.triangles) == pytest.approx(1 / 6, rel=1e-14)
    assert live.preview_remove_plane(0, loose) is None
    assert live.preview_remove_plane(0, 1) == "unbounded"
    assert seen(live) == before
    again = pickle.loads(pickle.dumps(piece))
    assert (again.planes.tobytes(), again.volume, again.material) == (piece.planes.tobytes(), piece.volume, "gold")
    # the model gains only what the other brush does not have
    assert live.preview.remove_plane(0, cut).volume_change < piece.volume / 2


@pytest.mark.parametrize("case", range(6))
def test_what_a_brush_gains_is_what_it_has_more_without_the_plane(case: int) -> None:
    rng = generator(case)
    kinds: Counter = Counter()
    for _ in range(6):
        live = pc.Live(pc.hull(rng.normal(size=(9, 3))))
        with live.edit() as e:
            e.add_plane(0, [*rng.normal(size=3), 9.0])
        for plane, numbers in live.planes(0).items():
            found, volume = live.preview_remove_plane(0, plane), live.volume
            kinds[type(found).__name__] += 1
            if found == "unbounded":
                with pytest.raises(pc.PlanecutError, match="infinity"):
                    live.preview.remove_plane(0, plane)
                continue
            preview = live.preview.remove_plane(0, plane)
            if found is None:
                assert (preview.volume_change, preview.added) == (0.0, [])
                continue
            assert preview.volume_change == pytest.approx(found.volume, rel=1e-9)
            np.testing.assert_array_equal(found.planes[-1], -np.array(numbers))
            sides = found.vertices @ found.planes[:, :3].T - found.planes[:, 3]
            np.testing.assert_array_less(sides / np.linalg.norm(found.planes[:, :3], axis=1), 1e-9)
            assert mesh_volume(found.vertices, found.triangles) == pytest.approx(found.volume, rel=1e-9)
            with live.edit() as e:
                e.remove_plane(0, plane)
            assert live.volume == pytest.approx(volume + found.to_solid().volume, rel=1e-9)
            live.undo()
    print(kinds)
    assert kinds["Cell"] > 10 and kinds["NoneType"] > 5


def test_planes_that_are_none_are_refused() -> None:
    live = pc.Live(pc.box([0, 0, 0], [1, 1, 1]))
    with pytest.raises(pc.PlanecutError, match="found brush 7"):
        live.preview_remove_plane(7, 0)
    with pytest.raises(pc.PlanecutError, match="found plane 9 of brush 0"):
        live.preview_remove_plane(0, 9)
    for wrong in ((-1, 0), (0, -1), ("a", 0), (0, 1.5), (pc.Node(0), 0)):
        assert_refused(lambda: live.preview_remove_plane(*wrong))
    torus = pc.torus(2, 0.5, 8, 6).mesh()
    live = pc.Live(pc.from_mesh(torus.vertices, torus.triangles))
    with pytest.raises(pc.PlanecutError, match="closed mesh"):
        live.preview_remove_plane(0, 0)
