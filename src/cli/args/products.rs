//! The products in `navwalker export --help`.

use crate::exchange::export::Product;
use crate::keyword::Keyword;

/// Columns of a keyword and the space after it.
const KEYWORD_WIDTH: usize = 12;

/// The values of `--as`, and examples.
pub(super) fn help() -> String {
    let mut help = "Products:\n".to_owned();
    for product in Product::ALL {
        let mut label = product.keyword();
        for line in product.row().help {
            help += &format!("  {label:KEYWORD_WIDTH$}{line}\n");
            label = "";
        }
    }
    help + "
Settings the other program needs are listed in manifest.json under assumptions.

Examples:
  navwalker export --design delta:55:182/13/1@925 --as czml,geojson,kml --out maps
  navwalker export regional --design star:86.4:66/6/2@780 --as stk,gmat --out scenario
  navwalker export --constellation iridium.tle --as oem,sp3,stk --out iridium"
}
