//! A train in motion as it crosses the border: masses, links between them, inertias that change with the angle, torques.

use super::curve::Curve;
use super::periodic::Periodic;
use super::torque::{Law, Shape, Torque};
use crate::kernel::error::PlanError;

/// What twists between two masses, as seen at a part that turns `ratio` times as fast as they do.
#[derive(Clone, Copy, Debug)]
pub struct Link {
    /// Masses, the number of masses for the ground.
    pub ends: [usize; 2],
    pub ratio: f64,
    /// \[N m/rad\]
    pub stiffness: f64,
    /// \[N m s/rad\]
    pub damping: f64,
    /// Torque over twist, added to that of the stiffness.
    pub curve: Option<usize>,
}

/// An inertia that changes with the angle of its part.
#[derive(Clone, Copy, Debug)]
pub struct Rotor {
    pub mass: usize,
    /// Speed of the part over that of the mass.
    pub ratio: f64,
    pub phase: f64,
    pub table: usize,
}

/// Masses, links and torques.
#[derive(Clone, Debug)]
pub struct System {
    /// Constant part \[kg m²\].
    pub inertia: Vec<f64>,
    /// Against the ground \[N m s/rad\].
    pub damping: Vec<f64>,
    /// Against the train as a whole: it resists swinging, not turning \[N m s/rad\].
    pub swing_damping: Vec<f64>,
    pub links: Vec<Link>,
    pub rotors: Vec<Rotor>,
    pub torques: Vec<Torque>,
    pub tables: Vec<Periodic>,
    pub curves: Vec<Curve>,
}

/// The lists that cross the border.
#[derive(Clone, Copy, Debug)]
pub struct Encoded<'a> {
    /// Constant inertia, damping against the ground, and damping against the train as a whole, of each mass.
    pub masses: [&'a [f64]; 3],
    /// Rows of both ends (−1 the ground) and curve (−1 none).
    pub links: &'a [i32],
    /// Rows of ratio, stiffness, damping.
    pub link_numbers: &'a [f64],
    /// Rows of mass and table.
    pub rotors: &'a [i32],
    /// Rows of ratio and phase.
    pub rotor_numbers: &'a [f64],
    /// Rows of mass, kind of law, weight, table, curve (−1 none).
    pub torques: &'a [i32],
    /// Rows of ratio, scale, pitch, phase and five numbers of the law.
    pub torque_numbers: &'a [f64],
    /// Start of each table in its knots, and the end of the last.
    pub table_starts: &'a [i32],
    pub periods: &'a [f64],
    /// Values of all knots, then slopes, then bends.
    pub knots: &'a [f64],
    /// As for tables.
    pub curve_starts: &'a [i32],
    /// Places of all points, then values, slopes before, slopes after.
    pub points: &'a [f64],
}

/// Numbers of a row of torques: four and those of its law.
const TORQUE_WIDTH: usize = 9;

fn index(value: i32, bound: usize, what: &'static str) -> Result<usize, PlanError> {
    usize::try_from(value).ok().filter(|&i| i < bound).ok_or(PlanError::Index { what, value, bound })
}

fn index_or_none(value: i32, bound: usize, what: &'static str) -> Result<Option<usize>, PlanError> {
    if value == -1 { Ok(None) } else { index(value, bound, what).map(Some) }
}

fn length(what: &'static str, found: usize, expected: usize) -> Result<(), PlanError> {
    if found == expected { Ok(()) } else { Err(PlanError::Length { what, found, expected }) }
}

/// Parts of lists that lie end to end: the same range of each.
fn parts<'a, const N: usize>(
    starts: &[i32],
    list: &'a [f64],
    what: &'static str,
) -> Result<Vec<[&'a [f64]; N]>, PlanError> {
    let total = starts.last().copied().unwrap_or(0);
    let total = index(total, i32::MAX as usize, what)?;
    length(what, list.len(), N * total)?;
    let part = |number: usize, pair: &[i32]| {
        let (a, b) = (index(pair[0], total + 1, what)?, index(pair[1], total + 1, what)?);
        if a > b {
            return Err(PlanError::Table { number });
        }
        Ok(std::array::from_fn(|row| &list[row * total + a..row * total + b]))
    };
    starts.windows(2).enumerate().map(|(number, pair)| part(number, pair)).collect()
}

impl System {
    /// How many masses.
    pub fn len(&self) -> usize {
        self.inertia.len()
    }

    /// Never: a system has at least one mass.
    pub fn is_empty(&self) -> bool {
        self.inertia.is_empty()
    }

    /// Whether it can turn as a whole.
    pub fn is_free(&self) -> bool {
        self.links.iter().all(|link| !link.ends.contains(&self.len()))
    }

    /// Share of each mass in the mean inertia: weights of the speeds whose sum is that of the train as a whole. None of a
    /// train that is held, which as a whole stands.
    pub fn shares(&self) -> Vec<f64> {
        if !self.is_free() {
            return vec![0.0; self.len()];
        }
        let mut shares = self.inertia.clone();
        for rotor in &self.rotors {
            shares[rotor.mass] += rotor.ratio * rotor.ratio * self.tables[rotor.table].mean();
        }
        let sum: f64 = shares.iter().sum();
        shares.iter_mut().for_each(|share| *share /= sum);
        shares
    }

    /// Decodes and checks every index.
    ///
    /// # Errors
    /// [`PlanError`] names the first list or row that does not make sense.
    pub fn decode(code: &Encoded<'_>) -> Result<System, PlanError> {
        let [inertia, damping, swing_damping] = code.masses;
        let n = inertia.len();
        if n == 0 {
            return Err(PlanError::Length { what: "list of inertias", found: 0, expected: 1 });
        }
        length("list of damping", damping.len(), n)?;
        length("list of damping of swings", swing_damping.len(), n)?;
        let tables = decode_tables(code)?;
        let curves = decode_curves(code)?;
        Ok(System {
            inertia: inertia.to_vec(),
            damping: damping.to_vec(),
            swing_damping: swing_damping.to_vec(),
            links: decode_links(code, n, curves.len())?,
            rotors: decode_rotors(code, n, tables.len())?,
            torques: decode_torques(code, n, tables.len(), curves.len())?,
            tables,
            curves,
        })
    }
}

fn decode_tables(code: &Encoded<'_>) -> Result<Vec<Periodic>, PlanError> {
    let parts = parts::<3>(code.table_starts, code.knots, "list of knots")?;
    length("list of periods", code.periods.len(), parts.len())?;
    let table = |(number, ([y, d1, d2], &period)): (usize, ([&[f64]; 3], &f64))| {
        Periodic::new(period, y, d1, d2).ok_or(PlanError::Table { number })
    };
    parts.into_iter().zip(code.periods).enumerate().map(table).collect()
}

fn decode_curves(code: &Encoded<'_>) -> Result<Vec<Curve>, PlanError> {
    let parts = parts::<4>(code.curve_starts, code.points, "list of points")?;
    let curve = |(number, [x, y, before, after]): (usize, [&[f64]; 4])| {
        Curve::new(x, y, before, after).ok_or(PlanError::Table { number })
    };
    parts.into_iter().enumerate().map(curve).collect()
}

fn decode_links(code: &Encoded<'_>, n: usize, curves: usize) -> Result<Vec<Link>, PlanError> {
    let rows = code.links.chunks_exact(3);
    length("list of links", code.link_numbers.len(), code.links.len())?;
    let end = |value: i32| Ok(index_or_none(value, n, "mass")?.unwrap_or(n));
    let link = |(row, numbers): (&[i32], &[f64])| {
        Ok(Link {
            ends: [end(row[0])?, end(row[1])?],
            ratio: numbers[0],
            stiffness: numbers[1],
            damping: numbers[2],
            curve: index_or_none(row[2], curves, "curve")?,
        })
    };
    rows.zip(code.link_numbers.chunks_exact(3)).map(link).collect()
}

fn decode_rotors(code: &Encoded<'_>, n: usize, tables: usize) -> Result<Vec<Rotor>, PlanError> {
    length("list of rotors", code.rotor_numbers.len(), code.rotors.len())?;
    let rotor = |(row, numbers): (&[i32], &[f64])| {
        Ok(Rotor {
            mass: index(row[0], n, "mass")?,
            table: index(row[1], tables, "table")?,
            ratio: numbers[0],
            phase: numbers[1],
        })
    };
    code.rotors.chunks_exact(2).zip(code.rotor_numbers.chunks_exact(2)).map(rotor).collect()
}

fn decode_torques(
    code: &Encoded<'_>,
    n: usize,
    tables: usize,
    curves: usize,
) -> Result<Vec<Torque>, PlanError> {
    length("list of torques", code.torque_numbers.len(), code.torques.len() / 5 * TORQUE_WIDTH)?;
    let torque = |(row, numbers): (&[i32], &[f64])| {
        let table = index_or_none(row[3], tables, "table")?;
        Ok(Torque {
            mass: index(row[0], n, "mass")?,
            ratio: numbers[0],
            scale: numbers[1],
            law: decode_law(row, &numbers[4..], curves)?,
            weight: index_or_none(row[2], curves, "curve")?,
            shape: table.map(|table| Shape { table, pitch: numbers[2], phase: numbers[3] }),
        })
    };
    code.torques.chunks_exact(5).zip(code.torque_numbers.chunks_exact(TORQUE_WIDTH)).map(torque).collect()
}

/// Kinds 0 to 5 in the order of [`Law`].
fn decode_law(row: &[i32], numbers: &[f64], curves: usize) -> Result<Law, PlanError> {
    let &[a, b, c, d, e] = numbers else {
        return Err(PlanError::Length { what: "row of a law", found: numbers.len(), expected: 5 });
    };
    let curve = || index(row[4], curves, "curve");
    Ok(match row[1] {
        0 => Law::Constant,
        1 => Law::Even { inverse_speed: 1.0 / a, exponent: b },
        2 => Law::Odd { inverse_speed: 1.0 / a, exponent: b },
        3 => Law::OverSpeed { curve: curve()? },
        4 => Law::Following { gain: a, curve: curve()? },
        5 => Law::Decaying { from: a, until: b, rate: c, omega: d, phase: e },
        kind => return Err(PlanError::Kind { what: "law of a torque", kind }),
    })
}
