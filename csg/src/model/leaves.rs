//! Trees with other leaves.

use super::tree::known_lines;
use super::{Brush, MeshBody, Operation, Tree, TreeNode};
use crate::ids::number32;

impl Tree {
    /// The tree with the union of some brushes in place of each leaf. They have its source line, and its name where they have none.
    ///
    /// ```
    /// use planecut_csg::{Brush, MaterialId, Tree};
    /// use planecut_kernel::DVec3;
    ///
    /// let block = |min: f64, max: f64| Brush::cuboid(DVec3::splat(min), DVec3::splat(max), MaterialId(0));
    /// let tree = Tree::from(block(0.0, 4.0)).with_name("frame") - block(1.0, 3.0).into();
    /// let twice = tree.try_replace_leaves(|brush| Ok::<_, ()>(vec![brush.clone(), brush]));
    /// let twice = twice.unwrap();
    /// assert_eq!(twice.brushes().len(), 4);
    /// assert_eq!(twice.brushes()[1].name.as_deref(), Some("frame"));
    /// ```
    ///
    /// # Errors
    /// What `by` gives.
    pub fn try_replace_leaves<E>(self, mut by: impl FnMut(Brush) -> Result<Vec<Brush>, E>) -> Result<Self, E> {
        let mut lines = (!self.lines.is_empty()).then(|| self.lines.clone().into_iter());
        let mut leaves = self.brushes.into_iter();
        let (mut brushes, mut nodes, mut lines_now) = (Vec::new(), Vec::with_capacity(self.nodes.len()), Vec::new());
        for node in self.nodes {
            if node != TreeNode::Leaf {
                nodes.push(node);
                continue;
            }
            let leaf = leaves.next().expect("a brush for each leaf");
            let name = leaf.name.clone();
            let others = by(leaf)?;
            let count = others.len();
            brushes.extend(others.into_iter().map(|other| {
                let own = other.name.clone().or_else(|| name.clone());
                Brush { name: own, ..other }
            }));
            nodes.resize(nodes.len() + count, TreeNode::Leaf);
            if count != 1 {
                nodes.push(TreeNode::Operation { operation: Operation::Union, operands: number32(count) });
            }
            let line = lines.as_mut().and_then(Iterator::next).flatten();
            lines_now.resize(brushes.len(), line);
        }
        Ok(Self { brushes, nodes, lines: known_lines(lines_now) })
    }

    /// The leaves that are closed meshes.
    pub fn meshes(&self) -> impl Iterator<Item = &MeshBody> {
        self.brushes.iter().filter_map(|brush| brush.mesh.as_ref())
    }
}
