//! The documents are true: every message has its entry, every command is accepted, every link leads somewhere.

use clap::Parser;
use cli::cli::Cli;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Every Rust file of every member's `src`, the tests' own excepted.
fn sources() -> Vec<PathBuf> {
    let mut waiting: Vec<PathBuf> = fs::read_dir(root())
        .expect("the workspace is there")
        .map(|entry| entry.expect("it can be read").path())
        .filter(|path| path.join("Cargo.toml").is_file() && !path.ends_with("tests"))
        .map(|path| path.join("src"))
        .collect();
    let mut files = Vec::new();
    while let Some(path) = waiting.pop() {
        if path.is_dir() {
            waiting.extend(fs::read_dir(&path).expect("a folder").map(|entry| entry.expect("it can be read").path()));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    files
}

/// The literals of all `#[error("...")]` above the unit tests of a file.
fn messages(source: &str) -> Vec<String> {
    let source = source.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    let attributes = source.split("#[error(").skip(1).map(str::trim_start);
    attributes.filter_map(|attribute| attribute.strip_prefix('"')).map(literal).collect()
}

/// The string literal that starts behind its opening quote.
fn literal(text: &str) -> String {
    let (mut value, mut characters) = (String::new(), text.chars().peekable());
    while let Some(character) = characters.next() {
        match character {
            '"' => break,
            '\\' if characters.peek() == Some(&'\n') => {
                while characters.next_if(|next| next.is_whitespace()).is_some() {}
            }
            '\\' => value.extend(characters.next()),
            other => value.push(other),
        }
    }
    value
}

/// The longest piece of a message between its placeholders; `None` when it has no words of its own
/// (it hands on a message that has its own entry).
fn stem(message: &str) -> Option<&str> {
    let pieces = message.split(['{', '}']).step_by(2).flat_map(|piece| piece.split(['`', '"'])).map(str::trim);
    pieces.max_by_key(|piece| piece.len()).filter(|piece| piece.chars().filter(|c| c.is_alphabetic()).count() >= 4)
}

#[test]
fn stems_are_the_longest_words_between_placeholders() {
    let source = "#[error(\n    \"cannot {what}: it \\\n     says \\\"no\\\" {}\", x.y())]\n#[error(transparent)]\n#[error(\"{a}: {b}\")]";
    let found = messages(source);
    assert_eq!(found, ["cannot {what}: it says \"no\" {}", "{a}: {b}"]);
    assert_eq!((stem(&found[0]), stem(&found[1])), (Some(": it says"), None));
}

#[test]
fn every_error_message_has_its_entry() {
    let entries: String = read(&root().join("TROUBLESHOOTING.md")).replace('`', "");
    let (mut found, mut missing) = (0, Vec::new());
    for file in sources() {
        for message in messages(&read(&file)) {
            let Some(stem) = stem(&message) else { continue };
            found += 1;
            // Separators at the ends belong to what the placeholders say.
            let words = stem.trim_matches(|c: char| !c.is_alphanumeric() && c != '[' && c != ']' && c != '/');
            if !entries.contains(words) {
                missing.push(format!("{}: {words}", file.display()));
            }
        }
    }
    assert!(found >= 40, "only {found} messages were found: the scan is broken");
    assert!(missing.is_empty(), "write an entry in TROUBLESHOOTING.md that contains:\n{}", missing.join("\n"));
}

#[test]
fn every_message_of_the_front_door_has_its_entry() {
    let (script, entries) = (read(&root().join("run.sh")), read(&root().join("TROUBLESHOOTING.md")));
    let messages: Vec<&str> = script.split("echo \"").skip(1).filter(|text| text.starts_with("error: ")).collect();
    assert!(messages.len() >= 2, "the scan is broken");
    for message in messages {
        let stem = message.split([';', '"']).next().unwrap_or_default();
        assert!(entries.contains(stem), "write an entry in TROUBLESHOOTING.md that contains: {stem}");
    }
}

#[test]
fn every_entry_has_a_cause_and_a_next_step() {
    let text = read(&root().join("TROUBLESHOOTING.md"));
    for entry in text.split("\n### ").skip(1) {
        let body = entry.split("\n## ").next().unwrap_or_default();
        assert!(body.contains("\nCause: ") && body.contains("\nNext: "), "{body}");
    }
}

fn documents() -> Vec<PathBuf> {
    let mut documents: Vec<PathBuf> = fs::read_dir(root())
        .expect("the workspace is there")
        .map(|entry| entry.expect("it can be read").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "md"))
        .collect();
    documents.push(root().join("scenarios/README.md"));
    documents
}

/// The arguments that `run.sh` hands to the coordinator; `None` for what it does itself or hands to the
/// policy server or the learner (whose heavy builds this test does not need).
fn arguments(line: &str) -> Option<Vec<String>> {
    let command = line.trim().strip_prefix("./run.sh ")?.split(" #").next()?;
    let mut words: Vec<String> = command.split_whitespace().map(str::to_owned).collect();
    let first = words.first()?.clone();
    if ["test", "policy", "learn", "learner", "train"].contains(&first.as_str()) {
        return None;
    }
    if first.starts_with(|c: char| c.is_ascii_digit()) || first.starts_with("--scenario") {
        words.insert(0, "run".into());
    }
    words.insert(0, "run.sh".into());
    Some(words)
}

#[test]
fn every_documented_command_is_accepted() {
    let mut tried = 0;
    for document in documents() {
        let text = read(&document);
        let blocks = text.split("```").skip(1).step_by(2).flat_map(str::lines);
        let spans = text.lines().flat_map(|line| line.split('`').skip(1).step_by(2));
        for words in blocks.chain(spans).filter_map(arguments) {
            // Names in capitals stand for what the user fills in.
            if words.iter().any(|word| word.chars().all(|c| c.is_ascii_uppercase())) {
                continue;
            }
            tried += 1;
            match Cli::try_parse_from(&words) {
                Ok(_) => {}
                Err(error) if !error.use_stderr() => {} // --help, --version
                Err(error) => panic!("{}: {}: {error}", document.display(), words.join(" ")),
            }
        }
    }
    assert!(tried >= 20, "only {tried} commands were found: the scan is broken");
}

#[test]
fn every_link_leads_to_a_file() {
    for document in documents() {
        let text = read(&document);
        for link in text.split("](").skip(1).filter_map(|rest| rest.split([')', '#']).next()) {
            if link.is_empty() || link.contains("://") {
                continue;
            }
            let target = document.with_file_name("").join(link);
            assert!(target.exists(), "{}: there is no {link}", document.display());
        }
    }
}
