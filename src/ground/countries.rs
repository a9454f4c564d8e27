//! Countries of the world by name, from Natural Earth, which is in the public domain; see `data/MANIFEST.toml`.

use super::ServiceArea;
use super::area::Ring;
use std::fmt;
use std::sync::LazyLock;
use thiserror::Error;

/// 1:110 million.
const WORLD: &str = include_str!("../../data/countries/world-110m.txt");

/// Other names of countries: alias, name.
const ALIASES: [(&str, &str); 60] = [
    ("America", "United States of America"),
    ("Bosnia", "Bosnia and Herzegovina"),
    ("Britain", "United Kingdom"),
    ("Burma", "Myanmar"),
    ("CAR", "Central African Republic"),
    ("Congo-Brazzaville", "Republic of the Congo"),
    ("Congo-Kinshasa", "Democratic Republic of the Congo"),
    ("Cote d'Ivoire", "Côte d'Ivoire"),
    ("Czech Republic", "Czechia"),
    ("Deutschland", "Germany"),
    ("DPRK", "North Korea"),
    ("Democratic People's Republic of Korea", "North Korea"),
    ("Dem. Rep. Congo", "Democratic Republic of the Congo"),
    ("DR Congo", "Democratic Republic of the Congo"),
    ("DRC", "Democratic Republic of the Congo"),
    ("Dominican Rep.", "Dominican Republic"),
    ("East Timor", "Timor-Leste"),
    ("Eire", "Ireland"),
    ("Eq. Guinea", "Equatorial Guinea"),
    ("Espana", "Spain"),
    ("Falklands", "Falkland Islands"),
    ("FYROM", "North Macedonia"),
    ("GB", "United Kingdom"),
    ("Great Britain", "United Kingdom"),
    ("Hellas", "Greece"),
    ("Holland", "Netherlands"),
    ("Islamic Republic of Iran", "Iran"),
    ("Ivory Coast", "Côte d'Ivoire"),
    ("Kyrgyz Republic", "Kyrgyzstan"),
    ("Lao PDR", "Laos"),
    ("Macedonia", "North Macedonia"),
    ("Malvinas", "Falkland Islands"),
    ("N. Cyprus", "Northern Cyprus"),
    ("Nippon", "Japan"),
    ("Palestinian Territories", "Palestine"),
    ("People's Republic of China", "China"),
    ("Persia", "Iran"),
    ("PRC", "China"),
    ("Republic of China", "Taiwan"),
    ("Republic of Ireland", "Ireland"),
    ("Republic of Korea", "South Korea"),
    ("Republic of Moldova", "Moldova"),
    ("ROK", "South Korea"),
    ("RSA", "South Africa"),
    ("Russian Federation", "Russia"),
    ("S. Sudan", "South Sudan"),
    ("Swaziland", "Eswatini"),
    ("Syrian Arab Republic", "Syria"),
    ("Trinidad", "Trinidad and Tobago"),
    ("Turkiye", "Turkey"),
    ("UAE", "United Arab Emirates"),
    ("UK", "United Kingdom"),
    ("United Republic of Tanzania", "Tanzania"),
    ("United States", "United States of America"),
    ("US", "United States of America"),
    ("USA", "United States of America"),
    ("Viet Nam", "Vietnam"),
    ("W. Sahara", "Western Sahara"),
    ("Brunei Darussalam", "Brunei"),
    ("Zaire", "Democratic Republic of the Congo"),
];

/// Names that two countries share; which of them is meant is asked.
const SHARED: [(&str, [&str; 2]); 2] = [
    ("Korea", ["North Korea", "South Korea"]),
    (
        "Congo",
        ["Democratic Republic of the Congo", "Republic of the Congo"],
    ),
];

/// Below this Jaro-Winkler similarity (0 to 1) a country is not worth suggesting.
const WORTH_SUGGESTING: f64 = 0.8;

/// Most countries that are suggested.
const MOST_SUGGESTED: usize = 3;

/// A name that is not one of a country.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "unknown country {found:?}{} (the 177 countries of Natural Earth 1:110m, which leaves out small states; give other \
     areas as region.polygon)",
    did_you_mean(.nearest)
)]
pub struct UnknownCountry {
    /// The name as written.
    pub found: String,
    /// The names most like it, the nearest first.
    pub nearest: Vec<&'static str>,
}

fn did_you_mean(nearest: &[&str]) -> String {
    let quoted: Vec<String> = nearest.iter().map(|name| format!("{name:?}")).collect();
    match quoted.as_slice() {
        [] => String::new(),
        [one] => format!(", did you mean {one}?"),
        [all @ .., last] => format!(", did you mean {} or {last}?", all.join(", ")),
    }
}

/// A country of the built-in data.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Country(usize);

/// Name, key of the name, and polygons, in the order of the file.
struct CountryEntry {
    name: &'static str,
    key: String,
    polygons: Vec<Vec<Ring>>,
}

static ALL: LazyLock<Vec<CountryEntry>> = LazyLock::new(|| read(WORLD));

fn read(text: &'static str) -> Vec<CountryEntry> {
    let mut all: Vec<CountryEntry> = Vec::new();
    for line in text.lines() {
        if let Some(name) = line.strip_prefix("= ") {
            all.push(CountryEntry {
                name,
                key: key(name),
                polygons: Vec::new(),
            });
            continue;
        }
        let Some(entry) = all.last_mut() else {
            continue;
        };
        match (line.strip_prefix("hole "), entry.polygons.last_mut()) {
            (Some(hole), Some(polygon)) => polygon.push(ring(hole)),
            _ => entry.polygons.push(vec![ring(line)]),
        }
    }
    all
}

/// Positions from thousandths of a degree.
fn ring(line: &str) -> Ring {
    let numbers = line.split_ascii_whitespace();
    let numbers: Vec<f64> = numbers.filter_map(|x| x.parse().ok()).collect();
    let position = |pair: &[f64]| [pair[0] / 1000.0, pair[1] / 1000.0];
    numbers.chunks_exact(2).map(position).collect()
}

/// A name without case, accents, dots, hyphens and a leading article.
fn key(name: &str) -> String {
    let mut plain = String::with_capacity(name.len());
    for letter in name.to_lowercase().chars() {
        match letter {
            'à'..='å' | 'ā' => plain.push('a'),
            'ç' => plain.push('c'),
            'è'..='ë' | 'ē' => plain.push('e'),
            'ì'..='ï' | 'ı' | 'ī' => plain.push('i'),
            'ñ' => plain.push('n'),
            'ò'..='ö' | 'ø' | 'ō' => plain.push('o'),
            'ù'..='ü' | 'ū' => plain.push('u'),
            // The dot of a capital I in Turkish, the dots of abbreviations, apostrophes.
            '\u{307}' | '.' | '\'' | '’' | ',' => {}
            '-' | '_' => plain.push(' '),
            '&' => plain.push_str("and"),
            other => plain.push(other),
        }
    }
    let words: Vec<&str> = plain.split_whitespace().collect();
    let words = match words.as_slice() {
        ["the", rest @ ..] if !rest.is_empty() => rest,
        all => all,
    };
    words.join(" ")
}

impl Country {
    /// All countries, by name.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..ALL.len()).map(Self)
    }

    /// The country of a name or an alias; case, accents, dots and hyphens do not matter.
    ///
    /// # Errors
    /// [`UnknownCountry`], with the nearest names.
    pub fn find(name: &str) -> Result<Self, UnknownCountry> {
        let wanted = key(name);
        let named = |key: &str| ALL.iter().position(|entry| entry.key == key).map(Self);
        let alias = || {
            let mut aliases = ALIASES.iter();
            let (_, name) = aliases.find(|(alias, _)| key(alias) == wanted)?;
            named(&key(name))
        };
        named(&wanted).or_else(alias).ok_or_else(|| UnknownCountry {
            found: name.to_owned(),
            nearest: match SHARED.iter().find(|(shared, _)| key(shared) == wanted) {
                Some((_, both)) => both.to_vec(),
                None => nearest(&wanted),
            },
        })
    }

    /// Its name in English.
    #[must_use]
    pub fn name(self) -> &'static str {
        ALL[self.0].name
    }

    /// The area of several countries together.
    #[must_use]
    pub fn area(countries: &[Self]) -> ServiceArea {
        let polygons = countries
            .iter()
            .flat_map(|country| ALL[country.0].polygons.iter());
        ServiceArea::of_polygons(polygons.cloned().collect())
    }
}

impl fmt::Display for Country {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// The names most like a key, of countries and of aliases.
fn nearest(wanted: &str) -> Vec<&'static str> {
    let names = ALL.iter().map(|entry| (entry.key.clone(), entry.name));
    let aliases = ALIASES.iter().map(|(alias, name)| (key(alias), *name));
    let mut alike: Vec<(f64, &str)> = names
        .chain(aliases)
        .map(|(key, name)| (strsim::jaro_winkler(wanted, &key), name))
        .filter(|(similarity, _)| *similarity >= WORTH_SUGGESTING)
        .collect();
    alike.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut names: Vec<&str> = Vec::new();
    for (_, name) in alike {
        if !names.contains(&name) && names.len() < MOST_SUGGESTED {
            names.push(name);
        }
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::earth::Surface;

    fn found(name: &str) -> &'static str {
        Country::find(name).unwrap().name()
    }

    #[test]
    fn there_are_177_countries_whose_borders_are_sound() {
        assert_eq!(Country::all().count(), 177);
        let mut unsound = Vec::new();
        for country in Country::all() {
            let area = Country::area(&[country]);
            unsound.extend(
                area.check()
                    .err()
                    .map(|error| format!("{country}: {error}")),
            );
            assert!(area.area_km2(Surface::Wgs84) > 1000.0, "{country}");
        }
        // A loop of 3 km in the data.
        let known =
            "Sudan: : the border crosses itself near longitude 33.9629, latitude 9.4643 degrees";
        assert_eq!(unsound, [known]);
    }

    #[test]
    fn names_ignore_case_accents_and_dots() {
        for (written, name) in [
            ("China", "China"),
            ("cote d'ivoire", "Côte d'Ivoire"),
            ("CÔTE D’IVOIRE", "Côte d'Ivoire"),
            ("Ivory Coast", "Côte d'Ivoire"),
            ("u.s.a.", "United States of America"),
            ("The United States", "United States of America"),
            ("uk", "United Kingdom"),
            ("Czech Republic", "Czechia"),
            ("Türkiye", "Turkey"),
            ("TÜRKİYE", "Turkey"),
            ("D.R. Congo", "Democratic Republic of the Congo"),
            ("timor leste", "Timor-Leste"),
            ("Guinea Bissau", "Guinea-Bissau"),
            ("Burma", "Myanmar"),
            ("eSwatini", "Eswatini"),
            ("macedonia", "North Macedonia"),
            ("Trinidad & Tobago", "Trinidad and Tobago"),
        ] {
            assert_eq!(found(written), name, "{written}");
        }
        for (alias, name) in ALIASES {
            assert_eq!(found(alias), name, "{alias}");
        }
    }

    #[test]
    fn an_unknown_country_is_told_with_the_nearest() {
        let error = Country::find("Germny").unwrap_err().to_string();
        assert_eq!(
            error,
            "unknown country \"Germny\", did you mean \"Germany\"? (the 177 countries of Natural Earth 1:110m, which leaves out \
             small states; give other areas as region.polygon)"
        );
        let both = Country::find("korea").unwrap_err();
        assert_eq!(both.nearest, ["North Korea", "South Korea"]);
        assert_eq!(Country::find("Congo").unwrap_err().nearest.len(), 2);
        assert!(
            SHARED
                .iter()
                .flat_map(|(_, both)| both)
                .all(|name| Country::find(name).is_ok())
        );
        let several = Country::find("Korea North").unwrap_err();
        assert!(
            several.nearest.len() <= MOST_SUGGESTED && several.nearest.contains(&"South Korea"),
            "{several}"
        );
        let none = Country::find("Liechtenstein").unwrap_err();
        assert!(
            none.to_string().contains("leaves out small states"),
            "{none}"
        );
    }

    /// Areas in km², of the CIA World Factbook (total, with inland waters), against those of the polygons: at 1:110 million,
    /// simplified by some 20 km, they are within 4 % for countries of this size.
    #[test]
    fn validate_areas_of_countries() {
        for (name, area_km2) in [
            ("China", 9_596_960.0),
            ("Brazil", 8_515_770.0),
            ("Germany", 357_022.0),
            ("South Africa", 1_219_090.0),
            ("Russia", 17_098_242.0),
        ] {
            let country = Country::find(name).unwrap();
            let found = Country::area(&[country]).area_km2(Surface::Wgs84);
            assert!((found / area_km2 - 1.0).abs() < 0.04, "{name} {found}");
        }
    }

    #[test]
    fn places_are_in_their_countries() {
        for (name, latitude, longitude, inside) in [
            ("China", 39.9, 116.4, true),
            ("China", 35.7, 139.7, false),
            ("France", 48.86, 2.35, true),
            ("South Africa", -29.6, 28.2, false),
            ("Lesotho", -29.6, 28.2, true),
            // On both sides of the antimeridian.
            ("Russia", 66.0, 179.0, true),
            ("Russia", 66.0, -175.0, true),
            ("Russia", 66.0, 185.0, true),
            ("Fiji", -17.8, 178.0, true),
            ("Antarctica", -90.0, 12.0, true),
            ("Antarctica", -60.0, 12.0, false),
        ] {
            let area = Country::area(&[Country::find(name).unwrap()]);
            assert_eq!(
                area.contains(latitude, longitude),
                inside,
                "{name} {latitude} {longitude}"
            );
        }
    }
}
