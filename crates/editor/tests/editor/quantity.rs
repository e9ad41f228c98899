//! Texts that are typed into a box for a number.

use hairline_editor::quantity::{Unit, parse};

fn metres(typed: &str) -> Result<f64, String> {
    parse(typed, Unit::Metre, Unit::Metre.shown(0.0825)).map_err(|error| error.to_string())
}

fn is(got: Result<f64, String>, expected: f64) {
    let got = got.unwrap();
    assert!(
        (got - expected).abs() <= 1e-12 * expected.abs(),
        "{got} in place of {expected}"
    );
}

#[test]
fn units_sums_and_commas() {
    for (typed, expected) in [
        ("0.004 mm", 4e-6),
        ("4 um", 4e-6),
        ("4µm", 4e-6),
        ("4 μm", 4e-6),
        ("550 nm", 550e-9),
        ("3 in", 0.0762),
        ("3\"", 0.0762),
        ("1.5m", 1.5),
        // Without a unit it counts in what is shown: millimetres here.
        ("90", 0.09),
        ("6,5", 0.0065),
        ("7/2", 0.0035),
        ("-(2 + 3)*4", -0.02),
        ("1/4 mm", 0.25e-3),
        ("5 cm + 3 mm", 0.053),
        ("2 * (1 cm - 2 mm)", 0.016),
        ("−3 mm", -0.003),
        ("1e-3 m", 1e-3),
        ("1 000 um", 1e-3),
        ("10_000 um", 1e-2),
        ("0,125", 0.125e-3),
        ("pi m", std::f64::consts::PI),
    ] {
        is(metres(typed), expected);
    }
    let per = |typed, unit: Unit| parse(typed, unit, unit.shown(1.0)).map_err(|e| e.to_string());
    is(per("4 um", Unit::Micrometre), 4.0);
    is(per("0.004 mm", Unit::Micrometre), 4.0);
    is(per("0.2 um", Unit::Nanometre), 200.0);
    is(per("30 /cm²", Unit::PerSquareMetre), 3e5);
    is(per("30/cm2", Unit::PerSquareMetre), 3e5);
    is(per("2 /mm", Unit::PerMetre), 2000.0);
    is(per("pi/2 rad", Unit::Degree), 90.0);
    is(per("45°", Unit::Degree), 45.0);
    is(per("30 deg", Unit::Degree), 30.0);
    is(per("-1.5 EV", Unit::Exposure), -1.5);
    is(per("3200 K", Unit::Kelvin), 3200.0);
    is(per("50 %", Unit::None), 0.5);
    is(per("640 px", Unit::Pixel), 640.0);
}

#[test]
fn what_is_no_number_says_why() {
    for (typed, says) in [
        ("", "no number"),
        ("4 zz", "zz"),
        ("30°", "angle"),
        ("4 mm +", "ends where a number belongs"),
        ("4 mm + 1", "unit"),
        ("(1", ")"),
        ("1)", ")"),
        ("1/0", "zero"),
        ("1,000", "1000 or 1."),
        ("1,234.5", "1,234.5"),
        ("mm", "mm"),
        ("2 3", "3"),
        ("1e400 m", "finite"),
        ("4 mm²", "area"),
        ("4 m^7", "power"),
        ("\u{1b}[31m", "\\u{1b}"),
    ] {
        let error = metres(typed).expect_err(typed);
        assert!(error.contains(says), "{typed:?}: {error}");
    }
    assert!(metres(&"(".repeat(100_000)).is_err());
    assert!(metres(&"9".repeat(100_000)).unwrap_err().len() < 200);
}

#[test]
fn numbers_are_shown_in_the_unit_that_reads_best() {
    let text = |value: f64| Unit::Metre.shown(value).text(value);
    assert_eq!(text(0.105), "105 mm");
    assert_eq!(text(0.0825), "82.5 mm");
    assert_eq!(text(4e-6), "4 µm");
    assert_eq!(text(6e-4), "0.6 mm");
    assert_eq!(text(2.5), "2.5 m");
    assert_eq!(text(1.0), "1 m");
    assert_eq!(text(-0.27), "-270 mm");
    assert_eq!(text(0.0), "0 mm");
    assert_eq!(text(5.5e-8), "55 nm");
    assert_eq!(text(0.123_456_7), "123.5 mm");
    assert_eq!(Unit::Nanometre.shown(180.0).text(180.0), "180 nm");
    assert_eq!(Unit::Degree.shown(22.5).text(22.5), "22.5°");
    assert_eq!(Unit::None.shown(3400.0).text(123_456.0), "123456");
    // Side by side in one unit, short enough for three in a row.
    let three = [-0.006_193_4, -0.3524, 0.2883];
    let shown = Unit::Metre.shown_together(&three, 1.0);
    let texts = three.map(|value| shown.text(value));
    assert_eq!(texts, ["-6 mm", "-352 mm", "288 mm"]);
    let shown = Unit::Metre.shown_together(&[0.0083774, -1e-9], 1.0);
    assert_eq!(
        [shown.text(0.0083774), shown.text(-1e-9)],
        ["8.38 mm", "0 mm"]
    );
    assert_eq!(
        Unit::None.shown_together(&[0.8071, 0.1], 1e-4).text(0.8071),
        "0.8071"
    );
    assert_eq!(Unit::Metre.shown_together(&[0.0; 3], 1.0).text(0.0), "0 mm");
    // A displayed number is read back as the same number.
    for value in [0.105, 4e-6, 2.5, -0.27, 1e-9, 1234.0] {
        let shown = Unit::Metre.shown(value);
        is(
            parse(&shown.text(value), Unit::Metre, shown).map_err(|e| e.to_string()),
            value,
        );
    }
}

/// A watch of 3 cm under a lamp at 1.2 m is placed to tenths of a millimetre.
#[test]
fn positions_about_a_small_object_have_its_digits() {
    let fine_m = 1e-4;
    let lamp_m = [0.30123, -0.02, 1.20346];
    let shown = Unit::Metre.shown_together(&lamp_m, fine_m);
    assert_eq!(
        lamp_m.map(|m| shown.text(m)),
        ["0.3012 m", "-0.02 m", "1.2035 m"]
    );
    let near_m = [0.030251, -0.12346, 0.0];
    let shown = Unit::Metre.shown_together(&near_m, fine_m);
    assert_eq!(
        near_m.map(|m| shown.text(m)),
        ["30.3 mm", "-123.5 mm", "0 mm"]
    );
    // There is room for five digits.
    let far_m = [120.0, 0.12345, 0.0];
    let shown = Unit::Metre.shown_together(&far_m, fine_m);
    assert_eq!(far_m.map(|m| shown.text(m)), ["120 m", "0.12 m", "0 m"]);
}
