//! A rotor and a slider-crank as models: closed forms, balance of energy, derivatives against differences, data that were changed.

use linkwright_core::drive::loads::{At, Body, Load, What};
use linkwright_core::drive::motor::{Drive, Motor};
use linkwright_core::kernel::formula::{Formula, Op, Variable};
use linkwright_core::linkage::dyads::SliderRod;
use linkwright_core::linkage::mechanism::{Element, GroundPoint};
use linkwright_core::plan::builder::Builder;
use linkwright_exchange::data::rigid;
use linkwright_exchange::{Data, Fault, Model, Parameter, Purpose};

const SUPPLY: u32 = 1 << 16;
const TORQUE: u32 = SUPPLY + 1;
const BRAKE: u32 = SUPPLY + 2;
const LOAD_SPEED: u32 = SUPPLY + 3;
const COUPLING: u32 = SUPPLY + 4;
const STIFF_TORQUE: u32 = 2 << 16;
const INERTIA: u32 = STIFF_TORQUE + 1;
const ANGLE: u32 = 3 << 16;
const SPEED: u32 = ANGLE + 1;
const ACCELERATION: u32 = (4 << 16) + 1;
const KINETIC: u32 = (6 << 16) + 5;
const COUPLED: u32 = (6 << 16) + 7;
const AT_REST: u32 = (6 << 16) + 16;
const SLIDE_SPEED: u32 = (9 << 16) + 1;

/// Inertia that turns with the crank \[kg m²\], torque of the motor at rest \[N m\] and its speed without load \[rad/s\].
const J: f64 = 2.0;
const M0: f64 = 30.0;
const W0: f64 = 50.0;

struct Parts {
    builder: Builder,
    q: Vec<f64>,
}

impl Parts {
    fn number(&mut self, x: f64) -> usize {
        self.q.push(x);
        self.builder.parameter()
    }
}

/// A crank with a flywheel and a motor whose torque falls in proportion to the speed; with a piston where it has a mass.
fn data(piston: Option<f64>) -> Data {
    machine(piston, None)
}

/// The same with a torque that grows in proportion to time, if it does.
fn machine(piston: Option<f64>, growth: Option<f64>) -> Data {
    let mut parts = Parts { builder: Builder::new(0), q: Vec::new() };
    let (x, y) = (parts.number(0.0), parts.number(0.0));
    parts.builder.fixed(GroundPoint { point: 0, x, y }).expect("a point");
    let [radius, cos, sin] = [0.1, 1.0, 0.0].map(|x| parts.number(x));
    let crank = Element::Crank { pin: 1, link: 0, pivot: 0, radius, cos, sin };
    parts.builder.element(crank).expect("a crank");
    if let Some(mass) = piston {
        let [rod, inverse_rod, offset, cos, sin, sign] =
            [0.4, 2.5, 0.0, 1.0, 0.0, 1.0].map(|x| parts.number(x));
        let rod = SliderRod {
            point: 2,
            link: 1,
            slide: 0,
            gap: 0,
            pin: 1,
            through: 0,
            rod,
            inverse_rod,
            offset,
            cos,
            sin,
            sign,
        };
        parts.builder.element(Element::SliderRod(rod)).expect("a rod");
        let mass = parts.number(mass);
        parts.builder.body(Body::Point { point: 2, mass }).expect("a piston");
        let size = parts.number(20.0);
        let load = Load { at: At::Slide { slide: 0, point: 2 }, what: What::Dry { size } };
        parts.builder.load(load).expect("a load");
    }
    if let Some(growth) = growth {
        let ops = vec![Op::Number(parts.number(growth)), Op::Variable(Variable::Time), Op::Mul];
        let formula = parts.builder.formula(Formula::new(ops).expect("a formula")).expect("its number");
        let load = Load { at: At::Crank, what: What::Formula { formula, turns: 1 } };
        parts.builder.load(load).expect("a load");
    }
    let [torque, inverse_speed, ratio, forward, reverse, inertia, speed_start] =
        [M0, 1.0 / W0, 1.0, 1.0, 1.0, J, W0].map(|x| parts.number(x));
    let motor = Motor::Line { torque, inverse_speed };
    let drive = Drive { motor, ratio, forward, reverse, inertia, speed_start, speed_loads: Vec::new() };
    Data {
        plan: parts.builder.into_plan(drive).expect("a plan"),
        q: parts.q,
        chain: rigid(),
        motor: 1.0,
        start: [0.3, 0.0],
        accuracy: 1e-11,
        parameters: vec![
            Parameter { value: M0, effects: vec![(torque, 1.0, 1.0)] },
            Parameter { value: J, effects: vec![(inertia, 1.0, 1.0)] },
        ],
        brake: 0,
        scales: Vec::new(),
        ranges: vec![(BRAKE, 0.0, 1e9), (STIFF_TORQUE, 1e-9, 1e9)],
        token: "{rotor}".to_owned(),
    }
}

fn begun(data: Data, purpose: Purpose) -> Model {
    let mut model = Model::new(data, purpose);
    model.begin();
    model
}

fn number(model: &mut Model, reference: u32) -> f64 {
    model.number(reference).expect("a number")
}

fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance * (1.0 + expected.abs()), "{found} against {expected}");
}

/// A rotor with a motor of a straight characteristic approaches its speed with exp(−M₀ t/(J ω₀)), in steps of any length.
#[test]
fn a_run_up_is_the_exponential_whatever_the_steps() {
    for steps in [1, 7, 400] {
        let mut model = begun(data(None), Purpose::Stepping);
        let until = 4.0;
        for step in 1..=steps {
            model.step(until * f64::from(step) / f64::from(steps)).expect("a step");
        }
        let (rate, decay) = (M0 / (J * W0), (-M0 / (J * W0) * until).exp());
        close(number(&mut model, SPEED), W0 * (1.0 - decay), 1e-10);
        close(number(&mut model, ANGLE), 0.3 + W0 * (until - (1.0 - decay) / rate), 1e-10);
        close(number(&mut model, ACCELERATION), W0 * rate * decay, 1e-9);
    }
}

/// With the supply off a brake stops the rotor after J ω/M, holds it against a smaller torque, and lets a larger one through.
#[test]
fn a_brake_stops_and_holds() {
    let mut start = data(None);
    start.start[1] = 10.0;
    let mut model = begun(start, Purpose::Stepping);
    model.set_truth(SUPPLY, false).expect("an input");
    model.set_number(BRAKE, 40.0).expect("an input");
    model.step(0.4).expect("a step");
    close(number(&mut model, SPEED), 10.0 - 40.0 / J * 0.4, 1e-10);
    model.step(1.0).expect("a step");
    close(number(&mut model, ANGLE), 0.3 + 0.5 * 100.0 * J / 40.0, 1e-10);
    assert_eq!(number(&mut model, SPEED), 0.0);
    assert!(model.truth(AT_REST).expect("an output"));
    model.set_number(TORQUE, -39.0).expect("an input");
    model.step(2.0).expect("a step");
    assert_eq!(number(&mut model, SPEED), 0.0, "held against a smaller torque");
    model.set_number(TORQUE, -44.0).expect("an input");
    model.step(3.0).expect("a step");
    close(number(&mut model, SPEED), -4.0 / J, 1e-10);
}

/// A load at a constant speed takes a rotor without supply along: ω = ω_L (1 − exp(−c t/J)), whatever the steps; however stiff the
/// coupling, in few steps.
#[test]
fn a_load_takes_the_rotor_along() {
    for (coupling, steps) in [(3.0, 1), (3.0, 40), (3e6, 1)] {
        let mut model = begun(data(None), Purpose::Stepping);
        model.set_truth(SUPPLY, false).expect("an input");
        model.set_number(LOAD_SPEED, -8.0).expect("an input");
        model.set_number(COUPLING, coupling).expect("a parameter");
        let (rate, until) = (coupling / J, 2.0);
        for step in 1..=steps {
            model.step(until * f64::from(step) / f64::from(steps)).expect("a step");
        }
        let decay = (-rate * until).exp();
        close(number(&mut model, SPEED), -8.0 * (1.0 - decay), 1e-10);
        close(number(&mut model, ANGLE), 0.3 - 8.0 * (until - (1.0 - decay) / rate), 1e-9);
        close(number(&mut model, COUPLED), -8.0 * coupling * decay, 1e-9 * (1.0 + coupling));
    }
}

/// A torque c t takes a rotor on from its brake at t = M/c, whatever the steps; then ω = c (t − M/c)²/(2 J).
#[test]
fn a_torque_over_time_takes_on_what_is_held() {
    for steps in [1, 3, 50] {
        let mut model = begun(machine(None, Some(100.0)), Purpose::Stepping);
        model.set_truth(SUPPLY, false).expect("an input");
        model.set_number(BRAKE, 40.0).expect("an input");
        for step in 1..=steps {
            model.step(f64::from(step) / f64::from(steps)).expect("a step");
        }
        close(number(&mut model, SPEED), 100.0 * 0.36 / (2.0 * J), 1e-9);
    }
    let mut model = Model::new(machine(None, Some(100.0)), Purpose::Exchange);
    model.set_truth(SUPPLY, false).expect("an input");
    model.set_number(BRAKE, 40.0).expect("an input");
    model.begin();
    for (time, is_held) in [(0.2, true), (0.399_999, true), (0.400_001, false)] {
        model.set_time(time);
        let lowest = model.indicators().expect("indicators").into_iter().fold(f64::INFINITY, f64::min);
        assert_eq!(lowest > 0.0, is_held, "{time}");
    }
    model.update().expect("an update");
    assert!(!model.truth(AT_REST).expect("an output"));
}

/// The energy of a slider-crank with the supply off falls by the work of the dry load on its piston alone: F per metre of its way.
#[test]
fn energy_is_lost_to_the_dry_load_alone() {
    let mut start = data(Some(3.0));
    start.start[1] = 20.0;
    let mut model = begun(start, Purpose::Stepping);
    model.set_truth(SUPPLY, false).expect("an input");
    let before = number(&mut model, KINETIC);
    let x = |phi: f64| 0.1 * phi.cos() + (0.16 - (0.1 * phi.sin()).powi(2)).sqrt();
    model.step(0.1).expect("a step");
    let phi = number(&mut model, ANGLE);
    assert!(phi > 1.0 && phi < 3.0, "no dead centre on the way: {phi}");
    close(before - number(&mut model, KINETIC), 20.0 * (x(0.3) - x(phi)), 1e-10);
}

/// A number out of its range, or none, is refused with the range, and what was set before stays.
#[test]
fn numbers_out_of_range_are_refused() {
    let mut model = begun(data(None), Purpose::Stepping);
    let wrong = [
        (BRAKE, -1.0),
        (STIFF_TORQUE, 0.0),
        (STIFF_TORQUE, 2e9),
        (TORQUE, f64::NAN),
        (INERTIA, f64::INFINITY),
    ];
    for (reference, value) in wrong {
        let before = number(&mut model, reference);
        let fault = model.set_number(reference, value).expect_err("out of range");
        assert!(matches!(fault, Fault::Value { .. }), "{fault}");
        assert_eq!(number(&mut model, reference), before);
    }
    model.set_number(STIFF_TORQUE, 1e-9).expect("the end of the range");
}

/// Derivatives by states, inputs and parameters are those of differences of order 4.
#[test]
fn derivatives_are_those_of_differences() {
    let mut start = data(Some(3.0));
    start.start = [0.7, 11.0];
    let mut model = begun(start, Purpose::Exchange);
    model.set_number(LOAD_SPEED, 14.0).expect("an input");
    model.set_number(COUPLING, 5.0).expect("an input");
    for known in [ANGLE, SPEED, TORQUE, BRAKE, LOAD_SPEED, COUPLING, STIFF_TORQUE, INERTIA] {
        let unknowns = [ACCELERATION, SLIDE_SPEED, KINETIC, COUPLED];
        let exact = model.derivative(&unknowns, &[known], &[1.0]).expect("derivatives");
        let mut other = begun(data(Some(3.0)), Purpose::Exchange);
        other.restore(model.saved(), false).expect("the state");
        let (at, h) = (number(&mut other, known), 1e-3);
        let mut values = |by: f64| {
            // A brake that pulls is no input: its derivative is taken ahead.
            let by = if known == BRAKE { by + 2.0 * h } else { by };
            other.set_number(known, at + by).expect("a value");
            unknowns.map(|unknown| number(&mut other, unknown))
        };
        let [a, b, c, d] = [-2.0 * h, -h, h, 2.0 * h].map(&mut values);
        for n in 0..unknowns.len() {
            let difference = (a[n] - 8.0 * b[n] + 8.0 * c[n] - d[n]) / (12.0 * h);
            close(exact[n], difference, 1e-9);
        }
    }
}

/// A state that was saved, as bytes too, leads to the same motion to the last bit.
#[test]
fn a_restored_state_goes_on_as_it_did() {
    let mut model = begun(data(Some(3.0)), Purpose::Stepping);
    model.step(0.37).expect("a step");
    let bytes = Model::to_bytes(&model.saved()).expect("bytes");
    let on = |model: &mut Model| {
        model.set_number(BRAKE, 3.0).expect("an input");
        model.step(0.9).expect("a step");
        [ANGLE, SPEED].map(|reference| number(model, reference).to_bits())
    };
    let first = on(&mut model);
    let mut other = begun(data(Some(3.0)), Purpose::Stepping);
    other.restore(Model::from_bytes(&bytes).expect("a state"), true).expect("a state of this machine");
    assert_eq!(on(&mut other), first);
}

/// Indicators are positive between events; where the rotor has come to rest under its brake an event takes its speed away.
#[test]
fn another_solver_is_told_of_rest() {
    let mut start = data(None);
    start.start[1] = 10.0;
    let mut model = Model::new(start, Purpose::Exchange);
    model.set_truth(SUPPLY, false).expect("an input");
    model.set_number(BRAKE, 40.0).expect("an input");
    model.begin();
    assert!(model.indicators().expect("indicators").iter().all(|&z| z > 0.0));
    model.set_continuous(&[2.0, -1e-6]).expect("a state");
    assert!(model.indicators().expect("indicators").iter().any(|&z| z < 0.0));
    assert!(model.update().expect("an update"), "the speed has changed");
    assert_eq!(model.continuous(), [2.0, 0.0]);
    assert_eq!(model.rates().expect("rates"), [0.0, 0.0]);
    model.set_number(TORQUE, 50.0).expect("an input");
    assert!(model.indicators().expect("indicators").iter().any(|&z| z < 0.0), "it is taken on");
    model.update().expect("an update");
    close(model.rates().expect("rates")[1], 10.0 / J, 1e-14);
}

/// A rotor that nothing drives is held, with an indicator above zero, so that a solver sees the first torque change its sign.
#[test]
fn what_nothing_drives_waits_for_the_first_torque() {
    let mut model = Model::new(data(None), Purpose::Exchange);
    model.set_truth(SUPPLY, false).expect("an input");
    model.begin();
    assert!(model.truth(AT_REST).expect("an output"));
    assert!(model.indicators().expect("indicators").iter().all(|&z| z > 0.0));
    model.set_number(TORQUE, 1e-3).expect("an input");
    assert!(model.indicators().expect("indicators").iter().any(|&z| z < 0.0));
}

/// Data survive the way through bytes; a bit that was changed, another format, or a short file are refused.
#[test]
fn data_that_were_changed_are_refused() {
    let bytes = data(Some(3.0)).to_bytes().expect("bytes");
    let again = Data::from_bytes(&bytes).expect("a machine");
    assert_eq!(again.to_bytes().expect("bytes"), bytes);
    for place in [16, bytes.len() / 2, bytes.len() - 1] {
        let mut wrong = bytes.clone();
        wrong[place] ^= 1;
        assert!(matches!(Data::from_bytes(&wrong), Err(Fault::Damaged(_))), "bit at {place}");
    }
    let mut other = bytes.clone();
    other[4] ^= 1;
    assert!(matches!(Data::from_bytes(&other), Err(Fault::Version { .. })));
    for length in [0, 3, 15, bytes.len() - 1] {
        assert!(matches!(Data::from_bytes(&bytes[..length]), Err(Fault::Damaged(_))), "length {length}");
    }
}
