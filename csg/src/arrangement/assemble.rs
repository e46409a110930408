//! The mesh of a boundary: what passes through, and beside it what was cut.

use planecut_kernel::DVec3;
use planecut_parallel::prelude::*;
use rustc_hash::FxHashMap;

use super::Arranged;
use super::facets::FacetKind;
use super::input::Input;
use super::kept::{Kept, KeptFacets};
use super::measures::{Sums, bounds_of, of_facets, of_triangles, total};
use super::merge::{Face, Merging};
use super::operand::Operand;
use super::pairing::{Fans, SEAM, fans};
use super::winding::Windings;
use crate::closed_mesh::connectivity::NO_TWIN;
use crate::ids::{HalfEdgeId, Id, InputTriangleId, InputVertexId, number32};
use crate::mesh::{Flaw, Mesh, MeshFace, Noise, SolidMeasures, may_be_noise, prove_part, proven};
use crate::weld::manifold::{repeated_edges, split_repeated_edges};

/// Triangles that one thread looks at in a row.
const CHUNK: usize = 1 << 13;

/// The part of a boundary that was cut, and the triangles beside it.
struct CutPart {
    /// Faces that are whole triangles come first.
    mesh: Mesh,
    /// The triangles of the input that faces are, those that come first.
    whole: Vec<InputTriangleId>,
    /// For each vertex the smallest vertex of the input that whole triangles at it have.
    origins: Vec<Option<InputVertexId>>,
    /// Whether triangles that pass through share it.
    is_shared: Vec<bool>,
}

impl Arranged<'_> {
    /// The boundary of what `is_solid` says of combinations of winding numbers, and its measures.
    pub(super) fn boundary(&self, is_solid: impl Fn(&Windings) -> bool) -> Result<(Mesh, SolidMeasures, Noise), Flaw> {
        let kept = self.kept(&is_solid);
        self.boundary_of(&kept, Merging::WithinRounding).or_else(|_| self.boundary_of(&kept, Merging::Exact))
    }

    fn boundary_of(&self, kept: &KeptFacets, merging: Merging) -> Result<(Mesh, SolidMeasures, Noise), Flaw> {
        let part = self.cut_part(kept, merging)?;
        let passing = self.passing(kept);
        let mesh = self.assembled(&passing, &part);
        if mesh.triangles.is_empty() {
            return Ok((mesh, SolidMeasures::default(), Noise::default()));
        }
        let bounds = bounds_of(&mesh.positions);
        let middle = 0.5 * bounds.min + 0.5 * bounds.max;
        let of_cut = of_facets(self, &kept.flat, middle);
        let operands = self.arrangement.surface.input.operands.iter().zip(&passing);
        let mut sums: Vec<Sums> = operands.map(|(own, passing)| of_passing(own, passing, middle)).collect();
        sums.push(of_cut);
        let solid = total(&sums).solid(middle, &bounds);
        if may_be_noise(&part.mesh) {
            let (mesh, noise) = proven(mesh, &solid, None, false)?;
            return Ok((mesh, solid, noise));
        }
        prove_part(&part.mesh, middle, [of_cut.six_volume.value() / 6.0, of_cut.area.value()], solid.area)?;
        Ok((mesh, solid, Noise::default()))
    }

    /// The triangles that were cut out of others, and those that are whole but share a vertex with these.
    fn cut_part(&self, kept: &KeptFacets, merging: Merging) -> Result<CutPart, Flaw> {
        let faces = self.faces(kept, merging);
        let filled = self.filled(&faces);
        let triangles = &filled.triangles;
        let mut triangle_faces = Vec::with_capacity(triangles.len());
        for (face, count) in (0..).zip(&filled.counts) {
            triangle_faces.extend(std::iter::repeat_n(face, *count as usize));
        }
        let twins = self.twins(&kept.values, &faces, &filled, &triangle_faces);
        let is_pair = |(half_edge, twin): (u32, &u32)| match *twin {
            NO_TWIN => false,
            SEAM => true,
            twin => twins[twin as usize] == half_edge,
        };
        if !(0..).zip(&twins).all(is_pair) {
            return Err(Flaw::Open);
        }
        let corners = self.input_corners(&faces, &triangle_faces);
        let surface = &self.arrangement.surface;
        let is_shared = |vertex: InputVertexId| !surface.is_core(vertex);
        let Fans { vertices, points, inputs } = fans(triangles, &twins, &corners, is_shared);
        let mut mesh = Mesh {
            positions: points.iter().map(|point| self.arrangement.points.at(surface, *point)).collect(),
            triangles: vertices,
            triangle_faces,
            faces: faces.par_iter().map(|face| self.mesh_face(&face.kept)).collect(),
            materials: Vec::new(),
        };
        if let Some(repeated) = repeated_edges(&mesh) {
            let side = |half_edge: u32| HalfEdgeId::from_index(half_edge as usize);
            let mut labels = (0..number32(triangles.len())).map(|t| [0, 1, 2].map(|k| side(3 * t + k))).collect();
            split_repeated_edges(&mut mesh, &mut labels, repeated, |piece| side(twins[piece.index()]));
        }
        let mut origins = inputs;
        origins.resize(mesh.positions.len(), None);
        let shared: Vec<bool> = origins.iter().map(|input| input.is_some_and(is_shared)).collect();
        let triangle = |face: &Face| match self.facets.kind(face.kept.facet) {
            FacetKind::Triangle(triangle) => Some(surface.number(triangle)),
            _ => None,
        };
        let whole = faces.iter().map_while(triangle).collect();
        Ok(CutPart { mesh, whole, origins, is_shared: shared })
    }

    /// For each corner of a whole triangle the vertex of the input that it is.
    fn input_corners(&self, faces: &[Face], face_of: &[u32]) -> Vec<Option<[InputVertexId; 3]>> {
        let surface = &self.arrangement.surface;
        let of_triangle = |face: &u32| {
            let kept = &faces[*face as usize].kept;
            let FacetKind::Triangle(triangle) = self.facets.kind(kept.facet) else { return None };
            let [a, b, c] = surface.triangle(triangle).corners.map(|corner| corner.vertex);
            Some(if kept.is_flipped { [a, c, b] } else { [a, b, c] })
        };
        face_of.iter().map(of_triangle).collect()
    }

    fn mesh_face(&self, kept: &Kept) -> MeshFace {
        let surface = &self.arrangement.surface;
        let triangle = surface.triangle(self.facets.triangle(&self.arrangement.cells, kept.facet));
        MeshFace { normal: surface.input.normal(&triangle, kept.is_flipped), material: kept.material }
    }

    /// For each operand the triangles that pass through, and whether they are turned over.
    fn passing(&self, kept: &KeptFacets) -> Vec<Vec<(u32, bool)>> {
        let (input, patches) = (self.arrangement.surface.input, &self.arrangement.patches);
        let of_operand = |operand: usize| {
            let all = (0..number32(input.operands[operand].triangles().len())).into_par_iter().with_min_len(CHUNK);
            let keep = |triangle: u32| {
                let patch = patches.of(operand, triangle)?;
                kept.patches[patch.index()].map(|is_flipped| (triangle, is_flipped))
            };
            all.filter_map(keep).collect()
        };
        (0..input.operands.len()).into_par_iter().map(of_operand).collect()
    }

    /// All in one mesh: triangles that are whole and vertices of the input in the order of the input, then the others. So the outcome does
    /// not depend on which of them were looked at.
    fn assembled(&self, passing: &[Vec<(u32, bool)>], part: &CutPart) -> Mesh {
        let input = self.arrangement.surface.input;
        let mut mesh = Mesh::default();
        let (numbers, of_part) = number_vertices(input, passing, part, &mut mesh.positions);
        let cut = &part.mesh;
        let first_of_face = starts(&cut.triangle_faces, cut.faces.len());
        let add_cut = |mesh: &mut Mesh, face: usize| {
            for triangle in &cut.triangles[first_of_face[face]..first_of_face[face + 1]] {
                mesh.triangles.push(triangle.map(|vertex| of_part[vertex as usize]));
                mesh.triangle_faces.push(number32(mesh.faces.len()));
            }
            mesh.faces.push(cut.faces[face]);
        };
        for (operand, passing) in passing.iter().enumerate() {
            let (own, numbers) = (&input.operands[operand], &numbers[operand]);
            let (first, end) = (input.number(operand, 0), input.number(operand, number32(own.triangles().len())));
            let cut_here = part.whole.partition_point(|t| *t < first)..part.whole.partition_point(|t| *t < end);
            let mut rest = &passing[..];
            for face in cut_here {
                let before = part.whole[face].number() - first.number();
                let (now, later) = rest.split_at(rest.partition_point(|(triangle, _)| *triangle < before));
                add_passing(&mut mesh, (input, operand), numbers, now);
                add_cut(&mut mesh, face);
                rest = later;
            }
            add_passing(&mut mesh, (input, operand), numbers, rest);
        }
        (part.whole.len()..cut.faces.len()).for_each(|face| add_cut(&mut mesh, face));
        mesh
    }
}

/// Where the triangles of each face begin, and where those of the last one end.
fn starts(faces: &[u32], count: usize) -> Vec<usize> {
    let mut starts = vec![0; count + 1];
    faces.iter().for_each(|face| starts[*face as usize + 1] += 1);
    for face in 0..count {
        starts[face + 1] += starts[face];
    }
    starts
}

/// The numbers that vertices get: those of each operand, and those of the cut part. Their places are added to a list.
fn number_vertices(
    input: &Input<'_>,
    passing: &[Vec<(u32, bool)>],
    part: &CutPart,
    positions: &mut Vec<DVec3>,
) -> (Vec<Vec<u32>>, Vec<u32>) {
    // how many vertices each vertex of an operand becomes
    let count = |(own, passing): (&Operand<'_>, &Vec<(u32, bool)>)| {
        let mut counts = vec![0_u32; own.positions().len()];
        for (triangle, _) in passing {
            own.triangles()[*triangle as usize].iter().for_each(|vertex| counts[*vertex as usize] = 1);
        }
        counts
    };
    let mut numbers: Vec<Vec<u32>> = input.operands.par_iter().zip(passing.par_iter()).map(count).collect();
    for (origin, is_shared) in part.origins.iter().zip(&part.is_shared) {
        if let Some(vertex) = origin {
            let (operand, vertex) = input.of_vertex(*vertex);
            let count = &mut numbers[operand][vertex as usize];
            *count = if *is_shared { 1 } else { *count + 1 };
        }
    }
    for (own, numbers) in input.operands.iter().zip(&mut numbers) {
        for (number, position) in numbers.iter_mut().zip(own.positions()) {
            let count = std::mem::replace(number, number32(positions.len()));
            positions.extend(std::iter::repeat_n(*position, count as usize));
        }
    }
    let mut taken: FxHashMap<InputVertexId, u32> = FxHashMap::default();
    let mut of_part = Vec::with_capacity(part.origins.len());
    for ((origin, is_shared), position) in part.origins.iter().zip(&part.is_shared).zip(&part.mesh.positions) {
        of_part.push(match origin {
            Some(vertex) => {
                let (operand, own) = input.of_vertex(*vertex);
                let taken = taken.entry(*vertex).or_insert(0);
                let number = numbers[operand][own as usize] + *taken;
                *taken += u32::from(!*is_shared);
                number
            }
            None => {
                positions.push(*position);
                number32(positions.len()) - 1
            }
        });
    }
    (numbers, of_part)
}

/// Adds triangles that pass through.
fn add_passing(mesh: &mut Mesh, (input, operand): (&Input<'_>, usize), numbers: &[u32], passing: &[(u32, bool)]) {
    let own = &input.operands[operand];
    let corners = |(triangle, is_flipped): &(u32, bool)| {
        let [a, b, c] = own.triangles()[*triangle as usize];
        if *is_flipped { [a, c, b] } else { [a, b, c] }
    };
    let face = |entry: &(u32, bool)| MeshFace {
        normal: input.normal(&input.triangle(operand, entry.0), entry.1),
        material: own.material(entry.0),
    };
    let first = number32(mesh.faces.len());
    let all = passing.par_iter().with_min_len(CHUNK);
    let triangle = |entry: &(u32, bool)| corners(entry).map(|vertex| numbers[vertex as usize]);
    mesh.triangles.extend(all.clone().map(triangle).collect::<Vec<[u32; 3]>>());
    mesh.faces.extend(all.map(face).collect::<Vec<MeshFace>>());
    mesh.triangle_faces.extend(first..first + number32(passing.len()));
}

/// Sums over triangles that pass through.
fn of_passing(own: &Operand<'_>, passing: &[(u32, bool)], middle: DVec3) -> Sums {
    let place = |(triangle, is_flipped): &(u32, bool)| {
        let [a, b, c] = own.triangles()[*triangle as usize].map(|vertex| own.positions()[vertex as usize] - middle);
        if *is_flipped { [a, c, b] } else { [a, b, c] }
    };
    of_triangles(passing, place)
}
