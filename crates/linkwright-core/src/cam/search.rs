//! Many cams of one law: what decides about each, at the same cam angles, in lanes and threads.
//!
//! The law is evaluated once; a lane is a cam. Between the angles an extreme may be higher, by about
//! (step)²/8 times its second derivative: what is chosen in the end is looked at exactly.

use super::shape::angles;
use super::{Cam, Dimensions, Kind};
use crate::kernel::call::{in_threads, poll};
use crate::kernel::lanes::{Job, in_lanes};
use crate::kernel::motion_law::MotionLaw;
use crate::kernel::real::Real;
use rayon::prelude::*;

/// Results per cam: largest |tan γ|, infinite where the follower locks; least soundness, greatest and least bend of
/// [`super`].
pub const RESULTS: usize = 4;

/// Dimensions of many cams of one kind: columns of one entry or one a cam, and the factor on the lift.
#[derive(Clone, Copy, Debug)]
pub struct Cams<'a> {
    pub kind: Kind,
    pub sense: f64,
    pub side: f64,
    pub size: Dimensions<&'a [f64]>,
    pub lift: &'a [f64],
    /// How many.
    pub n: usize,
}

/// Looks at all cams at about `angles` angles a turn; `out` holds [`RESULTS`] numbers a cam.
pub fn search(law: &MotionLaw, cams: &Cams<'_>, per_turn: usize, out: &mut [f64]) {
    let lifts: Vec<[f64; 3]> =
        law.pieces().iter().flat_map(|piece| angles(piece, per_turn).map(|phi| piece.at(phi))).collect();
    in_threads(|crew| {
        out.par_chunks_mut(CHUNK * RESULTS).enumerate().for_each(|(k, out)| {
            crew.task(|| in_lanes(Chunk { lifts: &lifts, cams, first: k * CHUNK, out }));
        });
    });
}

/// Cams a task: some hundred microseconds of work.
const CHUNK: usize = 256;

struct Chunk<'a> {
    lifts: &'a [[f64; 3]],
    cams: &'a Cams<'a>,
    first: usize,
    out: &'a mut [f64],
}

impl Job for Chunk<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self) {
        let n = self.out.len() / RESULTS;
        let mut row = vec![0.0; R::LANES];
        for at in (0..n).step_by(R::LANES) {
            poll();
            let found = R::outline(
                #[inline(always)]
                || self.lanes::<R>(self.first + at),
            );
            for (result, x) in found.into_iter().enumerate() {
                x.store(&mut row);
                for (lane, &value) in row.iter().take(n - at).enumerate() {
                    self.out[(at + lane) * RESULTS + result] = value;
                }
            }
        }
    }
}

impl Chunk<'_> {
    /// The cams from one on, as many as there are lanes; beyond the last they are repeated.
    #[inline(always)]
    fn lanes<R: Real>(&self, first: usize) -> [R; RESULTS] {
        let load = |column: &[f64]| {
            if column.len() == 1 {
                return R::splat(column[0]);
            }
            let mut lanes = [0.0; 2 * LANES_MAX];
            for (lane, to) in lanes[..R::LANES].iter_mut().enumerate() {
                *to = column[(first + lane).min(column.len() - 1)];
            }
            R::load(&lanes)
        };
        let cams = self.cams;
        let cam = Cam::new(cams.kind, cams.sense, cams.side, cams.size.map(load));
        let lift = load(cams.lift);
        let (zero, infinite) = (R::splat(0.0), R::splat(f64::INFINITY));
        let (mut lead, mut sound, mut most, mut least) = (zero, infinite, -infinite, infinite);
        for s in self.lifts {
            let contact = cam.contact(s.map(|x| lift * x));
            let slope = contact.lead.y.abs() / contact.lead.x;
            lead = lead.max(slope.select_lt(zero, infinite, slope));
            sound = sound.min(cam.soundness(&contact));
            most = most.max(contact.bend);
            least = least.min(contact.bend);
        }
        // Dimensions that do not go together gave NaN everywhere, which min and max pass over.
        let nan = cam.start * 0.0;
        [lead + nan, sound + nan, most + nan, least + nan]
    }
}

/// Lanes of the widest register.
const LANES_MAX: usize = 8;
