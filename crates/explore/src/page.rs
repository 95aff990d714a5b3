//! The page and all that it needs, built into the program: it works without a network.

/// A file of the page.
#[derive(Clone, Copy, Debug)]
pub struct File {
    /// Its name in the address.
    pub name: &'static str,
    /// Its type.
    pub kind: &'static str,
    /// Its bytes.
    pub bytes: &'static [u8],
}

macro_rules! file {
    ($name:literal, $kind:literal) => {
        File { name: $name, kind: $kind, bytes: include_bytes!(concat!("../page/", $name)) }
    };
}

/// Every file.
pub const FILES: &[File] = &[
    File { name: "", kind: "text/html; charset=utf-8", bytes: include_bytes!("../page/index.html") },
    file!("style.css", "text/css; charset=utf-8"),
    file!("main.js", "text/javascript; charset=utf-8"),
    file!("link.js", "text/javascript; charset=utf-8"),
    file!("place.js", "text/javascript; charset=utf-8"),
    file!("controls.js", "text/javascript; charset=utf-8"),
    file!("charts.js", "text/javascript; charset=utf-8"),
    file!("response.js", "text/javascript; charset=utf-8"),
    file!("drawing.js", "text/javascript; charset=utf-8"),
    file!("phase.js", "text/javascript; charset=utf-8"),
    file!("figures.js", "text/javascript; charset=utf-8"),
    file!("tuning.js", "text/javascript; charset=utf-8"),
    file!("save.js", "text/javascript; charset=utf-8"),
    file!("uplot/uPlot.iife.min.js", "text/javascript; charset=utf-8"),
    file!("uplot/uPlot.min.css", "text/css; charset=utf-8"),
    file!("uplot/LICENSE", "text/plain; charset=utf-8"),
];
