"""`planecut.compat.run_coacd`: the shape of `coacd.run_coacd`, with hulls that hold all of the mesh."""

import inspect
import itertools
import types
import warnings
from fractions import Fraction

import numpy as np
import planecut as pc
import pytest

DATA = {
    "stairs": lambda: pc.union([pc.box([k, 0, 0], [k + 1, 2, k + 1]) for k in range(4)]),
    "ell": lambda: pc.extrude([[0, 0], [3, 0], [3, 1], [1, 1], [1, 2.5], [0, 2.5]], 0.7).rotate([1, 2, 3], 25),
    "cup": lambda: pc.revolve([[0, 0], [1, 0], [1.2, 2], [1.1, 2], [0.9, 0.1], [0, 0.1]], segments=12),
}


def mesh_of(name):
    """Vertices and triangles of a body of many cells."""
    mesh = DATA[name]().mesh()
    return mesh.vertices, mesh.triangles


def exact_side(a, b, c, point):
    """The sign of where a point lies to the plane through a, b and c, in exact numbers: above 0 outside."""
    a, b, c, p = ([Fraction(float(x)) for x in row] for row in (a, b, c, point))
    u, v, w = ([x - y for x, y in zip(row, a)] for row in (b, c, p))
    normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    value = sum(x * y for x, y in zip(normal, w))
    return (value > 0) - (value < 0)


def held(hull, points):
    """For each point whether all half-spaces of a hull's triangles hold it.

    It is decided exactly: in doubles where these suffice, else in fractions.
    """
    vertices, triangles = hull
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    offset = points[:, None, :] - a[None]
    value = np.einsum("pti,ti->pt", offset, normals)
    # far more than what a dozen of roundings can do to the sum
    doubt = 1e-13 * (np.abs(vertices).max() + np.abs(points).max()) ** 3
    outside = value > doubt
    for point, triangle in np.argwhere(np.abs(value) <= doubt):
        if not outside[point].any():
            outside[point, triangle] = exact_side(a[triangle], b[triangle], c[triangle], points[point]) > 0
    return ~outside.any(axis=1)


def volume(vertices, triangles):
    """By the divergence theorem."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def is_closed(triangles):
    """Whether each edge comes once in each direction."""
    edges = [tuple(edge) for corners in triangles.tolist() for edge in zip(corners, corners[1:] + corners[:1])]
    return len(set(edges)) == len(edges) and all((b, a) in set(edges) for a, b in edges)


@pytest.mark.parametrize("name", DATA)
def test_hulls_are_arrays_of_their_own_closed_and_convex(name):
    hulls = pc.compat.run_coacd(*mesh_of(name))
    assert isinstance(hulls, list) and hulls
    for vertices, triangles in hulls:
        assert vertices.dtype == np.float64 and vertices.ndim == 2 and vertices.shape[1] == 3
        assert triangles.dtype == np.int32 and triangles.ndim == 2 and triangles.shape[1] == 3
        assert vertices.flags.writeable and triangles.flags.writeable
        assert is_closed(triangles)
        assert set(np.unique(triangles)) == set(range(len(vertices)))
        heights = np.einsum(
            "pti,ti->pt",
            vertices[:, None] - vertices[triangles[:, 0]][None],
            np.cross(*(vertices[triangles[:, k]] - vertices[triangles[:, 0]] for k in (1, 2))),
        )
        assert heights.max() < 1e-9


@pytest.mark.parametrize("name", DATA)
@pytest.mark.parametrize("most", [-1, 5, 1])
def test_hulls_hold_every_vertex_exactly(name, most):
    vertices, triangles = mesh_of(name)
    hulls = pc.compat.run_coacd(vertices, triangles, max_convex_hull=most)
    assert most < 0 or len(hulls) <= most
    inside = np.any([held(hull, vertices) for hull in hulls], axis=0)
    assert inside.all(), f"{np.count_nonzero(~inside)} of {len(vertices)} vertices are left out"


@pytest.mark.parametrize("name", DATA)
def test_hulls_hold_places_all_over_the_surface_and_inside(name):
    vertices, triangles = mesh_of(name)
    rng = np.random.default_rng(7)
    weights = rng.dirichlet([1, 1, 1], 500)
    chosen = vertices[triangles[rng.integers(0, len(triangles), 500)]]
    points = np.einsum("pk,pki->pi", weights, chosen)
    low, high = vertices.min(0), vertices.max(0)
    inner = rng.uniform(low, high, (500, 3))
    inner = inner[DATA[name]().contains(inner)]
    hulls = pc.compat.run_coacd(vertices, triangles, max_convex_hull=6)
    assert np.any([held(hull, inner) for hull in hulls], axis=0).all()
    # places on the surface are rounded, and hulls that add nothing end there
    wider = [((corners - corners.mean(0)) * (1 + 1e-12) + corners.mean(0), faces) for corners, faces in hulls]
    assert np.any([held(hull, points) for hull in hulls + wider], axis=0).all()


def test_the_threshold_bounds_the_volume_that_is_added():
    vertices, triangles = mesh_of("stairs")
    for threshold in (0.0, 0.2, 0.6):
        hulls = pc.compat.run_coacd(vertices, triangles, threshold=threshold)
        union = pc.union([pc.hull(points) for points, _ in hulls])
        assert union.volume <= volume(vertices, triangles) * (1 + threshold) * (1 + 1e-9)
    assert len(pc.compat.run_coacd(vertices, triangles, threshold=0.0)) > len(
        pc.compat.run_coacd(vertices, triangles, threshold=0.6)
    )


def test_an_object_with_vertices_and_indices_is_a_mesh():
    class Mesh:
        vertices, indices = (array.tolist() for array in mesh_of("stairs"))

    one = pc.compat.run_coacd(Mesh(), threshold=0.1)
    other = pc.compat.run_coacd(*mesh_of("stairs"), threshold=0.1)
    assert len(one) == len(other)
    assert all(np.array_equal(a, b) for first, second in zip(one, other) for a, b in zip(first, second))


@pytest.mark.filterwarnings("ignore")
def test_open_meshes_are_enclosed():
    vertices, triangles = mesh_of("cup")
    # without its floor, and with single triangles left out
    centers = vertices[triangles].mean(axis=1)
    for kept in (centers[:, 2] > 0.1, np.arange(len(triangles)) % 17 != 3):
        assert not is_closed(triangles[kept])
        used, renumbered = np.unique(triangles[kept], return_inverse=True)
        points = vertices[used]
        for most in (-1, 8):
            hulls = pc.compat.run_coacd(points, renumbered.reshape(-1, 3), max_convex_hull=most)
            assert len(hulls) <= (32 if most < 0 else most)
            assert np.any([held(hull, points) for hull in hulls], axis=0).all()


def test_ignored_settings_are_named_in_one_warning():
    vertices, triangles = mesh_of("ell")
    with pytest.warns(UserWarning, match="mcts_iterations, resolution") as caught:
        pc.compat.run_coacd(vertices, triangles, resolution=3, mcts_iterations=10)
    assert len(caught) == 1 and caught[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        pc.compat.run_coacd(vertices, triangles, 0.1, 4)


def test_an_object_may_be_followed_by_a_count_alone():
    """`run_coacd(mesh, 0.1, max_convex_hull=8)` lost the 8."""
    vertices, triangles = mesh_of("stairs")
    mesh = types.SimpleNamespace(vertices=vertices, indices=triangles)
    fewest = len(pc.compat.run_coacd(vertices, triangles, threshold=0.0))
    assert fewest > 2
    for hulls in (pc.compat.run_coacd(mesh, 0.0, 2), pc.compat.run_coacd(mesh, 0.0, max_convex_hull=2)):
        assert len(hulls) <= 2


@pytest.mark.parametrize("change", ["number", "nan", "shape"])
def test_what_is_no_mesh_is_refused(change):
    vertices, triangles = (np.array(array) for array in mesh_of("ell"))
    if change == "number":
        triangles[0, 0] = len(vertices)
    elif change == "nan":
        vertices[2, 1] = np.nan
    else:
        triangles = triangles[:, :2]
    with pytest.raises(pc.PlanecutError):
        pc.compat.run_coacd(vertices, triangles)


def test_arguments_and_results_are_those_of_coacd():
    coacd = pytest.importorskip("coacd", reason="coacd is not installed")
    coacd.set_log_level("error")
    ours, theirs = (inspect.signature(function).parameters for function in (pc.compat.run_coacd, coacd.run_coacd))
    assert list(theirs)[1:3] == ["threshold", "max_convex_hull"]
    assert all(ours[name].default == theirs[name].default for name in ("threshold", "max_convex_hull"))
    vertices, triangles = mesh_of("ell")
    settings = dict(threshold=0.2, max_convex_hull=4)
    # every setting of coacd is taken, if only with a warning
    other = {name: value.default for name, value in itertools.islice(theirs.items(), 3, None)}
    with pytest.warns(UserWarning, match="ignores"):
        mine = pc.compat.run_coacd(coacd.Mesh(vertices, triangles), **settings, **other)
    its = coacd.run_coacd(coacd.Mesh(vertices, triangles), **settings, resolution=500, mcts_iterations=20)
    assert type(mine) is type(its)
    for (points, faces), (its_points, its_faces) in ((mine[0], its[0]),):
        assert (type(points), points.dtype, points.ndim) == (type(its_points), its_points.dtype, its_points.ndim)
        assert (type(faces), faces.dtype, faces.ndim) == (type(its_faces), its_faces.dtype, its_faces.ndim)
        # seen from outside counter-clockwise, both
        assert volume(points, faces) > 0 and volume(its_points, its_faces) > 0
