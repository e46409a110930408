//! One face of one body: which part of it is boundary, and where that part ends.

use planecut_kernel::DVec3;
use planecut_kernel::sign::Sign;

use super::clip::{Clipper, Cutter};
use super::contact::{Contact, Facing, misses};
use super::covered::CoverWorker;
use super::ownership::{EdgeSide, Ownership, Turn};
use super::role::{Pair, Role};
use super::section::{Clip, Cover, Line, Piece, Polygon};
use super::signs::{KeptSigns, Signs};
use super::sweep::{Context, Sweep};
use super::{BoundaryEdge, EdgeChange, KnownEdge, Scene};
use crate::base::{Bounds, Boxes, push_if};
use crate::body::{BodyFace, PlaneFilter};
use crate::expression::{OneLevel, Restriction};
use crate::ids::{BodyFaceId, BodyId, EdgeId, Id, KeptLeafId, LeafId, NearId, holds, number32, place_of};
use crate::plane_table::{PlaneId, PlaneTable};

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

/// A part of the face that another body covers.
#[derive(Debug, Clone)]
pub(super) struct Section {
    pub(super) polygon: Polygon,
    pub(super) bounds: Bounds,
    pub(super) of: Reaching,
}

impl Section {
    /// Whether another surely lies within this one, and strictly but for edges of the region, which both lie in.
    fn surely_holds(&self, table: &PlaneTable, region: &Polygon, other: &Self) -> bool {
        self.bounds.holds(&other.bounds)
            && self.polygon.edges.iter().all(|edge| {
                holds(&region.edges, *edge) || {
                    let filter = PlaneFilter::new(table.half_space(*edge));
                    other.polygon.corners.iter().all(|corner| filter.side(corner) == Sign::Negative)
                }
            })
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
    coplanar: usize,
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

    /// Finds what covering bodies leave of the region; false where that is nothing.
    fn cover_region(&mut self, scene: &Scene<'_>, face: &BodyFace) -> bool {
        self.live = 0;
        for k in 0..self.covering.len() {
            let cutter = cutter(scene, &self.signs, face, &self.covering[k]);
            if self.clipper.surely_holds(cutter, &self.region) {
                return false;
            }
        }
        for k in 0..self.covering.len() {
            match self.cover(scene, face, self.covering[k]) {
                Clip::Whole => return false,
                Clip::Part if self.take_section(scene, face) => {}
                Clip::Part => return false,
                Clip::Nothing => {}
            }
        }
        self.drop_held_sections(scene.table);
        true
    }

    /// Takes the section that was cut last; false where covering bodies leave nothing of the region.
    ///
    /// Where a section has one edge within the region, what it leaves is convex, and the region becomes that.
    fn take_section(&mut self, scene: &Scene<'_>, face: &BodyFace) -> bool {
        let mut k = self.live;
        self.live += 1;
        while k < self.live {
            let mut within = self.edges_within_region(k);
            match (within.next(), within.next()) {
                (None, _) => return false,
                (Some(edge), None) => {
                    drop(within);
                    self.leave_out_section(k);
                    self.cut_region(scene, face, edge.flipped());
                    // of others there may be one edge left now
                    k = 0;
                }
                (Some(_), Some(_)) => k += 1,
            }
        }
        true
    }

    /// The edges of a section that are none of the region.
    fn edges_within_region(&self, section: usize) -> impl Iterator<Item = PlaneId> {
        let edges = self.sections[section].polygon.edges.iter().copied();
        edges.filter(|edge| !holds(&self.region.edges, *edge))
    }

    /// Cuts the region, and the sections with it.
    fn cut_region(&mut self, scene: &Scene<'_>, face: &BodyFace, cut: PlaneId) {
        self.region.clip(Signs::new(scene.table, &self.signs), face.plane, cut, &mut self.part);
        self.clipper.look_at(&self.region);
        for k in (0..self.live).rev() {
            let (section, signs) = (&mut self.sections[k], Signs::new(scene.table, &self.signs));
            match section.polygon.clip(signs, face.plane, cut, &mut self.part) {
                Clip::Whole => section.polygon.name_edge_by(signs, face.plane, cut),
                Clip::Part => section.bounds = section.polygon.bounds(),
                Clip::Nothing => self.leave_out_section(k),
            }
        }
    }

    /// Leaves out a section; the others stay in order.
    fn leave_out_section(&mut self, section: usize) {
        self.sections[section..self.live].rotate_left(1);
        self.live -= 1;
    }

    /// Leaves out what covering bodies cover within what another covers: none of its edges is one of the boundary.
    fn drop_held_sections(&mut self, table: &PlaneTable) {
        if self.live > MANY_SECTIONS {
            return;
        }
        let mut k = 0;
        while k < self.live {
            let (section, others) = (&self.sections[k], (0..self.live).filter(|other| *other != k));
            if others.map(|other| &self.sections[other]).any(|other| other.surely_holds(table, &self.region, section)) {
                self.leave_out_section(k);
            } else {
                k += 1;
            }
        }
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
        self.coplanar = 0;
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
        self.covering.push(reaching);
        if reaching.contact != Contact::Across {
            let last = self.covering.len() - 1;
            self.covering.swap(self.coplanar, last);
            self.coplanar += 1;
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
        self.coplanar = 0;
        self.open.clear();
        self.holding.clear();
        self.others.clear();
        for leaf in KeptLeafId::all(self.bodies.len()) {
            if leaf != own.leaf && self.restriction.matters(leaf) {
                self.others.push(self.reaching(scene, leaf, face));
            }
        }
        let polarity = scene.polarity(own.body);
        let coplanar = self.others.iter().filter(|other| other.contact != Contact::Across).count();
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

    /// Clips the region by a body into the next free section.
    fn cover(&mut self, scene: &Scene<'_>, face: &BodyFace, of: Reaching) -> Clip {
        if self.sections.len() == self.live {
            self.sections.push(Section { polygon: Polygon::default(), bounds: Bounds::EMPTY, of });
        }
        let cutter = cutter(scene, &self.signs, face, &of);
        let section = &mut self.sections[self.live];
        section.of = of;
        let clip = self.clipper.clip(cutter, &self.region, &mut section.polygon);
        if clip == Clip::Part {
            section.bounds = section.polygon.bounds();
        }
        clip
    }

    /// The pieces of the region's own edges along which nothing is covered.
    fn emit_own_edges(&mut self, scene: &Scene<'_>, face: &BodyFace, facing: Facing, out: &mut Vec<BoundaryEdge>) {
        let signs = Signs::new(scene.table, &self.signs);
        for (i, &edge) in self.region.edges.iter().enumerate() {
            let line = Line { plane: face.plane, edge };
            self.pieces.clear();
            self.pieces.push(Piece::of_edge(&self.region, i));
            for section in &self.sections[..self.live] {
                let polygon = &section.polygon;
                if let Some(k) = place_of(&polygon.edges, edge) {
                    let covered = Piece::of_edge(polygon, k);
                    line.subtract(signs, &mut self.pieces, &covered);
                }
            }
            out.extend(self.pieces.iter().map(|piece| BoundaryEdge::left(face, facing, edge, piece.start, piece.end)));
        }
    }

    /// The pieces of section edges outside of which nothing is covered: there the boundary ends, too.
    fn emit_section_edges(&mut self, scene: &Scene<'_>, face: &BodyFace, facing: Facing, out: &mut Vec<BoundaryEdge>) {
        let signs = Signs::new(scene.table, &self.signs);
        let sections = &self.sections[..self.live];
        let boxes = || Boxes::new(sections.iter().map(|section| section.bounds).collect());
        let boxes = (sections.len() > MANY_SECTIONS).then(boxes);
        self.beside.clear();
        self.beside.extend(0..number32(sections.len()));
        for (k, section) in sections.iter().enumerate() {
            if let Some(boxes) = &boxes {
                boxes.touching(&section.bounds, &mut self.beside);
            }
            for (i, &edge) in section.polygon.edges.iter().enumerate() {
                if holds(&self.region.edges, edge) {
                    continue;
                }
                let line = Line { plane: face.plane, edge };
                self.pieces.clear();
                self.pieces.push(Piece::of_edge(&section.polygon, i));
                subtract_others(signs, line, sections, &self.beside, [k, i], &mut self.pieces);
                let right = |piece: &Piece| BoundaryEdge::right(face, facing, edge, piece.start, piece.end);
                out.extend(self.pieces.iter().map(right));
            }
        }
    }
}

fn cutter<'a>(scene: &'a Scene<'a>, signs: &'a KeptSigns, face: &'a BodyFace, by: &Reaching) -> Cutter<'a> {
    Cutter { scene, signs: Signs::new(scene.table, signs), face, body: by.body, place: by.place }
}

/// Takes out of `pieces`, which lie on edge `edge` of section `own`, what others cover on the outer side of those `beside`.
///
/// Along a shared edge line a section on the outer side covers; of two on the same side the first keeps the edge.
fn subtract_others(
    signs: Signs<'_>,
    line: Line,
    sections: &[Section],
    beside: &[u32],
    [own, edge]: [usize; 2],
    pieces: &mut Vec<Piece>,
) {
    let Some(whole) = pieces.first().copied() else { return };
    let bounds = sections[own].polygon.edge_bounds(edge);
    for (k, other) in beside.iter().map(|k| (*k as usize, &sections[*k as usize])) {
        if k == own || pieces.is_empty() || !other.bounds.touches(&bounds) {
            continue;
        }
        match line.cover(signs, &whole, &other.polygon) {
            Cover::Apart => {}
            Cover::Across(part) => line.subtract(signs, pieces, &part),
            Cover::Along(part, edge) => {
                if !line.is_same_side(signs.table, edge) || k < own {
                    line.subtract(signs, pieces, &part);
                }
            }
        }
    }
}
