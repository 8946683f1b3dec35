//! The way from the crank to one point, link or slide, in registers.
//!
//! What is asked for often depends on the crank by a chain: each dyad has its pin on the one before and its pivot or its
//! guide on the ground. Then one moving point is all that goes from dyad to dyad, and it stays in registers; what else
//! the dyads move is not computed. The formulas are those of the elements ([`super::dyads`], [`super::mechanism`]).
//!
//! A [`Chain`] is made once a call, and with it every index is checked: [`Chain::numbers`] has the numbers of a
//! machine in rows of fixed length.

use super::dyads::{Bars, Rocker, Rocking, Rod, SliderRod, Sliding, rocking, sliding};
use super::mechanism::{Element, GroundPoint, Mechanism, crank};
use super::motion::{Channel, on_link};
use crate::kernel::plane::{Angle, Heading, Place, Slide, Vec2};
use crate::kernel::real::Real;
use crate::kernel::slot::Slot;

/// Numbers of a link: its own, the ground's, and the place of a point on a link.
const NUMBERS: usize = 10;

/// Where the numbers of one link of the chain are found.
type Slots = [Slot; NUMBERS];

/// The numbers of one link of the chain.
pub type Numbers = [f64; NUMBERS];

/// What is taken from a crank or a dyad.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    /// A point at rest.
    Ground,
    CrankPin,
    OnCrank,
    Crank,
    /// Joint of coupler and rocker, a point of either, either's angle.
    Joint,
    OnCoupler,
    OnRocker,
    Coupler,
    Rocker,
    /// The slider, a point of the rod, the rod's angle, the coordinate along the guide.
    Slider,
    OnRod,
    Rod,
    Along,
}

#[derive(Clone, Copy, Debug)]
struct Stage {
    part: Part,
    slots: Slots,
}

/// A chain: the points that lead to what is asked for, and what is taken at its end.
#[derive(Clone, Debug)]
pub struct Chain {
    lead: Vec<Stage>,
    end: Stage,
}

/// What is computed at the end.
enum EndMotion<R> {
    Point(Place<R>),
    Link(Heading<R>),
    Slide(Slide<R>),
}

impl Chain {
    /// The chain to a target; `None` where it depends on the crank in another way.
    pub fn to(mechanism: &Mechanism, target: Channel) -> Option<Self> {
        let (end, mut pin) = found(mechanism, target)?;
        let mut lead = Vec::new();
        while let Some(point) = pin {
            let (stage, next) = found(mechanism, Channel::Point(point))?;
            // A guide or a pivot may lie on the ground, a pin may not: such a machine stands still.
            if stage.part == Part::Ground {
                return None;
            }
            lead.push(stage);
            pin = next;
        }
        lead.reverse();
        Some(Chain { lead, end })
    }

    /// How many dyads are solved on the way.
    pub fn dyads(&self) -> usize {
        let moves = |stage: &&Stage| {
            !matches!(stage.part, Part::Ground | Part::CrankPin | Part::OnCrank | Part::Crank)
        };
        self.lead.iter().chain([&self.end]).filter(moves).count()
    }

    /// The numbers of a machine with parameters `q`, link by link.
    pub fn numbers(&self, q: &[f64], to: &mut Vec<Numbers>) {
        to.clear();
        to.extend(self.lead.iter().chain([&self.end]).map(|stage| stage.slots.map(|slot| q[slot])));
    }

    /// Follows the chain at some angles; `out` holds a list a number: x, y, x′, y′, x″, y″ of a point, cos ψ, sin ψ, ψ′,
    /// ψ″ of a link, s, s′, s″ of a slide. The lists are as long as those of the angles, a multiple of the lanes.
    /// Returns zero, or NaN where not all numbers are finite.
    #[inline(always)]
    pub fn follow<R: Real>(
        &self,
        numbers: &[Numbers],
        sin: &[f64],
        cos: &[f64],
        out: &mut [&mut [f64]],
    ) -> R {
        let Some((last, lead)) = numbers.split_last() else { return R::splat(0.0) };
        if let [crank] = lead
            && self.lead[0].part == Part::CrankPin
            && let Some(flaw) = from_crank(self.end.part, crank, last, (sin, cos), out)
        {
            return flaw;
        }
        let mut flaw = R::splat(0.0);
        for at in (0..sin.len()).step_by(R::LANES) {
            let angle = angle_at::<R>(sin, cos, at);
            let mut pin = Place::fixed(Vec2::zero());
            for k in 0..lead.len() {
                pin = point(self.lead[k].part, &lead[k], angle, &pin);
            }
            let sum = match end(self.end.part, last, angle, &pin) {
                EndMotion::Point(place) => put(of_point(place), at, out),
                EndMotion::Link(heading) => put(of_link(heading), at, out),
                EndMotion::Slide(slide) => put(of_slide(slide), at, out),
            };
            flaw = sum.mul_add(R::splat(0.0), flaw);
        }
        flaw
    }
}

/// One dyad on a crank: a loop for each thing that is asked for, in which the pin stays in registers. The numbers of the machine
/// are taken beforehand: behind every result that is written the compiler would read them again. None where it is no dyad's.
#[inline(always)]
fn from_crank<R: Real>(
    part: Part,
    crank: &Numbers,
    q: &Numbers,
    angles: (&[f64], &[f64]),
    out: &mut [&mut [f64]],
) -> Option<R> {
    let (centre, radius, phase) =
        (ground(crank).p, R::splat(crank[2]), [R::splat(crank[3]), R::splat(crank[4])]);
    let (pivot, bars, rod, at) = (ground(q), bars_of(q), rod_of(q), [R::splat(q[8]), R::splat(q[9])]);
    macro_rules! each {
        ($pin:ident => $values:expr) => {
            at_all(
                angles,
                out,
                #[inline(always)]
                |angle| {
                    let $pin = &super::mechanism::crank(centre, radius, phase, angle).0;
                    $values
                },
            )
        };
    }
    let flaw = match part {
        Part::Joint => each!(pin => of_point(rocking::<R, 2>(pin, &pivot, &bars).joint)),
        Part::OnCoupler => each!(pin => of_point(on(pin, &rocking::<R, 2>(pin, &pivot, &bars).coupler, at))),
        Part::OnRocker => each!(pin => of_point(on(&pivot, &rocking::<R, 2>(pin, &pivot, &bars).rocker, at))),
        Part::Coupler => each!(pin => of_link(rocking::<R, 2>(pin, &pivot, &bars).coupler)),
        Part::Rocker => each!(pin => of_link(rocking::<R, 2>(pin, &pivot, &bars).rocker)),
        Part::Slider => each!(pin => of_point(sliding::<R, 2>(pin, pivot.p, &rod).point)),
        Part::OnRod => each!(pin => of_point(on(pin, &sliding::<R, 2>(pin, pivot.p, &rod).link, at))),
        Part::Rod => each!(pin => of_link(sliding::<R, 2>(pin, pivot.p, &rod).link)),
        Part::Along => each!(pin => of_slide(sliding::<R, 2>(pin, pivot.p, &rod).slide)),
        Part::Ground | Part::CrankPin | Part::OnCrank | Part::Crank => return None,
    };
    Some(flaw)
}

/// The numbers at all angles; zero, or NaN where not all are finite.
#[inline(always)]
fn at_all<R: Real, const K: usize>(
    (sin, cos): (&[f64], &[f64]),
    out: &mut [&mut [f64]],
    values: impl Fn(Angle<R>) -> [R; K],
) -> R {
    let mut flaw = R::splat(0.0);
    for at in (0..sin.len()).step_by(R::LANES) {
        flaw = put(values(angle_at(sin, cos, at)), at, out).mul_add(R::splat(0.0), flaw);
    }
    flaw
}

#[inline(always)]
fn angle_at<R: Real>(sin: &[f64], cos: &[f64], at: usize) -> Angle<R> {
    let sine = R::load(&sin[at..at + R::LANES]);
    Angle { phi: sine, sin: sine, cos: R::load(&cos[at..at + R::LANES]) }
}

#[inline(always)]
fn of_point<R>(Place { p, d1, d2 }: Place<R>) -> [R; 6] {
    [p.x, p.y, d1.x, d1.y, d2.x, d2.y]
}

#[inline(always)]
fn of_link<R>(Heading { e, d1, d2 }: Heading<R>) -> [R; 4] {
    [e.x, e.y, d1, d2]
}

#[inline(always)]
fn of_slide<R>(Slide { s, d1, d2 }: Slide<R>) -> [R; 3] {
    [s, d1, d2]
}

/// The point of a link that is asked for.
#[inline(always)]
fn on<R: Real>(origin: &Place<R>, link: &Heading<R>, [along, across]: [R; 2]) -> Place<R> {
    on_link::<R, 2>(origin, link, along, across)
}

/// Writes one bundle to each list, and returns their sum.
#[inline(always)]
fn put<R: Real, const K: usize>(values: [R; K], at: usize, out: &mut [&mut [f64]]) -> R {
    let mut sum = values[0];
    let Some(out) = out.first_chunk_mut::<K>() else { return sum };
    for k in 0..K {
        values[k].store(&mut out[k][at..at + R::LANES]);
        if k > 0 {
            sum = sum + values[k];
        }
    }
    sum
}

/// What is taken at the end of a chain.
#[inline(always)]
fn end<R: Real>(part: Part, q: &Numbers, angle: Angle<R>, pin: &Place<R>) -> EndMotion<R> {
    match part {
        Part::Crank => EndMotion::Link(turned(q, angle).1),
        Part::Coupler => EndMotion::Link(bars(q, pin).coupler),
        Part::Rocker => EndMotion::Link(bars(q, pin).rocker),
        Part::Rod => EndMotion::Link(rod(q, pin).link),
        Part::Along => EndMotion::Slide(rod(q, pin).slide),
        point_of => EndMotion::Point(point(point_of, q, angle, pin)),
    }
}

/// A point of the chain from the one before.
#[inline(always)]
fn point<R: Real>(part: Part, q: &Numbers, angle: Angle<R>, pin: &Place<R>) -> Place<R> {
    let at = [R::splat(q[8]), R::splat(q[9])];
    match part {
        Part::CrankPin => turned(q, angle).0,
        Part::OnCrank => on(&ground(q), &turned(q, angle).1, at),
        Part::Joint => bars(q, pin).joint,
        Part::OnCoupler => on(pin, &bars(q, pin).coupler, at),
        Part::OnRocker => on(&ground(q), &bars(q, pin).rocker, at),
        Part::Slider => rod(q, pin).point,
        Part::OnRod => on(pin, &rod(q, pin).link, at),
        _ => ground(q),
    }
}

/// The point of the ground on which a link of the chain hangs.
#[inline(always)]
fn ground<R: Real>(q: &Numbers) -> Place<R> {
    Place::fixed(Vec2::new(R::splat(q[0]), R::splat(q[1])))
}

#[inline(always)]
fn turned<R: Real>(q: &Numbers, angle: Angle<R>) -> (Place<R>, Heading<R>) {
    crank(ground(q).p, R::splat(q[2]), [R::splat(q[3]), R::splat(q[4])], angle)
}

#[inline(always)]
fn bars<R: Real>(q: &Numbers, pin: &Place<R>) -> Rocking<R> {
    rocking::<R, 2>(pin, &ground(q), &bars_of(q))
}

#[inline(always)]
fn bars_of<R: Real>(q: &Numbers) -> Bars<R> {
    // Written out: `map` of an array is a call of its own wherever it is not inlined.
    Bars {
        coupler: R::splat(q[2]),
        rocker: R::splat(q[3]),
        inverse_coupler: R::splat(q[4]),
        inverse_rocker: R::splat(q[5]),
        sign: R::splat(q[6]),
    }
}

#[inline(always)]
fn rod<R: Real>(q: &Numbers, pin: &Place<R>) -> Sliding<R> {
    sliding::<R, 2>(pin, ground(q).p, &rod_of(q))
}

#[inline(always)]
fn rod_of<R: Real>(q: &Numbers) -> Rod<R> {
    Rod {
        rod: R::splat(q[2]),
        inverse_rod: R::splat(q[3]),
        sign: R::splat(q[4]),
        offset: R::splat(q[5]),
        t: Vec2::new(R::splat(q[6]), R::splat(q[7])),
    }
}

/// The stage that has a target, and the point on which it hangs, if any.
fn found(mechanism: &Mechanism, target: Channel) -> Option<(Stage, Option<usize>)> {
    if let Channel::Point(index) = target
        && let Some(at) = at_rest(mechanism, index)
    {
        return Some((Stage { part: Part::Ground, slots: row(at, &[]) }, None));
    }
    mechanism.elements.iter().find_map(|element| match element {
        &Element::RigidPoint { point, link, origin, along, across } if target == Channel::Point(point) => {
            on_a_link(mechanism, link, origin, [along, across])
        }
        element => taken(mechanism, element, target),
    })
}

/// The point of the ground with an index.
fn at_rest(mechanism: &Mechanism, point: usize) -> Option<&GroundPoint> {
    mechanism.ground.iter().find(|fixed| fixed.point == point)
}

/// Slots in a row of fixed length; places that are not used repeat one that is.
fn row(ground: &GroundPoint, own: &[Slot]) -> Slots {
    let mut slots = [ground.x; NUMBERS];
    slots[1] = ground.y;
    slots[2..2 + own.len()].copy_from_slice(own);
    slots
}

/// What an element itself places, turns or shifts.
fn taken(mechanism: &Mechanism, element: &Element, target: Channel) -> Option<(Stage, Option<usize>)> {
    match *element {
        Element::Crank { pin, link, pivot, radius, cos, sin } => {
            let part = match target {
                Channel::Point(index) if index == pin => Part::CrankPin,
                Channel::Link(index) if index == link => Part::Crank,
                _ => return None,
            };
            let slots = row(at_rest(mechanism, pivot)?, &[radius, cos, sin]);
            Some((Stage { part, slots }, None))
        }
        Element::Rocker(ref e) => {
            let part = match target {
                Channel::Point(index) if index == e.joint => Part::Joint,
                Channel::Link(index) if index == e.coupler_link => Part::Coupler,
                Channel::Link(index) if index == e.rocker_link => Part::Rocker,
                _ => return None,
            };
            Some((Stage { part, slots: slots_of_bars(mechanism, e)? }, Some(e.pin)))
        }
        Element::SliderRod(ref e) => {
            let part = match target {
                Channel::Point(index) if index == e.point => Part::Slider,
                Channel::Link(index) if index == e.link => Part::Rod,
                Channel::Slide(index) if index == e.slide => Part::Along,
                _ => return None,
            };
            Some((Stage { part, slots: slots_of_rod(mechanism, e)? }, Some(e.pin)))
        }
        _ => None,
    }
}

fn slots_of_bars(mechanism: &Mechanism, e: &Rocker) -> Option<Slots> {
    let own = [e.coupler, e.rocker, e.inverse_coupler, e.inverse_rocker, e.sign];
    Some(row(at_rest(mechanism, e.pivot)?, &own))
}

fn slots_of_rod(mechanism: &Mechanism, e: &SliderRod) -> Option<Slots> {
    let own = [e.rod, e.inverse_rod, e.sign, e.offset, e.cos, e.sin];
    Some(row(at_rest(mechanism, e.through)?, &own))
}

/// A point on a link of the chain, counted from where the link starts.
fn on_a_link(
    mechanism: &Mechanism,
    link: usize,
    origin: usize,
    place: [Slot; 2],
) -> Option<(Stage, Option<usize>)> {
    let (mut stage, pin) =
        mechanism.elements.iter().find_map(|element| taken(mechanism, element, Channel::Link(link)))?;
    let starts_at = |fixed: usize| at_rest(mechanism, origin).is_some() && origin == fixed;
    stage.part = match stage.part {
        Part::Crank if at_rest(mechanism, origin).is_some_and(|at| [at.x, at.y] == stage.slots[..2]) => {
            Part::OnCrank
        }
        Part::Coupler if pin == Some(origin) => Part::OnCoupler,
        Part::Rod if pin == Some(origin) => Part::OnRod,
        Part::Rocker if pivot_of(mechanism, link).is_some_and(starts_at) => Part::OnRocker,
        _ => return None,
    };
    stage.slots[8..].copy_from_slice(&place);
    Some((stage, pin))
}

/// The pivot of the rocker that is a link.
fn pivot_of(mechanism: &Mechanism, link: usize) -> Option<usize> {
    mechanism.elements.iter().find_map(|element| match element {
        Element::Rocker(e) if e.rocker_link == link => Some(e.pivot),
        _ => None,
    })
}
