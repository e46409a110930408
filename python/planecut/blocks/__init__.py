"""Models that are larger than memory: cut into blocks, which are evaluated one by one, on this machine or by Ray or Dask.

>>> import tempfile
>>> import planecut as pc
>>> boxes = (pc.box([x, y, 0], [x + 0.75, y + 0.75, 1]) for x in range(40) for y in range(25))
>>> plan = pc.blocks.plan(boxes, tempfile.mkdtemp(), brushes=100)
>>> pieces = plan.evaluate()
>>> len(pieces) >= 10, round(pieces.volume, 9)
(True, 562.5)
"""

from .._planecut import Block, Counts, Pieces, Plan, evaluate_block, open, plan

__all__ = ["Block", "Counts", "Pieces", "Plan", "evaluate_block", "open", "plan"]
