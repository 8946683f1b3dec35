//! A plan is put together from what exists: the builder refuses everything else where it is added, and stays as it was.

use linkwright_core::drive::loads::{At, Body, Load, What};
use linkwright_core::drive::motor::{Drive, Motor};
use linkwright_core::kernel::error::PlanError;
use linkwright_core::kernel::formula::{Formula, Op, Variable};
use linkwright_core::kernel::table::Table;
use linkwright_core::linkage::coupled::{AngleOf, Runner, Source, Sum, Turn};
use linkwright_core::linkage::dyads::Rocker;
use linkwright_core::linkage::folding::{ChangePoint, Folding};
use linkwright_core::linkage::group::{Condition, Group};
use linkwright_core::linkage::guided::Line;
use linkwright_core::linkage::mechanism::{Element, GroundPoint};
use linkwright_core::plan::builder::{Builder, FRAME};

const DRIVE: Drive = Drive {
    motor: Motor::Off,
    ratio: 0,
    forward: 0,
    reverse: 0,
    inertia: 0,
    speed_start: 0,
    speed_loads: Vec::new(),
};

fn crank(pin: usize, link: usize, pivot: usize) -> Element {
    Element::Crank { pin, link, pivot, radius: 0, cos: 1, sin: 2 }
}

fn rocker(joint: usize, links: [usize; 2], pin: usize, pivot: usize) -> Rocker {
    let [coupler_link, rocker_link] = links;
    Rocker {
        joint,
        coupler_link,
        rocker_link,
        gap: 0,
        pin,
        pivot,
        coupler: 0,
        rocker: 0,
        inverse_coupler: 0,
        inverse_rocker: 0,
        sign: 0,
    }
}

/// Two fixed points, 0 and 1, and a crank on the first with pin 2 and link 0; parameters 0 to 3.
fn started() -> Builder {
    let mut b = Builder::new(4);
    for point in [0, 1] {
        b.fixed(GroundPoint { point, x: 0, y: 0 }).expect("the next point");
    }
    b.element(crank(2, 0, 0)).expect("a crank on a fixed point");
    b
}

fn inner(error: PlanError) -> PlanError {
    match error {
        PlanError::In { error, .. } => *error,
        other => other,
    }
}

fn refused(element: Element) -> PlanError {
    let mut b = started();
    let error = inner(b.element(element).expect_err("nonsense"));
    assert_eq!(b.element(Element::Rocker(rocker(3, [1, 2], 2, 1))), Ok(1), "the plan is as it was");
    error
}

#[test]
fn what_is_used_was_made_before() {
    let missing = |what, value, made| PlanError::Missing { what, value, made };
    assert_eq!(refused(crank(3, 1, 3)), missing("point", 3, 3), "a crank on its own pin");
    assert_eq!(refused(Element::Rocker(rocker(3, [1, 2], 2, 9))), missing("point", 9, 3));
    let far = Element::RigidPoint { point: 3, link: 1, origin: 0, along: 0, across: 0 };
    assert_eq!(refused(far), missing("link", 1, 1));
    let number = Element::RigidPoint { point: 3, link: 0, origin: 0, along: 0, across: 4 };
    assert_eq!(refused(number), missing("parameter", 4, 4));
    let terms = vec![(Source::Drive, 0), (Source::Slide(0), 0)];
    let turn = Turn { link: 1, slide: 0, angle: Sum { start: 0, terms } };
    assert_eq!(refused(Element::Turn(turn)), missing("slide", 0, 0), "an angle that hangs on itself");
    let angle = AngleOf { link: 7, slide: 0, winding: 0, centre: 0 };
    assert_eq!(refused(Element::AngleOf(angle)), missing("link", 7, 1));
}

#[test]
fn what_is_made_is_the_next() {
    let order = |what, value, next| PlanError::Order { what, value, next };
    assert_eq!(refused(crank(2, 1, 0)), order("point", 2, 3), "made twice");
    assert_eq!(refused(crank(usize::MAX, 1, 0)), order("point", usize::MAX, 3), "no room for all between");
    assert_eq!(refused(crank(3, 2, 0)), order("link", 2, 1));
    let dyad = Rocker { gap: 1, ..rocker(3, [1, 2], 2, 1) };
    assert_eq!(refused(Element::Rocker(dyad)), order("dyad", 1, 0));
    let mut b = started();
    let error = b.element(crank(9, 1, 0)).expect_err("a gap");
    assert_eq!(error.to_string(), "element 1, a crank: point 9 is made where point 3 is the next");
}

#[test]
fn lists_have_their_length() {
    let length = |what, found, expected| PlanError::Length { what, found, expected };
    let knot = Table::new(&[0.0], &[0.0]).expect("one knot");
    let group = Group {
        unknowns: vec![3],
        bar_points: Vec::new(),
        bars: Vec::new(),
        conditions: vec![Condition::Distance { from: 2, to: 3, length: 0 }; 2],
        gap: 0,
        starts: vec![knot],
        inverse_turns: 0,
        repeats: true,
    };
    assert_eq!(refused(Element::Group(group.clone())), length("starts of a group", 1, 2));
    let starts = [group.starts.clone(), group.starts.clone()].concat();
    let loose = Group { conditions: Vec::new(), starts, ..group };
    assert_eq!(refused(Element::Group(loose)), length("conditions of a group", 0, 2));
    let change_points = vec![ChangePoint { series: vec![0], ..ChangePoint::stored(0, false) }];
    let folding = Folding { rocker: rocker(3, [1, 2], 2, 1), change_points };
    // Its numbers are beyond the list before its series is looked at.
    assert_eq!(
        inner(refused(Element::Folding(folding))),
        PlanError::Missing { what: "parameter", value: 4, made: 4 }
    );
}

#[test]
fn a_line_on_the_frame_is_on_the_link_after_the_last() {
    let mut b = started();
    let line = Line { through: 0, link: FRAME, cos: 0, sin: 0, offset: 0 };
    let place = Sum { start: 0, terms: vec![(Source::Drive, 0)] };
    b.element(Element::Runner(Runner { point: 3, slide: 0, line, place })).expect("a linear driver");
    b.element(crank(4, 1, 0)).expect("another crank");
    let plan = b.into_plan(DRIVE).expect("a sound drive");
    let Element::Runner(runner) = &plan.mechanism.elements[1] else { panic!("no runner") };
    assert_eq!((runner.line.link, plan.mechanism.n_links), (2, 2));
}

#[test]
fn bodies_loads_and_drive_hang_on_what_exists() {
    let mut b = started();
    let missing = |what, value, made| Err(PlanError::Missing { what, value, made });
    assert_eq!(b.body(Body::Point { point: 3, mass: 0 }), missing("point", 3, 3));
    let (dry, viscous) = (What::Dry { size: 0 }, What::Viscous { damping: 4 });
    let mut load = |at, what| b.load(Load { at, what });
    assert_eq!(load(At::Slide { slide: 0, point: 0 }, dry), missing("slide", 0, 0));
    assert_eq!(load(At::Point { point: 2 }, viscous), missing("parameter", 4, 4));
    assert_eq!(load(At::Crank, What::OverAngle { table: 0, turns: 1 }), missing("table", 0, 0));
    assert_eq!(
        load(At::BetweenLinks { link: 0, other: Some(1), cos: 0, sin: 0 }, dry),
        missing("link", 1, 1)
    );
    assert_eq!(load(At::Link { link: 0 }, What::Formula { formula: 0, turns: 1 }), missing("formula", 0, 0));
    let spring = What::Spring { stiffness: 0, free_length: 1, preload: 2 };
    assert_eq!(load(At::Point { point: 2 }, spring), Err(PlanError::Load), "a path has no position");
    assert_eq!(load(At::Bodies { cos: 0, sin: 1 }, dry), Err(PlanError::Load), "weight is constant");
    let far = Formula::new(vec![Op::Number(4)]).expect("one number");
    assert_eq!(b.formula(far).map(|_| ()), missing("parameter", 4, 4));
    let motor = Motor::Table { table: 0 };
    let error = b.into_plan(Drive { motor, ..DRIVE }).expect_err("no table");
    assert_eq!(error, PlanError::Missing { what: "table", value: 0, made: 0 });
}

/// Formulas of degree 0 and 1 belong to the reduction, others are laws.
#[test]
fn formulas_are_sorted_by_their_degree() {
    let mut b = started();
    let square = vec![Op::Variable(Variable::PsiDot), Op::Power(2)];
    for ops in [vec![Op::Variable(Variable::Psi)], vec![Op::Variable(Variable::PsiDot)], square] {
        let formula = b.formula(Formula::new(ops).expect("a formula")).expect("no parameters");
        let what = What::Formula { formula, turns: 1 };
        b.load(Load { at: At::Link { link: 0 }, what }).expect("on the crank");
    }
    let plan = b.into_plan(DRIVE).expect("a sound drive");
    assert_eq!([plan.loads.len(), plan.laws.len()], [2, 1], "the square of a speed is a law");
}

/// Loads over two and over three revolutions repeat together after six; a formula counts if it knows the angle.
#[test]
fn loads_repeat_together() {
    let mut b = started();
    let table = b.table(Table::new(&[0.0, 1.0], &[0.0, 1.0]).expect("a table"));
    let none = PlanError::Missing { what: "turn", value: 0, made: 1000 };
    let over_angle = |turns| Load { at: At::Crank, what: What::OverAngle { table, turns } };
    assert_eq!(b.load(over_angle(0)), Err(none));
    b.load(over_angle(2)).expect("two revolutions");
    for (variable, turns) in [(Variable::Phi, 3), (Variable::Psi, 5)] {
        let formula =
            b.formula(Formula::new(vec![Op::Variable(variable)]).expect("a variable")).expect("sound");
        let what = What::Formula { formula, turns };
        b.load(Load { at: At::Link { link: 0 }, what }).expect("on the crank");
    }
    let plan = b.into_plan(DRIVE).expect("a sound drive");
    assert_eq!(plan.turns, 6);
    assert_eq!(plan.over_turns(4).map(|plan| plan.turns), Ok(12));
    assert!(plan.over_turns(1001).is_err(), "too many");
}

/// What has a potential does no work over a closed cycle, and can be left off.
#[test]
fn loads_with_a_potential_are_told() {
    let mut b = started();
    let table = b.table(Table::new(&[0.0, 1.0], &[0.0, 1.0]).expect("a table"));
    let size = 0;
    let between = At::Between { from: 0, to: 2 };
    let between_links = At::BetweenLinks { link: 0, other: None, cos: 1, sin: 2 };
    let spring = What::Spring { stiffness: 0, free_length: 1, preload: 2 };
    let with = [
        (At::Bodies { cos: 0, sin: 1 }, What::Constant { size }),
        (At::Toward { point: 2, cos: 0, sin: 1 }, What::Constant { size }),
        (between, spring),
        (between, What::Curve { table }),
        (between, What::Gas { force: 0, length: 1, column: 2, exponent: 3 }),
        (between_links, spring),
    ];
    let without = [
        (At::Point { point: 2 }, What::Dry { size }),
        (At::Crank, What::OverAngle { table, turns: 1 }),
        (At::Link { link: 0 }, What::Constant { size }),
        (At::Along { point: 2, link: 0, cos: 0, sin: 1 }, What::Constant { size }),
        (between, What::Viscous { damping: 0 }),
    ];
    for (at, what) in with.into_iter().chain(without) {
        b.load(Load { at, what }).expect("a sound load");
    }
    let rest = b.into_plan(DRIVE).expect("a sound drive").without_conservative();
    assert_eq!(rest.loads.iter().map(|load| load.at).collect::<Vec<_>>(), without.map(|(at, _)| at));
}
