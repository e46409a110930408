//! The named parts of a tree: unions that are taken apart where brushes have names.

use super::tree::known_lines;
use super::{Operation, Tree, TreeNode};

impl Tree {
    /// The parts of a union by the names of their brushes: an operand whose brushes have one name is a part, as are single brushes of one
    /// name that follow one another; unions of several names are taken apart further. What has no name, or is no union of several names, is the part
    /// without a name, which comes first.
    ///
    /// ```
    /// use planecut_csg::{Brush, MaterialId, Tree};
    /// use planecut_kernel::DVec3;
    ///
    /// let block = |at: f64| Tree::from(Brush::cuboid(DVec3::splat(at), DVec3::splat(at + 2.0), MaterialId(0)));
    /// let nut = (block(0.0) - block(1.0)).with_name("nut");
    /// let tree = Tree::union([block(9.0), nut, block(4.0).with_name("bolt")]);
    /// let names: Vec<Option<String>> = tree.into_named_parts().into_iter().map(|(name, _)| name).collect();
    /// assert_eq!(names, [None, Some("nut".to_owned()), Some("bolt".to_owned())]);
    /// ```
    #[must_use]
    pub fn into_named_parts(self) -> Vec<(Option<String>, Self)> {
        let mut nameless = Vec::new();
        let mut parts: Vec<(Option<String>, Self)> = Vec::new();
        // trees, and whether each goes with the one before it if both have one name
        let mut waiting = vec![(self, false)];
        while let Some((tree, is_joined)) = waiting.pop() {
            match tree.common_name() {
                Ok(Some(name)) => match parts.last_mut() {
                    Some((last, part)) if is_joined && last.as_ref() == Some(&name) => {
                        let before = std::mem::take(part);
                        *part = before | tree;
                    }
                    _ => parts.push((Some(name), tree)),
                },
                Err(()) if tree.root() == Some(Operation::Union) => {
                    let operands = tree.into_operands();
                    let first = operands.first().and_then(|operand| operand.common_name().ok());
                    // the operands of a union that comes first are operands of the whole
                    let of_first = operands.iter().take_while(|operand| operand.common_name().ok() == first).count();
                    let joined = operands.into_iter().enumerate().map(|(place, operand)| {
                        let is_leaf = operand.nodes.len() == 1;
                        (operand, place > 0 && (is_leaf || place < of_first))
                    });
                    waiting.extend(joined.collect::<Vec<_>>().into_iter().rev());
                }
                _ => nameless.push(tree),
            }
        }
        let nameless = (!nameless.is_empty()).then(|| (None, Self::union(nameless)));
        nameless.into_iter().chain(parts).collect()
    }

    /// The name that all brushes have, if they have one; an error where names differ.
    fn common_name(&self) -> Result<Option<String>, ()> {
        let first = self.brushes.first().and_then(|brush| brush.name.as_ref());
        let is_common = self.brushes.iter().all(|brush| brush.name.as_ref() == first);
        if is_common { Ok(first.cloned()) } else { Err(()) }
    }

    fn root(&self) -> Option<Operation> {
        match self.nodes.last()? {
            TreeNode::Leaf => None,
            TreeNode::Operation { operation, .. } => Some(*operation),
        }
    }

    /// The operands of the root, which is an operation.
    fn into_operands(mut self) -> Vec<Self> {
        let Some(TreeNode::Operation { operands, .. }) = self.nodes.pop() else { return Vec::new() };
        // from the last operand to the first: each ends where the one after it begins
        let mut parts = Vec::with_capacity(operands as usize);
        for _ in 0..operands {
            let mut open = 1;
            let mut start = self.nodes.len();
            while open > 0 && start > 0 {
                start -= 1;
                open -= 1;
                if let TreeNode::Operation { operands, .. } = self.nodes[start] {
                    open += operands as usize;
                }
            }
            let nodes = self.nodes.split_off(start);
            let leaves = nodes.iter().filter(|node| **node == TreeNode::Leaf).count();
            let first = self.brushes.len() - leaves;
            let lines = if self.lines.is_empty() { Vec::new() } else { known_lines(self.lines.split_off(first)) };
            parts.push(Self { brushes: self.brushes.split_off(first), nodes, lines });
        }
        parts.reverse();
        parts
    }
}
