"""Rigid bodies that `planecut coarsen` writes, in the engines that read them: MuJoCo, PyBullet, USD."""
