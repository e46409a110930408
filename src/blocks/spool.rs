//! All pieces of a tree in a file, to be read again in their order.

use std::fs::File;
use std::io::{self, BufRead, BufReader, BufWriter, Read, Write};
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};

use planecut_csg::stages::Bounds;
use planecut_csg::{Brush, BrushFace, BrushPlace, MaterialId, Operation, Polarity};
use planecut_kernel::HalfSpace;
use planecut_parallel::job::check;

use super::bytes::{self, Bytes};
use super::error::BlocksError;

/// Bytes that are read or written at once.
const BUFFER: usize = 1 << 20;

/// A piece of a tree.
#[derive(Debug)]
pub(super) enum Piece {
    Begin(Operation),
    Leaf(Leaf),
    End,
}

/// A brush, and what is known of it.
#[derive(Debug)]
pub(super) struct Leaf {
    pub(super) brush: Brush,
    pub(super) line: Option<NonZeroU32>,
    pub(super) polarity: Polarity,
    pub(super) place: BrushPlace,
}

const OPERATIONS: [Operation; 5] =
    [Operation::Union, Operation::Intersection, Operation::Difference, Operation::Xor, Operation::Complement];
const POLARITIES: [Polarity; 3] = [Polarity::Takes, Polarity::Both, Polarity::Adds];
const LEAF: u8 = 5;
const END: u8 = 6;

/// The number of an operation in files.
pub(super) fn number_of_operation(operation: Operation) -> u8 {
    OPERATIONS.iter().position(|other| *other == operation).expect("all are listed") as u8
}

/// The operation of a number.
pub(super) fn operation_of(number: u8) -> io::Result<Operation> {
    OPERATIONS.get(usize::from(number)).copied().ok_or_else(bytes::damaged)
}

/// The number of a polarity in files.
pub(super) fn number_of_polarity(polarity: Polarity) -> u8 {
    POLARITIES.iter().position(|other| *other == polarity).expect("all are listed") as u8
}

/// The polarity of a number.
pub(super) fn polarity_of(number: u8) -> io::Result<Polarity> {
    POLARITIES.get(usize::from(number)).copied().ok_or_else(bytes::damaged)
}

/// Puts the faces of a brush.
pub(super) fn put_faces(brush: &Brush, material: impl FnMut(MaterialId) -> u32, to: &mut Bytes) {
    let mut material = material;
    to.u32(u32::try_from(brush.faces.len()).expect("fewer than 2^32 faces"));
    for face in &brush.faces {
        face.half_space.to_array().into_iter().for_each(|value| to.f64(value));
        to.u32(material(face.material));
    }
}

/// Reads the faces of a brush.
pub(super) fn faces(from: &mut impl Read) -> io::Result<Brush> {
    let count = bytes::u32(from)?;
    let face = |_| {
        let coefficients = [bytes::f64(from)?, bytes::f64(from)?, bytes::f64(from)?, bytes::f64(from)?];
        let half_space = HalfSpace::from_array(coefficients).map_err(|_| bytes::damaged())?;
        Ok(BrushFace { half_space, material: MaterialId(bytes::u32(from)?) })
    };
    let faces = (0..count).map(face).collect::<io::Result<Vec<BrushFace>>>()?;
    Ok(Brush { faces, ..Brush::default() })
}

/// The file while it is written.
pub(super) struct SpoolWriter {
    path: PathBuf,
    file: BufWriter<File>,
    bytes: Bytes,
}

impl SpoolWriter {
    pub(super) fn create(path: &Path) -> Result<Self, BlocksError> {
        let file = File::create(path).map_err(BlocksError::io(path))?;
        let file = BufWriter::with_capacity(BUFFER, file);
        Ok(Self { path: path.to_owned(), file, bytes: Bytes::default() })
    }

    pub(super) fn push(&mut self, piece: &Piece) -> Result<(), BlocksError> {
        let to = &mut self.bytes;
        to.0.clear();
        match piece {
            Piece::Begin(operation) => to.u8(number_of_operation(*operation)),
            Piece::End => to.u8(END),
            Piece::Leaf(leaf) => {
                to.u8(LEAF);
                to.u32(leaf.line.map_or(0, NonZeroU32::get));
                to.u8(number_of_polarity(leaf.polarity));
                to.point(leaf.place.bounds.min);
                to.point(leaf.place.bounds.max);
                to.u32(u32::try_from(leaf.place.redundant.len()).expect("fewer than 2^32 planes"));
                leaf.place.redundant.iter().for_each(|plane| to.u32(*plane));
                put_faces(&leaf.brush, |material| material.0, to);
            }
        }
        self.file.write_all(&self.bytes.0).map_err(BlocksError::io(&self.path))
    }

    pub(super) fn finish(mut self) -> Result<Spool, BlocksError> {
        self.file.flush().map_err(BlocksError::io(&self.path))?;
        Ok(Spool { path: self.path })
    }
}

/// The file once it is complete.
pub(super) struct Spool {
    pub(super) path: PathBuf,
}

impl Spool {
    /// Reads all pieces; they go to `take`.
    pub(super) fn read(&self, mut take: impl FnMut(Piece) -> Result<(), BlocksError>) -> Result<(), BlocksError> {
        let file = File::open(&self.path).map_err(BlocksError::io(&self.path))?;
        let mut file = BufReader::with_capacity(BUFFER, file);
        while !file.fill_buf().map_err(BlocksError::io(&self.path))?.is_empty() {
            // the work may be ended from outside
            check();
            take(piece(&mut file).map_err(BlocksError::io(&self.path))?)?;
        }
        Ok(())
    }

    /// Reads the brushes alone.
    pub(super) fn read_leaves(&self, mut take: impl FnMut(Leaf) -> Result<(), BlocksError>) -> Result<(), BlocksError> {
        self.read(|piece| match piece {
            Piece::Leaf(leaf) => take(leaf),
            Piece::Begin(_) | Piece::End => Ok(()),
        })
    }
}

fn piece(from: &mut impl Read) -> io::Result<Piece> {
    match bytes::u8(from)? {
        END => Ok(Piece::End),
        LEAF => {
            let line = NonZeroU32::new(bytes::u32(from)?);
            let polarity = polarity_of(bytes::u8(from)?)?;
            let bounds = Bounds { min: bytes::point(from)?, max: bytes::point(from)? };
            let redundant = (0..bytes::u32(from)?).map(|_| bytes::u32(from)).collect::<io::Result<Vec<u32>>>()?;
            let place = BrushPlace { bounds, redundant, is_unbounded: false };
            Ok(Piece::Leaf(Leaf { brush: faces(from)?, line, polarity, place }))
        }
        number => operation_of(number).map(Piece::Begin),
    }
}
