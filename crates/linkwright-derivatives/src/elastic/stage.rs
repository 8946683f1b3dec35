//! The mechanism at a crank angle that may move, along directions.

use linkwright_core::drive::law::LawGeometry;
use linkwright_core::drive::reduce::Reduction;
use linkwright_core::linkage::motion::Motion;
use linkwright_driveline::equation::{Equation, Row};
use linkwright_kernel::dual::Dual;
use linkwright_kernel::out_of_line;
use linkwright_kernel::plane::Angle;
use linkwright_kernel::real::Real;

/// The mechanism where a stage is read, along the directions.
pub(super) struct StageRow<R> {
    phi: Dual<R>,
    reduced: Reduction<Dual<R>>,
    geometry: Vec<LawGeometry<Dual<R>>>,
}

impl<R: Real> StageRow<R> {
    /// At a crank angle, which may move.
    #[inline(always)]
    pub(super) fn new(equation: &Equation<'_, Dual<R>>, phi: Dual<R>, m: &mut Motion<Dual<R>>) -> Self {
        out_of_line!(Dual<R>, {
            let Equation { plan, q, .. } = *equation;
            let reduced = plan.reduce::<Dual<R>, 2>(q, Angle::new(phi), 1.0, m);
            let mut geometry = Vec::new();
            plan.add_geometry(q, phi, m, &mut geometry);
            StageRow { phi, reduced, geometry }
        })
    }

    #[inline(always)]
    pub(super) fn row(&self) -> Row<'_, Dual<R>> {
        Row { phi: self.phi, reduced: self.reduced, geometry: &self.geometry }
    }
}
