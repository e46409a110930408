//! Scripts from arbitrary bytes, for fuzzing: any bytes are a script, and small changes of the bytes are small changes
//! of the script.

use crate::exact::Coefficients;
use crate::generators::{dot, plane};
use crate::kernel_calls::is_accepted;
use crate::script::Op;

/// No `Add` while this many planes are there.
pub const CAPACITY: usize = 20;
/// Bytes after this many operations are ignored.
pub const OPERATIONS: usize = 150;

/// Factors of scaled copies; the negative one turns a plane around.
const FACTORS: [f64; 8] = [2.0, 0.5, 3.0, 0.1, 1024.0, -1.0, 1e-3, 7.0];

/// The script that `bytes` stand for.
#[must_use]
pub fn script(bytes: &[u8]) -> Vec<Op> {
    let mut decoder = Decoder { bytes, ops: Vec::new(), live: Vec::new(), names: 0 };
    while decoder.ops.len() < OPERATIONS && decoder.operation().is_some() {}
    decoder.ops
}

struct Decoder<'a> {
    bytes: &'a [u8],
    ops: Vec<Op>,
    /// Name and half-space of the planes that are there, by age.
    live: Vec<(usize, Coefficients)>,
    names: usize,
}

impl Decoder<'_> {
    /// Decodes one operation; `None` at the end of the bytes. What makes no sense is left out.
    fn operation(&mut self) -> Option<()> {
        match self.byte()? % 16 {
            0..=7 => {
                let plane = self.plane()?;
                self.add(plane);
            }
            8..=10 => {
                if let Some(k) = self.pick()? {
                    let name = self.live.remove(k).0;
                    self.ops.push(Op::Remove { name });
                }
            }
            11 => self.remove_many()?,
            12 | 13 => {
                let (k, plane) = (self.pick()?, self.plane()?);
                if let Some((k, plane)) = k.zip(plane.filter(|p| is_accepted(*p))) {
                    self.live[k].1 = plane;
                    self.ops.push(Op::Move { name: self.live[k].0, plane });
                }
            }
            14 => self.ops.push(Op::Clone),
            _ => {
                // rarer than the others: what was built is lost
                if self.byte()? < 64 {
                    self.live.clear();
                    self.ops.push(Op::Clear);
                }
            }
        }
        Some(())
    }

    fn add(&mut self, plane: Option<Coefficients>) {
        if let Some(plane) = plane.filter(|p| is_accepted(*p))
            && self.live.len() < CAPACITY
        {
            self.live.push((self.names, plane));
            self.ops.push(Op::Add { name: self.names, plane });
            self.names += 1;
        }
    }

    /// Two bytes choose which of the first sixteen planes go.
    fn remove_many(&mut self) -> Option<()> {
        let mask = u16::from_le_bytes([self.byte()?, self.byte()?]);
        let gone = |k: usize| k < 16 && mask >> k & 1 == 1;
        let names: Vec<usize> = (0..self.live.len()).filter(|k| gone(*k)).map(|k| self.live[k].0).collect();
        self.live.retain(|(name, _)| !names.contains(name));
        if !names.is_empty() {
            self.ops.push(Op::RemoveMany { names });
        }
        Some(())
    }

    /// A plane of one of eight kinds; the inner `None` where there is no plane to copy.
    fn plane(&mut self) -> Option<Option<Coefficients>> {
        match self.byte()? % 8 {
            0..=2 => {
                let n = self.small_vector(4)?;
                Some(Some(plane(n, self.small(8)?)))
            }
            3 => {
                let (copied, place, steps) = (self.pick()?, self.byte()? as usize % 4, self.signed()?);
                Some(copied.map(|k| nudged(self.live[k].1, place, i64::from(steps))))
            }
            4 => {
                let (copied, factor) = (self.pick()?, FACTORS[self.byte()? as usize % FACTORS.len()]);
                Some(copied.map(|k| self.live[k].1.map(|v| v * factor)))
            }
            5 => {
                let n = [self.decimal()?, self.decimal()?, self.decimal()?];
                Some(Some(plane(n, self.decimal()?)))
            }
            6 => {
                let n = [self.wide()?, self.wide()?, self.wide()?];
                Some(Some(plane(n, self.wide()?)))
            }
            _ => {
                // through a point with small integer coordinates: many planes meet there
                let (n, point) = (self.small_vector(4)?, self.small_vector(2)?);
                Some(Some(plane(n, dot(n, point))))
            }
        }
    }

    fn byte(&mut self) -> Option<u8> {
        let (first, rest) = self.bytes.split_first()?;
        self.bytes = rest;
        Some(*first)
    }

    fn signed(&mut self) -> Option<i8> {
        self.byte().map(|byte| byte as i8)
    }

    /// The place of a plane that is there, if there is one.
    fn pick(&mut self) -> Option<Option<usize>> {
        let byte = self.byte()? as usize;
        Some(byte.checked_rem(self.live.len()))
    }

    /// An integer from `-reach` to `reach`.
    fn small(&mut self, reach: i8) -> Option<f64> {
        self.signed().map(|v| f64::from(v % (reach + 1)))
    }

    fn small_vector(&mut self, reach: i8) -> Option<[f64; 3]> {
        Some([self.small(reach)?, self.small(reach)?, self.small(reach)?])
    }

    fn short(&mut self) -> Option<i16> {
        Some(i16::from_le_bytes([self.byte()?, self.byte()?]))
    }

    /// Three decimals, as in text.
    fn decimal(&mut self) -> Option<f64> {
        self.short().map(|v| f64::from(v) / 1000.0)
    }

    /// Sixteen bits with an exponent of their own.
    fn wide(&mut self) -> Option<f64> {
        let (mantissa, exponent) = (self.short()?, self.signed()?);
        Some(f64::from(mantissa) * 2f64.powi(i32::from(exponent) / 3))
    }
}

/// One coefficient moved by `steps` units in the last place; zero stays zero.
fn nudged(mut plane: Coefficients, place: usize, steps: i64) -> Coefficients {
    if plane[place] != 0.0 {
        plane[place] = f64::from_bits(plane[place].to_bits().wrapping_add_signed(steps));
    }
    plane
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Rng;

    /// Random bytes give all kinds of operations, and only planes that the kernel accepts.
    #[test]
    fn bytes_become_scripts() {
        let mut rng = Rng::new(1);
        let mut seen = [0; 6];
        for _ in 0..200 {
            let bytes: Vec<u8> = (0..400).map(|_| rng.bits() as u8).collect();
            for op in script(&bytes) {
                seen[match op {
                    Op::Add { plane, .. } => {
                        assert!(is_accepted(plane));
                        0
                    }
                    Op::Remove { .. } => 1,
                    Op::RemoveMany { .. } => 2,
                    Op::Move { plane, .. } => {
                        assert!(is_accepted(plane));
                        3
                    }
                    Op::Clone => 4,
                    Op::Clear => 5,
                }] += 1;
            }
        }
        assert!(seen.iter().all(|n| *n > 50), "{seen:?}");
        assert_eq!(script(&[]), []);
    }
}
