//! The columns of a table, taken from the fields of the types that its rows serialise.

use crate::evaluate::{COVERAGE_COLUMNS, COVERAGE_TOTAL_COLUMNS, Metrics};
use serde::de::value::Error;
use serde::de::{Deserialize, Deserializer, Error as _, Visitor};
use serde::ser::Serialize;
use serde_json::Value;

/// The names of a struct's fields as they are serialised, in order.
pub(crate) fn fields<'de, T: Deserialize<'de>>() -> &'static [&'static str] {
    let mut names: &'static [&'static str] = &[];
    // A deserialiser that only collects the names never yields a value.
    let _ = T::deserialize(Listener { names: &mut names });
    names
}

/// Collects the fields that a struct requests.
struct Listener<'a> {
    names: &'a mut &'static [&'static str],
}

impl<'de> Deserializer<'de> for Listener<'_> {
    type Error = Error;

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        fields: &'static [&'static str],
        _visitor: V,
    ) -> Result<V::Value, Error> {
        *self.names = fields;
        Err(Error::custom("only the names were asked for"))
    }

    fn deserialize_any<V: Visitor<'de>>(self, _visitor: V) -> Result<V::Value, Error> {
        Err(Error::custom("no struct"))
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option
        unit unit_struct newtype_struct seq tuple tuple_struct map enum identifier ignored_any
    }
}

/// The columns of the metrics that every scenario has: their fields, and of a coverage the share of each number of
/// satellites.
#[must_use]
pub fn metric_columns() -> Vec<&'static str> {
    let columns = |name: &&'static str| match *name {
        "coverage" => COVERAGE_COLUMNS.to_vec(),
        "coverage_total" => COVERAGE_TOTAL_COLUMNS.to_vec(),
        name => vec![name],
    };
    let always = fields::<Metrics>().iter();
    let always = always.filter(|name| !Metrics::is_on_demand(name));
    always.flat_map(columns).collect()
}

/// The metrics one by one, named and ordered as the columns of tables, those on demand last.
///
/// # Errors
/// Never for metrics.
pub fn metric_values(metrics: &Metrics) -> serde_json::Result<Vec<(String, Value)>> {
    let all = serde_json::to_value(metrics)?;
    let always = metric_columns().into_iter();
    let always = always.map(|name| (name.to_owned(), field(&all, name).clone()));
    let on_demand = metrics.on_demand().into_iter();
    Ok(always
        .chain(on_demand.map(|(name, value)| (name, Value::from(value))))
        .collect())
}

/// The value of a field, or of an element of a field: `coverage_4` is element 4 of `coverage`.
pub(crate) fn field<'a>(row: &'a Value, name: &str) -> &'a Value {
    let element = || {
        let (field, element) = name.rsplit_once('_')?;
        row.get(field)?.get(element)
    };
    row.get(name).or_else(element).unwrap_or(&Value::Null)
}

/// The values of the fields `names` of a struct, in that order, as the cells of a row.
///
/// # Errors
/// If the struct cannot be serialised.
pub(crate) fn cells(row: &impl Serialize, names: &[&str]) -> serde_json::Result<Vec<String>> {
    let value = serde_json::to_value(row)?;
    Ok(names.iter().map(|name| cell(field(&value, name))).collect())
}

/// The shortest digits that round-trip; empty for a missing value.
fn cell(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        Value::Number(number) if number.is_f64() => optional(number.as_f64()),
        other => other.to_string(),
    }
}

/// The shortest digits that round-trip; empty for a metric without a value.
pub(crate) fn optional(value: Option<f64>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::DesignSummary;

    #[derive(serde::Serialize, serde::Deserialize)]
    struct Row {
        whole: f64,
        small: f64,
        count: u64,
        yes: bool,
        none: Option<f64>,
        text: String,
    }

    #[test]
    fn cells_are_the_shortest_digits() {
        let row = Row {
            whole: 925.0,
            small: 1e-7,
            count: 3,
            yes: true,
            none: None,
            text: "a b".to_owned(),
        };
        let names = fields::<Row>();
        assert_eq!(names, ["whole", "small", "count", "yes", "none", "text"]);
        let expected = ["925", "0.0000001", "3", "true", "", "a b"];
        assert_eq!(cells(&row, names).unwrap(), expected);
    }

    /// A table has the same fields of a design as JSON.
    #[test]
    fn every_field_of_json_is_a_column() {
        let design: crate::constellation::Design = "delta:55:182/13/1@925".parse().unwrap();
        let value = serde_json::to_value(DesignSummary::from(&design)).unwrap();
        let keys = value.as_object().unwrap().keys();
        assert!(
            keys.clone()
                .all(|key| DesignSummary::columns().contains(&key.as_str()))
        );
        assert_eq!(keys.count(), DesignSummary::columns().len());
        let metrics = crate::run::testing::member(1, "delta:55:182/13/1@925").metrics;
        let value = serde_json::to_value(metrics).unwrap();
        let numbers = value.as_object().unwrap().values();
        let numbers = numbers.map(|value| value.as_object().map_or(1, serde_json::Map::len));
        let columns = metric_columns();
        assert_eq!(numbers.sum::<usize>(), columns.len());
        let cells = cells(&metrics, &columns).unwrap();
        for (name, cell) in columns.iter().zip(&cells) {
            assert_eq!(
                cell,
                if name.starts_with("cov") { "0" } else { cell },
                "{name}"
            );
        }
    }
}
