//! Which of the compared constellations dominate which, in words.

use super::Baseline;
use crate::optimize::dominates;

/// Maximum number of constellations whose relations are told one by one.
const MOST_TOLD: usize = 8;

/// Who dominates whom by the objectives, as sentences; `None` for fewer than two constellations.
pub(crate) fn dominance(compared: &[&Baseline], objectives: &[String]) -> Option<String> {
    if compared.len() < 2 {
        return None;
    }
    let judged: Vec<(&str, &[f64])> = compared
        .iter()
        .filter_map(|one| Some((name(one), one.feasible.as_deref()?)))
        .collect();
    let mut text = format!("By {}, ", listed(objectives.iter().map(String::as_str)));
    text += &relations(&judged);
    text.push('.');
    for one in compared.iter().filter(|one| one.feasible.is_none()) {
        text += &format!(" {} is not judged: {}.", name(one), reason(one, objectives));
    }
    Some(text)
}

/// The name in a sentence.
fn name(one: &Baseline) -> &str {
    if one.name == Baseline::REFERENCE {
        return "the reference design";
    }
    &one.name
}

fn relations(judged: &[(&str, &[f64])]) -> String {
    if judged.len() < 2 {
        return "there are not two to compare".to_owned();
    }
    let beaten = |by: &[f64]| -> Vec<&str> {
        let others = judged.iter().filter(|(_, other)| dominates(by, other));
        others.map(|(name, _)| *name).collect()
    };
    let is_free = |own: &[f64]| !judged.iter().any(|(_, other)| dominates(other, own));
    let free: Vec<&str> = judged
        .iter()
        .filter(|(_, own)| is_free(own))
        .map(|(name, _)| *name)
        .collect();
    let names = || free.iter().copied();
    if free.len() == judged.len() {
        return format!("{} do not dominate each other", listed(names()));
    }
    if judged.len() > MOST_TOLD {
        let are = if free.len() == 1 { "is" } else { "are" };
        return format!(
            "{} {are} dominated by no other, and each of the other {} is dominated",
            listed(names()),
            judged.len() - free.len()
        );
    }
    let mut told: Vec<String> = judged
        .iter()
        .map(|(name, own)| (name, beaten(own)))
        .filter(|(_, beaten)| !beaten.is_empty())
        .map(|(name, beaten)| format!("{name} dominates {}", listed(beaten.into_iter())))
        .collect();
    if free.len() > 1 {
        told.push(format!("{} do not dominate each other", listed(names())));
    }
    told.join("; ")
}

/// Why a constellation cannot be judged.
fn reason(one: &Baseline, objectives: &[String]) -> String {
    let lacking = objectives.iter().zip(&one.objectives);
    let lacking = lacking.filter(|(_, value)| value.is_none());
    let lacking: Vec<&str> = lacking.map(|(name, _)| name.as_str()).collect();
    if lacking.is_empty() {
        return "it violates a constraint, or has too many unsolved samples".to_owned();
    }
    format!("it has no {}", listed(lacking.into_iter()))
}

/// `a`, `a and b`, `a, b and c`.
fn listed<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.collect();
    match names.split_last() {
        None => String::new(),
        Some((last, [])) => (*last).to_owned(),
        Some((last, others)) => format!("{} and {last}", others.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::testing;

    fn place(name: &str, feasible: Option<[f64; 2]>) -> Baseline {
        Baseline {
            name: name.to_owned(),
            made_of: name.to_owned(),
            satellites: 3,
            metrics: testing::member(1, "delta:55:3/3/1@900").metrics,
            objectives: feasible.map_or(vec![Some(1.0), None], |x| x.map(Some).to_vec()),
            constraints: Vec::new(),
            feasible: feasible.map(|x| x.to_vec()),
        }
    }

    fn told(places: &[Baseline]) -> Option<String> {
        let objectives = ["j-pos".to_owned(), "planes".to_owned()];
        dominance(&places.iter().collect::<Vec<_>>(), &objectives)
    }

    #[test]
    fn every_relation_is_told() {
        let a = place("A", Some([1.0, 5.0]));
        let b = place("B", Some([1.0, 6.0]));
        let c = place("C", Some([2.0, 7.0]));
        let d = place("D", Some([3.0, 1.0]));
        let e = place("E", None);
        let all = [a.clone(), b.clone(), c, d.clone(), e];
        assert_eq!(
            told(&all).unwrap(),
            "By j-pos and planes, A dominates B and C; B dominates C; A and D do not dominate each other. E \
             is not judged: it has no planes."
        );
        assert_eq!(
            told(&[a.clone(), d]).unwrap(),
            "By j-pos and planes, A and D do not dominate each other."
        );
        // Equal places dominate in neither direction.
        let twin = place("twin", Some([1.0, 5.0]));
        assert!(
            told(&[a.clone(), twin])
                .unwrap()
                .contains("A and twin do not")
        );
        let reference = place(Baseline::REFERENCE, Some([0.0, 5.0]));
        assert!(
            told(&[a.clone(), reference])
                .unwrap()
                .contains("the reference design dominates A.")
        );
        assert_eq!(told(&[a]), None);
        assert!(b.feasible.is_some());
    }

    #[test]
    fn many_are_told_in_short() {
        let many: Vec<Baseline> = (0..9)
            .map(|n| place(&format!("N{n}"), Some([f64::from(n), 1.0])))
            .collect();
        let text = told(&many).unwrap();
        assert!(
            text.contains("N0 is dominated by no other, and each of the other 8 is dominated"),
            "{text}"
        );
    }
}
