//! What the pages and figures of several jobs have in common.

use crate::Error;
use retune_model::Parameter;
use retune_report::document::Document;
use retune_report::{Axis, Drawing, Scale, Sheet, drawing};
use retune_store::Directory;
use retune_study::{Study, hertz_and_rpm};

/// Writes a page in both forms, and its figures.
pub fn write(document: &Document, directory: &Directory) -> Result<(), Error> {
    document.files().iter().try_for_each(|(name, text)| Ok(directory.write(name, text)?))
}

/// A figure of designs of a study. Its description ends with the words of its legend, its caption with [`made_by`].
pub fn figure(mut sheet: Sheet, study: Option<&Study>) -> Drawing {
    sheet.description += &format!(": {}.", sheet.legend_words());
    sheet.caption.push(made_by(study));
    drawing(&sheet)
}

/// The line below a figure: what the designs of a study are tuned for, and the version of Retune.
pub fn made_by(study: Option<&Study>) -> String {
    let over = study.map(|study| format!("{}; ", over(study)));
    format!("{}Retune {}", over.unwrap_or_default(), env!("CARGO_PKG_VERSION"))
}

/// The range over which the objective of a study is taken, in words.
pub fn over(study: &Study) -> String {
    retune_study::over(&study.objective(), study.scene.forcing.frequency.get())
}

/// An abscissa of a parameter, the angular frequency as ω; with a second scale in Hz if `in_hertz`.
pub fn abscissa(parameter: Parameter, scale: Scale, range: (f64, f64), in_hertz: bool) -> Axis {
    let symbol = if parameter.is_frequency() { "ω" } else { parameter.symbol() };
    let axis = Axis::new(format!("{symbol}, {}", parameter.unit()), scale, range);
    if in_hertz && parameter.is_frequency() {
        axis.with_second("frequency, Hz", hertz_and_rpm(1.0)[0])
    } else {
        axis
    }
}
