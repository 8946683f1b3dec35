//! Masses and links of a driveline at the border.

use linkwright_driveline::chain::{Chain, Link, Swing};
use linkwright_driveline::law::{Curve, Law};
use pyo3::exceptions::{PyIndexError, PyValueError};
use pyo3::prelude::*;

use crate::arrays::as_indices;
use crate::builder::driveline::{DrivelineStation, DrivelineTorque};
use crate::{Floats, Ints};

/// Twists, torques and slopes at the points of a link's curve; none of a straight spring.
type Points = Option<[Vec<f64>; 3]>;

/// A driveline as Python lists it, by name; `gap` is half of the backlash of each link.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Driveline<'py> {
    inertia: Floats<'py>,
    apart: f64,
    first: Ints<'py>,
    second: Ints<'py>,
    stiffness: Floats<'py>,
    damping: Floats<'py>,
    gap: Floats<'py>,
    curves: Vec<Points>,
    drivers: Vec<PyRef<'py, DrivelineTorque>>,
    loads: Vec<PyRef<'py, DrivelineTorque>>,
    stations: Vec<PyRef<'py, DrivelineStation>>,
    swing: Option<(Floats<'py>, Floats<'py>)>,
}

impl Driveline<'_> {
    /// For the core.
    pub(crate) fn chain(&self) -> PyResult<Chain> {
        let inertia = self.inertia.as_slice()?.to_vec();
        let torques = |list: &[PyRef<'_, DrivelineTorque>]| list.iter().map(|each| each.core()).collect();
        let swing = match &self.swing {
            None => None,
            Some((damping, share)) => {
                Some(Swing { damping: damping.as_slice()?.to_vec(), share: share.as_slice()?.to_vec() })
            }
        };
        let chain = Chain {
            links: self.links(inertia.len() + 1)?,
            inertia,
            apart: self.apart,
            drivers: torques(&self.drivers),
            loads: torques(&self.loads),
            stations: self.stations.iter().map(|each| each.core()).collect(),
            swing,
        };
        if !chain.fits() {
            return Err(PyIndexError::new_err("driveline: a link, a torque or a mechanism is at no mass"));
        }
        Ok(chain)
    }

    fn links(&self, masses: usize) -> PyResult<Vec<Link>> {
        let [first, second] =
            [as_indices(self.first.as_slice()?, masses)?, as_indices(self.second.as_slice()?, masses)?];
        let (stiffness, damping) = (self.stiffness.as_slice()?, self.damping.as_slice()?);
        let gap = self.gap.as_slice()?;
        if [second.len(), stiffness.len(), damping.len(), gap.len(), self.curves.len()] != [first.len(); 5] {
            return Err(PyValueError::new_err("links: arrays of one length are needed"));
        }
        let wrong = || PyValueError::new_err("links: a curve has to rise from zero");
        let link = |i: usize| {
            let through = |[x, y, slope]: &[Vec<f64>; 3]| Curve::new(x, y, slope).ok_or_else(wrong);
            let curve = self.curves[i].as_ref().map(through).transpose()?;
            let law = Law { stiffness: stiffness[i], damping: damping[i], gap: gap[i], curve };
            Ok(Link { first: first[i], second: second[i], law })
        };
        (0..first.len()).map(link).collect()
    }
}
