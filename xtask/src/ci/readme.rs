//! The commands and programs that README.md shows.

use super::shell::{fail, Done, Shell};
use std::fs;

/// README.md must show the command, alone on a line of a code block.
pub fn documents(shell: &Shell, command: &str) -> Done {
    let readme = fs::read_to_string(shell.root.join("README.md"))?;
    if shows(&readme, command) {
        return Ok(());
    }
    fail(format!(
        "README.md has no code block with the line: {command}"
    ))
}

fn shows(page: &str, command: &str) -> bool {
    let mut inside = false;
    for line in page.lines().map(str::trim) {
        if line.starts_with("```") {
            inside = !inside;
            continue;
        }
        let line = line.strip_prefix("$ ").unwrap_or(line);
        let line = line.split(" #").next().unwrap_or_default().trim_end();
        if inside && line == command {
            return true;
        }
    }
    false
}

/// The first block in this language under the heading.
pub fn block(page: &str, language: &str, heading: &str) -> Option<String> {
    let fence = format!("\n```{language}\n");
    let (_, section) = page.split_once(&format!("\n{heading}"))?;
    let (_, block) = section.split_once(&fence)?;
    let (block, _) = block.split_once("\n```")?;
    Some(format!("{block}\n"))
}

#[cfg(test)]
mod tests {
    use super::{block, shows};

    const PAGE: &str = "\
cargo fmt
```sh
$ cargo run --release   # a minute
cargo test
```
## One
```rust
one();
```
## Two
```toml
[two]
```
```rust
two();
2
```
```rust
three();
```
";

    #[test]
    fn a_command_is_a_whole_line_of_a_block() {
        assert!(shows(PAGE, "cargo test"));
        assert!(shows(PAGE, "cargo run --release"));
        assert!(!shows(PAGE, "cargo run"));
        assert!(!shows(PAGE, "cargo fmt"));
    }

    #[test]
    fn a_block_is_the_first_of_its_language_under_the_heading() {
        let found = |language| block(PAGE, language, "## Two");
        assert_eq!(found("rust").as_deref(), Some("two();\n2\n"));
        assert_eq!(found("toml").as_deref(), Some("[two]\n"));
        assert_eq!(found("c"), None);
        assert_eq!(block(PAGE, "rust", "## Three"), None);
    }
}
