//! Words with the figures of both jobs.

use retune_report::Key;
use retune_study::Study;

/// The words of a legend, for the description of a figure.
pub fn words(legend: &[(Key, String)]) -> String {
    legend.iter().map(|(_, words)| words.as_str()).collect::<Vec<_>>().join("; ")
}

/// The line below a figure: what the designs of a study are tuned for, and what made them.
pub fn made_by(study: Option<&Study>) -> String {
    let over = study.map(|study| {
        let over = retune_study::over(&study.objective(), study.scene.forcing.frequency.get());
        format!("{over}; ")
    });
    format!("{}Retune {}", over.unwrap_or_default(), env!("CARGO_PKG_VERSION"))
}
