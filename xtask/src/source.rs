//! One Rust file without comments, blank lines and unit tests.

/// The code of a file.
#[derive(Debug, Default, PartialEq)]
pub struct Source {
    /// Lines that contain code, in order, without comments and without the contents of strings.
    pub code: Vec<String>,
    /// Modules in separate files that exist for unit tests only.
    pub test_modules: Vec<String>,
}

/// Reads the code of a file.
pub fn read(text: &str) -> Source {
    let lines: Vec<String> = plain(text).lines().map(str::to_owned).collect();
    let mut source = Source::default();
    let mut at = 0;
    while let Some(line) = lines.get(at) {
        let trimmed = line.trim();
        if is_test_only(trimmed) {
            at = end_of_item(&lines, at, &mut source.test_modules);
        } else if !trimmed.is_empty() {
            source.code.push(line.trim_end().to_owned());
        }
        at += 1;
    }
    source
}

/// Whether a line is the attribute of an item that is compiled for unit tests only.
fn is_test_only(line: &str) -> bool {
    line.starts_with("#[cfg(test)]") || line.starts_with("#[cfg(all(test,")
}

/// The last line of the item whose attribute is on the line `at`.
fn end_of_item(lines: &[String], at: usize, test_modules: &mut Vec<String>) -> usize {
    let mut depth = 0_i32;
    for (i, line) in lines.iter().enumerate().skip(at + 1) {
        let words: Vec<&str> = line.split_whitespace().collect();
        if let (0, ["mod", name]) = (depth, &words[..]) {
            if let Some(name) = name.strip_suffix(';') {
                test_modules.push(name.to_owned());
            }
        }
        let mut closed = false;
        for c in line.chars() {
            depth += i32::from(c == '{') - i32::from(c == '}');
            closed |= c == '}' || c == ';';
        }
        if depth <= 0 && closed {
            return i;
        }
    }
    lines.len()
}

/// The text with comments replaced by spaces and the contents of strings by underscores.
fn plain(text: &str) -> String {
    let chars: Vec<char> = text.chars().collect();
    let mut out = String::with_capacity(text.len());
    let mut at = 0;
    while let Some(&c) = chars.get(at) {
        let rest = &chars[at..];
        let skipped = match rest {
            ['/', '/', ..] => rest.iter().take_while(|c| **c != '\n').count(),
            ['/', '*', ..] => block_comment(rest),
            ['"', ..] => string(rest),
            ['r', '"' | '#', ..] if !follows_a_word(&out) => raw_string(rest),
            ['\'', '\\', ..] => {
                2 + rest[2..].iter().skip(1).take_while(|c| **c != '\'').count() + 2
            }
            ['\'', _, '\'', ..] => 3,
            _ => 0,
        };
        if skipped == 0 {
            out.push(c);
            at += 1;
            continue;
        }
        let taken = &rest[..skipped.min(rest.len())];
        // A string is code, a comment is not.
        let mark = if c == '/' { ' ' } else { '_' };
        out.extend(taken.iter().map(|c| if *c == '\n' { '\n' } else { mark }));
        at += taken.len();
    }
    out
}

fn follows_a_word(out: &str) -> bool {
    out.ends_with(|c: char| c.is_alphanumeric() || c == '_')
}

/// The length of a block comment; block comments nest.
fn block_comment(rest: &[char]) -> usize {
    let (mut depth, mut at) = (0, 0);
    while at < rest.len() {
        match rest[at..] {
            ['/', '*', ..] => (depth, at) = (depth + 1, at + 2),
            ['*', '/', ..] => (depth, at) = (depth - 1, at + 2),
            _ => at += 1,
        }
        if depth == 0 {
            break;
        }
    }
    at
}

/// The length of a string with escapes.
fn string(rest: &[char]) -> usize {
    let mut at = 1;
    while let Some(c) = rest.get(at) {
        at += match c {
            '"' => return at + 1,
            '\\' => 2,
            _ => 1,
        };
    }
    at
}

/// The length of a raw string; zero if the text does not begin with one.
fn raw_string(rest: &[char]) -> usize {
    let hashes = rest[1..].iter().take_while(|c| **c == '#').count();
    if rest.get(1 + hashes) != Some(&'"') {
        return 0;
    }
    let mut at = 2 + hashes;
    while at < rest.len() {
        let end = rest[at..].iter().skip(1).take_while(|c| **c == '#').count();
        if rest[at] == '"' && end >= hashes {
            return at + 1 + hashes;
        }
        at += 1;
    }
    at
}

#[cfg(test)]
mod tests {
    use super::read;

    #[test]
    fn comments_and_blank_lines_are_no_code() {
        let source =
            read("//! Docs.\n\n/* a\n /* b */ c */ use x;\nlet y = 1; // one\n    /// z\n");
        assert_eq!(source.code.len(), 2);
        assert!(source.code[0].ends_with("use x;"));
        assert_eq!(source.code[1], "let y = 1;");
    }

    #[test]
    fn a_comment_in_a_string_is_text() {
        let source = read("let a = \"// no\\\" /*\";\nlet b = r#\"*/ \"// \"#;\nlet c = '\"'; // yes\nlet d = '\\'';\n");
        assert_eq!(source.code.len(), 4);
        assert!(!source.code[2].contains("yes"));
    }

    #[test]
    fn lifetimes_are_no_characters() {
        assert_eq!(
            read("fn f<'a>(x: &'a str) {} // end\n").code,
            ["fn f<'a>(x: &'a str) {}"]
        );
    }

    #[test]
    fn unit_tests_are_left_out() {
        let source = read("fn f() {}\n#[cfg(test)]\nmod tests {\n    fn g() { }\n}\nfn h() {}\n");
        assert_eq!(source.code, ["fn f() {}", "fn h() {}"]);
    }

    #[test]
    fn a_file_of_unit_tests_is_named() {
        let source = read("#[cfg(test)]\nmod garbage;\nmod number;\n");
        assert_eq!(source.test_modules, ["garbage"]);
        assert_eq!(source.code, ["mod number;"]);
    }
}
