"""Has assets that planecut writes read back by others, and compares what they find with planecut's report.

Nothing here shares code with planecut.

`__main__`: options, order, exit status
`planecut`: runs of the program
`inputs`: what is built; `paint`: in one colour; `assets`: which files are written of each input
`gltf_file`: what a glTF file says of itself; `measure`: volumes and what they may differ by
`meshes`: trimesh and manifold3d; `package`: 3MF against its specification, lib3mf
`validator`: the glTF validator
`browser`: three.js in Chromium; `silhouette`: its pictures beside planecut's previews
`round_trip`: maps and trees, by planecut itself and OpenSCAD
`figures`: sizes, time, memory
`results`: all that was found; `page`: the Markdown page, from `page.template.md`; `machine`: where the run was made
"""
