//! Walker's notation with pattern and altitude: `delta:55:182/13/1@925[,e=0.01,w=270]`.

use super::{Design, DesignError, DesignParameters};
use crate::keyword::UnknownKeyword;
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// The form of the notation, for error messages.
const FORM: &str = "pattern:inclination:T/P/F@altitude[,e=E][,w=DEG], e.g. delta:55:182/13/1@925";

/// Why a text is not a design.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum NotationError {
    /// The separators are missing or misplaced.
    #[error("'{text}' is not a design; the form is {FORM}")]
    Form {
        /// The text.
        text: String,
    },
    /// A field that is not a number.
    #[error("{field} '{text}' is not a number; the form is {FORM}")]
    Number {
        /// The field.
        field: &'static str,
        /// The text found.
        text: String,
    },
    /// An option other than `e` and `w`, or the same one twice.
    #[error("option '{0}' is unknown or given twice; the options are e=E and w=DEG")]
    Option(String),
    /// Several shells.
    #[error("'+' is reserved for designs of several shells, which are not supported yet")]
    SeveralShells,
    /// A pattern that does not exist.
    #[error("pattern: {0}")]
    Pattern(#[from] UnknownKeyword),
    /// Numbers that do not describe a design.
    #[error(transparent)]
    Design(#[from] DesignError),
}

fn number<T: FromStr>(field: &'static str, text: &str) -> Result<T, NotationError> {
    text.parse().map_err(|_| NotationError::Number {
        field,
        text: text.to_owned(),
    })
}

fn decimal(field: &'static str, text: &str) -> Result<f64, NotationError> {
    let value: f64 = number(field, text)?;
    if value.is_finite() {
        Ok(value)
    } else {
        Err(NotationError::Number {
            field,
            text: text.to_owned(),
        })
    }
}

impl FromStr for Design {
    type Err = NotationError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let form = || NotationError::Form {
            text: text.to_owned(),
        };
        if text.contains('+') {
            return Err(NotationError::SeveralShells);
        }
        let (pattern, rest) = text.split_once(':').ok_or_else(form)?;
        let (inclination, rest) = rest.split_once(':').ok_or_else(form)?;
        let (counts, rest) = rest.split_once('@').ok_or_else(form)?;
        let [t, p, f] = counts
            .split('/')
            .collect::<Vec<_>>()
            .try_into()
            .map_err(|_| form())?;
        let mut options = rest.split(',');
        let altitude = options.next().unwrap_or_default();
        let pattern = pattern.parse()?;
        let satellites = number("satellites T", t)?;
        let planes = number("planes P", p)?;
        let phasing = number("phasing F", f)?;
        let inclination_deg = decimal("inclination", inclination)?;
        let altitude_km = decimal("altitude", altitude)?;
        let design = Self::new(DesignParameters {
            pattern,
            planes,
            satellites_per_plane: Self::per_plane(satellites, planes)?,
            phasing,
            inclination_deg,
            altitude_km,
        })?;
        let (mut eccentricity, mut arg_perigee_deg) = (None, None);
        for option in options {
            let (slot, field, value) = match option.split_once('=') {
                Some(("e", value)) => (&mut eccentricity, "eccentricity e", value),
                Some(("w", value)) => (&mut arg_perigee_deg, "argument of perigee w", value),
                _ => return Err(NotationError::Option(option.to_owned())),
            };
            if slot.replace(decimal(field, value)?).is_some() {
                return Err(NotationError::Option(option.to_owned()));
            }
        }
        let design =
            design.with_ellipse(eccentricity.unwrap_or(0.0), arg_perigee_deg.unwrap_or(0.0))?;
        Ok(design)
    }
}

impl fmt::Display for Design {
    /// The shortest digits that round-trip to the same design.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut text = format!(
            "{}:{}:{}/{}/{}@{}",
            self.pattern(),
            self.inclination_deg(),
            self.satellite_count(),
            self.planes(),
            self.phasing(),
            self.altitude_km()
        );
        if self.eccentricity() != 0.0 {
            text += &format!(",e={}", self.eccentricity());
        }
        if self.arg_perigee_deg() != 0.0 {
            text += &format!(",w={}", self.arg_perigee_deg());
        }
        formatter.pad(&text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constellation::Pattern;
    use crate::keyword::Keyword;
    use proptest::prelude::*;

    fn error(text: &str) -> String {
        text.parse::<Design>().unwrap_err().to_string()
    }

    #[test]
    fn notation_of_the_documentation() {
        for text in [
            "delta:55:182/13/1@925",
            "star:90:182/13/1@925",
            "lattice:63.4:182/13/5@950,e=0.01,w=270",
            "delta:43.8274:225/15/1@1000,w=90",
        ] {
            assert_eq!(text.parse::<Design>().unwrap().to_string(), text);
        }
        let spelled = "delta:55.0:182/13/1@925.000,e=0,w=360"
            .parse::<Design>()
            .unwrap();
        assert_eq!(spelled.to_string(), "delta:55:182/13/1@925");
    }

    #[test]
    fn errors_say_what_is_wrong() {
        assert!(error("delta").starts_with("'delta' is not a design; the form is pattern:"));
        assert!(error("delta:55:182/13@925").contains("is not a design"));
        assert!(error("delta:55:182/13/-1@925").starts_with("phasing F '-1' is not a number"));
        assert!(error("delta:x:182/13/1@925").starts_with("inclination 'x' is not a number"));
        assert!(error("delta:55:182/13/1@nan").starts_with("altitude 'nan' is not a number"));
        assert!(error("helix:55:182/13/1@925").contains("(choices: delta, star, lattice)"));
        assert!(error("delta:55:182/13/1@925,f=3").starts_with("option 'f=3' is unknown"));
        assert!(error("delta:55:182/13/1@925,e=0,e=0").contains("given twice"));
        assert_eq!(
            error("delta:55:183/13/0@925"),
            "satellites T = 183 is not a multiple of planes P = 13; nearest: 182 or 195"
        );
        assert_eq!(
            error("delta:55:10/0/0@925"),
            "planes P = 0; at least one plane is needed"
        );
        assert!(error("delta:55:4/2/1@925,e=0.95").contains("outside [0, 0.9)"));
        assert!(error("delta:55:4/2/1@925+delta:40:4/2/1@925").contains("several shells"));
    }

    proptest! {
        #[test]
        fn any_design_round_trips(
            pattern in prop::sample::select(<Pattern as Keyword>::ALL.to_vec()),
            planes in 1_usize..40, satellites_per_plane in 1_usize..40, f in 0_usize..40,
            inclination_deg in 0.0..180.0_f64, altitude_km in 200.0..30_000.0_f64,
            e in 0.0..0.02_f64, w in 0.0..360.0_f64,
        ) {
            let parameters = DesignParameters {
                pattern,
                planes,
                satellites_per_plane,
                phasing: f % planes,
                inclination_deg,
                altitude_km,
            };
            let design = Design::new(parameters).unwrap().with_ellipse(e, w).unwrap();
            prop_assert_eq!(design.to_string().parse::<Design>().unwrap(), design);
        }

        #[test]
        fn arbitrary_text_never_panics(text in "\\PC{0,60}") {
            let _ = text.parse::<Design>();
        }
    }
}
