//! All pieces of a plan: one closed surface.

use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::PathBuf;

use planecut_csg::stages::CompensatedSum;
use planecut_csg::{
    BlockPlace, Material, Mesh, Noise, SeamEdge, SeamEdges, SolidMeasures, uncancelled_edges, unmatched_edges,
};
use planecut_export::MeshPieces;
use planecut_kernel::DVec3;
use planecut_kernel::sign::Counts;
use rustc_hash::FxHashMap;

use super::error::BlocksError;
use super::piece::{self, PieceHeader, SeamDigest};
use super::plan::BlockPlan;
use crate::tiles::{TileLeaf, TileSource};

/// The pieces of a mesh that are one closed surface together: that neighbours end in the same edges was proven when they were opened. The meshes
/// stay in their files until they are read, one at a time.
#[derive(Debug)]
pub struct Pieces {
    folder: PathBuf,
    pieces: Vec<(PathBuf, PieceHeader)>,
    materials: Vec<Material>,
    leaves: Vec<TileLeaf>,
}

impl Pieces {
    /// Those of a plan whose blocks are all evaluated. On each wall the edges of both sides are compared by their SHA-256.
    ///
    /// # Errors
    /// [`BlocksError::Io`] where one is not there, [`BlocksError::Damaged`] where one is something else, [`BlocksError::Seam`] where two do not
    /// fit together: that is a bug in planecut.
    pub fn open(plan: &BlockPlan) -> Result<Self, BlocksError> {
        let mut pieces = Vec::with_capacity(plan.blocks().len());
        for (number, block) in plan.blocks().iter().enumerate() {
            let path = plan.piece_path(number);
            let file = File::open(&path).map_err(BlocksError::io(&path))?;
            let header = piece::header(&mut BufReader::new(file)).ok().filter(|header| header.place == block.place);
            match header {
                Some(header) => pieces.push((path, header)),
                None => return Err(BlocksError::Damaged { path, expected: "the piece of a block of planecut" }),
            }
        }
        let leaf =
            |(_, header): &(PathBuf, PieceHeader)| TileLeaf { place: header.place, min: header.min, max: header.max };
        let leaves = pieces.iter().map(leaf).collect();
        let pieces = Self { folder: plan.folder().to_owned(), pieces, materials: plan.materials().to_vec(), leaves };
        pieces.prove_seams()?;
        Ok(pieces)
    }

    /// Compares the edges on both sides of each wall.
    fn prove_seams(&self) -> Result<(), BlocksError> {
        let edges = uncancelled_edges(self.pieces.iter().flat_map(|(_, header)| &header.crossings));
        if edges > 0 {
            return Err(BlocksError::Crossing { edges });
        }
        let numbers: FxHashMap<BlockPlace, usize> =
            self.pieces.iter().enumerate().map(|(number, (_, header))| (header.place, number)).collect();
        let nothing = SeamDigest::none();
        for (number, (_, header)) in self.pieces.iter().enumerate() {
            for side in 0..6 {
                let (axis, is_larger) = (side / 2, side % 2 == 1);
                let mut place = header.place;
                place[axis] = if is_larger { place[axis] + 1 } else { place[axis].wrapping_sub(1) };
                let neighbour = numbers.get(&place).copied();
                // a wall between two blocks is looked at from one of them
                if neighbour.is_some() && !is_larger {
                    continue;
                }
                let other = neighbour.map_or(&nothing, |neighbour| &self.pieces[neighbour].1.seams[side ^ 1]);
                if header.seams[side] != *other {
                    let edges = |piece: Option<usize>, side: usize| -> Result<Vec<SeamEdge>, BlocksError> {
                        let Some(piece) = piece else { return Ok(Vec::new()) };
                        self.read(piece).map(|(_, mut seams)| std::mem::take(&mut seams.sides[side]))
                    };
                    let edges = unmatched_edges(&edges(Some(number), side)?, &edges(neighbour, side ^ 1)?);
                    let (first, second) = if is_larger { (header.place, place) } else { (place, header.place) };
                    return Err(BlocksError::Seam { first, second, edges });
                }
            }
        }
        Ok(())
    }

    /// How many there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.pieces.len()
    }

    /// The place of a piece in the grid.
    #[must_use]
    pub fn place(&self, piece: usize) -> BlockPlace {
        self.pieces[piece].1.place
    }

    /// The corners of the box of a piece: of smallest and of largest coordinates.
    #[must_use]
    pub fn bounds(&self, piece: usize) -> [DVec3; 2] {
        let header = &self.pieces[piece].1;
        [header.min, header.max]
    }

    /// The materials of the model.
    #[must_use]
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// Reads the mesh of a piece and the edges in which it ends on walls; its materials are those that it needs.
    ///
    /// # Errors
    /// [`BlocksError::Io`], [`BlocksError::Damaged`].
    pub fn read(&self, piece: usize) -> Result<(Mesh, SeamEdges), BlocksError> {
        let (path, known) = &self.pieces[piece];
        let file = File::open(path).map_err(BlocksError::io(path))?;
        let mut file = BufReader::with_capacity(1 << 18, file);
        let read = piece::header(&mut file).ok().filter(|header| header == known).and_then(|header| {
            let contents = piece::contents(&header, &mut file).ok()?;
            // nothing follows
            (file.read(&mut [0]).ok()? == 0).then_some(contents)
        });
        let expected = "the piece of a block of planecut";
        read.ok_or_else(|| BlocksError::Damaged { path: path.clone(), expected })
    }

    /// Vertices, triangles and planar faces of all pieces; vertices on walls count in each of their pieces.
    #[must_use]
    pub fn mesh_counts(&self) -> [u64; 3] {
        let sum = |of: fn(&PieceHeader) -> u64| self.pieces.iter().map(|(_, header)| of(header)).sum();
        [sum(|header| header.vertices), sum(|header| header.triangles), sum(|header| header.faces)]
    }

    /// Edges on walls between blocks, each counted once: each has its like on the other side.
    #[must_use]
    pub fn seam_edges(&self) -> u64 {
        self.pieces.iter().flat_map(|(_, header)| &header.seams).map(|seam| seam.edges).sum::<u64>() / 2
    }

    /// The volume that the triangles of all pieces enclose.
    #[must_use]
    pub fn mesh_volume(&self) -> f64 {
        let mut sum = CompensatedSum::default();
        let from = self.pieces.first().map_or(DVec3::ZERO, |(_, header)| header.min);
        for (_, header) in &self.pieces {
            // cones from a point of its own, moved to one for all
            sum.add(header.mesh_volume);
            sum.add((header.min - from).dot(header.mesh_area) / 3.0);
        }
        sum.value()
    }

    /// What was removed as rounding noise.
    #[must_use]
    pub fn noise(&self) -> Noise {
        let noise = self.pieces.iter().map(|(_, header)| header.noise);
        noise.fold(Noise::default(), |sum, (collapsed, thickest)| Noise {
            collapsed: sum.collapsed + collapsed as usize,
            thickest: sum.thickest.max(thickest),
        })
    }

    /// The signs that were asked for.
    #[must_use]
    pub fn signs(&self) -> Counts {
        let signs = self.pieces.iter().map(|(_, header)| header.signs);
        signs.fold(Counts::default(), |sum, [total, small_int, big]| Counts {
            total: sum.total + total,
            small_int: sum.small_int + small_int,
            big: sum.big + big,
        })
    }

    /// Measures of the whole solid.
    #[must_use]
    pub fn solid(&self) -> SolidMeasures {
        let held = || {
            self.pieces
                .iter()
                .map(|(_, header)| header)
                .filter(|header| header.solid.volume != 0.0 || header.triangles > 0)
        };
        let sum = |of: &dyn Fn(&PieceHeader) -> f64| {
            let mut sum = CompensatedSum::default();
            held().for_each(|header| sum.add(of(header)));
            sum.value()
        };
        let Some(first) = held().next() else { return SolidMeasures::default() };
        let volume = sum(&|header| header.solid.volume);
        let middle = DVec3::from_array([0, 1, 2].map(|axis| {
            // relative to a corner, so that nothing is lost far from the origin
            sum(&|header| header.solid.volume * (header.solid.centroid - first.solid.min)[axis])
        }));
        let centroid = if volume > 0.0 { first.solid.min + middle / volume } else { DVec3::ZERO };
        SolidMeasures {
            volume,
            area: sum(&|header| header.solid.area),
            centroid,
            min: held().map(|header| header.solid.min).reduce(DVec3::min).unwrap_or_default(),
            max: held().map(|header| header.solid.max).reduce(DVec3::max).unwrap_or_default(),
        }
    }
}

impl TileSource for Pieces {
    fn leaves(&self) -> &[TileLeaf] {
        &self.leaves
    }

    fn mesh(&self, leaf: usize) -> io::Result<Mesh> {
        self.piece(leaf)
    }
}

impl MeshPieces for Pieces {
    fn count(&self) -> usize {
        self.pieces.len()
    }

    fn piece(&self, number: usize) -> io::Result<Mesh> {
        self.read(number).map(|(mesh, _)| mesh).map_err(|error| match error {
            BlocksError::Io { source, .. } => source,
            error => io::Error::new(io::ErrorKind::InvalidData, error.to_string()),
        })
    }

    fn name(&self, number: usize) -> String {
        let [x, y, z] = self.place(number);
        format!("block {x}-{y}-{z}")
    }

    /// In the folder of the plan, where there is room for pieces.
    fn temporary_file(&self) -> io::Result<File> {
        tempfile::tempfile_in(&self.folder)
    }
}
