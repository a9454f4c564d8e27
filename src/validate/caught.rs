//! The errors that were planted in the library to see the gates fail.

/// A planted error, and the gates that fail under it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CaughtError {
    /// The error.
    pub error: &'static str,
    /// The names of the gates.
    pub gates: &'static [&'static str],
}

/// All of them, in the order of the documentation; a test plants each and sees its gates fail.
pub const CAUGHT_ERRORS: &[CaughtError] = &[
    CaughtError {
        error: "two bodies, where J2 acts",
        gates: &[
            "sgp4/two-body/sgp4/in-track-rms",
            "sgp4/two-body/sgp4/cross-track-rms",
            "sgp4/two-body/sgp4/in-track-growth",
            "sgp4/two-body/sweep",
            "sgp4/rates/node/two-body",
            "sgp4/rates/argument-of-latitude/two-body",
            "sgp4/decisions/flipped-decisions",
        ],
    },
    CaughtError {
        error: "dM/dt = n, without its J2 term",
        gates: &[
            "sgp4/mean-j2/sgp4/in-track-rms",
            "sgp4/mean-j2/sgp4/in-track-growth",
            "sgp4/mean-j2/sgp4-no-j3j4/in-track-rms",
            "sgp4/mean-j2/sgp4-no-j3j4/in-track-growth",
            "sgp4/mean-j2/sweep",
            "sgp4/kepler-slot/closed-form",
            "sgp4/rates/argument-of-latitude/mean-j2",
            "sgp4/decisions/flipped-decisions",
            "sgp4/tle/decisions/flipped-decisions",
            "numerical/1-days/in-track-drift",
            "analytic/rates/argument-of-latitude",
        ],
    },
    CaughtError {
        error: "sqrt(μ/a³) in the mean motion slot of element sets",
        gates: &[
            "sgp4/mean-j2/sgp4/in-track-growth",
            "sgp4/rates/argument-of-latitude/sgp4",
            "sgp4/tle/decisions/flipped-decisions",
        ],
    },
    CaughtError {
        error: "sqrt(μ/a³) in the mean motion slot of the model",
        gates: &[
            "sgp4/sgp4/sgp4/in-track-rms",
            "sgp4/sgp4/sgp4/in-track-growth",
            "sgp4/sgp4/sweep",
        ],
    },
    CaughtError {
        error: "short-period terms left out of `j2-osculating`",
        gates: &[
            "sgp4/j2-osculating/sgp4-no-j3j4/radial-rms",
            "sgp4/j2-osculating/sgp4-no-j3j4/cross-track-rms",
            "sgp4/j2-osculating/sweep",
            "numerical/1-days/in-track-drift",
        ],
    },
    CaughtError {
        error: "sign of J2",
        gates: &[
            "sgp4/mean-j2/sgp4/in-track-growth",
            "sgp4/mean-j2/sgp4/cross-track-rms",
            "sgp4/rates/node/mean-j2",
            "numerical/1-days/in-track-drift",
            "numerical/1-days/node-rate",
            "analytic/rates/node",
            "analytic/rates/argument-of-latitude",
        ],
    },
    CaughtError {
        error: "sign of dΩ/dt",
        gates: &[
            "sgp4/mean-j2/sgp4/cross-track-rms",
            "sgp4/mean-j2/sgp4-no-j3j4/cross-track-rms",
            "sgp4/rates/node/mean-j2",
            "numerical/1-days/node-rate",
            "numerical/1-days/cross-track-after-fit",
            "analytic/rates/node",
        ],
    },
    CaughtError {
        error: "altitude over another radius (6371 km)",
        gates: &[
            "sgp4/mean-j2/sgp4/radial-rms",
            "sgp4/mean-j2/sgp4-no-j3j4/radial-rms",
            "sgp4/mean-j2/sgp4/in-track-growth",
            "sgp4/radius-shift/closed-form",
        ],
    },
    CaughtError {
        error: "satellites at the inclination 180° - i",
        gates: &["sgp4/rates/node/sgp4", "sgp4/rates/node/mean-j2"],
    },
    CaughtError {
        error: "star for delta",
        gates: &["analytic/symmetry/turn"],
    },
    CaughtError {
        error: "constants of WGS 84 in SGP4",
        gates: &[
            "sgp4/verification/published",
            "sgp4/verification/afspc",
            "sgp4/verification/improved",
        ],
    },
    CaughtError {
        error: "J3 left out of SGP4",
        gates: &[
            "sgp4/verification/afspc",
            "sgp4/frozen-eccentricity/closed-form",
            "sgp4/frozen-eccentricity/cancelled",
        ],
    },
    CaughtError {
        error: "frozen eccentricity at ω = 90°",
        gates: &["sgp4/frozen-eccentricity/cancelled"],
    },
    CaughtError {
        error: "mean motion of a TLE cut to four decimals",
        gates: &["sgp4/tle/digits"],
    },
    CaughtError {
        error: "elements not carried to the rounded epoch of a TLE",
        gates: &["sgp4/tle/epoch"],
    },
    CaughtError {
        error: "sidereal time off by a second",
        gates: &["sgp4/sidereal-time"],
    },
    CaughtError {
        error: "geocentric vertical",
        gates: &[
            "geographiclib/elevation",
            "geographiclib/curvature-method/low",
        ],
    },
    CaughtError {
        error: "sphere for ellipsoid",
        gates: &["geographiclib/elevation"],
    },
    CaughtError {
        error: "elevation of the line of sight from the centre of the Earth",
        gates: &[
            "geographiclib/elevation",
            "geographiclib/footprint/geodesic-polygon",
        ],
    },
    CaughtError {
        error: "swapped azimuth axes",
        gates: &["geographiclib/azimuth"],
    },
    CaughtError {
        error: "factor of x and y for z in the acceleration of J2",
        gates: &[
            "numerical/conserved/energy",
            "numerical/1-days/in-track-drift",
            "numerical/1-days/node-rate",
        ],
    },
    CaughtError {
        error: "J2 about the x axis in the integration",
        gates: &[
            "numerical/conserved/polar-momentum",
            "numerical/1-days/in-track-after-fit",
            "numerical/1-days/cross-track-after-fit",
        ],
    },
    CaughtError {
        error: "sign of J3 in the integration",
        gates: &["numerical/j3/frozen-eccentricity"],
    },
    CaughtError {
        error: "wrong number of clocks",
        gates: &["analytic/geometry/mean-pdop", "analytic/geometry/max-pdop"],
    },
    CaughtError {
        error: "mask taken from the zenith",
        gates: &[
            "analytic/mask",
            "analytic/mean-visible",
            "analytic/geometry/mean-visible",
        ],
    },
    CaughtError {
        error: "first satellite of a list counted by its height over the equator",
        gates: &["analytic/symmetry/order"],
    },
];

/// The errors under which the gate of this check fails; the name may have that of a constellation or a shell before it.
pub fn caught_by(check: &str) -> impl Iterator<Item = &'static str> {
    let is_of = |gate: &&str| {
        check
            .strip_suffix(*gate)
            .is_some_and(|before| before.is_empty() || before.ends_with('/'))
    };
    let errors = CAUGHT_ERRORS.iter();
    errors
        .filter(move |caught| caught.gates.iter().any(is_of))
        .map(|caught| caught.error)
}
