//! Where each vertex of a tile goes when it is simplified.
//!
//! Vertices in one cell of a lattice, the same for all tiles of a height, become one. Those at which the boundary of the tile runs along a wall are apart from
//! others, because the neighbour must map them alike:
//!
//! - on one wall, those of a cell become one of them, by what both tiles know: the edges of the boundary, which are the same on both sides;
//! - on two walls or three, where more tiles meet of which some do not have all vertices, each goes to a place that depends on its own coordinates alone.
//!
//! A cluster is represented by the vertex of it that is nearest to the planes of its triangles, on a wall to the lines of its edges, in the mean of squares
//! weighted by the squares of areas or lengths (Lindstrom 2000, who takes the best point of space). A vertex of the input keeps the planes and edges
//! of what people build exactly where they are, and no tile leaves its box.

use planecut_kernel::DVec3;
use rustc_hash::FxHashMap;

use super::grid::TileWalls;
use super::quadric::Quadric;
use super::surface::Surface;

/// How much a vertex's distance from the mean of its cluster counts beside the distance from planes: enough where these are the same.
const TOWARDS_MEAN: f64 = 1e-3;

/// Number of places of a cell along the edges where walls meet.
const PLACES_ALONG_EDGE: f64 = 4.0;

/// Cells and places of one height.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lattice {
    /// The length of the edges of a cell.
    pub(super) cell: f64,
    /// A power of two, of which the coordinates of representatives are multiples.
    pub(super) step: f64,
}

/// The cell of a lattice that a vertex is in.
type Cell = [i64; 3];

impl Lattice {
    /// The nearest multiple of the step.
    pub(super) fn rounded(&self, value: f64) -> f64 {
        (value / self.step).round() * self.step + 0.0
    }

    fn cell(&self, at: DVec3) -> Cell {
        (at / self.cell).floor().to_array().map(|along| along as i64)
    }

    /// A place near one on several walls that depends on nothing else.
    fn along_edge(&self, at: DVec3, walls: u8) -> DVec3 {
        let part = self.cell / PLACES_ALONG_EDGE;
        DVec3::from_array([0, 1, 2].map(|axis| {
            let is_on_wall = walls & (1 << axis) != 0;
            if is_on_wall { at[axis] } else { (at[axis] / part).round() * part }
        }))
    }
}

/// On which walls a vertex of the boundary is: a bit for each axis.
const SHARED: u8 = 8;

/// The representative of each vertex.
pub(super) fn representatives(surface: &Surface, walls: &TileWalls, lattice: &Lattice) -> Vec<DVec3> {
    let open = surface.open_edges();
    let on_walls = vertices_on_walls(surface, &open, walls);
    let mut clusters = Clusters::new(surface, &on_walls, lattice);
    clusters.add_triangles(surface);
    clusters.add_open_edges(surface, &open, &on_walls);
    let chosen = clusters.choose(surface);
    let place = |vertex: usize| {
        let at = match clusters.of_vertex[vertex] {
            NONE => lattice.along_edge(surface.positions[vertex], on_walls[vertex]),
            cluster => chosen[cluster as usize],
        };
        at.map(|value| lattice.rounded(value))
    };
    (0..surface.positions.len()).map(place).collect()
}

/// For each vertex the walls that the boundary runs along there.
fn vertices_on_walls(surface: &Surface, open: &[[u32; 2]], walls: &TileWalls) -> Vec<u8> {
    let mut on_walls = vec![0; surface.positions.len()];
    for vertex in open.iter().flatten() {
        let at = surface.positions[*vertex as usize];
        for (axis, wall) in walls.iter().enumerate().flat_map(|(axis, pair)| pair.iter().map(move |wall| (axis, wall)))
        {
            if at[axis] == wall.at {
                on_walls[*vertex as usize] |= (1 << axis) | if wall.is_shared { SHARED } else { 0 };
            }
        }
    }
    on_walls
}

/// Stands for no cluster.
const NONE: u32 = u32::MAX;

/// Vertices that become one.
struct Clusters {
    /// Of each vertex its cluster; none where its place depends on itself alone.
    of_vertex: Vec<u32>,
    quadrics: Vec<Quadric>,
    /// Whether it is on a wall.
    is_on_wall: Vec<bool>,
    /// Points near clusters that quadrics and means are relative to, so that little of them is lost.
    origins: Vec<DVec3>,
}

impl Clusters {
    fn new(surface: &Surface, on_walls: &[u8], lattice: &Lattice) -> Self {
        let mut numbers: FxHashMap<(u8, Cell), u32> = FxHashMap::default();
        let (mut origins, mut is_on_wall) = (Vec::new(), Vec::new());
        let of_vertex = surface.positions.iter().zip(on_walls).map(|(at, walls)| {
            if walls.count_ones() > 1 {
                return NONE;
            }
            let cell = lattice.cell(*at);
            let mut key = cell;
            if let Some(axis) = [1, 2, 4].iter().position(|bit| bit == walls) {
                // a tile may be thinner than a cell: its two walls are apart, as its neighbours know one of them alone
                key[axis] = at[axis].to_bits().cast_signed();
            }
            *numbers.entry((*walls, key)).or_insert_with(|| {
                is_on_wall.push(*walls != 0);
                origins.push(DVec3::from_array(cell.map(|along| along as f64)) * lattice.cell);
                (origins.len() - 1) as u32
            })
        });
        let of_vertex = of_vertex.collect();
        Self { of_vertex, quadrics: vec![Quadric::default(); origins.len()], is_on_wall, origins }
    }

    /// Planes of triangles, for clusters within.
    fn add_triangles(&mut self, surface: &Surface) {
        for triangle in &surface.triangles {
            let [a, b, c] = surface.corners(*triangle);
            let normal = (b - a).cross(c - a);
            let [p, q, r] = triangle.map(|vertex| {
                let cluster = self.of_vertex[vertex as usize];
                // what lies within one tile is not known to the other
                if cluster == NONE || self.is_on_wall[cluster as usize] { NONE } else { cluster }
            });
            self.add(p, normal, a);
            if q != p {
                self.add(q, normal, a);
            }
            if r != p && r != q {
                self.add(r, normal, a);
            }
        }
    }

    fn add(&mut self, cluster: u32, normal: DVec3, point: DVec3) {
        if cluster != NONE {
            self.quadrics[cluster as usize].add(normal, point - self.origins[cluster as usize]);
        }
    }

    /// Lines of edges for clusters on walls, in an order that is the same on both sides.
    fn add_open_edges(&mut self, surface: &Surface, open: &[[u32; 2]], on_walls: &[u8]) {
        let ends = |edge: &[u32; 2]| {
            let mut ends = edge.map(|vertex| (surface.positions[vertex as usize].to_array(), vertex));
            ends.sort_by(|a, b| compare(a.0, b.0));
            ends
        };
        let mut edges: Vec<_> = open.iter().map(ends).collect();
        edges.sort_by(|a, b| compare(a[0].0, b[0].0).then_with(|| compare(a[1].0, b[1].0)));
        for [(low, from), (high, to)] in edges {
            let [low, high] = [low, high].map(DVec3::from_array);
            let [p, q] = [from, to].map(|vertex| self.of_vertex[vertex as usize]);
            let ends = [(p, from), (q, to)];
            for (cluster, vertex) in &ends[..if p == q { 1 } else { 2 }] {
                if let Some(axis) = [1, 2, 4].iter().position(|bit| on_walls[*vertex as usize] == *bit) {
                    self.add(*cluster, (high - low).cross(DVec3::AXES[axis]), low);
                }
            }
        }
    }

    /// The vertex that represents each cluster.
    fn choose(&self, surface: &Surface) -> Vec<DVec3> {
        let relative = |cluster: u32, at: DVec3| at - self.origins[cluster as usize];
        let mut members: Vec<(u32, [f64; 3])> = self
            .of_vertex
            .iter()
            .zip(&surface.positions)
            .filter(|(cluster, _)| **cluster != NONE)
            .map(|(cluster, at)| (*cluster, at.to_array()))
            .collect();
        // the order of coordinates is the same on both sides of a wall, that of numbers is not
        members.sort_unstable_by(|a, b| a.0.cmp(&b.0).then_with(|| compare(a.1, b.1)));
        let choose = |members: &[(u32, [f64; 3])]| {
            let cluster = members[0].0;
            let all = || members.iter().map(|(_, at)| DVec3::from_array(*at));
            let mean = all().map(|at| relative(cluster, at)).sum::<DVec3>() / members.len() as f64;
            let quadric = &self.quadrics[cluster as usize];
            let badness = |at: DVec3| {
                let at = relative(cluster, at);
                quadric.mean_square(at) + TOWARDS_MEAN * at.distance_squared(mean)
            };
            let least = all().map(|at| (badness(at), at)).min_by(|a, b| a.0.total_cmp(&b.0));
            least.map_or(DVec3::ZERO, |(_, at)| at)
        };
        // numbers of clusters are consecutive, and each has a member
        members.chunk_by(|a, b| a.0 == b.0).map(choose).collect()
    }
}

fn compare(a: [f64; 3], b: [f64; 3]) -> std::cmp::Ordering {
    let axes = a.iter().zip(&b).map(|(a, b)| a.total_cmp(b));
    axes.fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then)
}
