//! The check sum by which a recording is known again: SHA-256, as `sha256sum` prints it.

use std::io::{self, Read};

use sha2::{Digest, Sha256};

/// The check sum of everything that `source` holds, in hexadecimal digits.
pub(super) fn sha256(mut source: impl Read) -> io::Result<String> {
    let mut digest = Sha256::new();
    let mut bytes = vec![0; 1 << 16];
    loop {
        match source.read(&mut bytes)? {
            0 => {
                let sum = digest.finalize();
                let digits = sum.iter().map(|byte| format!("{byte:02x}"));
                return Ok(digits.collect::<Vec<_>>().concat());
            }
            n => digest.update(&bytes[..n]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::sha256;

    #[test]
    fn it_is_the_check_sum_that_others_print() {
        let of = |bytes: &[u8]| sha256(bytes).unwrap();
        assert_eq!(of(b""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
        assert_eq!(of(b"abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    }
}
