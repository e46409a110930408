"""An engine for the Boolean operations of trimesh."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from ._planecut import PlanecutError, Solid, difference, from_mesh, intersection, union

if TYPE_CHECKING:
    from trimesh import Trimesh


def trimesh_engine(
    meshes: Iterable[Trimesh], operation: str, *, check_volume: bool = True, **kwargs: Any
) -> Trimesh:
    """A Boolean operation on meshes of trimesh, as an entry of trimesh's table of engines.

    ```python
    trimesh.boolean._engines["planecut"] = planecut.trimesh_engine
    trimesh.boolean.union([a, b], engine="planecut")
    ```

    Args:
        meshes: Objects with `vertices` of shape (n, 3) and `faces` of shape (m, 3), each closed.
        operation: "union", "difference" (the first less all others) or "intersection".
        check_volume: Whether meshes that trimesh takes for no volume are refused, as its own engines do; without, what winds around a point more than zero times is inside.
        kwargs: For other engines; nothing here.

    Returns:
        A new `trimesh.Trimesh`, closed.

    Raises:
        PlanecutError: A mesh is not closed, or the operation is another one.
    """
    import trimesh

    meshes = list(meshes)
    if check_volume and not all(mesh.is_volume for mesh in meshes):
        raise PlanecutError("found a mesh that is no volume, expected closed ones (check_volume=False takes what winds around)")
    solids = [from_mesh(mesh.vertices, mesh.faces) for mesh in meshes]
    mesh = _combined(solids, operation).mesh()
    # the arrays of a mesh are views that nobody may write to; vertices at one place are several where the solid touches itself
    return trimesh.Trimesh(vertices=mesh.vertices.copy(), faces=mesh.triangles.astype("int64"), process=False)


def _combined(solids: list[Solid], operation: str) -> Solid:
    if not solids:
        raise PlanecutError("found no meshes, expected one at least")
    if operation == "union":
        return union(solids)
    if operation == "intersection":
        return intersection(solids)
    if operation == "difference":
        return difference(solids[0], solids[1:])
    raise PlanecutError(f"operation: found {operation!r}, expected 'union', 'difference' or 'intersection'")
