//! Functions of the angles of masses, looked up side by side in lanes.
//!
//! Where in its table each mass is follows in lanes. The powers of the piece there are then taken into the lane of the mass, register
//! by register: through memory a bundle would wait for the last of its numbers.

use super::periodic::{IN_LOW_BITS, Periodic, in_low_bits};
use linkwright_kernel::real::Real;

/// Numbers in the widest register.
pub const WIDEST: usize = 8;

/// Powers of a piece, filled up to a line of the cache.
type Piece = [f64; WIDEST];

/// At most one function for each mass.
#[derive(Clone, Debug)]
pub struct Bank {
    /// Place of each mass's function in the list that the banks were made of.
    pub places: Vec<Option<usize>>,
    blocks: Vec<Block>,
    /// Pieces of all tables, one table after the other.
    pieces: Vec<Piece>,
}

/// Functions of as many masses as the widest register has numbers; zeros where there is none.
#[derive(Clone, Debug, Default)]
struct Block {
    /// Whether there is any.
    busy: bool,
    /// Pieces of the table per angle of the mass, and place at angle zero, from the middle of the first piece.
    rate: [f64; WIDEST],
    start: [f64; WIDEST],
    /// Pieces of the table, one over them, and the place of the first in the list of all, in the low bits.
    count: [f64; WIDEST],
    inverse_count: [f64; WIDEST],
    first: [f64; WIDEST],
    /// What the values of the table count.
    scale: [f64; WIDEST],
}

/// A function of the angle of a mass: scale · table(pitch · angle + phase).
#[derive(Clone, Copy, Debug)]
pub struct OfAngle {
    pub mass: usize,
    pub table: usize,
    pub scale: f64,
    pub pitch: f64,
    pub phase: f64,
}

impl Bank {
    /// Functions of so many masses, with their places in a list, in as few banks as hold them.
    pub fn several(
        functions: impl Iterator<Item = (usize, OfAngle)>,
        masses: usize,
        tables: &[Periodic],
    ) -> Vec<Bank> {
        let mut banks: Vec<Bank> = Vec::new();
        for (place, function) in functions {
            let free = banks.iter().position(|bank| bank.places[function.mass].is_none());
            let free = free.unwrap_or_else(|| {
                banks.push(Bank::empty(masses));
                banks.len() - 1
            });
            banks[free].take(place, &function, tables);
        }
        banks
    }

    fn empty(masses: usize) -> Self {
        let blocks = vec![Block::default(); masses.div_ceil(WIDEST)];
        Bank { places: vec![None; masses], blocks, pieces: vec![[0.0; WIDEST]] }
    }

    fn take(&mut self, place: usize, function: &OfAngle, tables: &[Periodic]) {
        let OfAngle { mass, table, scale, pitch, phase } = *function;
        let (pieces, density) = (tables[table].pieces(), tables[table].density());
        self.places[mass] = Some(place);
        let (block, lane, count) = (&mut self.blocks[mass / WIDEST], mass % WIDEST, pieces.len() as f64);
        block.busy = true;
        (block.rate[lane], block.start[lane], block.scale[lane]) =
            (pitch * density, phase * density - 0.5, scale);
        (block.count[lane], block.inverse_count[lane]) = (count, 1.0 / count);
        block.first[lane] = self.pieces.len() as f64 + IN_LOW_BITS;
        self.pieces.extend(pieces.iter().map(|&[a, b, c, d, e, f]| [a, b, c, d, e, f, 0.0, 0.0]));
    }

    /// Values and slopes at the angles of some masses, the first of which has a place; `None` if none has a function.
    #[inline(always)]
    pub fn at<R: Real>(&self, at: usize, theta: R) -> Option<[R; 2]> {
        let (block, lane) = (&self.blocks[at / WIDEST], at % WIDEST);
        if !block.busy {
            return None;
        }
        let rate = R::load(&block.rate[lane..]);
        let middle = rate.mul_add(theta, R::load(&block.start[lane..]));
        let whole = nearest(middle);
        let [a, b, c, d, e, f] = self.powers(block.index(lane, whole));
        let (z, scale) = ((middle - whole) + 0.5, R::load(&block.scale[lane..]));
        // Sums of pairs do not wait for each other.
        let square = z * z;
        let value = square.mul_add(square.mul_add(z.mul_add(f, e), z.mul_add(d, c)), z.mul_add(b, a));
        let steep = square.mul_add(f * 5.0, z.mul_add(e * 4.0, d * 3.0));
        let slope = square.mul_add(steep, z.mul_add(c * 2.0, b));
        Some([value * scale, slope * (rate * scale)])
    }

    /// Powers of the pieces of a list, each in a lane of its own.
    #[inline(always)]
    fn powers<R: Real>(&self, places: R) -> [R; 6] {
        const LANES: [f64; WIDEST] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];
        let (mut numbers, lanes) = ([0.0; WIDEST], R::load(&LANES));
        places.store(&mut numbers);
        let mut found = [R::splat(0.0); 6];
        for lane in 0..R::LANES {
            let piece = &self.pieces[in_low_bits(numbers[lane]).min(self.pieces.len() - 1)];
            let here = R::splat(lane as f64);
            for (found, &power) in found.iter_mut().zip(piece) {
                *found = lanes.select_lt(here, *found, R::splat(power));
            }
        }
        found
    }
}

impl Block {
    /// Places of pieces, counted on over all periods, in the list of all, in the low bits.
    #[inline(always)]
    fn index<R: Real>(&self, lane: usize, whole: R) -> R {
        let (count, inverse) = (R::load(&self.count[lane..]), R::load(&self.inverse_count[lane..]));
        // The middle of the piece is in no period but its own, whatever rounding does.
        let periods = nearest(inverse.mul_add(whole, (inverse - R::splat(1.0)) * 0.5));
        (-periods).mul_add(count, whole) + R::load(&self.first[lane..])
    }
}

/// Nearest whole numbers.
#[inline(always)]
fn nearest<R: Real>(x: R) -> R {
    // No fractions are left in a sum with 1.5 · 2⁵².
    const ROUND: f64 = 6_755_399_441_055_744.0;
    (x + ROUND) - ROUND
}

#[cfg(test)]
mod tests {
    use super::*;
    use linkwright_kernel::lanes::{Job, in_single_lanes};
    use std::f64::consts::TAU;

    struct At<'a>(&'a Bank, &'a [f64]);
    impl Job for At<'_> {
        type Output = [Vec<f64>; 2];
        #[inline(always)]
        fn run<R: Real>(self) -> Self::Output {
            let mut found = [vec![0.0; self.1.len()], vec![0.0; self.1.len()]];
            for at in (0..self.1.len()).step_by(R::LANES) {
                if let Some([value, slope]) = self.0.at(at, R::load(&self.1[at..])) {
                    value.store(&mut found[0][at..]);
                    slope.store(&mut found[1][at..]);
                }
            }
            found
        }
    }

    /// A wave of a period through even knots.
    fn wave(period: f64, knots: usize) -> Periodic {
        let list = |f: fn(f64) -> f64, size: f64| -> Vec<f64> {
            (0..knots).map(|i| size * f(TAU * i as f64 / knots as f64)).collect()
        };
        let omega = TAU / period;
        let [value, slope] = [list(f64::sin, 1.0), list(f64::cos, omega)];
        Periodic::new(period, &value, &slope, &list(|x| -x.sin(), omega * omega)).expect("even knots")
    }

    /// Tables of several periods and numbers of knots, on masses of two registers, two of them on one mass: values and slopes are
    /// those of the tables, many revolutions on as well, and nothing where there is no function.
    #[test]
    fn look_ups_in_lanes_are_those_of_the_tables() {
        let tables = [wave(TAU, 512), wave(2.0 * TAU, 37)];
        let function = |mass, table, pitch, phase| OfAngle { mass, table, scale: 3.0, pitch, phase };
        let functions = [
            function(1, 0, 1.0, 0.3),
            function(9, 1, -2.5, 0.0),
            function(2, 1, 1.0, -7.0),
            function(1, 1, 0.5, 1.0),
        ];
        let banks = Bank::several(functions.into_iter().enumerate(), 16, &tables);
        assert_eq!(banks.len(), 2, "two functions of one mass");
        let mut found = 0;
        for turn in [0.0, 0.01, -3.0, 1234.5] {
            let theta: Vec<f64> = (0..16).map(|i| turn + 0.37 * f64::from(i)).collect();
            for bank in &banks {
                let [values, slopes] = in_single_lanes(At(bank, &theta));
                for (mass, place) in bank.places.iter().enumerate() {
                    let Some(place) = *place else {
                        assert_eq!([values[mass], slopes[mass]], [0.0; 2], "no function");
                        continue;
                    };
                    let OfAngle { table, scale, pitch, phase, .. } = functions[place];
                    let [value, slope] = tables[table].value_and_slope(pitch * theta[mass] + phase);
                    // Rounding of a place of some hundred thousand pieces, times the slope of a piece.
                    assert!((values[mass] - scale * value).abs() < 1e-11, "value of {place} at {turn}");
                    assert!(
                        (slopes[mass] - scale * pitch * slope).abs() < 1e-11,
                        "slope of {place} at {turn}"
                    );
                    found += 1;
                }
            }
        }
        assert_eq!(found, 16, "four functions at four angles");
    }
}
