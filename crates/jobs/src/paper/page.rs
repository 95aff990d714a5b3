//! The list of items, and their page.

use super::item::Item;
use super::plan::{Plan, Tuner};
use super::{cases, curves, energies, regimes, surfaces, table1, table2, variants};
use crate::Error;
use retune_report::document::{Block, Document, Statement, Verdict};
use retune_report::table::Table;
use retune_study::counted;

/// A table or figure of the paper, or another item of the page.
pub struct Entry {
    pub name: &'static str,
    pub title: &'static str,
    /// What the paper shows.
    pub paper: &'static str,
    /// The function that makes the item.
    pub make: fn(&Plan, &mut Tuner) -> Result<Item, Error>,
}

/// The file with the verdicts on the statements of an item.
pub fn statements(item: &str) -> String {
    format!("{item}-statements.json")
}

/// Every item, in the order of the page.
pub static ENTRIES: [Entry; 9] = [
    Entry {
        name: "table1",
        title: "Table 1. The log of fminsearch",
        paper: "Three rows of an fminsearch run and its result: E1max falls from 666.2 J over 661.1 J and 573.1 J to 563.0 J.",
        make: |plan, _| table1::table1(plan),
    },
    Entry {
        name: "table2",
        title: "Table 2. The optimised dampers",
        paper: "SSVI NES: k2 = 215 N/m, c2 = 232 N·s/m, D = 0.06 m, C = 0.36 m. TMD: k2 = 600 N/m, c2 = 262 N·s/m, D = 2.08 m, C = 4.7 m.",
        make: table2::table2,
    },
    Entry {
        name: "figure2",
        title: "Figure 2. The surf surfaces",
        paper: "Two surfaces of E1max at k1 = 3.95e4 N/m on which approximate optima were read with the Data Tip. Axes and ranges are not in the text.",
        make: |plan, _| surfaces::figure2(plan),
    },
    Entry {
        name: "figure3",
        title: "Figure 3. Does a damper keep its tuning?",
        paper: "E1max against the frequency for several stiffnesses k1, dampers tuned at k1 = 3.95e4 N/m (red): without damper, with SSVI NES, with TMD.",
        make: |plan, _| curves::figure3(plan),
    },
    Entry {
        name: "figure4",
        title: "Figure 4. Impact zones and motions",
        paper: "For five stiffnesses: zones of impacts on both walls (pink) and on the structure only (blue), E1max of all three scenes, E2max, and bifurcation diagrams with regimes nT, m, k.",
        make: |plan, _| regimes::figure4(plan),
    },
    Entry {
        name: "figure5",
        title: "Figure 5. Energy ratios",
        paper: "R1 = E1max/(E1max + E2max) and R2 = E2max/(E1max + E2max), against k1 (a) and against ω for k1 = 2.00e4 (b) and 3.95e4 N/m (c).",
        make: |plan, _| energies::figure5(plan),
    },
    Entry {
        name: "figure6",
        title: "Figure 6. Energies over time at resonance",
        paper: "E1(t) of the structure without damper and with a damper, and E2(t) of the damper, at ω = 6.28 rad/s: (a) SSVI NES, (b) TMD.",
        make: |plan, _| energies::figure6(plan),
    },
    Entry {
        name: "figure7",
        title: "Figure 7. Three irregular motions",
        paper: "x2(t), phase trajectory and contact forces (on the PS blue, on the obstacle green): (a) intermittency, (b) transient chaos, (c) chaos.",
        make: |plan, _| cases::figure7(plan),
    },
    Entry {
        name: "figures",
        title: "What hangs on R and on the window",
        paper: "Neither the radius R of the damper's surfaces nor the window of the maxima.",
        make: |plan, _| variants::figures(plan),
    },
];

pub fn page(items: &[(&'static Entry, Item)]) -> String {
    let of_paper = || items.iter().flat_map(|(_, item)| &item.statements).filter(|one| !one.conjecture);
    let [holds, partly, fails, undecided] =
        Verdict::ALL.map(|verdict| of_paper().filter(|one| one.verdict == verdict).count());
    let opening = vec![
        Block::Words(format!(
            "Each table and figure of the paper beside what Retune computes, and a verdict on each statement. Of {} statements {holds} hold, {partly} hold in part, {fails} do not hold under our settings, and {undecided} cannot be decided: practically equal designs decide them differently. What is marked as our conjecture is not counted. In the paper's words the PS is the primary structure, which is to be kept still, a TMD a damper that touches nothing, an SSVI NES one that strikes the PS or an obstacle; R1 and R2 are the shares of the largest energy that PS and damper have, and a motion T, 1, 0 repeats every period of the force, with one impact on the PS and none on the obstacle.",
            of_paper().count()
        )),
        verdicts(items),
        Block::Words(
            "Only the text of the paper was available, not the data of its figures: what a figure shows is taken from the words about it. The paper leaves out the radius R and the coefficient q of the contact, the length of a run, the window of its maxima and the tolerances. Ours stand under each item; which verdicts hang on R and on the window stands at the end."
                .to_owned(),
        ),
        Block::Words("Two samplings of the frequency, each under one name:".to_owned()),
        Block::About(
            "Finest",
            "the largest of as many runs over Figure 3's frequencies as the last column of its tables says, with the least and the largest of 21 designs within ±0.1 % beside it; every verdict on a worst case is by this."
                .to_owned(),
        ),
        Block::About(
            "Coarse",
            "31 frequencies over 5 to 8 rad/s and the peaks between them; by this searches and Figure 2's maps compare designs, no more."
            .to_owned(),
        ),
        Block::Words(
            "All data stand beside this page as CSV, all figures as SVG; so do the study, all that it names, and what made each file:"
                .to_owned(),
        ),
        Block::Files(["study.json", "resolved.json", "manifest.json"].map(str::to_owned).to_vec()),
    ];
    let document = Document {
        title: "Retention of tuning for vibro-impact and linear dampers: the whole paper, made again"
            .to_owned(),
        command: "retune reproduce",
        opening,
        sections: items.iter().map(|(entry, item)| (entry.name, entry.title, blocks(entry, item))).collect(),
    };
    document.html()
}

/// Every statement with its verdict, in one table.
fn verdicts(items: &[(&'static Entry, Item)]) -> Block {
    let row = |entry: &Entry, one: &Statement| {
        let item = entry.title.split('.').next().unwrap_or_default().to_owned();
        let ours = if one.conjecture { "Our conjecture: " } else { "" };
        vec![item, format!("{ours}{}", one.paper), one.verdict.words().to_owned()]
    };
    let rows = items.iter().flat_map(|(entry, item)| item.statements.iter().map(|one| row(entry, one)));
    Block::table("Every statement, and its verdict", ["item", "statement", "verdict"], rows.collect())
}

/// An item as a section: the first figure is open, everything else folded.
fn blocks(entry: &Entry, item: &Item) -> Vec<Block> {
    let mut blocks = vec![Block::About("In the paper", entry.paper.to_owned())];
    let folded = |subject: &str, inner: Vec<Block>| {
        (!inner.is_empty()).then(|| Block::Folded(subject.to_owned(), inner))
    };
    let mut pictures = item.pictures.iter().cloned().map(Block::Linked);
    let count = item.statements.len();
    let statements = (count > 0).then(|| Block::Statements(item.statements.clone()));
    let subject = format!("{}: verdicts, rules and numbers", counted(count as u64, "statement"));
    blocks.extend(pictures.next());
    blocks.extend(folded(&subject, statements.into_iter().collect()));
    blocks.extend(folded("More figures", pictures.collect()));
    let table = |(caption, table): &(String, Table)| Block::of_table(caption, table);
    let inner = item.tables.iter().map(table).chain(item.notes.iter().cloned().map(Block::Words));
    blocks.extend(folded("Tables and remarks", inner.collect()));
    blocks.push(Block::MadeBy(item.made_by.clone()));
    if !item.data.is_empty() {
        blocks.push(Block::Files(item.data.iter().map(|(name, _)| name.clone()).collect()));
    }
    blocks
}
