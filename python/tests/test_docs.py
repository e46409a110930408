"""The pages about the package: blocks of Python run, and names in the tables are there and mean what the tables say."""

import re
import warnings
from pathlib import Path

import numpy as np
import planecut as pc
import pytest

PYTHON = Path(__file__).parent.parent
PAGES = {"python.md": PYTHON.parent / "docs" / "python.md", "README.md": PYTHON / "README.md"}
LOOP = [[0.5, 0.0], [2.0, 0.0], [1.5, 1.0], [0.5, 2.0]]


def blocks(path):
    """The blocks of Python of a page, each with the line where it begins."""
    text = path.read_text(encoding="utf-8")
    found = re.finditer(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    return [(text[: match.start(1)].count("\n"), match.group(1)) for match in found]


def rows(path, heading):
    """The code in the first two columns of the table below a heading, where both have one."""
    section = path.read_text(encoding="utf-8").split(f"### {heading}\n")[1].split("\n## ")[0].split("\n### ")[0]
    table = []
    for line in section.splitlines():
        cells = [cell.strip().replace("\\|", "|") for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
        if len(cells) == 3 and cells[0].startswith("`") and cells[1].startswith("`"):
            table.append(tuple(cell.strip("`") for cell in cells[:2]))
    assert table, heading
    return table


@pytest.mark.parametrize("name", PAGES)
def test_blocks_of_a_page_run_one_after_another(name, tmp_path, monkeypatch, capsys):
    if not PAGES[name].is_file():
        pytest.skip(f"{name} is not here: the tests run without the repository")
    monkeypatch.chdir(tmp_path)
    names = {"__name__": "page"}
    assert blocks(PAGES[name])
    for line, block in blocks(PAGES[name]):
        # errors name the line of the page
        code = compile("\n" * line + block, str(PAGES[name]), "exec")
        exec(code, names)


@pytest.mark.parametrize("name", PAGES)
def test_what_comments_say_is_printed(name, tmp_path, monkeypatch, capsys):
    if not PAGES[name].is_file():
        pytest.skip(f"{name} is not here: the tests run without the repository")
    monkeypatch.chdir(tmp_path)
    names = {"__name__": "page"}
    for _, block in blocks(PAGES[name]):
        capsys.readouterr()
        exec(block, names)
        printed = capsys.readouterr().out
        for said in re.findall(r"print\(.*\)\s+# ([^:\n]*)", block):
            # a comment in words says nothing about the text
            if re.match(r"[\[(\d'T]", said):
                assert said.strip() in printed, said


def measured(value):
    """What can be compared of a result of either package: the volume of solids, else numbers."""
    value = value() if callable(value) and not hasattr(value, "volume") else value
    if isinstance(value, (list, tuple)) and value and hasattr(value[0], "volume"):
        return sorted(measured(part)[0] for part in value)
    if hasattr(value, "to_polygons"):
        return [abs(value.area())]
    if isinstance(value, list) and value and isinstance(value[0], np.ndarray) and value[0].shape[1] == 2:
        return [abs(sum(x @ np.roll(y, -1) - y @ np.roll(x, -1) for x, y in (loop.T for loop in value))) / 2]
    if hasattr(value, "volume"):
        volume = value.volume
        return [volume() if callable(volume) else volume]
    return np.sort(np.asarray(value, dtype=float), axis=None)


@pytest.fixture
def names():
    """What the tables take for granted: two bodies that overlap, points and a mesh."""
    a = pc.box([0, 0, 0], [2, 2, 1]) - pc.box([1, 1, 0.25], [3, 3, 3])
    b = pc.cylinder(2, 0.7, segments=24)
    mesh = a.mesh()
    points = np.random.default_rng(1).uniform(-1, 3, (50, 3))
    shared = {
        "np": np,
        "points": points,
        "loop": LOOP,
        "vertices": mesh.vertices.copy(),
        "triangles": mesh.triangles.astype(np.uint64),
        "mesh": mesh,
    }
    return shared, {"pc": pc, "a": a, "b": b}


# results that are made in another way on purpose, and those that are no numbers
OTHER = {"Manifold.sphere(1, 32)", "a.num_tri()", "a.to_mesh64().vert_properties"}


def test_names_of_manifold3d_mean_the_same(names):
    manifold3d = pytest.importorskip("manifold3d", reason="manifold3d is not installed")
    shared, ours = names
    made = {
        key: manifold3d.Manifold(
            manifold3d.Mesh64(solid.mesh().vertices.copy(), solid.mesh().triangles.astype(np.uint64))
        )
        for key, solid in ours.items()
        if key in "ab"
    }
    theirs = {**vars(manifold3d), **shared, **made}
    for left, right in rows(PAGES["python.md"], "manifold3d"):
        expected, found = eval(left, theirs), eval(right, {**shared, **ours})
        if left in OTHER:
            continue
        if hasattr(found, "bounds") and hasattr(expected, "bounding_box"):
            assert np.ravel(found.bounds) == pytest.approx(np.array(expected.bounding_box()), abs=1e-12), left
        assert measured(found) == pytest.approx(measured(expected), rel=1e-9), left


def test_names_of_trimesh_mean_the_same(names, tmp_path, monkeypatch):
    trimesh = pytest.importorskip("trimesh", reason="trimesh is not installed")
    pytest.importorskip("scipy", reason="scipy is not installed: trimesh needs it")
    monkeypatch.chdir(tmp_path)
    shared, ours = names
    ours["a"].save("plate.stl")
    for left, right in rows(PAGES["python.md"], "trimesh"):
        tm = ours["a"].to_trimesh()
        found = eval(right, {**shared, **ours})
        if left.startswith(("tm.contains", "tm.convex_decomposition", "tm.show")):
            # these need rtree, other packages or a window
            assert hasattr(tm, left[3:].split("(")[0])
            continue
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            expected = eval(left, {**shared, "trimesh": trimesh, "tm": tm})
        if left.startswith("tm.export"):
            assert Path("out.glb").stat().st_size > 0
        else:
            assert measured(found) == pytest.approx(measured(expected), rel=1e-6), left


def test_names_of_coacd_and_openscad_are_there(names, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shared, ours = names
    ours["a"].save("plate.stl")
    volumes = {}
    for heading in ("CoACD", "OpenSCAD"):
        for left, right in rows(PAGES["python.md"], heading):
            volumes[left] = eval(right, {**shared, **ours})
    # what OpenSCAD's manual says, by hand
    assert volumes["cube([1, 2, 3]);"].volume == pytest.approx(6)
    # a sphere has rings of corners half a step away from the poles
    polar, around = np.meshgrid(np.pi * (np.arange(16) + 0.5) / 16, 2 * np.pi * np.arange(32) / 32)
    corners = np.stack(
        [np.sin(polar) * np.cos(around), np.sin(polar) * np.sin(around), np.cos(polar)], axis=-1
    ).reshape(-1, 3)
    ball = volumes["sphere(r=1, $fn=32);"].mesh().vertices
    assert np.abs(ball[:, None] - corners[None]).max(axis=2).min(axis=1).max() < 1e-12 and len(ball) == len(corners)
    loop_area = sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(LOOP, LOOP[1:] + LOOP[:1])) / 2
    assert pc.extrude(LOOP, 3).volume == pytest.approx(3 * loop_area)
    assert len(volumes["coacd.run_coacd(coacd.Mesh(vertices, triangles))"][0]) == 2


def test_links_of_the_pages_lead_somewhere():
    for page in PAGES.values():
        if not page.is_file():
            continue
        for target in re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", page.read_text(encoding="utf-8")):
            if not target.startswith("http"):
                assert (page.parent / target).exists(), target
