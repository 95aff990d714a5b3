//! What must hold for any text as a study file. The fuzzer asks it of the bytes that it makes up, the test of those it kept.

use super::read::from_text;

/// Reads `bytes` as a study: a checked study, which means the same when it is written out and read again, or one sentence.
///
/// # Panics
/// Where that does not hold.
pub fn check(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let study = match from_text(text, "any.json") {
        Ok(study) => study,
        Err(error) => {
            let sentence = error.to_string();
            assert!(sentence.starts_with("any.json:") && sentence.len() > 12, "{sentence}");
            return;
        }
    };
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

#[cfg(test)]
#[test]
fn invariant_the_fuzzers_corpus_holds() {
    let corpus = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fuzz/corpus/study");
    let (mut seen, mut good) = (0, 0);
    for entry in std::fs::read_dir(corpus).expect("the corpus") {
        let bytes = std::fs::read(entry.expect("an entry").path()).expect("an input");
        check(&bytes);
        seen += 1;
        good +=
            usize::from(std::str::from_utf8(&bytes).is_ok_and(|text| from_text(text, "any.json").is_ok()));
    }
    assert!(seen > 300 && good > 20, "{good} of {seen} are studies");
}
