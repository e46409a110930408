//! The few colours of a GIF, and how pictures are drawn with them.
//!
//! Colours between two of the palette become a pattern of both that is fixed on the picture (ordered dithering): what does
//! not move keeps its pixels from frame to frame, where diffusing the error would make it shimmer.
//!
//! Own code instead of a crate for colour quantisation: one palette serves all frames of a file and grows with samples, the same frames give the
//! same bytes on every machine, and colours are matched to pairs of colours, for the patterns, not to single ones.

use rustc_hash::FxHashMap;

use crate::picture::Picture;

/// Most colours of a palette. One of the 256 indices is for transparent pixels.
const COLORS: usize = 255;
/// Bits of each channel that tell colours apart in the histogram.
const BITS: u32 = 6;
/// How much red, green and blue count when colours are compared.
const WEIGHTS: [f32; 3] = [2.0, 4.0, 1.5];
/// How much the coarseness of a pattern counts against it, beside its error.
const GRAIN: f32 = 0.12;
/// Rounds of moving the colours to the middle of what they stand for.
const ROUNDS: usize = 4;
/// A pixel is off if its pattern is farther from its colour than this number of steps of all channels.
const TOLERANCE: f32 = 14.0;
/// A palette suits a picture if at most one pixel in this number is off.
const OFF_SHARE: usize = 400;
/// Colours whose pattern is remembered at once.
const REMEMBERED: usize = 1 << 20;
/// Alpha from which on a pixel is not transparent.
const OPAQUE_FROM: u8 = 128;

/// In which order the pixels of a square of 8 × 8 go over to the second colour.
const ORDER: [[u8; 8]; 8] = order();

const fn order() -> [[u8; 8]; 8] {
    let mut order = [[0; 8]; 8];
    let mut i = 0;
    while i < 64 {
        let (x, y) = (i % 8, i / 8);
        // Bayer's order: the bits of x xor y and of y in turn, the lowest counting most.
        let mut bit = 0;
        while bit < 3 {
            let both = ((x ^ y) >> bit & 1) << 1 | (y >> bit & 1);
            order[y][x] |= (both << (2 * (2 - bit))) as u8;
            bit += 1;
        }
        i += 1;
    }
    order
}

/// How many pixels have which colour, about.
pub(super) struct Histogram {
    /// For each cell of the colour cube the number of pixels and the sums of their channels.
    cells: Vec<[u64; 4]>,
}

impl Default for Histogram {
    fn default() -> Self {
        Self { cells: vec![[0; 4]; 1 << (3 * BITS)] }
    }
}

/// A colour and how much it counts.
#[derive(Clone, Copy)]
struct Sample {
    color: [f32; 3],
    count: f64,
}

impl Histogram {
    /// Counts the pixels of a picture that are not transparent.
    pub(super) fn add(&mut self, picture: &Picture) {
        for &[r, g, b, a] in picture.pixels.as_chunks::<4>().0 {
            if a < OPAQUE_FROM {
                continue;
            }
            let index = [r, g, b].iter().fold(0, |index, &value| index << BITS | usize::from(value >> (8 - BITS)));
            let cell = &mut self.cells[index];
            for (sum, value) in cell.iter_mut().zip([1, r, g, b]) {
                *sum += u64::from(value);
            }
        }
    }

    /// The palette that suits all pixels counted.
    pub(super) fn palette(&self) -> Palette {
        let mut samples: Vec<Sample> = self
            .cells
            .iter()
            .filter(|cell| cell[0] > 0)
            .map(|&[count, r, g, b]| Sample {
                color: [r, g, b].map(|sum| (sum as f64 / count as f64) as f32),
                count: count as f64,
            })
            .collect();
        let mut colors = cut(&mut samples);
        for _ in 0..ROUNDS {
            settle(&mut colors, &samples);
        }
        if colors.is_empty() {
            // Nothing but transparent pixels.
            colors.push([0.0; 3]);
        }
        Palette::new(&colors)
    }
}

/// Some samples, and what they have in common.
struct Group {
    first: usize,
    end: usize,
    mean: [f32; 3],
    /// The channel in which the samples differ most.
    axis: usize,
    /// How much there is to be gained by dividing them.
    spread: f64,
}

impl Group {
    fn new(samples: &[Sample], first: usize, end: usize) -> Self {
        let samples = &samples[first..end];
        let total: f64 = samples.iter().map(|sample| sample.count).sum();
        let mean = |i: usize| samples.iter().map(|s| s.count * f64::from(s.color[i])).sum::<f64>() / total;
        let mean = [mean(0), mean(1), mean(2)];
        let spread = |i: usize| {
            let square = |s: &Sample| s.count * (f64::from(s.color[i]) - mean[i]).powi(2);
            f64::from(WEIGHTS[i]) * samples.iter().map(square).sum::<f64>()
        };
        let spreads = [spread(0), spread(1), spread(2)];
        let axis = (1..3).fold(0, |best, i| if spreads[i] > spreads[best] { i } else { best });
        // Not the plain sum: a large even ground would take colours from small parts.
        let spread = if samples.len() > 1 { spreads.iter().sum::<f64>() / total.sqrt() } else { 0.0 };
        Self { first, end, mean: mean.map(|value| value as f32), axis, spread }
    }
}

/// Divides the samples into as many groups as there may be colours, and gives the means.
fn cut(samples: &mut [Sample]) -> Vec<[f32; 3]> {
    if samples.is_empty() {
        return Vec::new();
    }
    let mut groups = vec![Group::new(samples, 0, samples.len())];
    while groups.len() < COLORS {
        let widest = (1..groups.len()).fold(0, |best, i| if groups[i].spread > groups[best].spread { i } else { best });
        let Group { first, end, mean, axis, spread } = groups[widest];
        let part = &mut samples[first..end];
        part.sort_by(|a, b| a.color[axis].total_cmp(&b.color[axis]));
        let middle = first + part.partition_point(|sample| sample.color[axis] <= mean[axis]);
        if spread <= 0.0 || middle == first || middle == end {
            break;
        }
        groups[widest] = Group::new(samples, first, middle);
        groups.push(Group::new(samples, middle, end));
    }
    groups.iter().map(|group| group.mean).collect()
}

/// Moves each colour to the mean of the samples that it is nearest to.
fn settle(colors: &mut [[f32; 3]], samples: &[Sample]) {
    let mut sums = vec![[0.0; 4]; colors.len()];
    for sample in samples {
        let sum = &mut sums[nearest(colors, sample.color).0];
        // As in the division, what is seen on a large area counts less for each pixel.
        let weight = sample.count.sqrt();
        sum[0] += weight;
        for i in 0..3 {
            sum[i + 1] += weight * f64::from(sample.color[i]);
        }
    }
    for (color, [weight, r, g, b]) in colors.iter_mut().zip(sums) {
        if weight > 0.0 {
            *color = [r, g, b].map(|sum| (sum / weight) as f32);
        }
    }
}

/// The nearest of some colours and the square of its distance.
fn nearest(colors: &[[f32; 3]], color: [f32; 3]) -> (usize, f32) {
    let distances = colors.iter().map(|&other| square(difference(other, color)));
    distances.enumerate().fold((0, f32::INFINITY), |best, (i, d)| if d < best.1 { (i, d) } else { best })
}

fn difference(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Scalar product in which the channels count as they should.
fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    WEIGHTS[0] * a[0] * b[0] + WEIGHTS[1] * a[1] * b[1] + WEIGHTS[2] * a[2] * b[2]
}

fn square(a: [f32; 3]) -> f32 {
    dot(a, a)
}

/// The colours of a GIF.
pub(super) struct Palette {
    /// Red, green and blue of each, and of the index of transparent pixels.
    bytes: Vec<u8>,
    colors: Vec<[f32; 3]>,
    patterns: FxHashMap<[u8; 3], Pattern>,
}

/// How a colour is drawn.
#[derive(Clone, Copy)]
struct Pattern {
    colors: [u8; 2],
    /// Pixels of 64 that get the second colour.
    share: u8,
    is_off: bool,
}

/// A picture in the colours of a palette.
pub(super) struct Matched {
    pub(super) indices: Vec<u8>,
    /// Whether it looks as it should.
    pub(super) suits: bool,
}

impl Palette {
    fn new(colors: &[[f32; 3]]) -> Self {
        let mut rounded: Vec<[u8; 3]> = colors.iter().map(|color| color.map(|value| value.round() as u8)).collect();
        // In the order of brightness, neighbours in a gradient get similar indices.
        rounded.sort_by_key(|&[r, g, b]| (2 * u32::from(r) + 4 * u32::from(g) + u32::from(b), r, g, b));
        rounded.dedup();
        let colors = rounded.iter().map(|color| color.map(f32::from)).collect();
        // Transparent pixels need an index that the file has a colour for.
        rounded.push([0; 3]);
        Self { bytes: rounded.into_flattened(), colors, patterns: FxHashMap::default() }
    }

    /// Red, green and blue of each colour, and of the index of transparent pixels.
    pub(super) fn colors(&self) -> &[u8] {
        &self.bytes
    }

    /// The index of transparent pixels.
    pub(super) fn clear(&self) -> u8 {
        self.colors.len() as u8
    }

    /// Draws a picture in these colours.
    pub(super) fn matched(&mut self, picture: &Picture) -> Matched {
        let clear = self.clear();
        let mut indices = Vec::with_capacity(picture.pixels.len() / 4);
        let mut off = 0;
        for (row, order) in picture.pixels.chunks_exact(4 * picture.width as usize).zip(ORDER.iter().cycle()) {
            for (&[r, g, b, a], &place) in row.as_chunks::<4>().0.iter().zip(order.iter().cycle()) {
                if a < OPAQUE_FROM {
                    indices.push(clear);
                    continue;
                }
                let pattern = self.pattern([r, g, b]);
                off += usize::from(pattern.is_off);
                indices.push(pattern.colors[usize::from(place < pattern.share)]);
            }
        }
        let suits = off * OFF_SHARE <= indices.len();
        Matched { indices, suits }
    }

    fn pattern(&mut self, color: [u8; 3]) -> Pattern {
        if let Some(&pattern) = self.patterns.get(&color) {
            return pattern;
        }
        if self.patterns.len() >= REMEMBERED {
            self.patterns.clear();
        }
        let pattern = self.find_pattern(color.map(f32::from));
        self.patterns.insert(color, pattern);
        pattern
    }

    /// The nearest colour with whichever other one makes the best mix.
    fn find_pattern(&self, color: [f32; 3]) -> Pattern {
        let (first, error) = nearest(&self.colors, color);
        let wanted = difference(color, self.colors[first]);
        // Cost, error, the other colour, and how much of it.
        let mut best = (error, error, first, 0.0);
        for (second, &other) in self.colors.iter().enumerate() {
            let way = difference(other, self.colors[first]);
            let length = square(way);
            let part = dot(wanted, way) / length;
            // Also where both are the same.
            if part.is_nan() || part <= 0.0 {
                continue;
            }
            let part = part.min(0.5);
            let error = square(difference(wanted, way.map(|value| value * part)));
            let cost = error + GRAIN * part * (1.0 - part) * length;
            if cost < best.0 {
                best = (cost, error, second, part);
            }
        }
        let (_, error, second, part) = best;
        let weights: f32 = WEIGHTS.iter().sum();
        let is_off = error > TOLERANCE * TOLERANCE * weights;
        // Always from the darker to the brighter, so that patterns of neighbours in a gradient fit together.
        let (colors, part) = if first <= second { ([first, second], part) } else { ([second, first], 1.0 - part) };
        Pattern { colors: colors.map(|index| index as u8), share: (part * 64.0).round() as u8, is_off }
    }
}
