//! Any bytes as a study file: a checked study or one sentence, and what is accepted means the same when written out and read
//! again.
#![no_main]

#[path = "../../crates/retune/src"]
#[allow(dead_code, unused_imports, reason = "the program uses the rest")]
mod program {
    pub mod study;
}

use libfuzzer_sys::fuzz_target;
use program::study::read::from_text;

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    match from_text(text, "fuzz.json") {
        Err(error) => {
            let sentence = error.to_string();
            assert!(sentence.starts_with("fuzz.json:"), "{sentence}");
            assert!(!sentence.contains('\n') || text.contains("\\n"), "{sentence}");
        }
        Ok(study) => {
            let resolved = study.resolved();
            let text = serde_json::to_string(&resolved).expect("a study as JSON");
            let again = from_text(&text, "again.json").unwrap_or_else(|error| panic!("{error}: {text}"));
            assert_eq!(again, resolved, "{text}");
            if study.optimize.is_some() {
                let search = study.search().expect("a checked search");
                if let Some((_, grid)) = search.surf {
                    let mut point = vec![0.0; grid.dim()];
                    for i in [0, grid.len() / 2, grid.len() - 1] {
                        grid.point(i, &mut point);
                        assert!(point.iter().all(|x| x.is_finite() && *x >= 0.0), "{point:?}: {text}");
                    }
                }
            }
        }
    }
});
