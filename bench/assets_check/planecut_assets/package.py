"""3MF as a package, against the core specification, and as the consortium's own library reads it."""

import re
import zipfile
from collections import Counter
from pathlib import Path
from xml.etree import ElementTree

import lib3mf
import numpy as np

from .assets import Asset
from .measure import Surface, Volume, compare
from .meshes import SINGLE
from .setting import Setting

MODEL = "3D/3dmodel.model"
CORE = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
TYPES = "{http://schemas.openxmlformats.org/package/2006/content-types}"
RELATIONS = "{http://schemas.openxmlformats.org/package/2006/relationships}"
START = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"
MODEL_TYPE = "application/vnd.ms-package.3dmanufacturing-3dmodel+xml"
RELATIONS_TYPE = "application/vnd.openxmlformats-package.relationships+xml"
UNITS = ("micron", "millimeter", "centimeter", "inch", "foot", "meter")
COLOR = re.compile(r"#[0-9A-Fa-f]{6}([0-9A-Fa-f]{2})?")


def check_package(setting: Setting, asset: Asset) -> list[Volume]:
    """Both checks; what is amiss goes to `setting`."""
    for fault in package_faults(asset.path):
        setting.fail(asset.where, fault)
    if asset.report["mesh"]["triangles"] == 0:
        return []
    volume = _check_with_library(setting, asset)
    if volume.amiss:
        setting.fail(asset.where, volume)
    return [volume]


def package_faults(path: Path) -> list[str]:
    """What the core specification forbids."""
    with zipfile.ZipFile(path) as package:
        faults = [
            f"{entry.filename}: compressed in a way that packages must not be"
            for entry in package.infolist()
            if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED) or entry.flag_bits & 1
        ]
        if package.testzip():
            faults.append(f"{package.testzip()}: damaged")
        missing = {"[Content_Types].xml", "_rels/.rels", MODEL} - set(package.namelist())
        if missing:
            return [*faults, f"the package has no {', '.join(sorted(missing))}"]
        types, relations, model = (
            ElementTree.fromstring(package.read(name)) for name in ("[Content_Types].xml", "_rels/.rels", MODEL)
        )
    faults += _type_faults(types)
    starts = [
        relation.get("Target")
        for relation in relations.iter(RELATIONS + "Relationship")
        if relation.get("Type") == START
    ]
    if starts != ["/" + MODEL]:
        faults.append(f"_rels/.rels starts at {starts}, not at /{MODEL}")
    return faults + _model_faults(model)


def _type_faults(types: ElementTree.Element) -> list[str]:
    defaults = {entry.get("Extension", "").lower(): entry.get("ContentType") for entry in types.iter(TYPES + "Default")}
    expected = {"rels": RELATIONS_TYPE, "model": MODEL_TYPE}
    return [
        f"[Content_Types].xml: .{ending} is {defaults.get(ending)}"
        for ending, kind in expected.items()
        if defaults.get(ending) != kind
    ]


def _model_faults(model: ElementTree.Element) -> list[str]:
    if model.tag != CORE + "model":
        return [f"the model's root element is {model.tag}"]
    faults = []
    if model.get("unit", "millimeter") not in UNITS:
        faults.append(f"unit {model.get('unit')}")
    resources = model.find(CORE + "resources")
    if resources is None or model.find(CORE + "build") is None:
        return [*faults, "the model lacks <resources> or <build>"]
    identifiers = Counter(resource.get("id", "") for resource in resources)
    faults += [
        f"resource id {name!r}"
        for name, count in identifiers.items()
        if count > 1 or not re.fullmatch("[1-9][0-9]*", name)
    ]
    materials = {group.get("id"): len(group) for group in resources.iter(CORE + "basematerials")}
    for base in resources.iter(CORE + "base"):
        if not base.get("name") or not COLOR.fullmatch(base.get("displaycolor", "")):
            faults.append(f"base material {base.attrib}")
    objects = {entry.get("id"): entry for entry in resources.iter(CORE + "object")}
    for name, entry in objects.items():
        faults += [f"object {name}: {fault}" for fault in _object_faults(entry, materials)]
    built = [item.get("objectid") for item in model.iter(CORE + "item")]
    return faults + [f"the build names object {name}, which is not there" for name in built if name not in objects]


def _object_faults(entry: ElementTree.Element, materials: dict[str | None, int]) -> list[str]:
    mesh = entry.find(CORE + "mesh")
    if mesh is None:
        return [] if entry.find(CORE + "components") is not None else ["neither a mesh nor components"]
    vertices = [[float(vertex.get(axis, "nan")) for axis in "xyz"] for vertex in mesh.iter(CORE + "vertex")]
    triangles = list(mesh.iter(CORE + "triangle"))
    corners = np.array([[int(triangle.get(name, "-1")) for name in ("v1", "v2", "v3")] for triangle in triangles])
    if len(vertices) < 3 or len(triangles) < 4:
        return [f"{len(vertices)} vertices, {len(triangles)} triangles"]
    faults = [] if np.isfinite(vertices).all() else ["a coordinate is missing or not finite"]
    if corners.min() < 0 or corners.max() >= len(vertices):
        return [*faults, f"indices from {corners.min()} to {corners.max()} of {len(vertices)} vertices"]
    if (corners == np.roll(corners, 1, axis=1)).any():
        faults.append("a triangle uses a vertex twice")
    ends = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2)
    edges, uses = np.unique(ends, axis=0, return_counts=True)
    if uses.max() > 1 or not np.array_equal(edges, np.unique(ends[:, ::-1], axis=0)):
        faults.append("an edge is not between two triangles that run along it in opposite directions")
    named = [(triangle.get("pid", entry.get("pid")), triangle.get("p1", entry.get("pindex"))) for triangle in triangles]
    unknown = {
        (group, number)
        for group, number in named
        if group is not None and not 0 <= int(number or 0) < materials.get(group, 0)
    }
    return faults + [f"material {number} of group {group} is not there" for group, number in sorted(unknown, key=str)]


def _check_with_library(setting: Setting, asset: Asset) -> Volume:
    """By lib3mf in strict mode. Each object of the build is measured where its item puts it."""
    model = lib3mf.get_wrapper().CreateModel()
    reader = model.QueryReader("3mf")
    reader.SetStrictModeActive(True)
    reader.ReadFromFile(str(asset.path))
    for number in range(reader.GetWarningCount()):
        setting.fail(asset.where, f"lib3mf warns: {reader.GetWarning(number)}")
    volume = area = extent = 0.0
    items = model.GetBuildItems()
    while items.MoveNext():
        item = items.GetCurrent()
        mesh = model.GetMeshObjectByID(item.GetObjectResource().GetResourceID())
        if not mesh.IsManifoldAndOriented():
            setting.fail(asset.where, f"lib3mf finds {mesh.GetName() or 'an object'} not manifold and oriented")
        placed = np.array([list(row) for row in item.GetObjectTransform().Fields])
        points = np.array([list(vertex.Coordinates) for vertex in mesh.GetVertices()]) @ placed[:3] + placed[3]
        found = Surface.of(points, np.array([list(triangle.Indices) for triangle in mesh.GetTriangleIndices()]))
        volume, area, extent = volume + found.volume, area + found.area, max(extent, found.extent)
    return compare(asset.where, "lib3mf", Surface(volume, area, extent), asset.report, extent * SINGLE)
