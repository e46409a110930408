//! The format as tables: which keys an object has, and what they hold. `docs/model.schema.json` says the same.

/// What a value must be.
#[derive(Debug, Clone, Copy)]
pub(super) enum Want {
    Number,
    Text,
    Flag,
    /// One of these texts.
    Choice(&'static [&'static str]),
    /// A list of this length.
    Vector(usize),
    /// One number, or a list of this length.
    Scale(usize),
    /// One or more lists of this length.
    Rows(usize),
    /// A matrix whose rows have this length; the last row may be left out.
    Matrix(usize),
    /// One or more loops of points in the plane, or one alone.
    Loops,
    /// A vector of angles, or an axis and an angle.
    Turn,
    /// The name of a mesh file, or an object with it, or with triangles.
    Mesh,
    /// Transform steps.
    Steps,
    /// One or more places of instances.
    Places,
    Object(&'static [Field]),
    Node,
    /// One or more nodes.
    Nodes,
    NodePair,
    Outline,
    /// One or more outlines.
    Outlines,
    PartName,
    OutlineName,
    MaterialName,
    /// A list of names of materials, or null in their place.
    MaterialNames,
    /// Numbers by the names of parameters.
    With,
}

/// A key of an object.
#[derive(Debug, Clone, Copy)]
pub(super) struct Field {
    pub(super) key: &'static str,
    pub(super) want: Want,
    pub(super) required: bool,
}

const fn required(key: &'static str, want: Want) -> Field {
    Field { key, want, required: true }
}

const fn optional(key: &'static str, want: Want) -> Field {
    Field { key, want, required: false }
}

const HEIGHT: Field = required("height", Want::Number);
const RADIUS: Field = required("radius", Want::Number);
const SIDES: Field = required("sides", Want::Number);
const SEGMENTS: Field = optional("segments", Want::Number);
const OF: Field = required("of", Want::Node);
const OUTLINE: Field = required("outline", Want::Outline);
const BOX: &[Field] = &[required("min", Want::Vector(3)), required("max", Want::Vector(3))];
const TORUS: &[Field] = &[RADIUS, required("tube", Want::Number), SEGMENTS, optional("tube_segments", Want::Number)];
const EXTRUDE: &[Field] = &[
    OUTLINE,
    HEIGHT,
    optional("twist", Want::Number),
    optional("scale", Want::Scale(2)),
    optional("slices", Want::Number),
    optional("center", Want::Flag),
];
const REVOLVE: &[Field] = &[OUTLINE, optional("angle", Want::Number), SEGMENTS];
const OFFSET: &[Field] = &[
    required("of", Want::Outline),
    required("by", Want::Number),
    optional("join", Want::Choice(&["round", "miter", "bevel"])),
    SEGMENTS,
];

/// Which winding numbers of a mesh are inside.
const RULE: Field = optional("rule", Want::Choice(&["positive", "nonzero", "odd"]));

/// A mesh file, and how it is taken.
pub(super) const MESH: &[Field] =
    &[required("file", Want::Text), optional("scale", Want::Number), RULE, optional("close", Want::Number)];

/// A mesh whose triangles the model lists itself.
pub(super) const INLINE_MESH: &[Field] = &[
    required("vertices", Want::Rows(3)),
    required("triangles", Want::Rows(3)),
    optional("materials", Want::MaterialNames),
    RULE,
];

/// The regular solids.
pub(super) const REGULAR: &[&str] = &["tetrahedron", "cube", "octahedron", "dodecahedron", "icosahedron"];

/// What a NODE can be: exactly one of these keys.
pub(super) const NODE_KINDS: &[Field] = &[
    optional("halfspaces", Want::Rows(4)),
    optional("points", Want::Rows(3)),
    optional("box", Want::Object(BOX)),
    optional("sphere", Want::Object(&[RADIUS, SEGMENTS])),
    optional("cylinder", Want::Object(&[HEIGHT, RADIUS, optional("top_radius", Want::Number), SEGMENTS])),
    optional("cone", Want::Object(&[HEIGHT, RADIUS, SEGMENTS])),
    optional("prism", Want::Object(&[HEIGHT, RADIUS, SIDES])),
    optional("pyramid", Want::Object(&[HEIGHT, RADIUS, SIDES])),
    optional("wedge", Want::Object(&[required("size", Want::Vector(3))])),
    optional("capsule", Want::Object(&[HEIGHT, RADIUS, SEGMENTS])),
    optional("regular", Want::Object(&[required("solid", Want::Choice(REGULAR)), RADIUS])),
    optional("torus", Want::Object(TORUS)),
    optional("extrude", Want::Object(EXTRUDE)),
    optional("revolve", Want::Object(REVOLVE)),
    optional("mesh", Want::Mesh),
    optional("union", Want::Nodes),
    optional("intersection", Want::Nodes),
    optional("difference", Want::Nodes),
    optional("xor", Want::Nodes),
    optional("complement", Want::Node),
    optional("hull", Want::Nodes),
    optional("minkowski", Want::NodePair),
    optional("use", Want::PartName),
    optional("instances", Want::Object(&[OF, required("at", Want::Places)])),
    optional("array", Want::Object(&[OF, required("count", Want::Vector(3)), required("step", Want::Vector(3))])),
    optional("ring", Want::Object(&[OF, required("count", Want::Number), optional("angle", Want::Number)])),
];

/// What any NODE may have besides.
pub(super) const NODE_EXTRAS: &[Field] = &[
    optional("material", Want::MaterialName),
    optional("name", Want::Text),
    optional("transform", Want::Steps),
    optional("matrix", Want::Matrix(4)),
];

/// What a NODE may have beside the one key that says what it is, and beside that key alone.
pub(super) const COMPANIONS: &[(&str, Field)] =
    &[("use", optional("with", Want::With)), ("halfspaces", optional("materials", Want::MaterialNames))];

/// What an OUTLINE can be: exactly one of these keys.
pub(super) const OUTLINE_KINDS: &[Field] = &[
    optional("polygon", Want::Loops),
    optional("rectangle", Want::Object(&[required("min", Want::Vector(2)), required("max", Want::Vector(2))])),
    optional("circle", Want::Object(&[RADIUS, SEGMENTS])),
    optional("union", Want::Outlines),
    optional("intersection", Want::Outlines),
    optional("difference", Want::Outlines),
    optional("xor", Want::Outlines),
    optional("offset", Want::Object(OFFSET)),
    optional("slice", Want::Object(&[OF, required("z", Want::Number)])),
    optional("project", Want::Node),
    optional("use", Want::OutlineName),
];

/// What any OUTLINE may have besides.
pub(super) const OUTLINE_EXTRAS: &[Field] = &[optional("matrix", Want::Matrix(3))];

/// A step of a transform: exactly one of these keys.
pub(super) const STEP_KINDS: &[Field] = &[
    optional("translate", Want::Vector(3)),
    optional("rotate", Want::Turn),
    optional("scale", Want::Scale(3)),
    optional("mirror", Want::Vector(3)),
    optional("matrix", Want::Matrix(4)),
];

/// A turn about an axis.
pub(super) const TURN: &[Field] = &[required("axis", Want::Vector(3)), required("angle", Want::Number)];

/// A place of an instance that is an object.
pub(super) const PLACE: &[Field] = &[required("matrix", Want::Matrix(4))];

/// A material.
pub(super) const MATERIAL: &[Field] =
    &[optional("color", Want::Vector(3)), optional("metallic", Want::Number), optional("roughness", Want::Number)];
