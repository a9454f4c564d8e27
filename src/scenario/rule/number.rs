//! Rules for numbers and intervals.

use std::fmt::Display;
use std::ops::{Bound, RangeBounds};

use serde_json::{Map, Value as Json, json};
use toml::de::DeValue;

use super::{Node, Reading, Rule};
use crate::ground::LONGITUDES_DEG;
use crate::scenario::number::toml_number;
use crate::scenario::problem::Fault;

/// A finite number within bounds.
pub(in crate::scenario) struct Number {
    low: Bound<f64>,
    high: Bound<f64>,
}

impl Number {
    pub(in crate::scenario) const fn from_to(low: f64, high: f64) -> Self {
        Self {
            low: Bound::Included(low),
            high: Bound::Included(high),
        }
    }

    pub(in crate::scenario) const fn from_below(low: f64, high: f64) -> Self {
        Self {
            low: Bound::Included(low),
            high: Bound::Excluded(high),
        }
    }

    pub(in crate::scenario) const fn at_least(low: f64) -> Self {
        Self {
            low: Bound::Included(low),
            high: Bound::Unbounded,
        }
    }

    pub(in crate::scenario) const fn above(low: f64) -> Self {
        Self {
            low: Bound::Excluded(low),
            high: Bound::Unbounded,
        }
    }

    pub(in crate::scenario) const fn above_to(low: f64, high: f64) -> Self {
        Self {
            low: Bound::Excluded(low),
            high: Bound::Included(high),
        }
    }

    pub(in crate::scenario) const fn between(low: f64, high: f64) -> Self {
        Self {
            low: Bound::Excluded(low),
            high: Bound::Excluded(high),
        }
    }

    pub(in crate::scenario) const fn any() -> Self {
        Self {
            low: Bound::Unbounded,
            high: Bound::Unbounded,
        }
    }

    pub(super) fn range(&self) -> String {
        let low = match self.low {
            Bound::Included(low) => Some(format!(">= {low}")),
            Bound::Excluded(low) => Some(format!("> {low}")),
            Bound::Unbounded => None,
        };
        let high = match self.high {
            Bound::Included(high) => Some(format!("<= {high}")),
            Bound::Excluded(high) => Some(format!("< {high}")),
            Bound::Unbounded => None,
        };
        let limits: Vec<String> = low.into_iter().chain(high).collect();
        limits.join(" and ")
    }
}

impl Rule for Number {
    type Value = f64;

    fn read(&self, node: &Node<'_>, reading: &mut Reading<'_>) -> Option<f64> {
        let number = as_number(node.get_ref())
            .filter(|number| number.is_finite() && (self.low, self.high).contains(number));
        if number.is_none() {
            reading.refuse(node);
        }
        number
    }

    fn accepted(&self) -> String {
        format!("a number {}", self.range()).trim_end().to_owned()
    }

    fn schema(&self) -> Json {
        let mut schema = Map::new();
        schema.insert("type".into(), "number".into());
        for (inclusive, exclusive, bound) in [
            ("minimum", "exclusiveMinimum", self.low),
            ("maximum", "exclusiveMaximum", self.high),
        ] {
            match bound {
                Bound::Included(bound) => schema.insert(inclusive.into(), bound.into()),
                Bound::Excluded(bound) => schema.insert(exclusive.into(), bound.into()),
                Bound::Unbounded => None,
            };
        }
        Json::Object(schema)
    }

    fn write(&self, value: &f64) -> String {
        toml_number(*value)
    }
}

/// The nearest `f64` to an integer or float; adding zero turns -0 into 0, so that equal values are
/// written alike.
fn as_number(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str().parse::<f64>().ok(),
        DeValue::Integer(_) => as_integer(value).map(|integer| integer as f64),
        DeValue::Float(float) => float.as_str().parse().ok(),
        _ => None,
    }
    .map(|number| number + 0.0)
}

/// The value of an integer, or of a float that is whole and small enough to be exact.
fn as_integer(value: &DeValue<'_>) -> Option<i128> {
    const EXACT: f64 = 9_007_199_254_740_992.0;
    match value {
        DeValue::Integer(integer) => i128::from_str_radix(integer.as_str(), integer.radix()).ok(),
        DeValue::Float(float) => {
            let number: f64 = float.as_str().parse().ok()?;
            (number.fract() == 0.0 && number.abs() <= EXACT).then_some(number as i128)
        }
        _ => None,
    }
}

/// An integer within bounds, both included.
pub(in crate::scenario) struct Integer<T> {
    pub(in crate::scenario) low: T,
    pub(in crate::scenario) high: T,
}

impl<T> Rule for Integer<T>
where
    T: Copy + Display + PartialOrd + Sync + TryFrom<i128> + Into<u64>,
{
    type Value = T;

    fn read(&self, node: &Node<'_>, reading: &mut Reading<'_>) -> Option<T> {
        let integer = as_integer(node.get_ref())
            .and_then(|integer| T::try_from(integer).ok())
            .filter(|integer| (self.low..=self.high).contains(integer));
        if integer.is_none() {
            reading.refuse(node);
        }
        integer
    }

    fn accepted(&self) -> String {
        format!("an integer >= {} and <= {}", self.low, self.high)
    }

    fn schema(&self) -> Json {
        let (low, high): (u64, u64) = (self.low.into(), self.high.into());
        json!({ "type": "integer", "minimum": low, "maximum": high })
    }

    fn write(&self, value: &T) -> String {
        value.to_string()
    }
}

/// Two values in rising order.
pub(in crate::scenario) struct Interval<R> {
    pub(in crate::scenario) of: R,
    /// Whether a single value gives both limits.
    pub(in crate::scenario) or_single: bool,
}

impl<R: Rule<Value: Copy + PartialOrd>> Rule for Interval<R> {
    type Value = [R::Value; 2];

    fn read(&self, node: &Node<'_>, reading: &mut Reading<'_>) -> Option<Self::Value> {
        if self.or_single && !node.get_ref().is_array() {
            return self.of.read(node, reading).map(|value| [value, value]);
        }
        let [low, high] = read_pair([&self.of; 2], node, reading)?;
        if low > high {
            let found = reading.written(node);
            reading.report(node.span(), Fault::Reversed { found });
            return None;
        }
        Some([low, high])
    }

    fn accepted(&self) -> String {
        let single = if self.or_single {
            ", or one for both"
        } else {
            ""
        };
        format!("[low, high], each {}{single}", self.of.accepted())
    }

    fn schema(&self) -> Json {
        let pair = pair_schema(&self.of);
        if self.or_single {
            json!({ "oneOf": [self.of.schema(), pair] })
        } else {
            pair
        }
    }

    fn write(&self, value: &Self::Value) -> String {
        if self.or_single && value[0] == value[1] {
            self.of.write(&value[0])
        } else {
            write_pair(&self.of, value)
        }
    }
}

/// A western and an eastern longitude in degrees; 360 is added to the second if it is the smaller.
pub(in crate::scenario) struct Eastward;

impl Eastward {
    const EACH: Number = Number::from_to(LONGITUDES_DEG[0], LONGITUDES_DEG[1]);
}

impl Rule for Eastward {
    type Value = [f64; 2];

    fn read(&self, node: &Node<'_>, reading: &mut Reading<'_>) -> Option<[f64; 2]> {
        let [west, east] = read_pair([&Self::EACH; 2], node, reading)?;
        let east = if east < west { east + 360.0 } else { east };
        // What is resolved is written, and read back.
        let [west, east] = if east > LONGITUDES_DEG[1] {
            [west - 360.0, east - 360.0]
        } else {
            [west, east]
        };
        let within = east >= west && east - west <= 360.0;
        if !within {
            let found = reading.written(node);
            reading.report(node.span(), Fault::NotEastwards { found });
        }
        within.then_some([west, east])
    }

    fn accepted(&self) -> String {
        format!("[west, east], each {}", Self::EACH.accepted())
    }

    fn schema(&self) -> Json {
        pair_schema(&Self::EACH)
    }

    fn write(&self, value: &[f64; 2]) -> String {
        write_pair(&Self::EACH, value)
    }
}

/// Two numbers.
pub(in crate::scenario) struct TwoNumbers(pub(in crate::scenario) Number);

impl Rule for TwoNumbers {
    type Value = [f64; 2];

    fn read(&self, node: &Node<'_>, reading: &mut Reading<'_>) -> Option<[f64; 2]> {
        read_pair([&self.0; 2], node, reading)
    }

    fn accepted(&self) -> String {
        format!("two numbers, each {}", self.0.accepted())
    }

    fn schema(&self) -> Json {
        pair_schema(&self.0)
    }

    fn write(&self, value: &[f64; 2]) -> String {
        write_pair(&self.0, value)
    }
}

/// One step for both directions, or one for each.
pub(in crate::scenario) struct Steps(pub(in crate::scenario) Number);

impl Rule for Steps {
    type Value = [f64; 2];

    fn read(&self, node: &Node<'_>, reading: &mut Reading<'_>) -> Option<[f64; 2]> {
        if node.get_ref().is_array() {
            read_pair([&self.0; 2], node, reading)
        } else {
            self.0.read(node, reading).map(|step| [step, step])
        }
    }

    fn accepted(&self) -> String {
        format!("{}, or [in latitude, in longitude]", self.0.accepted())
    }

    fn schema(&self) -> Json {
        json!({ "oneOf": [self.0.schema(), pair_schema(&self.0)] })
    }

    fn write(&self, value: &[f64; 2]) -> String {
        if value[0] == value[1] {
            self.0.write(&value[0])
        } else {
            write_pair(&self.0, value)
        }
    }
}

pub(super) fn read_pair<R: Rule>(
    rules: [&R; 2],
    node: &Node<'_>,
    reading: &mut Reading<'_>,
) -> Option<[R::Value; 2]> {
    let elements: Vec<&Node<'_>> = node.get_ref().as_array().into_iter().flatten().collect();
    let [first, second] = elements[..] else {
        reading.refuse(node);
        return None;
    };
    let first = rules[0].read(first, reading);
    let second = rules[1].read(second, reading);
    Some([first?, second?])
}

pub(super) fn write_pair<R: Rule>(rule: &R, value: &[R::Value; 2]) -> String {
    format!("[{}, {}]", rule.write(&value[0]), rule.write(&value[1]))
}

fn pair_schema<R: Rule>(of: &R) -> Json {
    json!({ "type": "array", "items": of.schema(), "minItems": 2, "maxItems": 2 })
}
