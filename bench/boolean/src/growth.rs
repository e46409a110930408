//! How time grows with size: the exponent of a power law, fitted by least squares to the logarithms.

use crate::entrant::Entrant;
use crate::report::Report;

/// An entrant's times over the sizes of a series.
pub(crate) struct Growth {
    pub(crate) series: &'static str,
    pub(crate) entrant: Entrant,
    /// Size and median in seconds.
    pub(crate) points: Vec<[f64; 2]>,
    pub(crate) exponent: f64,
}

/// Of each series and entrant with three sizes or more.
pub(crate) fn growth(report: &Report) -> Vec<Growth> {
    let mut found: Vec<Growth> = Vec::new();
    for line in &report.lines {
        let Some((series, size)) = line.series else { continue };
        for (entrant, record) in &line.records {
            let Some(median) = record.median() else { continue };
            let point = [size as f64, median];
            match found.iter_mut().find(|growth| growth.series == series && growth.entrant == *entrant) {
                Some(growth) => growth.points.push(point),
                None => found.push(Growth { series, entrant: *entrant, points: vec![point], exponent: 0.0 }),
            }
        }
    }
    found.retain(|growth| growth.points.len() >= 3);
    for growth in &mut found {
        growth.exponent = exponent(&growth.points);
    }
    // the entrants of a series side by side
    found.sort_by_key(|growth| report.lines.iter().position(|line| line.series.is_some_and(|s| s.0 == growth.series)));
    found
}

/// The slope of the line through the logarithms.
fn exponent(points: &[[f64; 2]]) -> f64 {
    let logarithms: Vec<[f64; 2]> = points.iter().map(|point| point.map(f64::ln)).collect();
    let mean = |k: usize| logarithms.iter().map(|point| point[k]).sum::<f64>() / logarithms.len() as f64;
    let [x, y] = [mean(0), mean(1)];
    let sum = |f: &dyn Fn(&[f64; 2]) -> f64| logarithms.iter().map(f).sum::<f64>();
    sum(&|p| (p[0] - x) * (p[1] - y)) / sum(&|p| (p[0] - x).powi(2))
}

#[cfg(test)]
mod tests {
    use super::exponent;

    #[test]
    fn a_power_law_is_found() {
        let points = |power: f64| [1e3, 1e4, 3e4, 1e5].map(|size: f64| [size, 2e-6 * size.powf(power)]);
        for power in [0.5, 1.0, 1.37, 2.0] {
            assert!((exponent(&points(power)) - power).abs() < 1e-12);
        }
    }

    #[test]
    fn noise_is_evened_out() {
        // twice too slow and twice too fast at the ends of three decades
        let slope = exponent(&[[1.0, 2.0], [10.0, 10.0], [100.0, 100.0], [1000.0, 500.0]]);
        let by_hand = 1.0 - 2.0 * 1.5 * 2f64.log10() / 5.0;
        assert!((slope - by_hand).abs() < 1e-12, "{slope} instead of {by_hand}");
    }
}
