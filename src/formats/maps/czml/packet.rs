//! The parts of a packet that give the position of a satellite.

use serde::Deserialize;
use serde::de::{Deserializer, Error, MapAccess, SeqAccess, Visitor, value::MapAccessDeserializer};
use std::fmt;
use std::marker::PhantomData;

/// The parts of a packet that are read.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Packet {
    pub(super) id: Option<String>,
    pub(super) version: Option<serde_json::Value>,
    pub(super) parent: Option<String>,
    pub(super) delete: bool,
    #[serde(deserialize_with = "one_or_many")]
    pub(super) availability: Vec<String>,
    #[serde(deserialize_with = "one_or_many")]
    pub(super) position: Vec<PositionPacket>,
}

/// A position, or its value in an interval.
#[derive(Debug, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct PositionPacket {
    pub(super) interval: Option<String>,
    pub(super) epoch: Option<String>,
    pub(super) reference_frame: Option<String>,
    pub(super) interpolation_algorithm: Option<String>,
    pub(super) interpolation_degree: Option<u64>,
    pub(super) cartesian: Option<ArraySamples>,
    pub(super) cartesian_velocity: Option<ArraySamples>,
    pub(super) cartographic_degrees: Option<ArraySamples>,
    pub(super) cartographic_radians: Option<ArraySamples>,
    pub(super) reference: Option<String>,
    pub(super) delete: bool,
}

/// Numbers, with any times given as text.
#[derive(Debug, Default)]
pub(super) struct ArraySamples {
    /// The numbers, with NaN for each text.
    pub(super) numbers: Vec<f64>,
    /// The texts and their positions.
    pub(super) texts: Vec<(usize, String)>,
}

impl<'de> Deserialize<'de> for ArraySamples {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(SamplesVisitor)
    }
}

struct SamplesVisitor;

impl<'de> Visitor<'de> for SamplesVisitor {
    type Value = ArraySamples;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("an array of numbers and times")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<ArraySamples, A::Error> {
        let mut samples = ArraySamples::default();
        while let Some(item) = items.next_element()? {
            match item {
                ArrayItem::Number(number) => samples.numbers.push(number),
                ArrayItem::Text(text) => {
                    samples.texts.push((samples.numbers.len(), text));
                    samples.numbers.push(f64::NAN);
                }
            }
        }
        Ok(samples)
    }
}

enum ArrayItem {
    Number(f64),
    Text(String),
}

impl<'de> Deserialize<'de> for ArrayItem {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ItemVisitor)
    }
}

struct ItemVisitor;

impl Visitor<'_> for ItemVisitor {
    type Value = ArrayItem;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a number or a time")
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<ArrayItem, E> {
        Ok(ArrayItem::Number(number))
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<ArrayItem, E> {
        Ok(ArrayItem::Number(number as f64))
    }

    fn visit_u64<E: Error>(self, number: u64) -> Result<ArrayItem, E> {
        Ok(ArrayItem::Number(number as f64))
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<ArrayItem, E> {
        Ok(ArrayItem::Text(text.to_owned()))
    }
}

/// Accepts a single value as a list of one.
fn one_or_many<'de, T: Deserialize<'de>, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Vec<T>, D::Error> {
    deserializer.deserialize_any(OneOrMany(PhantomData))
}

struct OneOrMany<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for OneOrMany<T> {
    type Value = Vec<T>;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a value or an array of values in intervals")
    }

    fn visit_unit<E: Error>(self) -> Result<Vec<T>, E> {
        Ok(Vec::new())
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Vec<T>, E> {
        let deserializer = serde::de::value::StrDeserializer::new(text);
        Ok(vec![T::deserialize(deserializer)?])
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Vec<T>, A::Error> {
        Ok(vec![T::deserialize(MapAccessDeserializer::new(map))?])
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Vec<T>, A::Error> {
        let mut found = Vec::new();
        while let Some(item) = items.next_element()? {
            found.push(item);
        }
        Ok(found)
    }
}
