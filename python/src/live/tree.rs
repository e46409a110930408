//! The tree of a live model: what names its operations, and the tree as Python's data.

use planecut::csg::{BrushId, EditError, LiveModel, NodeId, Operation, Role, TreeOperand};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyInt, PyList};

use super::Live;
use crate::errors::refuse;

/// An operation in the tree of a live model, by its number: brushes are named by numbers alone, operations by nodes.
///
/// It is a name and nothing more; `Live.tree` says which operations there are. No number is given twice.
///
/// Args:
///     number: The number of the operation.
///
/// >>> import planecut as pc
/// >>> live = pc.Live(pc.box([0, 0, 0], [3, 3, 3]) | (pc.box([2, 0, 0], [5, 3, 3]) ^ pc.box([4, 0, 0], [6, 3, 3])))
/// >>> with live.edit() as e:
/// ...     e.set_operation(pc.Node(0), "union")
/// >>> live.volume
/// 54.0
#[pyclass(frozen, eq, hash, module = "planecut")]
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Node {
    number: u64,
}

impl Node {
    pub(super) fn of(id: NodeId) -> Self {
        Self { number: id.0 }
    }

    pub(super) fn id(self) -> NodeId {
        NodeId(self.number)
    }
}

#[pymethods]
impl Node {
    #[new]
    fn new(number: u64) -> Self {
        Self { number }
    }

    /// The number of the operation.
    #[getter]
    fn number(&self) -> u64 {
        self.number
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> (Bound<'py, PyAny>, (u64,)) {
        (slf.get_type().into_any(), (slf.get().number,))
    }

    fn __repr__(&self) -> String {
        format!("planecut.Node({})", self.number)
    }
}

/// A brush by its number, or an operation by its node.
pub(super) fn operand_of(value: &Bound<'_, PyAny>, name: &str) -> PyResult<TreeOperand> {
    if let Ok(node) = value.cast::<Node>() {
        return Ok(TreeOperand::Node(node.get().id()));
    }
    let Ok(number) = value.extract::<u64>() else {
        let found = match value.cast::<PyInt>() {
            Ok(number) => number.str()?.to_string(),
            Err(_) => format!("an object of type {}", value.get_type().name()?),
        };
        return Err(refuse(format!("{name}: found {found}, expected the number of a brush or a Node")));
    };
    Ok(TreeOperand::Brush(BrushId(number)))
}

const OPERATIONS: [Operation; 5] =
    [Operation::Union, Operation::Intersection, Operation::Difference, Operation::Xor, Operation::Complement];

/// An operation by its name.
pub(super) fn operation_of(name: &str) -> PyResult<Operation> {
    OPERATIONS.into_iter().find(|operation| operation.name() == name).ok_or_else(|| {
        let names = OPERATIONS.map(|operation| format!("{:?}", operation.name()));
        refuse(format!("operation: found {name:?}, expected {} or {}", names[..4].join(", "), names[4]))
    })
}

/// A brush or an operation of a tree.
struct Entry {
    operand: TreeOperand,
    /// The operation, where it is one.
    operation: Option<Operation>,
    /// What it does, where it is a part of the model itself.
    role: Option<Role>,
    /// The place of the entry that it is an operand of.
    parent: Option<usize>,
}

/// All of a tree: operands in their order, and after what they are operands of.
fn entries(model: &LiveModel) -> Result<Vec<Entry>, EditError> {
    let entry = |operand, parent: Option<usize>| {
        let (operation, role) = match operand {
            TreeOperand::Brush(id) => (None, model.brush(id)?.1),
            TreeOperand::Node(id) => model.node(id).map(|node| (Some(node.operation), node.role))?,
        };
        Ok::<_, EditError>(Entry { operand, operation, role: parent.is_none().then_some(role), parent })
    };
    let mut all = model.operands(None)?.map(|part| entry(part, None)).collect::<Result<Vec<_>, _>>()?;
    let mut at = 0;
    while at < all.len() {
        if let TreeOperand::Node(id) = all[at].operand {
            for operand in model.operands(Some(id))? {
                all.push(entry(operand, Some(at))?);
            }
        }
        at += 1;
    }
    Ok(all)
}

#[pymethods]
impl Live {
    /// The tree of the model as it is now: a new list of its parts, which are combined one after another by their roles.
    ///
    /// A part is a dict. A brush is `{"brush": number, "role": role}`; an operation is `{"node": Node, "operation": name, "operands": list, "role": role}` with the name "union", "intersection",
    /// "difference" (the others from the first), "xor" or "complement" (of the union). Its operands are such dicts again, in their order, without roles: only parts of the model have one.
    ///
    /// >>> import planecut as pc
    /// >>> a, b, c = (pc.box([k, 0, 0], [k + 2, 1, 1]) for k in range(3))
    /// >>> pc.Live(a - (b ^ c)).tree  # doctest: +NORMALIZE_WHITESPACE
    /// [{'brush': 0, 'role': 'add'},
    ///  {'node': planecut.Node(0), 'operation': 'xor', 'operands': [{'brush': 1}, {'brush': 2}], 'role': 'subtract'}]
    #[getter]
    fn tree<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let entries = self.with(py, |state| Ok(entries(&state.model)?))?;
        let parts = PyList::empty(py);
        let mut operands: Vec<Option<Bound<'py, PyList>>> = Vec::with_capacity(entries.len());
        for Entry { operand, operation, role, parent } in entries {
            let part = PyDict::new(py);
            match operand {
                TreeOperand::Brush(id) => part.set_item("brush", id.0)?,
                TreeOperand::Node(id) => part.set_item("node", Node::of(id))?,
            }
            let own = operation.map(|operation| (operation.name(), PyList::empty(py)));
            if let Some((name, own)) = &own {
                part.set_item("operation", name)?;
                part.set_item("operands", own)?;
            }
            if let Some(role) = role {
                part.set_item("role", role.name())?;
            }
            // what it is an operand of comes before it
            let within = parent.and_then(|parent| operands[parent].as_ref());
            within.unwrap_or(&parts).append(part)?;
            operands.push(own.map(|own| own.1));
        }
        Ok(parts)
    }
}
