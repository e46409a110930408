//! `surface`: a field of heights in a text file beside the tree, as a solid.
//!
//! The solid is OpenSCAD's: each cell of the field is four triangles around the mean of its corners, and the bottom lies one below the lowest
//! height, or below 0 where that is lower.

use std::path::Path;

use planecut_csg::{ClosedMesh, MaterialId, MeshBody, Tree};
use planecut_kernel::DVec3;

use super::arguments::Arguments;
use super::import::Imported;
use super::problem::Problem;
use super::syntax::Node;
use crate::file::{MAX_MESH, read_file};

/// Heights on a grid, row by row.
struct Field {
    heights: Vec<f64>,
    columns: usize,
    rows: usize,
}

/// The solid below a field of heights. Like OpenSCAD, goes on without a file that is not there.
///
/// # Errors
/// [`Problem`] for an image, which is not supported.
pub(super) fn solid(node: &Node<'_>, folder: &Path, material: MaterialId) -> Result<Imported, Problem> {
    let arguments = Arguments::of(node, &["file", "center", "convexity", "invert"]);
    let file = arguments.text("file").unwrap_or_default();
    if Path::new(file).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png")) {
        let found = format!("a `surface` of `{}`, which is not supported", file.escape_debug());
        return Err(Problem::new(found, "heights as text, `.dat`"));
    }
    let bytes = match read_file(&folder.join(file), MAX_MESH) {
        Ok(bytes) => bytes,
        Err(error) => return Ok(Imported::LeftOut(format!("`{}` cannot be read ({error})", file.escape_debug()))),
    };
    let field = match Field::read(&String::from_utf8_lossy(&bytes)) {
        Ok(field) => field,
        Err(why) => return Ok(Imported::LeftOut(format!("`{}`:{why}", file.escape_debug()))),
    };
    let (positions, triangles) = field.mesh(arguments.is_set("center"));
    let mesh = ClosedMesh::new(&positions, &triangles, |_| 0);
    Ok(match mesh {
        Ok(mesh) => Imported::Solid(Tree::from(MeshBody::new(mesh, vec![material])), Vec::new()),
        Err(error) => Imported::LeftOut(error.to_string()),
    })
}

impl Field {
    /// Numbers between blanks, a line for each row; lines that are empty or begin with `#` count for nothing, and what a row lacks is 0.
    fn read(text: &str) -> Result<Self, String> {
        let mut rows: Vec<Vec<f64>> = Vec::new();
        for (number, line) in (1..).zip(text.lines()) {
            if line.trim().is_empty() || line.starts_with('#') {
                continue;
            }
            let height = |word: &str| match word.parse() {
                Ok(height) if f64::is_finite(height) => Ok(height),
                _ => Err(format!("{number}: found `{}`, expected a finite number", word.escape_debug())),
            };
            rows.push(line.split_whitespace().map(height).collect::<Result<_, _>>()?);
        }
        let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
        if rows.len() < 2 || columns < 2 {
            return Err(format!(" found {} rows of {columns} heights, expected two of two at least", rows.len()));
        }
        let count = rows.len();
        rows.iter_mut().for_each(|row| row.resize(columns, 0.0));
        Ok(Self { heights: rows.concat(), columns, rows: count })
    }

    fn height(&self, column: usize, row: usize) -> f64 {
        self.heights[row * self.columns + column]
    }

    /// Corners and triangles: the corners of the top first, then the middles of cells, then the rim of the bottom and its middle.
    fn mesh(&self, is_centered: bool) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let (columns, rows) = (self.columns, self.rows);
        let extent = DVec3::new((columns - 1) as f64, (rows - 1) as f64, 0.0);
        let origin = if is_centered { -0.5 * extent } else { DVec3::ZERO };
        let place = |x: f64, y: f64, z: f64| origin + DVec3::new(x, y, z);
        let mut positions = Vec::new();
        for row in 0..rows {
            positions.extend((0..columns).map(|column| place(column as f64, row as f64, self.height(column, row))));
        }
        let mut triangles = Vec::new();
        for row in 1..rows {
            for column in 1..columns {
                // counter-clockwise seen from above
                let corners = [(column - 1, row - 1), (column, row - 1), (column, row), (column - 1, row)];
                let mean = corners.iter().map(|(column, row)| self.height(*column, *row)).sum::<f64>() / 4.0;
                let middle = positions.len() as u32;
                positions.push(place(column as f64 - 0.5, row as f64 - 0.5, mean));
                let numbers = corners.map(|(column, row)| (row * columns + column) as u32);
                triangles.extend((0..4).map(|k| [numbers[k], numbers[(k + 1) % 4], middle]));
            }
        }
        self.close(&mut positions, &mut triangles, origin + 0.5 * extent);
        (positions, triangles)
    }

    /// Adds walls and bottom.
    fn close(&self, positions: &mut Vec<DVec3>, triangles: &mut Vec<[u32; 3]>, middle: DVec3) {
        let (columns, rows) = (self.columns, self.rows);
        let bottom = self.heights.iter().fold(0.0, |lowest: f64, height| lowest.min(height - 1.0));
        // the rim, counter-clockwise seen from above
        let south = (0..columns - 1).map(|column| (column, 0));
        let east = (0..rows - 1).map(|row| (columns - 1, row));
        let north = (1..columns).rev().map(|column| (column, rows - 1));
        let west = (1..rows).rev().map(|row| (0, row));
        let rim: Vec<u32> =
            south.chain(east).chain(north).chain(west).map(|(column, row)| (row * columns + column) as u32).collect();
        let first = positions.len() as u32;
        for corner in &rim {
            let above = positions[*corner as usize];
            positions.push(DVec3::new(above.x, above.y, bottom));
        }
        let center = positions.len() as u32;
        positions.push(DVec3::new(middle.x, middle.y, bottom));
        let count = rim.len();
        for k in 0..count {
            let next = (k + 1) % count;
            let ([a, b], [c, d]) = ([rim[k], rim[next]], [first + k as u32, first + next as u32]);
            triangles.extend([[a, c, d], [a, d, b], [c, center, d]]);
        }
    }
}
