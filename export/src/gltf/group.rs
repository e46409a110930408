//! Meshes whose arrays lie together in the buffer.

use std::io::{self, Write};

use planecut_parallel::prelude::*;

use super::geometry::Geometry;
use super::packed::Packed;
use super::sections::Section;
use crate::{ExportError, ExportOptions};

/// Alignment of arrays in bytes: no component is larger.
pub(super) const ALIGNED: usize = 4;

/// Meshes, and their arrays by kind.
pub(super) struct Group<'a> {
    pub(super) meshes: Vec<Geometry<'a>>,
    pub(super) sections: Vec<Section>,
    /// For each section its packed form, where packing is asked for.
    pub(super) packed: Vec<Packed>,
}

impl<'a> Group<'a> {
    /// Lays out the arrays of some meshes.
    pub(super) fn new(mut meshes: Vec<Geometry<'a>>, options: &ExportOptions) -> Result<Self, ExportError> {
        if options.meshopt {
            Packed::turn_triangles(&mut meshes)?;
        }
        meshes.par_iter_mut().for_each(Geometry::find_merges);
        let sections = Section::of(&meshes, options.quantize);
        let packed = if options.meshopt {
            sections.par_iter().map(|section| Packed::of(section, &meshes)).collect::<Result<_, _>>()?
        } else {
            Vec::new()
        };
        Ok(Self { meshes, sections, packed })
    }

    /// How long their part of the buffer is.
    pub(super) fn bytes(&self) -> usize {
        let long = |(number, section): (usize, &Section)| match self.packed.get(number) {
            Some(packed) => packed.bytes.len(),
            None => section.bytes(),
        };
        self.sections.iter().enumerate().map(|section| long(section).next_multiple_of(ALIGNED)).sum()
    }

    /// Writes their part of the buffer.
    pub(super) fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        for (number, section) in self.sections.iter().enumerate() {
            let long = match self.packed.get(number) {
                Some(packed) => {
                    out.write_all(&packed.bytes)?;
                    packed.bytes.len()
                }
                None => {
                    section.write(&self.meshes, out)?;
                    section.bytes()
                }
            };
            out.write_all(&[0; ALIGNED][..long.next_multiple_of(ALIGNED) - long])?;
        }
        Ok(())
    }
}
