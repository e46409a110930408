//! On which sides of planes corners of a face lie, asked once: the same four planes are asked about from each edge that ends in a corner.

use std::cell::{Cell, OnceCell};

use planecut_kernel::sign::{Sign, side_left_open};

use crate::body::{Corner, PlaneFilter};
use crate::plane_table::{PlaneId, PlaneTable};

/// Number of signs that are kept, a power of two.
const KEPT: usize = 512;

/// Signs of four planes, each in the one place where its planes may be kept; those of planes that came later take it over.
#[derive(Debug, Default)]
pub(super) struct KeptSigns {
    /// Signs of earlier rounds count no more.
    round: Cell<u32>,
    signs: OnceCell<Box<[Cell<Kept>]>>,
}

#[derive(Debug, Clone, Copy)]
struct Kept {
    round: u32,
    planes: [u32; 4],
    sign: Sign,
}

impl KeptSigns {
    /// Forgets all signs: those that follow are of planes of another table, or of other planes.
    pub(super) fn forget(&self) {
        let round = self.round.get().wrapping_add(1);
        if round == 0 {
            // one of as many rounds ago would pass for one of this
            self.signs.get().into_iter().flat_map(|signs| signs.iter()).for_each(|kept| kept.set(Kept::NONE));
        }
        self.round.set(round);
    }

    fn of(&self, planes: [u32; 4]) -> &Cell<Kept> {
        let signs = self.signs.get_or_init(|| vec![Cell::new(Kept::NONE); KEPT].into());
        let factors = [0x9E37_79B1_u32, 0x85EB_CA77, 0xC2B2_AE3D, 0x27D4_EB2F];
        let mixed = planes.iter().zip(factors).fold(0, |mixed, (plane, factor)| mixed ^ plane.wrapping_mul(factor));
        &signs[(mixed >> (u32::BITS - KEPT.ilog2())) as usize]
    }
}

impl Kept {
    /// Of no four planes.
    const NONE: Self = Self { round: 0, planes: [0; 4], sign: Sign::Zero };
}

/// The planes of a scene, and what is kept of signs among them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Signs<'a> {
    pub(super) table: &'a PlaneTable,
    kept: Option<&'a KeptSigns>,
}

impl<'a> Signs<'a> {
    /// With signs that are kept since they were last [forgotten](KeptSigns::forget), of planes of this table.
    pub(super) fn new(table: &'a PlaneTable, kept: &'a KeptSigns) -> Self {
        Self { table, kept: Some(kept) }
    }

    /// Without any that is kept.
    pub(super) fn of(table: &'a PlaneTable) -> Self {
        Self { table, kept: None }
    }

    /// On which side of a plane a corner lies; `planes` are those that meet in it, right-handed.
    #[inline]
    pub(super) fn side(&self, corner: &Corner, planes: [PlaneId; 3], plane: PlaneId) -> Sign {
        self.settled(PlaneFilter::new(self.table.half_space(plane)).side(corner), || planes, plane)
    }

    /// The same of a corner of which plain numbers told a side, or left it open: only then it is asked for its planes.
    #[inline]
    pub(super) fn settled(&self, side: Sign, planes: impl FnOnce() -> [PlaneId; 3], plane: PlaneId) -> Sign {
        match side {
            Sign::Zero => self.exact_side(planes(), plane),
            certain => certain,
        }
    }

    /// The same where plain numbers leave it open.
    #[inline]
    fn exact_side(&self, planes: [PlaneId; 3], plane: PlaneId) -> Sign {
        if planes.iter().fold(false, |is_one, other| is_one | (other.index() == plane.index())) {
            return Sign::Zero;
        }
        self.side_of_other(planes, plane)
    }

    /// The same for a plane that is none of those of the corner.
    #[cold]
    #[inline(never)]
    fn side_of_other(&self, planes: [PlaneId; 3], plane: PlaneId) -> Sign {
        let side = || side_left_open(planes.map(|plane| self.table.row(plane)), self.table.row(plane));
        let Some(kept) = self.kept else { return side() };
        // the sign is that of a determinant: rows that change places turn it, and so do rows of opposite sides
        let mut sorted = [planes[0], planes[1], planes[2], plane];
        let mut is_turned = false;
        for (i, j) in [(0, 1), (2, 3), (0, 2), (1, 3), (1, 2)] {
            if sorted[i].index() > sorted[j].index() {
                sorted.swap(i, j);
                is_turned = !is_turned;
            }
        }
        is_turned ^= sorted.iter().filter(|plane| **plane != plane.unsided()).count() % 2 == 1;
        let turn = |sign: Sign| if is_turned { sign.flip() } else { sign };
        let (sorted, round) = (sorted.map(PlaneId::index), kept.round.get());
        let place = kept.of(sorted);
        let found = place.get();
        if (found.round, found.planes) == (round, sorted) {
            return turn(found.sign);
        }
        let side = side();
        place.set(Kept { round, planes: sorted, sign: turn(side) });
        side
    }
}

#[cfg(test)]
mod tests {
    use planecut_kernel::{DVec3, HalfSpace};
    use planecut_testkit::random::Rng;

    use super::*;

    /// Planes of which some meet in one point, or nearly so.
    fn planes(rng: &mut Rng) -> (PlaneTable, Vec<PlaneId>) {
        let mut table = PlaneTable::default();
        let planes = (0..9).map(|_| {
            let normal = rng.unit();
            let through = normal.dot(DVec3::splat(0.7));
            let elsewhere = rng.float(-1.0, 1.0);
            let offset = rng.pick(&[through, through.next_up(), elsewhere]);
            table.insert_exact(&HalfSpace::new(normal, offset).expect("a plane"))
        });
        let planes = planes.collect();
        (table, planes)
    }

    /// What is kept is asked for in every order and from either side of each plane; of two tables in turns, with the same numbers of planes.
    #[test]
    fn signs_that_are_kept_are_those_worked_out() {
        let mut rng = Rng::new(5);
        let kept = KeptSigns::default();
        let mut told = [0; 3];
        for _ in 0..6 {
            let (table, planes) = planes(&mut rng);
            kept.forget();
            for _ in 0..4_000 {
                let some: [PlaneId; 4] = std::array::from_fn(|_| {
                    let plane = rng.pick(&planes);
                    if rng.chance(0.5) { plane.flipped() } else { plane }
                });
                let [a, b, c, plane] = some;
                let found = Signs::new(&table, &kept).exact_side([a, b, c], plane);
                assert_eq!(found, Signs::of(&table).exact_side([a, b, c], plane), "{some:?}");
                told[found as usize] += 1;
            }
        }
        assert!(told.iter().all(|count| *count > 1_000), "outside, on, inside: {told:?}");
    }

    #[test]
    fn signs_of_as_many_rounds_ago_as_are_counted_are_forgotten() {
        let mut rng = Rng::new(6);
        let kept = KeptSigns::default();
        kept.forget();
        let (first, planes_of_first) = planes(&mut rng);
        let [a, b, c, plane, ..] = planes_of_first[..] else { panic!("nine planes") };
        let sign = Signs::new(&first, &kept).exact_side([a, b, c], plane);
        // the count goes on from just before where it begins again
        kept.round.set(u32::MAX);
        kept.forget();
        kept.forget();
        let of_table = |table: &PlaneTable| Signs::of(table).exact_side([a, b, c], plane);
        let mut others = std::iter::repeat_with(|| planes(&mut rng).0);
        let other = others.find(|table| of_table(table) != sign).expect("there is no end of them");
        assert_eq!(Signs::new(&other, &kept).exact_side([a, b, c], plane), of_table(&other));
    }
}
