//! A polytope as data: its planes with their handles and stamps, of which the structure is a function.

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{IncrementalPolytope, PlaneIdx, external, infinity};
use crate::half_space::HalfSpace;

/// What is written of a polytope.
#[derive(Serialize, Deserialize)]
#[serde(rename = "IncrementalPolytope", deny_unknown_fields)]
struct Saved {
    epsilon: f64,
    /// By handle.
    planes: Vec<SavedPlane>,
    /// The handles that are free, the next one to be given last.
    free: Vec<PlaneIdx>,
    next_stamp: u64,
}

#[derive(Serialize, Deserialize)]
#[serde(rename = "Plane", deny_unknown_fields)]
struct SavedPlane {
    plane: PlaneIdx,
    stamp: u64,
    half_space: HalfSpace,
}

impl Saved {
    fn of(polytope: &IncrementalPolytope) -> Self {
        let planes = polytope.planes.slots().map(|slot| SavedPlane {
            plane: external(slot),
            stamp: polytope.planes.stamp(slot),
            half_space: *polytope.planes.half_space(slot),
        });
        Self {
            epsilon: polytope.epsilon,
            planes: planes.collect(),
            free: polytope.planes.free_slots().iter().map(|slot| external(*slot)).collect(),
            next_stamp: polytope.planes.next_stamp(),
        }
    }

    /// The planes by handle, `None` for those that are free.
    fn by_handle(&self) -> Result<Vec<Option<(HalfSpace, u64)>>, String> {
        let count = self.planes.len() + self.free.len();
        let mut places = vec![None; count];
        let taken = self.planes.iter().map(|plane| (plane.plane, Some((plane.half_space, plane.stamp))));
        for (PlaneIdx(handle), plane) in taken.chain(self.free.iter().map(|handle| (*handle, None))) {
            match places.get_mut(handle) {
                Some(place @ None) => *place = Some(plane),
                _ => return Err(format!("found handle {handle}, expected each below {count} once")),
            }
        }
        Ok(places.into_iter().flatten().collect())
    }

    /// Stamps are given once, the first ones to the infinity planes.
    fn check_stamps(&self) -> Result<(), String> {
        let mut stamps: Vec<u64> = self.planes.iter().map(|plane| plane.stamp).collect();
        stamps.sort_unstable();
        if let Some(pair) = stamps.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(format!("found stamp {} twice, expected a different one for each plane", pair[0]));
        }
        let (first, last) = (u64::from(infinity::COUNT), self.next_stamp);
        let stray = stamps.first().filter(|stamp| **stamp < first).or(stamps.last().filter(|stamp| **stamp >= last));
        match stray {
            Some(stamp) => Err(format!("found stamp {stamp}, expected one from {first} and below {last}")),
            None if last < first => Err(format!("found {last} as the next stamp, expected {first} or more")),
            None => Ok(()),
        }
    }

    fn restore(self) -> Result<IncrementalPolytope, String> {
        if self.epsilon.is_nan() {
            return Err("found an epsilon that is not a number, expected a length".to_owned());
        }
        self.check_stamps()?;
        let planes = self.by_handle()?;
        let slot = |PlaneIdx(handle): PlaneIdx| u32::try_from(handle).ok()?.checked_add(infinity::COUNT);
        let free: Option<Vec<u32>> = self.free.into_iter().map(slot).collect();
        let mut polytope = IncrementalPolytope::with_epsilon(self.epsilon);
        polytope.planes.restore(&planes, free.ok_or("found more planes than handles")?, self.next_stamp);
        polytope.rebuild();
        Ok(polytope)
    }
}

/// Written are the planes with their handles and stamps, the free handles and the epsilon: of these the structure is a function.
/// Vertices and edges get other handles when it is read.
impl Serialize for IncrementalPolytope {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Saved::of(self).serialize(serializer)
    }
}

/// Half-spaces are checked as by [`HalfSpace::new`], handles and stamps must be different ones, and the structure is built again.
impl<'de> Deserialize<'de> for IncrementalPolytope {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Saved::deserialize(deserializer)?.restore().map_err(D::Error::custom)
    }
}
