//! What a cache holds is what would be made, whatever becomes of it and whoever else uses it.

use std::fs;
use std::path::PathBuf;

use serde_json::{Value, json};

use super::CUBE;
use super::support::Batch;
use crate::support::files_below;
use crate::support::finish;

fn boxes(count: usize) -> Vec<Value> {
    let job = |k: usize| json!({"id": k.to_string(), "command": "build", "input": "box.json", "outputs": [format!("{k}.glb"), format!("{k}.obj")], "options": {"set": {"w": k + 1}, "mtl": true, "report": format!("{k}.json")}});
    (0..count).map(job).collect()
}

/// The folders of results.
fn entries(batch: &Batch) -> Vec<PathBuf> {
    let list = |folder: PathBuf| -> Vec<PathBuf> {
        fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()).collect()
    };
    let mut entries: Vec<PathBuf> = list(batch.path().join("cache/results")).into_iter().flat_map(list).collect();
    entries.sort();
    entries
}

fn cached(batch: &Batch) -> usize {
    batch.results().iter().filter(|result| result["cached"] == json!(true)).count()
}

/// Outputs without results and reports, which hold times.
fn timeless(batch: &Batch) -> Vec<(String, Vec<u8>)> {
    files_below(&batch.out()).into_iter().filter(|(name, _)| !name.contains(".json")).collect()
}

#[test]
fn what_is_known_is_not_made_again() {
    let batch = Batch::new();
    batch.write("cube.stl", CUBE);
    batch.write("mesh.json", r#"{"planecut": 1, "model": {"mesh": "cube.stl"}}"#);
    let mut jobs = boxes(5);
    jobs.push(json!({"id": "mesh", "command": "build", "input": "mesh.json", "outputs": ["mesh.glb"]}));
    jobs.push(json!({"id": "bad", "command": "build", "input": "nosuch.json", "outputs": ["bad.glb"]}));
    assert_eq!(batch.run(&jobs, "--cache cache").status, 1);
    assert_eq!((cached(&batch), entries(&batch).len()), (0, 6));
    let made = timeless(&batch);
    for _ in 0..2 {
        fs::remove_dir_all(batch.out()).expect("removed");
        assert_eq!(batch.run(&jobs, "--cache cache --verify-cache 3").status, 1);
        assert_eq!((cached(&batch), entries(&batch).len()), (6, 6));
        assert_eq!(timeless(&batch), made);
    }
    // what the model names has changed, and changes back
    batch.write("cube.stl", &CUBE.replace('1', "2"));
    fs::remove_dir_all(batch.out()).expect("removed");
    assert_eq!(batch.run(&jobs, "--cache cache").status, 1);
    assert_eq!((cached(&batch), entries(&batch).len()), (5, 7));
    assert_ne!(timeless(&batch), made);
    batch.write("cube.stl", CUBE);
    fs::remove_dir_all(batch.out()).expect("removed");
    assert_eq!(batch.run(&jobs, "--cache cache").status, 1);
    assert_eq!((cached(&batch), timeless(&batch)), (6, made));
}

#[test]
fn damaged_entries_are_made_again() {
    let batch = Batch::new();
    let jobs = boxes(4);
    assert_eq!(batch.run(&jobs, "--cache cache").status, 0);
    let made = timeless(&batch);
    let found = entries(&batch);
    fs::write(found[0].join("1"), "other bytes").expect("written");
    fs::remove_file(found[1].join("0")).expect("removed");
    fs::write(found[2].join("entry.json"), "{\"status\": 0,").expect("written");
    fs::remove_dir_all(batch.out()).expect("removed");
    assert_eq!(batch.run(&jobs, "--cache cache").status, 0);
    assert_eq!((cached(&batch), timeless(&batch)), (1, made));
}

#[test]
fn verification_finds_a_result_that_is_wrong() {
    let batch = Batch::new();
    let jobs = boxes(2);
    assert_eq!(batch.run(&jobs, "--cache cache").status, 0);
    let made = timeless(&batch);
    // one entry gets the files of the other, with sums that fit
    let found = entries(&batch);
    for name in ["0", "1", "2", "3"] {
        fs::copy(found[1].join(name), found[0].join(name)).expect("copied");
    }
    let text = |entry: &PathBuf| -> Value {
        serde_json::from_slice(&fs::read(entry.join("entry.json")).expect("there")).expect("JSON")
    };
    let (mut wrong, other) = (text(&found[0]), text(&found[1]));
    for k in 0..4 {
        wrong["files"][k]["sum"] = other["files"][k]["sum"].clone();
    }
    fs::write(found[0].join("entry.json"), wrong.to_string()).expect("written");
    fs::remove_dir_all(batch.out()).expect("removed");
    batch.run(&jobs, "--cache cache --verify-cache 2").expect_error(1, "found 1 of 2 jobs that failed");
    let results = batch.results();
    let wrong = results.iter().find(|result| result["status"] == json!(1)).expect("one that failed");
    let error = wrong["error"].as_str().expect("an error");
    assert!(
        error.starts_with("found other bytes of ") && error.ends_with("expected what is made of the same inputs"),
        "{error}"
    );
    // what was made is right, and the entry is gone
    assert_eq!((timeless(&batch), entries(&batch).len()), (made, 1));
}

#[test]
fn several_batches_share_a_cache() {
    let batches: Vec<Batch> = (0..3).map(|_| Batch::new()).collect();
    let cache = crate::support::folder();
    let place = cache.path().join("shared").display().to_string();
    let jobs = boxes(60);
    let children: Vec<_> = batches
        .iter()
        .map(|batch| {
            batch.manifest(&jobs);
            batch.command(&format!("--jobs 2 --cache {place}")).spawn().expect("it starts")
        })
        .collect();
    for mut child in children {
        assert!(child.wait().expect("ended").success());
    }
    let made: Vec<_> = batches.iter().map(timeless).collect();
    assert!(made[0].len() == 180 && made.iter().all(|files| *files == made[0]));
    let unfinished = fs::read_dir(cache.path().join("shared/tmp")).expect("a folder").count();
    assert_eq!(unfinished, 0);
    let last = Batch::new();
    last.manifest(&jobs);
    assert_eq!(finish(&mut last.command(&format!("--cache {place} --verify-cache 10"))).status, 0);
    assert_eq!((cached(&last), timeless(&last)), (60, made[0].clone()));
}

#[test]
fn a_cache_is_cut_down_to_its_size_from_its_oldest_end() {
    let batch = Batch::new();
    batch.write(
        "ball.json",
        r#"{"planecut": 1, "parameters": {"r": 1}, "model": {"sphere": {"radius": "=r", "segments": 128}}}"#,
    );
    let jobs: Vec<Value> = (1..=5)
        .map(|r| json!({"id": r.to_string(), "command": "build", "input": "ball.json", "outputs": [format!("{r}.stl")], "options": {"set": {"r": r}}}))
        .collect();
    let size = |batch: &Batch| -> u64 {
        files_below(&batch.path().join("cache/results")).iter().map(|(_, bytes)| bytes.len() as u64).sum()
    };
    assert_eq!(batch.run(&jobs[..4], "--jobs 1 --cache cache").status, 0);
    let all = size(&batch);
    assert!(all > 3_000_000, "{all}");
    // the first one is used again, the fifth is new: these two are what was used last
    fs::remove_dir_all(batch.out()).expect("removed");
    let used = [jobs[0].clone(), jobs[4].clone()];
    assert_eq!(batch.run(&used, "--jobs 1 --cache cache --cache-size 2").status, 0);
    assert!(size(&batch) <= 2_000_000);
    fs::remove_dir_all(batch.out()).expect("removed");
    assert_eq!(batch.run(&used, "--jobs 1 --cache cache").status, 0);
    assert_eq!(cached(&batch), 2);
}
