//! A small seeded random number generator, so that a printed seed repeats a test on every machine.

use glam::{DQuat, DVec3};

/// `splitmix64` (Steele, Lea, Flood 2014).
#[derive(Debug, Clone)]
pub struct Rng(u64);

impl Rng {
    /// A generator whose whole stream is a function of `seed`.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// A generator for seeds that follow one another: their bits are spread first.
    #[must_use]
    pub fn spread(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 0x5851_F42D_4C95_7F2D)
    }

    /// 64 uniform bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// A uniform index in `0..n`; `n` must not be zero.
    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    /// A uniform integer in `low..=high`.
    pub fn integer(&mut self, low: i64, high: i64) -> i64 {
        low + (self.bits() % (high - low + 1) as u64) as i64
    }

    /// [`Rng::integer`] as a float; exact while the bounds are below 2⁵³.
    pub fn whole(&mut self, low: i64, high: i64) -> f64 {
        self.integer(low, high) as f64
    }

    /// A uniform float in `low..high`.
    pub fn float(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.bits() >> 11) as f64 / (1u64 << 53) as f64)
    }

    /// True with probability `p`.
    pub fn chance(&mut self, p: f64) -> bool {
        self.float(0.0, 1.0) < p
    }

    /// One of the items.
    pub fn pick<T: Copy>(&mut self, items: &[T]) -> T {
        items[self.below(items.len())]
    }

    /// A direction, uniform on the sphere, of unit length up to rounding.
    pub fn direction(&mut self) -> [f64; 3] {
        loop {
            let v: [f64; 3] = std::array::from_fn(|_| self.float(-1.0, 1.0));
            let squared = v.iter().map(|x| x * x).sum::<f64>();
            if (1e-4..=1.0).contains(&squared) {
                return v.map(|x| x / squared.sqrt());
            }
        }
    }

    /// A direction as a vector of unit length.
    pub fn unit(&mut self) -> DVec3 {
        loop {
            let p = self.point(-1.0, 1.0);
            if (0.01..1.0).contains(&p.length_squared()) {
                return p.normalize();
            }
        }
    }

    /// A point of the cube `low..high`, component by component.
    pub fn point(&mut self, low: f64, high: f64) -> DVec3 {
        DVec3::new(self.float(low, high), self.float(low, high), self.float(low, high))
    }

    /// A rotation by a uniform angle about a uniform axis.
    pub fn rotation(&mut self) -> DQuat {
        DQuat::from_axis_angle(self.unit(), self.float(0.0, std::f64::consts::TAU))
    }

    /// A non-zero vector of integers in `-reach..=reach`.
    pub fn lattice(&mut self, reach: i64) -> [f64; 3] {
        loop {
            let v: [f64; 3] = std::array::from_fn(|_| self.whole(-reach, reach));
            if v != [0.0; 3] {
                return v;
            }
        }
    }

    /// `value` moved by up to `reach` units in the last place; zero stays zero.
    pub fn nudge(&mut self, value: f64, reach: i64) -> f64 {
        if value == 0.0 {
            return value;
        }
        f64::from_bits(value.to_bits().wrapping_add_signed(self.integer(-reach, reach)))
    }

    /// Fisher–Yates.
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for i in (1..items.len()).rev() {
            items.swap(i, self.below(i + 1));
        }
    }
}
