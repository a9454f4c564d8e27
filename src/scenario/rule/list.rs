//! Rules for words and lists.

use std::collections::HashSet;
use std::hash::Hash;
use std::marker::PhantomData;

use serde_json::{Value as Json, json};

use super::number::{read_pair, write_pair};
use super::{Node, Number, Reading, Rule, Text};
use crate::keyword::Keyword;
use crate::scenario::number::toml_text;
use crate::scenario::problem::Fault;
use crate::scenario::values::MaskPoint;
use crate::search::{Constraint, ConstraintError, Relation};
use crate::visibility::MaskTable;

/// One of the words of `T`.
pub(in crate::scenario) struct OneOf<T>(PhantomData<fn() -> T>);

impl<T> OneOf<T> {
    pub(in crate::scenario) const fn new() -> Self {
        Self(PhantomData)
    }
}

impl<T: Keyword> Rule for OneOf<T> {
    type Value = T;

    fn read(&self, node: &Node<'_>, reading: &mut Reading<'_>) -> Option<T> {
        let Some(word) = node.get_ref().as_str() else {
            reading.refuse(node);
            return None;
        };
        T::from_keyword(word)
            .map_err(|unknown| reading.report(node.span(), unknown))
            .ok()
    }

    fn accepted(&self) -> String {
        let quoted: Vec<String> = T::choices().into_iter().map(toml_text).collect();
        quoted.join(" | ")
    }

    fn schema(&self) -> Json {
        json!({ "enum": T::choices() })
    }

    fn write(&self, value: &T) -> String {
        toml_text(value.keyword())
    }
}

/// A list of different words of `T`.
pub(in crate::scenario) struct SomeOf<T> {
    of: OneOf<T>,
    least: usize,
}

impl<T> SomeOf<T> {
    pub(in crate::scenario) const fn at_least(least: usize) -> Self {
        Self {
            of: OneOf::new(),
            least,
        }
    }
}

impl<T: Keyword + Hash> Rule for SomeOf<T> {
    type Value = Vec<T>;

    fn read(&self, node: &Node<'_>, reading: &mut Reading<'_>) -> Option<Vec<T>> {
        let words = read_different(&self.of, node, reading)?;
        if words.len() < self.least {
            reading.refuse(node);
            return None;
        }
        Some(words)
    }

    fn accepted(&self) -> String {
        let least = if self.least > 0 { "one or more" } else { "any" };
        format!("a list of {least} of {}", self.of.accepted())
    }

    fn schema(&self) -> Json {
        json!({
            "type": "array", "items": self.of.schema(),
            "minItems": self.least, "uniqueItems": true,
        })
    }

    fn write(&self, value: &Vec<T>) -> String {
        write_list(&self.of, value)
    }
}

/// One word of `T`, or a list of different ones.
pub(in crate::scenario) struct OneOrMore<T>(SomeOf<T>);

impl<T> OneOrMore<T> {
    pub(in crate::scenario) const fn new() -> Self {
        Self(SomeOf::at_least(1))
    }
}

impl<T: Keyword + Hash> Rule for OneOrMore<T> {
    type Value = Vec<T>;

    fn read(&self, node: &Node<'_>, reading: &mut Reading<'_>) -> Option<Vec<T>> {
        if node.get_ref().is_array() {
            return self.0.read(node, reading);
        }
        self.0.of.read(node, reading).map(|word| vec![word])
    }

    fn accepted(&self) -> String {
        format!("{}, or a list of them", self.0.of.accepted())
    }

    fn schema(&self) -> Json {
        json!({ "anyOf": [self.0.of.schema(), self.0.schema()] })
    }

    fn write(&self, value: &Vec<T>) -> String {
        match value.as_slice() {
            [one] => self.0.of.write(one),
            _ => self.0.write(value),
        }
    }
}

/// A list of whatever a rule accepts.
pub(in crate::scenario) struct ListOf<R>(pub(in crate::scenario) R);

impl<R: Rule> Rule for ListOf<R> {
    type Value = Vec<R::Value>;

    fn read(&self, node: &Node<'_>, reading: &mut Reading<'_>) -> Option<Self::Value> {
        read_list(&self.0, node, reading)
    }

    fn accepted(&self) -> String {
        format!("a list, each {}", self.0.accepted())
    }

    fn schema(&self) -> Json {
        json!({ "type": "array", "items": self.0.schema() })
    }

    fn is_absent(&self, value: &Self::Value) -> bool {
        value.is_empty()
    }

    fn write(&self, value: &Self::Value) -> String {
        write_list(&self.0, value)
    }
}

/// A list of different texts of a kind, such as paths.
pub(in crate::scenario) struct Texts {
    /// What the texts are, in the plural.
    kind: &'static str,
    least: usize,
}

impl Texts {
    pub(in crate::scenario) const fn any(kind: &'static str) -> Self {
        Self { kind, least: 0 }
    }

    pub(in crate::scenario) const fn one_or_more(kind: &'static str) -> Self {
        Self { kind, least: 1 }
    }
}

impl Rule for Texts {
    type Value = Vec<String>;

    fn read(&self, node: &Node<'_>, reading: &mut Reading<'_>) -> Option<Vec<String>> {
        let texts = read_different(&Text::Any, node, reading)?;
        if texts.len() < self.least {
            reading.refuse(node);
            return None;
        }
        Some(texts)
    }

    fn accepted(&self) -> String {
        let least = if self.least > 0 { "one or more " } else { "" };
        format!("a list of {least}{}", self.kind)
    }

    fn schema(&self) -> Json {
        json!({
            "type": "array", "items": Text::Any.schema(),
            "minItems": self.least, "uniqueItems": true,
        })
    }

    fn is_absent(&self, value: &Vec<String>) -> bool {
        value.len() < self.least
    }

    fn write(&self, value: &Vec<String>) -> String {
        write_list(&Text::Any, value)
    }
}

/// A list of constraints, each a text such as `max-pdop <= 2.5`.
pub(in crate::scenario) struct Constraints;

struct OneConstraint;

impl Rule for OneConstraint {
    type Value = Constraint;

    fn read(&self, node: &Node<'_>, reading: &mut Reading<'_>) -> Option<Constraint> {
        let Some(text) = node.get_ref().as_str() else {
            reading.refuse(node);
            return None;
        };
        text.parse()
            .map_err(|error: ConstraintError| {
                reading.report(node.span(), error);
            })
            .ok()
    }

    fn accepted(&self) -> String {
        "a text such as \"max-pdop <= 2.5\"".to_owned()
    }

    fn schema(&self) -> Json {
        json!({ "type": "string", "pattern": "(<=|>=)" })
    }

    fn write(&self, value: &Constraint) -> String {
        toml_text(&value.to_string())
    }
}

/// Why two bounds on one quantity contradict each other.
fn conflict(first: &Constraint, second: &Constraint) -> Option<Fault> {
    let (lower, upper) = match (first.relation, second.relation) {
        (Relation::AtLeast, Relation::AtMost) => (first, second),
        (Relation::AtMost, Relation::AtLeast) => (second, first),
        _ => {
            return Some(Fault::Repeated {
                found: format!("{} {}", second.quantity, second.relation),
            });
        }
    };
    (lower.bound > upper.bound).then(|| Fault::Contradiction {
        lower: lower.to_string(),
        upper: upper.to_string(),
    })
}

impl Rule for Constraints {
    type Value = Vec<Constraint>;

    fn read(&self, node: &Node<'_>, reading: &mut Reading<'_>) -> Option<Vec<Constraint>> {
        let constraints = read_list(&OneConstraint, node, reading)?;
        let fault = constraints.iter().enumerate().find_map(|(n, one)| {
            let before = constraints[..n].iter();
            let same = before.filter(|other| other.quantity == one.quantity);
            same.into_iter().find_map(|other| conflict(other, one))
        });
        if let Some(fault) = fault {
            reading.report(node.span(), fault);
            return None;
        }
        Some(constraints)
    }

    fn accepted(&self) -> String {
        "a list of texts such as \"max-pdop <= 2.5\"".to_owned()
    }

    fn schema(&self) -> Json {
        json!({ "type": "array", "items": OneConstraint.schema() })
    }

    fn write(&self, value: &Vec<Constraint>) -> String {
        write_list(&OneConstraint, value)
    }
}

/// A list of finite numbers.
pub(in crate::scenario) struct Numbers;

impl Rule for Numbers {
    type Value = Vec<f64>;

    fn read(&self, node: &Node<'_>, reading: &mut Reading<'_>) -> Option<Vec<f64>> {
        read_list(&Number::any(), node, reading)
    }

    fn accepted(&self) -> String {
        "a list of numbers, one for each objective".to_owned()
    }

    fn schema(&self) -> Json {
        json!({ "type": "array", "items": Number::any().schema(), "minItems": 1 })
    }

    fn write(&self, value: &Vec<f64>) -> String {
        write_list(&Number::any(), value)
    }
}

/// A skyline: pairs of azimuth and mask, by rising azimuth once around the horizon, or none.
pub(in crate::scenario) struct Skyline;

impl Skyline {
    const AZIMUTH: Number = Number::from_to(0.0, 360.0);
    const MASK: Number = Number::from_below(0.0, 90.0);
}

impl Rule for Skyline {
    type Value = Vec<MaskPoint>;

    fn read(&self, node: &Node<'_>, reading: &mut Reading<'_>) -> Option<Vec<MaskPoint>> {
        let points = read_list(&OnePoint, node, reading)?;
        let vertices = points
            .iter()
            .map(|point| (point.azimuth_deg, point.mask_deg))
            .collect();
        if !points.is_empty() && MaskTable::new(vertices).is_err() {
            reading.refuse(node);
            return None;
        }
        Some(points)
    }

    fn accepted(&self) -> String {
        format!(
            "a list of {}, azimuths rising from 0 to 360 with the same mask at both",
            OnePoint.accepted()
        )
    }

    fn schema(&self) -> Json {
        json!({ "type": "array", "items": OnePoint.schema() })
    }

    fn write(&self, value: &Vec<MaskPoint>) -> String {
        write_list(&OnePoint, value)
    }
}

struct OnePoint;

impl Rule for OnePoint {
    type Value = MaskPoint;

    fn read(&self, node: &Node<'_>, reading: &mut Reading<'_>) -> Option<MaskPoint> {
        let rules = [&Skyline::AZIMUTH, &Skyline::MASK];
        let [azimuth_deg, mask_deg] = read_pair(rules, node, reading)?;
        Some(MaskPoint {
            azimuth_deg,
            mask_deg,
        })
    }

    fn accepted(&self) -> String {
        format!(
            "[azimuth {}, mask {}]",
            Skyline::AZIMUTH.range(),
            Skyline::MASK.range()
        )
    }

    fn schema(&self) -> Json {
        json!({
            "type": "array", "items": false, "minItems": 2,
            "prefixItems": [Skyline::AZIMUTH.schema(), Skyline::MASK.schema()],
        })
    }

    fn write(&self, value: &MaskPoint) -> String {
        write_pair(&Number::any(), &[value.azimuth_deg, value.mask_deg])
    }
}

/// Reads every element, so that all problems are reported; an element is `None` where it is wrong.
fn read_each<R: Rule>(
    rule: &R,
    node: &Node<'_>,
    reading: &mut Reading<'_>,
) -> Option<Vec<Option<R::Value>>> {
    let Some(elements) = node.get_ref().as_array() else {
        reading.refuse(node);
        return None;
    };
    let read = |(place, element): (usize, &Node<'_>)| {
        // Tables are told apart by their numbers, as `--set` has them.
        let number = (place + 1).to_string();
        if element.get_ref().is_table() || reading.is_set(&number) {
            rule.read(element, &mut reading.within(&number, rule.accepted()))
        } else {
            rule.read(element, reading)
        }
    };
    Some(elements.iter().enumerate().map(read).collect())
}

fn read_list<R: Rule>(
    rule: &R,
    node: &Node<'_>,
    reading: &mut Reading<'_>,
) -> Option<Vec<R::Value>> {
    read_each(rule, node, reading)?.into_iter().collect()
}

pub(super) fn read_different<R: Rule<Value: Eq + Hash>>(
    rule: &R,
    node: &Node<'_>,
    reading: &mut Reading<'_>,
) -> Option<Vec<R::Value>> {
    let values = read_each(rule, node, reading)?;
    let mut seen = HashSet::new();
    let mut different = true;
    let elements = node.get_ref().as_array().into_iter().flatten();
    for (element, value) in elements.zip(&values) {
        if value.as_ref().is_some_and(|value| !seen.insert(value)) {
            let found = reading.written(element);
            reading.report(element.span(), Fault::Repeated { found });
            different = false;
        }
    }
    let values: Option<Vec<R::Value>> = values.into_iter().collect();
    values.filter(|_| different)
}

pub(super) fn write_list<R: Rule>(rule: &R, values: &[R::Value]) -> String {
    let written: Vec<String> = values.iter().map(|value| rule.write(value)).collect();
    format!("[{}]", written.join(", "))
}
