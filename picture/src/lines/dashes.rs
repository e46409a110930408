//! Dashes that run on from one edge to the next: curves consist of edges that are shorter than a dash.

use crate::view::lens::ScreenPoint;

/// Where a line is within the dashes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct DashRun {
    /// Pixels from the beginning of the dashes to the first end of the line.
    pub(crate) start: f32,
    /// Whether the dashes are counted from the first end to the second, or back.
    pub(crate) is_forward: bool,
}

impl DashRun {
    /// Pixels from the beginning of the dashes to a point `distance` pixels from the first end of the line.
    pub(crate) fn at(self, distance: f32) -> f32 {
        if self.is_forward { self.start + distance } else { self.start - distance }
    }
}

/// The longest chain that is followed, in edges: chains of more would only cost time.
const LONGEST: usize = 1 << 16;

/// For each edge its place in the dashes of the chain that it belongs to. Chains go on with the edge that turns least.
pub(crate) fn dash_runs(edges: &[[u32; 2]], points: &[ScreenPoint]) -> Vec<DashRun> {
    let ends_at = Ends::new(edges, points.len());
    let mut runs: Vec<Option<DashRun>> = vec![None; edges.len()];
    for start in 0..edges.len() {
        if runs[start].is_some() {
            continue;
        }
        runs[start] = Some(DashRun { start: 0.0, is_forward: true });
        let [first, last] = edges[start];
        let length = distance(points, first, last);
        // Onwards from the second end, then the other way from the first, where distances are negative.
        for (mut from, mut to, mut travelled, sign) in [(first, last, length, 1.0), (last, first, 0.0, -1.0)] {
            for _ in 0..LONGEST {
                let free = ends_at.of(to).iter().filter(|&&edge| runs[edge as usize].is_none());
                let straightest = free
                    .map(|&edge| (edge, turn(points, [from, to, other_end(edges[edge as usize], to)])))
                    .filter(|(_, cosine)| *cosine > 0.0)
                    .max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)));
                let Some((edge, _)) = straightest else { break };
                let next = other_end(edges[edge as usize], to);
                let length = distance(points, to, next);
                let starts_here = edges[edge as usize][0] == to;
                let at_first_end = if starts_here { travelled } else { travelled + sign * length };
                runs[edge as usize] = Some(DashRun { start: at_first_end, is_forward: starts_here == (sign > 0.0) });
                travelled += sign * length;
                (from, to) = (to, next);
            }
        }
    }
    runs.into_iter().map(|run| run.unwrap_or(DashRun { start: 0.0, is_forward: true })).collect()
}

/// Which edges end at each vertex.
struct Ends {
    first: Vec<u32>,
    edges: Vec<u32>,
}

impl Ends {
    fn new(edges: &[[u32; 2]], vertices: usize) -> Self {
        let mut first = vec![0; vertices + 1];
        for vertex in edges.iter().flatten() {
            first[*vertex as usize + 1] += 1;
        }
        for vertex in 0..vertices {
            first[vertex + 1] += first[vertex];
        }
        let mut next = first.clone();
        let mut list = vec![0; edges.len() * 2];
        for (number, edge) in (0..).zip(edges) {
            for &vertex in edge {
                list[next[vertex as usize] as usize] = number;
                next[vertex as usize] += 1;
            }
        }
        Self { first, edges: list }
    }

    fn of(&self, vertex: u32) -> &[u32] {
        let [start, end] = [vertex, vertex + 1].map(|vertex| self.first[vertex as usize] as usize);
        &self.edges[start..end]
    }
}

fn other_end([a, b]: [u32; 2], end: u32) -> u32 {
    if a == end { b } else { a }
}

fn distance(points: &[ScreenPoint], a: u32, b: u32) -> f32 {
    points[a as usize].place().distance(points[b as usize].place())
}

/// Cosine of the turn at the middle one of three points.
fn turn(points: &[ScreenPoint], [a, b, c]: [u32; 3]) -> f32 {
    let [a, b, c] = [a, b, c].map(|vertex| points[vertex as usize].place());
    (b - a).normalize_or_zero().dot((c - b).normalize_or_zero())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(x: f32, y: f32) -> ScreenPoint {
        ScreenPoint { x, y, w: 1.0 }
    }

    /// Along a polyline whose edges point to and fro the dashes count pixels without a jump.
    #[test]
    fn dashes_run_on_along_a_chain() {
        let points: Vec<ScreenPoint> = (0..6).map(|i| point(10.0 * i as f32, (i % 2) as f32)).collect();
        let edges = [[2, 3], [1, 2], [3, 4], [5, 4], [0, 1]];
        let runs = dash_runs(&edges, &points);
        let mut places = vec![Vec::new(); points.len()];
        for (edge, run) in edges.iter().zip(&runs) {
            places[edge[0] as usize].push(run.at(0.0));
            places[edge[1] as usize].push(run.at(distance(&points, edge[0], edge[1])));
        }
        for (vertex, along) in places.iter().enumerate() {
            assert!(along.windows(2).all(|pair| (pair[0] - pair[1]).abs() < 1e-4), "vertex {vertex}: {along:?}");
        }
        let [begin, end] = [places[0][0], places[5][0]];
        assert!((end - begin - 5.0 * 101.0_f32.sqrt()).abs() < 1e-3, "{begin} to {end}");
    }

    #[test]
    fn chains_go_straight_on_at_crossings() {
        // A cross: four arms meet at vertex 0.
        let points = [point(0.0, 0.0), point(-5.0, 0.0), point(7.0, 0.0), point(0.0, -4.0), point(0.0, 3.0)];
        let edges = [[0, 1], [0, 3], [0, 2], [0, 4]];
        let runs = dash_runs(&edges, &points);
        assert_eq!(runs[0].at(0.0), runs[2].at(0.0));
        assert_ne!(runs[0].is_forward, runs[2].is_forward);
        assert_ne!(runs[1].is_forward, runs[3].is_forward);
    }
}
