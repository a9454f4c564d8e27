//! The keyword tables of the CCSDS Orbit Data Messages: where each keyword belongs, whether it is mandatory, its unit.

/// Whether a keyword is mandatory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Need {
    Mandatory,
    /// Mandatory, but catalogues leave its value empty.
    Named,
    /// Mandatory in the standard, but missing so often that its absence is tolerated.
    Expected,
    Optional,
}

/// The type of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ValueKind {
    /// A text, a time or a count.
    Text,
    /// A number, and the unit that may follow it (7.7).
    Number(Option<&'static str>),
}

/// A keyword of a table: whether it is mandatory, and the type of its value.
pub(crate) struct KvnKeyword {
    pub(super) name: &'static str,
    pub(super) need: Need,
    pub(super) kind: ValueKind,
}

impl KvnKeyword {
    const fn new(name: &'static str, need: Need) -> Self {
        let kind = ValueKind::Text;
        Self { name, need, kind }
    }

    /// A number without a unit.
    pub(crate) const fn number(self) -> Self {
        let kind = ValueKind::Number(None);
        Self { kind, ..self }
    }

    /// A number in a unit.
    pub(crate) const fn unit(self, unit: &'static str) -> Self {
        let kind = ValueKind::Number(Some(unit));
        Self { kind, ..self }
    }
}

/// A mandatory keyword.
pub(crate) const fn must(name: &'static str) -> KvnKeyword {
    KvnKeyword::new(name, Need::Mandatory)
}

/// A mandatory keyword whose value catalogues leave empty.
pub(crate) const fn named(name: &'static str) -> KvnKeyword {
    KvnKeyword::new(name, Need::Named)
}

/// A keyword that is mandatory in the standard but whose absence is tolerated.
pub(crate) const fn should(name: &'static str) -> KvnKeyword {
    KvnKeyword::new(name, Need::Expected)
}

/// An optional keyword.
pub(crate) const fn may(name: &'static str) -> KvnKeyword {
    KvnKeyword::new(name, Need::Optional)
}

/// The spacecraft parameters of an OPM and an OMM (tables 3-3 and 4-3).
pub(crate) const SPACECRAFT: &[KvnKeyword] = &[
    may("MASS").unit("kg"),
    may("SOLAR_RAD_AREA").unit("m**2"),
    may("SOLAR_RAD_COEFF").number(),
    may("DRAG_AREA").unit("m**2"),
    may("DRAG_COEFF").number(),
];

/// Units of a covariance: of positions, positions and velocities, and velocities.
const PP: &str = "km**2";
const PV: &str = "km**2/s";
const VV: &str = "km**2/s**2";

/// The frame and the elements of a covariance matrix, at the end of an OPM or an OMM (tables
/// 3-3 and 4-3).
pub(crate) const COVARIANCE: &[KvnKeyword] = &[
    may("COV_REF_FRAME"),
    may("CX_X").unit(PP),
    may("CY_X").unit(PP),
    may("CY_Y").unit(PP),
    may("CZ_X").unit(PP),
    may("CZ_Y").unit(PP),
    may("CZ_Z").unit(PP),
    may("CX_DOT_X").unit(PV),
    may("CX_DOT_Y").unit(PV),
    may("CX_DOT_Z").unit(PV),
    may("CX_DOT_X_DOT").unit(VV),
    may("CY_DOT_X").unit(PV),
    may("CY_DOT_Y").unit(PV),
    may("CY_DOT_Z").unit(PV),
    may("CY_DOT_X_DOT").unit(VV),
    may("CY_DOT_Y_DOT").unit(VV),
    may("CZ_DOT_X").unit(PV),
    may("CZ_DOT_Y").unit(PV),
    may("CZ_DOT_Z").unit(PV),
    may("CZ_DOT_X_DOT").unit(VV),
    may("CZ_DOT_Y_DOT").unit(VV),
    may("CZ_DOT_Z_DOT").unit(VV),
];
