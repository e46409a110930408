//! The report: what `--report` writes and `info` prints.
//!
//! Names, meanings and order are fixed (`docs/command-line.md`); scripts read them. Numbers that are not finite become
//! `null` when they are written, which is what `serde_json` does with them.

use std::time::Duration;

use planecut::blocks::{BlockPlan, Pieces};
use planecut::check::{Measures, TopologyReport, check_topology, measure_triangles};
use planecut::csg::coarsen::{Bounded, Coarsened};
use planecut::csg::{Evaluation, ModelSummary, Noise, SolidMeasures, StageTimes, Tree};
use planecut::export::{Engine, MassProperties, Written};
use planecut::import::Warning;
use planecut::kernel::DVec3;
use planecut::kernel::sign::Counts;
use serde::Serialize;

/// The report of one input.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Report {
    /// Version of the program.
    planecut: &'static str,
    /// The input's path as it was given.
    input: String,
    /// The input's format.
    format: &'static str,
    /// What the model holds; `null` for a mesh that bounds no solid.
    model: Option<ModelPart>,
    /// The solid; of a mesh that bounds none but is closed, what its triangles enclose.
    solid: Option<SolidPart>,
    /// The mesh.
    mesh: MeshPart,
    /// What was removed from the mesh as rounding noise.
    noise: NoisePart,
    /// The signs that were asked for.
    signs: SignsPart,
    /// How several inputs were combined; of one nothing is said of it.
    #[serde(skip_serializing_if = "Option::is_none")]
    combine: Option<CombinePart>,
    /// What `edit` did; other commands say nothing of it.
    #[serde(skip_serializing_if = "Option::is_none")]
    edit: Option<EditPart>,
    /// The blocks in which the model was evaluated.
    #[serde(skip_serializing_if = "Option::is_none")]
    blocks: Option<BlocksPart>,
    /// What `coarsen` did; other commands say nothing of it.
    #[serde(skip_serializing_if = "Option::is_none")]
    coarsen: Option<CoarsenPart>,
    /// Where the time went, in milliseconds.
    pub(crate) time_ms: Times,
    /// How many solids that the input states are left out; warnings name them.
    left_out: usize,
    /// What was left out or is doubtful.
    warnings: Vec<String>,
}

impl Report {
    /// The report on a model that was evaluated; export, preview and total times are still to be filled in.
    pub(crate) fn of_model(
        input: String,
        format: &'static str,
        materials: usize,
        evaluation: &Evaluation,
        mesh: MeshPart,
    ) -> Self {
        Self {
            planecut: env!("CARGO_PKG_VERSION"),
            input,
            format,
            model: Some(ModelPart::new(&evaluation.model, materials)),
            solid: Some(SolidPart::new(&evaluation.solid)),
            mesh,
            noise: NoisePart::new(evaluation.noise),
            signs: SignsPart::new(&evaluation.signs),
            combine: None,
            edit: None,
            blocks: None,
            coarsen: None,
            time_ms: Times::new(&evaluation.times),
            left_out: 0,
            warnings: Vec::new(),
        }
    }

    /// The report on a model that was evaluated in blocks; export and total times are still to be filled in.
    pub(crate) fn of_blocks(
        input: String,
        format: &'static str,
        plan: &BlockPlan,
        pieces: &Pieces,
        vertices: Option<u64>,
    ) -> Self {
        let model = plan.model();
        let [of_pieces, triangles, faces] = pieces.mesh_counts();
        let count = |number: u64| usize::try_from(number).unwrap_or(usize::MAX);
        let summary = ModelPart {
            brushes: count(model.brushes),
            planes: count(model.planes),
            empty_brushes: count(model.empty),
            redundant_planes: count(model.redundant_planes),
            snapped_planes: count(model.snapped_planes),
            materials: plan.materials().len(),
            unbounded_brushes: count(model.unbounded),
            brush_volume_sum: model.brush_volume_sum,
            meshes: 0,
            mesh_triangles: 0,
        };
        let mesh = MeshPart {
            vertices: count(vertices.unwrap_or(of_pieces)),
            triangles: count(triangles),
            faces: Some(count(faces)),
            components: None,
            genus: None,
            // each piece is, and that they fit together is proven before there is a report
            watertight: true,
            manifold: true,
            volume: pieces.mesh_volume() + 0.0,
        };
        let walls: usize = (0..3).map(|axis| plan.grid().walls(axis).len().saturating_sub(2)).sum();
        let blocks = BlocksPart { count: pieces.count(), walls, seam_edges: pieces.seam_edges() };
        Self {
            planecut: env!("CARGO_PKG_VERSION"),
            input,
            format,
            model: Some(summary),
            solid: Some(SolidPart::new(&pieces.solid())),
            mesh,
            noise: NoisePart::new(pieces.noise()),
            signs: SignsPart::new(&pieces.signs()),
            combine: None,
            edit: None,
            blocks: Some(blocks),
            coarsen: None,
            time_ms: Times::default(),
            left_out: 0,
            warnings: Vec::new(),
        }
    }

    /// Says how long reading, evaluating and encoding took.
    pub(crate) fn set_times(&mut self, import: Duration, evaluate: Duration, export: Duration) {
        let [import, evaluate, export] = [import, evaluate, export].map(milliseconds);
        self.time_ms = Times { import, evaluate, export, ..Times::default() };
    }

    /// Says what is to be warned of, after what was said before.
    pub(crate) fn warn(&mut self, warnings: &[Warning]) {
        self.left_out += warnings.iter().map(|warning| warning.left_out).sum::<usize>();
        self.warnings.extend(warnings.iter().map(ToString::to_string));
    }

    /// Says what of the solid's parts is written.
    pub(crate) fn set_parts(&mut self, mesh: MeshPart) {
        self.mesh = mesh;
    }

    /// Says how many materials the input has.
    pub(crate) fn set_materials(&mut self, materials: usize) {
        if let Some(model) = &mut self.model {
            model.materials = materials;
        }
    }

    /// Says how many leaves of the model are closed meshes, and how many triangles these have.
    pub(crate) fn set_meshes(&mut self, leaves: MeshLeaves) {
        if let Some(model) = &mut self.model {
            (model.meshes, model.mesh_triangles) = (leaves.meshes, leaves.triangles);
        }
    }

    /// Says of what format the first of several inputs is, and how they were combined.
    pub(crate) fn set_inputs(&mut self, (format, combined): (&'static str, Option<(String, Vec<String>)>)) {
        self.format = format;
        self.combine = combined.map(|(operation, inputs)| CombinePart { operation, inputs });
    }

    /// The report on a mesh that was read from a file of the given format.
    pub(crate) fn of_mesh(input: String, format: &'static str, topology: &TopologyReport) -> Self {
        let Measures { volume, area, centroid, min, max } = topology.measures;
        let measures = SolidMeasures { volume, area, centroid: centroid.into(), min: min.into(), max: max.into() };
        Self {
            planecut: env!("CARGO_PKG_VERSION"),
            input,
            format,
            model: None,
            solid: topology.watertight.then(|| SolidPart::new(&measures)),
            mesh: MeshPart::new(topology, None),
            noise: NoisePart::new(Noise::default()),
            signs: SignsPart::new(&Counts::default()),
            combine: None,
            edit: None,
            blocks: None,
            coarsen: None,
            time_ms: Times::default(),
            left_out: 0,
            warnings: Vec::new(),
        }
    }

    /// Takes what a report says of the model and its solid, and the times that it took.
    pub(crate) fn take_model(&mut self, other: Self) {
        self.model = other.model;
        self.solid = other.solid;
        self.noise = other.noise;
        self.signs = other.signs;
        self.time_ms = other.time_ms;
    }

    /// Says that cells were written instead of the skin: how many, the sum of their volumes, and their meshes.
    pub(crate) fn set_cells(&mut self, count: usize, volume: f64, mesh: MeshPart) {
        if let Some(solid) = &mut self.solid {
            solid.cells = Some(count);
            solid.volume = volume + 0.0;
        }
        self.mesh = mesh;
    }

    /// Says what the first file holds of the mesh, where its precision is not that of the mesh.
    pub(crate) fn set_written(&mut self, written: &Written) {
        self.mesh = self.mesh.written(written);
    }

    /// Says what edits were done.
    pub(crate) fn set_edit(&mut self, edit: EditPart) {
        self.edit = Some(edit);
    }

    /// Says what became of the cells, whose meshes were written.
    pub(crate) fn set_coarsen(&mut self, coarsen: CoarsenPart, mesh: MeshPart) {
        self.coarsen = Some(coarsen);
        self.mesh = mesh;
    }

    /// The report as a file: JSON with line breaks.
    pub(crate) fn to_json(&self) -> String {
        let json = serde_json::to_string_pretty(self).expect("the report holds only texts, numbers and lists");
        json + "\n"
    }
}

#[derive(Debug, Clone, Serialize)]
struct ModelPart {
    brushes: usize,
    planes: usize,
    empty_brushes: usize,
    redundant_planes: usize,
    snapped_planes: usize,
    materials: usize,
    unbounded_brushes: usize,
    brush_volume_sum: f64,
    /// Brushes that are closed meshes, and the triangles of all of these.
    meshes: usize,
    mesh_triangles: usize,
}

impl ModelPart {
    fn new(summary: &ModelSummary, materials: usize) -> Self {
        Self {
            brushes: summary.brushes,
            planes: summary.planes,
            empty_brushes: summary.empty.len(),
            redundant_planes: summary.redundant_planes,
            snapped_planes: summary.snapped_planes,
            materials,
            unbounded_brushes: summary.unbounded.len(),
            brush_volume_sum: summary.brush_volume_sum,
            meshes: 0,
            mesh_triangles: 0,
        }
    }
}

/// Leaves of a tree that are closed meshes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MeshLeaves {
    meshes: usize,
    triangles: usize,
}

impl MeshLeaves {
    /// Those of a tree.
    pub(crate) fn of(tree: &Tree) -> Self {
        let meshes = || tree.brushes().iter().filter_map(|brush| brush.mesh.as_ref());
        Self { meshes: meshes().count(), triangles: meshes().map(|mesh| mesh.mesh().triangles().len()).sum() }
    }
}

/// Several inputs that became one solid.
#[derive(Debug, Clone, Serialize)]
struct CombinePart {
    operation: String,
    /// Their paths as they were given.
    inputs: Vec<String>,
}

/// How a model was evaluated in blocks.
#[derive(Debug, Clone, Serialize)]
struct BlocksPart {
    /// Blocks with a brush.
    count: usize,
    /// Walls between blocks, across all axes.
    walls: usize,
    /// Edges on walls in which the meshes of two blocks meet.
    seam_edges: u64,
}

#[derive(Debug, Clone, Serialize)]
struct NoisePart {
    /// How many edges were contracted or gaps closed.
    collapsed: usize,
    /// The largest distance by which a vertex moved in that.
    thickest: f64,
}

impl NoisePart {
    fn new(Noise { collapsed, thickest }: Noise) -> Self {
        Self { collapsed, thickest }
    }
}

#[derive(Debug, Clone, Serialize)]
struct SolidPart {
    volume: f64,
    area: f64,
    centroid: [f64; 3],
    min: [f64; 3],
    max: [f64; 3],
    /// Number of convex cells, where they were asked for.
    cells: Option<usize>,
}

impl SolidPart {
    fn new(solid: &SolidMeasures) -> Self {
        // Adding zero turns `-0` into `0`.
        let array = |v: DVec3| (v + DVec3::ZERO).to_array();
        Self {
            volume: solid.volume + 0.0,
            area: solid.area,
            centroid: array(solid.centroid),
            min: array(solid.min),
            max: array(solid.max),
            cells: None,
        }
    }
}

/// Counts of a mesh, from its indices, and its volume, from its triangles.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct MeshPart {
    vertices: usize,
    triangles: usize,
    /// Planar regions; `null` for meshes from files, which do not say.
    faces: Option<usize>,
    /// `null` where the mesh was never in memory as a whole.
    components: Option<usize>,
    /// Handles, summed over components; `null` where the mesh is not manifold, or was never in memory as a whole.
    genus: Option<i64>,
    watertight: bool,
    manifold: bool,
    volume: f64,
}

impl MeshPart {
    /// The mesh of a model.
    pub(crate) fn of_solid(topology: &TopologyReport, faces: usize) -> Self {
        Self::new(topology, Some(faces))
    }

    /// What a file holds of this mesh. Where no triangle is missing there, only the volume is another.
    fn written(&self, written: &Written) -> Self {
        let Written { positions, triangles, faces, is_reduced } = written;
        if *is_reduced {
            return Self::of_solid(&check_topology(positions, triangles), *faces);
        }
        let volume = measure_triangles(positions, triangles).map_or(self.volume, |measures| measures.volume + 0.0);
        Self { volume, ..self.clone() }
    }

    fn new(topology: &TopologyReport, faces: Option<usize>) -> Self {
        Self {
            vertices: topology.vertices,
            triangles: topology.triangles,
            faces,
            components: Some(topology.components),
            genus: topology.genus,
            watertight: topology.watertight,
            manifold: topology.manifold,
            volume: topology.measures.volume + 0.0,
        }
    }
}

#[derive(Debug, Clone, Serialize)]
struct SignsPart {
    total: u64,
    filtered: u64,
    small_int: u64,
    big: u64,
}

impl SignsPart {
    fn new(counts: &Counts) -> Self {
        let Counts { total, small_int, big } = *counts;
        Self { total, filtered: counts.filtered(), small_int, big }
    }
}

/// Edits of a live model, and how long they took.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct EditPart {
    pub(crate) edits: usize,
    /// `null` where there were none.
    pub(crate) median_ms: Option<f64>,
    pub(crate) p99_ms: Option<f64>,
    /// How long the evaluation of the same model takes: the median, where that was done after each edit.
    pub(crate) fresh_ms: Option<f64>,
    pub(crate) same_as_fresh: bool,
}

/// Cells that became fewer.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct CoarsenPart {
    cells_in: usize,
    cells_out: usize,
    /// Of the solid.
    volume_in: f64,
    /// Of the union of the cells.
    volume_out: f64,
    /// What the union adds, relative to the solid.
    excess: f64,
    exact_merges: usize,
    volume_sum_in: f64,
    volume_sum_out: f64,
    sum_excess: f64,
    /// What the input was taken for: `cells`, or the surface of a `solid`, one that was `filled`, or a `shell`.
    taken_as: &'static str,
    /// Of a shell.
    thickness: Option<f64>,
    /// By how much less than its radius the ball covers what is kept clear of it.
    clear_tolerance: Option<f64>,
    /// How long it took, in milliseconds; reading and evaluating the input are not in it.
    time_ms: f64,
    /// The engine that limits were taken from.
    engine: Option<&'static str>,
    /// How many cells rigid bodies have as boxes; `null` where none is written.
    boxes: Option<usize>,
    /// Of rigid bodies.
    mass: Option<MassPart>,
}

/// Mass and inertia, in metres and kilograms.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct MassPart {
    density: f64,
    volume: f64,
    mass: f64,
    center: [f64; 3],
    /// About the centre: xx, yy, zz, xy, xz and yz of the tensor.
    inertia: [f64; 6],
    /// What it was integrated over: the `input`, or the union of the `colliders`.
    of: &'static str,
}

impl MassPart {
    pub(crate) fn new(mass: &MassProperties, density: f64, is_of_input: bool) -> Self {
        let MassProperties { volume, mass, center, moments, products } = *mass;
        // adding zero turns `-0` into `0`
        let [x, y, z] = (moments + DVec3::ZERO).to_array();
        let [xy, xz, yz] = (products + DVec3::ZERO).to_array();
        let of = if is_of_input { "input" } else { "colliders" };
        let center = (center + DVec3::ZERO).to_array();
        Self { density, volume, mass, center, inertia: [x, y, z, xy, xz, yz], of }
    }
}

impl CoarsenPart {
    pub(crate) fn new(coarsened: &Coarsened, bounded: Option<Bounded>, time: Duration) -> Self {
        let (taken_as, thickness) = match bounded {
            None => ("cells", None),
            Some(Bounded::Solid) => ("solid", None),
            Some(Bounded::Filled) => ("filled", None),
            Some(Bounded::Shell { thickness }) => ("shell", Some(thickness)),
        };
        Self {
            taken_as,
            thickness,
            clear_tolerance: coarsened.clear_tolerance,
            cells_in: coarsened.cells_in,
            cells_out: coarsened.cells.len(),
            volume_in: coarsened.volume_in,
            volume_out: coarsened.volume_out,
            excess: coarsened.excess(),
            exact_merges: coarsened.exact_merges,
            volume_sum_in: coarsened.volume_sum_in,
            volume_sum_out: coarsened.volume_sum_out,
            sum_excess: coarsened.sum_excess(),
            time_ms: milliseconds(time),
            engine: None,
            boxes: None,
            mass: None,
        }
    }

    /// Says what the colliders are for.
    pub(crate) fn for_engine(self, engine: Option<Engine>) -> Self {
        Self { engine: engine.map(Engine::name), ..self }
    }

    /// Says what rigid bodies are made of.
    pub(crate) fn with_body(self, boxes: usize, mass: MassPart) -> Self {
        Self { boxes: Some(boxes), mass: Some(mass), ..self }
    }
}

/// Milliseconds that each stage took; the total holds reading and checking as well.
#[derive(Debug, Clone, Default, Serialize)]
pub(crate) struct Times {
    pub(crate) import: f64,
    /// With taking the solid apart into cells and coarsening these, where that was asked for.
    pub(crate) evaluate: f64,
    weld: f64,
    triangulate: f64,
    pub(crate) export: f64,
    pub(crate) preview: f64,
    pub(crate) total: f64,
}

impl Times {
    fn new(times: &StageTimes) -> Self {
        Self {
            evaluate: milliseconds(times.evaluate),
            weld: milliseconds(times.weld),
            triangulate: milliseconds(times.triangulate),
            ..Self::default()
        }
    }
}

/// How long an evaluation took: from the model in memory to its mesh.
pub(crate) fn evaluation_time(times: &StageTimes) -> Duration {
    times.evaluate + times.weld + times.triangulate
}

/// A duration in milliseconds, to the microsecond.
pub(crate) fn milliseconds(duration: Duration) -> f64 {
    duration.as_micros() as f64 / 1e3
}
