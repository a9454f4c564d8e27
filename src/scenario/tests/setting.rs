//! What the keys of the setting accept: time, region, visibility.

use super::{accepts, refuses};
use crate::scenario::Region;
use crate::scenario::values::points;

#[test]
fn durations_and_steps_are_bounded() {
    let range = ", expected a number > 0 and <= 8784, in h";
    for found in ["0", "-1", "8784.1", "nan", "inf", "\"24\"", "true", "[24]"] {
        let line = format!("duration-h = {found}");
        refuses(
            "time",
            &line,
            "duration-h",
            &format!("found {found}{range}"),
        );
    }
    refuses(
        "time",
        "step-s = 0",
        "step-s",
        "found 0, expected a number > 0, in s",
    );
    refuses(
        "time",
        "step-s = -60.5",
        "step-s",
        "found -60.5, expected a number > 0, in s",
    );
    let too_many = "86400000 samples in time, expected at most 10000000";
    refuses("time", "step-s = 1e-3", "step-s", too_many);
    let endless = "inf samples in time, expected at most 10000000";
    refuses("time", "step-s = 1e-305", "step-s", endless);
}

#[test]
fn a_step_beyond_the_duration_leaves_the_first_sample() {
    let scenario = accepts("time", "duration-h = 1\nstep-s = 7200");
    assert_eq!(scenario.time.samples(), 1);
}

#[test]
fn the_sample_at_the_end_is_left_out_up_to_rounding() {
    let samples = |text| accepts("time", text).time.samples();
    assert_eq!(samples("duration-h = 24\nstep-s = 60"), 1440);
    assert_eq!(samples("duration-h = 24\nstep-s = 70"), 1235); // 1234.29 steps
    // In f64, 0.7 h are 2519.9999999999995 s and 1.1 h are 3960.0000000000005 s.
    assert_eq!(samples("duration-h = 0.7\nstep-s = 60"), 42);
    assert_eq!(samples("duration-h = 1.1\nstep-s = 60"), 66);
}

#[test]
fn epochs_are_utc_and_in_range() {
    let wanted = "expected a UTC instant such as \"2025-01-01T00:00:00Z\", years 1972 to 2100, with \
                  23:59:60 only on days that end with a leap second";
    for found in [
        "\"2025-01-01\"",
        "\"2025-01-01T00:00:00\"",
        "\"2025-01-01T00:00:00+08:00\"",
        "\"1971-12-31T23:59:59Z\"",
        "\"2101-01-01T00:00:00Z\"",
        "\"2017-06-30T23:59:60Z\"",
        "\"2016-12-31T22:59:60Z\"",
        "2016-12-30T23:59:60Z",
        "\"2025-02-29T00:00:00Z\"",
        "2025-01-01T00:00:00",
        "2025-01-01",
        "12:00:00",
        "2025-01-01T00:00:00-05:00",
        "20250101",
        "\"\"",
    ] {
        let line = format!("epoch = {found}");
        refuses("time", &line, "epoch", &format!("found {found}, {wanted}"));
    }
    let same = accepts("time", "epoch = \"2024-02-29T12:00:00.5Z\"");
    assert_eq!(accepts("time", "epoch = 2024-02-29T12:00:00.5Z"), same);
    assert_eq!(
        accepts("time", "epoch = 2024-02-29 12:00:00.500+00:00"),
        same
    );
    assert_eq!(same.time.epoch.timestamp_millis(), 1_709_208_000_500);
    let leap = accepts("time", "epoch = \"2016-12-31T23:59:60.25Z\"");
    assert_eq!(accepts("time", "epoch = 2016-12-31T23:59:60.25Z"), leap);
    let epoch = crate::time::Epoch::from_utc(leap.time.epoch);
    assert_eq!(epoch.to_string(), "2016-12-31T23:59:60.250Z");
    accepts("time", "epoch = \"1972-01-01T00:00:00Z\"");
    accepts("time", "epoch = \"2100-12-31T23:59:59Z\"");
}

#[test]
fn masks_are_from_the_horizon_to_below_the_zenith() {
    for key in ["mask-deg", "gnss-mask-deg"] {
        for found in ["-0.1", "90", "1e999"] {
            let message = format!("found {found}, expected a number >= 0 and < 90, in deg");
            refuses("visibility", &format!("{key} = {found}"), key, &message);
        }
        accepts("visibility", &format!("{key} = 0"));
    }
    let table = accepts(
        "visibility",
        "mask-table = [[0, 5], [90.5, 12], [270, 0], [360, 5]]",
    );
    assert_eq!(table.visibility.mask_table[1].azimuth_deg, 90.5);
    assert_eq!(table.visibility.mask_table[1].mask_deg, 12.0);
    let wanted = "expected a list of [azimuth >= 0 and <= 360, mask >= 0 and < 90], \
                  azimuths rising from 0 to 360 with the same mask at both";
    for (table, found) in [
        ("[[0, 90]]", "90"),
        ("[[361, 5]]", "361"),
        ("[[0, 5], [180, 5]]", "[[0, 5], [180, 5]]"),
        ("[[0, 5], [360, 6]]", "[[0, 5], [360, 6]]"),
        ("[[0, 5, 1]]", "[0, 5, 1]"),
        ("[[10, 5], [10, 6]]", "[[10, 5], [10, 6]]"),
        ("7", "7"),
    ] {
        let message = format!("found {found}, {wanted}, in deg");
        refuses(
            "visibility",
            &format!("mask-table = {table}"),
            "mask-table",
            &message,
        );
    }
}

#[test]
fn the_pdop_cap_is_above_one_and_above_rounding() {
    for cap in ["1", "1000001"] {
        refuses(
            "visibility",
            &format!("pdop-cap = {cap}"),
            "pdop-cap",
            &format!("found {cap}, expected a number > 1 and <= 1000000"),
        );
    }
    refuses(
        "objectives",
        "availability-pdop = 0",
        "availability-pdop",
        "expected a number > 0",
    );
}

#[test]
fn latitudes_run_northwards() {
    let reversed = "found [54, 3], but the low limit is above the high limit";
    refuses("region", "latitude-deg = [54, 3]", "latitude-deg", reversed);
    let range = "expected [low, high], each a number >= -90 and <= 90, in deg";
    for (line, found) in [
        ("[3, 90.5]", "90.5"),
        ("[-91, 3]", "-91"),
        ("[3]", "[3]"),
        ("3", "3"),
    ] {
        let message = format!("found {found}, {range}");
        refuses(
            "region",
            &format!("latitude-deg = {line}"),
            "latitude-deg",
            &message,
        );
    }
    accepts("region", "latitude-deg = [30, 30]");
}

#[test]
fn longitudes_run_eastwards() {
    let longitudes = |text: &str| match accepts("region", text).region {
        Region::Grid(grid) => grid.longitude_deg,
        _ => panic!("{text} is a grid"),
    };
    assert_eq!(longitudes("longitude-deg = [160, -155]"), [160.0, 205.0]);
    assert_eq!(longitudes("longitude-deg = [160, 205]"), [160.0, 205.0]);
    assert_eq!(longitudes("longitude-deg = [-180, 180]"), [-180.0, 180.0]);
    assert_eq!(longitudes("longitude-deg = [350, 10]"), [350.0, 370.0]);
    assert_eq!(longitudes("longitude-deg = [350, 370]"), [350.0, 370.0]);
    assert_eq!(longitudes("longitude-deg = [719, 365]"), [359.0, 365.0]);
    let wide = "found [-180, 180.5], expected a span eastwards of 0 to 360 degrees";
    refuses(
        "region",
        "longitude-deg = [-180, 180.5]",
        "longitude-deg",
        wide,
    );
    let reversed = "found [700, 10], expected a span eastwards of 0 to 360 degrees";
    refuses(
        "region",
        "longitude-deg = [700, 10]",
        "longitude-deg",
        reversed,
    );
    let far = "found 721, expected [west, east], each a number >= -360 and <= 720, in deg";
    refuses("region", "longitude-deg = [721, 10]", "longitude-deg", far);
}

#[test]
fn grid_steps_are_bounded() {
    let range = "expected a number > 0 and <= 360, or [in latitude, in longitude], in deg";
    for (line, found) in [
        ("0", "0"),
        ("[5, -5]", "-5"),
        ("[5, 5, 5]", "[5, 5, 5]"),
        ("361", "361"),
    ] {
        let message = format!("found {found}, {range}");
        refuses(
            "region",
            &format!("step-deg = {line}"),
            "step-deg",
            &message,
        );
    }
    refuses(
        "region",
        "step-deg = 0.01",
        "step-deg",
        "grid points, expected at most 1040000",
    );
    let one = accepts("region", "step-deg = [100, 200]");
    assert!(matches!(one.region, Region::Grid(grid) if points(&grid) == 1.0));
}

#[test]
fn poles_alone_weigh_nothing() {
    let weightless = "every point is a pole and has zero weight";
    let line = "latitude-deg = [90, 90]\nweights = \"cos-latitude\"";
    refuses("region", line, "latitude-deg", weightless);
    let line = "latitude-deg = [-90, 90]\nstep-deg = 180\nweights = \"cos-latitude\"";
    refuses("region", line, "latitude-deg", weightless);
    accepts(
        "region",
        "latitude-deg = [-90, 90]\nweights = \"cos-latitude\"",
    );
    accepts("region", "latitude-deg = [90, 90]");
}

#[test]
fn points_exclude_the_grid() {
    let line = "step-deg = 5\npoints = \"p.csv\"";
    refuses(
        "region",
        line,
        "step-deg",
        "excluded by `region.points`; give one of them",
    );
    refuses(
        "region",
        "points = \"\"",
        "points",
        "expected a text without control characters",
    );
}
