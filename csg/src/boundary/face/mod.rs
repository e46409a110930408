//! One face of one body: which part of it is boundary, and where that part ends.

mod cover;
mod edges;

use planecut_kernel::DVec3;

pub(super) use cover::Section;

use super::clip::{Clipper, Cutter};
use super::contact::{Contact, Facing, misses};
use super::covered::CoverWorker;
use super::ownership::{EdgeSide, Ownership, Turn};
use super::role::{Pair, Role};
use super::section::{Clip, Piece, Polygon};
use super::signs::{KeptSigns, Signs};
use super::sweep::{Context, Sweep};
use super::{BoundaryEdge, EdgeChange, KnownEdge, Scene};
use crate::base::{Bounds, push_if};
use crate::body::BodyFace;
use crate::expression::{OneLevel, Restriction};
use crate::ids::{BodyFaceId, BodyId, EdgeId, Id, KeptLeafId, LeafId, NearId};

/// Number of sections from which those near one are looked up: few are compared one by one.
const MANY_SECTIONS: usize = 32;

/// A body that reaches the plane of the face.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reaching {
    body: BodyId,
    /// Its place among the bodies near.
    place: NearId,
    /// Its place among the leaves of the restriction.
    pub(super) leaf: KeptLeafId,
    pub(super) contact: Contact,
    /// When its face on the plane has its turn, where it has one.
    pub(super) turn: Turn,
}

impl Reaching {
    /// Whether it has a face on the plane.
    fn is_coplanar(&self) -> bool {
        self.contact != Contact::Across
    }
}

/// Emits the boundary edges of faces, reusing its buffers.
#[derive(Default)]
pub(crate) struct FaceWorker {
    /// The body whose faces are worked on.
    body: Option<BodyId>,
    /// The bodies that may touch it, itself among them, ascending.
    near: Vec<BodyId>,
    /// The boxes of these.
    boxes: Vec<Bounds>,
    restriction: Restriction,
    bodies: Vec<BodyId>,
    /// The places of these among the bodies near.
    places: Vec<NearId>,
    leaves: Vec<LeafId>,
    others: Vec<Reaching>,
    /// Bodies that cover what lies in them, first those with a face on the plane: of these one often covers all.
    covering: Vec<Reaching>,
    open: Vec<Reaching>,
    /// Bodies that hold both sides of all of the region.
    holding: Vec<KeptLeafId>,
    region: Polygon,
    part: Polygon,
    sections: Vec<Section>,
    live: usize,
    clipper: Clipper,
    pieces: Vec<Piece>,
    /// The sections near one of them.
    beside: Vec<u32>,
    ownership: Ownership,
    sweep: Sweep,
    cover: CoverWorker,
    signs: KeptSigns,
}

impl FaceWorker {
    /// Begins with the faces of another body; `near` are the bodies whose boxes touch its own, by number, itself among them.
    pub(crate) fn begin(&mut self, scene: &Scene<'_>, body: BodyId, near: impl IntoIterator<Item = BodyId>) {
        self.body = Some(body);
        self.signs.forget();
        self.near.clear();
        self.boxes.clear();
        self.clipper.begin(scene, body);
        for other in near {
            if other == body {
                self.clipper.add_itself();
            } else if !self.clipper.add_near(scene, body, other) {
                continue;
            }
            self.near.push(other);
            self.boxes.push(scene.body(other).bounds);
        }
    }

    fn own(&self) -> BodyId {
        self.body.expect("the faces of a body are worked on")
    }

    /// Emits the boundary of what a face of the body is of the boundary.
    pub(crate) fn emit(&mut self, scene: &Scene<'_>, face: BodyFaceId, out: &mut Vec<BoundaryEdge>) {
        let body = self.own();
        let solid = scene.body(body);
        let this = &solid.faces[face.index()];
        self.region.set(solid.edges(this), solid.corners(this));
        self.clipper.look_at(&self.region);
        let own = self.gather(scene, this);
        if let Some(operation) = scene.one_level
            && (operation == OneLevel::Union || !scene.is_plane_shared(this))
        {
            if let Some(facing) = self.sort_out_one_level(scene, own, this, operation)
                && self.cover_region(scene, this)
            {
                self.emit_own_edges(scene, this, facing, out);
                self.emit_section_edges(scene, this, facing, out);
            }
            return;
        }
        self.restriction.restrict(scene.expression, &self.leaves);
        if !self.restriction.matters(own) {
            return;
        }
        let turn = scene.turn(body, this);
        let own = Reaching { body, place: NearId::NONE, leaf: own, contact: Contact::SameWay, turn };
        self.ownership.begin(scene.expression, &mut self.restriction, &own);
        if !self.sort_out(scene, &own, this) {
            return;
        }
        if self.open.is_empty() && self.emitted_on_region(scene).is_none() {
            return;
        }
        if !self.cover_region(scene, this) {
            return;
        }
        let covering = self.live;
        for k in 0..self.open.len() {
            if self.is_silenced(scene, self.open[k].leaf) {
                continue;
            }
            match self.cover(scene, this, self.open[k]) {
                Clip::Whole => self.hold(scene, self.open[k]),
                Clip::Part => self.live += 1,
                Clip::Nothing => {}
            }
        }
        for k in (covering..self.live).rev() {
            if self.is_silenced(scene, self.sections[k].of.leaf) {
                self.live -= 1;
                self.sections.swap(k, self.live);
            }
        }
        if self.live > covering {
            let signs = Signs::new(scene.table, &self.signs);
            let context = Context { scene, signs, face: this, sections: &self.sections[..self.live], covering };
            self.sweep.emit(&context, &self.region, &mut self.restriction, &mut self.ownership, out);
        } else if let Some(facing) = self.emitted_on_region(scene) {
            self.emit_own_edges(scene, this, facing, out);
            self.emit_section_edges(scene, this, facing, out);
        }
    }

    /// How the edges known on a face of a body change where another body covers what lies in it; as [`CoverWorker::change`].
    pub(crate) fn cover_known(
        &mut self,
        scene: &Scene<'_>,
        by: BodyId,
        face: BodyFaceId,
        known: &[KnownEdge],
        rounded: impl Fn(EdgeId) -> [DVec3; 2],
    ) -> Option<EdgeChange> {
        // a body that is apart covers nothing
        let Ok(place) = self.near.binary_search(&by) else { return Some(EdgeChange::default()) };
        let solid = scene.body(self.own());
        let face = &solid.faces[face.index()];
        self.region.set(solid.edges(face), solid.corners(face));
        let signs = Signs::new(scene.table, &self.signs);
        let cutter = Cutter { scene, signs, face, body: by, place: NearId::from_index(place) };
        self.cover.change(&mut self.clipper, cutter, &self.region, known, rounded)
    }

    /// What [`sort_out`](Self::sort_out) finds in a union, or where the tree has one level and no other face lies on the plane; and which
    /// boundary the face is, where it is any.
    ///
    /// In a union a body covers what lies in it, and what its face covers on the plane: there the solid goes on where it faces the other way, and where it faces
    /// the same way the first of both emits the boundary.
    fn sort_out_one_level(
        &mut self,
        scene: &Scene<'_>,
        own: KeptLeafId,
        face: &BodyFace,
        operation: OneLevel,
    ) -> Option<Facing> {
        self.covering.clear();
        let turn = scene.turn(self.own(), face);
        let is_tool = operation == OneLevel::Difference && self.leaves[own.index()].index() != 0;
        let mut is_in_first = !is_tool;
        for leaf in KeptLeafId::all(self.bodies.len()) {
            if leaf == own {
                continue;
            }
            let reaching = self.reaching(scene, leaf, face);
            if is_tool && self.leaves[leaf.index()].index() == 0 {
                if !self.require(scene, face, &reaching) {
                    return None;
                }
                is_in_first = true;
            } else if reaching.contact != Contact::SameWay || reaching.turn < turn {
                self.cover_by(reaching);
            }
        }
        is_in_first.then_some(if is_tool { Facing::In } else { Facing::Out })
    }

    /// Adds a body that covers what lies in it.
    fn cover_by(&mut self, reaching: Reaching) {
        let coplanar = self.covering.partition_point(Reaching::is_coplanar);
        self.covering.push(reaching);
        if reaching.is_coplanar() {
            let last = self.covering.len() - 1;
            self.covering.swap(coplanar, last);
        }
    }

    /// Cuts the region down to what lies in a body; false where that is nothing.
    fn require(&mut self, scene: &Scene<'_>, face: &BodyFace, by: &Reaching) -> bool {
        let cutter = cutter(scene, &self.signs, face, by);
        match self.clipper.clip(cutter, &self.region, &mut self.part) {
            Clip::Nothing => return false,
            Clip::Part => {
                std::mem::swap(&mut self.region, &mut self.part);
                self.clipper.look_at(&self.region);
            }
            Clip::Whole => {}
        }
        true
    }

    /// Takes a body as covering all of the region.
    fn hold(&mut self, scene: &Scene<'_>, reaching: Reaching) {
        self.ownership.cover_both(scene.expression, &mut self.restriction, &reaching);
        if reaching.contact == Contact::Across {
            self.holding.push(reaching.leaf);
        }
    }

    /// Whether a body changes nothing within the region, as others hold all of it.
    fn is_silenced(&self, scene: &Scene<'_>, leaf: KeptLeafId) -> bool {
        let silences = |other: &KeptLeafId| self.restriction.forces(scene.expression, *other, true, leaf).is_some();
        self.holding.iter().any(silences)
    }

    /// Which boundary the face is where nothing is covered that depends on several bodies.
    fn emitted_on_region(&mut self, scene: &Scene<'_>) -> Option<Facing> {
        self.ownership.emitted(scene.expression, &mut self.restriction, EdgeSide::Left)
    }

    /// Finds the bodies that may reach the face, and their leaves; gives the place of its own body.
    fn gather(&mut self, scene: &Scene<'_>, face: &BodyFace) -> KeptLeafId {
        let body = self.own();
        let half_space = scene.table.half_space(face.plane);
        let (normal, offset) = (half_space.normal(), half_space.offset());
        let Self { near, boxes, bodies, places, clipper, .. } = self;
        // by their boxes first, without a branch for each
        places.clear();
        for (place, (other, bounds)) in NearId::all(near.len()).zip(near.iter().zip(boxes.iter())) {
            push_if(places, place, (*other == body) | bounds.may_share_area(&face.bounds));
        }
        bodies.clear();
        let mut own = None;
        places.retain(|place| {
            let other = near[place.index()];
            if other == body {
                own = Some(KeptLeafId::from_index(bodies.len()));
            }
            let misses = || misses(&boxes[place.index()], normal, offset);
            let reaches = other == body || !clipper.is_known_outside(*place) && !misses();
            if reaches {
                bodies.push(other);
            }
            reaches
        });
        self.leaves.clear();
        self.leaves.extend(self.bodies.iter().map(|body| scene.leaf_of_body[body.index()]));
        own.expect("a body is near itself")
    }

    /// Finds what each body does to the face and cuts the face down to what is required; false where nothing is left.
    fn sort_out(&mut self, scene: &Scene<'_>, own: &Reaching, face: &BodyFace) -> bool {
        self.covering.clear();
        self.open.clear();
        self.holding.clear();
        self.others.clear();
        for leaf in KeptLeafId::all(self.bodies.len()) {
            if leaf != own.leaf && self.restriction.matters(leaf) {
                self.others.push(self.reaching(scene, leaf, face));
            }
        }
        let polarity = scene.polarity(own.body);
        let coplanar = self.others.iter().filter(|other| other.is_coplanar()).count();
        for k in 0..self.others.len() {
            let reaching = self.others[k];
            match Pair::new(scene.expression, &self.restriction, (own, polarity), &reaching, coplanar).role() {
                Role::None => {}
                Role::Covers => self.cover_by(reaching),
                Role::Open => self.open.push(reaching),
                Role::Required => {
                    if !self.require(scene, face, &reaching) {
                        return false;
                    }
                    self.hold(scene, reaching);
                }
            }
        }
        true
    }

    fn reaching(&self, scene: &Scene<'_>, leaf: KeptLeafId, face: &BodyFace) -> Reaching {
        let body = self.bodies[leaf.index()];
        let is_shared = scene.is_plane_shared(face);
        let other = if is_shared { scene.body(body).face_on(face.plane) } else { None };
        let contact = match other {
            None => Contact::Across,
            Some(other) if other.plane == face.plane => Contact::SameWay,
            Some(_) => Contact::OtherWay,
        };
        // a body that crosses the plane has no face there, and its turn is never asked for
        let turn = scene.turn(body, other.unwrap_or(face));
        Reaching { body, place: self.places[leaf.index()], leaf, contact, turn }
    }
}

fn cutter<'a>(scene: &'a Scene<'a>, signs: &'a KeptSigns, face: &'a BodyFace, by: &Reaching) -> Cutter<'a> {
    Cutter { scene, signs: Signs::new(scene.table, signs), face, body: by.body, place: by.place }
}
