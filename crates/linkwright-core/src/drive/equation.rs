//! The equation of motion over the crank angle.
//!
//! ```text
//! du/dφ = ε = [M_d(ω) − M_r(φ, ω) − J′(φ) u] / J(φ),   ω = √(2u)
//! ```
//!
//! u = ½ ω² is the state (paper 1, equation (1), divided by J): its derivative by the angle *is* the
//! acceleration, so the acceleration is known as well as the solution is, also where a steep motor leaves
//! little of it.

use crate::drive::law::LawGeometry;
use crate::drive::structure::Plan;
use crate::kernel::branch::OnBranch;
use crate::kernel::dual::Dual;
use crate::kernel::out_of_line;
use crate::kernel::plane::Angle;
use crate::kernel::radau::S;
use crate::kernel::real::{Lift, Real};
use crate::linkage::motion::Motion;

/// The reduced machine at one stage: all that the equation of motion needs besides u.
#[derive(Clone, Copy, Debug)]
pub struct Row<R> {
    /// 1/J \[1/(kg m²)\].
    pub inverse: R,
    /// J′/J \[1/rad\].
    pub drift: R,
    /// Load torque that does not depend on speed \[N m\].
    pub load: R,
    /// Viscous coefficient \[N m s/rad\].
    pub viscous: R,
}

/// A machine with its parameters in lanes of `R`: what every function of a revolution works on.
#[derive(Clone, Copy)]
pub struct Machine<'a, R> {
    /// Its structure.
    pub plan: &'a Plan,
    /// Its numbers.
    pub q: &'a [R],
    /// Whether the laws at all stages of a step keep to one branch, that of its [`crate::drive::step::REFERENCE`]: where a
    /// law jumps at some speed the jump is the end of a step then, and rounding does not decide on which side of it a
    /// stage lies.
    pub keeps_branch: bool,
    /// The state that chooses the branch of all stages in the place of the reference: what laws know there, and u.
    pub side: Option<(&'a [LawGeometry<R>], R)>,
    /// How far \[rad\] inside a step its ends are known to be on its side; 0 where they are read as they are.
    pub(super) inside: f64,
}

/// So far \[rad\] inside a step its ends are on its side of an angle at which the machine jumps: that angle is known to the
/// rounding of the quantity that tells it over its slope, 1e-16 over 1e-6 where a blow is that short and told by a cosine. What is
/// drawn on from there misses the end by the square of it.
const AT_JUMP: f64 = 1e-9;

impl<'a, R: Real> Machine<'a, R> {
    /// A machine that is evaluated as it is at every stage.
    pub fn new(plan: &'a Plan, q: &'a [R]) -> Self {
        let inside = if plan.jumps_over_angle() { AT_JUMP } else { 0.0 };
        Machine { plan, q, keeps_branch: false, side: None, inside }
    }

    /// A machine that is read on the side of the step also where it only bends at an angle, so that derivatives jump.
    #[must_use]
    pub fn keeping_sides_of_bends(self) -> Self {
        let inside = if self.plan.bends_over_angle() { AT_JUMP } else { 0.0 };
        Machine { inside, ..self }
    }

    /// A machine that is read on the side of the step wherever it has any kink.
    #[must_use]
    pub fn keeping_sides(self) -> Self {
        Machine { inside: AT_JUMP, ..self }
    }

    /// A machine whose steps each keep to one branch, or not.
    #[must_use]
    pub fn keeping_branch(self, keeps_branch: bool) -> Self {
        Machine { keeps_branch, ..self }
    }

    /// ε without laws.
    #[inline(always)]
    pub(super) fn drive_acceleration<N: Lift<R>>(&self, row: &Row<R>, u: N) -> N {
        let omega = (u * 2.0).sqrt();
        let torque = self.plan.drive.torque(&self.plan.tables, self.q, omega);
        let net = torque - N::lift(row.load) - N::lift(row.viscous) * omega;
        net * N::lift(row.inverse) - N::lift(row.drift) * u
    }

    /// ε, and its derivative by u.
    #[inline(always)]
    pub fn acceleration(&self, row: &Row<R>, geometry: &[LawGeometry<R>], u: R) -> Dual<R> {
        out_of_line!(R, {
            let free = self.drive_acceleration(row, Dual::variable(u));
            if geometry.is_empty() {
                return free;
            }
            let taken = self.laws(geometry, (Dual::variable(u) * 2.0).sqrt());
            free - taken * Dual::constant(row.inverse)
        })
    }

    /// The same with laws on the branch of a reference, which has its own `known` and u. The drive's torque is continuous.
    #[inline(always)]
    pub fn acceleration_on_branch(
        &self,
        row: &Row<R>,
        geometry: &[LawGeometry<R>],
        u: R,
        (known, at): (&[LawGeometry<R>], R),
    ) -> Dual<R> {
        out_of_line!(R, {
            let free = self.drive_acceleration(row, Dual::variable(u));
            if geometry.is_empty() {
                return free;
            }
            let u = OnBranch { value: Dual::variable(u), at };
            let taken = self.laws_on_branch(geometry, known, (u * 2.0).sqrt()).value;
            free - taken * Dual::constant(row.inverse)
        })
    }

    /// Load torque of all laws at a stage; no time counts, since no turn differs from another.
    #[inline(always)]
    pub fn laws<N: Lift<R>>(&self, geometry: &[LawGeometry<R>], omega: N) -> N {
        out_of_line!(N, self.plan.law_torque::<R, R, N>(self.q, geometry, omega, N::splat(f64::NAN)))
    }

    /// The same on the branch of a reference, where the laws know what is `known`.
    #[inline(always)]
    pub fn laws_on_branch<N>(&self, geometry: &[LawGeometry<R>], known: &[LawGeometry<R>], omega: N) -> N
    where
        N: Lift<R> + Lift<OnBranch<R, R>>,
    {
        let both: Vec<LawGeometry<OnBranch<R, R>>> =
            geometry.iter().zip(known).map(|(geometry, known)| geometry.on_branch_of(known)).collect();
        out_of_line!(
            N,
            self.plan.law_torque::<R, OnBranch<R, R>, N>(self.q, &both, omega, N::splat(f64::NAN))
        )
    }

    /// What the laws need to know at one stage of several.
    #[inline(always)]
    pub fn geometry_at<'g>(&self, geometry: &'g [LawGeometry<R>], stage: usize) -> &'g [LawGeometry<R>] {
        let n = self.plan.laws.len();
        &geometry[stage * n..(stage + 1) * n]
    }

    /// Whether the laws at a stage are on the branch of [`crate::drive::step::REFERENCE`].
    #[inline(always)]
    pub fn is_on_branch(&self, stage: usize) -> bool {
        self.keeps_branch || (self.inside > 0.0 && stage == S - 1)
    }

    /// What the slope ∂ε/∂u by the drive has on the branch of a reference besides that which rounding chose, on a kink.
    #[inline(always)]
    pub(super) fn slope_besides(&self, row: &Row<R>, u: R, reference: R) -> R {
        let on_branch = OnBranch { value: Dual::variable(u), at: reference };
        self.drive_acceleration(row, on_branch).value.d - self.drive_acceleration(row, on_branch.value).d
    }

    /// The reduced machine at a crank angle; what its laws need to know there is added to `geometry`.
    #[inline(always)]
    pub fn row(&self, phi: R, m: &mut Motion<R>, geometry: &mut Vec<LawGeometry<R>>) -> Row<R> {
        out_of_line!(R, {
            let r = self.plan.reduce::<R, 2>(self.q, Angle::new(phi), 1.0, m);
            if !self.plan.laws.is_empty() {
                self.plan.add_geometry(self.q, phi, m, geometry);
            }
            let inverse = r.J.recip();
            Row { inverse, drift: r.J_d1 * inverse, load: r.load + r.dry, viscous: r.viscous }
        })
    }

    /// The reduced machine at an end of a step, on its side of a jump there: drawn on from two angles inside, of which the
    /// other is farther `inside` by as much. Read at the nearer one it would not be what the speed at the end belongs to, and a steep
    /// drive would make that angle times its steepness of it.
    #[inline(always)]
    pub(super) fn row_at_end(
        &self,
        phi: R,
        inside: R,
        m: &mut Motion<R>,
        geometry: &mut Vec<LawGeometry<R>>,
    ) -> Row<R> {
        out_of_line!(R, {
            if self.inside == 0.0 {
                return self.row(phi, m, geometry);
            }
            let mut none = Vec::new();
            let [far, near] = [inside + inside, inside].map(|by| self.row(phi + by, m, &mut none));
            if !self.plan.laws.is_empty() {
                self.plan.mechanism.place::<R, 2>(self.q, Angle::new(phi), m);
                self.plan.add_geometry(self.q, phi, m, geometry);
            }
            near.drawn_on_from(&far)
        })
    }
}

impl<R: Real> Row<R> {
    /// What a row and one before it make of one as far behind it, all near each other.
    #[inline(always)]
    fn drawn_on_from(&self, before: &Self) -> Self {
        Row {
            inverse: self.inverse + (self.inverse - before.inverse),
            drift: self.drift + (self.drift - before.drift),
            load: self.load + (self.load - before.load),
            viscous: self.viscous + (self.viscous - before.viscous),
        }
    }
}
