//! `linkwright._core`: converts arrays, lets the interpreter lock go, calls the core, converts back.
//! There is no arithmetic here.
// The functions' arguments are the border itself; each is described in `_core.pyi`.
#![allow(missing_docs, clippy::too_many_arguments)]

mod arrays;
mod builder;
mod cam;
mod drive;
mod driveline;
mod driveline_chain;
mod driveline_gradient;
mod driveline_in_time;
mod driveline_rows;
mod equations;
mod errors;
mod exchange;
mod guard;
mod linkage;
mod rods;
mod status;
mod topper;
mod torsion;
mod torsion_transient;

use numpy::{PyArray1, PyArray2, PyReadonlyArray1};
use pyo3::prelude::*;

type Ints<'py> = PyReadonlyArray1<'py, i32>;
type Floats<'py> = PyReadonlyArray1<'py, f64>;
type Curve<'py> = Bound<'py, PyArray1<f64>>;
type Table<'py> = Bound<'py, PyArray2<f64>>;

#[pymodule(gil_used = false)]
pub mod _core {
    #[pymodule_export]
    const FORMAT: u32 = linkwright_core::plan::FORMAT;
    #[pymodule_export]
    const SEARCH_TURNS_MAX: usize = linkwright_core::drive::march::TURNS_MAX;
    #[pymodule_export]
    const SEARCH_STEPS_MAX: usize = linkwright_core::drive::march::STEPS_IN_ALL_MAX;
    #[pymodule_export]
    const MESH_STEPS_MAX: usize = linkwright_core::drive::steady::STEPS_MAX;

    #[pymodule_init]
    fn init(_module: &pyo3::Bound<'_, pyo3::types::PyModule>) -> pyo3::PyResult<()> {
        if !linkwright_kernel::lanes::is_supported() {
            return Err(pyo3::exceptions::PyImportError::new_err(linkwright_kernel::lanes::NEEDS));
        }
        super::guard::keep_panics();
        Ok(())
    }

    #[pymodule_export]
    use super::builder::Plan;
    #[pymodule_export]
    use super::builder::drive::{Drive, Motor, Span};
    #[pymodule_export]
    use super::builder::driveline::{DrivelineStation, DrivelineTorque};
    #[pymodule_export]
    use super::builder::elements::{Element, GroundPoint};
    #[pymodule_export]
    use super::builder::loads::{At, Body, What};
    #[pymodule_export]
    use super::builder::numbers::{Formula, Harmonic, Knots, MotionLaw, Piece};
    #[pymodule_export]
    use super::builder::parts::{Bar, BarPoint, ChangePoint, Condition, Line, Sum, Term};
    #[pymodule_export]
    use super::builder::train::{
        Curve, Periodic, TorqueLaw, TorqueShape, TorsionController, TorsionFriction, TorsionGrip,
        TorsionLink, TorsionMass, TorsionPendulum, TorsionRotor, TorsionTorque,
    };
    #[pymodule_export]
    use super::cam::{
        Cam, CamCrossings, CamDimensions, CamExtreme, CamOffset, CamPasses, CamSearch, CamShape,
        cam_crossings,
    };
    #[pymodule_export]
    use super::drive::{
        MotionInTime, MotionVariations, MotorTorques, NoSteadyMotion, OtherMotion, Reductions, SteadyCurves,
        SteadyGradient, SteadyMotion, SteadyRows, SteadySolution, inertias_along, kinks, kinks_along,
        law_torques, motion_at, motor_torques, reductions, steady_rows, steady_state, transient,
        transient_along,
    };
    #[pymodule_export]
    use super::driveline::{
        DrivelineCurves, DrivelineMotion, NoDrivelineMotion, driveline_branch, driveline_motion,
    };
    #[pymodule_export]
    use super::driveline_gradient::DrivelineGradient;
    #[pymodule_export]
    use super::driveline_in_time::{DrivelineInTime, DrivelineInTimeCurves, driveline_in_time};
    #[pymodule_export]
    use super::driveline_rows::{DrivelineExtremes, DrivelineRows, driveline_rows, least_inertias};
    #[pymodule_export]
    use super::equations::solve_systems;
    #[pymodule_export]
    use super::exchange::{FmuMachine, fmu_machine};
    #[pymodule_export]
    use super::linkage::{
        Channel, GroupPath, InLine, ThirdDerivatives, follow_group, gaps, in_line, motions, motions_along,
        third,
    };
    #[pymodule_export]
    use super::rods::{RodMotions, predict_rods, rod_cards, rods_along};
    #[pymodule_export]
    use super::status::Status;
    #[pymodule_export]
    use super::topper::{TopperCover, TopperKnife};
    #[pymodule_export]
    use super::torsion::{Extremes, TorsionModes, torsion_forced, torsion_modes, torsion_waves};
    #[pymodule_export]
    use super::torsion_transient::{NetTorques, TorsionMotion, TorsionSystem};
}
