//! Facts about triangle indices alone.

/// Whether the triangles form a closed, oriented 2-manifold by edges: every directed edge occurs once and so does its
/// opposite.
///
/// An empty list is one, trivially.
pub(crate) fn is_oriented_manifold(triangles: &[[u32; 3]]) -> bool {
    let Some(targets) = Targets::without_repeats(triangles) else { return false };
    directed_edges(triangles).all(|(from, to)| targets.of(to).binary_search(&from).is_ok())
}

fn directed_edges(triangles: &[[u32; 3]]) -> impl Iterator<Item = (u32, u32)> {
    triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)])
}

/// For each vertex the sorted ends of the directed edges that leave it, one list after the other.
struct Targets {
    /// Where each vertex's list ends; it starts where the one before it ends.
    ends: Vec<usize>,
    lists: Vec<u32>,
}

impl Targets {
    /// `None` when a directed edge occurs twice.
    fn without_repeats(triangles: &[[u32; 3]]) -> Option<Self> {
        let vertices = triangles.iter().flatten().max().map_or(0, |&last| last as usize + 1);
        let mut ends = vec![0; vertices];
        for (from, _) in directed_edges(triangles) {
            ends[from as usize] += 1;
        }
        let mut sum = 0;
        for end in &mut ends {
            // For now the start of the list; filling it moves this to its end.
            sum += std::mem::replace(end, sum);
        }
        let mut lists = vec![0; sum];
        for (from, to) in directed_edges(triangles) {
            lists[ends[from as usize]] = to;
            ends[from as usize] += 1;
        }
        let mut start = 0;
        for &end in &ends {
            let list = &mut lists[start..end];
            list.sort_unstable();
            if list.windows(2).any(|pair| pair[0] == pair[1]) {
                return None;
            }
            start = end;
        }
        Some(Self { ends, lists })
    }

    fn of(&self, vertex: u32) -> &[u32] {
        let vertex = vertex as usize;
        let start = if vertex == 0 { 0 } else { self.ends[vertex - 1] };
        &self.lists[start..self.ends[vertex]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tetrahedron_is_and_its_damaged_forms_are_not() {
        let whole = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        assert!(is_oriented_manifold(&whole));
        assert!(!is_oriented_manifold(&whole[1..]), "an open edge");
        let mut flipped = whole;
        flipped[2].swap(0, 1);
        assert!(!is_oriented_manifold(&flipped), "a flipped triangle");
        let doubled = [whole, whole].concat();
        assert!(!is_oriented_manifold(&doubled), "every edge twice");
    }
}
