//! Identities of set algebra on solids: equal sets have an empty difference both ways.

use planecut_cells::Solid;
use planecut_csg::Model;

use planecut_testkit::random::Rng;
use planecut_testkit::scene::{Scene, ensure, sweep};
use planecut_testkit::shape::{Kind, Shape, bounded, ensure_close, ensure_sound, random_shape};

#[derive(Debug, Clone)]
struct Three([Shape; 3]);

impl Scene for Three {
    fn model(&self) -> Model {
        self.0[0].model()
    }

    fn smaller(&self) -> Vec<Self> {
        let replaced = |k: usize, smaller: Shape| {
            let mut all = self.0.clone();
            all[k] = smaller;
            Self(all)
        };
        (0..3).flat_map(|k| self.0[k].smaller().into_iter().map(move |s| replaced(k, s))).collect()
    }

    fn as_rust(&self) -> String {
        self.0.iter().map(|shape| shape.as_rust() + "\n").collect()
    }
}

fn ensure_same(what: &str, left: &Solid, right: &Solid) -> Result<(), String> {
    ensure_sound(left)?;
    ensure!((left - right).is_empty(), "{what}: the left exceeds the right");
    ensure!((right - left).is_empty(), "{what}: the right exceeds the left");
    Ok(())
}

/// The identities, `volume` telling volumes where they are finite.
#[allow(clippy::eq_op, reason = "that is what is tested")]
fn judge([a, b, c]: &[Solid; 3]) -> Result<(), String> {
    ensure_same("A ∪ A = A", &(a | a), a)?;
    ensure_same("A ∩ A = A", &(a & a), a)?;
    ensure!((a - a).is_empty(), "A − A is not empty");
    ensure!((a ^ a).is_empty(), "A ^ A is not empty");
    ensure_same("A − B − B = A − B", &(&(a - b) - b), &(a - b))?;
    ensure_same("¬¬A = A", &!&!a, a)?;
    ensure!((a & &!a).is_empty(), "A ∩ ¬A is not empty");
    ensure_same("¬(A ∪ B) = ¬A ∩ ¬B", &!&(a | b), &(&!a & &!b))?;
    ensure_same("A ∩ ¬B = A − B", &(a & &!b), &(a - b))?;
    ensure_same("A − (B ∪ C) = (A − B) ∩ (A − C)", &(a - &(b | c)), &(&(a - b) & &(a - c)))?;
    ensure_same("A ∩ (B ∪ C) = (A ∩ B) ∪ (A ∩ C)", &(a & &(b | c)), &(&(a & b) | &(a & c)))?;
    ensure_same("A ^ B = (A − B) ∪ (B − A)", &(a ^ b), &(&(a - b) | &(b - a)))?;
    ensure_same("(A ^ B) ^ B = A", &(&(a ^ b) ^ b), a)?;
    ensure_same("A ∪ (A ∩ B) = A", &(a | &(a & b)), a)?;
    ensure_same("A ∩ (A ∪ B) = A", &(a & &(a | b)), a)?;
    let volume = |solid: &Solid| solid.volume().ok_or("unbounded");
    let both = volume(&(a | b))? + volume(&(a & b))?;
    ensure_close("|A ∪ B| + |A ∩ B| = |A| + |B|", both, volume(a)? + volume(b)?, 1e-3)?;
    let pairs = volume(&(a & b))? + volume(&(a & c))? + volume(&(b & c))?;
    let three = volume(a)? + volume(b)? + volume(c)? - pairs + volume(&(&(a & b) & c))?;
    ensure_close("inclusion and exclusion of three", volume(&(&(a | b) | c))?, three, 10.0)
}

#[test]
fn identities_hold() {
    for (kind, count) in [(Kind::Boxes, 25), (Kind::Sloped, 20), (Kind::Turned, 10), (Kind::Mixed, 12)] {
        let generate = |rng: &mut Rng| {
            Three([0; 3].map(|_| {
                let leaves = 1 + rng.below(3);
                bounded(random_shape(rng, kind, leaves))
            }))
        };
        sweep(count, generate, |scene| judge(&[0, 1, 2].map(|k| Solid::from_tree(&scene.0[k].tree()))));
    }
}
