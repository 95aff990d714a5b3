//! The items of the page.

use super::item::Item;
use super::plan::{Plan, Tuner};
use super::{cases, curves, energies, ratios, regimes, surfaces, table1, table2, variants};
use crate::Error;

/// The function that makes an item.
pub type Maker = fn(&Plan, &mut Tuner) -> Result<Item, Error>;
/// The directory of the searches of Table 2.
pub const SEARCHES: &str = "table2";

/// Every item, in the order of the page.
pub const ITEMS: [(&str, Maker); 9] = [
    ("table1", |plan, _| table1::table1(plan)),
    ("table2", table2::table2),
    ("figure2", |plan, _| surfaces::figure2(plan)),
    ("figure3", |plan, _| curves::figure3(plan)),
    ("figure4", |plan, _| regimes::figure4(plan)),
    ("figure5", |plan, _| ratios::figure5(plan)),
    ("figure6", |plan, _| energies::figure6(plan)),
    ("figure7", |plan, _| cases::figure7(plan)),
    (variants::NAME, |plan, _| variants::figures(plan)),
];

/// The file with the verdicts on the statements of an item.
pub fn statements(name: &str) -> String {
    format!("{name}-statements.json")
}
