//! Ends of finer steps: where errors are too large, and at crossings.

use crate::crossings::Crossing;
use crate::mesh::Mesh;

/// Steps of a cycle at most.
pub(crate) const STEPS_MAX: usize = 20_000;

/// Parts of a step at once.
const PARTS_MAX: f64 = 6.0;

/// The error of quintics falls with this power of the length of their step.
pub(crate) const POWER: f64 = 6.0;

/// Angles \[rad\] that are one.
pub(crate) const SAME_ANGLE: f64 = 1e-9;

/// Ends of finer steps, with those at crossings, which move with the solution until both stand; `placed` are those of the last round.
pub(crate) fn finer_edges(
    mesh: &Mesh,
    errors: &[f64],
    crossings: &[Crossing],
    accuracy: f64,
    placed: &mut Vec<f64>,
) -> Vec<f64> {
    let mut edges = divided(&mesh.edges, |k| parts_of_step(errors[k], accuracy));
    edges.retain(|edge| !placed.iter().any(|old: &f64| (old - edge).abs() < 0.5 * SAME_ANGLE));
    *placed = with_ends(&mut edges, crossings);
    edges
}

/// Parts into which a step with an error is divided.
pub(crate) fn parts_of_step(error: f64, accuracy: f64) -> usize {
    let excess = 2.0 * error / accuracy;
    if excess <= 2.0 { 1 } else { excess.powf(1.0 / POWER).ceil().clamp(2.0, PARTS_MAX) as usize }
}

/// Ends of steps after each is divided into a number of parts.
pub(crate) fn divided(edges: &[f64], parts: impl Fn(usize) -> usize) -> Vec<f64> {
    let mut finer = vec![edges[0]];
    for (k, pair) in edges.windows(2).enumerate() {
        let (parts, length) = (parts(k), pair[1] - pair[0]);
        finer.extend((1..=parts).map(|i| pair[0] + length * (i as f64 / parts as f64)));
    }
    finer
}

/// Puts ends of steps at crossings, and gives those that are new.
fn with_ends(edges: &mut Vec<f64>, crossings: &[Crossing]) -> Vec<f64> {
    let mut placed = Vec::new();
    for Crossing { angle, .. } in crossings {
        let behind = edges.partition_point(|edge| edge < angle);
        let near = |i: usize| edges.get(i).is_some_and(|edge| (edge - angle).abs() < SAME_ANGLE);
        if !(near(behind) || behind > 0 && near(behind - 1)) {
            edges.insert(behind, *angle);
            placed.push(*angle);
        }
    }
    placed
}
