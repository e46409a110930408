//! Corners that are nearly one become one.

use planecut_kernel::DVec3;

use super::corners::Corners;
use super::near::Near;

/// Corners of a cell in groups, each around one that stands for it.
pub(super) struct Clusters {
    /// The corner that stands for each group.
    pub(super) first: Vec<usize>,
    /// The group of each corner.
    pub(super) group_of: Vec<usize>,
}

impl Clusters {
    /// Groups whose corners are within `separation` of the one that stands for them, and these farther from each other.
    pub(super) fn of(corners: &Corners, separation: f64) -> Self {
        let mut clusters = Self { first: Vec::new(), group_of: Vec::with_capacity(corners.corners.len()) };
        let mut near = Near::new(separation);
        for (number, corner) in corners.corners.iter().enumerate() {
            let place = |group: usize| corners.corners[clusters.first[group]].place;
            let is_near = |group: &usize| place(*group).distance(corner.place) <= separation;
            let group = near.around(corner.place).filter(is_near).min().unwrap_or_else(|| {
                clusters.first.push(number);
                clusters.first.len() - 1
            });
            if clusters.first[group] == number {
                near.insert(group, corner.place);
            }
            clusters.group_of.push(group);
        }
        clusters
    }

    /// Where the corners are that stand for groups.
    pub(super) fn places(&self, corners: &Corners) -> Vec<DVec3> {
        self.first.iter().map(|corner| corners.corners[*corner].place).collect()
    }

    /// The numbers of the faces at the corners of each group, each once.
    pub(super) fn faces(&self, corners: &Corners) -> Vec<Vec<usize>> {
        let mut faces = vec![Vec::new(); self.first.len()];
        for (corner, group) in corners.corners.iter().zip(&self.group_of) {
            faces[*group].extend(corner.faces);
        }
        for around in &mut faces {
            around.sort_unstable();
            around.dedup();
        }
        faces
    }

    /// How far the farthest corner is from the place that its group has.
    pub(super) fn largest_move(&self, corners: &Corners, places: &[DVec3]) -> f64 {
        let moves =
            corners.corners.iter().zip(&self.group_of).map(|(corner, group)| corner.place.distance(places[*group]));
        moves.fold(0.0, f64::max)
    }
}

/// As many of the places as there are farther from each other than `separation`, the first ones.
pub(super) fn distinct(places: &[DVec3], separation: f64) -> Vec<DVec3> {
    let mut kept: Vec<DVec3> = Vec::with_capacity(places.len());
    let mut near = Near::new(separation);
    for place in places {
        if !near.around(*place).any(|other| kept[other].distance(*place) <= separation) {
            near.insert(kept.len(), *place);
            kept.push(*place);
        }
    }
    kept
}
