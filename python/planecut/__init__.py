"""planecut, a convex-CSG modeling kernel: exact half-spaces in, watertight meshes and enclosing colliders out.

Solids are made by functions (`box`, `cylinder`, `extrude`, `from_mesh`, …), combined with operators and moved; nothing is computed before something is asked of them.

>>> import planecut as pc
>>> plate = pc.box([0, 0, 0], [40, 20, 4]) - pc.cylinder(height=4, radius=3, segments=4).translate([20, 10, 0])
>>> round(plate.volume, 9)
3128.0
>>> plate.mesh().is_watertight
True

Lengths are in the units of the caller, z is up, axes are right-handed, and triangles run counter-clockwise seen from outside. Arrays that leave are read-only views of memory that the package
owns; arrays that come in are copied. Long calls release the interpreter's lock and can be interrupted with Ctrl-C.
"""

from . import batch, blocks, compat
from ._planecut import (
    Buffers,
    Cell,
    Change,
    Coarsened,
    Edit,
    Face,
    InternalError,
    Live,
    Mesh,
    Node,
    PlanecutError,
    Polytope,
    Preview,
    Previewer,
    Solid,
    __version__,
    box,
    coarsen,
    cylinder,
    difference,
    extrude,
    from_mesh,
    from_trimesh,
    halfspaces,
    hull,
    intersection,
    load,
    minkowski,
    revolve,
    sphere,
    torus,
    union,
)
from ._trimesh import trimesh_engine
from ._view import View

__all__ = [
    "Buffers",
    "Cell",
    "Change",
    "Coarsened",
    "Edit",
    "Face",
    "InternalError",
    "Live",
    "Mesh",
    "Node",
    "PlanecutError",
    "Polytope",
    "Preview",
    "Previewer",
    "Solid",
    "View",
    "__version__",
    "batch",
    "blocks",
    "box",
    "coarsen",
    "compat",
    "cylinder",
    "difference",
    "extrude",
    "from_mesh",
    "from_trimesh",
    "halfspaces",
    "hull",
    "intersection",
    "load",
    "minkowski",
    "revolve",
    "sphere",
    "torus",
    "trimesh_engine",
    "union",
]
