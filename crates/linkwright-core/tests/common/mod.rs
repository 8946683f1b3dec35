//! Machines for the tests, built as a plan with its parameters.
#![allow(dead_code, unreachable_pub)]

use linkwright_core::drive::loads::{At, Body, Load, What};
use linkwright_core::drive::motor::{Drive, Motor, Span};
use linkwright_core::drive::structure::Plan;
use linkwright_core::kernel::formula::{Formula, Op, Variable};
use linkwright_core::kernel::table::Table;
use linkwright_core::linkage::coupled::{AngleOf, Law, Runner, Source, Sum, Turn};
use linkwright_core::linkage::dyads::{Rocker, SliderRod};
use linkwright_core::linkage::folding::{ChangePoint, Folding};
use linkwright_core::linkage::group::{Bar, BarPoint, Condition, Group};
use linkwright_core::linkage::guided::{Crossing, GuidedRod, Line, SlottedLever};
use linkwright_core::linkage::in_line::in_line;
use linkwright_core::linkage::mechanism::{Element, GroundPoint};
use linkwright_core::linkage::trace::{Path, follow};
use linkwright_core::plan::builder as plan;

/// A plan and the numbers that go with it.
pub struct SampleMachine {
    pub plan: Plan,
    pub q: Vec<f64>,
}

/// Collects numbers, and gives elements of the plan's builder their indices.
pub struct Builder {
    plan: plan::Builder,
    n_points: usize,
    n_links: usize,
    n_slides: usize,
    n_gaps: usize,
    q: Vec<f64>,
}

impl Builder {
    /// Starts with the origin as point 0.
    pub fn new() -> Self {
        let plan = plan::Builder::new(0);
        let mut b = Builder { plan, n_points: 0, n_links: 0, n_slides: 0, n_gaps: 0, q: Vec::new() };
        b.fixed(0.0, 0.0);
        b
    }

    pub fn number(&mut self, x: f64) -> usize {
        self.q.push(x);
        self.plan.parameter()
    }

    fn add(&mut self, element: Element) -> usize {
        self.plan.element(element).expect("a sound element")
    }

    fn point(&mut self) -> usize {
        self.n_points += 1;
        self.n_points - 1
    }

    fn link(&mut self) -> usize {
        self.n_links += 1;
        self.n_links - 1
    }

    fn gap(&mut self) -> usize {
        self.n_gaps += 1;
        self.n_gaps - 1
    }

    pub fn fixed(&mut self, x: f64, y: f64) -> usize {
        let (point, x, y) = (self.point(), self.number(x), self.number(y));
        self.plan.fixed(GroundPoint { point, x, y }).expect("a sound point");
        point
    }

    /// Pin and link of a crank about point 0.
    pub fn crank(&mut self, radius: f64, phase: f64) -> (usize, usize) {
        let (pin, link) = (self.point(), self.link());
        let (radius, cos, sin) = (self.number(radius), self.number(phase.cos()), self.number(phase.sin()));
        self.add(Element::Crank { pin, link, pivot: 0, radius, cos, sin });
        (pin, link)
    }

    /// Point, link and slide of a slider.
    pub fn slider(&mut self, pin: usize, rod: f64, offset: f64, angle: f64, sign: f64) -> [usize; 3] {
        let (point, link, gap) = (self.point(), self.link(), self.gap());
        let slide = self.slide();
        let element = SliderRod {
            point,
            link,
            slide,
            gap,
            pin,
            through: 0,
            rod: self.number(rod),
            inverse_rod: self.number(1.0 / rod),
            offset: self.number(offset),
            cos: self.number(angle.cos()),
            sin: self.number(angle.sin()),
            sign: self.number(sign),
        };
        self.add(Element::SliderRod(element));
        [point, link, slide]
    }

    /// Joint, coupler and rocker of a dyad RRR.
    pub fn rocker(&mut self, pin: usize, pivot: usize, coupler: f64, rocker: f64, sign: f64) -> [usize; 3] {
        let (joint, coupler_link, rocker_link, gap) = (self.point(), self.link(), self.link(), self.gap());
        let element = Rocker {
            joint,
            coupler_link,
            rocker_link,
            gap,
            pin,
            pivot,
            coupler: self.number(coupler),
            rocker: self.number(rocker),
            inverse_coupler: self.number(1.0 / coupler),
            inverse_rocker: self.number(1.0 / rocker),
            sign: self.number(sign),
        };
        self.add(Element::Rocker(element));
        [joint, coupler_link, rocker_link]
    }

    pub fn rigid_point(&mut self, link: usize, origin: usize, along: f64, across: f64) -> usize {
        let (point, along, across) = (self.point(), self.number(along), self.number(across));
        self.add(Element::RigidPoint { point, link, origin, along, across });
        point
    }

    fn slide(&mut self) -> usize {
        self.n_slides += 1;
        self.n_slides - 1
    }

    /// A guide on a link.
    pub fn line(&mut self, through: usize, link: usize, angle: f64, offset: f64) -> Line {
        let [cos, sin, offset] = [angle.cos(), angle.sin(), offset].map(|x| self.number(x));
        Line { through, link, cos, sin, offset }
    }

    pub fn guided_rod(&mut self, pin: usize, line: Line, rod: f64, sign: f64) {
        let element = GuidedRod {
            point: self.point(),
            link: self.link(),
            slide: self.slide(),
            gap: self.gap(),
            pin,
            line,
            rod: self.number(rod),
            inverse_rod: self.number(1.0 / rod),
            sign: self.number(sign),
        };
        self.add(Element::GuidedRod(element));
    }

    pub fn slotted_lever(&mut self, pin: usize, pivot: usize, offset: f64, sign: f64) {
        let (link, slide, gap) = (self.link(), self.slide(), self.gap());
        let (offset, sign) = (self.number(offset), self.number(sign));
        let element = SlottedLever { link, slide, gap, pin, pivot, offset, sign };
        self.add(Element::SlottedLever(element));
    }

    pub fn crossing(&mut self, first: Line, second: Line) {
        let (point, slides, gap) = (self.point(), [self.slide(), self.slide()], self.gap());
        self.add(Element::Crossing(Crossing { point, slides, gap, lines: [first, second] }));
    }

    fn sum(&mut self, start: f64, terms: &[(Option<usize>, f64)]) -> Sum {
        let start = self.number(start);
        let terms = terms
            .iter()
            .map(|&(slide, factor)| (slide.map_or(Source::Drive, Source::Slide), self.number(factor)))
            .collect();
        Sum { start, terms }
    }

    /// A gear; terms are slides, or none for the crank angle, with their factors.
    pub fn turn(&mut self, start: f64, terms: &[(Option<usize>, f64)]) {
        let (link, slide, angle) = (self.link(), self.slide(), self.sum(start, terms));
        self.add(Element::Turn(Turn { link, slide, angle }));
    }

    pub fn runner(&mut self, line: Line, start: f64, terms: &[(Option<usize>, f64)]) {
        let (point, slide, place) = (self.point(), self.slide(), self.sum(start, terms));
        self.add(Element::Runner(Runner { point, slide, line, place }));
    }

    /// The slide that holds a link's angle.
    pub fn angle_of(&mut self, link: usize, winding: f64, centre: f64) -> usize {
        let (slide, winding, centre) = (self.slide(), self.number(winding), self.number(centre));
        self.add(Element::AngleOf(AngleOf { link, slide, winding, centre }));
        slide
    }

    /// A coordinate 0.3 sin φ.
    pub fn law_of_sine(&mut self) -> usize {
        let slide = self.slide();
        let size = self.number(0.3);
        let ops = vec![Op::Number(size), Op::Variable(Variable::Phi), Op::Sin, Op::Mul];
        let formula = Formula::new(ops).expect("a sound formula");
        self.add(Element::Law(Law { slide, formula }));
        slide
    }

    /// A joint at a distance from one point, and at a length that is a slide from another.
    pub fn cylinder(&mut self, bar: (usize, f64), cylinder: (usize, usize), near: [f64; 2]) -> usize {
        let to = self.point();
        let conditions = vec![
            Condition::Distance { from: bar.0, to, length: self.number(bar.1) },
            Condition::Length { from: cylinder.0, to, slide: cylinder.1 },
        ];
        let starts = near.iter().map(|&x| Table::new(&[0.0], &[x]).expect("one knot")).collect();
        let (gap, inverse_turns) = (self.gap(), self.number(1.0));
        let unknowns = vec![to];
        let (bar_points, bars) = (vec![], vec![]);
        let group =
            Group { unknowns, bar_points, bars, conditions, gap, starts, inverse_turns, repeats: true };
        self.add(Element::Group(group));
        to
    }

    /// Joints P, Q and the third corner of the plate PQ; bars from the pin to P, of the plate, from Q and from
    /// the corner to two pivots. Gives the element's number.
    pub fn triad(
        &mut self,
        pin: usize,
        pivots: [usize; 2],
        lengths: [f64; 4],
        corner: (f64, f64),
        near: [f64; 4],
    ) -> usize {
        let [p, q, k] = [self.point(), self.point(), self.point()];
        let ends = [(pin, p), (p, q), (q, pivots[0]), (k, pivots[1])];
        let plate = lengths[1];
        let starts = near.iter().map(|&x| Table::new(&[0.0], &[x]).expect("one knot")).collect();
        let conditions = ends
            .iter()
            .zip(lengths)
            .map(|(&(from, to), length)| Condition::Distance { from, to, length: self.number(length) })
            .collect();
        let bars = ends
            .iter()
            .zip(lengths)
            .map(|(&(from, to), length)| Bar {
                link: self.link(),
                from,
                to,
                inverse_length: self.number(1.0 / length),
            })
            .collect();
        let (along, across) = (self.number(corner.0 / plate), self.number(corner.1 / plate));
        let group = Group {
            unknowns: vec![p, q],
            bar_points: vec![BarPoint { point: k, from: p, to: q, along, across }],
            bars,
            conditions,
            gap: self.gap(),
            starts,
            inverse_turns: self.number(1.0),
            repeats: true,
        };
        self.add(Element::Group(group))
    }

    /// A group of joints and the bars between points, followed from near the places of the joints at φ = 0; after
    /// how many revolutions it repeats.
    pub fn group(&mut self, bars: &[(usize, usize, f64)], unknowns: &[usize], near: &[f64]) -> Option<u32> {
        let gap = self.gap();
        let inverse_turns = self.number(1.0);
        let starts = near.iter().map(|&x| Table::new(&[0.0], &[x]).expect("a sound table")).collect();
        let conditions = bars
            .iter()
            .map(|&(from, to, length)| Condition::Distance { from, to, length: self.number(length) })
            .collect();
        let links = bars
            .iter()
            .map(|&(from, to, length)| Bar {
                link: self.link(),
                from,
                to,
                inverse_length: self.number(1.0 / length),
            })
            .collect();
        let mut group = Group {
            unknowns: unknowns.to_vec(),
            bar_points: vec![],
            bars: links,
            conditions,
            gap,
            starts,
            inverse_turns,
            repeats: true,
        };
        // Followed as if it were there already, from the table of its places at the start.
        let mut mechanism = self.plan.mechanism().clone();
        let element = mechanism.elements.len();
        mechanism.elements.push(Element::Group(group.clone()));
        (mechanism.n_points, mechanism.n_links) = (self.n_points, self.n_links);
        (mechanism.n_slides, mechanism.n_gaps) = (self.n_slides, self.n_gaps);
        let path = follow(&mechanism, element, &self.q, 0.0, near)?;
        let turns = path.turns;
        let cycle = f64::from(turns.unwrap_or(1));
        self.q[inverse_turns] = 1.0 / cycle;
        let phi: Vec<f64> = path.phi.iter().map(|phi| phi / cycle).collect();
        group.starts = path.places.iter().map(|x| Table::new(&phi, x).expect("a sound table")).collect();
        group.repeats = turns.is_some();
        self.add(Element::Group(group));
        turns
    }

    /// A point for a group to find.
    pub fn joint(&mut self) -> usize {
        self.point()
    }

    /// Gives a group the motion that was followed.
    pub fn give_path(built: &mut SampleMachine, element: usize, path: &Path) {
        let Element::Group(group) = &mut built.plan.mechanism.elements[element] else {
            panic!("element {element} is no group");
        };
        let table = |place: &Vec<f64>| Table::new(&path.phi, place).expect("angles increase");
        group.starts = path.places.iter().map(table).collect();
    }

    /// Turns a rocker into one with the change points that it has; its side is that at small positive crank angles.
    /// Gives how many there are.
    pub fn give_change_points(built: &mut SampleMachine, element: usize) -> usize {
        let Element::Rocker(rocker) = built.plan.mechanism.elements[element] else {
            panic!("element {element} is no rocker");
        };
        let found = in_line(&built.plan.mechanism, element, &built.q);
        let side = |phi: f64| found.iter().map(|at| ((phi - at.phi) / 2.0).sin()).product::<f64>().signum();
        built.q[rocker.sign] *= side(1e-7);
        let mut change_points = Vec::new();
        for at in &found {
            change_points.push(ChangePoint::stored(built.q.len(), !at.arms.is_empty()));
            built.q.extend(at.series.iter().chain(&at.arms));
        }
        built.plan.n_parameters = built.q.len();
        built.plan.mechanism.elements[element] = Element::Folding(Folding { rocker, change_points });
        found.len()
    }

    pub fn mass(&mut self, point: usize, mass: f64) {
        let mass = self.number(mass);
        self.plan.body(Body::Point { point, mass }).expect("a sound body");
    }

    pub fn rod(&mut self, link: usize, origin: usize, length: f64, mass: f64) {
        let (along, across) = (self.number(length / 2.0), self.number(0.0));
        let (mass, inertia) = (self.number(mass), self.number(mass * length * length / 12.0));
        let body = Body::Link { link, origin, along, across, mass, inertia };
        self.plan.body(body).expect("a sound body");
    }

    pub fn dry_slide(&mut self, slide: usize, force: f64) {
        let size = self.number(force);
        self.load(At::Slide { slide, point: 0 }, What::Dry { size });
    }

    pub fn load(&mut self, at: At, what: What) {
        self.plan.load(Load { at, what }).expect("a sound load");
    }

    pub fn gravity(&mut self, g: f64) {
        let [cos, sin, size] = [0.0, -1.0, g].map(|x| self.number(x));
        self.load(At::Bodies { cos, sin }, What::Constant { size });
    }

    pub fn table(&mut self, x: &[f64], y: &[f64]) -> usize {
        self.plan.table(Table::new(x, y).expect("a sound table"))
    }

    /// `factors`: ratio, forward, reverse, inertia on the crank, starting speed.
    pub fn finish(mut self, motor: Motor, factors: [f64; 5]) -> SampleMachine {
        let [ratio, forward, reverse, inertia, speed_start] = factors.map(|x| self.number(x));
        let drive = Drive { motor, ratio, forward, reverse, inertia, speed_start, speed_loads: vec![] };
        let plan = self.plan.into_plan(drive).expect("a sound drive");
        SampleMachine { plan, q: self.q }
    }

    /// Motor of paper 1 with its start, by the catalogue curve.
    pub fn paper_motor(&mut self) -> Motor {
        let (synchronous, breakdown) = (104.72, 94.95);
        let [x0, y0, x1, y1, inverse_width] =
            [0.0, 129.24, breakdown, 215.4, 1.0 / breakdown].map(|x| self.number(x));
        Motor::Induction {
            inverse_synchronous: self.number(1.0 / synchronous),
            torque: self.number(215.4),
            slip: self.number(1.0 - breakdown / synchronous),
            resistance: self.number(0.0),
            spans: vec![Span { x0, y0, x1, y1, inverse_width, is_level: false }],
        }
    }
}

/// The two-cart drive of paper 1 with the given phase of the second crank and reverse factor.
pub fn two_carts(phase: f64, reverse: f64) -> SampleMachine {
    let mut b = Builder::new();
    for phase in [0.0, phase] {
        let (pin, _) = b.crank(0.2, phase);
        let [point, link, slide] = b.slider(pin, 0.8, 0.0, 0.0, 1.0);
        b.mass(point, 1000.0);
        b.rod(link, pin, 0.8, 64.0);
        b.dry_slide(slide, 3562.0);
    }
    b.gravity(9.81);
    let motor = b.paper_motor();
    b.finish(motor, [9.8, 0.9, reverse, 0.504 * 9.8 * 9.8, 104.72 / 9.8])
}

/// Reproducible random numbers (SplitMix64).
pub struct Random(pub u64);

impl Random {
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^= z >> 31;
        low + (high - low) * (z >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A machine with an inclined, offset slider, a crank-rocker with a coupler point, and all kinds of bodies.
pub fn mixed(random: &mut Random) -> SampleMachine {
    let mut b = Builder::new();
    let (pin, crank) = b.crank(random.between(0.08, 0.12), random.between(-3.0, 3.0));
    let [slider, rod, slide] = b.slider(
        pin,
        random.between(0.4, 0.6),
        random.between(-0.1, 0.1),
        random.between(-3.0, 3.0),
        if random.between(0.0, 1.0) < 0.5 { 1.0 } else { -1.0 },
    );
    let pivot = b.fixed(random.between(0.38, 0.42), random.between(-0.1, 0.1));
    let side = if random.between(0.0, 1.0) < 0.5 { 1.0 } else { -1.0 };
    let [joint, coupler, rocker] =
        b.rocker(pin, pivot, random.between(0.36, 0.4), random.between(0.26, 0.3), side);
    let tip = b.rigid_point(coupler, pin, 0.2, random.between(-0.2, 0.2));
    b.mass(slider, 20.0);
    b.mass(tip, 3.0);
    b.mass(joint, 1.0);
    b.rod(rod, pin, 0.5, 4.0);
    b.rod(rocker, pivot, 0.28, 5.0);
    b.rod(crank, 0, 0.1, 2.0);
    b.dry_slide(slide, random.between(100.0, 400.0));
    let [size, damping, stiffness, free_length, preload] =
        [random.between(1.0, 5.0), 30.0, random.between(100.0, 900.0), 0.3, 0.0].map(|x| b.number(x));
    b.load(At::Link { link: rocker }, What::Dry { size });
    b.load(At::Point { point: tip }, What::Viscous { damping });
    b.load(At::Between { from: joint, to: 0 }, What::Spring { stiffness, free_length, preload });
    b.gravity(9.81);
    let (torque, inverse_speed) = (b.number(100.0), b.number(1.0 / 300.0));
    b.finish(Motor::Line { torque, inverse_speed }, [10.0, 0.9, 0.9, 5.0, 30.0])
}
