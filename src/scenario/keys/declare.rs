//! The macros that declare keys.

/// Declares the keys of a section, each in one place.
///
/// ```text
/// section! {
///     /// What the struct is.
///     #[derive(Debug, Clone, Copy, PartialEq)]
///     pub struct TimeSpan in "time", finish check_samples {
///         /// What the key means, one sentence.
///         pub step_s: f64 = Number::above(0.0), unit "s", default 60.0;
///         /// A key whose default `check_samples` fills in; the example is what the template shows.
///         pub stop_s: f64 = Number::above(0.0), unit "s", follows "duration-h", example 86_400.0;
///         /// A field without a rule is a section too, of the same or another name in the file.
///         pub leap: LeapSeconds;
///     }
/// }
/// ```
///
/// The key is the field's name with hyphens. `impl DesignSpace in "search" { … }` declares the keys
/// of a struct that another module defines, without types and `pub`; `prefix "launch-cost-"` comes
/// before their names.
macro_rules! section {
    (
        $(#[$attribute:meta])*
        $visibility:vis struct $name:ident in $section:literal $(, finish $finish:path)? {
            $(
                $(#[doc = $documentation:literal])+
                pub $field:ident: $type:ty $(= $rule:expr, $($word:ident $value:expr),+)?;
            )+
        }
    ) => {
        $(#[$attribute])*
        $visibility struct $name {
            $($(#[doc = $documentation])+ pub $field: $type,)+
        }

        $crate::scenario::keys::section! {
            impl $name in $section $(, finish $finish)? {
                $(
                    $(#[doc = $documentation])+
                    $field $(= $rule, $($word $value),+)?;
                )+
            }
        }
    };
    (impl $name:ident in $section:literal $(, finish $finish:path)? { $($keys:tt)+ }) => {
        $crate::scenario::keys::section! {
            impl $name in $section, prefix "" $(, finish $finish)? { $($keys)+ }
        }
    };
    (
        impl $name:ident in $section:literal, prefix $prefix:literal $(, finish $finish:path)? {
            $(
                $(#[doc = $documentation:literal])+
                $field:ident $(= $rule:expr, $($word:ident $value:expr),+)?;
            )+
        }
    ) => {
        impl $crate::scenario::keys::Section for $name {
            const SECTION: &'static str = $section;

            fn walk(
                walk: &mut impl $crate::scenario::keys::Walk,
                values: Option<&Self>,
            ) -> Self {
                let gathered = Self {
                    $($field: $crate::scenario::keys::section! {
                        @field walk, values.map(|values| &values.$field),
                        $section, concat!($prefix, stringify!($field)),
                        concat!($($documentation),+)
                        $(, $rule, $($word $value),+)?
                    },)+
                };
                $(let gathered = $crate::scenario::keys::Walk::finish(walk, gathered, $finish);)?
                gathered
            }
        }
    };
    (@field $walk:ident, $value:expr, $section:literal, $name:expr, $documentation:expr) => {
        $crate::scenario::keys::Section::walk($walk, $value)
    };
    (
        @field $walk:ident, $value:expr, $section:literal, $name:expr, $documentation:expr,
        $rule:expr, $($word:ident $setting:expr),+
    ) => {{
        let key = $crate::scenario::keys::Key {
            path: $crate::scenario::keys::KeyPath {
                section: $section,
                name: $crate::scenario::keys::kebab_case!($name),
            },
            documentation: $documentation,
            rule: $rule,
            unit: $crate::scenario::keys::section!(@unit $($word $setting),+),
            default: $crate::scenario::keys::section!(@default $($word $setting),+),
            follows: $crate::scenario::keys::section!(@follows $($word $setting),+),
        };
        $crate::scenario::keys::Walk::key($walk, key, $value)
    }};
    (@unit unit $unit:expr $(, $($rest:tt)+)?) => { $unit };
    (@unit $($rest:tt)+) => { "" };
    (@default unit $unit:expr, $($rest:tt)+) => {
        $crate::scenario::keys::section!(@default $($rest)+)
    };
    (@default default $default:expr) => { $default };
    (@default follows $what:expr, example $example:expr) => { $example };
    (@follows unit $unit:expr, $($rest:tt)+) => {
        $crate::scenario::keys::section!(@follows $($rest)+)
    };
    (@follows default $default:expr) => { None };
    (@follows follows $what:expr, example $example:expr) => { Some($what) };
}

/// The path of the key that is declared with a field: `key!(TimeSpan.step_s)`.
macro_rules! key {
    ($section:ident.$field:ident) => {{
        // This only checks that the field exists.
        let _ = |values: &$section| {
            let _ = &values.$field;
        };
        $crate::scenario::keys::KeyPath {
            section: <$section as $crate::scenario::keys::Section>::SECTION,
            name: $crate::scenario::keys::kebab_case!(stringify!($field)),
        }
    }};
}

/// A constant name with hyphens in place of underscores.
macro_rules! kebab_case {
    ($name:expr) => {
        const {
            const NAME: &str = $name;
            const BYTES: [u8; NAME.len()] = $crate::scenario::keys::kebab_bytes(NAME);
            match std::str::from_utf8(&BYTES) {
                Ok(name) => name,
                Err(_) => NAME,
            }
        }
    };
}

/// The bytes of `name`, all `N`, with hyphens in place of underscores.
pub(in crate::scenario) const fn kebab_bytes<const N: usize>(name: &str) -> [u8; N] {
    let mut bytes = [0; N];
    let mut at = 0;
    while at < N {
        let byte = name.as_bytes()[at];
        bytes[at] = if byte == b'_' { b'-' } else { byte };
        at += 1;
    }
    bytes
}

pub(in crate::scenario) use {kebab_case, key, section};
