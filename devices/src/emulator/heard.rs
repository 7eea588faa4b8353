//! What a host has sent, command by command.

/// Bytes kept of a command that does not end; no command of any protocol here is so long.
const BYTES_MAX: usize = 256;

/// The bytes that belong to no whole command yet.
#[derive(Debug, Default)]
pub(super) struct Heard {
    bytes: Vec<u8>,
}

impl Heard {
    pub(super) fn extend(&mut self, bytes: &[u8]) {
        self.bytes.extend_from_slice(bytes);
    }

    /// The next command without the byte that ends it; none until it is whole.
    pub(super) fn next(&mut self, ends: impl Fn(u8) -> bool) -> Option<Vec<u8>> {
        let Some(end) = self.bytes.iter().position(|byte| ends(*byte)) else {
            let excess = self.bytes.len().saturating_sub(BYTES_MAX);
            self.bytes.drain(..excess);
            return None;
        };
        let mut command: Vec<u8> = self.bytes.drain(..=end).collect();
        command.pop();
        Some(command)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_taken_whole_however_they_are_cut() {
        let mut heard = Heard::default();
        heard.extend(b"#01\r#0");
        assert_eq!(heard.next(|byte| byte == b'\r'), Some(b"#01".to_vec()));
        assert_eq!(heard.next(|byte| byte == b'\r'), None);
        heard.extend(b"2\r");
        assert_eq!(heard.next(|byte| byte == b'\r'), Some(b"#02".to_vec()));
        heard.extend(&[b'x'; 1000]);
        assert_eq!(heard.next(|byte| byte == b'\r'), None);
        assert_eq!(heard.bytes.len(), BYTES_MAX);
    }
}
