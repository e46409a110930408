"""The line oracle where lines are at their worst: aimed at edges, at corners, along faces."""

import unittest
from unittest import mock

import manifold3d
import numpy as np

from planecut_validate import line_oracle
from planecut_validate.brush_union import BrushUnion
from planecut_validate.convex_body import convex_body
from planecut_validate.lines import Lines
from planecut_validate.mesh import Mesh


def box(low, high) -> list[tuple[int, int, int, int]]:
    """The six half-spaces of a box."""
    planes = []
    for axis in range(3):
        normal = [int(i == axis) for i in range(3)]
        planes += [(*normal, high[axis]), (*(-n for n in normal), -low[axis])]
    return planes


def union(boxes) -> tuple[BrushUnion, Mesh]:
    """A model of boxes and its mesh by manifold3d."""
    model = BrushUnion([convex_body(box(*corners)) for corners in boxes], len(boxes))
    solid = manifold3d.Manifold.batch_boolean(model.hulls, manifold3d.OpType.Add).to_mesh64()
    triangles = np.array(solid.tri_verts, dtype=np.int64)
    return model, Mesh(np.array(solid.vert_properties)[:, :3], triangles)


class AimedLines(unittest.TestCase):
    # The first two touch in a face, the third overlaps both.
    BOXES = [((0, 0, 0), (8, 8, 8)), ((8, 0, 0), (16, 8, 8)), ((4, 4, 4), (12, 12, 12))]

    def compare(self, lines: Lines, mesh: Mesh, model: BrushUnion):
        with mock.patch.object(line_oracle, "_draw", lambda *_: lines):
            return line_oracle.compare(line_oracle.draw(model, len(lines), seed=3), mesh)

    def test_lines_through_edges_and_corners_are_redrawn_and_agree(self):
        model, mesh = union(self.BOXES)
        random = np.random.default_rng(11)
        # From random points straight through points of the silhouettes: corners, then points on edges along x.
        corners = np.array([body.vertices[random.integers(8)] for body in model.bodies for _ in range(200)])
        on_edges = corners.copy()
        on_edges[:, 0] += random.random(len(corners)) - 0.5
        targets = np.concatenate([corners, on_edges])
        origins = model.low + random.random(targets.shape) * (model.high - model.low)
        directions = targets - origins
        lines = Lines(origins, directions / np.linalg.norm(directions, axis=1)[:, None])
        report = self.compare(lines, mesh, model)
        self.assertGreater(report.redrawn, 100, report)
        self.assertEqual((report.mismatches, report.unclear), (0, 0), report.examples)

    def test_lines_in_faces_are_redrawn_and_agree(self):
        model, mesh = union(self.BOXES)
        random = np.random.default_rng(13)
        origins = np.column_stack([16 * random.random(300), 8 * random.random(300), np.full(300, 8.0)])
        angles = 2 * np.pi * random.random(300)
        lines = Lines(origins, np.column_stack([np.cos(angles), np.sin(angles), np.full(300, 1e-9)]))
        report = self.compare(lines, mesh, model)
        self.assertGreater(report.redrawn, 250, report)
        self.assertEqual((report.mismatches, report.unclear), (0, 0), report.examples)

    def test_a_gap_too_thin_to_tell_is_accepted_either_way(self):
        model, closed = union(self.BOXES[:1] + [((8, 0, 0), (16, 8, 8))])
        # The same pair, 1e-9 apart: no line along x can be clear about that.
        thin = [(10**9 * a, 10**9 * b, 10**9 * c, 10**9 * d) for a, b, c, d in box((8, 0, 0), (16, 8, 8))]
        thin[1] = (-(10**9), 0, 0, -(8 * 10**9 + 1))
        apart = BrushUnion([convex_body(box(*self.BOXES[0])), convex_body(thin)], 2)
        hulls = [np.array(h.to_mesh64().vert_properties)[:, :3] for h in apart.hulls]
        faces = [np.array(h.to_mesh64().tri_verts, dtype=np.int64) for h in apart.hulls]
        opened = Mesh(np.concatenate(hulls), np.concatenate([faces[0], faces[1] + len(hulls[0])]))
        random = np.random.default_rng(17)
        origins = np.column_stack([np.full(50, 4.0), 1 + 6 * random.random((50, 2))])
        for mesh in (closed, opened):
            lines = Lines(origins.copy(), np.tile([1.0, 0.0, 0.0], (50, 1)))
            report = self.compare(lines, mesh, apart)
            self.assertEqual(report.mismatches, 0, report.examples)
            self.assertEqual(report.unclear, 50)
        self.assertEqual(model.brushes, apart.brushes)


if __name__ == "__main__":
    unittest.main()
