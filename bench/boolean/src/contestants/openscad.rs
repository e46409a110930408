//! OpenSCAD, where it is installed: a file of polyhedra, and the time of the whole process from reading it to the
//! written mesh, because it tells no other.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use super::{Contestant, Outcome, outcome};
use crate::entrant::OPENSCAD;
use crate::scene::{Body, Entry, Plan, Scene};

/// It is a process of this process, which cannot end it any more once it has been ended itself.
const LIMIT: Duration = Duration::from_secs(35);

pub(super) struct OpenScad {
    input: PathBuf,
    output: PathBuf,
    has_backends: bool,
}

impl OpenScad {
    pub(super) fn new(scene: &Scene, file: &Path) -> Result<Self, String> {
        let Plan::Tree(entries) = &scene.plan else { return Err("it knows no steps".to_owned()) };
        let [input, output] = ["scad", "off"].map(|extension| file.with_extension(extension));
        std::fs::write(&input, text(entries, &scene.bodies)).map_err(|error| error.to_string())?;
        let help = Command::new(OPENSCAD).arg("--help").output().map_err(|error| error.to_string())?;
        let has_backends = [help.stdout, help.stderr].iter().any(|text| text.windows(7).any(|part| part == b"backend"));
        Ok(Self { input, output, has_backends })
    }
}

impl Contestant for OpenScad {
    fn run(&mut self) -> Result<Outcome, String> {
        let _ = std::fs::remove_file(&self.output);
        let mut command = Command::new(OPENSCAD);
        command.args(self.has_backends.then_some("--backend=manifold")).arg("-o").args([&self.output, &self.input]);
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        let begin = Instant::now();
        wait(command.spawn().map_err(|error| error.to_string())?, begin)?;
        let time = begin.elapsed();
        // it writes nothing where nothing is left, and its exit status is that of an error
        let mesh = std::fs::read_to_string(&self.output).unwrap_or_default();
        Ok(outcome(time, &triangles(&mesh).ok_or("found a mesh that cannot be read")?))
    }
}

fn wait(mut child: Child, begin: Instant) -> Result<(), String> {
    loop {
        if child.try_wait().map_err(|error| error.to_string())?.is_some() {
            return Ok(());
        }
        if begin.elapsed() > LIMIT {
            let _ = child.kill();
            let _ = child.wait();
            return Err(format!("no end within {} s", LIMIT.as_secs()));
        }
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// The tree in its language.
fn text(entries: &[Entry], bodies: &[Body]) -> String {
    let mut stack: Vec<String> = Vec::new();
    let mut leaves = bodies.iter();
    for entry in entries {
        let (name, count) = match entry {
            Entry::Leaf => {
                stack.extend(leaves.next().map(polyhedron));
                continue;
            }
            Entry::Union(count) => ("union", count),
            Entry::Difference(count) => ("difference", count),
            Entry::Intersection(count) => ("intersection", count),
        };
        let operands = stack.split_off(stack.len() - *count as usize);
        stack.push(format!("{name}() {{\n{}}}\n", operands.concat()));
    }
    stack.pop().unwrap_or_default()
}

/// Its faces turn clockwise, seen from outside.
fn polyhedron(body: &Body) -> String {
    let mut text = String::from("polyhedron(points=[");
    for [x, y, z] in &body.positions {
        let _ = write!(text, "[{x},{y},{z}],");
    }
    text += "],faces=[";
    for [a, b, c] in &body.triangles {
        let _ = write!(text, "[{a},{c},{b}],");
    }
    text + "]);\n"
}

/// The triangles of a mesh in OFF; none of an empty file.
fn triangles(text: &str) -> Option<Vec<[[f64; 3]; 3]>> {
    let mut lines = text.trim_start().strip_prefix("OFF").unwrap_or_default().lines();
    let mut rows =
        lines.by_ref().map(|line| line.split('#').next().unwrap_or_default()).filter(|l| !l.trim().is_empty());
    let Some(sizes) = rows.next() else { return Some(Vec::new()) };
    let mut sizes = sizes.split_whitespace().map_while(|word| word.parse::<usize>().ok());
    let (corners, faces) = (sizes.next()?, sizes.next()?);
    let mut positions: Vec<[f64; 3]> = Vec::new();
    for row in rows.by_ref().take(corners) {
        let mut numbers = row.split_whitespace().map_while(|word| word.parse().ok());
        positions.push([numbers.next()?, numbers.next()?, numbers.next()?]);
    }
    let mut triangles = Vec::new();
    for row in rows.take(faces) {
        let mut numbers = row.split_whitespace().map_while(|word| word.parse::<usize>().ok());
        let count = numbers.next()?;
        let polygon = numbers.take(count).map(|corner| positions.get(corner).copied()).collect::<Option<Vec<_>>>()?;
        triangles.extend((2..polygon.len()).map(|k| [polygon[0], polygon[k - 1], polygon[k]]));
    }
    Some(triangles)
}

#[cfg(test)]
mod tests {
    use super::{text, triangles};
    use crate::contestants::measures;
    use crate::scene::{Body, Entry};

    #[test]
    fn a_tree_is_written() {
        let corner = Body {
            planes: Vec::new(),
            positions: vec![[0.0; 3], [1.5, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            triangles: vec![[0, 2, 1]],
            matrix: None,
        };
        let leaf = "polyhedron(points=[[0,0,0],[1.5,0,0],[0,1,0],[0,0,1],],faces=[[0,1,2],]);\n";
        let entries = [Entry::Leaf, Entry::Leaf, Entry::Leaf, Entry::Union(2), Entry::Difference(2)];
        let expected = format!("difference() {{\n{leaf}union() {{\n{leaf}{leaf}}}\n}}\n");
        assert_eq!(text(&entries, &vec![corner; 3]), expected);
    }

    #[test]
    fn a_mesh_is_read() {
        let cube = "OFF 8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 2\n1 0 2\n1 1 2\n0 1 2\n4 3 2 1 0 200 9 9\n4 4 5 6 7\n\
                    4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";
        let found = triangles(cube).unwrap();
        assert_eq!((found.len(), measures(found.into_iter())), (12, (2.0, 10.0)));
        assert_eq!(triangles(""), Some(Vec::new()));
        assert_eq!(triangles("OFF\n1 1 0\n0 0 0\n3 0 1 2\n"), None);
    }
}
