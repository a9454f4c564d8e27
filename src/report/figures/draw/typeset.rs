//! Subscripts and powers in the texts of an SVG.

/// Symbols of this project as they are written elsewhere, and as they are set.
const SYMBOLS: [(&str, &str); 4] = [
    ("J_pos", "J_{pos}"),
    ("J_cost", "J_{cost}"),
    ("E_g", "E_{g}"),
    ("N_visible", "N_{visible}"),
];

/// Size of a subscript.
const SIZE: &str = "72%";

/// How far a subscript is lowered and a power is raised, in heights of their own text, and the way back.
const LOWERED: [&str; 2] = ["0.3em", "-0.216em"];
const RAISED: [&str; 2] = ["-0.5em", "0.36em"];

/// Sets `_{…}` and `^{…}` in every text element. Plotters writes each as an opening tag, the escaped text and a closing
/// tag, each on its own line.
pub(super) fn typeset(svg: &str) -> String {
    let mut set = String::with_capacity(svg.len());
    let mut is_text = false;
    for line in svg.split_inclusive('\n') {
        if is_text {
            set.push_str(&of_text(line));
        } else if line.starts_with("<text ") {
            set.push_str(&line.replace(
                "font-family=\"sans-serif\"",
                &format!("font-family=\"{}\"", super::FAMILIES),
            ));
        } else {
            set.push_str(line);
        }
        is_text = line.starts_with("<text ") && !line.contains("</text>");
    }
    set
}

fn of_text(text: &str) -> String {
    let mut rest = SYMBOLS.iter().fold(text.to_owned(), |text, (plain, set)| {
        text.replace(plain, set)
    });
    let mut set = String::new();
    let mut open = "";
    while let Some((at, end, [there, back])) = next(&rest) {
        let inner = &rest[at + 2..end];
        set.push_str(&rest[..at]);
        set.push_str(open);
        set.push_str(&format!(
            "<tspan dy=\"{there}\" font-size=\"{SIZE}\">{inner}</tspan><tspan dy=\"{}\">",
            // From the size of the subscript to that of the text.
            back
        ));
        open = "</tspan>";
        rest = rest[end + 1..].to_owned();
    }
    let (last, newline) = match rest.strip_suffix('\n') {
        Some(last) => (last, "\n"),
        None => (rest.as_str(), ""),
    };
    set.push_str(last);
    set.push_str(open);
    set + newline
}

/// Where the next subscript or power begins and ends.
fn next(text: &str) -> Option<(usize, usize, [&'static str; 2])> {
    let of = |mark: &str, shifts| text.find(mark).map(|at| (at, shifts));
    let first = [of("_{", LOWERED), of("^{", RAISED)];
    let (at, shifts) = first.into_iter().flatten().min_by_key(|(at, _)| *at)?;
    let end = at + text[at..].find('}')?;
    Some((at, end, shifts))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn symbols_have_subscripts_and_ticks_powers() {
        let svg = "<text x=\"1\">\nJ_pos &lt; 10^{-3} km\n</text>\n<rect/>\n";
        let set = typeset(svg);
        assert!(
            set.starts_with("<text x=\"1\">\nJ<tspan dy=\"0.3em\" font-size=\"72%\">pos</tspan>")
        );
        assert!(set.contains(">-3</tspan><tspan dy=\"0.36em\"> km</tspan>\n</text>\n<rect/>"));
        assert_eq!(
            set.matches("<tspan").count(),
            set.matches("</tspan").count()
        );
        // What is not closed stays as it is.
        assert_eq!(
            typeset("<text >\na_{b\n</text>\n"),
            "<text >\na_{b\n</text>\n"
        );
    }
}
