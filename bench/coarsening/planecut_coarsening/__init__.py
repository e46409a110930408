"""Measures `planecut coarsen` beside CoACD and V-HACD, by manifold3d.

Nothing here shares code with planecut: its cells are read from the files that it writes, as everybody's are.

`__main__`: options, order, exit status
`bodies`: closed meshes in OBJ files, one for each object
`measure`: volumes and corners of hulls against a reference
`entrant`: runs of planecut, CoACD and V-HACD, each in a process of its own; `worker` is that process for the latter two
`greedy`: pairs merged one after another, to compare with
`decompositions`, `whole_mesh`, `exact_merges`, `engines`: the four parts of the benchmark
`plot`: lines over the number of cells as SVG; `charts`: which lines
`page`: the Markdown page, from `page.template.md`; `machine`: where the run was made
"""
