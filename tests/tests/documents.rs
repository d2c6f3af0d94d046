//! The documents are true: every command is accepted, every link leads somewhere, every page and every rule that is
//! named exists.

use clap::Parser;
use cli::cli::Cli;
use std::fs;
use std::path::{Path, PathBuf};

/// Pages that programs write, not pages of the repository.
const WRITTEN: [&str; 1] = ["table.md"];
/// Folders that hold nothing of the repository's own.
const FOREIGN: [&str; 5] = ["target", ".git", "runs", "trainings", "rollouts"];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Every file of the repository with this ending.
fn files(ending: &str) -> Vec<PathBuf> {
    let (mut waiting, mut found) = (vec![root()], Vec::new());
    while let Some(folder) = waiting.pop() {
        for entry in fs::read_dir(&folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            let foreign = path.file_name().is_some_and(|name| FOREIGN.iter().any(|foreign| name == *foreign));
            if path.is_dir() && !foreign {
                waiting.push(path);
            } else if path.extension().is_some_and(|extension| extension == ending) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// The arguments that `run.sh` hands to the program `vodca`; `None` for what it does itself or hands to others (whose
/// heavy builds this test does not need).
fn arguments(line: &str) -> Option<Vec<String>> {
    let command = line.trim().strip_prefix("./run.sh ")?.split(" #").next()?;
    let mut words: Vec<String> = command.split_whitespace().map(str::to_owned).collect();
    let first = words.first()?.clone();
    if ["test", "python", "policy", "learn", "learner", "train"].contains(&first.as_str()) {
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
    for document in files("md") {
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
    let mut followed = 0;
    for document in files("md") {
        let text = read(&document);
        let links = text.split("](").skip(1).filter_map(|rest| rest.split([')', '#']).next());
        let pictures = text.split("src=\"").skip(1).filter_map(|rest| rest.split('"').next());
        for link in links.chain(pictures).filter(|link| !link.is_empty() && !link.contains("://")) {
            let target = document.with_file_name("").join(link);
            assert!(target.exists(), "{}: there is no {link}", document.display());
            followed += 1;
        }
    }
    assert!(followed >= 10, "only {followed} links were found: the scan is broken");
}

/// The pages that a text names: `NAME.md`, perhaps with folders before it.
fn pages(text: &str) -> impl Iterator<Item = &str> {
    let is_part = |c: char| c.is_ascii_alphanumeric() || "/._-".contains(c);
    let words = text.split(move |c| !is_part(c)).map(|word| word.trim_end_matches('.'));
    words.filter(|word| word.strip_suffix(".md").is_some_and(|stem| !stem.is_empty() && !stem.ends_with('/')))
}

#[test]
fn pages_are_found_among_words() {
    let text = "/// as `docs/A.md` says (b.md, rule 1), not in c.mdx or .md. See ../d.md.";
    assert_eq!(pages(text).collect::<Vec<_>>(), ["docs/A.md", "b.md", "../d.md"]);
}

#[test]
fn every_page_that_a_comment_or_a_document_names_is_in_the_repository() {
    let known = files("md");
    let comments = files("rs").into_iter().map(|file| {
        let text = read(&file);
        let lines = text.lines().filter_map(|line| line.split_once("//").map(|(_, comment)| comment.to_string()));
        (file, lines.collect::<Vec<_>>().join("\n"))
    });
    let documents = known.iter().map(|file| (file.clone(), read(file)));
    let mut named = 0;
    for (file, text) in comments.chain(documents) {
        if file.ends_with("tests/documents.rs") {
            continue; // it names pages that do not exist
        }
        for page in pages(&text).filter(|page| !WRITTEN.contains(page)) {
            named += 1;
            let end = page.trim_start_matches("../");
            assert!(
                known.iter().any(|path| path.ends_with(end)),
                "{} names {page}, which is not there",
                file.display()
            );
        }
    }
    assert!(named >= 10, "only {named} pages were found: the scan is broken");
}

#[test]
fn every_rule_that_a_comment_cites_is_numbered_in_the_architecture() {
    let text = read(&root().join("docs/ARCHITECTURE.md"));
    let (_, rules) = text.split_once("## The rules of the safe profile").expect("the rules have a section");
    let section = rules.split("\n## ").next().unwrap_or_default();
    let numbered = |number: &str| section.lines().any(|line| line.starts_with(&format!("| {number} |")));
    let mut cited = 0;
    for file in files("rs") {
        let text = read(&file);
        for rest in text.split("ARCHITECTURE, rule").skip(1) {
            let numbers = rest.trim_start_matches('s').split(')').next().unwrap_or_default();
            for number in numbers.split(|c: char| !c.is_ascii_digit()).filter(|number| !number.is_empty()) {
                assert!(numbered(number), "{} cites rule {number}", file.display());
                cited += 1;
            }
        }
    }
    assert!(cited >= 10, "only {cited} citations were found: the scan is broken");
}

#[test]
fn every_entry_of_troubleshooting_has_a_cause_and_a_next_step() {
    let text = read(&root().join("docs/TROUBLESHOOTING.md"));
    let entries: Vec<&str> = text.split("\n### ").skip(1).collect();
    assert!(entries.len() >= 20, "only {} entries were found: the scan is broken", entries.len());
    for entry in entries {
        let body = entry.split("\n## ").next().unwrap_or_default();
        assert!(body.contains("\nCause: ") && body.contains("\nNext: "), "{body}");
    }
}

#[test]
fn the_front_page_is_short_and_shows_a_picture_at_once() {
    let text = read(&root().join("README.md"));
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines.len() <= 200, "{} lines", lines.len());
    let is_picture = |line: &&str| line.contains("![") || line.contains("<img ");
    assert!(lines.iter().take(25).any(is_picture), "no picture within the first 25 lines");
    for picture in text.split("src=\"").skip(1).filter_map(|rest| rest.split('"').next()) {
        assert!(root().join(picture).is_file(), "there is no {picture}");
    }
}
