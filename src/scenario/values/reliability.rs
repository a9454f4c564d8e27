//! How reliable the satellites are.

use crate::scenario::keys::{key, section};
use crate::scenario::problem::Fault;
use crate::scenario::reader::Reader;
use crate::scenario::rule::{Integer, Number, Optional};

section! {
    /// Reliability of the LEO satellites: metrics as expected over their failures are computed if it is given.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct Reliability in "reliability", finish check_reliability {
        /// Probability that a LEO satellite is up, independently of the others.
        pub availability: Option<f64> = Optional(Number::above_to(0.0, 1.0)), follows "mtbf-h/(mtbf-h + mttr-h)",
            example Some(0.98);
        /// Mean time between the repair of a satellite, or its replacement, and its next failure, instead of availability.
        pub mtbf_h: Option<f64> = Optional(Number::above_to(0.0, 1e9)), unit "h", follows "none", example Some(43_800.0);
        /// Mean time to repair or replace a satellite, with mtbf-h.
        pub mttr_h: Option<f64> = Optional(Number::from_to(0.0, 1e9)), unit "h", follows "none", example Some(720.0);
        /// Spares in the orbit of each plane, which fail like the others and fill vacant slots at once: the metrics are those of
        /// seeded draws of the vacant slots.
        pub spares_per_plane: Option<u32> = Optional(Integer { low: 0, high: 100 }), follows "none", example Some(1);
    }
}

fn check_reliability(reliability: &mut Reliability, reader: &mut Reader<'_>) {
    let keys = [
        key!(Reliability.availability),
        key!(Reliability.mtbf_h),
        key!(Reliability.mttr_h),
    ];
    let [availability, mtbf, mttr] = keys.map(|key| reader.is_given(key));
    let values = [
        (&mut reliability.availability, availability),
        (&mut reliability.mtbf_h, mtbf),
        (&mut reliability.mttr_h, mttr),
    ];
    for (value, is_given) in values {
        if !is_given {
            *value = None;
        }
    }
    let spares = key!(Reliability.spares_per_plane);
    if !reader.is_given(spares) {
        reliability.spares_per_plane = None;
    } else if !availability && !mtbf {
        let fault = Fault::Needs {
            quantity: spares.to_string(),
            needs: format!("{} or {}", keys[0], keys[1]),
        };
        reader.refuse(&[spares], fault);
    }
    if availability && (mtbf || mttr) {
        let other = if mtbf { keys[1] } else { keys[2] };
        reader.refuse(
            &keys[..1],
            Fault::Excluded {
                other: other.to_string(),
            },
        );
    } else if mtbf != mttr {
        let (given, missing) = if mtbf { (1, 2) } else { (2, 1) };
        let fault = Fault::Needs {
            quantity: keys[given].to_string(),
            needs: keys[missing].to_string(),
        };
        reader.refuse(&[keys[given]], fault);
    }
}

impl Reliability {
    /// The probability that a satellite is up; `None` if nothing is said of it.
    #[must_use]
    pub fn satellite_availability(&self) -> Option<f64> {
        let of_times = || Some(self.mtbf_h? / (self.mtbf_h? + self.mttr_h?));
        self.availability.or_else(of_times)
    }
}
