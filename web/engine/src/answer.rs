//! An answer: JSON and its files.

use serde::Serialize;

/// The answer that a page receives.
#[derive(Debug, Default)]
pub struct Answer {
    json: serde_json::Map<String, serde_json::Value>,
    /// The files, by name.
    pub files: Vec<(String, Vec<u8>)>,
}

impl Answer {
    /// An answer that consists of an error message of one line.
    #[must_use]
    pub fn refusal(line: &str) -> Self {
        let mut answer = Self::default();
        answer.put("refused", line);
        answer
    }

    /// Adds a field; a value that JSON cannot represent is left out.
    pub fn put(&mut self, name: &str, value: impl Serialize) {
        if let Ok(value) = serde_json::to_value(value) {
            self.json.insert(name.to_owned(), value);
        }
    }

    /// A field.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&serde_json::Value> {
        self.json.get(name)
    }

    /// A file.
    #[must_use]
    pub fn file(&self, name: &str) -> Option<&[u8]> {
        let mut all = self.files.iter();
        all.find(|(own, _)| own == name)
            .map(|(_, bytes)| &bytes[..])
    }

    /// The answer as bytes: a line of JSON, whose `files` lists names and lengths, then the files.
    #[must_use]
    pub fn bytes(mut self) -> Vec<u8> {
        let files = std::mem::take(&mut self.files);
        let list: Vec<(&str, usize)> = files
            .iter()
            .map(|(name, bytes)| (name.as_str(), bytes.len()))
            .collect();
        self.put("files", list);
        let mut all = serde_json::to_vec(&self.json).unwrap_or_default();
        all.push(b'\n');
        for (_, bytes) in files {
            all.extend(bytes);
        }
        all
    }
}
