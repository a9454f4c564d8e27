//! The rule for countries.

use serde_json::{Value as Json, json};

use super::list::{read_different, write_list};
use super::{Node, Reading, Rule};
use crate::ground::Country;
use crate::scenario::number::toml_text;

/// A country by its name, or a list of different ones.
pub(in crate::scenario) struct Countries;

/// One country by its name or another name of it; written by the name of the data.
struct OneCountry;

impl Countries {
    pub(in crate::scenario) fn example() -> Vec<Country> {
        Country::find("China").into_iter().collect()
    }
}

impl Rule for OneCountry {
    type Value = Country;

    fn read(&self, node: &Node<'_>, reading: &mut Reading<'_>) -> Option<Country> {
        let Some(name) = node.get_ref().as_str() else {
            reading.refuse(node);
            return None;
        };
        Country::find(name)
            .map_err(|unknown| reading.report(node.span(), unknown))
            .ok()
    }

    fn accepted(&self) -> String {
        "the name of a country".to_owned()
    }

    fn schema(&self) -> Json {
        json!({ "type": "string" })
    }

    fn write(&self, value: &Country) -> String {
        toml_text(value.name())
    }
}

impl Rule for Countries {
    type Value = Vec<Country>;

    fn read(&self, node: &Node<'_>, reading: &mut Reading<'_>) -> Option<Vec<Country>> {
        if node.get_ref().is_str() {
            return Some(vec![OneCountry.read(node, reading)?]);
        }
        let countries = read_different(&OneCountry, node, reading)?;
        if countries.is_empty() {
            reading.refuse(node);
            return None;
        }
        Some(countries)
    }

    fn accepted(&self) -> String {
        "the name of a country, or a list of one or more".to_owned()
    }

    fn schema(&self) -> Json {
        let list = json!({
            "type": "array", "items": OneCountry.schema(), "minItems": 1, "uniqueItems": true,
        });
        json!({ "anyOf": [OneCountry.schema(), list] })
    }

    fn write(&self, value: &Vec<Country>) -> String {
        match value.as_slice() {
            [one] => OneCountry.write(one),
            all => write_list(&OneCountry, all),
        }
    }
}
