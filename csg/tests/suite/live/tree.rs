//! Edits of the tree, against trees that are put together from scratch.

use std::collections::BTreeMap;

use planecut_csg::{
    Brush, BrushId, Change, EditError, EvaluateError, LiveModel, Material, MaterialId, Mesh, Model, NodeId, Operation,
    Role, Transform, Tree, TreeOperand, evaluate,
};
use planecut_kernel::{DVec3, HalfSpace};
use planecut_testkit::random::Rng;
use planecut_testkit::scene::scaled;

use super::edits::{Plane, Viewer, triangles_of};
use super::random::turned;

const OPERATIONS: [Operation; 5] =
    [Operation::Union, Operation::Intersection, Operation::Difference, Operation::Xor, Operation::Complement];

fn materials() -> Vec<Material> {
    ["stone", "brass"].map(Material::named).to_vec()
}

fn cuboid(min: [f64; 3], max: [f64; 3]) -> Brush {
    Brush::cuboid(DVec3::from_array(min), DVec3::from_array(max), MaterialId(0))
}

fn cube(min: f64, max: f64) -> Brush {
    cuboid([min; 3], [max; 3])
}

/// What the test knows of a model: plain lists.
#[derive(Debug, Clone, Default, PartialEq)]
struct Known {
    parts: Vec<TreeOperand>,
    nodes: BTreeMap<NodeId, (Operation, Vec<TreeOperand>)>,
    roles: BTreeMap<TreeOperand, Role>,
    brushes: BTreeMap<BrushId, Brush>,
}

impl Known {
    fn list(&mut self, parent: Option<NodeId>) -> &mut Vec<TreeOperand> {
        match parent {
            None => &mut self.parts,
            Some(node) => &mut self.nodes.get_mut(&node).expect("it is there").1,
        }
    }

    fn parent(&self, operand: TreeOperand) -> Option<NodeId> {
        self.nodes.iter().find(|(_, (_, operands))| operands.contains(&operand)).map(|(node, _)| *node)
    }

    fn place(&self, operand: TreeOperand) -> usize {
        let parent = self.parent(operand);
        let list = parent.map_or(&self.parts, |node| &self.nodes[&node].1);
        list.iter().position(|other| *other == operand).expect("it is there")
    }

    fn tree_of(&self, operand: TreeOperand) -> Tree {
        match operand {
            TreeOperand::Brush(id) => self.brushes[&id].clone().into(),
            TreeOperand::Node(id) => {
                let (operation, operands) = &self.nodes[&id];
                Tree::combine(*operation, operands.iter().map(|operand| self.tree_of(*operand)))
            }
        }
    }

    fn fresh(&self) -> Result<Mesh, EvaluateError> {
        let tree = self.parts.iter().fold(Tree::empty(), |tree, part| {
            let operation = match self.roles[part] {
                Role::Add => Operation::Union,
                Role::Subtract => Operation::Difference,
                Role::Intersect => Operation::Intersection,
            };
            Tree::combine(operation, [tree, self.tree_of(*part)])
        });
        Ok(evaluate(&Model { materials: materials(), tree })?.mesh)
    }

    fn below(&self, operand: TreeOperand) -> Vec<TreeOperand> {
        let mut all = vec![operand];
        if let TreeOperand::Node(id) = operand {
            all.extend(self.nodes[&id].1.iter().flat_map(|operand| self.below(*operand)));
        }
        all
    }

    fn forget(&mut self, operand: TreeOperand) {
        self.roles.remove(&operand);
        match operand {
            TreeOperand::Brush(id) => drop(self.brushes.remove(&id)),
            TreeOperand::Node(id) => drop(self.nodes.remove(&id)),
        }
    }

    /// Takes an operand and all below it out; what is needed is replaced by nothing.
    fn remove(&mut self, operand: TreeOperand, next_node: NodeId) {
        let (parent, place) = (self.parent(operand), self.place(operand));
        let is_needed = match parent.map(|node| self.nodes[&node].0) {
            Some(Operation::Intersection) => true,
            Some(Operation::Difference) => place == 0,
            _ => false,
        };
        self.list(parent).remove(place);
        if is_needed {
            self.list(parent).insert(place, TreeOperand::Node(next_node));
            self.nodes.insert(next_node, (Operation::Union, Vec::new()));
            self.roles.insert(TreeOperand::Node(next_node), Role::Add);
        }
        self.below(operand).into_iter().for_each(|gone| self.forget(gone));
    }
}

fn random_cuboid(rng: &mut Rng) -> Brush {
    let low = [0; 3].map(|_| rng.whole(0, 4));
    let material = MaterialId(rng.below(2) as u32);
    Brush::cuboid(DVec3::from_array(low), DVec3::from_array(low.map(|v| v + rng.whole(1, 3))), material)
}

/// A body of up to 26 planes in general position.
/// A box out of a few, so that many are equal.
fn cuboid_of_few(rng: &mut Rng) -> Brush {
    let lengths = [0; 3].map(|_| rng.pick(&[[0.0, 1.0], [0.0, 2.0], [1.0, 2.0]]));
    let material = MaterialId(rng.below(2) as u32);
    let [low, high] = [0, 1].map(|end| DVec3::from_array(lengths.map(|length| length[end])));
    Brush::cuboid(low, high, material)
}

fn turned_body(rng: &mut Rng) -> Brush {
    let plane = |(normal, offset): &Plane| HalfSpace::new(DVec3::from_array(*normal), *offset).expect("a valid plane");
    let material = MaterialId(rng.below(2) as u32);
    Brush::from_half_spaces(turned(rng).iter().map(plane), material)
}

/// How a random brush is made.
type Shape = fn(&mut Rng) -> Brush;

/// A random edit of what is known and of the model.
fn edit(known: &mut Known, live: &mut LiveModel, rng: &mut Rng, shape: Shape) -> Result<Change, EditError> {
    let next_node = NodeId(live.nodes().map(|node| node.0 + 1).max().unwrap_or(0).max(known.nodes.len() as u64));
    let all: Vec<TreeOperand> = known.roles.keys().copied().collect();
    let nodes: Vec<NodeId> = known.nodes.keys().copied().collect();
    if all.len() < 3 || known.brushes.is_empty() {
        return add(known, live, rng, shape);
    }
    let operand = rng.pick(&all);
    match rng.below(12) {
        0 => add(known, live, rng, shape),
        1 => {
            let (id, operation) = match operand {
                TreeOperand::Node(id) => (id, rng.pick(&OPERATIONS)),
                TreeOperand::Brush(_) => return wrap(known, live, rng, operand),
            };
            known.nodes.get_mut(&id).expect("it is there").0 = operation;
            live.set_operation(id, operation)
        }
        2..4 => wrap(known, live, rng, operand),
        4 => {
            let Some(node) = nodes.first() else { return wrap(known, live, rng, operand) };
            let node = if rng.chance(0.5) { *node } else { rng.pick(&nodes) };
            dissolve(known, node);
            live.dissolve(node)
        }
        5..8 => {
            let inner = known.below(operand);
            let to = nodes.iter().copied().map(Some).chain([None]).collect::<Vec<_>>();
            let to = rng.pick(&to);
            if to.is_some_and(|node| inner.contains(&TreeOperand::Node(node))) {
                let refused = live.move_operand(operand, to, None);
                assert!(matches!(refused, Err(EditError::WithinItself(_))), "{refused:?}");
                return refused;
            }
            let (parent, place) = (known.parent(operand), known.place(operand));
            known.list(parent).remove(place);
            let others = known.list(to).clone();
            let at = rng.below(others.len() + 1);
            known.list(to).insert(at, operand);
            live.move_operand(operand, to, others.get(at).copied())
        }
        8 => {
            let role = rng.pick(&[Role::Add, Role::Add, Role::Subtract, Role::Intersect]);
            if known.parent(operand).is_some() {
                assert_eq!(live.set_role(operand, role), Err(EditError::Nested(operand)));
                return Err(EditError::Nested(operand));
            }
            known.roles.insert(operand, role);
            live.set_role(operand, role)
        }
        9 => {
            // the next number of an operation is seen where one comes
            let change = match operand {
                TreeOperand::Brush(id) => live.remove_brush(id),
                TreeOperand::Node(id) => live.remove_node(id),
            };
            let new = live.nodes().find(|node| !known.nodes.contains_key(node)).unwrap_or(next_node);
            known.remove(operand, new);
            change
        }
        10 => {
            let TreeOperand::Brush(id) = operand else { return add(known, live, rng, shape) };
            let brush = shape(rng);
            known.brushes.insert(id, brush.clone());
            live.replace_brush(id, brush)
        }
        _ => copy(known, live, rng),
    }
}

fn add(known: &mut Known, live: &mut LiveModel, rng: &mut Rng, shape: Shape) -> Result<Change, EditError> {
    let (brush, role) = (shape(rng), rng.pick(&[Role::Add, Role::Add, Role::Add, Role::Subtract]));
    let (id, change) = live.add_brush(brush.clone(), role)?;
    known.brushes.insert(id, brush);
    known.roles.insert(id.into(), role);
    known.parts.push(id.into());
    Ok(change)
}

fn wrap(known: &mut Known, live: &mut LiveModel, rng: &mut Rng, first: TreeOperand) -> Result<Change, EditError> {
    let parent = known.parent(first);
    let mut chosen: Vec<TreeOperand> =
        known.list(parent).iter().copied().filter(|operand| *operand == first || rng.chance(0.4)).collect();
    let operation = rng.pick(&OPERATIONS);
    let (rest, place) = (known.list(parent).clone(), known.place(chosen[0]));
    let in_order = chosen.clone();
    chosen.reverse();
    let (node, change) = live.wrap(&chosen, operation)?;
    *known.list(parent) = rest.into_iter().filter(|operand| !in_order.contains(operand)).collect();
    known.list(parent).insert(place, node.into());
    known.roles.insert(node.into(), known.roles[&in_order[0]]);
    known.nodes.insert(node, (operation, in_order));
    Ok(change)
}

fn dissolve(known: &mut Known, node: NodeId) {
    let (parent, place, role) = (known.parent(node.into()), known.place(node.into()), known.roles[&node.into()]);
    let (operation, operands) = known.nodes[&node].clone();
    if parent.is_none() {
        for (index, operand) in operands.iter().enumerate() {
            let other = match operation {
                Operation::Difference => Role::Subtract,
                Operation::Intersection => Role::Intersect,
                _ => role,
            };
            known.roles.insert(*operand, if index == 0 { role } else { other });
        }
    }
    known.list(parent).splice(place..=place, operands);
    known.forget(node.into());
}

/// Copies two brushes, or one, and puts each copy where it belongs.
fn copy(known: &mut Known, live: &mut LiveModel, rng: &mut Rng) -> Result<Change, EditError> {
    let brushes: Vec<BrushId> = known.brushes.keys().copied().collect();
    let mut chosen = vec![rng.pick(&brushes)];
    let other = rng.pick(&brushes);
    if other != chosen[0] {
        chosen.push(other);
    }
    let shift = [0; 3].map(|_| rng.whole(-2, 2));
    let count = 1 + rng.below(2);
    let transform = Transform::translation(DVec3::from_array(shift)).expect("a shift");
    let before = known.nodes.clone();
    let (ids, change) = live.array_brushes(&chosen, &transform, count)?;
    let mut new_nodes = live.nodes().filter(|node| !before.contains_key(node)).collect::<Vec<_>>().into_iter();
    for (which, original) in chosen.iter().enumerate() {
        let copies: Vec<BrushId> = (0..count).map(|time| ids[time * chosen.len() + which]).collect();
        let role = known.roles[&TreeOperand::Brush(*original)];
        for (time, id) in copies.iter().enumerate() {
            let by = DVec3::from_array(shift) * (time + 1) as f64;
            let moved = known.brushes[original].clone().transformed(&Transform::translation(by).expect("a shift"));
            known.brushes.insert(*id, moved.expect("it is near"));
            known.roles.insert((*id).into(), role);
        }
        let (parent, place) = (known.parent((*original).into()), known.place((*original).into()));
        let is_one_operand = match parent.map(|node| known.nodes[&node].0) {
            None => role == Role::Intersect,
            Some(Operation::Intersection) => true,
            Some(Operation::Difference) => place == 0,
            Some(_) => false,
        };
        let with_copies = [*original].into_iter().chain(copies).map(TreeOperand::Brush);
        if is_one_operand {
            let node = new_nodes.next().expect("an operation for them");
            known.list(parent)[place] = node.into();
            known.roles.insert(node.into(), role);
            known.nodes.insert(node, (Operation::Union, with_copies.collect()));
        } else {
            known.list(parent).splice(place..=place, with_copies);
        }
    }
    Ok(change)
}

/// Whether the model has the brushes and operations that are known, in their places.
fn is_as_known(live: &LiveModel, known: &Known) -> bool {
    let operands = |of| live.operands(of).map(|operands| operands.collect::<Vec<_>>());
    let is_same = |(id, (operation, list)): (&NodeId, &(Operation, Vec<TreeOperand>))| {
        live.node(*id).is_ok_and(|node| node.operation == *operation && node.parent == known.parent((*id).into()))
            && operands(Some(*id)).as_ref() == Ok(list)
    };
    operands(None).as_ref() == Ok(&known.parts)
        && live.nodes().count() == known.nodes.len()
        && known.nodes.iter().all(is_same)
        && live.brushes().eq(known.brushes.keys().copied())
        && known.parts.iter().all(|part| match part {
            TreeOperand::Brush(id) => live.brush(*id).is_ok_and(|brush| brush.1 == known.roles[part]),
            TreeOperand::Node(id) => live.node(*id).is_ok_and(|node| node.role == known.roles[part]),
        })
}

fn compare(live: &LiveModel, viewer: &Viewer, known: &Known, case: &str) {
    assert!(is_as_known(live, known), "{case}: the tree");
    let (mesh, fresh) = (live.mesh().unwrap(), known.fresh().unwrap());
    assert!(mesh == fresh, "{case}: the mesh");
    let seen = viewer.triangles();
    assert_eq!(seen.len(), live.triangle_count(), "{case}");
    if live.has_faces() {
        assert!(viewer.is_closed(live), "{case}: the faces are closed");
        let expected = triangles_of(&mesh);
        assert!(seen.len() != expected.len() || seen == expected, "{case}: the faces are those of the mesh");
    }
}

/// Random edits of trees of brushes; gives how many were done, how many were refused, and the triangles after each, all in all.
fn sweep(seeds: u64, length: usize, shape: Shape) -> [usize; 3] {
    let (mut done, mut refused, mut triangles) = (0, 0, 0);
    for seed in 0..scaled(seeds) {
        let rng = &mut Rng::spread(seed);
        let (mut live, mut known, mut viewer) = (LiveModel::new(materials()), Known::default(), Viewer::default());
        let (mut before, mut after): (Vec<Known>, Vec<Known>) = (Vec::new(), Vec::new());
        for step in 0..length {
            let case = format!("seed {seed}, edit {step}");
            if rng.chance(0.2) {
                let undoes = rng.chance(0.6);
                let (from, to) = if undoes { (&mut before, &mut after) } else { (&mut after, &mut before) };
                let Some(other) = from.pop() else { continue };
                to.push(std::mem::replace(&mut known, other));
                let change = if undoes { live.undo() } else { live.redo() }.unwrap();
                viewer.follow(&live, &change).unwrap_or_else(|text| panic!("{case}: {text}"));
            } else {
                let mut new = known.clone();
                match edit(&mut new, &mut live, rng, shape) {
                    Ok(change) => {
                        viewer.follow(&live, &change).unwrap_or_else(|text| panic!("{case}: {text}"));
                        before.push(std::mem::replace(&mut known, new));
                        after.clear();
                        done += 1;
                    }
                    Err(EditError::Evaluate(EvaluateError::Unbounded)) => {
                        refused += 1;
                    }
                    Err(EditError::Nested(_) | EditError::WithinItself(_)) => {}
                    Err(error) => panic!("{case}: {error}"),
                }
            }
            compare(&live, &viewer, &known, &case);
            triangles += live.triangle_count();
        }
        while let Some(other) = before.pop() {
            let change = live.undo().unwrap();
            viewer.follow(&live, &change).unwrap();
            known = other;
        }
        compare(&live, &viewer, &known, &format!("seed {seed}: undone"));
    }
    [done, refused, triangles]
}

#[test]
fn random_edits_of_the_tree() {
    let [done, refused, triangles] = sweep(60, 40, random_cuboid);
    assert!(done > 1200 && refused > 20 && triangles > 10 * done, "{done} done, {refused} refused, {triangles}");
}

#[test]
fn random_edits_of_the_tree_with_equal_bodies() {
    let [done, refused, triangles] = sweep(60, 40, cuboid_of_few);
    assert!(done > 1200 && refused > 20 && triangles > 5 * done, "{done} done, {refused} refused, {triangles}");
}

#[test]
fn random_edits_of_the_tree_in_general_position() {
    let [done, refused, triangles] = sweep(15, 40, turned_body);
    assert!(done > 300 && refused > 5 && triangles > 60 * done, "{done} done, {refused} refused, {triangles}");
}

#[test]
fn unbounded_trees_are_refused_and_nothing_is_changed() {
    let mut live = LiveModel::new(materials());
    let (block, _) = live.add_brush(cube(0.0, 3.0), Role::Add).unwrap();
    let (hole, _) = live.add_brush(cube(1.0, 2.0), Role::Subtract).unwrap();
    let before = live.mesh().unwrap();
    let unbounded = EditError::Evaluate(EvaluateError::Unbounded);
    assert_eq!(live.wrap(&[block.into()], Operation::Complement).map(|_| ()), Err(unbounded));
    let (node, change) = live.wrap(&[hole.into()], Operation::Complement).unwrap();
    assert_eq!((live.triangle_count(), change.removed.len(), change.added.len()), (12, 12, 6), "the hole is left");
    assert_eq!(live.set_role(node, Role::Add), Err(unbounded));
    assert_eq!(live.node(node).map(|node| node.role), Ok(Role::Subtract));
    let change = live.set_role(node, Role::Intersect).unwrap();
    assert_eq!((live.mesh().unwrap(), change.added.len()), (before.clone(), 12));
    assert_eq!(live.move_brush_before(block, None).map(|_| live.triangle_count()), Ok(12), "the block is whole again");
    (0..3).for_each(|_| drop(live.undo().unwrap()));
    assert_eq!((live.mesh().unwrap(), live.nodes().count()), (before, 0));
}

#[test]
fn what_cannot_be_done_to_the_tree_is_refused() {
    let mut live = LiveModel::new(materials());
    let ids: Vec<TreeOperand> =
        (0..3).map(|k| live.add_brush(cube(f64::from(k), f64::from(k) + 1.5), Role::Add).unwrap().0.into()).collect();
    let (inner, _) = live.wrap(&ids[..2], Operation::Difference).unwrap();
    let (outer, _) = live.wrap(&[inner.into()], Operation::Union).unwrap();
    let before = (live.mesh().unwrap(), live.history_len());
    let missing = NodeId(7);
    assert_eq!(live.wrap(&[], Operation::Union), Err(EditError::NoOperands));
    assert_eq!(live.wrap(&[ids[0], ids[0]], Operation::Union), Err(EditError::Twice(ids[0])));
    assert_eq!(live.wrap(&[ids[0], ids[2]], Operation::Union), Err(EditError::Apart([ids[2], ids[0]])));
    assert_eq!(live.move_operand(outer, Some(inner), None), Err(EditError::WithinItself(outer)));
    assert_eq!(live.move_operand(outer, Some(missing), None), Err(EditError::UnknownNode(missing)));
    let elsewhere = EditError::NotAnOperand { operand: ids[2], of: Some(inner) };
    assert_eq!(live.move_operand(ids[0], Some(inner), Some(ids[2])), Err(elsewhere));
    assert_eq!(live.set_role(ids[0], Role::Subtract), Err(EditError::Nested(ids[0])));
    assert_eq!(live.set_operation(missing, Operation::Xor), Err(EditError::UnknownNode(missing)));
    assert_eq!(live.dissolve(missing), Err(EditError::UnknownNode(missing)));
    assert_eq!(live.remove_node(missing), Err(EditError::UnknownNode(missing)));
    let far = BrushId(9);
    assert_eq!(live.copy_brushes(&[far], &Transform::identity()), Err(EditError::UnknownBrush(far)));
    let first = BrushId(0);
    assert_eq!(
        live.copy_brushes(&[first, first], &Transform::identity()),
        Err(EditError::Twice(TreeOperand::Brush(first)))
    );
    assert!(matches!(
        live.array_brushes(&[first], &Transform::identity(), usize::MAX),
        Err(EditError::Copies { found: usize::MAX, .. })
    ));
    assert_eq!(elsewhere.to_string(), "found brush 2, expected an operand of node 0");
    assert_eq!((live.mesh().unwrap(), live.history_len()), before);
}

#[test]
fn operations_of_the_input_are_numbered_and_can_be_edited() {
    let tree = (Tree::from(cube(0.0, 4.0)) - Tree::from(cube(1.0, 2.0)))
        | (Tree::from(cube(3.0, 6.0)) ^ (Tree::from(cube(5.0, 7.0)) & Tree::from(cube(4.0, 6.5))));
    let mut live = LiveModel::from_model(Model { materials: materials(), tree }).unwrap();
    let [xor, both] = [0, 1].map(NodeId);
    assert_eq!(live.nodes().collect::<Vec<_>>(), [xor, both]);
    let brush = |k| TreeOperand::Brush(BrushId(k));
    assert_eq!(live.operands(None).unwrap().collect::<Vec<_>>(), [brush(0), brush(1), xor.into()]);
    assert_eq!(live.operands(Some(xor)).unwrap().collect::<Vec<_>>(), [brush(2), both.into()]);
    assert_eq!((live.parent(brush(3)), live.parent(both)), (Ok(Some(both)), Ok(Some(xor))));
    live.set_operation(both, Operation::Union).unwrap();
    live.move_operand(both, None, Some(brush(1))).unwrap();
    let block = Tree::from(cube(0.0, 4.0)) | Tree::from(cube(5.0, 7.0)) | Tree::from(cube(4.0, 6.5));
    let expected = (block - Tree::from(cube(1.0, 2.0))) | Tree::from(cube(3.0, 6.0));
    let fresh = evaluate(&Model { materials: materials(), tree: expected }).unwrap().mesh;
    assert_eq!(live.mesh().unwrap(), fresh);
    assert_eq!(evaluate(&live.to_model()).unwrap().mesh, fresh);
    live.dissolve(both).unwrap();
    live.dissolve(xor).unwrap();
    assert_eq!((live.mesh().unwrap(), live.nodes().count()), (fresh, 0));
}

#[test]
fn a_copy_does_what_it_is_a_copy_of_does() {
    // a wall, a door in it, and a frame within the door, which a copy of the door must not cut
    let mut live = LiveModel::new(materials());
    let (wall, _) = live.add_brush(cuboid([0.0; 3], [20.0, 1.0, 4.0]), Role::Add).unwrap();
    let (door, _) = live.add_brush(cuboid([2.0, -1.0, 0.0], [4.0, 2.0, 3.0]), Role::Subtract).unwrap();
    let (frame, _) = live.add_brush(cuboid([2.0, 0.0, 0.0], [2.25, 1.0, 3.0]), Role::Add).unwrap();
    let shift = Transform::translation([5.0, 0.0, 0.0]).unwrap();
    let (copies, _) = live.array_brushes(&[door, frame], &shift, 2).unwrap();
    assert_eq!(copies, [3, 4, 5, 6].map(BrushId));
    let order: Vec<TreeOperand> = live.operands(None).unwrap().collect();
    assert_eq!(order, [wall, door, copies[0], copies[2], frame, copies[1], copies[3]].map(TreeOperand::Brush));
    assert_eq!(live.brush(copies[2]).unwrap().1, Role::Subtract);
    let volume = evaluate(&live.to_model()).unwrap().solid.volume;
    assert_eq!(volume, 80.0 - 3.0 * (6.0 - 0.75));
    live.undo().unwrap();
    assert_eq!(live.brushes().len(), 3);
}

#[test]
fn mirror_images_in_planes_across_axes_are_exact() {
    let mut live = LiveModel::new(materials());
    let sloped = HalfSpace::new([0.1, 0.7, 0.3], 0.9).unwrap();
    let (block, _) = live.add_brush(cuboid([0.1; 3], [0.7; 3]), Role::Add).unwrap();
    live.add_plane(block, sloped, MaterialId(1)).unwrap();
    for (normal, offset) in [([0.0, 3.0, 0.0], 0.3), ([0.0, -1.0, 0.0], -0.1), ([0.0, 0.7, 0.0], 0.0)] {
        let (copies, _) = live.mirror_brushes(&[block], &HalfSpace::new(normal, offset).unwrap()).unwrap();
        let at = offset / normal[1];
        let (copy, _) = live.brush(copies[0]).unwrap();
        for (face, original) in copy.faces.iter().zip(&live.brush(block).unwrap().0.faces) {
            let [x, y, z, d] = original.half_space.to_array();
            assert_eq!(face.half_space.normal().to_array(), [x, -y, z]);
            assert_eq!(face.half_space.offset(), d - y * (2.0 * at), "rounded once, and the product");
            assert_eq!(face.material, original.material);
        }
    }
    // what ends at the mirror and its image are one block without a wall
    let mut live = LiveModel::new(materials());
    let (half, _) = live.add_brush(cuboid([0.0; 3], [1.0, 0.1, 1.0]), Role::Add).unwrap();
    live.mirror_brushes(&[half], &HalfSpace::new([0.0, 1.0, 0.0], 0.1).unwrap()).unwrap();
    assert_eq!(live.triangle_count(), 12);
}

#[test]
fn there_is_always_room_between_two_brushes() {
    let mut live = LiveModel::new(materials());
    let (first, _) = live.add_brush(cuboid([0.0; 3], [1.0; 3]), Role::Add).unwrap();
    let (last, _) = live.add_brush(cuboid([0.5; 3], [1.5; 3]), Role::Subtract).unwrap();
    let mut expected = vec![first, last];
    for k in 0..700 {
        // alternately behind the first and before the last, each halving what is left
        let empty = Brush::cuboid(DVec3::ZERO, DVec3::ZERO, MaterialId(0));
        let (new, _) = live.add_brush(empty, Role::Add).unwrap();
        let before = expected[if k % 2 == 0 { 1 } else { expected.len() / 2 }];
        live.move_brush_before(new, Some(before)).unwrap();
        let place = expected.iter().position(|id| *id == before).unwrap();
        expected.insert(place, new);
    }
    let order: Vec<TreeOperand> = live.operands(None).unwrap().collect();
    assert_eq!(order, expected.iter().copied().map(TreeOperand::Brush).collect::<Vec<_>>());
    assert_eq!(live.history_len(), (1000, 0));
    (0..1000).for_each(|_| drop(live.undo().unwrap()));
    (0..1000).for_each(|_| drop(live.redo().unwrap()));
    let order: Vec<TreeOperand> = live.operands(None).unwrap().collect();
    assert_eq!(order, expected.into_iter().map(TreeOperand::Brush).collect::<Vec<_>>());
}

#[test]
fn a_brush_that_moves_in_the_order_changes_what_is_near_it_alone() {
    let mut live = LiveModel::new(materials());
    let row: Vec<(Brush, Role)> = (0..20)
        .flat_map(|k| {
            let x = 4.0 * f64::from(k);
            let block = cuboid([x, 0.0, 0.0], [x + 2.0, 2.0, 2.0]);
            [(cuboid([x + 0.5, 0.5, -1.0], [x + 1.5, 1.5, 3.0]), Role::Subtract), (block, Role::Add)]
        })
        .collect();
    let (ids, _) = live.add_brushes(row).unwrap();
    assert_eq!(live.triangle_count(), 240, "blocks that come after their holes are whole");
    let change = live.move_brush_before(ids[8], None).unwrap();
    assert_eq!((change.removed.len(), change.added.len()), (2, 6));
    let (node, change) = live.wrap(&[ids[8].into(), ids[9].into()], Operation::Union).unwrap();
    assert_eq!((change.removed.len(), change.added.len()), (4, 10), "what was a hole is a post");
    let change = live.set_operation(node, Operation::Xor).unwrap();
    assert!(change.brushes.len() == 2 && change.added.len() <= 12, "{change:?}");
}

#[test]
fn a_step_of_a_move_to_where_an_operand_stands_is_none() {
    let mut live = LiveModel::new(materials());
    let row = (0..4).map(|k| (cube(f64::from(k), f64::from(k) + 2.0), Role::Add));
    let (ids, _) = live.add_brushes(row.collect::<Vec<_>>()).unwrap();
    let known = live.history_len();
    for (place, id) in ids.iter().enumerate() {
        for before in [ids.get(place + 1).copied(), Some(*id)] {
            live.begin_step().unwrap();
            let change = live.move_brush_before(*id, before).unwrap();
            live.commit_step().unwrap();
            assert_eq!((change.removed.len(), change.added.len(), live.history_len()), (0, 0, known));
        }
    }
    live.begin_step().unwrap();
    live.move_brush_before(ids[0], None).unwrap();
    live.commit_step().unwrap();
    assert_eq!(live.history_len(), (known.0 + 1, 0));
}
