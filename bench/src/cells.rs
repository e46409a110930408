//! Voronoi cells from the shared data: sites with their boxes, the half-spaces that cut them, and their known volumes.

use crate::inputs::{Plane, dot};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// One Voronoi cell before it is cut.
#[derive(Debug, Clone)]
pub struct Cell {
    /// The point that is nearer to every point of the cell than any other site.
    pub site: [f64; 3],
    /// The corners of the container, in which every cell begins.
    pub container: [[f64; 3]; 2],
    /// The half-spaces that bound the cell, walls of the container left out, in the order of the file.
    pub cuts: Vec<Plane>,
    /// The volume by voro++, as the file has it.
    pub volume: f64,
}

impl Cell {
    /// The six walls of the container.
    #[must_use]
    pub fn walls(&self) -> [Plane; 6] {
        let [low, high] = self.container;
        std::array::from_fn(|i| {
            let (axis, sign) = (i / 2, if i % 2 == 0 { -1.0 } else { 1.0 });
            let mut normal = [0.0; 3];
            normal[axis] = sign;
            Plane { normal, offset: if i % 2 == 0 { -low[axis] } else { high[axis] } }
        })
    }

    /// The same cell with its cuts replaced by the bisectors to the `count` nearest of `sites`, nearest first, as a
    /// program meets them that does not know the neighbours: most cut nothing.
    #[must_use]
    pub fn among_nearest(&self, sites: &[[f64; 3]], count: usize) -> Self {
        let towards = |site: &[f64; 3]| -> [f64; 3] { std::array::from_fn(|i| site[i] - self.site[i]) };
        let mut others: Vec<_> = sites.iter().filter(|site| **site != self.site).map(towards).collect();
        others.sort_by(|a, b| dot(*a, *a).total_cmp(&dot(*b, *b)));
        others.truncate(count);
        let bisector = |v: [f64; 3]| Plane { normal: v, offset: dot(v, self.site) + dot(v, v) / 2.0 };
        Self { cuts: others.into_iter().map(bisector).collect(), ..self.clone() }
    }
}

/// Where the packing of 216 cells lies beside the project.
#[must_use]
pub fn packing_file() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/cells/pack_six_cube.cells.json")
}

/// Reads all cells of a file.
///
/// # Errors
/// What is missing, in one sentence.
pub fn read(file: &Path) -> Result<Vec<Cell>, String> {
    let text = std::fs::read_to_string(file).map_err(|error| format!("cannot read the Voronoi cells: {error}"))?;
    let value: Value =
        serde_json::from_str(&text).map_err(|error| format!("the Voronoi cells are no JSON: {error}"))?;
    let container = [numbers(&value["box_lo"])?, numbers(&value["box_hi"])?];
    let cells = value["cells"].as_array().ok_or("the file has no cells")?;
    cells.iter().map(|cell| read_cell(cell, container)).collect()
}

fn read_cell(cell: &Value, container: [[f64; 3]; 2]) -> Result<Cell, String> {
    let half_spaces = cell["halfspaces"].as_array().ok_or("a cell has no half-spaces")?;
    let neighbours = cell["neighbors"].as_array().ok_or("a cell has no neighbours")?;
    // Negative neighbours are walls.
    let inner = half_spaces.iter().zip(neighbours).filter(|(_, neighbour)| neighbour.as_i64() >= Some(0));
    let cuts = inner.map(|(half_space, _)| {
        let [x, y, z, offset] = numbers(half_space)?;
        Ok(Plane { normal: [x, y, z], offset })
    });
    Ok(Cell {
        site: numbers(&cell["site"])?,
        container,
        cuts: cuts.collect::<Result<_, String>>()?,
        volume: cell["volume"].as_f64().ok_or("a cell has no volume")?,
    })
}

fn numbers<const N: usize>(value: &Value) -> Result<[f64; N], String> {
    let list: Option<Vec<f64>> = value.as_array().and_then(|list| list.iter().map(Value::as_f64).collect());
    list.and_then(|list| list.try_into().ok()).ok_or_else(|| format!("expected {N} numbers, found {value}"))
}
