//! The page with all its files, built into the program: it works without a network.

/// A file of the page.
#[derive(Clone, Copy, Debug)]
pub struct File {
    /// Its name in the URL.
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
    file!("help.js", "text/javascript; charset=utf-8"),
    file!("charts.js", "text/javascript; charset=utf-8"),
    file!("response.js", "text/javascript; charset=utf-8"),
    file!("branches.js", "text/javascript; charset=utf-8"),
    file!("drawing.js", "text/javascript; charset=utf-8"),
    file!("phase.js", "text/javascript; charset=utf-8"),
    file!("figures.js", "text/javascript; charset=utf-8"),
    file!("tuning.js", "text/javascript; charset=utf-8"),
    file!("forcing.js", "text/javascript; charset=utf-8"),
    file!("own.js", "text/javascript; charset=utf-8"),
    file!("save.js", "text/javascript; charset=utf-8"),
    file!("uplot/uPlot.iife.min.js", "text/javascript; charset=utf-8"),
    file!("uplot/uPlot.min.css", "text/css; charset=utf-8"),
    file!("uplot/LICENSE", "text/plain; charset=utf-8"),
];

#[cfg(test)]
mod tests {
    use super::*;
    use retune_report::colour::{BLACK, BLUE, DARK, GREEN, ORANGE, PAPER, PURPLE, VERMILION, VIRIDIS};

    fn text(name: &str) -> &'static str {
        let file = FILES.iter().find(|file| file.name == name).expect("a file of the page");
        std::str::from_utf8(file.bytes).expect("text")
    }

    #[test]
    fn contract_the_page_is_small() {
        let size: usize = FILES.iter().map(|file| file.bytes.len()).sum();
        assert!(size <= 300_000, "{size} bytes");
    }

    /// The page uses the palette of all figures.
    #[test]
    fn contract_the_colours_are_those_of_the_figures() {
        let (light, dark) = text("style.css").split_once("prefers-color-scheme: dark").expect("both");
        let of = |sheet: &str, name: &str| {
            let value = sheet.split_once(&format!("--{name}: ")).map(|(_, rest)| rest.split(';').next());
            value.flatten().map(str::to_uppercase)
        };
        for (name, colour) in [
            ("blue", BLUE),
            ("vermilion", VERMILION),
            ("green", GREEN),
            ("purple", PURPLE),
            ("orange", ORANGE),
        ] {
            assert_eq!(of(light, name).as_deref(), Some(colour), "{name}");
        }
        let names =
            [(BLACK, "ink"), (PAPER, "card"), (BLUE, "blue"), (VERMILION, "vermilion"), (GREEN, "green")];
        for (colour, other) in DARK {
            let name = names.iter().find(|(light, _)| *light == colour).expect("a name").1;
            assert_eq!(of(dark, name).as_deref(), Some(other), "{name}");
        }
        let script = text("tuning.js");
        let hex = |[r, g, b]: [f64; 3]| format!("\"#{:02X}{:02X}{:02X}\"", r as u8, g as u8, b as u8);
        let steps: Vec<String> = VIRIDIS.into_iter().map(hex).collect();
        assert!(script.contains(&format!("[{}]", steps.join(", "))), "{steps:?}");
    }

    /// Nothing is loaded from elsewhere, and everything that is loaded is there.
    #[test]
    fn contract_the_page_is_whole() {
        for file in FILES.iter().filter(|file| file.name.is_empty() || !file.name.starts_with("uplot/")) {
            let text = text(file.name);
            assert!(!text.contains("https:") && !text.contains("http:"), "{}", file.name);
            for part in text.split(" from \"./").skip(1).chain(text.split("src=\"").skip(1)) {
                let name = part.split('"').next().expect("a name");
                assert!(FILES.iter().any(|file| file.name == name), "{name}");
            }
        }
    }
}
