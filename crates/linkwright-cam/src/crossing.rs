//! Where a profile crosses itself: what lies between is cut away.
//!
//! The profile is looked at as a closed polygon. Seen from the centre a sound one turns one way only; otherwise its
//! sides are sorted into the cells of a grid about as large as they are, and sides that share a cell are compared.

/// Two places of a closed polygon that are one point: side and share along it of each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    pub first: f64,
    pub second: f64,
    pub x: f64,
    pub y: f64,
}

/// Crossings of the sides of a closed polygon, by the first side.
pub fn crossings(x: &[f64], y: &[f64]) -> Vec<Crossing> {
    if x.len() < 4 || turns_one_way(x, y) {
        return Vec::new();
    }
    let n = x.len();
    let grid = Grid::over(x, y);
    let mut cells: Vec<(u64, usize)> = Vec::with_capacity(3 * n);
    for i in 0..n {
        let j = (i + 1) % n;
        cells.extend(grid.cells([x[i], y[i]], [x[j], y[j]]).map(|cell| (cell, i)));
    }
    cells.sort_unstable();
    let mut found = Vec::new();
    for group in cells.chunk_by(|a, b| a.0 == b.0) {
        for (k, &(_, i)) in group.iter().enumerate() {
            for &(_, j) in &group[k + 1..] {
                found.extend(crossing(x, y, i, j));
            }
        }
    }
    found.sort_by(|a, b| a.first.total_cmp(&b.first));
    found.dedup();
    found
}

/// Whether the polygon turns one way about the origin, and once: then it cannot cross itself.
fn turns_one_way(x: &[f64], y: &[f64]) -> bool {
    let n = x.len();
    let (mut left, mut right, mut crossed_axis) = (false, false, 0);
    for i in 0..n {
        let j = (i + 1) % n;
        let side = x[i] * y[j] - x[j] * y[i];
        left |= side > 0.0;
        right |= side < 0.0;
        if (y[i] < 0.0) != (y[j] < 0.0) {
            crossed_axis += 1;
        }
    }
    left != right && crossed_axis == 2
}

/// Square cells over the plane.
struct Grid {
    x: f64,
    y: f64,
    cell: f64,
}

impl Grid {
    /// Cells as large as the sides are on the average.
    fn over(x: &[f64], y: &[f64]) -> Grid {
        let n = x.len();
        let around: f64 = (0..n).map(|i| (x[(i + 1) % n] - x[i]).hypot(y[(i + 1) % n] - y[i])).sum();
        let least = |values: &[f64]| values.iter().copied().fold(f64::INFINITY, f64::min);
        Grid { x: least(x), y: least(y), cell: (around / n as f64).max(f64::MIN_POSITIVE) }
    }

    /// The cells of the box around a side.
    fn cells(&self, a: [f64; 2], b: [f64; 2]) -> impl Iterator<Item = u64> {
        let index = |value: f64, least: f64| ((value - least) / self.cell) as u64;
        let (x0, x1) = (index(a[0].min(b[0]), self.x), index(a[0].max(b[0]), self.x));
        let (y0, y1) = (index(a[1].min(b[1]), self.y), index(a[1].max(b[1]), self.y));
        (x0..=x1).flat_map(move |i| (y0..=y1).map(move |j| (i << 32) | j))
    }
}

/// The crossing of two sides that are not neighbours.
fn crossing(x: &[f64], y: &[f64], i: usize, j: usize) -> Option<Crossing> {
    let n = x.len();
    let (i, j) = (i.min(j), i.max(j));
    if j - i < 2 || j - i == n - 1 {
        return None;
    }
    let side = |k: usize| (x[(k + 1) % n] - x[k], y[(k + 1) % n] - y[k]);
    let ((ax, ay), (bx, by)) = (side(i), side(j));
    let (cx, cy) = (x[j] - x[i], y[j] - y[i]);
    let det = ax * by - ay * bx;
    let (t, u) = ((cx * by - cy * bx) / det, (cx * ay - cy * ax) / det);
    ((0.0..1.0).contains(&t) && (0.0..1.0).contains(&u)).then(|| Crossing {
        first: i as f64 + t,
        second: j as f64 + u,
        x: x[i] + t * ax,
        y: y[i] + t * ay,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn polygon(n: usize, radius: impl Fn(f64) -> f64, turns: f64) -> (Vec<f64>, Vec<f64>) {
        (0..n)
            .map(|i| {
                // Half a step on, so that crossings fall inside sides.
                let t = TAU * (i as f64 + 0.5) / n as f64;
                (radius(t) * (turns * t).cos(), radius(t) * (turns * t).sin())
            })
            .unzip()
    }

    #[test]
    fn a_star_does_not_cross_itself_and_a_limacon_does_once() {
        let (x, y) = polygon(720, |t| 2.0 + (5.0 * t).sin(), 1.0);
        assert!(crossings(&x, &y).is_empty(), "a star");
        // r = 1 + 2 cos t passes the origin at t = ±120°.
        let (x, y) = polygon(721, |t| 1.0 + 2.0 * t.cos(), 1.0);
        let found = crossings(&x, &y);
        assert_eq!(found.len(), 1, "{found:?}");
        let at = |side: f64| (side + 0.5) * TAU / 721.0;
        assert!((at(found[0].first) - TAU / 3.0).abs() < 1e-4, "the chord's error is (2π/721)²");
        assert!((at(found[0].second) - 2.0 * TAU / 3.0).abs() < 1e-4, "{found:?}");
    }

    #[test]
    fn the_same_as_comparing_all_sides() {
        let (x, y) = polygon(301, |t| 1.0 + 0.6 * (7.0 * t).cos(), 2.0);
        let n = x.len();
        let mut all: Vec<_> = (0..n)
            .flat_map(|i| (i + 2..n).map(move |j| (i, j)))
            .filter_map(|(i, j)| crossing(&x, &y, i, j))
            .collect();
        all.sort_by(|a, b| a.first.total_cmp(&b.first));
        assert!(!all.is_empty(), "a curve that winds twice crosses itself");
        assert_eq!(crossings(&x, &y), all);
    }
}
