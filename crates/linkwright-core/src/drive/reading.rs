//! The solution between the steps of a revolution: state of the machine at any angle, and curves over the revolution.
//!
//! Where there are series ([`crate::drive::between`]) they are read. Elsewhere, from the start of the step that an angle
//! lies in, a step of its own leads to the angle ([`Machine::advance`]): what is read has the order of the method, is
//! stiffly stable like it, and is what [`crate::drive::check`] compares.

use crate::drive::between::Between;
use crate::drive::equation::Machine;
use crate::drive::law::LawGeometry;
use crate::drive::step::{Step, stages_of_part};
use crate::drive::structure::Plan;
use crate::kernel::call::poll;
use crate::kernel::lanes::{Job, in_lanes};
use crate::kernel::out_of_line;
use crate::kernel::radau::{N, S, through};
use crate::kernel::real::Real;
use crate::kernel::series::{TERMS, value as on_series};
use crate::linkage::motion::Motion;

/// The solution at the start of a step.
#[derive(Clone, Copy, Debug)]
pub struct Mark {
    /// Crank angle \[rad\].
    pub phi: f64,
    /// u = ½ ω² \[rad²/s²\].
    pub u: f64,
    /// Time from φ = 0 \[s\].
    pub t: f64,
    /// Length of the step \[rad\].
    pub h: f64,
    /// u at the stages of the step, from which what is read between is begun.
    pub X: [f64; S],
}

/// The machine at one angle of its motion.
#[derive(Clone, Copy, Debug)]
pub struct State<R> {
    /// Speed of the crank \[rad/s\].
    pub omega: R,
    /// Acceleration of the crank \[rad/s²\].
    pub epsilon: R,
    /// Torque of the motor at its own shaft \[N m\].
    pub motor_torque: R,
    /// Torque of the motor at the crank, through the gearbox \[N m\].
    pub drive_torque: R,
    /// Load torque at the crank \[N m\].
    pub load_torque: R,
    /// Reduced inertia \[kg m²\].
    pub J: R,
}

impl<R: Real> Machine<'_, R> {
    /// The machine at (φ, u).
    #[inline(always)]
    pub fn state(&self, phi: R, u: R, m: &mut Motion<R>) -> State<R> {
        self.state_at_end(&self.advance(phi, u, R::splat(0.0), m))
    }

    /// The machine at the end of a step.
    #[inline(always)]
    pub fn state_at_end(&self, (step, geometry): &(Step<R>, Vec<LawGeometry<R>>)) -> State<R> {
        let row = &step.rows[S - 1];
        let omega = (step.end() * 2.0).sqrt();
        let [motor_torque, drive_torque, load_torque] = self.torques(step, geometry, S - 1);
        State {
            omega,
            epsilon: step.K[S - 1],
            motor_torque,
            drive_torque,
            load_torque,
            J: row.inverse.recip(),
        }
    }
}

impl<R: Real> Machine<'_, R> {
    /// The machine at an angle of its motion and u there.
    #[inline(always)]
    fn state_of(&self, phi: R, u: R, m: &mut Motion<R>) -> State<R> {
        let mut geometry = Vec::new();
        let row = self.row(phi, m, &mut geometry);
        let [motor_torque, drive_torque, load_torque] = self.torques_at(&row, &geometry, u);
        State {
            omega: (u * 2.0).sqrt(),
            epsilon: (drive_torque - load_torque) * row.inverse - row.drift * u,
            motor_torque,
            drive_torque,
            load_torque,
            J: row.inverse.recip(),
        }
    }
}

/// Curves over the revolution at given angles (from 0 to 2π): each list as long as `phi`.
#[derive(Clone, Debug, Default)]
pub struct Curves {
    pub time: Vec<f64>,
    pub omega: Vec<f64>,
    pub epsilon: Vec<f64>,
    pub motor_torque: Vec<f64>,
    pub drive_torque: Vec<f64>,
    pub load_torque: Vec<f64>,
    pub J: Vec<f64>,
}

impl Curves {
    /// With room for so many angles.
    fn with_room(n: usize) -> Self {
        let [time, omega, epsilon, motor_torque, drive_torque, load_torque, J] =
            [const { Vec::new() }; 7].map(|_: Vec<f64>| Vec::with_capacity(n));
        Curves { time, omega, epsilon, motor_torque, drive_torque, load_torque, J }
    }
}

/// Numbers that an angle is read from: the angle, its share of the step and the time at the start of that, and two series.
const NUMBERS: usize = 3 + 2 * TERMS;

/// Reads the solution at many angles, as many at once as there are lanes.
pub struct ReadCurves<'a> {
    /// The machine's structure.
    pub plan: &'a Plan,
    /// Its numbers.
    pub q: &'a [f64],
    /// The solution.
    pub marks: &'a [Mark],
    /// What lies between as series, where there are any.
    pub between: Option<&'a [Between<f64>]>,
    /// The angles \[rad\], in [0, 2π].
    pub phi: &'a [f64],
}

impl Job for ReadCurves<'_> {
    type Output = Curves;

    #[inline(always)]
    fn run<R: Real>(self) -> Curves {
        let q: Vec<R> = self.q.iter().map(|&x| R::splat(x)).collect();
        let machine = Machine::new(self.plan, &q).keeping_branch(self.plan.may_jump());
        let mut m = Motion::new(&self.plan.mechanism, &q);
        let mut curves = Curves::with_room(self.phi.len());
        let mut lanes = vec![0.0; R::LANES];
        let mut numbers = vec![0.0; NUMBERS * R::LANES];
        let mut places = Vec::with_capacity(R::LANES);
        let mut k = 0;
        for phis in self.phi.chunks(R::LANES) {
            poll();
            places.clear();
            for lane in 0..R::LANES {
                let phi = phis[lane.min(phis.len() - 1)];
                k = self.mark_before(phi, k);
                places.push((k, phi));
            }
            let (time, state) = match self.between {
                Some(series) => self.on_series(series, &machine, &places, &mut numbers, &mut m),
                None => self.by_steps(&machine, &places, &mut m),
            };
            let row = [
                (&mut curves.time, time),
                (&mut curves.omega, state.omega),
                (&mut curves.epsilon, state.epsilon),
                (&mut curves.motor_torque, state.motor_torque),
                (&mut curves.drive_torque, state.drive_torque),
                (&mut curves.load_torque, state.load_torque),
                (&mut curves.J, state.J),
            ];
            for (list, value) in row {
                value.store(&mut lanes);
                list.extend_from_slice(&lanes[..phis.len()]);
            }
        }
        curves
    }
}

impl ReadCurves<'_> {
    /// The curves. Not inlined: a kernel is long, and every crate that called it would compile its own.
    #[inline(never)]
    pub fn curves(self) -> Curves {
        in_lanes(self)
    }

    /// Time and state at angles, each behind its mark, by the series.
    #[inline(always)]
    fn on_series<R: Real>(
        &self,
        series: &[Between<f64>],
        machine: &Machine<'_, R>,
        places: &[(usize, f64)],
        numbers: &mut [f64],
        m: &mut Motion<R>,
    ) -> (R, State<R>) {
        for (lane, &(k, phi)) in places.iter().enumerate() {
            let (mark, series) = (&self.marks[k], &series[k]);
            numbers[lane] = phi;
            numbers[R::LANES + lane] = (phi - mark.phi) / mark.h;
            numbers[2 * R::LANES + lane] = mark.t;
            for i in 0..TERMS {
                numbers[(3 + i) * R::LANES + lane] = series.u[i];
                numbers[(3 + TERMS + i) * R::LANES + lane] = series.t[i];
            }
        }
        out_of_line!(R, {
            let load = |number: usize| R::load(&numbers[number * R::LANES..]);
            let (phi, share, start) = (load(0), load(1), load(2));
            let (mut u, mut t) = ([phi; TERMS], [phi; TERMS]);
            for i in 0..TERMS {
                (u[i], t[i]) = (load(3 + i), load(3 + TERMS + i));
            }
            let state = machine.state_of(phi, on_series(&u, share), m);
            (start + on_series(&t, share), state)
        })
    }

    /// The same by a step from each mark.
    #[inline(always)]
    fn by_steps<R: Real>(
        &self,
        machine: &Machine<'_, R>,
        places: &[(usize, f64)],
        m: &mut Motion<R>,
    ) -> (R, State<R>) {
        let mut from: [Vec<f64>; 5 + S] = std::array::from_fn(|_| vec![0.0; R::LANES]);
        for (lane, &(k, phi)) in places.iter().enumerate() {
            let mark = &self.marks[k];
            let values = [mark.phi, mark.u, phi - mark.phi, mark.t, mark.h];
            for (list, value) in from.iter_mut().zip(values.into_iter().chain(mark.X)) {
                list[lane] = value;
            }
        }
        let [phi, u, h, start, whole] = std::array::from_fn(|i| R::load(&from[i]));
        let mut samples = [u; N];
        for i in 0..S {
            samples[i + 1] = R::load(&from[5 + i]);
        }
        let X = stages_of_part(&through(&samples), R::splat(0.0), h / whole);
        let there = machine.advance_near(phi, u, h, X, m);
        let time = start + there.0.duration();
        let state = out_of_line!(R, machine.state_at_end(&there));
        (time, state)
    }

    /// Index of the last mark not after φ, looked for from a likely one on.
    fn mark_before(&self, phi: f64, from: usize) -> usize {
        let is_before = |k: usize| self.marks.get(k).is_some_and(|mark| mark.phi <= phi);
        let mut k = if is_before(from) { from } else { 0 };
        while is_before(k + 1) {
            k += 1;
        }
        k
    }
}
