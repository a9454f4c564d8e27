//! Walker's notation with pattern and altitude, `delta:55:182/13/1@925[,e=0.01,w=270]`; `+` joins shells. In place of an
//! altitude `repeat:15/1`, and of an inclination `sun-synchronous`, stand for the numbers that they lead to.

use super::{Design, DesignError, Orientation, Shell, ShellParameters, shell_letters};
use crate::keyword::{UnknownKeyword, nearest};
use crate::orbit::relations::{NumberOr, RepeatRatio, inclination_and_altitude};
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// The form of the notation, for error messages.
const FORM: &str = "pattern:inclination:T/P/F@altitude[,e=E][,w=DEG][,raan=DEG][,u=DEG][,node-step=DEG], \
                    e.g. delta:55:182/13/1@925, and + joins shells";

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
    /// An option that does not exist.
    #[error("option '{text}' is unknown{}; {OPTIONS_TOLD}", did_you_mean(*.nearest))]
    UnknownOption {
        /// The option as written.
        text: String,
        /// The option that was most likely meant.
        nearest: Option<&'static str>,
    },
    /// An option without a value.
    #[error("option '{0}' has no value; {OPTIONS_TOLD}")]
    NoValue(String),
    /// The same option twice.
    #[error("option {0} is given twice")]
    RepeatedOption(&'static str),
    /// Nothing before, between or after the `+` of a design.
    #[error("'{0}' has an empty shell: + joins two shells")]
    EmptyShell(String),
    /// An error in one of several shells.
    #[error("shell {letters}: {source}")]
    Shell {
        /// Its letters.
        letters: String,
        /// The error.
        source: Box<NotationError>,
    },
    /// A pattern that does not exist.
    #[error("pattern: {0}")]
    Pattern(#[from] UnknownKeyword),
    /// Numbers that do not describe a design.
    #[error(transparent)]
    Design(#[from] DesignError),
}

/// The names of the options.
const OPTIONS: [&str; 5] = ["e", "w", "raan", "u", "node-step"];

/// The options, for error messages.
const OPTIONS_TOLD: &str = "the options are e=E, w=DEG, raan=DEG, u=DEG and node-step=DEG";

fn did_you_mean(nearest: Option<&str>) -> String {
    nearest.map_or_else(String::new, |name| format!(", did you mean {name}?"))
}

fn number<T: FromStr>(field: &'static str, text: &str) -> Result<T, NotationError> {
    text.parse().map_err(|_| NotationError::Number {
        field,
        text: text.to_owned(),
    })
}

/// A number without an exponent, whose `+` would join shells.
fn decimal(field: &'static str, text: &str) -> Result<f64, NotationError> {
    let value: f64 = number(field, text)?;
    if value.is_finite() && !text.contains(['e', 'E']) {
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
        let shells: Vec<&str> = text.split('+').collect();
        if shells.len() > 1 && shells.iter().any(|shell| shell.trim().is_empty()) {
            return Err(NotationError::EmptyShell(text.to_owned()));
        }
        let parse = |(n, shell): (usize, &&str)| {
            shell
                .parse()
                .map_err(|source: NotationError| match shells.len() {
                    1 => source,
                    _ => NotationError::Shell {
                        letters: shell_letters(n),
                        source: Box::new(source),
                    },
                })
        };
        let shells = shells.iter().enumerate().map(parse);
        Ok(Self::new(shells.collect::<Result<_, _>>()?)?)
    }
}

impl FromStr for Shell {
    type Err = NotationError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let form = || NotationError::Form {
            text: text.to_owned(),
        };
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
        let options = Options::parse(options)?;
        let (inclination_deg, altitude_km) = inclination_and_altitude(
            match inclination.parse() {
                Ok(sun) => NumberOr::Following(sun),
                Err(()) => NumberOr::Number(decimal("inclination", inclination)?),
            },
            if altitude.starts_with(RepeatRatio::PREFIX) {
                NumberOr::Following(altitude.parse().map_err(DesignError::from)?)
            } else {
                NumberOr::Number(decimal("altitude", altitude)?)
            },
            options.eccentricity.unwrap_or(0.0),
        )
        .map_err(DesignError::from)?;
        let shell = Self::new(ShellParameters {
            pattern,
            planes,
            satellites_per_plane: Self::per_plane(satellites, planes)?,
            phasing,
            inclination_deg,
            altitude_km,
        })?;
        options.apply(shell)
    }
}

/// The options after the altitude.
#[derive(Default)]
struct Options {
    eccentricity: Option<f64>,
    arg_perigee_deg: Option<f64>,
    raan_deg: Option<f64>,
    arg_latitude_deg: Option<f64>,
    node_step_deg: Option<f64>,
}

impl Options {
    fn parse<'a>(texts: impl Iterator<Item = &'a str>) -> Result<Self, NotationError> {
        let mut options = Self::default();
        for text in texts {
            let (written, value) = match text.split_once('=') {
                Some((name, value)) => (name, Some(value)),
                None => (text, None),
            };
            let Some(name) = OPTIONS.into_iter().find(|name| *name == written) else {
                return Err(NotationError::UnknownOption {
                    text: text.to_owned(),
                    nearest: nearest(written, &OPTIONS),
                });
            };
            let (place, field) = match name {
                "e" => (&mut options.eccentricity, "eccentricity e"),
                "w" => (&mut options.arg_perigee_deg, "argument of perigee w"),
                "raan" => (&mut options.raan_deg, "right ascension of the node raan"),
                "u" => (&mut options.arg_latitude_deg, "argument of latitude u"),
                _ => (&mut options.node_step_deg, "node-step"),
            };
            let Some(value) = value.filter(|value| !value.is_empty()) else {
                return Err(NotationError::NoValue(text.to_owned()));
            };
            if place.replace(decimal(field, value)?).is_some() {
                return Err(NotationError::RepeatedOption(name));
            }
        }
        Ok(options)
    }

    fn apply(self, shell: Shell) -> Result<Shell, NotationError> {
        let shell = shell.with_ellipse(
            self.eccentricity.unwrap_or(0.0),
            self.arg_perigee_deg.unwrap_or(0.0),
        )?;
        Ok(shell.with_orientation(Orientation {
            raan_deg: self.raan_deg.unwrap_or(0.0),
            arg_latitude_deg: self.arg_latitude_deg,
            node_step_deg: self.node_step_deg,
        })?)
    }
}

impl fmt::Display for Design {
    /// The shells joined by `+`, each in the shortest digits that round-trip.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let shells: Vec<String> = self.shells().iter().map(Shell::to_string).collect();
        formatter.pad(&shells.join("+"))
    }
}

impl fmt::Display for Shell {
    /// The shortest digits that round-trip to the same shell.
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
        let orientation = self.orientation();
        let other_than_zero = |value: f64| (value != 0.0).then_some(value);
        let options = [
            ("e", other_than_zero(self.eccentricity())),
            ("w", other_than_zero(self.arg_perigee_deg())),
            ("raan", other_than_zero(orientation.raan_deg)),
            ("u", orientation.arg_latitude_deg),
            ("node-step", orientation.node_step_deg),
        ];
        for (name, value) in options {
            if let Some(value) = value {
                text += &format!(",{name}={value}");
            }
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
            "star:86.4:66/6/3@780,node-step=31.6",
            "delta:53:160/10/1@1000+star:90:40/5/1@1100",
            "delta:53:24/3/1@1000,raan=12.5,u=0+delta:53:24/3/1@1000,raan=72.5,u=359.5,node-step=-40",
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
        assert_eq!(
            error("delta:55:182/13/1@925,ran=5"),
            "option 'ran=5' is unknown, did you mean raan?; the options are e=E, w=DEG, raan=DEG, u=DEG and \
             node-step=DEG"
        );
        assert!(error("delta:55:182/13/1@925,raan").starts_with("option 'raan' has no value"));
        assert_eq!(
            error("delta:55:182/13/1@925,e=0,e=0"),
            "option e is given twice"
        );
        assert_eq!(
            error("delta:55:183/13/0@925"),
            "satellites T = 183 is not a multiple of planes P = 13; nearest: 182 or 195"
        );
        assert_eq!(
            error("delta:55:10/0/0@925"),
            "planes P = 0; at least one plane is needed"
        );
        assert!(error("delta:55:4/2/1@925,e=0.95").contains("outside [0, 0.9)"));
        assert!(error("delta:55:4/2/1@1e3").starts_with("altitude '1e3' is not a number"));
        assert_eq!(
            error("delta:55:4/2/1@925+"),
            "'delta:55:4/2/1@925+' has an empty shell: + joins two shells"
        );
        assert_eq!(
            error("delta:55:4/2/1@925+delta:40:4/2/2@925"),
            "shell B: phasing F = 2 is outside 0 to P - 1 = 1"
        );
        assert_eq!(
            error("delta:55:4/2/1@925+delta:55:0/2/1@925"),
            "shell B: satellites T = 0; at least one satellite is needed"
        );
    }

    proptest! {
        #[test]
        fn any_design_round_trips(
            pattern in prop::sample::select(<Pattern as Keyword>::ALL.to_vec()),
            planes in 1_usize..40, satellites_per_plane in 1_usize..40, f in 0_usize..40,
            inclination_deg in 0.0..180.0_f64, altitude_km in 200.0..30_000.0_f64,
            e in 0.0..0.02_f64, w in 0.0..360.0_f64, raan_deg in 0.0..360.0_f64,
            u in prop::option::of(0.0..360.0_f64), step in prop::option::of(-360.0..360.0_f64),
            copies in 1_usize..4,
        ) {
            let parameters = ShellParameters {
                pattern,
                planes,
                satellites_per_plane,
                phasing: f % planes,
                inclination_deg,
                altitude_km,
            };
            let orientation = Orientation {
                raan_deg,
                arg_latitude_deg: u,
                node_step_deg: step.filter(|_| pattern != Pattern::Lattice),
            };
            let shell = Shell::new(parameters).unwrap().with_ellipse(e, w).unwrap();
            let turned = shell.with_orientation(orientation).unwrap();
            let mut shells = vec![turned; copies];
            shells[0] = shell;
            let design = Design::new(shells).unwrap();
            prop_assert_eq!(design.to_string().parse::<Design>().unwrap(), design);
        }

        #[test]
        fn arbitrary_text_never_panics(text in "\\PC{0,60}") {
            let _ = text.parse::<Design>();
        }
    }
}
