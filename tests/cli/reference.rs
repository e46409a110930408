//! What the program tells about itself: the schema of the model file, completions for shells, manual pages.

use std::collections::BTreeSet;
use std::path::Path;

use serde_json::Value;

use crate::examples::examples;
use crate::support::{ROOT, command, everything_in, finish, folder, planecut};

/// The names of all commands, from the program's help.
fn commands() -> Vec<String> {
    let help = String::from_utf8(planecut(["--help"]).expect_quiet_success().stdout).expect("UTF-8");
    let list = help.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    let names = list.filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    let names: Vec<String> = names.filter_map(|line| line.split_whitespace().next().map(str::to_owned)).collect();
    assert!(names.len() >= 9 && names.contains(&"build".to_owned()), "{help}");
    names.into_iter().filter(|name| name != "help").collect()
}

/// The text of a manual page without its markup.
fn plain(page: &str) -> String {
    [r"\fB", r"\fI", r"\fR"].iter().fold(page.replace(r"\-", "-"), |text, markup| text.replace(markup, ""))
}

/// The long options in a text.
fn options(text: &str) -> BTreeSet<String> {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '-';
    let words = text.split(|c| !is_part(c));
    words.filter(|word| word.len() > 2 && word.starts_with("--")).map(str::to_owned).collect()
}

#[test]
fn the_schema_is_the_published_one_wherever_the_program_runs() {
    let folder = folder();
    let run = finish(command().current_dir(folder.path()).arg("schema")).expect_quiet_success();
    assert_eq!(run.stdout, std::fs::read(Path::new(ROOT).join("docs/model.schema.json")).expect("the schema"));
    let schema: Value = serde_json::from_slice(&run.stdout).expect("JSON");
    let schema = jsonschema::validator_for(&schema).expect("a schema");
    for path in examples() {
        let model = serde_json::from_slice(&std::fs::read(&path).expect("an example")).expect("JSON");
        let errors: Vec<String> = schema.iter_errors(&model).map(|error| error.to_string()).collect();
        assert!(errors.is_empty(), "{}: {errors:?}", path.display());
    }
    let unknown = serde_json::json!({"planecut": 1, "modle": {}});
    assert!(!schema.is_valid(&unknown));
}

#[test]
fn completions_name_every_command_and_its_options() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = planecut(["completions", shell]).expect_quiet_success().stdout;
        let script = String::from_utf8(script).expect("UTF-8");
        for name in commands() {
            assert!(script.contains(&name), "{shell}: {name}");
        }
        for option in ["max-excess", "verify", "tolerance", "input-format"] {
            assert!(script.contains(option), "{shell}: {option}");
        }
    }
    planecut(["completions", "tcsh"]).expect_error(2, "tcsh");
}

#[test]
fn manual_pages_name_every_command_and_every_option() {
    let page = |arguments: &[&str]| {
        let run = planecut([&["man"], arguments].concat()).expect_quiet_success();
        let page = plain(&String::from_utf8(run.stdout).expect("UTF-8"));
        assert!(page.contains(".TH planecut"), "{page}");
        page
    };
    let program = page(&[]);
    let commands = commands();
    for name in &commands {
        assert!(program.contains(&format!("planecut-{name}(1)")), "{name}: {program}");
        let help = planecut([name, "--help"]).expect_quiet_success().stdout;
        let missing = &options(&String::from_utf8(help).expect("UTF-8")) - &options(&page(&[name]));
        assert!(missing.is_empty(), "{name}: {missing:?}");
    }
    planecut(["man", "biuld"]).expect_error(2, "found command biuld, expected one of build, ");

    let folder = folder();
    finish(command().current_dir(folder.path()).args(["man", "--dir", "man/man1"])).expect_quiet_success();
    let mut expected: Vec<String> = commands.iter().map(|name| format!("planecut-{name}.1")).collect();
    expected.extend(["planecut.1", "man", "man1"].map(str::to_owned));
    expected.sort();
    assert_eq!(everything_in(folder.path()), expected);
    let written = std::fs::read_to_string(folder.path().join("man/man1/planecut-build.1")).expect("a page");
    assert_eq!(plain(&written), page(&["build"]));
}
