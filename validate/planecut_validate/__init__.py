"""Checks what planecut writes against manifold3d and against itself, with no code of planecut's own.

| module | what it holds |
|---|---|
| `map_file` | text of a `.map` to exact integer half-spaces |
| `model_file` | a native model file to a tree of bodies |
| `csg_file` | an OpenSCAD tree to a tree of bodies |
| `convex_body` | half-spaces to the exact vertices of a convex body |
| `leaf` | a body of a tree: convex by its half-spaces, or a closed mesh |
| `solid_tree` | set operations over bodies, along lines and by manifold3d |
| `lines`, `intervals` | lines, and set operations on intervals along them |
| `coincidence` | do faces of two bodies lie in one plane? |
| `rectilinear` | volume and area of boxes along the axes |
| `model` | reference models by file ending: `brush_union` of a map, `tree_model` of a model file; `reference` is what they answer |
| `obj_file`, `glb_file` | readers of what planecut writes |
| `mesh` | volume, area, centroid, twin check, components and genus of an indexed mesh |
| `mesh_lines` | where lines cross a mesh |
| `line_oracle` | random lines: mesh crossings against the model's coverage |
| `cells` | convex cells: by themselves, and their union along lines |
| `known` | volumes that are known from elsewhere |
| `process` | one run of the `planecut` command line |
| `checks` | all checks of one model; `result` is what they leave |
| `random_trees`, `shrink`, `batch` | random models, many at once, failing ones made small |
| `identities` | identities of set algebra over random solids |
| `table`, `report`, `plot` | results as rows, as files, as a picture |
| `__main__` | the command line |
"""
