//! The valid name that was most likely meant.

/// Below this Jaro-Winkler similarity (0 to 1) a name is not worth suggesting:
/// short unrelated keys such as `epoch` and `points` reach about 0.6.
const WORTH_SUGGESTING: f64 = 0.7;

/// The candidate most similar to `written`, if one is similar enough.
///
/// Jaro-Winkler favours a common beginning, so that `latitude` finds
/// `latitude-deg`, of which an edit distance would say that it is four edits away.
pub(super) fn nearest<'c>(written: &str, candidates: &[&'c str]) -> Option<&'c str> {
    let written = written.to_lowercase().replace('_', "-");
    candidates
        .iter()
        .map(|candidate| (strsim::jaro_winkler(&written, candidate), *candidate))
        .filter(|(similarity, _)| *similarity >= WORTH_SUGGESTING)
        .max_by(|(a, _), (b, _)| a.total_cmp(b))
        .map(|(_, candidate)| candidate)
}
