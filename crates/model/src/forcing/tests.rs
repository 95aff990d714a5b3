//! How a forcing is written in a study.

use super::*;

fn read(text: &str) -> Result<Forcing, String> {
    serde_json::from_str(text).map_err(|error| error.to_string())
}

#[test]
fn contract_one_kind_of_forcing_and_what_it_needs() {
    for text in [
        r#"{"P":800.0,"omega":6.28}"#,
        r#"{"imbalance":0.5,"omega":6.28}"#,
        r#"{"base_acceleration":0.5,"omega":6.28}"#,
        r#"{"base":0.01,"omega":6.28}"#,
        r#"{"P":800.0,"start":{"x1":0.1,"v1":0.0,"x2":0.2,"v2":0.0},"omega":6.28}"#,
        r#"{"start":{"x1":0.1,"v1":0.0,"v2":0.0}}"#,
        r#"{"pulse":"half sine","of":"base acceleration","peak":3.0,"duration":0.1}"#,
        r#"{"start":{"x1":0.1,"v1":0.0,"v2":0.0},"pulse":"rectangle","of":"force","peak":-3.0,"duration":0.1,"unit":"kN"}"#,
        r#"{"record":"quake.csv","of":"base acceleration"}"#,
        r#"{"record":"quake.csv","of":"base acceleration","unit":"g","scale":-2.0,"column":"north"}"#,
        r#"{"record":"push.csv","of":"force","column":3}"#,
        r#"{"record":{"step":0.1,"values":[1.0,-2.0]},"of":"force"}"#,
        r#"{"record":{"times":[0.0,0.1,0.3],"values":[1.0,-2.0,0.5]},"of":"base acceleration"}"#,
        r#"{"pulse":"versed sine","of":"force","peak":-3.0,"duration":0.1,"unit":"kN"}"#,
        r#"{"harmonics":[{"amplitude":2.0,"omega":6.0,"phase":0.5}],"of":"force","duration":2.0}"#,
        r#"{"sweep":{"amplitude":2.0,"from":6.0,"rate":-0.5},"of":"force","duration":2.0,"step":0.01}"#,
        r#"{"spectrum":{"omega":[1.0,2.0],"density":[0.5,1.0],"seed":7},"of":"base acceleration","duration":20.0,"unit":"g"}"#,
    ] {
        let forcing = read(text).expect(text);
        assert_eq!(serde_json::to_string(&forcing).expect("JSON"), text);
    }
    // Samples read from a file are written as the file's name, unless the study is to be self-contained.
    let text =
        r#"{"record":{"file":"a.csv","unit":"kN","start":0.5,"step":0.1,"values":[1.0,-2.0]},"of":"force"}"#;
    let mut forcing = read(text).expect(text);
    let short = r#"{"record":"a.csv","of":"force","unit":"kN"}"#;
    assert_eq!(serde_json::to_string(&forcing).expect("JSON"), short);
    let (_, record) = forcing.record_mut().expect("a record");
    *record = record.whole();
    assert_eq!(serde_json::to_string(&forcing).expect("JSON"), text);
    for (text, expected) in [
        (
            r#"{"omega":6.28}"#,
            "give one of `P`, `imbalance`, `base`, `base_acceleration`, `pulse`, `record`, `harmonics`, `sweep` and `spectrum`, or `start` alone, not 0",
        ),
        (
            r#"{"pulse":"half sine","of":"force","peak":1,"duration":1,"omega":1}"#,
            "`omega` has no meaning beside `pulse`",
        ),
        (r#"{"pulse":"half sine","of":"force","peak":1}"#, "missing field `duration` beside `pulse`"),
        (r#"{"pulse":"half sine","peak":1,"duration":1}"#, "missing field `of` beside `pulse`: `force` or"),
        (r#"{"pulse":"saw","of":"force","peak":1,"duration":1}"#, "unknown variant `saw`"),
        (r#"{"pulse":"rectangle","of":"force","peak":1,"duration":0}"#, "0 is not allowed here"),
        (
            r#"{"pulse":"rectangle","of":"force","peak":1,"duration":1,"unit":"g"}"#,
            "`unit`: \"g\" is not allowed here: give one of N, kN",
        ),
        (r#"{"record":"a.csv","of":"force","peak":1}"#, "`peak` has no meaning beside `record`"),
        (r#"{"record":"a.csv","pulse":"rectangle","of":"force","peak":1,"duration":1}"#, "not 2 of them"),
        (
            r#"{"record":"a.csv","of":"base acceleration","unit":"N"}"#,
            "\"N\" is not allowed here: give one of m/s²",
        ),
        (r#"{"record":{"step":1,"values":[1]},"of":"force"}"#, "it has 1 sample: give at least two"),
        (r#"{"record":{"values":[1,2]},"of":"force"}"#, "give one of `step` and `times`"),
        (r#"{"record":{"times":[0],"values":[1,2]},"of":"force"}"#, "2 values for 1 times"),
        (r#"{"record":{"times":[0,0],"values":[1,2]},"of":"force"}"#, "sample 2: the time 0 s does not"),
        (r#"{"record":{"step":1,"values":[1,2]},"of":"force","unit":"N"}"#, "`unit` has no meaning"),
        (r#"{"record":3,"of":"force"}"#, "a file, or samples"),
        (
            r#"{"record":"a.csv","of":"force","column":-1}"#,
            "a column's name in the header, or its number from 1",
        ),
        (r#"{"P":1,"omega":1,"of":"force"}"#, "`of` has no meaning beside `P`"),
        (
            r#"{"P":1,"omega":1,"pulse":"rectangle","of":"force","peak":1,"duration":1}"#,
            "`omega` has no meaning beside `pulse`",
        ),
        (
            r#"{"sweep":{"amplitude":2,"from":6,"rate":0},"of":"force"}"#,
            "missing field `duration` beside `sweep`",
        ),
        (r#"{"harmonics":[],"of":"force","duration":2}"#, "`harmonics`: empty"),
        (
            r#"{"harmonics":[],"sweep":{"amplitude":2,"from":6,"rate":0},"of":"force","duration":2}"#,
            "`harmonics`",
        ),
        (
            r#"{"spectrum":{"omega":[1,2],"density":[1,-1]},"of":"force","duration":2}"#,
            "-1 is not allowed here",
        ),
        (
            r#"{"spectrum":{"omega":[2,1],"density":[1,1]},"of":"force","duration":2}"#,
            "2 frequencies with 2 densities are not allowed",
        ),
        (
            r#"{"pulse":"rectangle","of":"force","peak":1,"duration":1,"step":1}"#,
            "`step` has no meaning beside `pulse`",
        ),
        (r#"{"start":{},"scale":1}"#, "`scale` has no meaning beside `start`"),
        (r#"{"P":1,"base":1,"omega":6.28}"#, "not 2 of them"),
        (r#"{"P":1}"#, "missing field `omega`"),
        (r#"{"start":{},"omega":1}"#, "`omega` has no meaning beside `start`"),
        (r#"{"base":-1,"omega":1}"#, "-1 is not allowed here"),
    ] {
        let error = read(text).expect_err(text);
        assert!(error.contains(expected), "{error}");
    }
}
