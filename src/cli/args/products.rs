//! What `navwalker export --help` says of the products.

/// What `--as` takes.
pub(super) const PRODUCTS: &str = "\
Products:
  tle         two-line element sets with names (SGP4), one file
  omm         CCSDS Orbit Mean-Elements Messages (SGP4): kvn, xml, json or csv
  oem         CCSDS Orbit Ephemeris Messages: kvn or xml
  opm         CCSDS Orbit Parameter Messages: state, osculating and mean elements at the epoch
  sp3         SP3-c or -d, positions and velocities in GPS time, Earth-fixed
  stk         STK ephemerides (.e), one file for each satellite, and in stk-scenario the Connect
              commands that build the study: period, satellites, GNSS, region, mask, PDOP
  gmat        GMAT script of the design under J2 alone, with the field that it loads
  czml        CesiumJS: satellites, orbits, GNSS, and the region coloured by mean PDOP
  geojson     for a GIS: region with metrics, ground tracks, footprints (RFC 7946)
  kml         for Google Earth: the same in one document
  yuma        YUMA almanacs of the nominal GNSS; a LEO design has none
  csv         tables of mean elements and of states, TEME and Earth-fixed
  metrics     tables of the metrics by ground point and by instant
  tle-states  table of what SGP4 makes of the element sets as written

Settings the other program needs are listed in manifest.json under assumptions.

Examples:
  navwalker export --design delta:55:182/13/1@925 --as czml,geojson,kml --out shown
  navwalker export regional --design star:86.4:66/6/2@780 --as stk,gmat --out rebuilt";
