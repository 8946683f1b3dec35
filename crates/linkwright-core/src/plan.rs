//! A machine's structure as it crosses the border: small integer tables, decoded and checked once.
//!
//! A plan says *what* is there and in which slot of the parameter list each number is found; the numbers
//! come separately, so that a batch of machines shares one plan. The rows are described at each `decode_*`.

use crate::drive::loads::{Body, Carrier, ForceElement, FormulaLoad, Law, Load};
use crate::drive::motor::{Drive, Motor, Span};
use crate::drive::structure::Plan;
use crate::kernel::error::PlanError;
use crate::kernel::formula::{Degree, Formula, Op, Variable};
use crate::kernel::motion_law::MotionLaw;
use crate::kernel::slot::Slot;
use crate::kernel::table::Table;
use crate::linkage::arm::{self, Arm};
use crate::linkage::coupled::{self, AngleOf, Programme, Runner, Source, Sum, Turn};
use crate::linkage::dyads::{Rocker, SliderRod};
use crate::linkage::folding::{ChangePoint, Folding, FoldingRod, TERMS};
use crate::linkage::group::{Bar, Carried, Condition, Group};
use crate::linkage::guided::{Crossing, GuidedRod, Line, SlottedLever};
use crate::linkage::mechanism::{Element, Fixed, Mechanism};

/// Number of the language in which machines, cams and trains cross the border: kinds of rows, order of lists and of
/// results. It goes up with every change of these, here and in `linkwright.kernel.core.core_format`.
pub const FORMAT: u32 = 12;

/// The integer tables of a plan, row by row, and the knots of its tables end to end.
#[derive(Clone, Copy, Debug)]
pub struct Encoded<'a> {
    /// Numbers of parameters, points, links, slides and dyads.
    pub sizes: &'a [i32],
    /// Rows of kind, number of entries, entries.
    pub elements: &'a [i32],
    /// Rows of 8.
    pub bodies: &'a [i32],
    /// Rows of 8.
    pub loads: &'a [i32],
    /// Motor kind, four slots, five slots of the drive line, then rows of 6 for the spans of the curve.
    pub drive: &'a [i32],
    /// Start of each table in the knots, and the end of the last.
    pub table_starts: &'a [i32],
    pub table_x: &'a [f64],
    pub table_y: &'a [f64],
    /// Formulas end to end, each with its number of instructions in front.
    pub formulas: &'a [i32],
    /// Motion laws end to end, as [`MotionLaw::decode`] reads them.
    pub motion_laws: &'a [f64],
}

const ROW_WIDTH: usize = 8;
const SPAN_WIDTH: usize = 6;
const DRIVE_HEAD: usize = 10;

/// Bounds that every index of a plan is checked against.
struct Bounds {
    parameters: usize,
    points: usize,
    links: usize,
    slides: usize,
    gaps: usize,
    tables: usize,
    formulas: usize,
    motion_laws: usize,
}

fn index(value: i32, bound: usize, what: &'static str) -> Result<usize, PlanError> {
    usize::try_from(value).ok().filter(|&i| i < bound).ok_or(PlanError::Index { what, value, bound })
}

impl Bounds {
    fn slot(&self, value: i32) -> Result<usize, PlanError> {
        index(value, self.parameters, "parameter")
    }
    fn point(&self, value: i32) -> Result<usize, PlanError> {
        index(value, self.points, "point")
    }
    fn link(&self, value: i32) -> Result<usize, PlanError> {
        index(value, self.links, "link")
    }
    fn slide(&self, value: i32) -> Result<usize, PlanError> {
        index(value, self.slides, "slide")
    }
    fn gap(&self, value: i32) -> Result<usize, PlanError> {
        index(value, self.gaps, "dyad")
    }
    fn table(&self, value: i32) -> Result<usize, PlanError> {
        index(value, self.tables, "table")
    }
    fn formula(&self, value: i32) -> Result<usize, PlanError> {
        index(value, self.formulas, "formula")
    }
    fn motion_law(&self, value: i32) -> Result<usize, PlanError> {
        index(value, self.motion_laws, "motion law")
    }
    /// A link, or −1 for the frame.
    fn link_or_frame(&self, value: i32) -> Result<Option<usize>, PlanError> {
        if value == -1 { Ok(None) } else { self.link(value).map(Some) }
    }
}

impl Plan {
    /// Decodes and checks every index.
    ///
    /// # Errors
    /// [`PlanError`] names the first row that does not make sense.
    pub fn decode(code: &Encoded<'_>) -> Result<Plan, PlanError> {
        let &[parameters, points, links, slides, gaps] = code.sizes else {
            return Err(PlanError::Length { what: "sizes", found: code.sizes.len(), expected: 5 });
        };
        let tables = decode_tables(code)?;
        let size = |value, what| index(value, i32::MAX as usize, what);
        let parameters = size(parameters, "parameter")?;
        let formulas = decode_formulas(code.formulas, parameters)?;
        let motion_laws = decode_motion_laws(code.motion_laws)?;
        let bounds = Bounds {
            parameters,
            points: size(points, "point")?,
            links: size(links, "link")?,
            slides: size(slides, "slide")?,
            gaps: size(gaps, "dyad")?,
            tables: tables.len(),
            formulas: formulas.len(),
            motion_laws: motion_laws.len(),
        };
        let known = Known { tables: &tables, formulas: &formulas, motion_laws: &motion_laws };
        let (mut ground, mut elements) = (Vec::new(), Vec::new());
        let mut rest = code.elements;
        while !rest.is_empty() {
            let mut row = Row::first_of(&mut rest, &bounds, &known)?;
            match row.kind {
                FIXED_POINT => ground.push(row.fixed()?),
                _ => elements.push(row.element()?),
            }
        }
        let bodies = rows(code.bodies, ROW_WIDTH, "bodies")?
            .map(|row| decode_body(row, &bounds))
            .collect::<Result<_, _>>()?;
        let (mut loads, mut force_elements, mut speed_loads, mut laws) =
            (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for row in rows(code.loads, ROW_WIDTH, "loads")? {
            match row[0] {
                LOAD_TORQUE_SPEED => speed_loads.push(bounds.table(row[1])?),
                LOAD_FORCE_ELEMENT..LOAD_DAMPER_TABLE => {
                    force_elements.push(decode_force_element(row, &bounds)?)
                }
                LOAD_DAMPER_TABLE => laws.push(decode_damper(row, &bounds)?),
                LOAD_FORMULA.. => {
                    let load = decode_formula_load(row, &bounds)?;
                    match formulas[load.formula].degree {
                        Degree::Any | Degree::Of(0) => force_elements.push(ForceElement::Formula(load)),
                        Degree::Of(1) => force_elements.push(ForceElement::ViscousFormula(load)),
                        _ => laws.push(Law::Formula(load)),
                    }
                }
                _ => loads.push(decode_load(row, &bounds)?),
            }
        }
        Ok(Plan {
            mechanism: Mechanism {
                ground,
                elements,
                n_points: bounds.points,
                n_links: bounds.links,
                n_slides: bounds.slides,
                n_gaps: bounds.gaps,
            },
            bodies,
            loads,
            force_elements,
            drive: decode_drive(code.drive, speed_loads, &bounds)?,
            tables,
            formulas,
            laws,
            n_parameters: bounds.parameters,
        })
    }
}

/// A point of the ground does not move: it is put in place once.
const FIXED_POINT: i32 = 0;

/// A load that depends on speed alone belongs to the drive, not to the reduction.
const LOAD_TORQUE_SPEED: i32 = 12;

/// The first of the force elements.
const LOAD_FORCE_ELEMENT: i32 = 14;

/// A damper by a table is a law of its own.
const LOAD_DAMPER_TABLE: i32 = 20;

/// The first of the loads by a formula, whose degree says where they belong.
const LOAD_FORMULA: i32 = 21;

fn rows<'a>(
    flat: &'a [i32],
    width: usize,
    what: &'static str,
) -> Result<std::slice::ChunksExact<'a, i32>, PlanError> {
    let rows = flat.chunks_exact(width);
    if rows.remainder().is_empty() {
        Ok(rows)
    } else {
        Err(PlanError::Length { what, found: flat.len(), expected: flat.len().next_multiple_of(width) })
    }
}

fn decode_tables(code: &Encoded<'_>) -> Result<Vec<Table>, PlanError> {
    let starts: Vec<usize> = code
        .table_starts
        .iter()
        .map(|&start| index(start, code.table_x.len() + 1, "table start"))
        .collect::<Result<_, _>>()?;
    let table = |(number, range): (usize, &[usize])| {
        let (x, y) = (code.table_x.get(range[0]..range[1]), code.table_y.get(range[0]..range[1]));
        x.zip(y).and_then(|(x, y)| Table::new(x, y)).ok_or(PlanError::Table { number })
    };
    starts.windows(2).enumerate().map(table).collect()
}

/// One row of the elements, read from left to right.
struct Row<'a> {
    kind: i32,
    rest: &'a [i32],
    bounds: &'a Bounds,
    known: &'a Known<'a>,
}

/// What rows refer to by number and take along.
struct Known<'a> {
    tables: &'a [Table],
    formulas: &'a [Formula],
    motion_laws: &'a [MotionLaw],
}

impl<'a> Row<'a> {
    /// Takes the first row off a list.
    fn first_of(list: &mut &'a [i32], bounds: &'a Bounds, known: &'a Known<'a>) -> Result<Self, PlanError> {
        let short = |found, expected| PlanError::Length { what: "elements", found, expected };
        let &[kind, length, ref rest @ ..] = *list else {
            return Err(short(list.len(), 2));
        };
        let length = index(length, i32::MAX as usize, "length of a row")?;
        let row = rest.get(..length).ok_or_else(|| short(rest.len(), length))?;
        *list = &rest[length..];
        Ok(Row { kind, rest: row, bounds, known })
    }

    fn next(&mut self) -> Result<i32, PlanError> {
        let (&first, rest) =
            self.rest.split_first().ok_or(PlanError::Length { what: "element", found: 0, expected: 1 })?;
        self.rest = rest;
        Ok(first)
    }

    fn point(&mut self) -> Result<usize, PlanError> {
        let value = self.next()?;
        self.bounds.point(value)
    }

    fn link(&mut self) -> Result<usize, PlanError> {
        let value = self.next()?;
        self.bounds.link(value)
    }

    fn slide(&mut self) -> Result<usize, PlanError> {
        let value = self.next()?;
        self.bounds.slide(value)
    }

    fn gap(&mut self) -> Result<usize, PlanError> {
        let value = self.next()?;
        self.bounds.gap(value)
    }

    fn slot(&mut self) -> Result<Slot, PlanError> {
        let value = self.next()?;
        self.bounds.slot(value)
    }

    fn table(&mut self) -> Result<Table, PlanError> {
        let value = self.next()?;
        Ok(self.known.tables[self.bounds.table(value)?].clone())
    }

    /// A list: how many, then each.
    fn list<T>(&mut self, each: impl Fn(&mut Self) -> Result<T, PlanError>) -> Result<Vec<T>, PlanError> {
        let n = self.next()?;
        (0..n).map(|_| each(self)).collect()
    }

    /// `through link cos sin offset`; the frame is the link after the last.
    fn line(&mut self) -> Result<Line, PlanError> {
        let through = self.point()?;
        let link = self.next()?;
        let link = index(link, self.bounds.links + 1, "link")?;
        Ok(Line { through, link, cos: self.slot()?, sin: self.slot()?, offset: self.slot()? })
    }

    /// `start`, then a list of `source factor`; source −1 is the crank angle, another a slide.
    fn sum(&mut self) -> Result<Sum, PlanError> {
        let start = self.slot()?;
        let term = |row: &mut Self| {
            let source = match row.next()? {
                -1 => Source::Drive,
                slide => Source::Slide(row.bounds.slide(slide)?),
            };
            Ok((source, row.slot()?))
        };
        Ok(Sum { start, terms: self.list(term)? })
    }

    /// `joint coupler rocker gap pin pivot coupler rocker 1/coupler 1/rocker sign`
    fn rocker(&mut self) -> Result<Rocker, PlanError> {
        Ok(Rocker {
            joint: self.point()?,
            coupler_link: self.link()?,
            rocker_link: self.link()?,
            gap: self.gap()?,
            pin: self.point()?,
            pivot: self.point()?,
            coupler: self.slot()?,
            rocker: self.slot()?,
            inverse_coupler: self.slot()?,
            inverse_rocker: self.slot()?,
            sign: self.slot()?,
        })
    }

    /// `point link slide gap pin line rod 1/rod sign`
    fn guided_rod(&mut self) -> Result<GuidedRod, PlanError> {
        Ok(GuidedRod {
            point: self.point()?,
            link: self.link()?,
            slide: self.slide()?,
            gap: self.gap()?,
            pin: self.point()?,
            line: self.line()?,
            rod: self.slot()?,
            inverse_rod: self.slot()?,
            sign: self.slot()?,
        })
    }

    /// `cos sin half_cos half_sin reach`, then the coefficients of the series, and a list of none or one pair of arms
    fn change_point(&mut self) -> Result<ChangePoint, PlanError> {
        Ok(ChangePoint {
            cos: self.slot()?,
            sin: self.slot()?,
            half_cos: self.slot()?,
            half_sin: self.slot()?,
            reach: self.slot()?,
            series: self.slots(TERMS)?,
            arms: self.list(|row| Ok([row.arm()?, row.arm()?]))?,
        })
    }

    /// `1/width reach`, then the coefficients of x and of y
    fn arm(&mut self) -> Result<Arm, PlanError> {
        Ok(Arm {
            inverse_width: self.slot()?,
            reach: self.slot()?,
            x: self.slots(arm::TERMS)?,
            y: self.slots(arm::TERMS)?,
        })
    }

    fn slots(&mut self, n: usize) -> Result<Vec<Slot>, PlanError> {
        (0..n).map(|_| self.slot()).collect()
    }

    /// `link from to 1/length`
    fn bar(&mut self) -> Result<Bar, PlanError> {
        Ok(Bar { link: self.link()?, from: self.point()?, to: self.point()?, inverse_length: self.slot()? })
    }

    /// `point from to along across`
    fn carried(&mut self) -> Result<Carried, PlanError> {
        Ok(Carried {
            point: self.point()?,
            from: self.point()?,
            to: self.point()?,
            along: self.slot()?,
            across: self.slot()?,
        })
    }

    /// `0 from to length` · `1 point line slide` · `2 point line slide bar`
    fn condition(&mut self) -> Result<Condition, PlanError> {
        Ok(match self.next()? {
            0 => Condition::Distance { from: self.point()?, to: self.point()?, length: self.slot()? },
            1 => Condition::OnLine { point: self.point()?, line: self.line()?, slide: self.slide()? },
            2 => Condition::OnBar {
                point: self.point()?,
                line: self.line()?,
                slide: self.slide()?,
                bar: self.bar()?,
            },
            kind => return Err(PlanError::Kind { what: "condition", kind }),
        })
    }

    /// `gap 1/turns repeats`, then lists of `unknown`, of `table` (x and y of each unknown), of carried
    /// points, of bars, of conditions
    fn group(&mut self) -> Result<Group, PlanError> {
        let (gap, inverse_turns, repeats) = (self.gap()?, self.slot()?, self.next()? != 0);
        let unknowns = self.list(Row::point)?;
        let starts = self.list(Row::table)?;
        let carried = self.list(Row::carried)?;
        let bars = self.list(Row::bar)?;
        let conditions = self.list(Row::condition)?;
        for (what, found) in
            [("starts of a group", starts.len()), ("conditions of a group", conditions.len())]
        {
            if found != 2 * unknowns.len() {
                return Err(PlanError::Length { what, found, expected: 2 * unknowns.len() });
            }
        }
        Ok(Group { unknowns, carried, bars, conditions, gap, starts, inverse_turns, repeats })
    }

    /// `0 fixed: point x y`
    fn fixed(&mut self) -> Result<Fixed, PlanError> {
        Ok(Fixed { point: self.point()?, x: self.slot()?, y: self.slot()? })
    }

    /// `1 crank: pin link pivot radius cos sin` ·
    /// `2 slider: point link slide gap pin through rod 1/rod offset cos sin sign` · `3 rocker` ·
    /// `4 rigid point: point link origin along across` ·
    /// `5 guided rod` ·
    /// `6 slotted lever: link slide gap pin pivot offset sign` · `7 crossing: point slide slide gap line line` ·
    /// `8 turn: link slide sum` · `9 runner: point slide line sum` · `10 angle: link slide winding centre` ·
    /// `11 folding: rocker`, list of change points · `12 group` · `13 bar` ·
    /// `14 law: slide formula` · `15 folding rod: guided rod`, list of change points ·
    /// `16 programme: slide phase law`
    fn element(&mut self) -> Result<Element, PlanError> {
        Ok(match self.kind {
            1 => Element::Crank {
                pin: self.point()?,
                link: self.link()?,
                pivot: self.point()?,
                radius: self.slot()?,
                cos: self.slot()?,
                sin: self.slot()?,
            },
            2 => Element::SliderRod(SliderRod {
                point: self.point()?,
                link: self.link()?,
                slide: self.slide()?,
                gap: self.gap()?,
                pin: self.point()?,
                through: self.point()?,
                rod: self.slot()?,
                inverse_rod: self.slot()?,
                offset: self.slot()?,
                cos: self.slot()?,
                sin: self.slot()?,
                sign: self.slot()?,
            }),
            3 => Element::Rocker(self.rocker()?),
            4 => Element::RigidPoint {
                point: self.point()?,
                link: self.link()?,
                origin: self.point()?,
                along: self.slot()?,
                across: self.slot()?,
            },
            5 => Element::GuidedRod(self.guided_rod()?),
            6 => Element::SlottedLever(SlottedLever {
                link: self.link()?,
                slide: self.slide()?,
                gap: self.gap()?,
                pin: self.point()?,
                pivot: self.point()?,
                offset: self.slot()?,
                sign: self.slot()?,
            }),
            7 => Element::Crossing(Crossing {
                point: self.point()?,
                slides: [self.slide()?, self.slide()?],
                gap: self.gap()?,
                lines: [self.line()?, self.line()?],
            }),
            8 => Element::Turn(Turn { link: self.link()?, slide: self.slide()?, angle: self.sum()? }),
            9 => Element::Runner(Runner {
                point: self.point()?,
                slide: self.slide()?,
                line: self.line()?,
                place: self.sum()?,
            }),
            10 => Element::AngleOf(AngleOf {
                link: self.link()?,
                slide: self.slide()?,
                winding: self.slot()?,
                centre: self.slot()?,
            }),
            11 => Element::Folding(Folding {
                rocker: self.rocker()?,
                change_points: self.list(Row::change_point)?,
            }),
            15 => Element::FoldingRod(FoldingRod {
                rod: self.guided_rod()?,
                change_points: self.list(Row::change_point)?,
            }),
            12 => Element::Group(self.group()?),
            13 => Element::Bar(self.bar()?),
            14 => {
                let slide = self.slide()?;
                let formula = self.next()?;
                let formula = self.known.formulas[self.bounds.formula(formula)?].clone();
                Element::Law(coupled::Law { slide, formula })
            }
            16 => {
                let (slide, phase) = (self.slide()?, self.slot()?);
                let law = self.next()?;
                let law = self.known.motion_laws[self.bounds.motion_law(law)?].clone();
                Element::Programme(Programme { slide, phase, law })
            }
            kind => return Err(PlanError::Kind { what: "element", kind }),
        })
    }
}

/// `0 mass: point mass` · `1 link: link origin along across mass inertia`
fn decode_body(row: &[i32], b: &Bounds) -> Result<Body, PlanError> {
    Ok(match row[0] {
        0 => Body::Point { point: b.point(row[1])?, mass: b.slot(row[2])? },
        1 => Body::Link {
            link: b.link(row[1])?,
            origin: b.point(row[2])?,
            along: b.slot(row[3])?,
            across: b.slot(row[4])?,
            mass: b.slot(row[5])?,
            inertia: b.slot(row[6])?,
        },
        kind => return Err(PlanError::Kind { what: "body", kind }),
    })
}

/// `0–2 dry: slide|point|link size` · `3–5 viscous: slide|point|link damping` · `6 force: point x y` ·
/// `7 torque: link torque` · `8 gravity: x y` · `9 spring: from to stiffness free_length preload` ·
/// `10 force over position: slide forward back` · `11 torque over angle: table` ·
/// `12 torque over speed: table` · `13 dry on the crank: torque`
fn decode_load(row: &[i32], b: &Bounds) -> Result<Load, PlanError> {
    Ok(match row[0] {
        0 => Load::DrySlide { slide: b.slide(row[1])?, force: b.slot(row[2])? },
        1 => Load::DryPoint { point: b.point(row[1])?, force: b.slot(row[2])? },
        2 => Load::DryLink { link: b.link(row[1])?, torque: b.slot(row[2])? },
        3 => Load::ViscousSlide { slide: b.slide(row[1])?, damping: b.slot(row[2])? },
        4 => Load::ViscousPoint { point: b.point(row[1])?, damping: b.slot(row[2])? },
        5 => Load::ViscousLink { link: b.link(row[1])?, damping: b.slot(row[2])? },
        6 => Load::Force { point: b.point(row[1])?, x: b.slot(row[2])?, y: b.slot(row[3])? },
        7 => Load::Torque { link: b.link(row[1])?, torque: b.slot(row[2])? },
        8 => Load::Gravity { x: b.slot(row[1])?, y: b.slot(row[2])? },
        9 => Load::Spring {
            from: b.point(row[1])?,
            to: b.point(row[2])?,
            stiffness: b.slot(row[3])?,
            free_length: b.slot(row[4])?,
            preload: b.slot(row[5])?,
        },
        10 => {
            Load::ForcePosition { slide: b.slide(row[1])?, forward: b.table(row[2])?, back: b.table(row[3])? }
        }
        11 => Load::TorqueAngle { table: b.table(row[1])? },
        13 => Load::DryCrank { torque: b.slot(row[1])? },
        kind => return Err(PlanError::Kind { what: "load", kind }),
    })
}

/// `14 force that follows: point link along across` · `15 damper: from to damping` ·
/// `16 spring over length: from to table` · `17 torsional spring: link link stiffness cos sin` ·
/// `18 torsional damper: link link damping` · `19 gas spring: from to force length column exponent`; of two
/// links the second may be −1, the frame
fn decode_force_element(row: &[i32], b: &Bounds) -> Result<ForceElement, PlanError> {
    Ok(match row[0] {
        14 => ForceElement::Follow {
            point: b.point(row[1])?,
            link: b.link(row[2])?,
            along: b.slot(row[3])?,
            across: b.slot(row[4])?,
        },
        15 => ForceElement::Damper { from: b.point(row[1])?, to: b.point(row[2])?, damping: b.slot(row[3])? },
        16 => ForceElement::SpringTable {
            from: b.point(row[1])?,
            to: b.point(row[2])?,
            table: b.table(row[3])?,
        },
        17 => ForceElement::TorsionSpring {
            link: b.link(row[1])?,
            other: b.link_or_frame(row[2])?,
            stiffness: b.slot(row[3])?,
            cos: b.slot(row[4])?,
            sin: b.slot(row[5])?,
        },
        18 => ForceElement::TorsionDamper {
            link: b.link(row[1])?,
            other: b.link_or_frame(row[2])?,
            damping: b.slot(row[3])?,
        },
        19 => ForceElement::GasSpring {
            from: b.point(row[1])?,
            to: b.point(row[2])?,
            force: b.slot(row[3])?,
            length: b.slot(row[4])?,
            column: b.slot(row[5])?,
            exponent: b.slot(row[6])?,
        },
        kind => return Err(PlanError::Kind { what: "load", kind }),
    })
}

/// `20 damper: from to table`
fn decode_damper(row: &[i32], b: &Bounds) -> Result<Law, PlanError> {
    Ok(Law::Damper { from: b.point(row[1])?, to: b.point(row[2])?, table: b.table(row[3])? })
}

/// `21 on a slide: formula slide point` · `22 on a point: formula point cos sin` ·
/// `23 on a point, along a link: formula point link cos sin` · `24 on a link: formula link`
fn decode_formula_load(row: &[i32], b: &Bounds) -> Result<FormulaLoad, PlanError> {
    let carrier = match row[0] {
        21 => Carrier::Slide { slide: b.slide(row[2])?, point: b.point(row[3])? },
        22 => Carrier::Point { point: b.point(row[2])?, cos: b.slot(row[3])?, sin: b.slot(row[4])? },
        23 => Carrier::Along {
            point: b.point(row[2])?,
            link: b.link(row[3])?,
            cos: b.slot(row[4])?,
            sin: b.slot(row[5])?,
        },
        24 => Carrier::Link { link: b.link(row[2])? },
        kind => return Err(PlanError::Kind { what: "load", kind }),
    };
    Ok(FormulaLoad { formula: b.formula(row[1])?, carrier })
}

/// Number of instructions of each formula, then these: two numbers each, what it does and what with.
fn decode_formulas(mut code: &[i32], parameters: usize) -> Result<Vec<Formula>, PlanError> {
    let mut formulas = Vec::new();
    while let Some((&n, rest)) = code.split_first() {
        let length = 2 * index(n, rest.len() / 2 + 1, "instruction")?;
        let (own, others) = rest.split_at(length);
        let ops = own.chunks_exact(2).map(|op| decode_op(op[0], op[1], parameters));
        let number = formulas.len();
        let formula = Formula::new(ops.collect::<Result<_, _>>()?);
        formulas.push(formula.ok_or(PlanError::Formula { number })?);
        code = others;
    }
    Ok(formulas)
}

/// Laws end to end, until the list is empty.
fn decode_motion_laws(mut list: &[f64]) -> Result<Vec<MotionLaw>, PlanError> {
    let mut laws = Vec::new();
    while !list.is_empty() {
        laws.push(MotionLaw::decode(&mut list)?);
    }
    Ok(laws)
}

/// `0 number: slot` · `1 zero` · `2 variable: which` · `8 whole power: exponent`; the others have no operand.
fn decode_op(code: i32, operand: i32, parameters: usize) -> Result<Op, PlanError> {
    let unknown = PlanError::Kind { what: "instruction", kind: code };
    Ok(match code {
        0 => Op::Number(index(operand, parameters, "parameter")?),
        1 => Op::Zero,
        2 => Op::Variable(Variable::of(operand).ok_or(unknown)?),
        3 => Op::Add,
        4 => Op::Sub,
        5 => Op::Mul,
        6 => Op::Div,
        7 => Op::Neg,
        8 => Op::Power(operand),
        9 => Op::Pow,
        10 => Op::Sin,
        11 => Op::Cos,
        12 => Op::Tan,
        13 => Op::Asin,
        14 => Op::Acos,
        15 => Op::Atan,
        16 => Op::Atan2,
        17 => Op::Exp,
        18 => Op::Log,
        19 => Op::Sqrt,
        20 => Op::Tanh,
        21 => Op::Abs,
        22 => Op::Sign,
        23 => Op::Step,
        24 => Op::Min,
        25 => Op::Max,
        26 => Op::Where,
        _ => return Err(unknown),
    })
}

/// Motor `0 off` · `1 constant: torque` · `2 line: torque 1/speed` ·
/// `3 induction: 1/synchronous torque slip resistance` · `4 table: table`, padded to five entries; then slots
/// of ratio, forward, reverse, inertia, starting speed; then spans `x0 y0 x1 y1 1/(x1−x0) is_level`.
fn decode_drive(code: &[i32], speed_loads: Vec<usize>, b: &Bounds) -> Result<Drive, PlanError> {
    if code.len() < DRIVE_HEAD {
        return Err(PlanError::Length { what: "drive", found: code.len(), expected: DRIVE_HEAD });
    }
    let spans = rows(&code[DRIVE_HEAD..], SPAN_WIDTH, "spans")?
        .map(|row| {
            Ok(Span {
                x0: b.slot(row[0])?,
                y0: b.slot(row[1])?,
                x1: b.slot(row[2])?,
                y1: b.slot(row[3])?,
                inverse_width: b.slot(row[4])?,
                is_level: row[5] != 0,
            })
        })
        .collect::<Result<_, PlanError>>()?;
    let motor = match code[0] {
        0 => Motor::Off,
        1 => Motor::Constant { torque: b.slot(code[1])? },
        2 => Motor::Line { torque: b.slot(code[1])?, inverse_speed: b.slot(code[2])? },
        3 => Motor::Induction {
            inverse_synchronous: b.slot(code[1])?,
            torque: b.slot(code[2])?,
            slip: b.slot(code[3])?,
            resistance: b.slot(code[4])?,
            spans,
        },
        4 => Motor::Table { table: b.table(code[1])? },
        kind => return Err(PlanError::Kind { what: "motor", kind }),
    };
    Ok(Drive {
        motor,
        ratio: b.slot(code[5])?,
        forward: b.slot(code[6])?,
        reverse: b.slot(code[7])?,
        inertia: b.slot(code[8])?,
        speed_start: b.slot(code[9])?,
        speed_loads,
    })
}
