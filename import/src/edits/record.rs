//! Edits as they are written: JSON objects.

use planecut_csg::{BrushId, NodeId, Operation, Role, TreeOperand};
use serde::{Deserialize, Serialize};

/// An edit as it is written.
#[derive(Debug, Deserialize, Serialize)]
#[serde(tag = "op", rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum Record {
    AddPlane {
        brush: u64,
        plane: [f64; 4],
        #[serde(default, skip_serializing_if = "Option::is_none")]
        material: Option<String>,
    },
    RemovePlane {
        brush: u64,
        plane: u32,
    },
    MovePlane {
        brush: u64,
        plane: u32,
        /// Along the normal, or else `to`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        offset: Option<f64>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        to: Option<[f64; 4]>,
    },
    SetMaterial {
        brush: u64,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        plane: Option<u32>,
        material: String,
    },
    RenameBrush {
        brush: u64,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        name: Option<String>,
    },
    AddBrush {
        planes: Vec<[f64; 4]>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        material: Option<MaterialNames>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        name: Option<String>,
        #[serde(default)]
        role: RoleName,
    },
    RemoveBrush {
        brush: u64,
    },
    ReplaceBrush {
        brush: u64,
        planes: Vec<[f64; 4]>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        material: Option<MaterialNames>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        name: Option<String>,
    },
    TransformBrush {
        brush: u64,
        matrix: Vec<[f64; 4]>,
    },
    SetRole {
        /// Or else `node`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        brush: Option<u64>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        node: Option<u64>,
        role: RoleName,
    },
    CopyBrushes {
        brushes: Vec<u64>,
        matrix: Vec<[f64; 4]>,
    },
    MirrorBrushes {
        brushes: Vec<u64>,
        plane: [f64; 4],
    },
    ArrayBrushes {
        brushes: Vec<u64>,
        matrix: Vec<[f64; 4]>,
        count: u32,
    },
    MoveBrushBefore {
        brush: u64,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        before: Option<u64>,
    },
    MoveOperand {
        operand: Operand,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        to: Option<u64>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        before: Option<Operand>,
    },
    SetOperation {
        node: u64,
        operation: OperationName,
    },
    Wrap {
        operands: Vec<Operand>,
        operation: OperationName,
    },
    Dissolve {
        node: u64,
    },
    RemoveNode {
        node: u64,
    },
    Begin {},
    Commit {},
    Cancel {},
    Undo {},
    Redo {},
}

/// One name for all faces, or one for each.
#[derive(Debug, Deserialize, Serialize)]
#[serde(untagged)]
pub(super) enum MaterialNames {
    One(String),
    Each(Vec<String>),
}

#[derive(Debug, Clone, Copy, Default, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum RoleName {
    #[default]
    Add,
    Subtract,
    Intersect,
}

#[derive(Debug, Clone, Copy, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum OperationName {
    Union,
    Intersection,
    Difference,
    Xor,
    Complement,
}

/// A brush or an operation.
#[derive(Debug, Clone, Copy, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Operand {
    Brush(u64),
    Node(u64),
}

impl From<RoleName> for Role {
    fn from(name: RoleName) -> Self {
        match name {
            RoleName::Add => Self::Add,
            RoleName::Subtract => Self::Subtract,
            RoleName::Intersect => Self::Intersect,
        }
    }
}

impl From<Role> for RoleName {
    fn from(role: Role) -> Self {
        match role {
            Role::Add => Self::Add,
            Role::Subtract => Self::Subtract,
            Role::Intersect => Self::Intersect,
        }
    }
}

impl From<OperationName> for Operation {
    fn from(name: OperationName) -> Self {
        match name {
            OperationName::Union => Self::Union,
            OperationName::Intersection => Self::Intersection,
            OperationName::Difference => Self::Difference,
            OperationName::Xor => Self::Xor,
            OperationName::Complement => Self::Complement,
        }
    }
}

impl From<Operation> for OperationName {
    fn from(operation: Operation) -> Self {
        match operation {
            Operation::Union => Self::Union,
            Operation::Intersection => Self::Intersection,
            Operation::Difference => Self::Difference,
            Operation::Xor => Self::Xor,
            Operation::Complement => Self::Complement,
        }
    }
}

impl From<Operand> for TreeOperand {
    fn from(operand: Operand) -> Self {
        match operand {
            Operand::Brush(id) => Self::Brush(BrushId(id)),
            Operand::Node(id) => Self::Node(NodeId(id)),
        }
    }
}

impl From<TreeOperand> for Operand {
    fn from(operand: TreeOperand) -> Self {
        match operand {
            TreeOperand::Brush(id) => Self::Brush(id.0),
            TreeOperand::Node(id) => Self::Node(id.0),
        }
    }
}
