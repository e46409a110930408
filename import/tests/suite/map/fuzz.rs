//! Random damage to a valid map: any result will do, a panic or a message of two lines will not.

use planecut_import::map::{MapOptions, read_map};
use planecut_testkit::random::Rng;

/// One face of every dialect, a patch, quoted names, a bare brush.
const MAP: &str = r#"// entity 0
{
"classname" "worldspawn"
"wad" "c:\quake\gfx.wad"
// brush 0
{
( -64 -64 -16 ) ( -64 -63 -16 ) ( -64 -64 -15 ) {fence 0 0 0 1 1
( -64.5 -64 -16.25 ) ( -64 -64 -15 ) ( -63 -64 -16 ) "a \"b\"" 0 0 0 1 1 -1
( -64 -64 -16 ) ( -63.125000 -64 -16 ) ( -64 -63 -16 ) *water 0 0 0 1 1 1 2 3
( 64 64 1e1 ) ( 64 505.37931034482756 197.51724137931035 ) ( 65 64 16 ) +0slip 0 0 0 1 1 0 0 0 8 9 10
( 64 64 16 ) ( 65 64 16 ) ( 64 64 17 ) gothic/a [ 1 0 0 -3.5 ] [ 0 -1 0 0 ] 30 0.25 0.25
( 0 0 0 ) ( 0 0 0 ) ( 0 0 0 ) __TB_empty 0 0 0 1 1
}
{ patchDef2 { common/caulk ( 3 3 0 0 0 ) ( ( ( 0 0 0 0 0 ) ) ) } }
{ brushDef { ( 64 64 16 ) ( 64 64 17 ) ( 64 65 16 ) ( ( 1 0 0 ) ( 0 1 0 ) ) stone 0 0 0 } }
}
{ ( 64 64 16 ) ( 64 64 17 ) ( 64 65 16 ) stone 0 0 0 1 1 }
{ "classname" "light" "origin" "0 0 24" }
"#;

/// Bytes that mean something to the reader.
const TELLING: &[u8] = b"(){}[]\"\\/-+.e0159 \n\r\tV\0\xff";

/// Whether the text was a map; checks what must hold for every result.
fn check(text: &[u8]) -> bool {
    match read_map(text, "m", &MapOptions::default()) {
        Ok(import) => {
            let accounted = import.model.tree.brushes().len() + import.brushes_skipped + import.brushes_left_out;
            assert_eq!(import.brushes_read, accounted);
            let materials = import.model.materials.len();
            let faces = || import.model.tree.brushes().iter().flat_map(|brush| &brush.faces);
            assert!(faces().all(|face| (face.material.0 as usize) < materials));
            true
        }
        Err(error) => {
            let message = error.to_string();
            assert!(!message.contains(['\n', '\r', '\0']) && message.len() < 400, "{message}");
            let lines = text.iter().filter(|b| matches!(b, b'\n' | b'\r')).count() as u32 + 1;
            assert!(error.line().is_none_or(|line| (1..=lines).contains(&line)), "{message}");
            false
        }
    }
}

#[test]
fn every_truncation() {
    assert!(check(MAP.as_bytes()));
    let readable = (0..MAP.len()).filter(|&length| check(&MAP.as_bytes()[..length])).count();
    // Only cuts between entities, in white space or in a comment leave a map.
    assert!(readable < MAP.len() / 10, "{readable} of {} truncations were read", MAP.len());
}

#[test]
fn random_damage() {
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_or(0, |d| d.as_nanos() as u64);
    let seed = std::env::var("PLANECUT_SEED").ok().and_then(|text| text.parse().ok()).unwrap_or(now);
    println!("PLANECUT_SEED={seed}");
    let mut random = Rng::new(seed);
    let (mut read, mut refused) = (0, 0);
    for _ in 0..20_000 {
        let mut text = MAP.as_bytes().to_vec();
        for _ in 0..=random.below(4) {
            damage(&mut text, &mut random);
        }
        *(if check(&text) { &mut read } else { &mut refused }) += 1;
    }
    assert!(read > 100 && refused > 100, "{read} read, {refused} refused");
}

/// Changes, removes, inserts, repeats or cuts off bytes.
fn damage(text: &mut Vec<u8>, random: &mut Rng) {
    if text.is_empty() {
        return;
    }
    let (at, byte) = (random.below(text.len()), TELLING[random.below(TELLING.len())]);
    match random.below(7) {
        0 => text[at] ^= 1 << random.below(8),
        1 => text[at] = byte,
        2 => text.insert(at, byte),
        3 => drop(text.remove(at)),
        4 => drop(text.drain(at..(at + random.below(40)).min(text.len()))),
        5 => {
            let copy = text[at..(at + random.below(80)).min(text.len())].to_vec();
            text.splice(at..at, copy);
        }
        _ => text.truncate(at.max(text.len() / 2)),
    }
}
