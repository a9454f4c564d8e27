use super::*;
use std::io::Cursor;

fn plan(tiles: usize) -> TilePlan {
    TilePlan {
        version: "1.2.3".to_owned(),
        scenario: ScenarioStamp {
            name: "small".to_owned(),
            hash: "abc".to_owned(),
        },
        constellation: "delta:55:6/3/1@925".to_owned(),
        gnss_alone: true,
        instants: 10,
        bytes_of_instant: 3,
        tiles,
    }
}

/// The byte `n` of the values of a part at an instant.
fn value(part: usize, instant: usize, n: usize) -> u8 {
    (100 * part + 3 * instant + n) as u8
}

fn bytes(plan: &TilePlan, tile: usize) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut writer = TileWriter::new(&mut bytes, plan, tile).unwrap();
    for part in 0..2 {
        for instant in plan.instants_of(tile) {
            let values = [0, 1, 2].map(|n| value(part, instant, n));
            writer.write_all(&values).unwrap();
        }
    }
    writer
        .finish(&[TileCounts::default(), TileCounts::default()])
        .unwrap();
    bytes
}

fn file(plan: &TilePlan, tile: usize) -> (String, TileFile<Cursor<Vec<u8>>>) {
    let file = TileFile::open(Cursor::new(bytes(plan, tile))).unwrap();
    (format!("{tile}.tile"), file)
}

fn refused(files: Vec<(String, TileFile<Cursor<Vec<u8>>>)>) -> String {
    TileSet::new(files, &plan(1)).unwrap_err().to_string()
}

/// Every byte is read from its place, across tiles of unequal length and in any order of the files.
#[test]
fn values_are_read_across_tiles() {
    let of = plan(4);
    let lengths = [1, 2, 3, 4].map(|tile| of.instants_of(tile).len());
    assert_eq!(lengths, [2, 3, 2, 3]);
    let files = [3, 1, 4, 2].map(|tile| file(&of, tile));
    let mut set = TileSet::new(files.into(), &plan(1)).unwrap();
    for part in 0..2 {
        for first in 0..10 {
            for count in 0..=10 - first {
                let mut read = vec![0; 3 * count];
                set.read(part, first, &mut read).unwrap();
                let instants = first..first + count;
                let expected = instants.flat_map(|k| [0, 1, 2].map(|n| value(part, k, n)));
                assert_eq!(read, expected.collect::<Vec<_>>());
            }
        }
    }
    assert!(set.read(0, 9, &mut [0; 6]).is_err());
}

/// Cut short anywhere, or with any bit turned, a file is no tile.
#[test]
fn a_damaged_tile_is_refused() {
    let whole = bytes(&plan(2), 2);
    for length in 0..whole.len() {
        let cut = whole[..length].to_vec();
        assert!(TileFile::open(Cursor::new(cut)).is_err(), "{length}");
    }
    for place in 0..whole.len() {
        let mut changed = whole.clone();
        changed[place] ^= 1;
        assert!(TileFile::open(Cursor::new(changed)).is_err(), "{place}");
    }
    let foreign = TileFile::open(Cursor::new(b"design\n".to_vec()));
    assert!(matches!(foreign, Err(TileFileError::Foreign)));
}

/// One error names what is wrong with a set.
#[test]
fn tiles_that_are_not_one_evaluation_are_refused() {
    let of = plan(4);
    let other = |change: fn(&mut TilePlan)| {
        let mut other = plan(4);
        change(&mut other);
        refused(vec![file(&of, 1), file(&other, 2)])
    };
    let version = other(|plan| plan.version = "1.2.4".to_owned());
    assert_eq!(
        version,
        "2.tile is a tile of another evaluation: the version is 1.2.4 there and 1.2.3 here"
    );
    assert!(other(|plan| plan.scenario.hash = "d".to_owned()).contains("the scenario is another"));
    assert!(other(|plan| plan.constellation = "x".to_owned()).contains("constellation is x there"));
    assert!(other(|plan| plan.tiles = 5).contains("the number of tiles is 5 there and 4 here"));
    assert!(other(|plan| plan.instants = 11).contains("the points or instants are others"));
    let twice = refused(vec![file(&of, 3), file(&of, 3)]);
    assert_eq!(twice, "3.tile and 3.tile are both tile 3 of 4");
    let missing = refused(vec![file(&of, 3), file(&of, 1)]);
    assert_eq!(missing, "tiles 2, 4 of 4 are missing");
}
