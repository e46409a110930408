//! What faces are made of.

/// Index into [`Model::materials`](crate::Model::materials).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MaterialId(pub u32);

/// A named material; faces refer to it by [`MaterialId`].
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Material {
    /// The name, in a Quake map that of the texture.
    pub name: String,
    /// Linear RGB base colour where the input states one; otherwise the exporter derives a colour from the name.
    pub color: Option<[f32; 3]>,
    /// How metallic it is, from 0 to 1, where the input states it.
    pub metallic: Option<f32>,
    /// How rough it is, from 0 to 1, where the input states it.
    pub roughness: Option<f32>,
}

impl Material {
    /// A material of which nothing is known but its name.
    #[must_use]
    pub fn named(name: impl Into<String>) -> Self {
        Self { name: name.into(), ..Self::default() }
    }
}
