//! Names beside sites, where they hide least.

use super::super::frame::PlotFrame;
use super::super::sheet::Sheet;
use super::super::{Area, Drawn};
use super::SITE;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Most names on a map.
const MOST_NAMES: usize = 60;

/// Left, top, right and bottom.
type Rect = [i32; 4];

/// Sides of a site on which its name may be, the best first.
const SIDES: [(i32, i32); 8] = [
    (1, 0),
    (-1, 0),
    (0, -1),
    (0, 1),
    (1, -1),
    (-1, -1),
    (1, 1),
    (-1, 1),
];

pub(super) fn draw(
    area: &Area<'_>,
    frame: &PlotFrame,
    (places, names): (&[(i32, i32)], &[String]),
    sheet: Sheet,
) -> Drawn {
    if names.len() > MOST_NAMES {
        return Ok(());
    }
    let most = (frame.right - frame.left) / 2;
    let names: Vec<String> = names
        .iter()
        .map(|name| sheet.fitted(name, 1.0, most))
        .collect();
    let sizes = names
        .iter()
        .map(|name| (sheet.text_width(name, 1.0), sheet.em(1.0)));
    let sizes: Vec<(i32, i32)> = sizes.collect();
    let inside = [frame.left, frame.top, frame.right, frame.bottom];
    let away = sheet.em(SITE + 0.25);
    for (name, rect) in names.iter().zip(placed(places, &sizes, inside, away)) {
        let Some(rect) = rect else { continue };
        if !name.is_empty() {
            let at = (rect[0], (rect[1] + rect[3]) / 2);
            let style = sheet.font().pos(Pos::new(HPos::Left, VPos::Center));
            area.draw(&Text::new(name.clone(), at, style))?;
        }
    }
    Ok(())
}

/// Where each name goes: the side with the least overlap with sites and what is outside. A name that would cover one before it
/// on every side has no place.
fn placed(
    places: &[(i32, i32)],
    sizes: &[(i32, i32)],
    inside: Rect,
    away: i32,
) -> Vec<Option<Rect>> {
    let sites: Vec<Rect> = places
        .iter()
        .map(|(x, y)| [x - away, y - away, x + away, y + away])
        .collect();
    let mut found: Vec<Option<Rect>> = Vec::new();
    for (&(x, y), &(width, height)) in places.iter().zip(sizes) {
        let at = |(across, down): (i32, i32)| {
            let left = x + match across {
                1 => away,
                -1 => -away - width,
                _ => -width / 2,
            };
            let reach = if across == 0 { away + height / 2 } else { away };
            let middle = y + down * reach;
            [left, middle - height / 2, left + width, middle + height / 2]
        };
        let cost = |rect: &Rect| {
            let whole = i64::from(width) * i64::from(height);
            let outside = whole - overlap(*rect, inside);
            let hidden = sites.iter().map(|site| overlap(*rect, *site));
            outside * 4 + hidden.sum::<i64>()
        };
        let before = found.iter().flatten();
        let is_free = |rect: &Rect| before.clone().all(|other| overlap(*rect, *other) == 0);
        let free = SIDES.map(at).into_iter().filter(is_free);
        let best = free.min_by_key(cost);
        found.push(best);
    }
    found
}

fn overlap(a: Rect, b: Rect) -> i64 {
    let across = (a[2].min(b[2]) - a[0].max(b[0])).max(0);
    let up = (a[3].min(b[3]) - a[1].max(b[1])).max(0);
    i64::from(across) * i64::from(up)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of two sites that are close, each has its name on the far side; one in the east has it inside the map.
    #[test]
    fn names_keep_away_from_sites_and_stay_inside() {
        let places = [(100, 100), (150, 100), (980, 400)];
        let sizes = [(80, 10); 3];
        let found = placed(&places, &sizes, [0, 0, 1000, 1000], 8);
        assert_eq!(found[0], Some([12, 95, 92, 105]));
        assert_eq!(found[1], Some([158, 95, 238, 105]));
        assert!(found[2].unwrap()[2] < 980);
    }

    /// Of many sites in one place, as many have their names as there is room for, the first ones, and none covers another.
    #[test]
    fn names_do_not_cover_each_other() {
        let places = [(500, 500); 12];
        let found = placed(&places, &[(80, 10); 12], [0, 0, 1000, 1000], 8);
        let shown: Vec<Rect> = found.iter().flatten().copied().collect();
        assert!(found[0].is_some() && (2..12).contains(&shown.len()));
        for (n, rect) in shown.iter().enumerate() {
            assert!(shown[..n].iter().all(|other| overlap(*rect, *other) == 0));
        }
    }
}
