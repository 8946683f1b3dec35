//! What an edge of given length leaves of a head, if it never retreats: the parts of chords beyond its two ends, over
//! the way of the edge along its normal.
//!
//! The integrand has kinks where an end of the edge crosses the rim of the head. They are found first; between them it is
//! smooth, and Gauss's rule takes it.

use super::knife::{Head, Knife};
use super::needed::{Stations, half_chord};
use crate::gauss::{B, C};
use std::f64::consts::FRAC_PI_2;

/// Length of u that a part of Gauss's rule takes, at most: of order 8, it leaves some 1e-12 of a head.
const PART: f64 = 0.25;

/// Steps of the search for a kink: regula falsi (Illinois) gains a digit and a half each.
const SEARCH: usize = 60;

/// Area that is left beyond the end behind and that ahead, seen along e.
pub fn uncut(
    knife: &Knife,
    head: &Head<f64>,
    half: f64,
    window: [f64; 2],
    turns: std::ops::RangeInclusive<i32>,
    stations: &Stations,
    top: f64,
) -> [f64; 2] {
    let mut area = [0.0; 2];
    knife.stretches(head, window, turns, |[start, end]| {
        if end > start {
            let swing = Swing { knife, head, half, middle: 0.5 * (start + end), width: 0.5 * (end - start) };
            let more = swing.area(stations, top);
            area = [area[0] + more[0], area[1] + more[1]];
        }
    });
    area
}

/// A stretch of time, run through as t = m + w sin u.
struct Swing<'a> {
    knife: &'a Knife,
    head: &'a Head<f64>,
    half: f64,
    middle: f64,
    width: f64,
}

impl Swing<'_> {
    /// How far the chord's ends lie beyond the edge's, behind and ahead; and how far its other ends do.
    fn beyond(&self, u: f64) -> [f64; 4] {
        let place = self.knife.place(self.head, self.middle + self.width * u.sin());
        let (chord, q) = (half_chord(self.head.radius, place.p[0]), place.q[0]);
        [q + chord - self.half, chord - q - self.half, q - chord - self.half, -q - chord - self.half]
    }

    /// Length left on both sides, times how fast p goes over u.
    fn rate(&self, u: f64) -> [f64; 2] {
        let place = self.knife.place(self.head, self.middle + self.width * u.sin());
        let (chord, q) = (half_chord(self.head.radius, place.p[0]), place.q[0]);
        let pace = place.p[1] * self.width * u.cos();
        [q, -q].map(|q| (q + chord - self.half).clamp(0.0, 2.0 * chord) * pace)
    }

    /// Area left on both sides.
    fn area(&self, stations: &Stations, top: f64) -> [f64; 2] {
        let mut area = [0.0; 2];
        for pair in self.kinks(stations, top).windows(2) {
            let middle = self.beyond(0.5 * (pair[0] + pair[1]));
            if middle[0] <= 0.0 && middle[1] <= 0.0 {
                continue;
            }
            let parts = ((pair[1] - pair[0]) / PART).ceil().max(1.0);
            let step = (pair[1] - pair[0]) / parts;
            for part in 0..parts as usize {
                for (c, b) in C.into_iter().zip(B) {
                    let rate = self.rate(pair[0] + (part as f64 + c) * step);
                    area = [area[0] + b * step * rate[0], area[1] + b * step * rate[1]];
                }
            }
        }
        area
    }

    /// Both ends, and where an end of the edge crosses the rim, increasing.
    fn kinks(&self, stations: &Stations, top: f64) -> Vec<f64> {
        let mut places: Vec<f64> = stations
            .turns
            .iter()
            .enumerate()
            .map(|(j, _)| (j as f64 + 0.5) * stations.step - FRAC_PI_2)
            .collect();
        let highest = (top - self.middle) / self.width;
        if highest.abs() < 1.0 {
            // Where most is left: between two stations nothing else might be.
            places.push(highest.asin());
            places.sort_by(f64::total_cmp);
        }
        places.push(FRAC_PI_2);
        let mut kinks = vec![-FRAC_PI_2];
        let (mut u, mut here) = (-FRAC_PI_2, self.beyond(-FRAC_PI_2));
        for next in places {
            let there = self.beyond(next);
            for k in 0..4 {
                if (here[k] > 0.0) != (there[k] > 0.0) {
                    kinks.push(crossing([u, next], [here[k], there[k]], |u| self.beyond(u)[k]));
                }
            }
            (u, here) = (next, there);
        }
        kinks.push(FRAC_PI_2);
        kinks.sort_by(f64::total_cmp);
        kinks
    }
}

/// Where a function crosses zero between two places (Dowell, Jarratt 1971: the Illinois method).
pub fn crossing([mut a, mut b]: [f64; 2], [mut fa, mut fb]: [f64; 2], f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..SEARCH {
        let x = b - fb * (b - a) / (fb - fa);
        let fx = f(x);
        if fx == 0.0 || (x - b).abs() < 1e-15 {
            return x;
        }
        if (fx > 0.0) == (fb > 0.0) {
            fa *= 0.5;
        } else {
            (a, fa) = (b, fb);
        }
        (b, fb) = (x, fx);
    }
    b
}
