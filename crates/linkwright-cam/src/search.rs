//! Many cams of one law: what decides about each, at the same cam angles, in lanes and threads.
//!
//! The law is evaluated once; a lane is a cam. Between the angles an extreme may be higher, by about
//! (step)²/8 times its second derivative: what is chosen in the end is looked at exactly.

use super::shape::angles;
use super::{Cam, Dimensions, Kind};
use linkwright_kernel::call::{in_threads, poll};
use linkwright_kernel::lanes::{Job, in_lanes};
use linkwright_kernel::motion_law::MotionLaw;
use linkwright_kernel::out_of_line;
use linkwright_kernel::real::Real;
use rayon::prelude::*;

/// Results per cam: largest |tan γ|, infinite where the follower locks; minimum soundness, maximum and minimum bend of
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

/// Looks at all cams at about `angles` angles per revolution; `out` holds [`RESULTS`] numbers a cam.
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
            let found = out_of_line!(R, self.lanes::<R>(self.first + at));
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
        let cams = self.cams;
        let size = cams.size.map(
            #[inline(always)]
            |column| load(column, first),
        );
        let cam = Cam::new(cams.kind, cams.sense, cams.side, size);
        let lift: R = load(cams.lift, first);
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        // Fractions are compared crosswise, and divided once in the end: the largest |tan γ| so far, where one whose lower
        // part is not positive is infinite, and the largest and the smallest bend, of which the first is none.
        let (mut over, mut under) = (zero, one);
        let (mut most, mut least) = ((-one, zero), (one, zero));
        for s in self.lifts {
            let contact = cam.measure([lift * s[0], lift * s[1], lift * s[2]]);
            let (y, x) = (contact.lead.y.abs(), contact.lead.x.max(zero));
            let (known, found) = (over * x, y * under);
            over = known.select_lt(found, y, over);
            under = known.select_lt(found, x, under);
            let bend = (contact.over, contact.under);
            let (known, found) = (most.0 * bend.1, bend.0 * most.1);
            most = (known.select_lt(found, bend.0, most.0), known.select_lt(found, bend.1, most.1));
            let (known, found) = (least.0 * bend.1, bend.0 * least.1);
            least = (found.select_lt(known, bend.0, least.0), found.select_lt(known, bend.1, least.1));
        }
        let (most, least) = (cam.bend_of(most.0, most.1), cam.bend_of(least.0, least.1));
        let lead = over / under;
        // Soundness falls with the bend of a pitch curve, and is the radius of a face's profile.
        let at = if cams.kind.is_roller() { most } else { least };
        let sound = cam.soundness_of(at);
        // Dimensions that do not go together gave NaN everywhere, which min and max pass over.
        let nan = cam.start * 0.0;
        [lead + nan, sound + nan, most + nan, least + nan]
    }
}

/// Entries of a column from one on, as many as there are lanes; beyond the last it is repeated.
#[inline(always)]
fn load<R: Real>(column: &[f64], first: usize) -> R {
    if column.len() == 1 {
        return R::splat(column[0]);
    }
    let mut lanes = [0.0; 2 * LANES_MAX];
    for (lane, to) in lanes[..R::LANES].iter_mut().enumerate() {
        *to = column[(first + lane).min(column.len() - 1)];
    }
    R::load(&lanes)
}

/// Lanes of the widest register.
const LANES_MAX: usize = 8;
