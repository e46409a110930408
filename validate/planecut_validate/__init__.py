"""Checks what planecut writes against manifold3d and against itself, with no code of planecut's own.

| module | what it holds |
|---|---|
| `map_file` | text of a `.map` to exact integer half-spaces |
| `convex_body` | half-spaces to the exact vertices of a convex body |
| `model` | a reference model: its solid by manifold3d, its coverage along lines by clipping; formats by file ending |
| `obj_file`, `glb_file` | readers of what planecut writes |
| `mesh` | volume, area, centroid, twin check, components and genus of an indexed mesh |
| `mesh_lines` | where lines cross a mesh |
| `line_oracle` | random lines: mesh crossings against the model's coverage |
| `process` | one run of the `planecut` command line |
| `checks` | all checks of one model |
| `__main__` | the command line, the table and the JSON report |
"""
