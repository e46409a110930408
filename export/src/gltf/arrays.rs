//! Where the array of a mesh lies, as accessors say it.

use gltf_json::accessor::{ComponentType, GenericComponentType, IndexComponentType, Type, sparse};
use gltf_json::buffer::View;
use gltf_json::validation::{Checked, USize64};
use gltf_json::{Accessor, Index};
use serde::Serialize;
use serde_json::{Value, json};

use super::geometry::Geometry;
use super::sections::{Kind, Section, Width};

/// The arrays of a group of meshes, in views that are described.
pub(super) struct Arrays<'a> {
    pub(super) sections: &'a [Section],
    /// For each section its view.
    pub(super) views: Vec<Index<View>>,
}

impl Arrays<'_> {
    /// The array of a mesh; an empty one where it has none.
    pub(super) fn get(&self, kind: Kind, mesh: usize) -> Array {
        let nothing = Array { view: Index::new(0), start: 0, count: 0, stride: 1, component: ComponentType::U16 };
        self.find(kind, mesh).unwrap_or(nothing)
    }

    /// The array of a mesh; nothing where that would be empty.
    pub(super) fn find(&self, kind: Kind, mesh: usize) -> Option<Array> {
        let place = self.sections.iter().position(|section| section.kind == kind)?;
        let section = &self.sections[place];
        let (start, end) = (section.starts[mesh], section.starts[mesh + 1]);
        let component = match kind {
            Kind::Indices(Width::U16) | Kind::MergePlaces(Width::U16) | Kind::MergeVertices(Width::U16) => {
                ComponentType::U16
            }
            _ => ComponentType::U32,
        };
        (end > start).then(|| Array {
            view: self.views[place],
            start,
            count: end - start,
            stride: section.stride,
            component,
        })
    }
}

/// An array within a view.
pub(super) struct Array {
    view: Index<View>,
    /// Its first element.
    start: usize,
    count: usize,
    /// Bytes of an element.
    stride: usize,
    component: ComponentType,
}

impl Array {
    /// All of it, as scalars.
    pub(super) fn whole(&self) -> Accessor {
        self.part(0, self.count)
    }

    /// Some of its elements, as scalars.
    pub(super) fn part(&self, start: usize, count: usize) -> Accessor {
        Accessor {
            buffer_view: Some(self.view),
            byte_offset: Some(self.offset(start)),
            count: USize64::from(count),
            component_type: Checked::Valid(GenericComponentType(self.component)),
            extensions: None,
            extras: Default::default(),
            type_: Checked::Valid(Type::Scalar),
            min: None,
            max: None,
            name: None,
            normalized: false,
            sparse: None,
        }
    }

    /// Where an element lies in the view.
    fn offset(&self, element: usize) -> USize64 {
        USize64::from((self.start + element) * self.stride)
    }
}

/// What replaces the indices at some places by others.
pub(super) fn sparse_merges(places: &Array, vertices: &Array) -> sparse::Sparse {
    sparse::Sparse {
        count: USize64::from(places.count),
        indices: sparse::Indices {
            buffer_view: places.view,
            byte_offset: places.offset(0),
            component_type: Checked::Valid(IndexComponentType(places.component)),
            extensions: None,
            extras: Default::default(),
        },
        values: sparse::Values {
            buffer_view: vertices.view,
            byte_offset: vertices.offset(0),
            extensions: None,
            extras: Default::default(),
        },
        extensions: None,
        extras: Default::default(),
    }
}

/// The least and greatest coordinates as they are stored.
pub(super) fn bounds(mesh: &Geometry) -> (Value, Value) {
    fn of<T: Copy + PartialOrd + Serialize>(positions: impl Iterator<Item = [T; 3]>) -> (Value, Value) {
        let wider = |(min, max): ([T; 3], [T; 3]), position: [T; 3]| {
            let pick = |other: [T; 3], is_better: fn(&T, &T) -> bool| {
                std::array::from_fn(|k| if is_better(&position[k], &other[k]) { position[k] } else { other[k] })
            };
            (pick(min, T::lt), pick(max, T::gt))
        };
        let bounds =
            positions.fold(None, |bounds, position| Some(wider(bounds.unwrap_or((position, position)), position)));
        bounds.map_or((Value::Null, Value::Null), |(min, max)| (json!(min), json!(max)))
    }
    let vertices = 0..mesh.vertices.origins.len();
    match mesh.rounding.step {
        Some(step) => of(vertices.map(|vertex| mesh.grid_position(vertex, step))),
        None => {
            let (min, max) = of(vertices.map(|vertex| mesh.position(vertex)));
            (as_parsed(min), as_parsed(max))
        }
    }
}

/// Single-precision numbers, which JSON values hold in double precision, as the JSON library parses their decimals: up to one unit in the last
/// place off, and so still the same in single precision. Files have had these digits from the beginning; they stay comparable byte by byte.
fn as_parsed(bounds: Value) -> Value {
    let parsed = |value: &Value| serde_json::from_str(&value.to_string()).unwrap_or_else(|_| value.clone());
    match bounds {
        Value::Array(numbers) => numbers.iter().map(parsed).collect(),
        other => other,
    }
}
